#include <sloper/cloth/forces/dihedral_bending.hpp>
#include <sloper/cloth/forces/orthotropic_bending.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::cloth {

namespace {

/// Index of `value` in `list`, where it is added if it is not there.
Eigen::Index place_of(std::vector<int>& list, int value) {
  const auto found = std::find(list.begin(), list.end(), value);
  if (found != list.end())
    return found - list.begin();
  list.push_back(value);
  return static_cast<Eigen::Index>(list.size()) - 1;
}

/// By how much a mode of a plate may be stiffer than its hinges alone. At 1.5 the hinges of an
/// equilateral mesh have the rigidity of a cylinder, and an error of any mode at least halves in a
/// step; from 2 on it would grow.
constexpr double MOST_ABOVE_HINGES = 1.5;

/// Diagonal of the plate's stiffness, scaled so that no mode exceeds it by more. m
Eigen::VectorXd hinges_alone(const Eigen::MatrixXd& stiffness) {
  const Eigen::VectorXd diagonal = stiffness.diagonal().cwiseMax(0);
  const Eigen::VectorXd root =
      diagonal.unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 0; });
  const Eigen::MatrixXd relative = root.asDiagonal() * stiffness * root.asDiagonal();
  const double largest =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(relative, Eigen::EigenvaluesOnly)
          .eigenvalues()
          .tail(1)[0];
  return largest / MOST_ABOVE_HINGES * diagonal;
}

} // namespace

OrthotropicBendingEffect::OrthotropicBendingEffect(const ClothMesh& mesh,
                                                   std::optional<std::vector<double>> rest_angle)
    : m_mesh(mesh), m_plates(make_bending_plates(mesh)), m_rest_angle(std::move(rest_angle)) {
  std::vector<Pair> pairs, hinge_pairs; // of plates whose stiffness is constant
  for (const BendingPlate& plate : m_plates) {
    m_stencils.push_back(stencil_of(plate));
    const Stencil& s = m_stencils.back();
    const bool constant = !m_rest_angle && plate.soft_share <= 0;
    if (!constant)
      continue;
    add_pairs(s, s.stiffness, pairs);
    add_pairs(s, s.of_hinges, hinge_pairs);
  }
  m_pairs = sums(std::move(pairs));
  m_hinge_pairs = sums(std::move(hinge_pairs));
  if (m_rest_angle)
    sign_lengths();
}

/// The particles of a plate's hinges, and what their places say of its curvature.
OrthotropicBendingEffect::Stencil
OrthotropicBendingEffect::stencil_of(const BendingPlate& plate) const {
  Stencil s;
  for (int h : plate.hinge)
    for (int p : m_mesh.hinges[h].particle)
      place_of(s.particle, p);
  const auto m = static_cast<Eigen::Index>(plate.hinge.size());
  const auto n = static_cast<Eigen::Index>(s.particle.size());
  s.coefficient = Eigen::MatrixXd::Zero(m, n);
  for (Eigen::Index e = 0; e < m; ++e) {
    const Hinge& hinge = m_mesh.hinges[plate.hinge[e]];
    for (int k = 0; k < 4; ++k)
      s.coefficient(e, place_of(s.particle, hinge.particle[k])) += hinge.coefficient[k];
  }
  s.stiffness = s.coefficient.transpose() * plate.stiffness * s.coefficient;
  s.of_hinges =
      s.coefficient.transpose() * hinges_alone(plate.stiffness).asDiagonal() * s.coefficient;
  return s;
}

/// Pairs that no hinge has together are 0 in a matrix of hinges, and are left out.
void OrthotropicBendingEffect::add_pairs(const Stencil& stencil, const Eigen::MatrixXd& of,
                                         std::vector<Pair>& to) {
  const auto n = static_cast<Eigen::Index>(stencil.particle.size());
  for (Eigen::Index a = 0; a < n; ++a)
    for (Eigen::Index b = a; b < n; ++b) {
      if (of(a, b) == 0)
        continue;
      const auto [low, high] = std::minmax(stencil.particle[a], stencil.particle[b]);
      to.push_back({low, high, of(a, b)});
    }
}

/// Plates overlap: one entry for each pair of particles.
std::vector<OrthotropicBendingEffect::Pair>
OrthotropicBendingEffect::sums(std::vector<Pair> pairs) {
  std::vector<Pair> out;
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
    return std::tie(a.i, a.j) < std::tie(b.i, b.j);
  });
  for (const Pair& p : pairs) {
    const bool again = !out.empty() && out.back().i == p.i && out.back().j == p.j;
    if (again)
      out.back().stiffness += p.stiffness;
    else
      out.push_back(p);
  }
  return out;
}

/// Rest length of each hinge's edge, negative where the hinge runs against its first triangle.
void OrthotropicBendingEffect::sign_lengths() {
  const ClothMesh& mesh = m_mesh;
  m_rest_angle->resize(mesh.hinges.size(), 0);
  for (const Hinge& h : mesh.hinges) {
    const auto [low, high] = std::minmax(h.particle[0], h.particle[1]);
    const auto found =
        std::lower_bound(mesh.edges.begin(), mesh.edges.end(), std::array<int, 2>{low, high});
    const double length = mesh.springs[found - mesh.edges.begin()].rest_length;
    const bool forward = mesh.triangles[h.triangle[0]].particle[h.corner[0]] == h.particle[0];
    m_signed_length.push_back(forward ? length : -length);
  }
}

void OrthotropicBendingEffect::declare(Couplings& couplings) const {
  auto& pairs = m_rest_angle ? couplings.full : couplings.isotropic;
  if (m_rest_angle)
    for (const Hinge& hinge : m_mesh.hinges)
      for (int a = 0; a < 4; ++a)
        for (int b = a + 1; b < 4; ++b)
          pairs.push_back({hinge.particle[a], hinge.particle[b]});
  for (const Pair& p : m_hinge_pairs)
    if (p.i != p.j)
      pairs.push_back({p.i, p.j});
  for (std::size_t k = 0; k < m_plates.size(); ++k) {
    if (!m_rest_angle && is_constant(k))
      continue;
    const Stencil& s = m_stencils[k];
    const auto n = static_cast<Eigen::Index>(s.particle.size());
    for (Eigen::Index a = 0; a < n; ++a)
      for (Eigen::Index b = a + 1; b < n; ++b)
        if (couples(s, a, b))
          pairs.push_back({s.particle[a], s.particle[b]});
  }
}

void OrthotropicBendingEffect::bind(const BlockMatrix& matrix) {
  if (m_rest_angle)
    m_hinge_slots = find_hinge_slots(m_mesh, matrix);
  m_pair_slots.clear();
  for (const Pair& p : m_hinge_pairs)
    m_pair_slots.push_back(p.i == p.j ? -1 : matrix.slot(p.i, p.j));
  for (std::size_t k = 0; k < m_plates.size(); ++k) {
    Stencil& s = m_stencils[k];
    s.slot.clear();
    if (!m_rest_angle && is_constant(k))
      continue;
    const auto n = static_cast<Eigen::Index>(s.particle.size());
    for (Eigen::Index a = 0; a < n; ++a)
      for (Eigen::Index b = a + 1; b < n; ++b)
        s.slot.push_back(couples(s, a, b) ? matrix.slot(s.particle[a], s.particle[b]) : -1);
  }
}

double OrthotropicBendingEffect::energy(const std::vector<Vec3>& x) const {
  if (m_rest_angle)
    return m_mesh.bend_scale * energy_of_angles(x);
  // A hinge is in up to three plates, and line searches ask often: each q is made once.
  std::vector<Vec3> q(m_mesh.hinges.size(), Vec3::Zero());
  for (std::size_t h = 0; h < q.size(); ++h)
    for (int k = 0; k < 4; ++k)
      q[h] += m_mesh.hinges[h].coefficient[k] * x[m_mesh.hinges[h].particle[k]];
  double sum = 0;
  for (const BendingPlate& plate : m_plates) {
    double s = 0;
    for (std::size_t a = 0; a < plate.hinge.size(); ++a) {
      Vec3 moment = Vec3::Zero();
      for (std::size_t b = 0; b < plate.hinge.size(); ++b)
        moment += plate.stiffness(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) *
                  q[plate.hinge[b]];
      s += q[plate.hinge[a]].dot(moment);
    }
    sum += plate.energy(s);
  }
  return m_mesh.bend_scale * sum;
}

void OrthotropicBendingEffect::add(StepContext& c) {
  const double damping = m_mesh.fabrics.empty() ? 0 : m_mesh.fabrics[0].damping_s / c.h;
  if (m_rest_angle) {
    add_angles(c, damping);
    return;
  }
  add_sums(c, damping);
  for (std::size_t k = 0; k < m_plates.size(); ++k)
    if (!is_constant(k))
      add_plate(c, k, damping);
}

void OrthotropicBendingEffect::add_sums(StepContext& c, double damping) const {
  const double scale = m_mesh.bend_scale;
  for (const Pair& p : m_pairs) {
    const double k = scale * p.stiffness;
    c.force[p.i] -= k * c.x[p.j];
    if (p.i != p.j)
      c.force[p.j] -= k * c.x[p.i];
  }
  for (std::size_t e = 0; e < m_hinge_pairs.size(); ++e) {
    const Pair& p = m_hinge_pairs[e];
    const double k = scale * p.stiffness * (1 + damping);
    if (p.i == p.j)
      c.stiffness.add_isotropic_diagonal(p.i, k);
    else
      c.stiffness.add_isotropic(m_pair_slots[e], k);
  }
}

void OrthotropicBendingEffect::add_plate(StepContext& c, std::size_t plate, double damping) {
  const Stencil& s = m_stencils[plate];
  const auto n = static_cast<Eigen::Index>(s.particle.size());
  Eigen::Matrix<double, Eigen::Dynamic, 3> x(n, 3);
  for (Eigen::Index a = 0; a < n; ++a)
    x.row(a) = (c.x[s.particle[a]] - c.x[s.particle[0]]).transpose();
  const Eigen::Matrix<double, Eigen::Dynamic, 3> force = s.stiffness * x;
  const double secant = m_mesh.bend_scale * m_plates[plate].secant(force.cwiseProduct(x).sum());
  std::size_t at = 0;
  for (Eigen::Index a = 0; a < n; ++a) {
    c.force[s.particle[a]] -= secant * force.row(a).transpose();
    const double k = secant * (1 + damping);
    c.stiffness.add_isotropic_diagonal(s.particle[a], k * s.of_hinges(a, a));
    for (Eigen::Index b = a + 1; b < n; ++b, ++at)
      if (s.slot[at] >= 0)
        c.stiffness.add_isotropic(s.slot[at], k * s.of_hinges(a, b));
  }
}

double OrthotropicBendingEffect::energy_of_angles(const std::vector<Vec3>& x) const {
  std::vector<double> q(m_mesh.hinges.size());
  for (std::size_t h = 0; h < q.size(); ++h)
    q[h] = turning(h, measure_hinge(m_mesh.hinges[h], x, false));
  double sum = 0;
  for (const BendingPlate& plate : m_plates) {
    double s = 0;
    for (std::size_t a = 0; a < plate.hinge.size(); ++a)
      for (std::size_t b = 0; b < plate.hinge.size(); ++b)
        s += plate.stiffness(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) *
             q[plate.hinge[a]] * q[plate.hinge[b]];
    sum += plate.energy(s);
  }
  for (std::size_t h = 0; h < q.size(); ++h)
    sum += 0.5 * m_mesh.hinges[h].firmness * q[h] * q[h];
  return sum;
}

void OrthotropicBendingEffect::add_angles(StepContext& c, double damping) {
  std::vector<HingeAngle> angle(m_mesh.hinges.size());
  for (std::size_t h = 0; h < angle.size(); ++h)
    angle[h] = measure_hinge(m_mesh.hinges[h], c.x, true);
  for (std::size_t k = 0; k < m_plates.size(); ++k)
    add_angles_of_plate(c, k, angle, damping);
  for (std::size_t h = 0; h < angle.size(); ++h)
    if (m_mesh.hinges[h].firmness > 0)
      add_firmness(c, h, angle[h], damping);
}

/// Gauss-Newton: the second derivatives of the angles are left out. @param angle  of every hinge
void OrthotropicBendingEffect::add_angles_of_plate(StepContext& c, std::size_t plate_index,
                                                   const std::vector<HingeAngle>& angle,
                                                   double damping) {
  const BendingPlate& plate = m_plates[plate_index];
  const Stencil& s = m_stencils[plate_index];
  const auto m = static_cast<Eigen::Index>(plate.hinge.size());
  const auto n = static_cast<Eigen::Index>(s.particle.size());
  Eigen::VectorXd q(m); // how far each hinge is turned
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(m, 3 * n);
  for (Eigen::Index e = 0; e < m; ++e) {
    const int h = plate.hinge[e];
    q[e] = turning(h, angle[h]);
    for (int i = 0; i < 4; ++i) {
      const auto found =
          std::find(s.particle.begin(), s.particle.end(), m_mesh.hinges[h].particle[i]);
      const Eigen::Index column = 3 * (found - s.particle.begin());
      jacobian.block<1, 3>(e, column) += m_signed_length[h] * angle[h].gradient[i].transpose();
    }
  }
  const Eigen::VectorXd moments = plate.stiffness * q;
  const double secant = m_mesh.bend_scale * plate.secant(q.dot(moments));
  const Eigen::VectorXd force = jacobian.transpose() * moments;
  const Eigen::MatrixXd stiffness =
      secant * (1 + damping) * jacobian.transpose() * plate.stiffness * jacobian;
  std::size_t at = 0;
  for (Eigen::Index a = 0; a < n; ++a) {
    c.force[s.particle[a]] -= secant * force.segment<3>(3 * a);
    c.stiffness.add_diagonal(s.particle[a], stiffness.block<3, 3>(3 * a, 3 * a));
    for (Eigen::Index b = a + 1; b < n; ++b, ++at) {
      const bool upper = s.particle[a] < s.particle[b];
      const Eigen::Index row = 3 * (upper ? a : b), column = 3 * (upper ? b : a);
      c.stiffness.add_off_diagonal(s.slot[at], Mat3(stiffness.block<3, 3>(row, column)));
    }
  }
}

void OrthotropicBendingEffect::add_firmness(StepContext& c, std::size_t h, const HingeAngle& angle,
                                            double damping) {
  const Hinge& hinge = m_mesh.hinges[h];
  const double firmness = m_mesh.bend_scale * hinge.firmness,
               moment = firmness * m_signed_length[h] * turning(h, angle),
               k = firmness * m_signed_length[h] * m_signed_length[h] * (1 + damping);
  add_hinge(c, hinge, m_hinge_slots[h], angle, moment, k);
}

} // namespace sloper::cloth

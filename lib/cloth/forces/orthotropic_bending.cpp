#include <sloper/cloth/forces/dihedral_bending.hpp>
#include <sloper/cloth/forces/orthotropic_bending.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::cloth {

namespace {

/// By how much a mode of a plate may be stiffer than its hinges alone. At 1.5 the hinges of an
/// equilateral mesh have the rigidity of a cylinder, and an error of any mode at least halves in a
/// step; from 2 on it would grow.
constexpr double MOST_ABOVE_HINGES = 1.5;

/// Largest eigenvalue of a plate's stiffness relative to its diagonal.
double largest_eigenvalue(const Eigen::MatrixXd& relative) {
  if (relative.rows() == 3) {
    Eigen::SelfAdjointEigenSolver<Mat3> direct;
    return direct.computeDirect(Mat3(relative), Eigen::EigenvaluesOnly).eigenvalues()[2];
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(relative, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .tail(1)[0];
}

/// Diagonal of the plate's stiffness, scaled so that no mode exceeds it by more. m
Eigen::VectorXd hinges_alone(const Eigen::MatrixXd& stiffness) {
  const Eigen::VectorXd diagonal = stiffness.diagonal().cwiseMax(0);
  const Eigen::VectorXd root =
      diagonal.unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 0; });
  const Eigen::MatrixXd relative = root.asDiagonal() * stiffness * root.asDiagonal();
  return largest_eigenvalue(relative) / MOST_ABOVE_HINGES * diagonal;
}

} // namespace

OrthotropicBendingEffect::OrthotropicBendingEffect(const ClothMesh& mesh,
                                                   std::optional<std::vector<double>> rest_angle)
    : m_mesh(mesh), m_plates(make_bending_plates(mesh)), m_rest_angle(std::move(rest_angle)) {
  if (!m_rest_angle) {
    join_plates();
    return;
  }
  for (const BendingPlate& plate : m_plates)
    m_stencils.push_back(stencil_of(plate));
  sign_lengths();
}

/// Plates that do not soften go into the weights of pairs; the others stay.
void OrthotropicBendingEffect::join_plates() {
  m_exact = m_given = PairWeights(m_mesh.n_particles);
  std::vector<double> constant(m_mesh.hinges.size(), 0); // what the solver gets, by hinge
  std::vector<BendingPlate> others;
  for (BendingPlate& plate : m_plates) {
    Eigen::VectorXd given = hinges_alone(plate.stiffness);
    if (plate.soft_share > 0) {
      others.push_back(std::move(plate));
      m_given_of.push_back(std::move(given));
      continue;
    }
    for (std::size_t a = 0; a < plate.hinge.size(); ++a)
      constant[plate.hinge[a]] += given[static_cast<Eigen::Index>(a)];
    const Stencil s = stencil_of(plate);
    const Eigen::MatrixXd turning = coefficients(plate, s.particle);
    m_exact.add(s.particle, turning.transpose() * plate.stiffness * turning);
  }
  m_plates = std::move(others);
  for (std::size_t h = 0; h < constant.size(); ++h) {
    const Hinge& hinge = m_mesh.hinges[h];
    const Eigen::Map<const Eigen::Vector4d> c(hinge.coefficient.data());
    if (constant[h] > 0)
      m_given.add(hinge.particle, constant[h] * c * c.transpose());
  }
  m_exact.pack();
  m_given.pack();
}

/// #hinges by #particles: the curvature vectors of a plate's hinges from its particles.
Eigen::MatrixXd OrthotropicBendingEffect::coefficients(const BendingPlate& plate,
                                                       const std::vector<int>& particle) const {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(std::ssize(plate.hinge), std::ssize(particle));
  for (std::size_t e = 0; e < plate.hinge.size(); ++e) {
    const Hinge& hinge = m_mesh.hinges[plate.hinge[e]];
    for (int k = 0; k < 4; ++k) {
      const auto at = std::find(particle.begin(), particle.end(), hinge.particle[k]);
      out(static_cast<Eigen::Index>(e), at - particle.begin()) += hinge.coefficient[k];
    }
  }
  return out;
}

/// The particles of a plate's hinges.
OrthotropicBendingEffect::Stencil
OrthotropicBendingEffect::stencil_of(const BendingPlate& plate) const {
  Stencil s;
  for (int h : plate.hinge)
    for (int p : m_mesh.hinges[h].particle)
      if (std::find(s.particle.begin(), s.particle.end(), p) == s.particle.end())
        s.particle.push_back(p);
  return s;
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
  m_given.declare(couplings.isotropic);
  if (!m_rest_angle && m_plates.empty())
    return;
  auto& pairs = m_rest_angle ? couplings.full : couplings.isotropic;
  for (const Hinge& hinge : m_mesh.hinges)
    for (int a = 0; a < 4; ++a)
      for (int b = a + 1; b < 4; ++b)
        pairs.push_back({hinge.particle[a], hinge.particle[b]});
  for (const Stencil& s : m_stencils)
    for (std::size_t a = 0; a < s.particle.size(); ++a)
      for (std::size_t b = a + 1; b < s.particle.size(); ++b)
        pairs.push_back({s.particle[a], s.particle[b]});
}

void OrthotropicBendingEffect::bind(const BlockMatrix& matrix) {
  m_given.bind(matrix);
  if (m_rest_angle || !m_plates.empty())
    m_hinge_slots = find_hinge_slots(m_mesh, matrix);
  for (Stencil& s : m_stencils) {
    s.slot.clear();
    for (std::size_t a = 0; a < s.particle.size(); ++a)
      for (std::size_t b = a + 1; b < s.particle.size(); ++b)
        s.slot.push_back(matrix.slot(s.particle[a], s.particle[b]));
  }
}

/// A hinge is in up to three plates: each q is made once.
std::vector<Vec3> OrthotropicBendingEffect::curvature_vectors(const std::vector<Vec3>& x) const {
  std::vector<Vec3> q(m_mesh.hinges.size());
  for (std::size_t h = 0; h < q.size(); ++h) {
    const Hinge& hinge = m_mesh.hinges[h];
    q[h] = hinge.coefficient[0] * x[hinge.particle[0]];
    for (int k = 1; k < 4; ++k)
      q[h] += hinge.coefficient[k] * x[hinge.particle[k]];
  }
  return q;
}

double OrthotropicBendingEffect::energy(const std::vector<Vec3>& x) const {
  if (m_rest_angle)
    return m_mesh.bend_scale * energy_of_angles(x);
  double sum = m_exact.energy(x);
  const std::vector<Vec3> q = m_plates.empty() ? std::vector<Vec3>() : curvature_vectors(x);
  for (const BendingPlate& plate : m_plates) {
    double s = 0;
    for (std::size_t a = 0; a < plate.hinge.size(); ++a)
      for (std::size_t b = 0; b < plate.hinge.size(); ++b)
        s += plate.stiffness(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) *
             q[plate.hinge[a]].dot(q[plate.hinge[b]]);
    sum += plate.energy(s);
  }
  return m_mesh.bend_scale * sum;
}

void OrthotropicBendingEffect::add(StepContext& c) {
  const double damping = m_mesh.fabrics.empty() ? 0 : m_mesh.fabrics[0].damping_s / c.h;
  if (m_rest_angle)
    add_angles(c, damping);
  else
    add_vectors(c, damping);
}

/// Moments dE/dq of a plate to those of its hinges. @param given  of m_given_of
void OrthotropicBendingEffect::add_moments(const BendingPlate& plate, const Eigen::VectorXd& given,
                                           const std::vector<Vec3>& q) {
  const auto m = static_cast<Eigen::Index>(plate.hinge.size());
  Eigen::Matrix<double, 3, Eigen::Dynamic> turned(3, m);
  for (Eigen::Index a = 0; a < m; ++a)
    turned.col(a) = q[plate.hinge[a]];
  const Eigen::Matrix<double, 3, Eigen::Dynamic> moment = turned * plate.stiffness;
  const double secant = plate.secant(moment.cwiseProduct(turned).sum());
  for (Eigen::Index a = 0; a < m; ++a) {
    m_moment[plate.hinge[a]] += secant * moment.col(a);
    m_stiffness[plate.hinge[a]] += secant * given[a];
  }
}

void OrthotropicBendingEffect::add_vectors(StepContext& c, double damping) {
  m_exact.add_force(c.x, m_mesh.bend_scale, c.force);
  m_given.add_stiffness(m_mesh.bend_scale * (1 + damping), c.stiffness);
  if (m_plates.empty())
    return;
  const std::vector<Vec3> q = curvature_vectors(c.x);
  m_moment.assign(q.size(), Vec3::Zero());
  m_stiffness.assign(q.size(), 0);
  for (std::size_t p = 0; p < m_plates.size(); ++p)
    add_moments(m_plates[p], m_given_of[p], q);
  for (std::size_t h = 0; h < q.size(); ++h) {
    const Vec3 moment = m_mesh.bend_scale * m_moment[h];
    const double k = m_mesh.bend_scale * m_stiffness[h] * (1 + damping);
    add_hinge_vector(m_mesh.hinges[h], m_hinge_slots[h], moment, k, c.force, c.stiffness);
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

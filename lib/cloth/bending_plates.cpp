#include <sloper/cloth/bending_plates.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::cloth {

namespace {

/// Smallest eigenvalue of the normal equations of unit rows with which a triangle's own hinges are
/// enough: three at 60 degrees have 0.5, those of a square cut in two 0.2. Below, as of slivers,
/// the quadratic would follow rounding instead of shape.
constexpr double WELL_POSED = 0.05;
/// Weight of the neighbours' hinges in the least squares where the own ones are not enough.
constexpr double NEIGHBOUR_WEIGHT = 0.25;
/// Share of their trace that is added to normal equations that the neighbours did not make regular
/// either (a strap one triangle wide): the curvature is then the smallest that explains the hinges.
constexpr double REGULARISATION = 1e-3;

/// A triangle laid flat in the plane of another one.
struct Laid {
  int triangle;
  std::array<Vec2, 3> p;
};

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// The triangle beyond corner `k`'s edge of `from`, unfolded about it.
Laid unfold(const ClothMesh& mesh, const Laid& from, int k, int triangle, int corner) {
  const RestTriangle &s = mesh.triangles[from.triangle], &t = mesh.triangles[triangle];
  const int next = (k + 1) % 3, other = (corner + 1) % 3, apex = (corner + 2) % 3;
  const bool opposite = t.particle[other] == s.particle[k]; // as two sides of an edge run
  const int begin = opposite ? other : corner, end = opposite ? corner : other;
  const Vec2 edge = t.flat[end] - t.flat[begin], to_apex = t.flat[apex] - t.flat[begin];
  const double along = to_apex.dot(edge) / edge.squaredNorm(),
               height = std::abs(cross(edge, to_apex)) / edge.norm();
  const Vec2 here = from.p[next] - from.p[k], left = Vec2(-here.y(), here.x()).normalized();
  const double side = cross(here, from.p[(k + 2) % 3] - from.p[k]) > 0 ? -1 : 1;
  Laid out;
  out.triangle = triangle;
  out.p[begin] = from.p[k];
  out.p[end] = from.p[next];
  out.p[apex] = from.p[k] + along * here + side * height * left;
  return out;
}

/// Hinges of the corners of each triangle; -1 for none.
std::vector<std::array<int, 3>> hinges_of_corners(const ClothMesh& mesh) {
  std::vector<std::array<int, 3>> out(mesh.triangles.size(), {-1, -1, -1});
  for (std::size_t h = 0; h < mesh.hinges.size(); ++h)
    for (int side = 0; side < 2; ++side)
      if (!mesh.hinges[h].pressed)
        out[mesh.hinges[h].triangle[side]][mesh.hinges[h].corner[side]] = static_cast<int>(h);
  return out;
}

/// Gathers the equations of one triangle.
class Patch {
public:
  Patch(const ClothMesh& mesh, const std::vector<std::array<int, 3>>& hinges, int triangle)
      : m_mesh(mesh), m_hinges(hinges) {
    const Laid own{triangle, mesh.triangles[triangle].flat};
    std::vector<Laid> around;
    add_hinges_of(own, 1, &around);
    m_is_well_posed = exceeds(normal_equations(), WELL_POSED);
    if (m_is_well_posed)
      return;
    for (const Laid& laid : around)
      add_hinges_of(laid, NEIGHBOUR_WEIGHT, nullptr);
  }
  const std::vector<int>& hinges() const { return m_hinge; }
  /// 3 by m: (x_uu, x_vv, sqrt(2) x_uv) from the hinges' vectors.
  Eigen::MatrixXd inverse() const {
    Mat3 normal = normal_equations();
    if (!m_is_well_posed && !exceeds(normal, REGULARISATION))
      normal += REGULARISATION * normal.trace() * Mat3::Identity();
    const Mat3 inverse = normal.inverse();
    Eigen::MatrixXd out(3, static_cast<Eigen::Index>(m_row.size()));
    for (std::size_t e = 0; e < m_row.size(); ++e) {
      const double length = m_row[e].norm();
      out.col(static_cast<Eigen::Index>(e)) =
          m_weight[e] / (length * length) * (inverse * m_row[e]);
    }
    return out;
  }

  /// m by m: by how much hinges turn otherwise than the quadratic does, over their rows' lengths
  /// and by the root of their weights. 0 where there are three hinges.
  Eigen::MatrixXd residual(const Eigen::MatrixXd& curvature) const {
    const auto m = static_cast<Eigen::Index>(m_row.size());
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(m, m);
    for (Eigen::Index e = 0; e < m; ++e) {
      const double length = m_row[e].norm();
      out(e, e) = 1 / length;
      out.row(e) -= m_row[e].transpose() / length * curvature;
      out.row(e) *= std::sqrt(m_weight[e]);
    }
    return out;
  }

private:
  void add_hinges_of(const Laid& laid, double weight, std::vector<Laid>* around) {
    for (int k = 0; k < 3; ++k) {
      const int h = m_hinges[laid.triangle][k];
      if (h < 0 || std::find(m_hinge.begin(), m_hinge.end(), h) != m_hinge.end())
        continue;
      const Hinge& hinge = m_mesh.hinges[h];
      const int side = hinge.triangle[0] == laid.triangle ? 0 : 1;
      const Laid beyond = unfold(m_mesh, laid, k, hinge.triangle[1 - side], hinge.corner[1 - side]);
      const Vec2 &p = laid.p[k], &q = laid.p[(k + 1) % 3], middle = 0.5 * (p + q);
      const bool forward = m_mesh.triangles[laid.triangle].particle[k] == hinge.particle[0];
      const std::array<Vec2, 4> at{
          forward ? p : q, forward ? q : p,
          side == 0 ? laid.p[(k + 2) % 3] : beyond.p[(hinge.corner[0] + 2) % 3],
          side == 1 ? laid.p[(k + 2) % 3] : beyond.p[(hinge.corner[1] + 2) % 3]};
      Vec3 row = Vec3::Zero();
      for (int j = 0; j < 4; ++j) {
        const Vec2 d = at[j] - middle;
        row += hinge.coefficient[j] *
               Vec3(0.5 * d.x() * d.x(), 0.5 * d.y() * d.y(), std::sqrt(0.5) * d.x() * d.y());
      }
      if (around)
        around->push_back(beyond);
      if (!(row.norm() > 0))
        continue;
      m_hinge.push_back(h);
      m_row.push_back(row);
      m_weight.push_back(weight);
    }
  }
  Mat3 normal_equations() const {
    Mat3 sum = Mat3::Zero();
    for (std::size_t e = 0; e < m_row.size(); ++e)
      sum += m_weight[e] / m_row[e].squaredNorm() * m_row[e] * m_row[e].transpose();
    return sum;
  }
  /// Whether the smallest eigenvalue is above `bound`.
  static bool exceeds(const Mat3& symmetric, double bound) {
    return Eigen::LLT<Mat3>(symmetric - bound * Mat3::Identity()).info() == Eigen::Success;
  }

  const ClothMesh& m_mesh;
  const std::vector<std::array<int, 3>>& m_hinges;
  std::vector<int> m_hinge;
  std::vector<Vec3> m_row;
  std::vector<double> m_weight;
  bool m_is_well_posed = false; // by the triangle's own hinges
};

} // namespace

bool bends_by_direction(const Fabric& fabric) {
  return fabric.bend_warp_n_m > 0 || fabric.bend_weft_n_m > 0 || fabric.bend_bias_n_m > 0 ||
         fabric.bend_soft_share > 0;
}

double least_bias_rigidity(double warp, double weft) {
  const double difference = std::sqrt(warp) - std::sqrt(weft);
  return 0.25 * difference * difference;
}

PlateRigidity plate_rigidity(const Fabric& fabric) {
  PlateRigidity plate;
  plate.warp = fabric.bend_warp_n_m > 0 ? fabric.bend_warp_n_m : fabric.bend_n_m;
  plate.weft = fabric.bend_weft_n_m > 0 ? fabric.bend_weft_n_m : fabric.bend_n_m;
  const double yarns = 0.25 * (plate.warp + plate.weft), huber = std::sqrt(plate.warp * plate.weft);
  const double bias =
      fabric.bend_bias_n_m > 0
          ? std::max(fabric.bend_bias_n_m, least_bias_rigidity(plate.warp, plate.weft))
          : yarns + 0.5 * huber;
  plate.twist = std::max(bias - yarns, 0.0);
  plate.coupling = std::clamp(2 * (bias - yarns - plate.twist), -huber, 0.0);
  return plate;
}

double bias_of_strip(double warp, double weft, double strip) {
  constexpr double MOST = 1.25;
  const double twist_compliance = 4 / strip - 1 / warp - 1 / weft;
  if (!(twist_compliance > 0))
    return MOST * strip;
  return std::min(0.25 * (warp + weft) + 1 / twist_compliance, MOST * strip);
}

double rigidity_along(const PlateRigidity& plate, double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad), c2 = c * c, s2 = s * s;
  return plate.warp * c2 * c2 + plate.weft * s2 * s2 +
         (2 * plate.coupling + 4 * plate.twist) * s2 * c2;
}

double BendingPlate::energy(double s) const {
  if (soft_share <= 0)
    return 0.5 * s;
  return 0.5 * (1 - soft_share) * s +
         soft_share * soft_energy * (std::sqrt(1 + s / soft_energy) - 1);
}

double BendingPlate::secant(double s) const {
  return soft_share <= 0 ? 1 : 1 - soft_share + soft_share / std::sqrt(1 + s / soft_energy);
}

std::vector<BendingPlate> make_bending_plates(const ClothMesh& mesh) {
  const auto hinges = hinges_of_corners(mesh);
  std::vector<Mat3> rigidity;
  for (const Fabric& fabric : mesh.fabrics) {
    const PlateRigidity r = plate_rigidity(fabric);
    rigidity.push_back(Mat3::Zero());
    rigidity.back() << r.weft, r.coupling, 0, r.coupling, r.warp, 0, 0, 0, 2 * r.twist;
  }
  std::vector<BendingPlate> plates;
  plates.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Patch patch(mesh, hinges, static_cast<int>(t));
    if (patch.hinges().empty())
      continue;
    const RestTriangle& triangle = mesh.triangles[t];
    const Fabric& fabric = mesh.fabrics[triangle.fabric];
    const double area = 0.5 * std::abs(cross(triangle.flat[1] - triangle.flat[0],
                                             triangle.flat[2] - triangle.flat[0]));
    const Eigen::MatrixXd inverse = patch.inverse();
    BendingPlate plate;
    plate.hinge = patch.hinges();
    plate.stiffness = area * inverse.transpose() * rigidity[triangle.fabric] * inverse;
    const double mean = 0.5 * (rigidity[triangle.fabric](0, 0) + rigidity[triangle.fabric](1, 1));
    if (plate.hinge.size() > 3) { // an edge must not curl away from the quadratic at no cost
      const Eigen::MatrixXd residual = patch.residual(inverse);
      plate.stiffness += area * mean * residual.transpose() * residual;
    }
    plate.soft_share = fabric.bend_soft_share;
    if (plate.soft_share > 0)
      plate.soft_energy =
          std::max(area * mean / (fabric.bend_soft_radius_m * fabric.bend_soft_radius_m), 1e-300);
    plates.push_back(std::move(plate));
  }
  return plates;
}

} // namespace sloper::cloth

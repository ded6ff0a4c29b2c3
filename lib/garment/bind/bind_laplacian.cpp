#include <garment/bind/bind_laplacian.hpp>

#include <algorithm>
#include <map>

namespace sloper::garment {

SurfaceOperators surface_operators(const std::vector<Vec3>& x,
                                   const std::vector<Triangle>& triangles) {
  SurfaceOperators s;
  s.mass = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(x.size()));
  std::map<std::array<int, 2>, double> cotangent;
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
      const Vec3 u = x[a] - x[c], v = x[b] - x[c];
      const double cross = std::max(u.cross(v).norm(), 1e-12);
      s.mass[c] += cross / 6;
      cotangent[{std::min(a, b), std::max(a, b)}] += 0.5 * u.dot(v) / cross;
    }
  const double floor_mass =
      1e-3 *
      std::max(s.mass.sum() / static_cast<double>(std::max<Eigen::Index>(s.mass.size(), 1)), 1e-9);
  s.mass = s.mass.cwiseMax(floor_mass);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(4 * cotangent.size());
  for (const auto& [edge, value] : cotangent) {
    const double c = std::clamp(value, 0.05, 20.0);
    entries.emplace_back(edge[0], edge[0], c);
    entries.emplace_back(edge[1], edge[1], c);
    entries.emplace_back(edge[0], edge[1], -c);
    entries.emplace_back(edge[1], edge[0], -c);
  }
  s.stiffness.resize(s.mass.size(), s.mass.size());
  s.stiffness.setFromTriplets(entries.begin(), entries.end());
  return s;
}

} // namespace sloper::garment

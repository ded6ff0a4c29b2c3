#pragma once
/// Scans for the tests: mannequins of our own, and what users do to scans.
#include <Eigen/Geometry>
#include <sloper/base/random.hpp>
#include <sloper/body/measure_scan.hpp>
#include <support/made_figure.hpp>

#include <cmath>
#include <set>

namespace sloper::test {

/// Without the runs that measure the spread, unless asked for.
inline body::MeasuredScan measure(const TriangleMesh& scan, body::ScanOptions options = {}) {
  options.jitter = std::max(0, options.jitter);
  return body::measure_scan(scan, "scan.obj", "", options, silent_reporter());
}

/// A landmark in the scan's own frame.
inline Vec3 in_scan(const body::Body& body, const std::string& name) {
  const Mat4 back = body.scan_to_body.inverse();
  return back.block<3, 3>(0, 0) * body.landmark(name) + back.block<3, 1>(0, 3);
}

inline TriangleMesh moved(TriangleMesh mesh, const Eigen::Matrix3d& linear, const Vec3& shift) {
  for (Vec3& p : mesh.positions)
    p = linear * p + shift;
  return mesh;
}

inline Eigen::Matrix3d turn_about_y(double degrees) {
  return Eigen::AngleAxisd(degrees * 3.14159265358979 / 180, Vec3::UnitY()).toRotationMatrix();
}

/// Noise of `sigma` along the normals, roughly Gaussian.
inline TriangleMesh with_noise(TriangleMesh mesh, double sigma, std::uint64_t seed) {
  Random random(seed);
  const std::vector<Vec3> normals = vertex_normals(mesh);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    double sum = -6;
    for (int k = 0; k < 12; ++k)
      sum += random.uniform();
    mesh.positions[v] += sigma * sum * normals[v];
  }
  return mesh;
}

/// Every edge has exactly two faces that run along it in opposite directions.
inline bool is_closed_and_oriented(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> count;
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k)
      ++count[{t[k], t[(k + 1) % 3]}];
  for (const auto& [edge, n] : count) {
    if (n != 1)
      return false;
    const auto other = count.find({edge.second, edge.first});
    if (other == count.end() || other->second != 1)
      return false;
  }
  return !count.empty();
}

inline double volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles)
    sum += mesh.positions[t[0]].dot(mesh.positions[t[1]].cross(mesh.positions[t[2]])) / 6;
  return sum;
}

} // namespace sloper::test

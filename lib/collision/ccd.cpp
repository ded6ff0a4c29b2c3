#include <collision/ccd.hpp>

#include <collision/distance.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::collision {

namespace {

constexpr double CLOSE_ENOUGH = 0.1; ///< impact is called when this fraction of the initial clearance is left
constexpr int MAX_ADVANCES = 10000;

/// Advances time by (distance - min) / (speed bound) until the clearance is used up. distance(t) is exact at t.
template<class Distance> std::optional<double> advance(double speed, double min_distance, const Distance& distance) {
  const double start = distance(0.0);
  if (start <= 0) return 0.0;
  if (speed <= 0) return std::nullopt;                      // distances do not change
  const double floor = std::min(min_distance, 0.9 * start); // nearer than the minimum: keep a share of what there is
  const double enough = CLOSE_ENOUGH * (start - floor);
  double t = 0;
  for (int i = 0; i < MAX_ADVANCES; ++i) {
    const double clearance = distance(t) - floor;
    if (i > 0 && clearance <= enough) return t;
    t += 0.9 * clearance / speed;
    if (t > 1) return std::nullopt;
  }
  return t;
}

} // namespace

std::optional<double> vertex_face_impact(const Vec3& p_t0, const Vec3& p_t1, const std::array<Vec3, 3>& t_t0, const std::array<Vec3, 3>& t_t1,
                                         double min_distance) {
  // the common motion takes no time from the clearance
  Vec3 dp = p_t1 - p_t0, d[3];
  for (int k = 0; k < 3; ++k) d[k] = t_t1[k] - t_t0[k];
  const Vec3 mean = 0.25 * (dp + d[0] + d[1] + d[2]);
  dp -= mean;
  double fastest = 0;
  for (Vec3& v : d) {
    v -= mean;
    fastest = std::max(fastest, v.norm());
  }
  return advance(dp.norm() + fastest, min_distance, [&](double t) {
    return std::sqrt(point_triangle(p_t0 + t * dp, t_t0[0] + t * d[0], t_t0[1] + t * d[1], t_t0[2] + t * d[2]).squared_distance);
  });
}

std::optional<double> edge_edge_impact(const std::array<Vec3, 2>& a_t0, const std::array<Vec3, 2>& a_t1, const std::array<Vec3, 2>& b_t0,
                                       const std::array<Vec3, 2>& b_t1, double min_distance) {
  Vec3 d[4] = {a_t1[0] - a_t0[0], a_t1[1] - a_t0[1], b_t1[0] - b_t0[0], b_t1[1] - b_t0[1]};
  const Vec3 mean = 0.25 * (d[0] + d[1] + d[2] + d[3]);
  for (Vec3& v : d) v -= mean;
  const double speed = std::sqrt(std::max(d[0].squaredNorm(), d[1].squaredNorm())) + std::sqrt(std::max(d[2].squaredNorm(), d[3].squaredNorm()));
  return advance(speed, min_distance, [&](double t) {
    return std::sqrt(edge_edge(a_t0[0] + t * d[0], a_t0[1] + t * d[1], b_t0[0] + t * d[2], b_t0[1] + t * d[3]).squared_distance);
  });
}

} // namespace sloper::collision

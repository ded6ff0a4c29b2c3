#pragma once
/// The heavy elastica, theta'' = -Gamma (1 - s) cos(theta), theta(0) = 0, theta'(1) = 0: what a
/// cantilever under its own weight comes to, Gamma = rho g L^3 / B.
#include <Eigen/LU>
#include <cmath>
#include <sloper/geometry/types.hpp>
#include <vector>

namespace sloper::cloth {

/// H/W of the heavy elastica, shot from the free end: theta(1) = tip, theta'(1) = 0, until theta(0)
/// = 0.
inline double elastica_ratio(double gamma) {
  double h = 0, w = 0;
  auto shoot = [&](double tip) { // returns theta at the clamp
    const int n = 20000;
    const double ds = 1.0 / n;
    double theta = tip, d = 0; // d: along r = 1 - s, the length from the free end
    h = w = 0;
    for (int i = 0; i < n; ++i) {
      const double r = i * ds;
      auto f = [&](double at, double angle) {
        return -gamma * at * std::cos(angle);
      }; // theta'' = gamma r cos(theta), theta downwards
      const double k1 = d, l1 = f(r, theta), k2 = d + 0.5 * ds * l1,
                   l2 = f(r + 0.5 * ds, theta + 0.5 * ds * k1), k3 = d + 0.5 * ds * l2,
                   l3 = f(r + 0.5 * ds, theta + 0.5 * ds * k2), k4 = d + ds * l3,
                   l4 = f(r + ds, theta + ds * k3);
      const double next = theta + ds / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
      w += 0.5 * ds * (std::cos(theta) + std::cos(next));
      h += 0.5 * ds * (std::sin(theta) + std::sin(next));
      theta = next;
      d += ds / 6 * (l1 + 2 * l2 + 2 * l3 + l4);
      if (theta < -0.1)
        return theta;
    }
    return theta;
  };
  double low = 0, high = 0.5 * M_PI;
  for (int k = 0; k < 60; ++k) {
    const double mid = 0.5 * (low + high);
    (shoot(mid) < 0 ? low : high) = mid;
  }
  shoot(high);
  return h / w;
}

/// The section of a sleeve that hangs over a rod: the heavy elastica closed to a loop, symmetric,
/// x'= cos(theta), y' = -sin(theta), theta'' = -Gamma (1 - s) cos(theta) - N sin(theta), theta(0) =
/// 0, theta(1) = pi, x(1) = 0; Gamma = rho g l^3 / B, l half the girth (the unit of the result). N
/// is the pull across the bottom. Shot by Newton's method, followed from the circle of Gamma = 0.
inline std::vector<Vec2> heavy_loop(double gamma) {
  constexpr int N_STEPS = 2000, N_LOADS = 40;
  std::vector<Vec2> half;
  const auto shoot = [&](double load, double slope, double pull) { // theta(1) - pi and x(1)
    const double ds = 1.0 / N_STEPS;
    const auto f = [&](double s, double theta) {
      return -load * (1 - s) * std::cos(theta) - pull * std::sin(theta);
    };
    double theta = 0, d = slope;
    Vec2 at = Vec2::Zero();
    half.assign(1, at);
    for (int i = 0; i < N_STEPS; ++i) {
      const double s = i * ds, k1 = d, l1 = f(s, theta), k2 = d + 0.5 * ds * l1,
                   l2 = f(s + 0.5 * ds, theta + 0.5 * ds * k1), k3 = d + 0.5 * ds * l2,
                   l3 = f(s + 0.5 * ds, theta + 0.5 * ds * k2), k4 = d + ds * l3,
                   l4 = f(s + ds, theta + ds * k3);
      const double next = theta + ds / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
      at += 0.5 * ds * Vec2(std::cos(theta) + std::cos(next), -std::sin(theta) - std::sin(next));
      half.push_back(at);
      theta = next;
      d += ds / 6 * (l1 + 2 * l2 + 2 * l3 + l4);
    }
    return Vec2(theta - M_PI, at.x());
  };
  double slope = M_PI, pull = 0;
  for (int k = 1; k <= N_LOADS; ++k) {
    const double load = gamma * k / N_LOADS;
    for (int newton = 0; newton < 30; ++newton) {
      const Vec2 r = shoot(load, slope, pull);
      if (r.norm() < 1e-10)
        break;
      const double h = 1e-6;
      Eigen::Matrix2d jacobian;
      jacobian.col(0) = (shoot(load, slope + h, pull) - r) / h;
      jacobian.col(1) = (shoot(load, slope, pull + h) - r) / h;
      const Vec2 step = jacobian.fullPivLu().solve(r);
      slope -= step[0];
      pull -= step[1];
    }
  }
  shoot(gamma, slope, pull);
  std::vector<Vec2> loop = half;
  for (std::size_t k = half.size() - 1; k-- > 0;)
    loop.emplace_back(-half[k].x(), half[k].y());
  return loop;
}

} // namespace sloper::cloth

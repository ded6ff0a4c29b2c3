#pragma once
/// The heavy elastica, theta'' = -Gamma (1 - s) cos(theta), theta(0) = 0, theta'(1) = 0: what a
/// cantilever under its own weight comes to, Gamma = rho g L^3 / B.
#include <cmath>

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
      if (theta < -0.1) return theta;
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

} // namespace sloper::cloth

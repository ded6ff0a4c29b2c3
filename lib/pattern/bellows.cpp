#include <pattern/bellows.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::pattern {
namespace {

constexpr int STEPS = 400;
constexpr double WANTED_DEPTH = 0.06; // m: shallow waves, as long as they are not too short for the mesh

} // namespace

Bellows::Bellows(double top, double stretch, double excess, double shortest) : m_top(top), m_stretch(stretch) {
  if (!(excess > 1e-4) || !(stretch > shortest)) return;
  const double rest = std::max(1 - excess / stretch, 0.3);
  double low = 0, high = 1.9; // J0 falls from 1 to 0.28 in between
  for (int k = 0; k < 60; ++k) {
    const double phi = 0.5 * (low + high);
    (std::cyl_bessel_j(0.0, phi) > rest ? low : high) = phi;
  }
  const double phi = 0.5 * (low + high);
  const double waves = std::clamp(std::ceil(stretch * phi / (M_PI * WANTED_DEPTH)), 1.0, std::max(std::floor(stretch / shortest), 1.0));
  const double ds = stretch / STEPS;
  m_table.push_back(Vec2(0, 0));
  for (int k = 0; k < STEPS; ++k) {
    const double slope = phi * std::sin(2 * M_PI * waves * (k + 0.5) / STEPS);
    m_table.push_back(m_table.back() + ds * Vec2(std::cos(slope), std::sin(slope)));
    m_depth = std::max(m_depth, m_table.back().y());
  }
  m_excess = stretch - m_table.back().x();
}

Vec2 Bellows::at(double v) const {
  const double s = m_top - v;
  if (m_table.empty() || s <= 0) return {v, 0};
  if (s >= m_stretch) return {v + m_excess, 0};
  const double x = s / m_stretch * STEPS;
  const std::size_t k = std::min(static_cast<std::size_t>(x), static_cast<std::size_t>(STEPS - 1));
  const Vec2 p = m_table[k] + (x - static_cast<double>(k)) * (m_table[k + 1] - m_table[k]);
  return {m_top - p.x(), p.y()};
}

} // namespace sloper::pattern

#include <pattern/surfaces/section_ring.hpp>
#include <sloper/base/units.hpp>

#include <cmath>

namespace sloper::pattern {

Vec2 direction(int k) {
  const double a = 2 * units::PI * k / RING_ANGLES;
  return {std::sin(a), std::cos(a)}; // 0 forwards, a quarter outwards
}

Ring empty_ring() {
  Ring r;
  r.fill(-1e300);
  return r;
}

void include(Ring& ring, const Vec2& p) {
  for (int d = 0; d < RING_ANGLES; ++d)
    ring[d] = std::max(ring[d], p.dot(direction(d)));
}

std::vector<Ring> filled(std::vector<Ring> rows) {
  const auto have = [&](std::size_t k) { return rows[k][0] > -1e299; };
  for (std::size_t k = 1; k < rows.size(); ++k)
    if (!have(k) && have(k - 1))
      rows[k] = rows[k - 1];
  for (std::size_t k = rows.size() - 1; k > 0; --k)
    if (!have(k - 1) && have(k))
      rows[k - 1] = rows[k];
  return rows;
}

std::vector<Ring> joined(const std::vector<Ring>& rows, int reach) {
  std::vector<Ring> out = rows;
  const int n = std::ssize(rows);
  for (int k = 0; k < n; ++k)
    for (int o = std::max(0, k - reach); o <= std::min(n - 1, k + reach); ++o)
      for (std::size_t d = 0; d < RING_ANGLES; ++d)
        out[k][d] = std::max(out[k][d], rows[o][d]);
  return out;
}

std::vector<Ring> smooth(const std::vector<Ring>& rows, int reach) {
  std::vector<Ring> out = rows;
  for (std::size_t d = 0; d < RING_ANGLES; ++d) {
    std::vector<double> column;
    for (const Ring& r : rows)
      column.push_back(r[d]);
    column = averaged(column, reach);
    for (std::size_t k = 0; k < rows.size(); ++k)
      out[k][d] = column[k];
  }
  return out;
}

Ring radii(const Ring& support, const Vec2& center, double grown) {
  static const std::vector<double> cosine = [] {
    std::vector<double> c;
    for (int k = 0; k < RING_ANGLES; ++k)
      c.push_back(std::cos(2 * units::PI * k / RING_ANGLES));
    return c;
  }();
  Ring own, out;
  for (int k = 0; k < RING_ANGLES; ++k)
    own[k] = std::max(support[k] - center.dot(direction(k)) + grown, 1e-3);
  for (int k = 0; k < RING_ANGLES; ++k) {
    double r = 1e300;
    for (int o = -RING_ANGLES / 4 + 4; o <= RING_ANGLES / 4 - 4; ++o)
      r = std::min(r, own[(k + o + RING_ANGLES) % RING_ANGLES] / cosine[std::abs(o)]);
    out[k] = r;
  }
  return out;
}

std::vector<double> least(const std::vector<double>& in, int reach) {
  std::vector<double> out = in;
  const int n = std::ssize(in);
  for (int k = 0; k < n; ++k)
    for (int o = std::max(0, k - reach); o <= std::min(n - 1, k + reach); ++o)
      out[k] = std::min(out[k], in[o]);
  return out;
}

} // namespace sloper::pattern

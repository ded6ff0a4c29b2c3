#include <pattern/read/ring_repair.hpp>
#include <sloper/base/units.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace sloper::pattern {
namespace {

constexpr double DEEPEST_SLIT = 0.02;              // m; notches are cut 3 to 10 mm deep
constexpr double OVERSHOOT = 1e-3;                 // m: a shorter slit is none
constexpr double SAME_POINT = 2e-4;                // m
const double FOLDS_BACK = units::radians(3);       // between the stretch out and the stretch back
const double OVERSHOOT_ANGLE = units::radians(15); // the same of an overshoot, which rounding bends
const double LEAVES = units::radians(30);
constexpr double SYMMETRIC = 0.003; // m
constexpr double ON_FOLD = 1e-3;    // m

double wedge(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

std::array<Vec2, 2> bounds_of(const PointRing& ring) {
  std::array<Vec2, 2> b = {Vec2::Constant(1e300), Vec2::Constant(-1e300)};
  for (const Vec2& p : ring) {
    b[0] = b[0].cwiseMin(p);
    b[1] = b[1].cwiseMax(p);
  }
  return b;
}

double angle_between(const Vec2& a, const Vec2& b) {
  return std::abs(std::atan2(wedge(a, b), a.dot(b)));
}

/// Whether the outline turns back at point k, within a slit's depth, and leaves the slit around a
/// corner: the legs of a dart go on.
bool turns_back(const PointRing& ring, std::size_t k) {
  const std::size_t n = ring.size();
  const auto at = [&](std::size_t steps) { return ring[(k + n + steps) % n]; };
  const Vec2 in = at(n - 1) - at(0), out = at(1) - at(0);
  const double depth = std::min(in.norm(), out.norm());
  if (!(depth < DEEPEST_SLIT))
    return false;
  if (depth < 1e-9)
    return true;
  const Vec2 leaves = in.norm() < out.norm() ? Vec2(at(n - 2) - at(n - 1)) : Vec2(at(2) - at(1));
  if (angle_between(in.norm() < out.norm() ? in : out, leaves) < LEAVES)
    return false;
  return angle_between(in, out) < (depth < OVERSHOOT ? OVERSHOOT_ANGLE : FOLDS_BACK);
}

/// Point where the lines of two sides meet, or the middle of their ends where they are all but one
/// line.
Vec2 mitre(const Vec2& p, const Vec2& along, const Vec2& q, const Vec2& other) {
  const double sine = wedge(along, other);
  if (std::abs(sine) < 1e-6)
    return 0.5 * (p + q);
  return p + wedge(q - p, other) / sine * along;
}

} // namespace

std::vector<Vec2> take_slits_off(PointRing& ring) {
  std::vector<Vec2> slits;
  for (std::size_t k = 0; k < ring.size() && ring.size() > 3;) {
    const std::size_t n = ring.size(), before = (k + n - 1) % n, after = (k + 1) % n;
    if (!turns_back(ring, k)) {
      ++k;
      continue;
    }
    const double in = (ring[before] - ring[k]).norm(), out = (ring[after] - ring[k]).norm();
    const Vec2 base = in < out ? ring[before] : ring[after];
    if (std::min(in, out) > OVERSHOOT)
      slits.push_back(base);
    const bool same = (ring[before] - ring[after]).norm() < SAME_POINT;
    std::vector<std::size_t> drop = {k};
    if (same)
      drop.push_back(after);
    std::sort(drop.rbegin(), drop.rend());
    for (std::size_t i : drop)
      ring.erase(ring.begin() + static_cast<long>(i));
    k = k > 2 ? k - 2 : 0; // what is left may turn back in its turn
  }
  return slits;
}

PointRing inset(const PointRing& ring, const std::vector<double>& by,
                std::vector<std::size_t>& corners) {
  const std::size_t n = ring.size();
  std::vector<std::size_t> sides(n);
  std::iota(sides.begin(), sides.end(), std::size_t{0});
  std::vector<Vec2> along(n), start(n);
  for (std::size_t k = 0; k < n; ++k) {
    along[k] = (ring[(k + 1) % n] - ring[k]).normalized();
    start[k] = ring[k] + by[k] * Vec2(-along[k].y(), along[k].x());
  }
  const auto end = [&](std::size_t k) { return Vec2(start[k] + ring[(k + 1) % n] - ring[k]); };
  PointRing out; // out[i] is where side i of those that are left begins
  for (;;) {
    out.clear();
    const std::size_t m = sides.size();
    for (std::size_t i = 0; i < m; ++i) {
      const std::size_t a = sides[(i + m - 1) % m], b = sides[i];
      Vec2 p = mitre(start[a], along[a], start[b], along[b]);
      if (std::abs(wedge(along[a], along[b])) < 1e-6)
        p = 0.5 * (end(a) + start[b]);
      out.push_back(p);
    }
    std::size_t worst = m;
    double most = -1e-9; // m backwards
    for (std::size_t i = 0; i < m; ++i)
      if (const double length = (out[(i + 1) % m] - out[i]).dot(along[sides[i]]); length < most) {
        most = length;
        worst = i;
      }
    if (worst == m || m <= 3)
      break;
    sides.erase(sides.begin() + static_cast<long>(worst));
  }
  std::vector<std::size_t> moved;
  for (std::size_t corner : corners) {
    const auto next = std::lower_bound(sides.begin(), sides.end(), corner);
    const std::size_t index =
        next == sides.end() ? 0 : static_cast<std::size_t>(next - sides.begin());
    if (std::find(moved.begin(), moved.end(), index) == moved.end())
      moved.push_back(index);
  }
  std::sort(moved.begin(), moved.end());
  corners = std::move(moved);
  return out;
}

PointRing without_allowance(const PointRing& ring, const DxfBlock& block, double unit,
                            double allowance, std::vector<std::size_t>& corners) {
  std::vector<double> by(ring.size(), allowance);
  for (const DxfLine& line : block.lines) {
    if (line.layer != 6 || line.points.size() < 2)
      continue;
    const Vec2 from = line.points.front() * unit,
               along = (line.points.back() * unit - from).normalized();
    const auto on_fold = [&](const Vec2& p) { return std::abs(wedge(along, p - from)) < ON_FOLD; };
    for (std::size_t k = 0; k < ring.size(); ++k)
      if (on_fold(ring[k]) && on_fold(ring[(k + 1) % ring.size()]))
        by[k] = 0;
  }
  return inset(ring, by, corners);
}

Vec2 size_of(const PointRing& ring) {
  const auto [low, high] = bounds_of(ring);
  return high - low;
}

bool is_symmetric(const PointRing& ring) {
  const auto [low, high] = bounds_of(ring);
  const Vec2 middle = 0.5 * (low + high);
  for (const int axis : {0, 1}) {
    const auto on_ring = [&](const Vec2& p) {
      Vec2 image = p;
      image[axis] = 2 * middle[axis] - p[axis];
      return distance_to_ring(ring, image) < SYMMETRIC;
    };
    if (std::all_of(ring.begin(), ring.end(), on_ring))
      return true;
  }
  return false;
}

bool is_box(const PointRing& ring) {
  const auto [low, high] = bounds_of(ring);
  const double box = (high - low).prod();
  return std::abs(std::abs(ring_area(ring)) - box) < 1e-3 * box;
}

} // namespace sloper::pattern

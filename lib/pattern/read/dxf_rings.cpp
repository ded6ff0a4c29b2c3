#include <pattern/read/dxf_rings.hpp>
#include <sloper/base/units.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::pattern {

double ring_area(const PointRing& r) {
  double a = 0;
  for (std::size_t k = 0; k < r.size(); ++k)
    a += 0.5 * (r[k].x() * r[(k + 1) % r.size()].y() - r[k].y() * r[(k + 1) % r.size()].x());
  return a;
}

std::vector<PointRing> rings_of(const DxfBlock& block, int layer, double unit, double join) {
  std::vector<PointRing> rings;
  std::vector<PointRing> open;
  for (const DxfLine& line : block.lines) {
    if (line.layer != layer)
      continue;
    PointRing points;
    for (const Vec2& p : line.points)
      if (points.empty() || (points.back() - p * unit).norm() > 1e-6)
        points.push_back(p * unit);
    if (points.size() < 2)
      continue;
    if (line.closed || (points.size() > 3 && (points.front() - points.back()).norm() < join))
      rings.push_back(points);
    else
      open.push_back(points);
  }
  while (!open.empty()) {
    PointRing chain = open.front();
    open.erase(open.begin());
    for (bool grown = true; grown && (chain.front() - chain.back()).norm() >= join;) {
      grown = false;
      for (std::size_t k = 0; k < open.size() && !grown; ++k)
        for (bool turn : {false, true}) {
          PointRing next = open[k];
          if (turn)
            std::reverse(next.begin(), next.end());
          if ((next.front() - chain.back()).norm() >= join)
            continue;
          chain.insert(chain.end(), next.begin() + 1, next.end());
          open.erase(open.begin() + static_cast<long>(k));
          grown = true;
          break;
        }
    }
    if (chain.size() > 3 && (chain.front() - chain.back()).norm() < join)
      rings.push_back(chain);
  }
  for (PointRing& r : rings)
    while (r.size() > 1 && (r.front() - r.back()).norm() < 1e-6)
      r.pop_back();
  rings.erase(
      std::remove_if(rings.begin(), rings.end(), [](const PointRing& r) { return r.size() < 3; }),
      rings.end());
  std::sort(rings.begin(), rings.end(), [](const PointRing& a, const PointRing& b) {
    return std::abs(ring_area(a)) > std::abs(ring_area(b));
  });
  return rings;
}

double distance_to_ring(const PointRing& ring, const Vec2& p) {
  double best = 1e300;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vec2 a = ring[k], along = ring[(k + 1) % ring.size()] - a;
    const double t = along.squaredNorm() > 0
                         ? std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0)
                         : 0.0;
    best = std::min(best, (p - a - t * along).norm());
  }
  return best;
}

bool follows(const PointRing& sew, const PointRing& cut) {
  constexpr double WIDEST_ALLOWANCE = 0.07; // m
  if (std::abs(ring_area(sew)) > 1.02 * std::abs(ring_area(cut)) ||
      std::abs(ring_area(sew)) < 0.15 * std::abs(ring_area(cut)))
    return false;
  return std::all_of(sew.begin(), sew.end(),
                     [&](const Vec2& p) { return distance_to_ring(cut, p) < WIDEST_ALLOWANCE; }) &&
         std::all_of(cut.begin(), cut.end(),
                     [&](const Vec2& p) { return distance_to_ring(sew, p) < WIDEST_ALLOWANCE; });
}

std::vector<std::size_t> corners_of(const PointRing& ring, const std::vector<Vec2>& turn_points) {
  std::vector<std::size_t> corners;
  for (std::size_t k = 0; k < ring.size(); ++k)
    for (const Vec2& p : turn_points)
      if ((p - ring[k]).norm() < 2e-4) {
        corners.push_back(k);
        break;
      }
  if (!corners.empty())
    return corners;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vec2 in = ring[k] - ring[(k + ring.size() - 1) % ring.size()],
               out = ring[(k + 1) % ring.size()] - ring[k];
    if (std::abs(std::atan2(in.x() * out.y() - in.y() * out.x(), in.dot(out))) > units::radians(30))
      corners.push_back(k);
  }
  if (corners.empty())
    corners.push_back(0);
  return corners;
}

std::vector<PanelEdge> edges_of(const PointRing& ring, const std::vector<std::size_t>& corners,
                                const std::string& prefix) {
  std::vector<PanelEdge> loop;
  const std::size_t n = ring.size();
  for (std::size_t c = 0; c < corners.size(); ++c) {
    const std::size_t from = corners[c],
                      to = c + 1 < corners.size() ? corners[c + 1] : corners[0] + n;
    PanelEdge e;
    e.name = prefix + std::to_string(c);
    for (std::size_t k = from; k < to; ++k)
      e.path.push_back(Segment::straight(ring[k % n], ring[(k + 1) % n]));
    loop.push_back(std::move(e));
  }
  return loop;
}

} // namespace sloper::pattern

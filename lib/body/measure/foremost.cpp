#include <body/measure/foremost.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace sloper::body {

namespace {

constexpr double LEVEL_STEP = 0.0012, ACROSS_FLAT = 0.0036; // of stature
constexpr std::ptrdiff_t MARGIN = 4;                        // levels at an end of the heights
/// Standard deviations: means of the seven sevenths of a normal distribution.
constexpr std::array<double, 7> SEVENTHS = {-1.579, -0.800, -0.368, 0, 0.368, 0.800, 1.579};

/// The farthest skin of each level; on a flat front the middle of what is as far out as its
/// vertices can tell.
std::vector<Vec3> outline_of(const Finder& f, Span heights, Span across, double sign) {
  std::vector<Vec3> outline;
  const double across_flat = ACROSS_FLAT * f.s, step = LEVEL_STEP * f.s;
  // all ask for the same levels, which are cut once
  for (double k = std::ceil(heights.low / step); k * step <= heights.high; ++k) {
    const double y = k * step;
    const auto& loop = f.levels.trunk_at(y);
    if (!loop)
      continue;
    std::optional<Vec3> outer;
    for (const auto& segment : loop->segments) {
      const Vec2& q = segment[0];
      if (q.x() < across.low || q.x() > across.high)
        continue;
      if (!outer || sign * q.y() > sign * outer->z())
        outer = Vec3(q.x(), y, q.y());
    }
    if (!outer)
      continue;
    double sum = 0, weight = 0;
    for (const auto& segment : loop->segments)
      for (const double t :
           {0.1, 0.3, 0.5, 0.7, 0.9}) { // a segment is longer than the flat part may be
        const Vec2 q = (1 - t) * segment[0] + t * segment[1];
        const double less = sign * (outer->z() - q.y());
        if (q.x() < across.low || q.x() > across.high || less > across_flat)
          continue;
        const double w = (across_flat - less) * (segment[1] - segment[0]).norm();
        sum += w * q.x();
        weight += w;
      }
    if (weight > 0)
      outer->x() = sum / weight;
    outline.push_back(*outer);
  }
  return outline;
}

/// What a quantity of standard deviation `sd` may be off by: nothing where it is known.
std::vector<double> may_be_off_by(double sd) {
  if (sd <= 0)
    return {0};
  std::vector<double> all(SEVENTHS.begin(), SEVENTHS.end());
  for (double& off : all)
    off *= sd;
  return all;
}

/// Depth of an outline at height y, m; beyond its ends that of the end.
double depth_at(const std::vector<Vec3>& points, double y) {
  const auto above = std::lower_bound(points.begin(), points.end(), y,
                                      [](const Vec3& p, double height) { return p.y() < height; });
  const Vec3 &b = above == points.end() ? points.back() : *above,
             &a = above == points.begin() ? b : *(above - 1);
  const double t = b.y() > a.y() ? (y - a.y()) / (b.y() - a.y()) : 0;
  return (1 - t) * a.z() + t * b.z();
}

class Outline {
public:
  Outline(const std::vector<Vec3>& points, double sign, double flat)
      : m_points(points), m_sign(sign), m_flat(flat) {}

  /// The middle of all levels from `first` to `last` that are as far out as `top`.
  Foremost middle(std::ptrdiff_t top, std::ptrdiff_t first, std::ptrdiff_t last) const {
    Vec2 sum = Vec2::Zero(); // x, y
    double squares = 0, weight = 0;
    Foremost place{at(top), 0, at(top).y(), at(top).y()};
    for (std::ptrdiff_t k = first; k <= last; ++k) {
      const double share = 1 - out_less(top, k) / m_flat;
      if (share <= 0)
        continue;
      const double w = share * share, y = at(k).y();
      sum += w * Vec2(at(k).x(), y);
      squares += w * y * y;
      weight += w;
      place.low = std::min(place.low, y);
      place.high = std::max(place.high, y);
    }
    const Vec2 mean = sum / weight;
    place.spread_m = std::sqrt(std::max(0.0, squares / weight - mean.y() * mean.y()));
    place.p = Vec3(mean.x(), mean.y(), depth_at(m_points, mean.y()));
    return place;
  }

  /// A level that is the farthest within 8 levels to both sides: the farthest of them; -1 where
  /// there is none.
  std::ptrdiff_t inner_top() const {
    const std::ptrdiff_t n = size();
    std::ptrdiff_t best = -1;
    for (std::ptrdiff_t k = MARGIN; k < n - MARGIN; ++k)
      if (farthest(std::max<std::ptrdiff_t>(0, k - 2 * MARGIN), std::min(n, k + 2 * MARGIN + 1)) ==
              k &&
          (best < 0 || out_less(k, best) > 0))
        best = k;
    return best;
  }

  /// Where the outline stands out most before the straight line from its one end to its other; -1
  /// where it hangs back.
  std::ptrdiff_t bulge_top() const {
    const Vec3 &a = m_points.front(), &b = m_points.back();
    std::ptrdiff_t best = -1;
    double most = m_flat;
    for (std::ptrdiff_t k = MARGIN; k < size() - MARGIN; ++k) {
      const double line = a.z() + (at(k).y() - a.y()) / (b.y() - a.y()) * (b.z() - a.z()),
                   out = m_sign * (at(k).z() - line);
      if (out > most) {
        most = out;
        best = k;
      }
    }
    return best;
  }

  /// First and last of the levels about `top` that are as far out, and no farther.
  std::pair<std::ptrdiff_t, std::ptrdiff_t> as_far_without_a_gap(std::ptrdiff_t top) const {
    auto as_far = [&](std::ptrdiff_t k) {
      return k >= 0 && k < size() && out_less(top, k) >= 0 && out_less(top, k) < m_flat;
    };
    std::ptrdiff_t first = top, last = top;
    while (as_far(first - 1))
      --first;
    while (as_far(last + 1))
      ++last;
    return {first, last};
  }

  std::ptrdiff_t farthest(std::ptrdiff_t first, std::ptrdiff_t end) const {
    return std::max_element(
               m_points.begin() + first, m_points.begin() + end,
               [&](const Vec3& a, const Vec3& b) { return m_sign * a.z() < m_sign * b.z(); }) -
           m_points.begin();
  }
  /// How much less far out level k is than `top`, m.
  double out_less(std::ptrdiff_t top, std::ptrdiff_t k) const {
    return m_sign * (at(top).z() - at(k).z());
  }
  std::ptrdiff_t size() const { return static_cast<std::ptrdiff_t>(m_points.size()); }
  const Vec3& at(std::ptrdiff_t k) const { return m_points[k]; }

private:
  const std::vector<Vec3>& m_points;
  double m_sign, m_flat;
};

/// The middle of what is as far out as the farthest of the points between two heights.
std::optional<Vec3> farthest_between(const std::vector<Vec3>& points, Span heights, double sign,
                                     double flat) {
  std::vector<Vec3> between;
  for (const Vec3& p : points)
    if (p.y() >= heights.low && p.y() <= heights.high)
      between.push_back(p);
  if (between.empty())
    return std::nullopt;
  const Outline outline(between, sign, flat);
  const std::ptrdiff_t top = outline.farthest(0, outline.size());
  const auto [first, last] = outline.as_far_without_a_gap(top);
  return outline.middle(top, first, last).p;
}

} // namespace

std::optional<Foremost> foremost_place(const Finder& finder, Span heights, Span across, double sign,
                                       double flat, double inside) {
  const std::vector<Vec3> points = outline_of(finder, heights, across, sign);
  if (points.empty())
    return std::nullopt;
  const double as_far = flat * finder.s;
  const Outline outline(points, sign, as_far);
  const std::ptrdiff_t n = outline.size(), most = outline.farthest(0, n);
  if (most >= MARGIN && most < n - MARGIN) {
    Foremost place = outline.middle(most, 0, n - 1);
    const auto [first, last] = outline.as_far_without_a_gap(most);
    place.p = outline.middle(most, first, last)
                  .p; // not between two places that are as far out, but the farther of them
    return place;
  }
  const Foremost at_the_end{outline.at(most), 0, outline.at(most).y(), outline.at(most).y()};
  if (n < 4 * MARGIN)
    return at_the_end;
  std::ptrdiff_t inner = outline.inner_top();
  const bool is_bulge =
      inner < 0; // of a bulge on a slope no level need be farther out than both its neighbours
  if (is_bulge)
    inner = outline.bulge_top();
  if (inner < 0 || outline.out_less(most, inner) >= inside * finder.s)
    return at_the_end;
  if (is_bulge)
    return outline.middle(inner, inner, inner);
  const auto [first, last] = outline.as_far_without_a_gap(
      inner); // where the skin runs out again, the place's own surroundings end
  return outline.middle(inner, first, last);
}

std::optional<Foremost> likely_foremost(const Finder& finder, Span heights, Span across,
                                        double sign, double flat, const Doubt& doubt) {
  const double most = SEVENTHS.back();
  const std::vector<Vec3> points = outline_of(
      finder, {heights.low - most * doubt.low_m, heights.high + most * doubt.high_m}, across, sign);
  std::vector<Vec3> places;
  for (const double lean : may_be_off_by(doubt.lean)) {
    std::vector<Vec3> leaning = points;
    for (Vec3& p : leaning)
      p.z() -= (finder.levels.rise() + lean) * p.y();
    for (const double low : may_be_off_by(doubt.low_m))
      for (const double high : may_be_off_by(doubt.high_m)) {
        const auto place = farthest_between(leaning, {heights.low + low, heights.high + high}, sign,
                                            flat * finder.s);
        if (place)
          places.push_back(*place);
      }
  }
  if (places.empty())
    return std::nullopt;
  Vec3 mean = Vec3::Zero();
  Foremost likely{mean, 0, places.front().y(), places.front().y()};
  for (const Vec3& p : places) {
    mean += p / static_cast<double>(places.size());
    likely.low = std::min(likely.low, p.y());
    likely.high = std::max(likely.high, p.y());
  }
  std::vector<double> heights_of;
  for (const Vec3& p : places)
    heights_of.push_back(p.y());
  const auto half = heights_of.begin() + std::ssize(heights_of) / 2;
  std::nth_element(heights_of.begin(), half, heights_of.end());
  likely.median = *half;
  double squares = 0;
  for (const Vec3& p : places)
    squares += (p.y() - mean.y()) * (p.y() - mean.y());
  likely.spread_m = std::sqrt(squares / static_cast<double>(places.size()));
  likely.p = Vec3(mean.x(), mean.y(), depth_at(points, mean.y()));
  return likely;
}

} // namespace sloper::body

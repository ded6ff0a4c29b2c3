#include <pattern/panel_words.hpp>
#include <pattern/seams/seam_sides.hpp>
#include <sloper/base/units.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numeric>

namespace sloper::pattern {
namespace {

/// Across the grain and along it.
Vec2 by_grain(const Vec2& grain, const Vec2& v) {
  return {grain.y() * v.x() - grain.x() * v.y(), v.dot(grain)};
}

/// A name without its last word where that says a side ("armhole_l" is "armhole"); empty for
/// "edge12".
std::string base_name(const std::string& name) {
  std::string base = name;
  for (const char* tail : {"_l", "_r", "_f", "_b", "_a", "_left", "_right", "_mirror"}) {
    const std::string t = tail;
    if (base.size() > t.size() && base.compare(base.size() - t.size(), t.size(), t) == 0) {
      base.resize(base.size() - t.size());
      break;
    }
  }
  std::string letters;
  for (char c : base)
    if (std::isalpha(static_cast<unsigned char>(c)))
      letters += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return letters == "edge" || letters.rfind("hole", 0) == 0 ? "" : letters;
}

/// 1 left, -1 right, 0 unknown.
int hand_of(const std::string& name) {
  const auto ends = [&](const std::string& t) {
    return name.size() > t.size() && name.compare(name.size() - t.size(), t.size(), t) == 0;
  };
  if (ends("_l") || ends("_left") || ends(" L"))
    return 1;
  return ends("_r") || ends("_right") || ends(" R") ? -1 : 0;
}

double interior_angle(const Path& in, const Path& out) {
  const ArcLength arrives(in), leaves(out);
  const Vec2 u = arrives.tangent(arrives.length()), v = leaves.tangent(0);
  return units::PI - std::atan2(u.x() * v.y() - u.y() * v.x(), u.dot(v));
}

} // namespace

SeamSide measure_side(const Pattern& pattern, int panel_index, int first, int count) {
  const Panel& panel = pattern.panels[panel_index];
  SeamSide side;
  side.panel = panel_index;
  side.first = first;
  side.count = count;
  for (const auto& loop : panel.loops) {
    side.loop_size = static_cast<int>(loop.size());
    if (first < side.loop_begin + side.loop_size)
      break;
    side.loop_begin += side.loop_size;
  }
  const auto edge_at = [&](int k) {
    const int n = side.loop_size;
    return side.loop_begin + ((first - side.loop_begin + k) % n + n) % n;
  };
  Path path;
  for (int k = 0; k < count; ++k) {
    const int e = edge_at(k);
    const double before = path.empty() ? 0 : length(path), own = length(panel.edge(e).path);
    for (const Notch& n : panel.notches)
      if (n.edge == e)
        side.notches.push_back(before + n.at * own);
    const Path& next = panel.edge(e).path;
    path.insert(path.end(), next.begin(), next.end());
  }
  std::sort(side.notches.begin(), side.notches.end());
  const ArcLength arc(path);
  side.length = arc.length();
  const Vec2 start = path.front().p[0], end = path.back().p[3], chord = end - start;
  side.chord = by_grain(panel.grain, chord);
  const Vec2 left = Vec2(-chord.y(), chord.x()) / std::max(chord.norm(), 1e-9);
  for (int k = 0; k < SeamSide::SAMPLES; ++k) {
    const Vec2 p = arc.at(side.length * (k + 1) / (SeamSide::SAMPLES + 1));
    side.offset[k] = (p - start).dot(left) / std::max(side.length, 1e-9);
    side.bulge += side.offset[k] / SeamSide::SAMPLES;
  }
  side.corner_start = interior_angle(panel.edge(edge_at(-1)).path, panel.edge(first).path);
  side.corner_end =
      interior_angle(panel.edge(edge_at(count - 1)).path, panel.edge(edge_at(count)).path);
  Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
  double around = 0;
  for (const PanelEdge& e : panel.loops[0]) {
    const ArcLength own(e.path);
    around += own.length();
    for (int k = 0; k < 4; ++k) {
      const Vec2 p = by_grain(panel.grain, own.at(own.length() * k / 4));
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  }
  side.place = (by_grain(panel.grain, arc.at(0.5 * side.length)) - low)
                   .cwiseQuotient((high - low).cwiseMax(1e-9));
  side.share = side.length / std::max(0.5 * around, 1e-9);
  if (count == 1)
    side.name = base_name(panel.edge(first).name);
  side.hand =
      hand_of(panel.edge(first).name) ? hand_of(panel.edge(first).name) : hand_of(panel.name);
  return side;
}

SideCorners all_corners(const Pattern& pattern) {
  SideCorners out;
  for (const Panel& panel : pattern.panels) {
    out.emplace_back(static_cast<std::size_t>(panel.n_edges()));
    std::iota(out.back().begin(), out.back().end(), 0);
  }
  return out;
}

std::vector<SeamSide> seam_sides(const Pattern& pattern, const SideCorners& corners,
                                 double shortest) {
  std::vector<SeamSide> sides;
  for (int p = 0; p < std::ssize(pattern.panels); ++p) {
    int begin = 0;
    for (const auto& loop : pattern.panels[p].loops) {
      const int n = std::ssize(loop);
      std::vector<int> own; // of this loop
      for (int c : corners[p])
        if (c >= begin && c < begin + n)
          own.push_back(c);
      for (std::size_t c = 0; c < own.size(); ++c) {
        const int to = c + 1 < own.size() ? own[c + 1] : own[0] + n;
        SeamSide side = measure_side(pattern, p, own[c], to - own[c]);
        if (side.length >= shortest)
          sides.push_back(std::move(side));
      }
      begin += n;
    }
  }
  for (std::size_t i = 0; i < sides.size(); ++i)
    for (std::size_t j = 0; j < sides.size(); ++j)
      if (sides[i].panel == sides[j].panel && sides[i].loop_begin == sides[j].loop_begin) {
        const int n = sides[i].loop_size, begin = sides[i].loop_begin;
        if ((sides[i].first - begin + sides[i].count) % n == sides[j].first - begin) {
          sides[i].after = static_cast<int>(j);
          sides[j].before = static_cast<int>(i);
        }
      }
  return sides;
}

/// Cuts sides that have not their like where both parts have.
static void cut_unlike(const Pattern& pattern, SideCorners& corners) {
  constexpr double LIKE = 0.03, LIKE_PART = 0.04; // logarithm of lengths
  constexpr double SHORTEST_PART = 0.08;          // m
  const std::vector<SeamSide> sides = seam_sides(pattern, corners, 0);
  const auto alike = [&](double length, int but, double within) {
    std::vector<int> found; // panels
    for (const SeamSide& s : sides)
      if (s.panel != but && s.length > 0 && std::abs(std::log(s.length / length)) < within)
        found.push_back(s.panel);
    return found;
  };
  for (const SeamSide& s : sides) {
    if (s.count < 2 || !alike(s.length, s.panel, LIKE).empty())
      continue;
    double best = 1e300;
    int at = -1;
    for (int k = 1; k < s.count; ++k) {
      const double first = measure_side(pattern, s.panel, s.first, k).length,
                   second = s.length - first;
      if (std::min(first, second) < SHORTEST_PART)
        continue;
      if (alike(first, s.panel, LIKE_PART).empty() || alike(second, s.panel, LIKE_PART).empty())
        continue;
      if (const double off = std::abs(first - second); off < best) {
        best = off;
        at = k;
      }
    }
    if (at < 0)
      continue;
    auto& own = corners[s.panel];
    own.push_back(s.loop_begin + (s.first - s.loop_begin + at) % s.loop_size);
    std::sort(own.begin(), own.end());
  }
}

SideCorners sharp_corners(const Pattern& pattern, double straight_on) {
  SideCorners out;
  for (const Panel& panel : pattern.panels) {
    out.emplace_back();
    int begin = 0;
    for (const auto& loop : panel.loops) {
      const int n = std::ssize(loop);
      std::vector<std::pair<double, int>> turns; // at the start of each edge, sharpest first
      for (int k = 0; k < n; ++k)
        turns.push_back(
            {-std::abs(units::PI - interior_angle(loop[(k + n - 1) % n].path, loop[k].path)), k});
      std::stable_sort(turns.begin(), turns.end());
      std::size_t kept = 0;
      for (const auto& [turn, k] : turns)
        if (-turn >= straight_on || kept < 2) {
          out.back().push_back(begin + k);
          ++kept;
        }
      begin += n;
    }
    std::sort(out.back().begin(), out.back().end());
  }
  cut_unlike(pattern, out);
  return out;
}

std::vector<std::vector<PanelMirror>> panel_mirrors(const Pattern& pattern) {
  constexpr double ALIKE = 0.003, ALIKE_PART = 0.01; // m and of the length
  struct Outline {
    std::vector<double> lengths;
    std::vector<Vec2> chords;
  };
  std::vector<Outline> outlines;
  for (const Panel& panel : pattern.panels) {
    Outline& o = outlines.emplace_back();
    for (const PanelEdge& e : panel.loops[0]) {
      o.lengths.push_back(length(e.path));
      o.chords.push_back(by_grain(panel.grain, e.path.back().p[3] - e.path.front().p[0]));
    }
  }
  std::vector<std::vector<PanelMirror>> out(outlines.size());
  for (std::size_t p = 0; p < outlines.size(); ++p)
    for (std::size_t q = 0; q < outlines.size(); ++q) {
      const int n = std::ssize(outlines[p].lengths);
      if (outlines[q].lengths.size() != outlines[p].lengths.size())
        continue;
      for (int sum = 0; sum < n; ++sum) {
        const PanelMirror m{static_cast<int>(q), sum};
        bool same = true;
        for (int e = 0; e < n && same; ++e) {
          const std::size_t own = static_cast<std::size_t>(e),
                            other = static_cast<std::size_t>(m.image(e, n));
          const double l = outlines[p].lengths[own], off = std::max(ALIKE, ALIKE_PART * l);
          const Vec2 &a = outlines[p].chords[own], &b = outlines[q].chords[other];
          same = std::abs(outlines[q].lengths[other] - l) < off &&
                 (b - Vec2(a.x(), -a.y())).norm() < 2 * off;
        }
        if (same)
          out[p].push_back(m);
      }
    }
  return out;
}

} // namespace sloper::pattern

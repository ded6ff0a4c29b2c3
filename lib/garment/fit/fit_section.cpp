#include <garment/fit/fit_section.hpp>

#include <sloper/base/units.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace sloper::garment {

namespace {

constexpr double SMALLEST_ARC = 0.03; // turns: a shorter piece of line is a fold

using EdgeKey = std::array<int, 2>; // particles

/// Rest length of a line from u to v (barycentric) in triangle f: from the metric that the three
/// rest edges give.
double rest_length(const Garment& garment, int f, const Vec3& u, const Vec3& v) {
  const Triangle& t = garment.panels.triangles[f];
  double squared[3];
  for (int k = 0; k < 3; ++k) {
    const double scale = garment.rest_scale.empty() ? 1 : garment.rest_scale[f][k];
    squared[k] =
        (garment.panels.pattern[t[(k + 1) % 3]] - garment.panels.pattern[t[k]]).squaredNorm() *
        scale * scale;
  }
  const Vec3 d = v - u; // sums to zero, so |line|^2 = -(d0 d1 l01^2 + d1 d2 l12^2 + d2 d0 l20^2)
  return std::sqrt(std::max(
      0.0, -(d[0] * d[1] * squared[0] + d[1] * d[2] * squared[1] + d[2] * d[0] * squared[2])));
}

struct Cut {
  SectionSegment segment;
  EdgeKey edge_a, edge_b;
};

void add_cut(const Garment& garment, int f, const std::vector<double>& height,
             const std::vector<Vec3>* elsewhere, std::vector<Cut>& cuts) {
  const Triangle& t = garment.panels.triangles[f];
  Vec3 where[2];
  EdgeKey edge[2];
  int found = 0;
  for (int k = 0; k < 3 && found < 2; ++k) {
    const int i = k, j = (k + 1) % 3, p = garment.particle_of[t[i]], q = garment.particle_of[t[j]];
    if ((height[p] > 0) == (height[q] > 0))
      continue;
    const double s = height[p] / (height[p] - height[q]);
    where[found] = Vec3::Zero();
    where[found][i] = 1 - s;
    where[found][j] = s;
    edge[found++] = {std::min(p, q), std::max(p, q)};
  }
  if (found < 2)
    return;
  const auto point = [&](const std::vector<Vec3>& x, const Vec3& w) {
    Vec3 p = Vec3::Zero();
    for (int k = 0; k < 3; ++k)
      p += w[k] * x[garment.particle_of[t[k]]];
    return p;
  };
  const double other =
      elsewhere ? (point(*elsewhere, where[1]) - point(*elsewhere, where[0])).norm() : 0;
  cuts.push_back({{f, point(garment.position, where[0]), point(garment.position, where[1]),
                   rest_length(garment, f, where[0], where[1]), other},
                  edge[0],
                  edge[1]});
}

double signed_turns(const SectionChain& chain, const Vec3& axis_point, const Vec3& normal) {
  double angle = 0;
  const auto flat = [&](const Vec3& p) {
    return Vec3(p - axis_point - (p - axis_point).dot(normal) * normal);
  };
  for (const SectionSegment& s : chain.segments) {
    const Vec3 u = flat(s.a), v = flat(s.b);
    angle += std::atan2(normal.dot(u.cross(v)), u.dot(v));
  }
  return angle / (2 * units::PI);
}

} // namespace

double SectionChain::turns(const Vec3& axis_point, const Vec3& normal) const {
  return std::abs(signed_turns(*this, axis_point, normal));
}

void SectionChain::reverse() {
  std::reverse(segments.begin(), segments.end());
  for (SectionSegment& s : segments)
    std::swap(s.a, s.b);
}

std::size_t SectionLine::n_segments() const {
  std::size_t n = 0;
  for (const SectionChain& chain : chains)
    n += chain.segments.size();
  return n;
}

std::optional<SectionLine> assemble_line(std::vector<SectionChain> chains, const Vec3& axis_point,
                                         const Vec3& normal, double open) {
  const Vec3 zero = std::abs(normal.z()) < 0.9
                        ? Vec3(Vec3::UnitZ() - normal.z() * normal).normalized()
                        : Vec3(Vec3::UnitX() - normal.x() * normal).normalized();
  struct Arc {
    double from, sweep, radius; // turns, turns, m
    SectionChain* chain;
  };
  std::vector<Arc> arcs;
  for (SectionChain& chain : chains) {
    double sweep = signed_turns(chain, axis_point, normal);
    if (std::abs(sweep) < SMALLEST_ARC || chain.closed)
      continue; // a closed line that does not go round is a fold or a pocket
    if (sweep < 0) {
      chain.reverse();
      sweep = -sweep;
    }
    const Vec3 d = chain.segments.front().a - axis_point;
    double radius = 0;
    for (const SectionSegment& s : chain.segments)
      radius += (s.a - axis_point).norm() / static_cast<double>(chain.segments.size());
    arcs.push_back({std::atan2(normal.dot(zero.cross(d)), zero.dot(d)) / (2 * units::PI), sweep,
                    radius, &chain});
  }
  // The innermost first: what lies over it by more than half (a facing, a placket) is left out.
  std::stable_sort(arcs.begin(), arcs.end(),
                   [](const Arc& a, const Arc& b) { return a.radius < b.radius; });
  std::vector<Arc> taken;
  double covered = 0;
  for (const Arc& arc : arcs) {
    double hidden = 0;
    for (const Arc& other : taken) {
      const double at =
          arc.from - other.from -
          std::floor(arc.from - other.from); // of its start after the other's, in [0, 1)
      hidden += std::max(0.0, std::min(at + arc.sweep, other.sweep) - at) +
                std::max(0.0, std::min(at + arc.sweep - 1, other.sweep));
    }
    if (hidden > 0.5 * arc.sweep)
      continue;
    taken.push_back(arc);
    covered += arc.sweep - hidden;
  }
  if (taken.empty() || covered < 1 - open)
    return std::nullopt;
  std::stable_sort(taken.begin(), taken.end(),
                   [](const Arc& a, const Arc& b) { return a.from < b.from; });
  SectionLine line;
  for (std::size_t i = 0; i < taken.size(); ++i) {
    const SectionChain &chain = *taken[i].chain, &next = *taken[(i + 1) % taken.size()].chain;
    line.bridged += (next.segments.front().a - chain.segments.back().b).norm();
    line.lying += chain.length;
    line.rest += chain.rest_length;
    line.elsewhere += chain.elsewhere;
  }
  for (const Arc& arc : taken)
    line.chains.push_back(std::move(*arc.chain));
  line.lying += line.bridged;
  line.rest += line.bridged;
  line.elsewhere += line.bridged;
  return line;
}

std::vector<SectionChain> cut_garment(const Garment& garment, const std::vector<char>& use,
                                      const Vec3& point, const Vec3& normal,
                                      const std::vector<Vec3>* elsewhere) {
  std::vector<double> height(garment.position.size());
  for (std::size_t i = 0; i < height.size(); ++i) {
    height[i] = (garment.position[i] - point).dot(normal);
    if (std::abs(height[i]) < 1e-7)
      height[i] = 1e-7;
  }
  std::vector<Cut> cuts;
  for (std::size_t f = 0; f < garment.panels.triangles.size(); ++f)
    if (use.empty() || use[f])
      add_cut(garment, static_cast<int>(f), height, elsewhere, cuts);
  std::map<EdgeKey, std::vector<int>> at_edge;
  for (std::size_t c = 0; c < cuts.size(); ++c) {
    at_edge[cuts[c].edge_a].push_back(static_cast<int>(c));
    at_edge[cuts[c].edge_b].push_back(static_cast<int>(c));
  }
  std::vector<char> taken(cuts.size(), 0);
  /// The line of untaken cuts that goes out from an edge.
  const auto follow = [&](EdgeKey edge) {
    std::vector<SectionSegment> line;
    for (;;) {
      const std::vector<int>& here = at_edge[edge];
      const auto next = std::find_if(here.begin(), here.end(), [&](int c) { return !taken[c]; });
      if (next == here.end())
        return line;
      taken[*next] = 1;
      Cut& cut = cuts[*next];
      if (cut.edge_a != edge) {
        std::swap(cut.edge_a, cut.edge_b);
        std::swap(cut.segment.a, cut.segment.b);
      }
      line.push_back(cut.segment);
      edge = cut.edge_b;
    }
  };
  std::vector<SectionChain> chains;
  for (std::size_t c = 0; c < cuts.size(); ++c) {
    if (taken[c])
      continue;
    taken[c] = 1;
    const std::vector<SectionSegment> forward = follow(cuts[c].edge_b),
                                      backward = follow(cuts[c].edge_a);
    SectionChain chain;
    for (auto s = backward.rbegin(); s != backward.rend(); ++s)
      chain.segments.push_back({s->triangle, s->b, s->a, s->rest, s->elsewhere});
    chain.segments.push_back(cuts[c].segment);
    chain.segments.insert(chain.segments.end(), forward.begin(), forward.end());
    for (const SectionSegment& s : chain.segments) {
      chain.length += (s.b - s.a).norm();
      chain.rest_length += s.rest;
      chain.elsewhere += s.elsewhere;
    }
    chain.opening = (chain.segments.front().a - chain.segments.back().b).norm();
    chain.closed = chain.segments.size() > 2 && chain.opening < 1e-9;
    chains.push_back(std::move(chain));
  }
  return chains;
}

} // namespace sloper::garment

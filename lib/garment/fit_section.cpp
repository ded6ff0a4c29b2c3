#include <garment/fit_section.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace sloper::garment {

namespace {

using EdgeKey = std::array<int, 2>; // particles

/// Rest length of a line from u to v (barycentric) in triangle f: from the metric that the three rest edges give.
double rest_length(const Garment& garment, int f, const Vec3& u, const Vec3& v) {
  const Triangle& t = garment.panels.triangles[f];
  double squared[3];
  for (int k = 0; k < 3; ++k) {
    const double scale = garment.rest_scale.empty() ? 1 : garment.rest_scale[f][k];
    squared[k] = (garment.panels.pattern[t[(k + 1) % 3]] - garment.panels.pattern[t[k]]).squaredNorm() * scale * scale;
  }
  const Vec3 d = v - u; // sums to zero, so |line|^2 = -(d0 d1 l01^2 + d1 d2 l12^2 + d2 d0 l20^2)
  return std::sqrt(std::max(0.0, -(d[0] * d[1] * squared[0] + d[1] * d[2] * squared[1] + d[2] * d[0] * squared[2])));
}

struct Cut {
  SectionSegment segment;
  EdgeKey edge_a, edge_b;
};

void add_cut(const Garment& garment, int f, const std::vector<double>& height, std::vector<Cut>& cuts) {
  const Triangle& t = garment.panels.triangles[f];
  Vec3 where[2];
  EdgeKey edge[2];
  int found = 0;
  for (int k = 0; k < 3 && found < 2; ++k) {
    const int i = k, j = (k + 1) % 3, p = garment.particle_of[t[i]], q = garment.particle_of[t[j]];
    if ((height[p] > 0) == (height[q] > 0)) continue;
    const double s = height[p] / (height[p] - height[q]);
    where[found] = Vec3::Zero();
    where[found][i] = 1 - s;
    where[found][j] = s;
    edge[found++] = {std::min(p, q), std::max(p, q)};
  }
  if (found < 2) return;
  const auto point = [&](const Vec3& w) {
    Vec3 p = Vec3::Zero();
    for (int k = 0; k < 3; ++k) p += w[k] * garment.position[garment.particle_of[t[k]]];
    return p;
  };
  cuts.push_back({{f, point(where[0]), point(where[1]), rest_length(garment, f, where[0], where[1])}, edge[0], edge[1]});
}

} // namespace

double SectionChain::turns(const Vec3& axis_point, const Vec3& normal) const {
  double angle = 0;
  const auto flat = [&](const Vec3& p) { return Vec3(p - axis_point - (p - axis_point).dot(normal) * normal); };
  for (const SectionSegment& s : segments) {
    const Vec3 u = flat(s.a), v = flat(s.b);
    angle += std::atan2(normal.dot(u.cross(v)), u.dot(v));
  }
  return std::abs(angle) / (2 * 3.14159265358979323846);
}

std::vector<SectionChain> cut_garment(const Garment& garment, const std::vector<char>& use, const Vec3& point, const Vec3& normal) {
  std::vector<double> height(garment.position.size());
  for (std::size_t i = 0; i < height.size(); ++i) {
    height[i] = (garment.position[i] - point).dot(normal);
    if (std::abs(height[i]) < 1e-7) height[i] = 1e-7;
  }
  std::vector<Cut> cuts;
  for (std::size_t f = 0; f < garment.panels.triangles.size(); ++f)
    if (use.empty() || use[f]) add_cut(garment, static_cast<int>(f), height, cuts);
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
      if (next == here.end()) return line;
      taken[*next] = 1;
      Cut& cut = cuts[*next];
      if (cut.edge_a != edge) std::swap(cut.edge_a, cut.edge_b), std::swap(cut.segment.a, cut.segment.b);
      line.push_back(cut.segment);
      edge = cut.edge_b;
    }
  };
  std::vector<SectionChain> chains;
  for (std::size_t c = 0; c < cuts.size(); ++c) {
    if (taken[c]) continue;
    taken[c] = 1;
    const std::vector<SectionSegment> forward = follow(cuts[c].edge_b), backward = follow(cuts[c].edge_a);
    SectionChain chain;
    for (auto s = backward.rbegin(); s != backward.rend(); ++s) chain.segments.push_back({s->triangle, s->b, s->a, s->rest});
    chain.segments.push_back(cuts[c].segment);
    chain.segments.insert(chain.segments.end(), forward.begin(), forward.end());
    for (const SectionSegment& s : chain.segments) chain.length += (s.b - s.a).norm(), chain.rest_length += s.rest;
    chain.opening = (chain.segments.front().a - chain.segments.back().b).norm();
    chain.closed = chain.segments.size() > 2 && chain.opening < 1e-9;
    chains.push_back(std::move(chain));
  }
  return chains;
}

} // namespace sloper::garment

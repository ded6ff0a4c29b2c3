#include <sloper/garment/fit/fit_lines.hpp>
#include <sloper/geometry/disjoint_sets.hpp>

#include <sloper/geometry/triangle_mesh.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::garment {

namespace {

constexpr double SHORTEST_HEM = 0.08; // m: a shorter loop is a button hole or a slit's end

/// Loops of edges that one triangle has: groups of edges that share particles.
std::vector<std::vector<std::array<int, 2>>> free_loops(const std::vector<Triangle>& triangles,
                                                        std::size_t n_particles) {
  const std::vector<std::array<int, 2>> free = free_edges_of(triangles);
  DisjointSets joined(n_particles);
  for (const auto& [a, b] : free)
    joined.unite(a, b);
  std::map<int, std::vector<std::array<int, 2>>> loops;
  for (const auto& e : free)
    loops[joined.find(e[0])].push_back(e);
  std::vector<std::vector<std::array<int, 2>>> result;
  for (auto& [first, edges] : loops)
    result.push_back(std::move(edges));
  return result;
}

/// Share of a loop's particles' weight by frame name without side, and the side.
std::string owner(const Garment& garment, const std::vector<std::array<int, 2>>& loop) {
  std::map<std::string, double> share;
  for (const auto& e : loop)
    for (const BindWeight& w : garment.bind.particles[e[0]]) {
      std::string name = garment.bind.frames[w.frame];
      if (name.find("arm_") != std::string::npos)
        name = name.back() == 'l' ? "left sleeve" : "right sleeve";
      else if (name.rfind("leg_", 0) == 0)
        name = name.back() == 'l' ? "left leg" : "right leg";
      share[name] += w.weight;
    }
  return std::max_element(share.begin(), share.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

FitHem measure_hem(const Garment& garment, const std::vector<std::array<int, 2>>& loop,
                   const Vec3& axis) {
  FitHem hem;
  hem.lowest_m = 1e300;
  hem.highest_m = -1e300;
  double sum = 0, half[4] = {}, half_length[4] = {}; // front, back, left, right
  for (const auto& e : loop) {
    const Vec3 &a = garment.position[e[0]], &b = garment.position[e[1]], middle = 0.5 * (a + b);
    const double length = (b - a).norm();
    hem.length_m += length;
    sum += length * middle.y();
    hem.lowest_m = std::min({hem.lowest_m, a.y(), b.y()});
    hem.highest_m = std::max({hem.highest_m, a.y(), b.y()});
    const int which[2] = {middle.z() > axis.z() ? 0 : 1, middle.x() > axis.x() ? 2 : 3};
    for (const int w : which) {
      half[w] += length * middle.y();
      half_length[w] += length;
    }
  }
  hem.height_m = sum / hem.length_m;
  if (half_length[0] > 0 && half_length[1] > 0)
    hem.front_minus_back_m = half[0] / half_length[0] - half[1] / half_length[1];
  if (half_length[2] > 0 && half_length[3] > 0)
    hem.left_minus_right_m = half[2] / half_length[2] - half[3] / half_length[3];
  hem.uncertainty_m = 0.5 * hem.length_m / static_cast<double>(loop.size());
  return hem;
}

/// How far down a limb a loop lies: length along the line of landmarks from the first one, and the
/// whole line's.
void cover(const body::Body& body, const std::vector<std::string>& names, const Vec3& at,
           const std::string& key, FitLines& lines) {
  double best = 1e300, covered = 0, whole = 0;
  for (const std::string& name : names)
    if (!body.has_landmark(name))
      return;
  for (std::size_t i = 0; i + 1 < names.size(); ++i) {
    const Vec3 a = body.landmark(names[i]), b = body.landmark(names[i + 1]), d = b - a;
    const double free = (at - a).dot(d) / d.squaredNorm();
    const double t = i + 2 == names.size()
                         ? std::max(0.0, free)
                         : std::clamp(free, 0.0, 1.0); // may reach over the hand or the floor
    if (const double distance = (a + t * d - at).norm(); distance < best) {
      best = distance;
      covered = whole + t * d.norm();
    }
    whole += d.norm();
  }
  if (whole <= 0)
    return;
  lines.coverage_m[key] = covered;
  lines.coverage[key] = covered / whole;
}

} // namespace

FitLines fit_lines(const Garment& garment, const body::Body& body) {
  FitLines lines;
  double low = 1e300, high = -1e300;
  for (const Vec3& p : garment.position) {
    low = std::min(low, p.y());
    high = std::max(high, p.y());
  }
  std::map<std::string, int> seen;
  for (const auto& loop : free_loops(garment.particle_triangles(), garment.position.size())) {
    Vec3 center = Vec3::Zero();
    for (const auto& e : loop)
      center += garment.position[e[0]] / static_cast<double>(loop.size());
    FitHem hem = measure_hem(garment, loop, center);
    hem.edges = loop;
    if (hem.length_m < SHORTEST_HEM)
      continue;
    hem.name = owner(garment, loop);
    if (hem.name == "head")
      hem.name = "neck";
    if (hem.name == "torso" || hem.name == "lower_body") {
      const bool up = hem.height_m > 0.5 * (low + high);
      const bool neck =
          body.has_landmark("axilla_l") && hem.height_m > body.landmark("axilla_l").y();
      hem.name = neck ? "neck" : "top";
      if (!up)
        hem.name = "hem";
    }
    const std::string side = hem.name.rfind("left", 0) == 0 ? "_l" : "_r";
    if (hem.name.find("sleeve") != std::string::npos)
      cover(body, {"shoulder_joint" + side, "elbow" + side, "wrist" + side}, center,
            "sleeve" + side, lines);
    if (hem.name.find("leg") != std::string::npos && body.has_landmark("crotch") &&
        body.has_landmark("ankle" + side)) {
      const double crotch = body.landmark("crotch").y(), ankle = body.landmark("ankle" + side).y();
      lines.coverage_m["inseam" + side] = crotch - hem.height_m;
      lines.coverage["inseam" + side] = (crotch - hem.height_m) / (crotch - ankle);
    }
    if (const int n = ++seen[hem.name]; n > 1)
      hem.name += " " + std::to_string(n);
    lines.hems.push_back(std::move(hem));
  }
  return lines;
}

} // namespace sloper::garment

#include <garment/bind/bind_weights.hpp>
#include <sloper/geometry/disjoint_sets.hpp>

#include <garment/bind/bind_laplacian.hpp>
#include <sloper/base/error.hpp>
#include <sloper/base/parallel.hpp>
#include <sloper/collision/triangle_tree.hpp>
#include <sloper/geometry/sparse_solver.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace sloper::garment {

namespace {

constexpr double BLEND_LENGTH =
    0.035; // m along the cloth; weights go from 0.9 to 0.1 within about 3 of these
constexpr double FACING_PENALTY =
    0.03; // m added to the distance of skin that faces away from the cloth's outside
constexpr double SMALL_PATCH =
    0.02; // of its piece: a smaller patch of one frame is a stray, not a sleeve
constexpr double NEGLIGIBLE_WEIGHT =
    2e-3; // taken off before normalising, so that weights reach 0 without a jump
constexpr int LEG_LINES = 24; // heights at which cloth between the legs is looked for

struct Patches {
  std::vector<int> of_particle;
  std::vector<double> area;
};

/// Connected patches of equal label.
Patches patches_of(const std::vector<int>& label, const std::vector<std::array<int, 2>>& edges,
                   const std::vector<double>& mass) {
  DisjointSets joined(label.size());
  for (const auto& [a, b] : edges)
    if (label[a] == label[b])
      joined.unite(a, b);
  Patches patches;
  patches.of_particle.resize(label.size());
  patches.area.assign(label.size(), 0);
  for (std::size_t i = 0; i < label.size(); ++i) {
    patches.of_particle[i] = joined.find(static_cast<int>(i));
    patches.area[patches.of_particle[i]] += mass[i];
  }
  return patches;
}

/// Strays (small patches) take the label of the neighbour with which they share most edges.
void remove_strays(std::vector<int>& label, const std::vector<int>& piece,
                   const std::vector<std::array<int, 2>>& edges, const std::vector<double>& mass) {
  std::map<int, double> piece_area;
  for (std::size_t i = 0; i < label.size(); ++i)
    piece_area[piece[i]] += mass[i];
  for (int round = 0; round < 4; ++round) {
    const Patches patches = patches_of(label, edges, mass);
    std::map<int, std::map<int, int>> neighbours; // stray patch -> label -> edges
    for (const auto& [a, b] : edges) {
      if (label[a] == label[b])
        continue;
      for (const auto& [i, j] : {std::pair{a, b}, std::pair{b, a}})
        if (patches.area[patches.of_particle[i]] < SMALL_PATCH * piece_area[piece[i]])
          ++neighbours[patches.of_particle[i]][label[j]];
    }
    if (neighbours.empty())
      return;
    std::map<int, int> next;
    for (const auto& [patch, counts] : neighbours)
      next[patch] =
          std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) {
            return a.second < b.second;
          })->first;
    for (std::size_t i = 0; i < label.size(); ++i)
      if (const auto found = next.find(patches.of_particle[i]); found != next.end())
        label[i] = found->second;
  }
}

/// One tree for each frame, over the skin that is labelled with it.
struct FrameTrees {
  std::vector<collision::TriangleTree> tree;
  std::vector<std::vector<Triangle>> triangles;
};

FrameTrees frame_trees(const body::Body& body, const BindFrames& frames) {
  FrameTrees trees;
  trees.triangles.resize(frames.frames.size());
  for (std::size_t f = 0; f < frames.frame_of_face.size(); ++f)
    if (frames.frame_of_face[f] >= 0)
      trees.triangles[frames.frame_of_face[f]].push_back(body.skin.triangles[f]);
  for (const auto& triangles : trees.triangles)
    trees.tree.emplace_back(triangles.empty()
                                ? collision::TriangleTree()
                                : collision::TriangleTree(body.skin.positions, triangles));
  return trees;
}

std::vector<int> nearest_frame(const std::vector<Vec3>& positions, const std::vector<Vec3>& normals,
                               const body::Body& body, const BindFrames& frames) {
  const FrameTrees trees = frame_trees(body, frames);
  std::vector<int> label(positions.size(), -1);
  parallel_for(positions.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      double best = 1e300;
      for (std::size_t k = 0; k < trees.tree.size(); ++k) {
        if (trees.triangles[k].empty())
          continue;
        const collision::ClosestPoint c = trees.tree[k].closest_point(positions[i], best);
        if (c.triangle < 0)
          continue;
        const Triangle& t = trees.triangles[k][c.triangle];
        const Vec3 n = area_normal(body.skin.positions[t[0]], body.skin.positions[t[1]],
                                   body.skin.positions[t[2]])
                           .normalized();
        const double agreement = std::isfinite(n.x()) ? n.dot(normals[i]) : 1;
        const double cost = std::sqrt(c.squared_distance) + FACING_PENALTY * 0.5 * (1 - agreement);
        if (cost < best) {
          best = cost;
          label[i] = static_cast<int>(k);
        }
      }
    }
  });
  return label;
}

} // namespace

bool wraps_legs_together(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                         const std::vector<int>& piece, int which, const BindFrames& frames,
                         double crotch_y) {
  const int l = frames.index("leg_l"), r = frames.index("leg_r");
  if (l < 0 || r < 0)
    return false;
  const auto axis_at = [&](int k, double y) {
    const PartFrame& f = frames.frames[k].frame;
    return Vec3(f.lower + (f.upper - f.lower) * ((y - f.lower.y()) / (f.upper.y() - f.lower.y())));
  };
  double lowest = 1e300;
  for (const Triangle& t : triangles)
    if (piece[t[0]] == which)
      for (int i : t)
        lowest = std::min(lowest, positions[i].y());
  const double highest = crotch_y - 0.01;
  if (lowest >= highest)
    return false;
  // A line from leg to leg at one height passes cloth of trousers, and none of a skirt, however far
  // apart the feet stand. Most heights decide, so that a pleat that hangs in at the front does not
  // make a pair of trousers out of a skirt.
  int passed = 0;
  for (int k = 0; k < LEG_LINES; ++k) {
    const double y = lowest + (k + 0.5) / LEG_LINES * (highest - lowest);
    const Vec3 a = axis_at(l, y), b = axis_at(r, y);
    const Vec2 from(a.x(), a.z()), line(b.x() - a.x(), b.z() - a.z()), aside(-line.y(), line.x());
    passed += std::any_of(triangles.begin(), triangles.end(), [&](const Triangle& t) {
      if (piece[t[0]] != which)
        return false;
      Vec2 cut[2]; // where the triangle's edges are at this height
      int n = 0;
      for (int e = 0; e < 3; ++e) {
        const Vec3 &p = positions[t[e]], &q = positions[t[(e + 1) % 3]];
        if ((p.y() <= y) == (q.y() <= y))
          continue;
        const Vec3 at = p + (y - p.y()) / (q.y() - p.y()) * (q - p);
        cut[n++] = Vec2(at.x(), at.z()) - from;
      }
      if (n != 2)
        return false;
      const double u = cut[0].dot(aside), v = cut[1].dot(aside);
      if ((u <= 0) == (v <= 0))
        return false;
      const double along =
          (cut[0] + u / (u - v) * (cut[1] - cut[0])).dot(line) / line.squaredNorm();
      return along > 0 && along < 1;
    });
  }
  return 2 * passed < LEG_LINES;
}

std::vector<std::vector<std::pair<int, double>>>
bind_weights(const Garment& garment, const body::Body& body, const BindFrames& frames) {
  const std::vector<Vec3>& x = garment.position;
  const std::vector<Triangle> triangles = garment.particle_triangles();
  const std::vector<std::array<int, 2>> edges = edges_of(triangles);
  const std::vector<int> piece = connected_components(x.size(), triangles);
  std::vector<int> label = nearest_frame(x, vertex_normals({x, triangles}), body, frames);
  if (std::find(label.begin(), label.end(), -1) != label.end())
    throw input_error("body.no-skin"_id, "", "",
                      "the body has no skin that a garment could hang on",
                      "make the body document again with scan-landmarks");

  const int lower_body = frames.index("lower_body"), leg_l = frames.index("leg_l"),
            leg_r = frames.index("leg_r");
  if (lower_body >= 0) {
    const int torso = frames.index("torso");
    const double crotch_y = body.has_landmark("crotch") ? body.landmark("crotch").y()
                                                        : frames.frames[torso].frame.lower.y();
    std::map<int, bool> together;
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (label[i] != leg_l && label[i] != leg_r)
        continue;
      const auto [found, is_new] = together.try_emplace(piece[i], false);
      if (is_new)
        found->second = wraps_legs_together(x, triangles, piece, piece[i], frames, crotch_y);
      if (found->second)
        label[i] = lower_body;
    }
  }

  const auto [mass, stiffness] = surface_operators(x, triangles);
  remove_strays(label, piece, edges, std::vector<double>(mass.data(), mass.data() + mass.size()));

  Eigen::SparseMatrix<double> system = BLEND_LENGTH * BLEND_LENGTH * stiffness;
  for (Eigen::Index i = 0; i < mass.size(); ++i)
    system.coeffRef(i, i) += mass[i];
  const SparseSolver solver(system);
  std::vector<std::vector<std::pair<int, double>>> weights(x.size());
  std::vector<double> sum(x.size(), 0);
  for (int k = 0; k < std::ssize(frames.frames); ++k) {
    Eigen::VectorXd w = Eigen::VectorXd::Zero(mass.size());
    for (std::size_t i = 0; i < x.size(); ++i)
      w[i] = label[i] == k;
    if (w.isZero())
      continue;
    for (int pass = 0; pass < 2; ++pass) {
      const Eigen::VectorXd right = mass.cwiseProduct(w);
      w = solver.solve(right);
    }
    for (std::size_t i = 0; i < x.size(); ++i)
      if (const double value = w[i] - NEGLIGIBLE_WEIGHT; value > 0) {
        weights[i].emplace_back(k, value);
        sum[i] += value;
      }
  }
  for (std::size_t i = 0; i < x.size(); ++i)
    for (auto& [frame, weight] : weights[i])
      weight /= sum[i];
  return weights;
}

} // namespace sloper::garment

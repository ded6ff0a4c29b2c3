#include <garment/ingest/carried_clearance.hpp>

#include <algorithm>
#include <iterator>

namespace sloper::garment {

namespace {

constexpr int MOST_ROUNDS = 40;        // sides that lie in each other cross at their rim alone
constexpr double NEARER = 0.3;         // of the distance to the cloth, in one round
constexpr double LEAST_SHARE = 0.1;    // of it that is kept: touching is crossing
constexpr double NEIGHBOUR_STEP = 0.2; // shares of the corners of a triangle differ by at most this

CrossingPairs pairs_that_cross(const std::vector<Vec3>& place, const std::vector<Triangle>& all) {
  return collision::self_intersections(place, all, collision::TriangleTree(place, all));
}

CrossingPairs without(const CrossingPairs& pairs, const CrossingPairs& known) {
  CrossingPairs left;
  std::set_difference(pairs.begin(), pairs.end(), known.begin(), known.end(),
                      std::back_inserter(left));
  return left;
}

/// The points of the cloth that places are carried by.
std::vector<Vec3> points_beneath(const Carried& carried, const std::vector<Vec3>& cloth,
                                 const std::vector<Triangle>& triangles) {
  std::vector<Vec3> beneath(carried.place.size(), Vec3::Zero());
  for (std::size_t i = 0; i < beneath.size(); ++i) {
    if (carried.particle[i] >= 0)
      continue;
    const Triangle& t = triangles[carried.triangle[i]];
    for (int k = 0; k < 3; ++k)
      beneath[i] += carried.barycentric[i][k] * cloth[t[k]];
  }
  return beneath;
}

/// Lowers shares of places that may move, until those of one triangle differ by no more than
/// NEIGHBOUR_STEP.
void lower_neighbours(const std::vector<Triangle>& all, const std::vector<char>& may_move,
                      std::vector<double>& share) {
  for (bool lowered = true; lowered;) {
    lowered = false;
    for (const Triangle& t : all) {
      const double most = std::min({share[t[0]], share[t[1]], share[t[2]]}) + NEIGHBOUR_STEP;
      for (const int v : t) {
        if (!may_move[v] || share[v] <= most + 1e-12)
          continue;
        share[v] = most;
        lowered = true;
      }
    }
  }
}

} // namespace

CrossingPairs keep_carried_clear(const Carried& carried, const std::vector<Vec3>& cloth,
                                 const std::vector<Triangle>& triangles,
                                 const std::vector<Triangle>& all, const CrossingPairs& known,
                                 Moved& moved) {
  CrossingPairs best_pairs = pairs_that_cross(moved.place, all);
  CrossingPairs added = without(best_pairs, known);
  if (added.empty())
    return best_pairs;
  const std::size_t n = carried.place.size();
  std::vector<char> may_move(n);
  for (std::size_t i = 0; i < n; ++i)
    may_move[i] = carried.particle[i] < 0 && carried.rigid[i] < 0;
  const std::vector<Vec3> beneath = points_beneath(carried, cloth, triangles), full = moved.place;
  std::vector<double> share(n, 1);
  std::vector<Vec3> place = full;
  std::size_t fewest = added.size();
  for (int round = 0; round < MOST_ROUNDS && !added.empty(); ++round) {
    const std::vector<double> before = share;
    for (const std::array<int, 2>& pair : added)
      for (const int f : pair)
        for (const int v : all[f])
          if (may_move[v])
            share[v] = std::max(LEAST_SHARE, before[v] - NEARER);
    lower_neighbours(all, may_move, share);
    if (share == before)
      break;
    for (std::size_t i = 0; i < n; ++i)
      if (may_move[i])
        place[i] = beneath[i] + share[i] * (full[i] - beneath[i]);
    CrossingPairs pairs = pairs_that_cross(place, all);
    added = without(pairs, known);
    if (added.size() >= fewest)
      continue;
    fewest = added.size();
    moved.place = place;
    best_pairs = std::move(pairs);
  }
  return best_pairs;
}

} // namespace sloper::garment

#include <sloper/collision/intersections.hpp>

#include <sloper/collision/chunks.hpp>
#include <sloper/collision/predicates.hpp>

#include <algorithm>

namespace sloper::collision {

namespace {

bool share_vertex(const Triangle& a, const Triangle& b) {
  for (int u : a)
    for (int v : b)
      if (u == v)
        return true;
  return false;
}

} // namespace

std::vector<std::array<int, 2>> self_intersections(const std::vector<Vec3>&,
                                                   const std::vector<Triangle>& triangles,
                                                   const TriangleTree& tree) {
  auto pairs = gather<std::array<int, 2>>(
      static_cast<std::size_t>(tree.n_slots()), [&](std::size_t begin, std::size_t end, auto& out) {
        for (auto slot = static_cast<int>(begin); slot < static_cast<int>(end); ++slot) {
          const int a = tree.triangle_of_slot(slot);
          tree.visit_slots(tree.dop_of_slot(slot, 0), slot + 1, [&](int other) {
            const int b = tree.triangle_of_slot(other);
            if (!share_vertex(triangles[a], triangles[b]) &&
                triangles_intersect(tree.corners(slot), tree.corners(other)))
              out.push_back({std::min(a, b), std::max(a, b)});
          });
        }
      });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

std::vector<EdgeFaceIntersection> edge_face_intersections(const std::vector<Vec3>& x,
                                                          const std::vector<Triangle>& triangles,
                                                          const Topology& topology,
                                                          const TriangleTree& tree) {
  return gather<EdgeFaceIntersection>(
      topology.edges.size(), [&](std::size_t begin, std::size_t end, auto& out) {
        for (std::size_t e = begin; e < end; ++e) {
          const int i = topology.edges[e][0],
                    j = topology.edges[e][1]; // clang 14 captures no structured binding
          const Vec3 &p = x[i], &q = x[j];
          Box3 box;
          box.add(p);
          box.add(q);
          const std::size_t first = out.size();
          tree.visit_overlaps(box, [&](int f) {
            const Triangle& t = triangles[f];
            if (t[0] == i || t[1] == i || t[2] == i || t[0] == j || t[1] == j || t[2] == j)
              return;
            const std::array<Vec3, 3> corner = {x[t[0]], x[t[1]], x[t[2]]};
            if (!segment_crosses_triangle(p, q, corner))
              return;
            const Vec3 n = area_normal(corner[0], corner[1], corner[2]);
            const double hp = n.dot(p - corner[0]), hq = n.dot(q - corner[0]);
            const double s = hp == hq ? 0.5 : std::clamp(hp / (hp - hq), 0.0, 1.0);
            const Vec3 point = (1 - s) * p + s * q;
            const PointTriangle on = point_triangle(point, corner[0], corner[1], corner[2]);
            out.push_back({static_cast<int>(e), f, s, on.barycentric, point});
          });
          std::sort(out.begin() + static_cast<long>(first), out.end(),
                    [](const auto& a, const auto& b) { return a.triangle < b.triangle; });
        }
      });
}

std::vector<int> triangles_through(const std::vector<Vec3>& positions,
                                   const std::vector<Triangle>& triangles,
                                   const TriangleTree& tree) {
  return gather<int>(triangles.size(), [&](std::size_t begin, std::size_t end, auto& out) {
    for (std::size_t f = begin; f < end; ++f) {
      const Triangle& t = triangles[f];
      const std::array<Vec3, 3> corner = {positions[t[0]], positions[t[1]], positions[t[2]]};
      Box3 box;
      for (const Vec3& p : corner)
        box.add(p);
      bool hit = false; // the traversal cannot be cut short, but the costly test can
      tree.visit_slots(tree.dop_of(box), 0, [&](int slot) {
        hit = hit || triangles_intersect(corner, tree.corners(slot));
      });
      if (hit)
        out.push_back(static_cast<int>(f));
    }
  });
}

} // namespace sloper::collision

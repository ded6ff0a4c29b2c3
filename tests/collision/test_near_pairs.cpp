/// The contact set of a cloth and a body against brute force, at every level: vertices against
/// faces, faces against vertices, edges against edges.
#include <support/shapes.hpp>

#include <gtest/gtest.h>
#include <set>
#include <sloper/base/parallel.hpp>
#include <sloper/collision/body_collider.hpp>
#include <sloper/collision/distance.hpp>

using namespace sloper;
using namespace sloper::collision;

namespace {

using Set = std::set<std::array<int, 3>>;

struct Sets {
  Set vertex_face, face_vertex, edge_edge; // the body's edge as its two vertices, ascending
};

std::array<int, 3> with_edge(int cloth, int a, int b) {
  return {cloth, std::min(a, b), std::max(a, b)};
}

/// All pairs, one by one. Edges of the body count where they bulge outward, or are no edge between
/// two faces.
Sets brute_force(const TriangleMesh& cloth, const Topology& topology, const TriangleMesh& body,
                 double vertex_radius, double edge_radius) {
  Sets s;
  const auto& x = cloth.positions;
  const auto& y = body.positions;
  const Topology skin = make_topology(y.size(), body.triangles);
  for (int v = 0; v < std::ssize(x); ++v)
    for (int g = 0; g < std::ssize(body.triangles); ++g) {
      const Triangle& t = body.triangles[g];
      if (point_triangle(x[v], y[t[0]], y[t[1]], y[t[2]]).squared_distance <=
          vertex_radius * vertex_radius)
        s.vertex_face.insert({v, g, 0});
    }
  for (int f = 0; f < std::ssize(cloth.triangles); ++f)
    for (int b = 0; b < std::ssize(y); ++b) {
      const Triangle& t = cloth.triangles[f];
      if (point_triangle(y[b], x[t[0]], x[t[1]], x[t[2]]).squared_distance <=
          edge_radius * edge_radius)
        s.face_vertex.insert({f, b, 0});
    }
  for (int k = 0; k < std::ssize(skin.edges); ++k) {
    const auto [b0, b1] = skin.edges[k];
    const auto around = skin.triangles_of_edge(k);
    if (around.size() ==
        2) { // convex where the far corner of one face lies below the plane of the other
      const Triangle& t = body.triangles[around[0]];
      const Vec3 n = area_normal(y[t[0]], y[t[1]], y[t[2]]).normalized();
      int far = -1;
      for (int v : body.triangles[around[1]])
        if (v != b0 && v != b1)
          far = v;
      const Vec3 outwards = y[far] - y[b0], line = (y[b1] - y[b0]).normalized();
      const double below =
          -n.dot(outwards) / (outwards - outwards.dot(line) * line).norm(); // sine of the angle
      EXPECT_GT(std::abs(below - 1e-3), 1e-6) << "the case is on the threshold";
      if (below <= 1e-3)
        continue;
    }
    for (int e = 0; e < std::ssize(topology.edges); ++e) {
      const auto [a0, a1] = topology.edges[e];
      if (edge_edge(x[a0], x[a1], y[b0], y[b1]).squared_distance <= edge_radius * edge_radius)
        s.edge_edge.insert(with_edge(e, b0, b1));
    }
  }
  return s;
}

Sets found(const TriangleMesh& cloth, const Topology& topology, const BodyCollider& body,
           double vertex_radius, double edge_radius) {
  BodyPairs pairs;
  body.near_pairs(cloth.positions, cloth.triangles, topology,
                  std::vector<char>(cloth.triangles.size(), 1), vertex_radius, edge_radius, pairs);
  Sets s;
  for (const auto& p : pairs.vertex_face)
    EXPECT_TRUE(s.vertex_face.insert({p.vertex, p.body_triangle, 0}).second) << "twice";
  for (const auto& p : pairs.face_vertex)
    EXPECT_TRUE(s.face_vertex.insert({p.triangle, p.body_vertex, 0}).second) << "twice";
  for (const auto& p : pairs.edge_edge) {
    const Triangle& t = body.mesh().triangles[p.body_triangle];
    EXPECT_TRUE(s.edge_edge.insert(with_edge(p.edge, t[p.side], t[(p.side + 1) % 3])).second)
        << "twice";
  }
  return s;
}

/// A crumpled sheet over a dented ball.
void expect_brute_force(std::uint64_t seed, int k, bool holes) {
  TriangleMesh body = shapes::sphere(2, 0.5), cloth = shapes::sheet(12, 12, 1.2, 1.2);
  shapes::jitter(body, 0.02, seed);
  if (holes)
    body.triangles.erase(body.triangles.begin() + 40, body.triangles.begin() + 60);
  for (Vec3& p : cloth.positions) {
    const Vec3 q = p - Vec3(0.6, 0.6, 0);
    p = Vec3(q.x(), q.y(), std::sqrt(std::max(0.0, 0.28 - q.head<2>().squaredNorm())));
  }
  shapes::jitter(cloth, 0.02, seed + 100);
  const Topology topology = make_topology(cloth.positions.size(), cloth.triangles);
  const BodyCollider collider(body, k);
  ASSERT_EQ(collider.findings().buried_triangles, 0);
  for (const auto& [vertex_radius, edge_radius] :
       {std::pair(0.05, 0.03), std::pair(0.02, 0.04), std::pair(0.2, 0.1)}) {
    const Sets right = brute_force(cloth, topology, collider.mesh(), vertex_radius, edge_radius);
    const Sets now = found(cloth, topology, collider, vertex_radius, edge_radius);
    EXPECT_GT(right.vertex_face.size(), 5U);
    EXPECT_GT(right.face_vertex.size(), 5U);
    EXPECT_GT(right.edge_edge.size(), 5U);
    EXPECT_EQ(now.vertex_face, right.vertex_face) << seed;
    EXPECT_EQ(now.face_vertex, right.face_vertex) << seed;
    EXPECT_EQ(now.edge_edge, right.edge_edge) << seed;
  }
}

} // namespace

TEST(NearPairs, of_cloth_and_body_are_those_of_brute_force_at_every_level) {
  for (std::uint64_t seed : {1, 2, 3})
    expect_brute_force(seed, 6, false);
}

TEST(NearPairs, are_those_of_brute_force_for_every_k_and_at_holes) {
  for (int k : {6, 14, 18, 26})
    expect_brute_force(4, k, true);
}

TEST(NearPairs, come_in_one_order_for_any_number_of_threads) {
  TriangleMesh body = shapes::sphere(3, 0.5), cloth = shapes::sheet(40, 40, 1, 1, 0.45);
  shapes::jitter(cloth, 0.05, 5);
  const Topology topology = make_topology(cloth.positions.size(), cloth.triangles);
  const BodyCollider collider(body);
  std::vector<std::array<int, 3>> first;
  for (int threads : {1, 2, 4}) {
    set_thread_count(threads);
    BodyPairs pairs;
    collider.near_pairs(cloth.positions, cloth.triangles, topology,
                        std::vector<char>(cloth.triangles.size(), 1), 0.1, 0.1, pairs);
    std::vector<std::array<int, 3>> list;
    for (const auto& p : pairs.edge_edge)
      list.push_back({p.edge, p.body_triangle, p.side});
    for (const auto& p : pairs.vertex_face)
      list.push_back({p.vertex, p.body_triangle, -1});
    for (const auto& p : pairs.face_vertex)
      list.push_back({p.triangle, p.body_vertex, -2});
    if (first.empty())
      first = list;
    EXPECT_EQ(list, first);
  }
  set_thread_count(1);
}

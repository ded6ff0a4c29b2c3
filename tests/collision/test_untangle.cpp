#include <sloper/collision/untangle.hpp>

#include <support/shapes.hpp>

#include <gtest/gtest.h>

namespace sloper::collision {
namespace {

struct Untangled {
  std::size_t at_first, left;
  int rounds;
};

/// Moves along the untangling displacements until nothing intersects or `rounds` are over; a little
/// smoothing of the motion stands in for the cloth that would carry its neighbours along.
Untangled untangle(TriangleMesh& mesh, double step, int rounds) {
  const Topology topology = make_topology(mesh.positions.size(), mesh.triangles);
  TriangleTree tree(mesh.positions, mesh.triangles);
  Untangled result{self_intersections(mesh.positions, mesh.triangles, tree).size(), 0, 0};
  for (; result.rounds < rounds; ++result.rounds) {
    const auto pairs = untangle_directions(mesh.positions, mesh.triangles, topology, tree);
    result.left = self_intersections(mesh.positions, mesh.triangles, tree).size();
    if (result.left == 0)
      break;
    auto d = untangle_displacements(pairs, mesh.triangles, topology, mesh.positions.size(), step);
    for (int pass = 0; pass < 3; ++pass) {
      auto smooth = d;
      for (std::size_t v = 0; v < d.size(); ++v) {
        Vec3 sum = d[v];
        int n = 1;
        for (int f : topology.triangles_of_vertex(static_cast<int>(v)))
          for (int u : mesh.triangles[f]) {
            sum += d[u];
            ++n;
          }
        smooth[v] = sum / n;
      }
      d = smooth;
    }
    for (std::size_t v = 0; v < d.size(); ++v)
      mesh.positions[v] += d[v];
    tree.refit(mesh.positions);
  }
  return result;
}

/// An upright sheet with a rounded lower rim that reaches through z = 0.
Vec3 flap(const Vec3& p) {
  return {0.21 + p.x(), 0.503 + 0.3 * p.y(), p.y() - 0.05 + 0.9 * (p.x() - 0.3) * (p.x() - 0.3)};
}

TEST(Untangle, FreeClothHasNothingToDo) {
  const TriangleMesh mesh = shapes::sheet(10, 10, 1, 1);
  const Topology topology = make_topology(mesh.positions.size(), mesh.triangles);
  EXPECT_TRUE(untangle_directions(mesh.positions, mesh.triangles, topology,
                                  TriangleTree(mesh.positions, mesh.triangles))
                  .empty());
  for (const Vec3& d :
       untangle_displacements({}, mesh.triangles, topology, mesh.positions.size(), 1))
    ASSERT_EQ(d, Vec3::Zero());
}

TEST(Untangle, ABumpThatHasGoneThroughASheetIsDrawnBack) {
  TriangleMesh mesh = shapes::sheet(20, 20, 1, 1);
  TriangleMesh upper = shapes::sheet(23, 23, 1, 1, 0.02);
  for (Vec3& p : upper.positions)
    p.z() -=
        0.06 * std::exp(-40 * ((p.x() - 0.52) * (p.x() - 0.52) + (p.y() - 0.47) * (p.y() - 0.47)));
  shapes::append(mesh, upper);
  const Untangled result = untangle(mesh, 0.004, 100);
  EXPECT_GT(result.at_first, 20u);
  EXPECT_EQ(result.left, 0u);
  RecordProperty("rounds", result.rounds);
}

TEST(Untangle, OneContourMovesEdgeAndFaceApartInOneDirection) {
  TriangleMesh mesh = shapes::sheet(20, 20, 1, 1);
  TriangleMesh upper = shapes::sheet(23, 23, 1, 1, 0.02);
  const auto base = static_cast<int>(mesh.positions.size());
  for (Vec3& p : upper.positions)
    p.z() -=
        0.06 * std::exp(-40 * ((p.x() - 0.52) * (p.x() - 0.52) + (p.y() - 0.47) * (p.y() - 0.47)));
  shapes::append(mesh, upper);
  const Topology topology = make_topology(mesh.positions.size(), mesh.triangles);
  const auto pairs = untangle_directions(mesh.positions, mesh.triangles, topology,
                                         TriangleTree(mesh.positions, mesh.triangles));
  ASSERT_FALSE(pairs.empty());
  for (const UntanglePair& pair : pairs) {
    EXPECT_EQ(pair.contour, 0);
    const bool upper_edge = topology.edges[pair.at.edge][0] >= base;
    ASSERT_GT(pair.direction.z() * (upper_edge ? 1 : -1), 0.9);
  }
}

TEST(Untangle, AFlapThroughAnEdgeIsDrawnOut) {
  // the rim of one sheet cuts a little way through another: an open contour
  TriangleMesh mesh = shapes::sheet(20, 20, 1, 1);
  TriangleMesh upright = shapes::sheet(17, 17, 0.6, 0.6);
  for (Vec3& p : upright.positions)
    p = flap(p);
  shapes::append(mesh, upright);
  const Untangled result = untangle(mesh, 0.004, 100);
  EXPECT_GT(result.at_first, 10u);
  EXPECT_EQ(result.left, 0u);
}

TEST(Untangle, PinnedVerticesStay) {
  TriangleMesh mesh = shapes::sheet(6, 6, 1, 1);
  const std::size_t base = mesh.positions.size();
  TriangleMesh upright = shapes::sheet(5, 5, 0.6, 0.6);
  for (Vec3& p : upright.positions)
    p = flap(p);
  shapes::append(mesh, upright);
  std::vector<double> inverse_mass(mesh.positions.size(), 1);
  std::fill(inverse_mass.begin(), inverse_mass.begin() + static_cast<long>(base), 0.0);
  const Topology topology = make_topology(mesh.positions.size(), mesh.triangles);
  const auto pairs = untangle_directions(mesh.positions, mesh.triangles, topology,
                                         TriangleTree(mesh.positions, mesh.triangles));
  const auto d = untangle_displacements(pairs, mesh.triangles, topology, mesh.positions.size(),
                                        0.01, inverse_mass);
  double most = 0;
  for (std::size_t v = 0; v < d.size(); ++v) {
    if (v < base)
      EXPECT_EQ(d[v], Vec3::Zero());
    else
      most = std::max(most, d[v].norm());
    ASSERT_LE(d[v].norm(), 0.01 + 1e-12);
  }
  EXPECT_GT(most, 0.005);
}

} // namespace
} // namespace sloper::collision

#include <support/mesh_quality.hpp>
#include <support/pattern_texts.hpp>

#include <gtest/gtest.h>
#include <sloper/base/error.hpp>
#include <sloper/pattern/mesh/boundary.hpp>

namespace sloper::pattern::test {
namespace {

/// One long edge of `front` sewn to two edges of other panels of unequal length, and back.
const char* ONE_TO_N =
    R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "n", "panels": [
  {"name": "long", "outline": [{"edge": "bottom", "path": [["M", 0, 0], ["L", 50, 0]]}, {"edge": "r", "path": [["L", 50, 20]]}, {"edge": "top", "path": [["L", 0, 20]]}, {"edge": "l", "path": [["L", 0, 0]]}]},
  {"name": "one", "outline": [{"edge": "bottom", "path": [["M", 0, 0], ["L", 17.3, 0]]}, {"edge": "r", "path": [["L", 17.3, 20]]}, {"edge": "top", "path": [["L", 0, 20]]}, {"edge": "l", "path": [["L", 0, 0]]}]},
  {"name": "two", "outline": [{"edge": "bottom", "path": [["M", 0, 0], ["L", 33, 0]]}, {"edge": "r", "path": [["L", 33, 20]]}, {"edge": "top", "path": [["L", 0, 20]]}, {"edge": "l", "path": [["L", 0, 0]]}]}],
  "seams": [{"name": "n", "a": [{"panel": "one", "edge": "bottom"}, {"panel": "two", "edge": "bottom"}], "b": [{"panel": "long", "edge": "top"}]},
            {"name": "middle", "a": [{"panel": "two", "edge": "l"}], "b": [{"panel": "one", "edge": "r"}]}]})";

TEST(Boundary, BothSidesOfEverySeamHaveTheSameNumberOfVertices) {
  for (double h : {0.004, 0.015, 0.05}) {
    const PanelMesh mesh = mesh_pattern(own(ONE_TO_N), h, "test.json");
    ASSERT_EQ(mesh.seams.size(), 2u);
    for (const MeshSeam& s : mesh.seams)
      EXPECT_EQ(s.a.size(), s.b.size());
  }
}

TEST(Boundary, ACornerWithinALongEdgeGetsAVertexThere) {
  const PanelMesh mesh = mesh_pattern(own(ONE_TO_N), 0.015, "test.json");
  const double at = 0.5 * 17.3 / 50.3; // linear in arc length over the whole seam; `top` is walked
                                       // against its sense, from x = 0
  bool found = false;
  for (int v : mesh.panels[0].outline)
    found = found || (mesh.pattern[v] - Vec2(at, 0.2)).norm() < 1e-9;
  EXPECT_TRUE(found);
}

TEST(Boundary, AHoleTooSmallForTheMeshIsLeftOutAndTold) {
  const std::string text =
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "eyelet", "panels": [{"name": "p", "outline": [
    {"edge": "b", "path": [["M", 0, 0], ["L", 20, 0]]}, {"edge": "r", "path": [["L", 20, 30]]}, {"edge": "t", "path": [["L", 0, 30]]}, {"edge": "l", "path": [["L", 0, 0]]}],
    "holes": [[{"edge": "h1", "path": [["M", 10, 10], ["L", 10, 10.3]]}, {"edge": "h2", "path": [["L", 10.3, 10.15]]}, {"edge": "h3", "path": [["L", 10, 10]]}]]}]})";
  const PanelMesh coarse = mesh_pattern(own(text), 0.02, "test.json"),
                  fine = mesh_pattern(own(text), 0.002, "test.json");
  EXPECT_EQ(sew(coarse).boundary_loops, 1);
  EXPECT_EQ(sew(fine).boundary_loops, 2);
  const auto has_finding = [](const PanelMesh& m) {
    return std::any_of(m.findings.begin(), m.findings.end(),
                       [](const Message& f) { return f.text.find("p: the hole at h1") == 0; });
  };
  EXPECT_TRUE(has_finding(coarse));
  EXPECT_FALSE(has_finding(fine));
}

TEST(Boundary, SewnOneToNIsAnOrientedManifold) {
  const Sewn sewn = sew(mesh_pattern(own(ONE_TO_N), 0.015, "test.json"));
  EXPECT_EQ(sewn.degenerate, 0);
  EXPECT_EQ(sewn.wrong_direction, 0);
  EXPECT_EQ(sewn.non_manifold, 0);
  EXPECT_EQ(sewn.boundary_loops, 1);
}

TEST(Boundary, PartOfAnEdgeCanBeSewn) {
  const std::string text =
      R"({"format": "pattern", "version": 1, "length_unit": "m", "name": "slit", "panels": [
    {"name": "p", "outline": [{"edge": "b", "path": [["M", 0, 0], ["L", 0.4, 0]]}, {"edge": "r", "path": [["L", 0.4, 0.6]]}, {"edge": "t", "path": [["L", 0, 0.6]]}, {"edge": "l", "path": [["L", 0, 0]]}]}],
    "seams": [{"name": "tube with a slit", "a": [{"panel": "p", "edge": "r", "from": 0.25, "to": 1}], "b": [{"panel": "p", "edge": "l", "from": 0.75, "to": 0}]}]})";
  const PanelMesh mesh = mesh_pattern(own(text), 0.02, "test.json");
  EXPECT_NEAR(mesh.pattern[mesh.seams[0].a.front()].y(), 0.15, 1e-12);
  EXPECT_NEAR(mesh.pattern[mesh.seams[0].b.front()].y(), 0.15, 1e-12);
  const Sewn sewn = sew(mesh);
  EXPECT_EQ(sewn.wrong_direction + sewn.non_manifold + sewn.degenerate, 0);
  EXPECT_EQ(sewn.boundary_loops, 2); // the top, and the hem with the slit
}

TEST(Boundary, TinyEdgesAreMergedAndReported) {
  const std::string text =
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "t", "panels": [
    {"name": "p", "outline": [{"edge": "b", "path": [["M", 0, 0], ["L", 40, 0]]}, {"edge": "chamfer", "path": [["L", 40.1, 0.1]]}, {"edge": "r", "path": [["L", 40.1, 30]]},
      {"edge": "t", "path": [["L", 0, 30]]}, {"edge": "l", "path": [["L", 0, 0]]}]}]})";
  const PanelMesh mesh = mesh_pattern(own(text), 0.015, "test.json");
  EXPECT_TRUE(std::any_of(mesh.findings.begin(), mesh.findings.end(), [](const Message& f) {
    return f.text.find("p: chamfer") != std::string::npos &&
           f.text.find("0.14 cm") != std::string::npos;
  }));
  EXPECT_GT(smallest_angle_deg(mesh), 25);
}

TEST(Boundary, AConeSewnFromOneSectorHasNoFoldedFaces) {
  const std::string text =
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "cone", "panels": [
    {"name": "p", "outline": [{"edge": "a", "path": [["M", 0, 0], ["L", 30, 0]]}, {"edge": "hem", "path": [["A", 30, 0, 1, 0, 30]]}, {"edge": "b", "path": [["L", 0, 0]]}]}],
    "seams": [{"name": "side", "a": [{"panel": "p", "edge": "a"}], "b": [{"panel": "p", "edge": "b"}]}]})";
  const Sewn sewn = sew(mesh_pattern(own(text), 0.015, "test.json"));
  EXPECT_EQ(sewn.degenerate, 0);
  EXPECT_EQ(sewn.duplicate_faces, 0);
  EXPECT_EQ(sewn.non_manifold, 0);
  EXPECT_EQ(sewn.wrong_direction, 0);
}

TEST(Boundary, AnEdgeSewnTwiceIsRefusedWithCentimetres) {
  const std::string text = tube_text(
      R"(, {"name": "again", "a": [{"panel": "front", "edge": "side_l", "from": 0.5, "to": 1}], "b": [{"panel": "back", "edge": "top"}]})");
  try {
    mesh_pattern(own(text), 0.015, "test.json");
    FAIL() << "sewn twice and not refused";
  } catch (const Error& e) {
    EXPECT_EQ(e.exit_code(), 3);
    EXPECT_NE(std::string(e.what()).find("front: side_l"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("30.00 cm"), std::string::npos) << e.what();
  }
}

} // namespace
} // namespace sloper::pattern::test

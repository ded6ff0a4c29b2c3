#include <support/placement_patterns.hpp>

#include <gtest/gtest.h>
#include <pattern/mesh/roll_lines.hpp>
#include <sloper/pattern/mesh/folds.hpp>
#include <sloper/pattern/place/place_panels.hpp>
#include <sloper/pattern/write/export_pattern.hpp>

namespace sloper::pattern::test {
namespace {

std::string roll(const std::string& path) {
  return R"("lines": [{"name": "roll", "kind": "roll", "path": )" + path + "}]";
}

/// A stand around the neck and a leaf on its upper edge, and a yoke that they hang on. cm.
Pattern collar_pattern(bool turned) {
  std::string leaf = rectangle("collar", 44, 6);
  if (turned)
    leaf.insert(leaf.size() - 1, ", " + roll(R"([["M", 0, 0], ["L", 44, 0]])"));
  return own(
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "collar", "panels": [)" +
      rectangle("front", 40, 50) + "," + rectangle("back", 40, 50) + "," +
      rectangle("stand", 44, 3) + "," + leaf + R"(], "seams": [
    {"name": "side_l", "a": [{"panel": "front", "edge": "l"}], "b": [{"panel": "back", "edge": "r"}]},
    {"name": "side_r", "a": [{"panel": "back", "edge": "l"}], "b": [{"panel": "front", "edge": "r"}]},
    {"name": "shoulder_l", "a": [{"panel": "front", "edge": "top", "from": 0, "to": 0.25}], "b": [{"panel": "back", "edge": "top", "from": 1, "to": 0.75}]},
    {"name": "shoulder_r", "a": [{"panel": "back", "edge": "top", "from": 0, "to": 0.25}], "b": [{"panel": "front", "edge": "top", "from": 1, "to": 0.75}]},
    {"name": "neck", "a": [{"panel": "stand", "edge": "hem", "from": 0.25, "to": 0.75}], "b": [{"panel": "back", "edge": "top", "from": 0.75, "to": 0.25}], "ease": "test"},
    {"name": "leaf", "a": [{"panel": "collar", "edge": "hem"}], "b": [{"panel": "stand", "edge": "top"}]}]})");
}

TEST(RollLines, ClothAtTheLeftOfALineGoesToItsMirrorImage) {
  const Pattern pattern = own(
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "t", "panels": [{"name": "front", "outline": [
      {"edge": "a", "path": [["M", 0, 0], ["L", 40, 0]]}, {"edge": "b", "path": [["L", 40, 60]]}, {"edge": "c", "path": [["L", 0, 60], ["L", 0, 0]]}], )" +
      roll(R"([["M", 0, 20], ["L", 10, 60]])") + R"(}], "seams": []})");
  const RollLines rolls(pattern.panels[0]);
  const auto [turned, image] = rolls.across(Vec2(0, 0.6));
  EXPECT_GT(turned, 0);
  EXPECT_NEAR(image.x(), 0.1882353, 1e-6); // (0, 60) mirrored across (10, 40) from (0, 20)
  EXPECT_NEAR(image.y(), 0.5529412, 1e-6);
  EXPECT_LT(rolls.across(Vec2(0.3, 0.3)).first, 0);
  EXPECT_NEAR(rolls.across(Vec2(0.05, 0.4)).first, 0, 1e-9);
  EXPECT_FALSE(turned_whole(pattern.panels[0]));
  const PanelMesh mesh = mesh_pattern(pattern, 0.015, "t");
  const Folding folding = fold_panels(pattern, mesh);
  for (std::size_t v = 0; v < mesh.pattern.size(); ++v) {
    const bool beyond = rolls.across(mesh.pattern[v]).first > 1e-9;
    EXPECT_EQ(folding.shift[v].norm() > 1e-9, beyond);
    EXPECT_LE(folding.depth[v], 0) << "outwards";
  }
  EXPECT_GT(pleat_edges(mesh).size(), 20u) << "the mesh has edges along the line";
  const Panel image_panel = mirror_image(pattern.panels[0]);
  EXPECT_GT(RollLines(image_panel).across(Vec2(0, 0.6)).first, 0)
      << "the same cloth of the other one of a pair";
}

TEST(RollLines, ACollarTurnedOverOnItsSeamStartsOutsideOfItsStandAndHangsDown) {
  for (const bool turned : {false, true}) {
    const Pattern pattern = collar_pattern(turned);
    EXPECT_EQ(turned_whole(pattern.panels[3]), turned);
    PanelMesh mesh = mesh_pattern(pattern, 0.012, "t");
    for (const Message& finding : mesh.findings)
      EXPECT_EQ(finding.text.find("line roll"), std::string::npos) << finding.text;
    const PlacementReport report = place_panels(pattern, stick_body(45), mesh);
    EXPECT_EQ(report.crossings, 0);
    EXPECT_EQ(report.vertices_inside, 0);
    const Vec3 stand = middle(mesh, 2), leaf = middle(mesh, 3);
    if (turned)
      EXPECT_LT(leaf.y(), stand.y()) << "its free edge is down";
    else
      EXPECT_GT(leaf.y(), stand.y());
    double far_stand = 0, near_leaf = 1e300; // from the axis, behind
    for (int k : {2, 3}) {
      const PanelInfo& info = mesh.panels[k];
      for (int v = info.first_vertex; v < info.first_vertex + info.n_vertices; ++v) {
        const Vec3& p = mesh.placed[v];
        if (std::abs(p.x()) > 0.02 || p.z() > 0)
          continue;
        if (k == 2)
          far_stand = std::max(far_stand, std::abs(p.z()));
        else
          near_leaf = std::min(near_leaf, std::abs(p.z()));
      }
    }
    if (turned) {
      EXPECT_GT(near_leaf, far_stand);
    }
    EXPECT_EQ(mesh.panels[3].layer, 0) << "what the pattern says stays";
  }
}

TEST(RollLines, ACoarseMeshOfACollarHasRoomForALineInIt) {
  std::string leaf = rectangle("collar", 44, 5);
  leaf.insert(leaf.size() - 1, ", " + roll(R"([["M", 0, 1.5], ["L", 44, 1.5]])"));
  const Pattern pattern = own(
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "collar", "panels": [)" +
      rectangle("front", 44, 50) + "," + leaf + R"(], "seams": [
      {"name": "neck", "a": [{"panel": "front", "edge": "top"}], "b": [{"panel": "collar", "edge": "hem"}]}]})");
  constexpr double USUAL = 0.048;
  const auto length_along = [&](const PanelMesh& mesh) {
    double sum = 0;
    for (const auto& [a, b] :
         edges_along(mesh, mesh.panels[1], mesh.source->panels[1].lines[0].path))
      sum += (mesh.pattern[a] - mesh.pattern[b]).norm();
    return sum;
  };
  const PanelMesh alike = mesh_pattern(pattern, USUAL, "t");
  EXPECT_EQ(length_along(alike), 0);
  const auto is_left_out = [](const Message& finding) {
    return finding.id == std::string("mesh.line-left-out");
  };
  EXPECT_EQ(std::count_if(alike.findings.begin(), alike.findings.end(), is_left_out), 1)
      << "it was taken for one along the outline, and nothing was said";
  const MeshLengths lengths = lengths_for_rolls(pattern, USUAL);
  EXPECT_EQ(lengths.of_panel[0], USUAL) << "no roll line";
  EXPECT_NEAR(lengths.of_panel[1], 0.015, 0.001) << "as far as the line lies from the outline";
  const PanelMesh mesh = mesh_pattern(pattern, lengths, "t");
  EXPECT_GT(length_along(mesh), 0.8 * 0.44);
  EXPECT_EQ(std::count_if(mesh.findings.begin(), mesh.findings.end(), is_left_out), 0);
  EXPECT_EQ(mesh.seams[0].a.size(), mesh.seams[0].b.size());
  EXPECT_GT(mesh.seams[0].a.size(), 25u) << "the front is as fine where it is sewn to the collar";
  EXPECT_LT(mesh.panels[0].n_vertices, 300) << "and coarse away from it";
}

TEST(RollLines, WithRoomForThemChangeNoMesh) {
  for (const char* line :
       {"", R"([["M", 0, 0], ["L", 44, 0]])", R"([["M", 0, 20], ["L", 44, 20]])"}) {
    std::string leaf = rectangle("leaf", 44, 40);
    if (*line)
      leaf.insert(leaf.size() - 1, ", " + roll(line));
    const Pattern pattern = own(
        R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "leaf", "panels": [)" +
        rectangle("front", 44, 50) + "," + leaf + R"(], "seams": [
        {"name": "neck", "a": [{"panel": "front", "edge": "top"}], "b": [{"panel": "leaf", "edge": "hem"}]}]})");
    const PanelMesh plain = mesh_pattern(pattern, 0.015, "t", 0.01),
                    with_room = mesh_pattern(pattern, lengths_for_rolls(pattern, 0.015, 0.01), "t");
    EXPECT_EQ(with_room.pattern, plain.pattern) << line;
    EXPECT_EQ(with_room.triangles, plain.triangles) << line;
    EXPECT_EQ(with_room.seam_length, plain.seam_length) << line;
  }
}

TEST(RollLines, AreWrittenAndReadBack) {
  const Pattern pattern = collar_pattern(true);
  const Pattern again = own(pattern_json(pattern, "test").dump());
  ASSERT_EQ(again.panels[3].lines.size(), 1u);
  EXPECT_EQ(again.panels[3].lines[0].kind, "roll");
}

} // namespace
} // namespace sloper::pattern::test

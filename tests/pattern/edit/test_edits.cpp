#include <support/mesh_quality.hpp>
#include <support/pattern_texts.hpp>

#include <gtest/gtest.h>
#include <pattern/mesh/triangulate.hpp>
#include <sloper/base/error.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/edit/edits.hpp>
#include <sloper/pattern/write/export_pattern.hpp>

namespace sloper::pattern::test {
namespace {

void edit(Pattern& pattern, const std::string& edits) {
  apply_edits(
      pattern,
      io::parse_json(R"({"format": "edits", "version": 1, "length_unit": "cm", "edits": [)" +
                         edits + "]}",
                     "edits.json"),
      "edits.json");
}

std::vector<Vec2> points(const Pattern& pattern) {
  std::vector<Vec2> out;
  for (const Panel& p : pattern.panels)
    for (const auto& loop : p.loops)
      for (const PanelEdge& e : loop)
        for (const Segment& s : e.path)
          out.insert(out.end(), s.p.begin(), s.p.end());
  return out;
}

TEST(Edits, MovesAreUndoneToTheLastBit) {
  const std::pair<const char*, const char*> pairs[] = {
      {R"({"edit": "move-point", "panel": "front", "edge": "side_l", "end": "end", "by": [1.37, -0.7]})",
       R"({"edit": "move-point", "panel": "front", "edge": "side_l", "end": "end", "by": [-1.37, 0.7]})"},
      {R"({"edit": "move-edge", "panel": "back", "edge": "hem", "by": [0.1, 3.33]})",
       R"({"edit": "move-edge", "panel": "back", "edge": "hem", "by": [-0.1, -3.33]})"},
      {R"({"edit": "take-in", "panel": "front", "edge": "side_r", "by": 1.1})",
       R"({"edit": "let-out", "panel": "front", "edge": "side_r", "by": 1.1})"}};
  for (const auto& [one, other] : pairs) {
    Pattern pattern = own(tube_text());
    edit(pattern, "");
    const std::vector<Vec2> before = points(pattern);
    edit(pattern, one);
    EXPECT_NE(points(pattern), before) << one;
    edit(pattern, other);
    EXPECT_EQ(points(pattern), before) << one;
  }
}

TEST(Edits, SetLengthGivesTheLength) {
  Pattern pattern = own(tube_text());
  edit(
      pattern,
      R"({"edit": "set-length", "panel": "front", "edge": "hem", "length": 44.4, "fixed": "middle"})");
  EXPECT_NEAR(length(pattern.panels[0].edge(0).path), 0.444, 1e-8);
  edit(pattern, R"({"edit": "set-length", "seam": "left", "length": 55})");
  EXPECT_NEAR(side_length(pattern, pattern.seams[0].a), 0.55, 1e-8);
  EXPECT_NEAR(side_length(pattern, pattern.seams[0].b), 0.55, 1e-8);
  finish_pattern(pattern, "t"); // still closed and sound
  EXPECT_EQ(sew(mesh_pattern(pattern, 0.02, "t")).non_manifold, 0);
}

TEST(Edits, ReplayGivesTheSameOutline) {
  const std::string log =
      R"({"edit": "lengthen", "panel": "front", "at": [0, 30], "along": [0, 1], "by": 4}, {"edit": "scale", "x": 1.1, "y": 0.95}, {"edit": "shrink", "panel": "back", "warp": 0.8, "weft": 1})";
  Pattern one = own(tube_text()), two = own(tube_text());
  edit(one, log);
  edit(two, log);
  EXPECT_EQ(points(one), points(two));
  EXPECT_NEAR(outline_area(one.panels[0]), 0.4 * 1.1 * 0.64 * 0.95, 1e-8);
  EXPECT_NEAR(outline_area(one.panels[1]), 0.4 * 1.1 * 0.6 * 0.95 * 0.8, 1e-8);
}

TEST(Edits, AMeshFollowsWithItsIdsAndTriangles) {
  const Pattern before = own(tube_text());
  Pattern after = before;
  edit(
      after,
      R"({"edit": "set-length", "panel": "front", "edge": "hem", "length": 46, "fixed": "middle"}, {"edit": "move-edge", "panel": "back", "edge": "hem", "by": [0, -5]})");
  PanelMesh mesh = mesh_pattern(before, 0.015, "t");
  const PanelMesh old = mesh;
  ASSERT_TRUE(follow_edits(before, after, mesh, 15));
  ASSERT_TRUE(mesh.source);
  EXPECT_EQ(pattern_json(*mesh.source, "test"), pattern_json(after, "test"))
      << "the mesh names the pattern that it is of now";
  EXPECT_EQ(mesh.triangles, old.triangles);
  for (std::size_t v = 0; v < mesh.ids.size(); ++v)
    EXPECT_EQ(mesh.ids[v].t, old.ids[v].t);
  for (std::size_t p = 0; p < 2; ++p)
    EXPECT_NEAR(mesh_area(mesh, mesh.panels[p]), outline_area(after.panels[p]),
                1e-3 * outline_area(after.panels[p]));
  EXPECT_GT(smallest_angle_deg(mesh), 15);
}

TEST(Edits, NoEditLeavesTheMeshWhereItIs) {
  const Pattern before = own(tube_text());
  PanelMesh mesh = mesh_pattern(before, 0.015, "t");
  const PanelMesh old = mesh;
  ASSERT_TRUE(follow_edits(before, before, mesh, 15));
  for (std::size_t v = 0; v < mesh.pattern.size(); ++v)
    EXPECT_LT((mesh.pattern[v] - old.pattern[v]).norm(), 1e-8);
}

TEST(Edits, AnEditTooWildForTheMeshIsToldSo) {
  const Pattern before = own(tube_text());
  Pattern after = before;
  edit(after, R"({"edit": "scale", "panel": "front", "x": 0.15, "y": 1})");
  PanelMesh mesh = mesh_pattern(before, 0.015, "t");
  EXPECT_FALSE(follow_edits(before, after, mesh, 15));
}

TEST(Edits, NumbersBeyondAllBoundsAreRefusedBeforeTheyAreMeshed) {
  for (
      const char* edit :
      {R"({"edit": "scale", "x": 1e6, "y": 1})",
       R"({"edit": "bend", "panel": "front", "edge": "top", "by": [0, 1e300]})",
       R"({"edit": "grade", "width": 1e200})",
       R"({"edit": "shrink", "panel": "front", "curve": [["M", 0, 0], ["L", 1e250, 1e250]], "factor": 0.5, "width": 1})"}) {
    Pattern p = own(tube_text());
    EXPECT_THROW(
        apply_edits(
            p,
            io::parse_json(R"({"format": "edits", "version": 1, "length_unit": "cm", "edits": [)" +
                               std::string(edit) + "]}",
                           "e"),
            "e"),
        Error)
        << edit;
  }
}

TEST(Edits, ALineBesideAPanelLengthensNothingAndIsRefused) {
  const Pattern before = own(tube_text());
  const auto lengthened = [&](const std::string& edit_name, double y, const char* along) {
    Pattern after = before;
    edit(after, R"({"edit": ")" + edit_name + R"(", "panel": "front", "at": [0, )" +
                    std::to_string(y) + R"(], "along": )" + along + R"(, "by": 3})");
    return points(after);
  };
  const char *up = "[0, 1]", *down = "[0, -1]";
  for (const auto& [name, y, along] : {std::tuple{"lengthen", 150.0, up},
                                       {"lengthen", 150.0, down},
                                       {"shorten", -0.1, up},
                                       {"lengthen", 60.0, up},
                                       {"shorten", -1.0, down}}) { // 60 is the top itself
    try {
      lengthened(name, y, along);
      ADD_FAILURE() << name << " at " << y << " along " << along;
    } catch (const Error& e) {
      EXPECT_EQ(e.id(), "edit.line-does-not-cut"_id) << e.what();
      EXPECT_EQ(e.place(), "/edits/0/at");
      EXPECT_NE(e.fact().find("panel front"), std::string::npos) << e.what();
      EXPECT_NE(e.next_step(), "");
    }
  }
  EXPECT_NE(lengthened("lengthen", 0, up), points(before)) << "from the hem on";
  EXPECT_NE(lengthened("shorten", 59.9, up), points(before));
}

TEST(Edits, WrongNamesAreRefusedWithASuggestion) {
  Pattern pattern = own(tube_text());
  for (const char* wrong :
       {R"({"edit": "moove-point", "panel": "front", "edge": "hem", "by": [1, 0]})",
        R"({"edit": "move-point", "panel": "frunt", "edge": "hem", "by": [1, 0]})",
        R"({"edit": "move-point", "panel": "front", "edge": "hm", "by": [1, 0]})",
        R"({"edit": "move-point", "panel": "front", "edge": "hem", "bye": [1, 0]})"}) {
    try {
      edit(pattern, wrong);
      FAIL() << wrong;
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find("did you mean"), std::string::npos) << e.what();
    }
  }
}

} // namespace
} // namespace sloper::pattern::test

#include <gtest/gtest.h>
#include <sloper/base/error.hpp>
#include <sloper/pattern/mesh/fold_lines.hpp>
#include <sloper/pattern/mesh/folds.hpp>
#include <sloper/pattern/mesh/mesh_pattern.hpp>
#include <support/placement_patterns.hpp>

namespace sloper::pattern::test {
namespace {

/// A collar of 40 cm that curves up in the middle, sewn on its lower edge to a stand. cm.
Pattern curved_collar() {
  return own(
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "collar", "panels": [
      {"name": "collar", "outline": [{"edge": "low", "path": [["M", -20, 0], ["Q", 0, 12, 20, 0]]},
        {"edge": "b", "path": [["L", 22, 5]]}, {"edge": "free", "path": [["Q", 0, 18, -22, 5]]},
        {"edge": "d", "path": [["L", -20, 0]]}]},)" +
      rectangle("stand", 40, 4) +
      R"(], "seams": [{"name": "low", "a": [{"panel": "collar", "edge": "low"}], "b": [{"panel": "stand", "edge": "top"}], "ease": "test"}]})");
}

TEST(FoldLines, ACurveGoesThroughItsPlacesWithoutCorners) {
  const std::vector<Vec2> points{{0, 0}, {0.1, 0.05}, {0.15, 0.05}, {0.3, 0}};
  const Path path = curve_through(points);
  ASSERT_EQ(path.size(), 3u);
  for (std::size_t k = 0; k < path.size(); ++k) {
    EXPECT_LT((path[k].p[0] - points[k]).norm(), 1e-15);
    EXPECT_LT((path[k].p[3] - points[k + 1]).norm(), 1e-15);
  }
  const ArcLength arc(path);
  EXPECT_LT(arc.length(), 0.35);
  for (std::size_t k = 1; k < path.size(); ++k)
    EXPECT_GT(path[k - 1].derivative(1).normalized().dot(path[k].derivative(0).normalized()),
              1 - 1e-9);
  const Path line = curve_through({{0, 0}, {0.1, 0.2}});
  EXPECT_TRUE(line.size() == 1 && line[0].line);
}

TEST(FoldLines, ALineIsTakenWhereItRunsOverThePanel) {
  const Panel collar = curved_collar().panels[0];
  // From beside the panel to beside it: its ends come to lie on the outline.
  const Path path =
      on_panel(collar, curve_through({{-0.25, 0.03}, {0, 0.075}, {0.25, 0.03}}), 0.004, "s", "/x");
  for (const Vec2& end : {path.front().p[0], path.back().p[3]})
    EXPECT_GE(on_outline(collar, end).edge, 0);
  EXPECT_LT(length(path), 0.46);
  EXPECT_GT(length(path), 0.42);
  // An end 3 mm from a corner lies in it; an end within the cloth stays.
  const Path corner = on_panel(collar, curve_through({{-0.25, 0.04}, {0, 0.1}}), 0.004, "s", "/x");
  EXPECT_LT((corner.front().p[0] - Vec2(-0.22, 0.05)).norm(), 1e-9);
  EXPECT_LT((corner.back().p[3] - Vec2(0, 0.1)).norm(), 1e-9);
}

TEST(FoldLines, ALineThatMissesThePanelOrComesBackToItIsRefusedWithItsPlace) {
  const Panel collar = curved_collar().panels[0];
  for (const auto& [from, to, fact] : std::vector<std::tuple<Vec2, Vec2, std::string>>{
           {{-0.25, 0.2}, {0.25, 0.2}, "misses panel collar"},
           {{-0.25, 0.02}, {0.25, 0.02}, "leaves panel collar for 32.66 cm and comes back"}}) {
    try {
      on_panel(collar, curve_through({from, to}), 0.004, "s.json", "/creases/0");
      FAIL() << fact;
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), ErrorKind::INPUT);
      EXPECT_EQ(e.place(), "/creases/0");
      EXPECT_NE(e.fact().find(fact), std::string::npos) << e.fact();
      EXPECT_NE(e.next_step().find("via"), std::string::npos);
    }
  }
}

TEST(FoldLines, WhatHangsFreeIsTurnedOverWhicheverWayTheLineIsWalked) {
  const Pattern pattern = curved_collar();
  const Path path = on_panel(
      pattern.panels[0], curve_through({{-0.25, 0.03}, {0, 0.075}, {0.25, 0.03}}), 0.004, "", "");
  for (const Path& line : {path, reversed(path)}) {
    Pattern drawn = pattern;
    drawn.panels[0].lines.push_back(roll_line(pattern, 0, "roll", line));
    const PanelMesh mesh = mesh_pattern(drawn, 0.012, "t");
    const Folding folding = fold_panels(drawn, mesh);
    const ArcLength free(drawn.panels[0].edge(2).path);
    const PanelInfo& collar = mesh.panels[0];
    for (int v : collar.outline) {
      if ((mesh.pattern[v] - free.at(free.length() / 2)).norm() < 0.02) {
        EXPECT_LT(folding.depth[v], 0);
      }
      if ((mesh.pattern[v] - Vec2(0, 0.06)).norm() < 0.012) {
        EXPECT_EQ(folding.depth[v], 0);
      }
    }
    double along = 0;
    for (const auto& [a, b] : edges_along(mesh, collar, path))
      along += (mesh.pattern[a] - mesh.pattern[b]).norm();
    EXPECT_GT(along, 0.85 * length(path));
  }
}

} // namespace
} // namespace sloper::pattern::test

/// Turned collars and lapels lie outside of what they are turned over.
#include <garment/levels/turned_leaves.hpp>
#include <gtest/gtest.h>
#include <mannequin.hpp>
#include <measures.hpp>
#include <sloper/base/progress.hpp>
#include <sloper/body/measure_scan.hpp>
#include <sloper/garment/bind/bind.hpp>
#include <sloper/garment/composite.hpp>
#include <sloper/garment/drape/drape.hpp>
#include <sloper/garment/fit/fit.hpp>
#include <sloper/garment/materials.hpp>
#include <sloper/garment/scene/scene_folds.hpp>
#include <sloper/garment/sewing.hpp>
#include <sloper/garment/simulate/roll_line_states.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/mesh/fold_lines.hpp>
#include <sloper/pattern/mesh/mesh_pattern.hpp>
#include <sloper/pattern/place/place_panels.hpp>
#include <sloper/pattern/read/read_pattern.hpp>
#include <support/made_figure.hpp>

using namespace sloper;
using namespace sloper::garment;

namespace {

/// A front of 20 x 20 cm in the plane z = 0, and a leaf of 16 x 6 cm, sewn to its top and turned
/// over it, at `z`.
Garment front_with_leaf(double z) {
  const std::string text =
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "two", "panels": [
    {"name": "front", "outline": [{"edge": "hem", "path": [["M", -10, 0], ["L", 10, 0]]}, {"edge": "left", "path": [["L", 10, 20]]},
      {"edge": "shoulder_l", "path": [["L", 8, 20]]}, {"edge": "top", "path": [["L", -8, 20]]},
      {"edge": "shoulder_r", "path": [["L", -10, 20]]}, {"edge": "right", "path": [["L", -10, 0]]}]},
    {"name": "leaf", "outline": [{"edge": "low", "path": [["M", -8, 0], ["L", 8, 0]]}, {"edge": "left", "path": [["L", 8, 6]]},
      {"edge": "free", "path": [["L", -8, 6]]}, {"edge": "right", "path": [["L", -8, 0]]}],
      "lines": [{"name": "roll", "kind": "roll", "path": [["M", -8, 0], ["L", 8, 0]]}]}],
    "seams": [{"name": "low", "a": [{"panel": "front", "edge": "top"}], "b": [{"panel": "leaf", "edge": "low"}]}]})";
  const pattern::Pattern source = pattern::read_pattern_json(io::parse_json(text, "two"), "two");
  Garment garment;
  garment.panels = pattern::mesh_pattern(source, 0.015, "two");
  std::vector<Vec3> placed;
  for (const pattern::PanelInfo& panel : garment.panels.panels)
    for (int v = panel.first_vertex; v < panel.first_vertex + panel.n_vertices; ++v) {
      const Vec2& p = garment.panels.pattern[v];
      const bool leaf = panel.name == "leaf";
      placed.emplace_back(p.x(), leaf ? 0.2 - p.y() : p.y(), leaf && p.y() > 1e-6 ? z : 0);
    }
  unsew(garment);
  garment.position = placed;
  weld(garment, placed);
  return garment;
}

} // namespace

TEST(TurnedLeaves, a_leaf_beneath_the_front_comes_to_lie_on_it_and_the_front_stays) {
  Garment garment = front_with_leaf(-0.01);
  const std::vector<Vec3> before = garment.position;
  EXPECT_GT(lay_leaves_over(garment, 0.003), 10);
  const pattern::PanelInfo &front = garment.panels.panels[0], &leaf = garment.panels.panels[1];
  for (int v = 0; v < leaf.first_vertex + leaf.n_vertices; ++v) {
    const auto i = static_cast<std::size_t>(garment.particle_of[v]);
    if (v < front.n_vertices) {
      EXPECT_EQ(garment.position[i], before[i]);
    } else if (before[i].z() < 0) {
      EXPECT_NEAR(garment.position[i].z(), 0.003, 1e-9);
    }
  }
}

TEST(TurnedLeaves, a_leaf_that_lies_on_the_front_is_left_as_it_is) {
  Garment garment = front_with_leaf(0.01);
  EXPECT_EQ(lay_leaves_over(garment, 0.003), 0);
}

namespace {

/// A shirt drafted for a figure, loose, on edges of 20 mm.
struct DraftedShirt {
  body::Body body;
  Garment garment;
};

/// A curve over a collar at this share of the way from its seam to its free edge, 5 cm.
pattern::Path across_collar(const pattern::Panel& collar, double share) {
  const auto edge = [&](const std::string& name) {
    for (const pattern::PanelEdge& e : collar.loops[0])
      if (e.name == name)
        return pattern::ArcLength(e.path);
    throw std::runtime_error("no edge " + name);
  };
  const pattern::ArcLength low = edge("low"), free = edge("free");
  std::vector<Vec2> points;
  for (int k = 0; k <= 8; ++k)
    points.push_back((1 - share) * low.at(low.length() * k / 8) +
                     share * free.at(free.length() * (1 - k / 8.0)));
  return pattern::curve_through(points);
}

/// What the pattern of a drafted shirt draws in its collar.
enum class CollarLines {
  NONE,
  ROLL,          ///< it is turned over a curve at 0.3 of the way to its free edge
  MARK_AND_ROLL, ///< the same, with a mark 6 mm beside it and a mesh of 10 mm there
};

DraftedShirt drafted_shirt(const std::string& figure, CollarLines lines) {
  const test::MadeFigure made = test::made_figure(figure);
  DraftedShirt out;
  out.body = body::measure_scan(made.mesh, "figure", "", {}, silent_reporter()).body;
  pattern::Pattern source =
      pattern::read_pattern_json(samples::pattern_document(samples::draft_shirt(
                                     samples::measures_from_body(made.truth, "figure"))),
                                 "shirt");
  const int collar = source.find_panel("collar");
  pattern::Panel& panel = source.panels[collar];
  if (lines == CollarLines::MARK_AND_ROLL)
    panel.lines.push_back({"stitching", "mark", across_collar(panel, 0.42)});
  if (lines != CollarLines::NONE)
    panel.lines.push_back(pattern::roll_line(source, collar, "roll", across_collar(panel, 0.3)));
  pattern::MeshLengths lengths = pattern::lengths_for_rolls(source, 0.02);
  if (lines == CollarLines::MARK_AND_ROLL)
    lengths.of_panel[collar] = 0.01;
  out.garment.panels = pattern::mesh_pattern(source, lengths, "shirt");
  pattern::place_panels(source, out.body, out.garment.panels);
  out.garment.materials[""] = material_preset("cotton-poplin");
  return out;
}

void expect_turned(const Garment& garment, const DrapeReport& report, int meshes = 2) {
  EXPECT_TRUE(report.converged) << stop_text(report);
  EXPECT_EQ(report.levels.meshes, meshes) << report.levels.why;
  const std::vector<RollLineState> states = roll_line_states(garment);
  ASSERT_EQ(states.size(), 1u);
  EXPECT_GT(states[0].turned_share, 0.9);
  EXPECT_LT(states[0].inwards_share, 0.05);
}

} // namespace

TEST(TurnedLeaves, a_collar_turns_over_a_line_in_it_on_the_coarse_mesh_already) {
  // That mesh had no edges along the line: the collar stood, and all was sewn on the given mesh.
  DraftedShirt shirt = drafted_shirt("f-165-plus", CollarLines::ROLL);
  const DrapeReport report =
      drape(shirt.garment, &shirt.body, preset_settings("draft"), silent_reporter());
  expect_turned(shirt.garment, report);
  // The fit called the neck 28 cm too wide: it went along the free edge of the leaf.
  bind_garment(shirt.garment, shirt.body);
  const collision::BodyCollider skin(shirt.body.skin);
  const FitReport fit = fit_garment(shirt.garment, shirt.body, skin, standard_fit_policy());
  for (const FitRow& row : fit.rows)
    EXPECT_NE(row.name, "neck_edge");
  const auto is_neck = [](const auto& left_out) { return left_out.first == "neck edge"; };
  const auto left_out = std::find_if(fit.left_out.begin(), fit.left_out.end(), is_neck);
  ASSERT_NE(left_out, fit.left_out.end());
  EXPECT_NE(left_out->second.find("turned over"), std::string::npos) << left_out->second;
}

TEST(TurnedLeaves, a_collar_that_stands_on_the_coarse_mesh_turns_on_the_given_one_alone) {
  // With a mark so near to the line, the mesh of 10 mm has edges along both, the coarse one has
  // not.
  DraftedShirt shirt = drafted_shirt("f-165-a", CollarLines::MARK_AND_ROLL);
  const DrapeReport report =
      drape(shirt.garment, &shirt.body, preset_settings("draft"), silent_reporter());
  expect_turned(shirt.garment, report, 1);
  EXPECT_NE(report.levels.why.find("roll line roll of panel collar turned over"), std::string::npos)
      << report.levels.why;
  ASSERT_FALSE(report.repairs.empty());
  EXPECT_NE(report.repairs[0].find("draped on the given mesh alone"), std::string::npos)
      << report.repairs[0];
}

TEST(TurnedLeaves, a_collar_turns_over_a_line_of_the_scene_by_way_of_the_coarse_mesh) {
  DraftedShirt shirt = drafted_shirt("f-165-a", CollarLines::NONE);
  SceneCrease crease;
  crease.run = {"collar", Vec2(0.06, 0.06), Vec2(0.94, 0.06)};
  crease.via = {Vec2(0.5, 0.62)};
  crease.angle_rad = -165 * M_PI / 180;
  crease.firmness = 30;
  crease.turns = true;
  shirt.garment.scene.creases = {crease};
  EXPECT_TRUE(mesh_along_folds(shirt.garment, &shirt.body, "", "scene.json").empty());
  const DrapeReport report =
      drape(shirt.garment, &shirt.body, preset_settings("draft"), silent_reporter());
  expect_turned(shirt.garment, report);
}

TEST(TurnedLeaves, a_collar_with_interfacing_rests_outside_of_the_shirt) {
  // Drafted for the body as measured, its stiff leaf came to rest beneath the fronts, with exit
  // status 0 (tests/cli/tools/drape.sh has that one).
  const test::MadeFigure made = test::made_figure("f-165-a");
  const body::Body body = body::measure_scan(made.mesh, "figure", "", {}, silent_reporter()).body;
  samples::Draft draft = samples::draft_shirt(samples::measures_from_body(made.truth, "figure"));
  for (samples::DraftPanel& panel : draft.panels)
    if (panel.name == "collar")
      panel.roll_edge = "low";
  const pattern::Pattern source =
      pattern::read_pattern_json(samples::pattern_document(draft), "shirt");
  Garment shirt;
  shirt.panels = pattern::mesh_pattern(source, 0.02, "shirt");
  shirt.panels.source = std::make_shared<pattern::Pattern>(source);
  pattern::place_panels(source, body, shirt.panels);
  const Material cotton = material_preset("cotton-poplin");
  shirt.materials[""] = cotton;
  shirt.materials["interfaced"] =
      layered(cotton, {{material_preset("fusible"), 1.0, false}, {cotton, 0.0, false}});
  for (pattern::PanelInfo& panel : shirt.panels.panels)
    if (panel.name == "collar" || panel.name == "stand")
      panel.material = "interfaced";
  const DrapeReport report = drape(shirt, &body, preset_settings("draft"), silent_reporter());
  EXPECT_TRUE(report.converged) << stop_text(report);
  EXPECT_EQ(report.levels.meshes, 2) << report.levels.why;
  EXPECT_EQ(report.quality["self_intersections"], 0);
  EXPECT_EQ(lay_leaves_over(shirt, 0), 0) << "nothing of it is beneath the fronts";
}

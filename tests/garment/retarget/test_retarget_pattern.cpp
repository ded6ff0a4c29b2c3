#include <support/sewn_tube.hpp>

#include <sloper/base/error.hpp>
#include <sloper/garment/retarget/retarget_pattern.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/mesh/mesh_pattern.hpp>
#include <sloper/pattern/read/read_pattern.hpp>

#include <gtest/gtest.h>

namespace sloper::garment {

TEST(retarget_pattern, outlines_and_seams_come_back_from_the_mesh) {
  const Garment g = sewn_tube(0.15, 0.4, 0.6);
  const pattern::Pattern p = pattern_of(g, g);
  ASSERT_EQ(p.seams.size(), 2u);
  for (const pattern::Seam& seam : p.seams) {
    ASSERT_EQ(seam.a.size(), 1u);
    EXPECT_NE(seam.a[0].panel, seam.b[0].panel);
    EXPECT_NEAR(pattern::side_length(p, seam.a), 0.4, 1e-9);
    EXPECT_NEAR(pattern::side_length(p, seam.b), 0.4, 1e-9);
  }
  std::vector<pattern::Path> loop;
  for (const pattern::PanelEdge& e : p.panels[0].loops[0])
    loop.push_back(e.path);
  EXPECT_NEAR(pattern::signed_area(loop), M_PI * 0.15 * 0.4, 1e-9);
  EXPECT_TRUE(p.findings.empty());
}

/// Two panels of 40 by 60 cm, meshed and not sewn; the back's side is sewn to the upper half of the
/// front's.
Garment drawn_panels() {
  const char* text =
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "apron", "panels": [
    {"name": "front", "label": "body", "place": {"part": "torso", "theta_deg": 20, "anchor": [20, 60], "height": 104}, "notches": [{"edge": "top", "at": 0.25}],
     "outline": [{"edge": "hem", "path": [["M", 0, 0], ["L", 40, 0]]}, {"edge": "side", "path": [["L", 40, 60]]}, {"edge": "top", "path": [["L", 30, 70],
     ["L", 0, 60]]}, {"edge": "other", "path": [["L", 0, 0]]}]},
    {"name": "back", "outline": [{"edge": "hem", "path": [["M", 0, 0], ["L", 40, 0]]}, {"edge": "side", "path": [["L", 40, 32]]}, {"edge": "top",
     "path": [["L", 0, 32]]}, {"edge": "other", "path": [["L", 0, 0]]}]}],
   "seams": [{"name": "half", "a": [{"panel": "front", "edge": "side", "from": 0.5, "to": 1}], "b": [{"panel": "back", "edge": "other", "from": 1, "to": 0}],
     "ease": "a little"}]})";
  Garment g;
  g.panels = pattern::mesh_pattern(pattern::read_pattern_json(io::Json::parse(text), "apron.json"),
                                   0.03, "apron.json");
  for (std::size_t v = 0; v < g.panels.pattern.size(); ++v) {
    g.particle_of.push_back(static_cast<int>(v));
    g.position.emplace_back(g.panels.pattern[v].x(), g.panels.pattern[v].y() + 0.5, 0.1);
  }
  return g;
}

TEST(retarget_pattern, edges_keep_their_names_and_panels_where_they_go) {
  const Garment before = drawn_panels();
  Garment after = before, twice = before;
  for (Vec2& p : after.panels.pattern)
    p.x() *= 1.1;
  for (Vec3& p : after.position)
    p.y() += 0.07;
  for (Vec2& p : twice.panels.pattern)
    p.x() *= 1.2;
  for (const pattern::Pattern& p :
       {pattern_of(after, before), pattern_of(twice, after)}) { // what was regraded before as well
    const pattern::Panel& front = p.panels[0];
    std::vector<std::string> names;
    for (const pattern::PanelEdge& e : front.loops[0])
      names.push_back(e.name);
    EXPECT_EQ(names, (std::vector<std::string>{"hem", "side_1", "side_2", "top", "other"}))
        << "a corner ends no edge";
    EXPECT_EQ(front.edge(p.seams[0].a[0].edge).name, "side_2");
    EXPECT_EQ(p.seams[0].ease, "a little");
    EXPECT_EQ(front.label, "body");
    EXPECT_EQ(front.hint.part, "torso");
    EXPECT_NEAR(front.hint.theta.value(), 20 * M_PI / 180, 1e-9);
    ASSERT_EQ(front.notches.size(), 1u);
    EXPECT_EQ(front.edge(front.notches[0].edge).name, "top");
  }
  const pattern::Panel front = pattern_of(after, before).panels[0];
  EXPECT_NEAR(front.hint.anchor->x(), 0.22, 0.003);
  EXPECT_NEAR(front.hint.height.value(), 0.6 + 0.07 + 0.5, 1e-6) << "where the cloth lies now";
  const pattern::ArcLength top(front.edge(front.notches[0].edge).path);
  const Vec2 notch = top.at(front.notches[0].at * top.length()),
             drawn = Vec2(0.4, 0.6) + 0.25 * (std::hypot(0.1, 0.1) + std::hypot(0.3, 0.1)) *
                                          Vec2(-1, 1).normalized();
  EXPECT_NEAR((notch - Vec2(1.1 * drawn.x(), drawn.y())).norm(), 0, 0.002);
}

TEST(retarget_pattern, a_garment_that_is_meshed_otherwise_than_its_pattern_has_edges_of_its_own) {
  Garment g = drawn_panels();
  g.panels.edge_length = 0.04;
  const pattern::Pattern p = pattern_of(g, g);
  EXPECT_EQ(p.panels[0].edge(0).name, "e0");
}

TEST(retarget_pattern, a_seam_inside_a_panel_is_told_and_left_out) {
  Garment g = sewn_tube(0.15, 0.4, 0.6);
  g.panels.seams[0].a = {30, 31, 32};
  g.panels.seams[0].b = {60, 61, 62};
  const pattern::Pattern p = pattern_of(g, g);
  EXPECT_EQ(p.seams.size(), 1u);
  EXPECT_EQ(p.findings.size(), 1u);
}

TEST(retarget_pattern, the_table_tells_what_grew) {
  const Garment g = sewn_tube(0.15, 0.4, 0.6);
  Garment wide = g;
  for (Vec2& p : wide.panels.pattern)
    p.x() *= 1.1;
  const std::string table = grade_table(pattern_of(g, g), pattern_of(wide, g));
  EXPECT_NE(table.find("width,front,,47.12,51.84,+4.71\r\n"), std::string::npos) << table;
  EXPECT_NE(table.find("height,front,,40.00,40.00,+0.00\r\n"), std::string::npos) << table;
}

} // namespace sloper::garment

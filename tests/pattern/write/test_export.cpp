#include <support/pattern_texts.hpp>

#include <gtest/gtest.h>
#include <sloper/pattern/write/export_pattern.hpp>

namespace sloper::pattern::test {
namespace {

TEST(Export, OwnJsonReadsBackTheSame) {
  const Pattern pattern = own(tube_text());
  Pattern back = read_pattern_json(pattern_json(pattern, "test"), "x");
  ASSERT_EQ(back.panels.size(), pattern.panels.size());
  ASSERT_EQ(back.seams.size(), pattern.seams.size());
  for (std::size_t p = 0; p < back.panels.size(); ++p)
    for (int e = 0; e < back.panels[p].n_edges(); ++e) {
      EXPECT_EQ(back.panels[p].edge(e).name, pattern.panels[p].edge(e).name);
      EXPECT_NEAR(length(back.panels[p].edge(e).path), length(pattern.panels[p].edge(e).path),
                  1e-12);
    }
  EXPECT_EQ(back.seams[1].b[0].from, 1);
}

TEST(Export, DxfReadsBackWithItsSeams) {
  const Pattern pattern = own(tube_text());
  std::vector<std::string> left_out;
  Pattern back = read_dxf(pattern_dxf(pattern, left_out), "x.dxf");
  EXPECT_TRUE(left_out.empty());
  finish_pattern(back, "x.dxf");
  ASSERT_EQ(back.panels.size(), 2u);
  ASSERT_EQ(back.seams.size(), 2u);
  EXPECT_NEAR(outline_area(back.panels[0]), outline_area(pattern.panels[0]), 1e-6);
  EXPECT_EQ(back.panels[0].edge(1).name, "side_l");
  const Sewn sewn = sew(mesh_pattern(back, 0.02, "x"));
  EXPECT_EQ(sewn.boundary_loops, 2);
  EXPECT_EQ(sewn.wrong_direction, 0);
}

TEST(Export, DxfKeepsWhatASeamIsAndWhetherItIsOpen) {
  Pattern pattern = own(tube_text(
      R"(, {"name": "placket", "kind": "closure", "open": true, "ease": "room for the button stand", "a": [{"panel": "front", "edge": "top"}], "b": [{"panel": "back", "edge": "top"}]})"));
  pattern.seams[0].open = true;
  pattern.seams[1].kind = "gather";
  pattern.panels[0].notches = {{1, 0.25, "layer 81"}, {1, 0.75, "slit"}};
  std::vector<std::string> left_out;
  Pattern back = read_dxf(pattern_dxf(pattern, left_out), "x.dxf");
  EXPECT_TRUE(left_out.empty()) << left_out[0];
  ASSERT_EQ(back.seams.size(), 3u);
  const auto named = [&](const std::string& name) {
    return *std::find_if(back.seams.begin(), back.seams.end(),
                         [&](const Seam& s) { return s.name == name; });
  };
  for (const Seam& s : pattern.seams) {
    EXPECT_EQ(named(s.name).open, s.open) << s.name;
    EXPECT_EQ(named(s.name).kind, s.kind) << s.name;
    EXPECT_EQ(named(s.name).ease, s.ease) << s.name;
  }
  const Panel& front = back.panels[back.find_panel("front")];
  ASSERT_EQ(front.notches.size(), 2u);
  EXPECT_EQ(std::count_if(front.notches.begin(), front.notches.end(),
                          [](const Notch& n) { return n.kind == "layer 81"; }),
            1);
}

TEST(Export, DxfTellsLayersFoldsAndPlaces) {
  Pattern pattern = own(tube_text());
  pattern.panels[0].layer = 1;
  pattern.panels[0].lines = {{"crease", "fold", {Segment::straight({-0.1, 0.1}, {-0.1, 0.5})}}};
  pattern.panels[1].hint.part = "torso";
  std::vector<std::string> left_out;
  pattern_dxf(pattern, left_out);
  ASSERT_EQ(left_out.size(), 3u);
  EXPECT_NE(left_out[0].find("layer 1"), std::string::npos) << left_out[0];
  EXPECT_NE(left_out[1].find("fold"), std::string::npos) << left_out[1];
  EXPECT_NE(left_out[2].find("back"), std::string::npos) << left_out[2];
}

TEST(Export, DxfTellsWhatItCannotSay) {
  const Pattern pattern = own(tube_text(
      R"(, {"name": "half", "a": [{"panel": "front", "edge": "top", "from": 0, "to": 0.5}], "b": [{"panel": "back", "edge": "top", "from": 1, "to": 0.5}]})"));
  std::vector<std::string> left_out;
  pattern_dxf(pattern, left_out);
  EXPECT_EQ(left_out.size(), 2u);
}

TEST(Export, SvgNamesEveryEdge) {
  const std::string svg = pattern_svg(own(tube_text()));
  EXPECT_EQ(svg.rfind("<svg", 0), 0u);
  for (const char* name : {"front", "back", "hem", "side_l", "top", "side_r"})
    EXPECT_NE(svg.find(name), std::string::npos) << name;
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

} // namespace
} // namespace sloper::pattern::test

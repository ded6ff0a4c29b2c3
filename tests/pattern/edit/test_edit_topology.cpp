#include <support/pattern_texts.hpp>

#include <gtest/gtest.h>
#include <random>
#include <sloper/base/error.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/edit/edits.hpp>
#include <sloper/pattern/write/export_pattern.hpp>

namespace sloper::pattern::test {
namespace {

io::Json log_of(const std::string& edits) {
  return io::parse_json(R"({"format": "edits", "version": 1, "length_unit": "cm", "edits": [)" +
                            edits + "]}",
                        "edits.json");
}
Pattern edited(Pattern pattern, const std::string& edits) {
  apply_edits(pattern, log_of(edits), "edits.json");
  return pattern;
}
std::string message(const Pattern& pattern, const std::string& edits) {
  try {
    edited(pattern, edits);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}
std::string bytes(const Pattern& pattern) {
  return io::to_text(pattern_json(pattern, "test"));
}

/// A tube with curved sides, a hole in the front, notches, and seams along parts of edges.
Pattern curvy() {
  return own(
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "curvy", "panels": [
    {"name": "front", "outline": [{"edge": "hem", "path": [["M", -20, 0], ["L", 20, 0]]}, {"edge": "side_l", "path": [["C", 26, 20, 14, 40, 20, 60]]},
      {"edge": "top", "path": [["Q", 0, 52, -20, 60]]}, {"edge": "side_r", "path": [["C", -14, 40, -26, 20, -20, 0]]}],
      "holes": [[{"edge": "h1", "path": [["M", 8, 44], ["L", 8, 48]]}, {"edge": "h2", "path": [["L", 12, 46]]}, {"edge": "h3", "path": [["L", 8, 44]]}]],
      "notches": [{"edge": "side_l", "at": 0.25}, {"edge": "side_r", "at": 0.75}]},
    {"name": "back", "mirror_of": "front"}], "seams": [
    {"name": "left", "a": [{"panel": "front", "edge": "side_l"}], "b": [{"panel": "back", "edge": "side_l", "from": 1, "to": 0}]},
    {"name": "right", "a": [{"panel": "back", "edge": "side_r", "from": 0, "to": 0.8}], "b": [{"panel": "front", "edge": "side_r", "from": 1, "to": 0.2}]}]})");
}

double total_area(const Pattern& p) {
  double sum = 0;
  for (const Panel& panel : p.panels)
    sum += outline_area(panel);
  return sum;
}

void expect_sound(Pattern pattern) {
  for (const Seam& s : pattern.seams)
    for (const auto* side : {&s.a, &s.b})
      for (const Run& r : *side)
        ASSERT_LT(r.edge, pattern.panels[r.panel].n_edges());
  finish_pattern(pattern, "t");
  const Sewn sewn = sew(mesh_pattern(pattern, 0.02, "t"));
  EXPECT_EQ(sewn.wrong_direction + sewn.non_manifold, 0);
}

TEST(EditTopology, ASplitPanelSewnTogetherIsTheSameCloth) {
  const Pattern before = edited(curvy(), "");
  const Pattern after = edited(
      before,
      R"({"edit": "split", "panel": "front", "from": [-30, 25], "to": [30, 28], "names": ["upper", "lower"]})");
  ASSERT_EQ(after.panels.size(), 3u);
  EXPECT_EQ(after.panels[0].name, "upper");
  EXPECT_EQ(after.panels[2].name, "lower");
  EXPECT_NEAR(total_area(after), total_area(before), 1e-9);
  EXPECT_EQ(after.panels[0].loops.size(), 2u) << "the hole is in the upper half";
  EXPECT_EQ(after.panels[0].notches.size() + after.panels[2].notches.size(), 2u);
  for (const char* name : {"left", "right"}) {
    const auto find = [&](const Pattern& p) {
      return *std::find_if(p.seams.begin(), p.seams.end(),
                           [&](const Seam& s) { return s.name == name; });
    };
    EXPECT_NEAR(side_length(after, find(after).a), side_length(before, find(before).a), 1e-8);
    EXPECT_NEAR(side_length(after, find(after).b), side_length(before, find(before).b), 1e-8);
    EXPECT_EQ(find(after).a.size() + find(after).b.size(), 3u);
  }
  expect_sound(after);
  const Pattern again =
      edited(after, R"({"edit": "join", "seam": "upper-lower", "name": "front"})");
  EXPECT_EQ(again.panels.size(), 2u);
  EXPECT_NEAR(total_area(again), total_area(before), 1e-9);
  expect_sound(again);
  EXPECT_EQ(
      edited(before, R"({"edit": "cut", "panel": "front", "from": [-30, 25], "to": [30, 28]})")
          .seams.size(),
      2u)
      << "a cut stays open";
}

TEST(EditTopology, SplitsThroughCornersAndAlongOneEdge) {
  const Pattern tube = own(tube_text());
  expect_sound(
      edited(tube, R"({"edit": "split", "panel": "front", "from": [-20, 0], "to": [20, 60]})"));
  expect_sound(
      edited(tube, R"({"edit": "split", "panel": "front", "from": [-20, 60], "to": [3, 0]})"));
  // Both ends on one edge: a corner piece of the curved top.
  const Pattern arc =
      edited(curvy(), R"({"edit": "split", "panel": "back", "from": [-20, 59.9], "to": [-8, 10]})");
  EXPECT_EQ(arc.panels.size(), 3u);
  expect_sound(arc);
}

TEST(EditTopology, WhatCannotBeSplitIsSaid) {
  const Pattern p = curvy();
  EXPECT_NE(message(p, R"({"edit": "split", "panel": "front", "from": [-30, 57], "to": [30, 57]})")
                .find("in 4 places"),
            std::string::npos);
  EXPECT_NE(message(p, R"({"edit": "split", "panel": "front", "from": [-30, 90], "to": [30, 90]})")
                .find("in 0 places"),
            std::string::npos);
  EXPECT_NE(message(p, R"({"edit": "split", "panel": "front", "from": [-30, 46], "to": [30, 46]})")
                .find("crosses a hole"),
            std::string::npos);
  EXPECT_NE(message(p, R"({"edit": "join", "seam": "right"})").find("does not join one whole edge"),
            std::string::npos);
  EXPECT_NE(message(p, R"({"edit": "join", "seam": "rihgt"})").find("there is no seam"),
            std::string::npos);
}

TEST(EditTopology, JoinLaysCongruentEdgesOnEachOther) {
  const Pattern before = own(tube_text());
  const Pattern after = edited(before, R"({"edit": "join", "seam": "left", "name": "tube"})");
  ASSERT_EQ(after.panels.size(), 1u);
  EXPECT_NEAR(outline_area(after.panels[0]), 0.8 * 0.6, 1e-8);
  ASSERT_EQ(after.seams.size(), 1u);
  const Sewn sewn = sew(mesh_pattern(after, 0.02, "t"));
  EXPECT_EQ(sewn.wrong_direction + sewn.non_manifold, 0);
  EXPECT_EQ(sewn.boundary_loops, 2);
}

TEST(EditTopology, ADartTakesItsWidthFromTheEdgeAndIsSewn) {
  const Pattern before = edited(own(tube_text()), "");
  const Pattern after = edited(
      before,
      R"({"edit": "add-dart", "panel": "front", "edge": "side_l", "at": 0.7, "width": 4, "tip": [8, 42], "name": "bust"})");
  EXPECT_NEAR(side_length(after, after.seams[0].a), 0.56, 1e-8)
      << "the side seam is shorter by the dart";
  EXPECT_NEAR(outline_area(after.panels[0]), 0.24 - 0.5 * 0.04 * 0.12, 1e-8);
  const Seam& dart = after.seams.back();
  EXPECT_EQ(dart.kind, "dart");
  EXPECT_NEAR(side_length(after, dart.a), side_length(after, dart.b), 1e-8);
  expect_sound(after);
  EXPECT_NE(
      message(
          before,
          R"({"edit": "add-dart", "panel": "front", "edge": "side_l", "at": 0.99, "width": 4, "tip": [8, 42]})")
          .find("extends past the end of the edge"),
      std::string::npos);
  EXPECT_NE(
      message(
          before,
          R"({"edit": "add-dart", "panel": "front", "edge": "side_l", "at": 0.7, "width": 4, "tip": [28, 42]})")
          .find("tip lies outside"),
      std::string::npos);
}

TEST(EditTopology, ARotatedDartKeepsTheClothAndMovesTheOpening) {
  const Pattern before = edited(
      own(tube_text()),
      R"({"edit": "add-dart", "panel": "front", "edge": "side_l", "at": 0.7, "width": 4, "tip": [8, 42], "name": "bust"})");
  const Pattern after =
      edited(before, R"({"edit": "rotate-dart", "dart": "bust", "edge": "top", "at": 0.4})");
  EXPECT_NEAR(outline_area(after.panels[0]), outline_area(before.panels[0]), 1e-8)
      << "turning a piece of cloth changes no area";
  EXPECT_NEAR(side_length(after, after.seams[0].a), 0.56, 1e-7);
  const Seam& dart = after.seams.back();
  EXPECT_NEAR(side_length(after, dart.a), side_length(after, dart.b), 1e-7);
  EXPECT_GT(side_length(after, dart.a), 0.17) << "from the tip to the top edge";
  expect_sound(after);
  // The old legs have met: the side is one line again, of two edges.
  const Panel& p = after.panels[0];
  EXPECT_LT((p.edge(p.find_edge("side_l_1")).path.back().p[3] -
             p.edge(p.find_edge("side_l_2")).path.front().p[0])
                .norm(),
            1e-12);
  const Pattern back =
      edited(after, R"({"edit": "rotate-dart", "dart": "bust", "edge": "side_l_1", "at": 1})");
  EXPECT_NEAR(outline_area(back.panels[0]), outline_area(before.panels[0]), 1e-8);
  expect_sound(back);
}

TEST(EditTopology, AFisheyeDartIsAHoleSewnShut) {
  const Pattern after = edited(
      own(tube_text()),
      R"({"edit": "add-dart", "panel": "back", "center": [5, 30], "length": 20, "width": 3})");
  EXPECT_EQ(after.panels[1].loops.size(), 2u);
  const Sewn sewn = sew(mesh_pattern(after, 0.01, "t"));
  EXPECT_EQ(sewn.wrong_direction + sewn.non_manifold, 0);
  EXPECT_EQ(sewn.boundary_loops, 2) << "hem and top only";
  EXPECT_NE(
      message(
          own(tube_text()),
          R"({"edit": "add-dart", "panel": "back", "center": [19.5, 30], "length": 20, "width": 3})")
          .find("extends beyond panel back"),
      std::string::npos);
}

TEST(Edits, AClosureLeftOpenIsPlacedAndNotSewn) {
  Pattern tube = own(tube_text());
  const PanelMesh closed = mesh_pattern(tube, 0.02, "t");
  const auto edit = [&](const std::string& text) {
    apply_edits(
        tube,
        io::parse_json(R"({"format": "edits", "version": 1, "length_unit": "cm", "edits": [)" +
                           text + "]}",
                       "e"),
        "e");
  };
  edit(R"({"edit": "open", "seam": "left"})");
  const PanelMesh open = mesh_pattern(tube, 0.02, "t");
  ASSERT_EQ(open.pattern.size(), closed.pattern.size())
      << "its sides have vertices alike, so that it can be closed again";
  for (std::size_t v = 0; v < open.pattern.size(); ++v)
    EXPECT_LT((open.pattern[v] - closed.pattern[v]).norm(), 1e-8);
  ASSERT_EQ(open.seams.size(), 2u);
  EXPECT_TRUE(open.seams[0].open);
  EXPECT_FALSE(open.seams[1].open);
  const Pattern again = own(io::to_text(pattern_json(tube, "test")));
  EXPECT_TRUE(again.seams[0].open) << "the own format says so";
  EXPECT_THROW(edit(R"({"edit": "open", "seam": "left"})"), Error);
  edit(R"({"edit": "close", "seam": "left"})");
  EXPECT_FALSE(tube.seams[0].open);
  EXPECT_THROW(edit(R"({"edit": "close", "seam": "nowhere"})"), Error);
}

TEST(Edits, ShrinkAlongAnEdgeAndAcrossAStrip) {
  const Pattern tube = own(tube_text());
  EXPECT_NEAR(
      length(edited(tube, R"({"edit": "shrink", "panel": "front", "edge": "hem", "factor": 0.75})")
                 .panels[0]
                 .edge(0)
                 .path),
      0.3, 1e-8);
  const Pattern strip = edited(
      tube,
      R"({"edit": "shrink", "panel": "front", "strip": {"from": [0, 20], "to": [0, 30]}, "factor": 0.5})");
  EXPECT_NEAR(outline_area(strip.panels[0]), 0.4 * 0.55, 1e-8);
}

TEST(Edits, GradeAddsLengths) {
  const Pattern p = edited(own(tube_text()), R"({"edit": "grade", "width": 2, "height": -1.5})");
  for (const Panel& panel : p.panels)
    EXPECT_NEAR(outline_area(panel), 0.42 * 0.585, 1e-8);
}

/// One random edit that suits the pattern; some fail (a cut through a hole) and are left out.
std::string random_edit(const Pattern& pattern, std::mt19937& random) {
  const auto number = [&](double low, double high) {
    return std::to_string(low + (high - low) * (random() % 10000) / 10000.0);
  };
  const Panel& panel = pattern.panels[random() % pattern.panels.size()];
  const std::string place = R"(, "panel": ")" + panel.name + R"(")",
                    edge = R"(, "edge": ")" +
                           panel.loops[0][random() % panel.loops[0].size()].name + R"(")";
  const std::string by = R"(, "by": [)" + number(-1, 1) + ", " + number(-1, 1) + "]";
  switch (random() % 14) {
  case 0: return R"({"edit": "move-point")" + place + edge + R"(, "end": "end")" + by + "}";
  case 1: return R"({"edit": "move-edge")" + place + edge + by + "}";
  case 2:
    return R"({"edit": "set-length")" + place + edge + R"(, "length": )" + number(8, 40) + "}";
  case 3: return R"({"edit": "take-in")" + place + edge + R"(, "by": )" + number(-1, 1) + "}";
  case 4:
    return R"({"edit": "lengthen")" + place + R"(, "at": [0, 20], "along": [0.1, 1], "by": )" +
           number(0, 3) + "}";
  case 5:
    return R"({"edit": "scale", "x": )" + number(0.9, 1.1) + R"(, "y": )" + number(0.9, 1.1) + "}";
  case 6:
    return R"({"edit": "shrink")" + place + R"(, "warp": )" + number(0.8, 1) + R"(, "weft": 1})";
  case 7: return R"({"edit": "grade", "width": )" + number(-1, 2) + R"(, "height": 1})";
  case 8:
    return R"({"edit": "split")" + place + R"(, "from": [-50, )" + number(0, 60) +
           R"(], "to": [50, )" + number(0, 60) + "]}";
  case 9:
    return R"({"edit": "add-dart")" + place + edge + R"(, "at": 0.5, "width": 1, "tip": [)" +
           number(-15, 15) + ", " + number(5, 50) + "]}";
  case 10:
    return R"({"edit": "rotate-dart", "dart": ")" + panel.name + R"(-dart")" + edge +
           R"(, "at": 0.3})";
  case 11: return R"({"edit": "take-in", "seam": "left", "by": )" + number(0, 1) + "}";
  case 12: return R"({"edit": "shrink")" + place + edge + R"(, "factor": )" + number(0.7, 1) + "}";
  default:
    return R"({"edit": "join", "seam": ")" + pattern.seams[random() % pattern.seams.size()].name +
           R"("})";
  }
}

TEST(Edits, AnyLogIsTakenBackToTheLastByteAndReplaysTheSame) {
  int n_edits = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    std::mt19937 random(seed);
    const Pattern start = curvy();
    Pattern now = start;
    std::string log;
    for (int k = 0; k < 6; ++k) {
      const std::string edit = random_edit(now, random);
      try {
        now = edited(now, edit);
      } catch (const Error&) {
        continue;
      }
      log += (log.empty() ? "" : ",") + edit;
      ++n_edits;
    }
    SCOPED_TRACE(log);
    const Pattern replayed = edited(start, log);
    EXPECT_TRUE(bytes(replayed) == bytes(now));
    Pattern back = now;
    apply_edits(back, inverse_edits(start, log_of(log), "edits.json", "test"), "undo.json");
    ASSERT_TRUE(bytes(back) == bytes(start));
  }
  EXPECT_GT(n_edits, 180);
}

TEST(Edits, EveryKindIsTakenBackToTheLastByte) {
  const Pattern start = edited(
      curvy(),
      R"({"edit": "split", "panel": "back", "from": [-30, 30], "to": [30, 30], "names": ["top", "skirt"]},
      {"edit": "add-dart", "panel": "front", "edge": "hem", "at": 0.5, "width": 2, "tip": [0, 12], "name": "dart"},
      {"edit": "shrink", "panel": "front", "curve": [["M", -10, 30], ["Q", 0, 34, 4, 30]], "factor": 0.9, "name": "old"})");
  const char* kinds[] = {
      R"({"edit": "move-point", "panel": "front", "edge": "top", "end": "start", "by": [0.123, 1]})",
      R"({"edit": "move-edge", "panel": "front", "edge": "side_l", "by": [0.7, -0.3]})",
      R"({"edit": "bend", "panel": "front", "edge": "side_r", "by": [-0.9, 0.1]})",
      R"({"edit": "add-point", "panel": "front", "edge": "top", "at": 0.3, "names": ["one", "two"]})",
      R"({"edit": "set-length", "panel": "front", "edge": "side_l", "length": 61.7, "fixed": "middle"})",
      R"({"edit": "set-length", "seam": "left", "length": 59})",
      R"({"edit": "take-in", "panel": "front", "edge": "side_l", "by": 0.77})",
      R"({"edit": "take-in", "seam": "left", "by": 0.3})",
      R"({"edit": "let-out", "panel": "top", "edge": "side_r_2", "by": 0.77})",
      R"({"edit": "let-out", "seam": "right", "by": 0.31})",
      R"({"edit": "lengthen", "panel": "front", "at": [0, 20], "along": [0.2, 1], "by": 3})",
      R"({"edit": "shorten", "panel": "front", "at": [0, 20], "along": [0, 1], "by": 3})",
      R"({"edit": "scale", "x": 1.07, "y": 0.93})",
      R"({"edit": "grade", "panel": "front", "width": 1.3, "height": -0.7})",
      R"({"edit": "shrink", "panel": "front", "warp": 0.9, "weft": 1.01})",
      R"({"edit": "shrink", "panel": "front", "edge": "top", "factor": 0.8})",
      R"({"edit": "shrink", "panel": "front", "strip": {"from": [0, 20], "to": [0, 28]}, "factor": 0.8})",
      R"({"edit": "shrink", "panel": "front", "curve": [["M", -12, 20], ["L", 12, 26]], "factor": 0.7, "width": 2})",
      R"({"edit": "split", "panel": "front", "from": [-30, 25], "to": [30, 28]})",
      R"({"edit": "cut", "panel": "front", "from": [-30, 25], "to": [30, 28]})",
      R"({"edit": "join", "seam": "top-skirt", "name": "back"})",
      R"({"edit": "open", "seam": "left"})",
      R"({"edit": "add-dart", "panel": "front", "edge": "side_l", "at": 0.4, "width": 2, "tip": [8, 27]})",
      R"({"edit": "add-dart", "panel": "front", "center": [-8, 30], "length": 12, "width": 2})",
      R"({"edit": "rotate-dart", "dart": "dart", "edge": "side_r", "at": 0.8})",
  };
  for (const char* kind : kinds) {
    SCOPED_TRACE(kind);
    const Pattern after = edited(start, kind);
    EXPECT_FALSE(bytes(after) == bytes(start));
    EXPECT_TRUE(bytes(edited(start, kind)) == bytes(after)) << "replayed";
    Pattern back = after;
    const io::Json undo = inverse_edits(start, log_of(kind), "edits.json", "test");
    apply_edits(back, undo, "undo.json");
    EXPECT_TRUE(bytes(back) == bytes(start));
    // The log that takes it back is itself taken back.
    apply_edits(back, inverse_edits(after, undo, "undo.json", "test"), "redo.json");
    EXPECT_TRUE(bytes(back) == bytes(after));
  }
}

TEST(Edits, SetLengthIsExactToATenthOfAMillimetreOnAnyEdge) {
  const Pattern start = curvy();
  std::mt19937 random(7);
  for (int k = 0; k < 40; ++k) {
    const std::size_t p = random() % 2;
    const std::string edge = start.panels[p].loops[0][random() % 4].name;
    const double wanted = 0.05 + 0.01 * (random() % 60);
    const Pattern after =
        edited(start, R"({"edit": "set-length", "panel": ")" + start.panels[p].name +
                          R"(", "edge": ")" + edge + R"(", "length": )" +
                          std::to_string(wanted * 100) + R"(, "fixed": "middle"})");
    EXPECT_NEAR(length(after.panels[p].edge(after.panels[p].find_edge(edge)).path), wanted, 1e-4);
  }
}

} // namespace
} // namespace sloper::pattern::test

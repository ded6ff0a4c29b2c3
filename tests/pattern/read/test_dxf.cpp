#include <support/pattern_texts.hpp>

#include <gtest/gtest.h>
#include <sloper/base/error.hpp>

namespace sloper::pattern::test {
namespace {

std::string text_entity(const std::string& layer, double x, double y, const std::string& text) {
  return "0\nTEXT\n8\n" + layer + "\n10\n" + std::to_string(x) + "\n20\n" + std::to_string(y) +
         "\n1\n" + text + "\n";
}

std::string polyline(const std::string& layer, const std::vector<Vec2>& points) {
  std::string t = "0\nPOLYLINE\n8\n" + layer + "\n66\n1\n70\n1\n";
  for (const Vec2& p : points)
    t += "0\nVERTEX\n8\n" + layer + "\n10\n" + std::to_string(p.x()) + "\n20\n" +
         std::to_string(p.y()) + "\n";
  return t + "0\nSEQEND\n8\n" + layer + "\n";
}

std::vector<Vec2> box(double w, double h, double x = 0) {
  return {{x, 0}, {x + w, 0}, {x + w, h}, {x, h}};
}

std::string block(const std::string& name, const std::string& content) {
  return "0\nBLOCK\n8\n1\n2\n" + name + "\n" + text_entity("1", 0, 0, "Piece Name:" + name) +
         content + "0\nENDBLK\n";
}

std::string file(const std::string& blocks, const std::string& texts = "") {
  return "0\nSECTION\n2\nBLOCKS\n" + blocks + "0\nENDSEC\n0\nSECTION\n2\nENTITIES\n" +
         text_entity("1", 0, 0, "Units: METRIC") + texts + "0\nENDSEC\n0\nEOF\n";
}

const char* RUL =
    "ASTM/D13Proposal 1 Version: D 6673-04\nUNITS: METRIC\nGRADE RULE TABLE: T\nNUMBER OF SIZES: "
    "3\nSIZE LIST: 36 38 40\nSAMPLE SIZE: 38\n"
    "RULE: DELTA 1\n 0.0,0.0 0.0,0.0 0.0,0.0\nRULE: DELTA 2\n -10.0, -5.0\n 0,0\n 20.0,5.0\nEND\n";

std::string graded_block() { // fixed at the left, rule 2 at the right
  std::string t = polyline("14", {{0, 0}, {200, 0}, {400, 0}, {400, 300}, {0, 300}});
  t += text_entity("2", 0, 0, "# 1") + text_entity("2", 0, 300, "# 1") +
       text_entity("2", 400, 0, "# 2") + text_entity("2", 400, 300, "# 2");
  return file(block("bib", t));
}

TEST(GradeRules, MoveGradedPointsAndWhatLiesBetween) {
  const GradeRules rules = parse_grade_rules(RUL, "t.rul");
  EXPECT_EQ(rules.sample, 1);
  const Pattern p = read_dxf(graded_block(), "p.dxf", {"40", &rules});
  EXPECT_NEAR(outline_area(p.panels[0]), 0.42 * 0.30, 1e-9)
      << "the right side moved out by 2 cm and up by 0.5";
  bool middle = false;
  for (const PanelEdge& e : p.panels[0].loops[0])
    for (const Segment& s : e.path)
      middle = middle || (s.p[0] - Vec2(0.21, 0.0025)).norm() < 1e-9;
  EXPECT_TRUE(middle) << "half way, half the move";
  EXPECT_NEAR(outline_area(read_dxf(graded_block(), "p.dxf", {"", &rules}).panels[0]), 0.12, 1e-12)
      << "the sample size stays";
}

TEST(GradeRules, WhatIsWrongIsNamed) {
  const GradeRules rules = parse_grade_rules(RUL, "t.rul");
  const auto message = [](const auto& call) -> std::string {
    try {
      call();
    } catch (const Error& e) {
      return std::string(e.what()) + e.fact();
    }
    return "";
  };
  EXPECT_NE(message([&] {
              read_dxf(graded_block(), "p.dxf", {"44", &rules});
            }).find("no size '44'"),
            std::string::npos);
  EXPECT_NE(message([&] {
              read_dxf(graded_block(), "p.dxf", {"40", nullptr});
            }).find("has only one size"),
            std::string::npos);
  std::string text = RUL;
  text.replace(text.find("20.0,5.0"), 8, "20.0");
  EXPECT_NE(
      message([&] { parse_grade_rules(text, "t.rul"); }).find("rule 2 has 5 numbers for 3 sizes"),
      std::string::npos);
  text = RUL;
  text.replace(text.find(" 0,0\n"), 5, " 1,0\n");
  EXPECT_NE(message([&] { parse_grade_rules(text, "t.rul"); }).find("moves the sample size by 0.1"),
            std::string::npos);
  text = RUL;
  text.replace(text.find("SAMPLE SIZE: 38"), 15, "SAMPLE SIZE: 37");
  EXPECT_NE(message([&] { parse_grade_rules(text, "t.rul"); }).find("'37' is not in the size list"),
            std::string::npos);
  std::string other = graded_block();
  other.replace(other.find("# 2"), 3, "# 7");
  EXPECT_NE(message([&] {
              read_dxf(other, "p.dxf", {"40", &rules});
            }).find("grade rule 7"),
            std::string::npos);
}

TEST(Dxf, OfANestTheSizeAskedForIsTaken) {
  std::string blocks;
  for (const auto& [size, w] : {std::pair<std::string, double>{"S", 380}, {"M", 400}, {"L", 420}})
    blocks += block("bib", text_entity("1", 0, 0, "Size: " + size) + polyline("14", box(w, 300)));
  const std::string nest = file(blocks, text_entity("1", 0, 0, "Sample Size: S"));
  EXPECT_NEAR(outline_area(read_dxf(nest, "p.dxf").panels[0]), 0.38 * 0.3, 1e-9)
      << "the sample size";
  EXPECT_NEAR(outline_area(read_dxf(nest, "p.dxf", {"L", nullptr}).panels[0]), 0.42 * 0.3, 1e-9);
  EXPECT_EQ(read_dxf(nest, "p.dxf", {"L", nullptr}).panels.size(), 1u);
  try {
    read_dxf(nest, "p.dxf", {"XL", nullptr});
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("its sizes are L, M, S"), std::string::npos) << e.what();
  }
}

TEST(Dxf, TheOrderOfPiecesDoesNotMatter) {
  std::vector<std::string> blocks = {block("front", polyline("14", box(400, 300))),
                                     block("flap", polyline("14", box(100, 50))),
                                     block("flap", polyline("14", box(120, 50, 500))),
                                     block("back", polyline("14", box(410, 300)))};
  std::vector<std::size_t> order = {0, 1, 2, 3};
  std::vector<std::string> names;
  std::vector<double> areas;
  do {
    std::string all;
    for (std::size_t k : order)
      all += blocks[k];
    const Pattern p = read_dxf(file(all), "p.dxf");
    std::vector<std::string> got;
    std::vector<double> area;
    for (const Panel& panel : p.panels) {
      got.push_back(panel.name);
      area.push_back(outline_area(panel));
    }
    if (names.empty()) {
      names = got;
      areas = area;
    }
    EXPECT_EQ(got, names);
    EXPECT_EQ(area, areas);
  } while (std::next_permutation(order.begin(), order.end()));
  EXPECT_EQ(names, (std::vector<std::string>{"back", "flap", "flap#2", "front"}));
}

TEST(Dxf, NotchesDrawnAsLinesAreThoseDrawnAsPoints) {
  const auto line = [](const char* x) {
    return std::string("0\nLINE\n8\n4\n10\n") + x + "\n20\n0\n11\n" + x + "\n21\n5\n";
  };
  const Pattern lines = read_dxf(file(block("a", polyline("14", box(400, 300)) + line("98.5") +
                                                     line("100") + line("101.5") + line("300"))),
                                 "p.dxf");
  const Pattern points = read_dxf(
      file(block("a", polyline("14", box(400, 300)) +
                          "0\nPOINT\n8\n4\n10\n100\n20\n0\n0\nPOINT\n8\n4\n10\n300\n20\n0\n")),
      "p.dxf");
  ASSERT_EQ(lines.panels[0].notches.size(), 2u) << "three slits side by side are one notch";
  ASSERT_EQ(points.panels[0].notches.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(lines.panels[0].notches[k].edge, points.panels[0].notches[k].edge);
    EXPECT_EQ(lines.panels[0].notches[k].at, points.panels[0].notches[k].at);
  }
}

TEST(Dxf, AHalfPieceIsUnfoldedWithItsNotchesAndSeams) {
  std::string half =
      polyline("14", box(200, 300)) + "0\nLINE\n8\n6\n10\n0\n20\n10\n11\n0\n21\n290\n";
  half += "0\nPOINT\n8\n4\n10\n200\n20\n100\n" +
          text_entity("15", 200, 150, "SEW side a 0 + side") +
          text_entity("15", 100, 300, "SEW side b 0 - top");
  const Pattern p = read_dxf(file(block("front", half)), "p.dxf");
  EXPECT_NEAR(outline_area(p.panels[0]), 0.12, 1e-9);
  ASSERT_EQ(p.panels[0].notches.size(), 2u);
  for (const Notch& n : p.panels[0].notches) {
    const ArcLength arc(p.panels[0].edge(n.edge).path);
    const Vec2 at = arc.at(n.at * arc.length());
    EXPECT_NEAR(std::abs(at.x()), 0.2, 1e-9);
    EXPECT_NEAR(at.y(), 0.1, 1e-3);
  }
  EXPECT_EQ(p.panels[0].edge(p.seams[0].a[0].edge).name, "side");
  EXPECT_NEAR(run_length(p, p.seams[0].a[0]), 0.3, 1e-12);
}

TEST(Dxf, PiecesToBeCutTwiceAreSaid) {
  for (const char* words : {"Quantity: 2", "Fabric, Cut 2"}) {
    const Pattern p = read_dxf(
        file(block("a", polyline("14", box(400, 300)) + text_entity("1", 0, 0, words))), "p.dxf");
    EXPECT_TRUE(std::any_of(p.findings.begin(), p.findings.end(), [](const Message& f) {
      return f.text == "a: to be cut 2 times; one copy is used";
    })) << words;
  }
  EXPECT_EQ(read_dxf(file(block("a", polyline("14", box(400, 300)) +
                                         text_entity("1", 0, 0, "Quantity: 1"))),
                     "p.dxf")
                .findings.size(),
            0u);
}

TEST(Dxf, CoordinatesBeyondAllBoundsAreRefused) { // found by fuzzing: no edge was near the text
  const std::string text = file(block("a", polyline("14", box(400, 300)) +
                                               "0\nTEXT\n8\n15\n10\n0.0\n20\n1e300\n1\nRUN hem\n"));
  EXPECT_THROW(read_dxf(text, "p.dxf"), Error);
}

TEST(Dxf, ASewLineOnLayerEightIsToldFromAnInternalLine) {
  const std::string cut = polyline("1", {{-10, -10}, {410, -10}, {410, 310}, {-10, 310}});
  EXPECT_NEAR(
      outline_area(
          read_dxf(file(block("a", cut + polyline("8", box(400, 300)))), "p.dxf").panels[0]),
      0.12, 1e-9);
  EXPECT_NEAR(
      outline_area(
          read_dxf(file(block("a", cut + polyline("8", box(200, 150, 100)))), "p.dxf").panels[0]),
      0.42 * 0.32, 1e-9);
  // A sew line that leaves out most of the piece is a fault of the exporting program.
  const Pattern p = read_dxf(file(block("a", cut + polyline("14", box(150, 300)))), "p.dxf");
  EXPECT_NEAR(outline_area(p.panels[0]), 0.42 * 0.32, 1e-9);
  EXPECT_TRUE(std::any_of(p.findings.begin(), p.findings.end(), [](const Message& f) {
    return f.text.find("does not follow its outline") != std::string::npos;
  }));
}

} // namespace
} // namespace sloper::pattern::test

/// What files of real CAD systems say and ask, each on a small drawing of our own.
#include <support/pattern_texts.hpp>

#include <gtest/gtest.h>
#include <sloper/base/error.hpp>
#include <sloper/pattern/seams/infer_seams.hpp>

namespace sloper::pattern::test::real_dxf {
namespace {

using Points = std::vector<Vec2>;

std::string text(double x, double y, const std::string& words, const std::string& layer = "1") {
  return "0\nTEXT\n8\n" + layer + "\n10\n" + std::to_string(x) + "\n20\n" + std::to_string(y) +
         "\n1\n" + words + "\n";
}

std::string polyline(const Points& points, const std::string& layer = "1") {
  std::string t = "0\nPOLYLINE\n8\n" + layer + "\n66\n1\n70\n1\n";
  for (const Vec2& p : points)
    t += "0\nVERTEX\n8\n" + layer + "\n10\n" + std::to_string(p.x()) + "\n20\n" +
         std::to_string(p.y()) + "\n";
  return t + "0\nSEQEND\n8\n" + layer + "\n";
}

std::string line(const Vec2& a, const Vec2& b, const std::string& layer) {
  return "0\nLINE\n8\n" + layer + "\n10\n" + std::to_string(a.x()) + "\n20\n" +
         std::to_string(a.y()) + "\n11\n" + std::to_string(b.x()) + "\n21\n" +
         std::to_string(b.y()) + "\n";
}

std::string block(const std::string& name, const std::string& content) {
  return "0\nBLOCK\n8\n1\n2\n" + name + "\n" + text(0, 0, "Piece Name: " + name) + content +
         "0\nENDBLK\n";
}

std::string file(const std::string& blocks) {
  return "0\nSECTION\n2\nBLOCKS\n" + blocks + "0\nENDSEC\n0\nSECTION\n2\nENTITIES\n" +
         text(0, 0, "Units: METRIC") + "0\nENDSEC\n0\nEOF\n";
}

Points box(double w, double h) {
  return {{0, 0}, {w, 0}, {w, h}, {0, h}};
}
Points sleeve() {
  return {{0, 0}, {300, 0}, {340, 200}, {250, 330}, {140, 350}, {60, 300}, {-40, 200}};
} // its cap leans to one side

bool found(const Pattern& p, const std::string& words) {
  return std::any_of(p.findings.begin(), p.findings.end(),
                     [&](const Message& f) { return f.text.find(words) != std::string::npos; });
}

std::vector<std::string> names(const Pattern& p) {
  std::vector<std::string> out;
  for (const Panel& panel : p.panels)
    out.push_back(panel.name);
  return out;
}

using Names = std::vector<std::string>;

TEST(RealDxf, APieceThatIsCutTwiceHasItsMirrorImage) {
  for (const char* words :
       {"Quantity: 2", "Quantity: 1,1", "ANNOTATION: 2XFABRIC", "Quantity : 2"}) {
    Pattern p =
        read_dxf(file(block("SLEEVE", polyline(sleeve()) + "0\nPOINT\n8\n4\n10\n320\n20\n100\n" +
                                          text(0, 0, words))),
                 "p.dxf");
    ASSERT_EQ(names(p), (Names{"SLEEVE", "SLEEVE_mirror"})) << words;
    EXPECT_NEAR(outline_area(p.panels[0]), outline_area(p.panels[1]), 1e-12);
    for (const PanelEdge& e : p.panels[0].loops[0]) {
      const PanelEdge& image = p.panels[1].edge(p.panels[1].find_edge(e.name));
      EXPECT_LT(
          (image.path.front().p[0] - Vec2(-e.path.back().p[3].x(), e.path.back().p[3].y())).norm(),
          1e-12)
          << e.name;
    }
    ASSERT_EQ(p.panels[1].notches.size(), 1u);
    const Notch &own = p.panels[0].notches[0], &other = p.panels[1].notches[0];
    EXPECT_EQ(p.panels[0].edge(own.edge).name, p.panels[1].edge(other.edge).name);
    EXPECT_NEAR(own.at, 1 - other.at, 1e-12);
  }
  const Pattern one = read_dxf(file(block("SLEEVE", polyline(sleeve()) + text(0, 0, "Quantity: 1") +
                                                        text(0, 0, "Annotation: 2XFABRIC"))),
                               "p.dxf");
  EXPECT_EQ(one.panels.size(), 1u) << "the quantity counts";
}

/// Front and back in one piece each, sleeves in two halves that are cut twice.
TEST(RealDxf, OfBothShouldersNoneIsLeftOut) {
  const Points front = {{0, 0},     {520, 0},   {520, 460}, {460, 520}, {450, 660}, {350, 700},
                        {310, 620}, {210, 620}, {170, 700}, {70, 660},  {60, 520},  {0, 460}},
               back = {{0, 0},     {520, 0},   {520, 460}, {470, 510}, {460, 670}, {350, 715},
                       {300, 690}, {220, 690}, {170, 715}, {60, 670},  {50, 510},  {0, 460}},
               sleeve_front = {{0, 0}, {160, 0}, {188, 81}, {105, 145}, {46, 227}, {0, 229}},
               sleeve_back = {{0, 0}, {200, 0}, {230, 84}, {180, 150}, {40, 290}, {0, 229}};
  const Pattern p =
      read_dxf(file(block("TEE FR", polyline(front) + text(0, 0, "Quantity: 1")) +
                    block("TEE BK", polyline(back) + text(0, 0, "Quantity: 1")) +
                    block("TEE SL FR", polyline(sleeve_front) + text(0, 0, "Quantity: 2")) +
                    block("TEE SL BK", polyline(sleeve_back) + text(0, 0, "Quantity: 2"))),
               "tee.dxf");
  int shoulders = 0;
  for (const SeamGuess& guess : infer_seams(p)) {
    const pattern::Run &a = guess.seam.a[0], &b = guess.seam.b[0];
    const std::string names =
        p.panels[a.panel].edge(a.edge).name + " " + p.panels[b.panel].edge(b.edge).name;
    shoulders += names == "edge4 edge8" || names == "edge6 edge4";
  }
  EXPECT_EQ(shoulders, 2) << "one, and its mirror image";
}

TEST(RealDxf, OfASymmetricPairOneIsTakenUnlessItGoesAroundALimb) {
  const auto read = [](const std::string& name) {
    return read_dxf(file(block(name, polyline(box(300, 60)) + text(0, 0, "Quantity: 2"))), "p.dxf")
        .panels.size();
  };
  EXPECT_EQ(read("COLLAR STAND"), 1u);
  EXPECT_EQ(read("CUFF"), 2u);
}

TEST(RealDxf, WhoSewsAPairSaysSoByItsName) {
  const std::string text_of = file(block("SLEEVE", polyline(sleeve()) + text(0, 0, "Quantity: 2")));
  DxfChoice choice;
  choice.sewn = {"SLEEVE"};
  EXPECT_EQ(read_dxf(text_of, "p.dxf", choice).panels.size(), 1u);
  choice.sewn = {"SLEEVE", "SLEEVE_mirror"};
  EXPECT_EQ(read_dxf(text_of, "p.dxf", choice).panels.size(), 2u);
}

TEST(RealDxf, WhatLiesInsideIsLeftOutUnlessItIsAskedFor) {
  const std::string front = block("A1", polyline(box(400, 600)) + text(0, 0, "Quantity: 1") +
                                            text(0, 0, "Category: FRONT"));
  const std::string fused =
      block("A2", polyline(box(400, 590)) + text(0, 0, "Annotation: 1XFABRIC 1X INTERLIN"));
  for (const char* words :
       {"Category: FRONT LINING", "Material: INTERLINING", "Annotation: 1XINTERLINING",
        "Fabric: Futter", "Category: NECK FACING"}) {
    const std::string all =
        file(front + fused + block("B", polyline(box(380, 580)) + text(0, 0, words)));
    const Pattern p = read_dxf(all, "p.dxf");
    EXPECT_EQ(names(p), (Names{"A1", "A2"})) << words;
    EXPECT_TRUE(found(p, "B is ")) << words;
    DxfChoice choice;
    choice.pieces = {"b"};
    EXPECT_EQ(names(read_dxf(all, "p.dxf", choice)), (Names{"A1", "A2", "B"})) << words;
    choice = {};
    choice.sewn = {"B"};
    EXPECT_EQ(read_dxf(all, "p.dxf", choice).panels.size(), 3u) << words;
  }
}

TEST(RealDxf, AQuantityOfNoneIsAnAlternative) {
  const std::string front = block("FRONT", polyline(box(400, 600)) + text(0, 0, "Quantity: 1"));
  const std::string none = block("V FRONT", polyline(box(400, 590)) + text(0, 0, "Quantity: 0"));
  EXPECT_EQ(names(read_dxf(file(front + none), "p.dxf")), Names{"FRONT"});
  EXPECT_EQ(read_dxf(file(none), "p.dxf").panels.size(), 1u) << "all that there is";
}

TEST(RealDxf, TheFrameOfADrawingIsNoPiece) {
  const std::string front =
      block("FRONT", polyline(box(400, 600)) + line({200, 100}, {200, 500}, "7"));
  const Pattern p = read_dxf(file(front + block("BOX", polyline(box(3200, 3200)))), "p.dxf");
  EXPECT_EQ(names(p), Names{"FRONT"});
  EXPECT_TRUE(found(p, "is a frame of 320.00 cm by 320.00 cm"));
}

TEST(RealDxf, SlitsInTheCutLineAreNotches) {
  const Points slit = {{0, 0}, {400, 0}, {400, 200}, {390, 200}, {400, 200}, {400, 300}, {0, 300}};
  const Pattern p = read_dxf(file(block("FRONT", polyline(slit))), "p.dxf");
  EXPECT_NEAR(outline_area(p.panels[0]), 0.12, 1e-12);
  ASSERT_EQ(p.panels[0].notches.size(), 1u);
  const ArcLength arc(p.panels[0].edge(p.panels[0].notches[0].edge).path);
  EXPECT_LT((arc.at(p.panels[0].notches[0].at * arc.length()) - Vec2(0.4, 0.2)).norm(), 1e-3);
  // The tip of a narrow dart turns back too.
  const Points dart = {{0, 0},   {190, 0}, {199.5, 190}, {200, 200}, {200.5, 190},
                       {210, 0}, {400, 0}, {400, 300},   {0, 300}};
  EXPECT_NEAR(outline_area(read_dxf(file(block("FRONT", polyline(dart))), "p.dxf").panels[0]),
              0.12 - 0.5 * 0.02 * 0.19 - 0.5 * 0.001 * 0.2, 1e-5);
  const Points over = {{0.1, 0}, {400, 0}, {400, 300}, {0, 300}, {0, 0}, {0.2, 0}};
  const Pattern closed = read_dxf(file(block("FRONT", polyline(over))), "p.dxf");
  EXPECT_NEAR(outline_area(closed.panels[0]), 0.12, 1e-6);
  EXPECT_TRUE(closed.panels[0].notches.empty()) << "an overshoot is no notch";
}

TEST(RealDxf, AnAllowanceIsTakenOffTheCutLineAndNotOffTheFold) {
  DxfChoice choice;
  choice.allowance = 0.01;
  EXPECT_NEAR(
      outline_area(read_dxf(file(block("A", polyline(box(400, 300)))), "p.dxf", choice).panels[0]),
      0.38 * 0.28, 1e-12);
  const std::string half = polyline(box(200, 300)) + line({0, 10}, {0, 290}, "6");
  const Pattern whole = read_dxf(file(block("A", half)), "p.dxf", choice);
  EXPECT_NEAR(outline_area(whole.panels[0]), 0.38 * 0.28, 1e-12);
  // A corner that is cut off by less than the allowance takes away comes back as a corner.
  const Points chamfer = {{0, 0}, {400, 0}, {400, 299}, {399, 300}, {0, 300}};
  const Pattern mitred = read_dxf(file(block("A", polyline(chamfer))), "p.dxf", choice);
  EXPECT_NEAR(outline_area(mitred.panels[0]), 0.38 * 0.28, 1e-9);
  const std::string with_sew_line =
      polyline(box(400, 300)) + polyline({{10, 10}, {390, 10}, {390, 290}, {10, 290}}, "14");
  EXPECT_NEAR(outline_area(read_dxf(file(block("A", with_sew_line)), "p.dxf", choice).panels[0]),
              0.38 * 0.28, 1e-12)
      << "once only";
}

TEST(RealDxf, TheUnitThatTheUserStatesCounts) {
  DxfChoice choice;
  choice.unit = 0.01;
  EXPECT_NEAR(
      outline_area(read_dxf(file(block("A", polyline(box(40, 30)))), "p.dxf", choice).panels[0]),
      0.12, 1e-12);
}

TEST(RealDxf, MetricMayMeanCentimetres) {
  const Pattern small = read_dxf(file(block("A", polyline(box(60, 40)))), "p.dxf"),
                usual = read_dxf(file(block("A", polyline(box(600, 400)))), "p.dxf");
  EXPECT_NEAR(outline_area(small.panels[0]), 0.24, 1e-12);
  EXPECT_TRUE(found(small, "centimetres are taken"));
  EXPECT_NEAR(outline_area(usual.panels[0]), 0.24, 1e-12);
  EXPECT_FALSE(found(usual, "centimetres are taken"));
}

TEST(RealDxf, AFlatDrawingHasAPieceForEachOutline) {
  std::string lines;
  const auto draw = [&](const Points& points) {
    for (std::size_t k = 0; k < points.size(); ++k)
      lines += line(points[k], points[(k + 1) % points.size()], "outline");
  };
  draw(box(400, 300));
  draw({{100, 100}, {150, 100}, {150, 150}}); // inside, so no piece
  draw({{500, 0}, {800, 0}, {800, 200}, {500, 200}});
  const Pattern p =
      read_dxf("0\nSECTION\n2\nENTITIES\n" + lines + text(600, 100, "BACK") + "0\nENDSEC\n0\nEOF\n",
               "p.dxf");
  EXPECT_EQ(names(p), (Names{"BACK", "piece1"}));
  EXPECT_NEAR(outline_area(p.panels[1]), 0.12, 1e-9);
  try {
    read_dxf("0\nSECTION\n2\nENTITIES\n" + line({0, 0}, {1, 1}, "1") + "0\nENDSEC\n0\nEOF\n",
             "p.dxf");
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("form no closed outline"), std::string::npos) << e.what();
  }
}

TEST(RealDxf, NumbersMayStandOnTheLineOfTheirRule) {
  const std::string head = "UNITS: METRIC\nNUMBER OF SIZES: 2\nSIZE LIST: M L\nSAMPLE SIZE: M\n";
  const GradeRules inline_rules =
      parse_grade_rules(head + "RULE: DELTA 1 0.00, 0.00 10.00, 5.00 \nEND\n", "t.rul");
  const GradeRules lines =
      parse_grade_rules(head + "RULE: DELTA 1\n0.00, 0.00\n10.00, 5.00\nEND\n", "t.rul");
  ASSERT_EQ(inline_rules.moves.at(1).size(), 2u);
  EXPECT_EQ(inline_rules.moves.at(1)[1], lines.moves.at(1)[1]);
}

} // namespace
} // namespace sloper::pattern::test::real_dxf

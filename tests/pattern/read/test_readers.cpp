#include <support/pattern_texts.hpp>
#include <support/scratch_folder.hpp>

#include <gtest/gtest.h>
#include <sloper/base/error.hpp>
#include <sloper/io/files.hpp>

namespace sloper::pattern::test {
namespace {

/// A GarmentCode specification with one panel of each sense and every kind of edge.
const char* GARMENTCODE = R"({"pattern": {"panels": {
  "front": {"translation": [0, 100, 20], "rotation": [0, 0, 0], "vertices": [[0, 0], [40, 0], [40, 30], [0, 30]], "edges": [
    {"endpoints": [0, 1], "curvature": {"type": "quadratic", "params": [[0.5, 0.2]]}}, {"endpoints": [1, 2]},
    {"endpoints": [2, 3], "curvature": {"type": "circle", "params": [25, 0, 1]}}, {"endpoints": [3, 0], "curvature": {"type": "cubic", "params": [[0.2, 0.1], [0.8, -0.1]]}}]},
  "back": {"translation": [0, 100, -20], "rotation": [0, 0, 0], "vertices": [[0, 0], [0, 30], [40, 30], [40, 0]], "edges": [
    {"endpoints": [0, 1], "curvature": [0.5, 0.1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}]}},
  "stitches": [[{"panel": "front", "edge": 1}, {"panel": "back", "edge": 2}], [{"panel": "front", "edge": 3}, {"panel": "back", "edge": 0}, "right_wrong"]]},
  "properties": {"curvature_coords": "relative", "units_in_meter": 100}})";

Pattern garmentcode() {
  Pattern p = read_garmentcode(io::parse_json(GARMENTCODE, "spec.json"), "spec.json");
  finish_pattern(p, "spec.json");
  return p;
}

TEST(GarmentCode, CurvesFollowTheirConventions) {
  const Pattern p = garmentcode();
  const Panel& front = p.panels[0];
  // Quadratic: control half way, 0.2 of the chord to the left of it; the curve passes half way to
  // it.
  EXPECT_NEAR(front.edge(0).path[0].at(0.5).y(), 0.5 * 0.2 * 0.4, 1e-12);
  // Circle from (40, 30) to (0, 30) turning counter-clockwise bulges upwards by the sagitta.
  EXPECT_NEAR(ArcLength(front.edge(2).path).at(0.5 * length(front.edge(2).path)).y(),
              0.30 + 0.25 - std::sqrt(0.25 * 0.25 - 0.2 * 0.2), 1e-7);
  // Cubic: controls at 0.2 and 0.8 of the way down, to the left (+x) and to the right.
  EXPECT_NEAR(front.edge(3).path[0].p[1].y(), 0.24, 1e-12);
  EXPECT_NEAR(front.edge(3).path[0].p[1].x(), 0.03, 1e-12);
}

TEST(GarmentCode, AClockwisePanelIsTurnedOverAndStaysInItsPlace) {
  const Pattern p = garmentcode();
  const Panel& back = p.panels[1];
  EXPECT_GT(outline_area(back), 0);
  const Vec2 corner = back.edge(1).path.front().p[0];
  EXPECT_LT((corner - Vec2(0, 0.3)).norm(), 1e-12);
  const Vec2 other = back.edge(2).path.front().p[0];
  EXPECT_LT((other - Vec2(-0.4, 0.3)).norm(), 1e-12) << "x is mirrored";
  const Eigen::Vector4d world = *back.hint.rigid * Eigen::Vector4d(other.x(), other.y(), 0, 1);
  EXPECT_LT((world.head<3>() - Vec3(0.4, 1.3, -0.2)).norm(), 1e-12)
      << "and the placement takes it back";
  EXPECT_LT((back.hint.rigid->topLeftCorner<3, 3>() * Vec3(0, 0, 1) - Vec3(0, 0, -1)).norm(), 1e-12)
      << "its outside looks backwards";
}

TEST(GarmentCode, StitchesRunAgainstEachOtherUnlessRightWrong) {
  const Pattern p = garmentcode();
  EXPECT_LT(p.seams[0].a[0].from, p.seams[0].a[0].to);
  EXPECT_GT(p.seams[0].b[0].from, p.seams[0].b[0].to);
  EXPECT_LT(p.seams[1].b[0].from, p.seams[1].b[0].to);
}

TEST(GarmentCode, APanelPlacedWithItsOutsideTowardsTheBodyIsTheOneDrawnTheOtherWayRound) {
  std::string text = GARMENTCODE;
  const auto replace = [&](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  replace(R"([[0, 0], [0, 30], [40, 30], [40, 0]], "edges": [
    {"endpoints": [0, 1], "curvature": [0.5, 0.1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}])",
          R"([[0, 0], [40, 0], [40, 30], [0, 30]], "edges": [
    {"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0], "curvature": [0.5, -0.1]}])");
  replace(R"("panel": "back", "edge": 2)", R"("panel": "back", "edge": 1)");
  replace(R"("panel": "back", "edge": 0)", R"("panel": "back", "edge": 3)");
  Pattern p = read_garmentcode(io::parse_json(text, "spec.json"), "spec.json");
  finish_pattern(p, "spec.json");
  const Pattern right = garmentcode();
  EXPECT_TRUE(right.findings.size() == 1 && p.findings.size() == 2 &&
              p.findings[0].text.starts_with("back: placed with its outside towards the body"));
  EXPECT_TRUE(p.panels[1].hint.rigid->isApprox(*right.panels[1].hint.rigid));
  for (std::size_t k = 0; k < p.seams.size(); ++k) {
    const pattern::Run &run = p.seams[k].b[0], &same = right.seams[k].b[0];
    const ArcLength edge(p.panels[1].edge(run.edge).path),
        like(right.panels[1].edge(same.edge).path);
    for (double t : {0.0, 0.3, 1.0})
      EXPECT_LT((edge.at((run.from + t * (run.to - run.from)) * edge.length()) -
                 like.at((same.from + t * (same.to - same.from)) * like.length()))
                    .norm(),
                1e-9);
  }
}

TEST(GarmentCode, RotationsAreIntrinsicXYZ) {
  std::string text = GARMENTCODE;
  const std::string from = "\"translation\": [0, 100, 20], \"rotation\": [0, 0, 0]";
  text.replace(text.find(from), from.size(),
               "\"translation\": [0, 100, 20], \"rotation\": [90, 0, 90]");
  const Pattern p = read_garmentcode(io::parse_json(text, "spec.json"), "spec.json");
  const Vec3 x =
      p.panels[0].hint.rigid->topLeftCorner<3, 1>(); // Rx(90) Rz(90) e_x = Rx(90) e_y = e_z
  EXPECT_LT((x - Vec3(0, 0, 1)).norm(), 1e-12);
}

TEST(GarmentCode, OpenOutlinesAndMissingEdgesAreRefusedWithPanelAndCentimetres) {
  std::string text = GARMENTCODE;
  const std::string from =
      "{\"endpoints\": [1, 2]},\n    {\"endpoints\": [2, 3], \"curvature\": {\"type\": \"circle\"";
  ASSERT_NE(text.find(from), std::string::npos);
  text.replace(text.find(from), 22, "{\"endpoints\": [1, 0]},");
  try {
    read_garmentcode(io::parse_json(text, "spec.json"), "spec.json");
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("panel front is open: edge 2 starts 50.00 cm"),
              std::string::npos)
        << e.what();
  }
  text = GARMENTCODE;
  text.replace(text.find("\"edge\": 2"), 9, "\"edge\": 9");
  try {
    read_garmentcode(io::parse_json(text, "spec.json"), "spec.json");
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("refers to edge 9 of panel back, which has 4"),
              std::string::npos)
        << e.what();
  }
}

TEST(OwnFormat, FoldAndMirrorMakeWholePanels) {
  const Pattern p =
      own(R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "f", "panels": [
    {"name": "half", "fold": {"edge": "cf", "suffix": ["_l", "_r"]}, "outline": [{"edge": "hem", "path": [["M", 0, 0], ["L", 20, 0]]}, {"edge": "side", "path": [["Q", 25, 30, 20, 60]]},
      {"edge": "top", "path": [["L", 0, 60]]}, {"edge": "cf", "path": [["L", 0, 0]]}]},
    {"name": "right", "outline": [{"edge": "a", "path": [["M", 1, 0], ["L", 20, 0]]}, {"edge": "b", "path": [["L", 5, 30]]}, {"edge": "c", "path": [["L", 1, 0]]}]},
    {"name": "left", "mirror_of": "right"}]})");
  EXPECT_EQ(p.panels[0].n_edges(), 6);
  EXPECT_GE(p.panels[0].find_edge("side_l"), 0);
  EXPECT_GE(p.panels[0].find_edge("side_r"), 0);
  EXPECT_NEAR(outline_area(p.panels[0]), 2 * (0.2 * 0.6 + 2.0 / 3 * 0.025 * 0.6 * 1), 1e-9);
  EXPECT_NEAR(outline_area(p.panels[1]), outline_area(p.panels[2]), 1e-12);
  EXPECT_NEAR(p.panels[2].edge(p.panels[2].find_edge("a")).path.front().p[0].x(), -0.2, 1e-12);
}

std::string dxf(const std::string& units, const std::string& outline_layer, bool reversed) {
  std::string t = "0\nSECTION\n2\nBLOCKS\n0\nBLOCK\n8\n1\n2\nP\n0\nTEXT\n8\n1\n10\n0\n20\n0\n1\nPie"
                  "ce Name:bib\n";
  const double x[5] = {0, 400, 400, 0, 0}, y[5] = {0, 0, 300, 300, 0};
  for (int k = 0; k < 4; ++k) { // four open polylines, two of them drawn against the others
    const int a = reversed ? 4 - k : k, b = reversed ? 3 - k : k + 1;
    t += "0\nPOLYLINE\n8\n" + outline_layer + "\n66\n1\n70\n0\n";
    for (int i : k % 2 ? std::vector<int>{b, a} : std::vector<int>{a, b})
      t += "0\nVERTEX\n8\n" + outline_layer + "\n10\n" + std::to_string(x[i]) + "\n20\n" +
           std::to_string(y[i]) + "\n";
    t += "0\nSEQEND\n8\n" + outline_layer + "\n";
  }
  for (int k = 0; k < 4; ++k)
    t += "0\nPOINT\n8\n2\n10\n" + std::to_string(x[k]) + "\n20\n" + std::to_string(y[k]) + "\n";
  t += "0\nTEXT\n8\n15\n10\n400\n20\n150\n1\nSEW tube a 0 + "
       "right\n0\nTEXT\n8\n15\n10\n0\n20\n150\n1\nSEW tube b 0 - left\n";
  t += "0\nLINE\n8\n7\n10\n0\n20\n10\n11\n100\n21\n10\n0\nENDBLK\n0\nENDSEC\n0\nSECTION\n2\nENTITIE"
       "S\n0\nTEXT\n8\n1\n10\n0\n20\n0\n1\nUnits: " +
       units + "\n0\nENDSEC\n0\nEOF\n";
  return t;
}

TEST(Dxf, OpenPolylinesAreChainedAndSewingTextsRead) {
  for (bool reversed : {false, true}) {
    Pattern p = read_dxf(dxf("METRIC", "14", reversed), "p.dxf");
    finish_pattern(p, "p.dxf");
    ASSERT_EQ(p.panels.size(), 1u);
    EXPECT_EQ(p.panels[0].name, "bib");
    EXPECT_EQ(p.panels[0].n_edges(), 4);
    EXPECT_NEAR(outline_area(p.panels[0]), 0.12, 1e-9)
        << "counter-clockwise whatever the drawing order";
    ASSERT_EQ(p.seams.size(), 1u);
    EXPECT_EQ(p.panels[0].edge(p.seams[0].a[0].edge).name, "right");
    EXPECT_NEAR(run_length(p, p.seams[0].a[0]), 0.3, 1e-12);
    EXPECT_NEAR(p.panels[0].grain.x(), 1, 1e-12);
    const Sewn sewn = sew(mesh_pattern(p, 0.02, "p.dxf"));
    EXPECT_EQ(sewn.wrong_direction + sewn.non_manifold, 0);
    EXPECT_EQ(sewn.boundary_loops, 2);
  }
}

TEST(Dxf, UnitsAreWordsAndTheCutLineServesWithoutASewLine) {
  Pattern p = read_dxf(dxf("ENGLISH", "1", false), "p.dxf");
  EXPECT_NEAR(outline_area(p.panels[0]), 400 * 300 * 0.0254 * 0.0254, 1e-6);
  EXPECT_TRUE(std::any_of(p.findings.begin(), p.findings.end(), [](const Message& f) {
    return f.text.find("no sew line") != std::string::npos;
  }));
}

TEST(Dxf, BadBytesAreRefused) {
  for (const std::string& text :
       {std::string("0\nSECTION\n2"), std::string("abc\ndef\n"),
        std::string("0\nSECTION\n2\nENTITIES\n0\nENDSEC\n0\nEOF\n"),
        std::string("0\nBLOCK\n10\nnan\n"), std::string("AutoCAD Binary DXF\r\n\0x", 22)})
    EXPECT_THROW(read_dxf(text, "p.dxf"), Error);
}

/// Numbers that a conversion to an integer would not bear further on: curves are cut by their
/// length, layers are counted from the lowest.
TEST(Readers, NumbersBeyondAllBoundsAreRefusedWithTheirPlace) {
  const auto fact = [](const std::string& text) -> std::string {
    try {
      own(text);
    } catch (const Error& e) {
      return e.place() + ": " + e.fact();
    }
    return "read";
  };
  const auto panel = [](const std::string& curve, const std::string& more = "") {
    return R"({"format": "pattern", "version": 1, "length_unit": "cm", "panels": [{"name": "p", "outline": [{"edge": "a", "path": [["M", 0, 0], )" +
           curve + R"(]}, {"edge": "b", "path": [["L", 40, 60], ["L", 0, 0]]}])" + more + "}]}";
  };
  EXPECT_EQ(fact(panel(R"(["L", 40, 0])")), "read");
  for (const char* far : {"1e308", "-1e200", "1e9"}) {
    EXPECT_NE(fact(panel(std::string(R"(["C", 10, )") + far + ", 30, 0, 40, 0]"))
                  .find("p: a: a control point"),
              std::string::npos)
        << far;
    EXPECT_NE(
        fact(panel(R"(["L", 40, 0])",
                   std::string(R"(, "lines": [{"name": "l", "path": [["M", 10, 10], ["L", )") +
                       far + R"(, 20]]}])"))
            .find("p: l"),
        std::string::npos)
        << far;
    EXPECT_NE(fact(panel(std::string("[\"L\", 40, ") + far + "]")).find("so the unit is wrong"),
              std::string::npos)
        << far;
  }
  EXPECT_NE(fact(panel(R"(["L", 40, 0])", R"(, "layer": -2000000000)")).find("is not a layer"),
            std::string::npos);
}

TEST(Readers, ASidecarMayLeaveASeamOpen) {
  Pattern p = own(tube_text());
  const std::string side =
      R"([{"panel": "front", "run": "top"}], "b": [{"panel": "back", "run": "top", "dir": "-"}])";
  read_sewing_seams(p,
                    io::parse_json(R"({"seams": [{"name": "neck", "open": true, "a": )" + side +
                                       R"(}, {"name": "hem", "a": )" + side + "}]}",
                                   "s"),
                    "s");
  ASSERT_EQ(p.seams.size(), 4u);
  EXPECT_TRUE(p.seams[2].open);
  EXPECT_FALSE(p.seams[3].open);
}

TEST(Readers, AMisspeltWordOfASidecarIsRefused) {
  const auto fact = [](const std::string& run, const std::string& seam) {
    Pattern p = own(tube_text());
    try {
      read_sewing_seams(p,
                        io::parse_json(R"({"seams": [{"a": [{"panel": "front", "run": "top")" +
                                           run + R"(}], "b": [{"panel": "back", "run": "top"}])" +
                                           seam + "}]}",
                                       "s"),
                        "s");
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_EQ(fact("", ""), "");
  EXPECT_NE(fact(R"(, "drr": "-")", "").find("unknown key \"drr\""), std::string::npos);
  EXPECT_NE(fact("", R"(, "knd": "dart")").find("unknown key \"knd\""), std::string::npos);
  EXPECT_NE(fact("", R"(, "kind": "gahter")").find("'gahter' is not a kind of seam"),
            std::string::npos);
}

TEST(Readers, AQuestionOfASidecarThatNoSeamAnswersIsOpen) {
  const sloper::test::ScratchFolder folder;
  const std::string pattern = folder / "tube.json", sidecar = folder / "q.json";
  io::write_file(pattern, tube_text());
  const auto open = [&](const std::string& seams) {
    io::write_file(sidecar, R"({"seams": [)" + seams +
                                R"(], "questions": [{"panel": "front", "run": "top"},
                                {"versions": [["front"], ["back"]]}]})");
    return read_pattern(pattern, PatternChoice{sidecar, "", "", 0, 0, {}, {}}).open_questions;
  };
  EXPECT_EQ(open(""), std::vector<std::string>{"front, top"});
  EXPECT_TRUE(open(R"({"a": [{"panel": "front", "run": "top"}],
                       "b": [{"panel": "back", "run": "top", "dir": "-"}]})")
                  .empty());
}

TEST(Readers, CutTextsNeverCrash) { // a truncated or damaged file is refused or read, never more
  const std::string texts[] = {tube_text(), GARMENTCODE, dxf("METRIC", "14", false)};
  int kind = 0;
  for (const std::string& whole : texts) {
    for (std::size_t n = 0; n < whole.size(); n += 37) {
      for (int damage = 0; damage < 2; ++damage) {
        std::string text = damage ? whole : whole.substr(0, n);
        if (damage)
          text[n] = static_cast<char>('0' + n % 10);
        try {
          Pattern p;
          if (kind == 0)
            p = read_pattern_json(io::parse_json(text, "x"), "x");
          else if (kind == 1)
            p = read_garmentcode(io::parse_json(text, "x"), "x");
          else
            p = read_dxf(text, "x");
          finish_pattern(p, "x");
        } catch (const Error&) {}
      }
    }
    ++kind;
  }
}

} // namespace
} // namespace sloper::pattern::test

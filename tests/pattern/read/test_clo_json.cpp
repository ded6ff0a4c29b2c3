/// The pattern JSON of CLO: two rectangles sewn to a tube, in the senses in which files list them.
#include <gtest/gtest.h>
#include <pattern/read/clo_json.hpp>
#include <sloper/base/error.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/read/read_pattern.hpp>

namespace sloper::pattern::test {
namespace {

std::string line(int id, double x0, double y0, double x1, double y1) {
  const auto point = [](double x, double y) {
    return R"({"PointType": "Straight", "Position": {"x": )" + std::to_string(x) + R"(, "y": )" +
           std::to_string(y) + "}}";
  };
  return R"({"ID": "line)" + std::to_string(id) + R"(", "PointList": [)" + point(x0, y0) + ", " +
         point(x1, y1) + "]}";
}

/// A rectangle of 300 by 500 mm: hem, right side, waist, left side, or against it.
std::string piece(const std::string& name, double x, bool clockwise) {
  const double l = x, r = x + 300;
  const std::string lines = clockwise ? line(0, r, 0, l, 0) + ", " + line(1, l, 0, l, 500) + ", " +
                                            line(2, l, 500, r, 500) + ", " + line(3, r, 500, r, 0)
                                      : line(0, l, 0, r, 0) + ", " + line(1, r, 0, r, 500) + ", " +
                                            line(2, r, 500, l, 500) + ", " + line(3, l, 500, l, 0);
  return R"({"Name": ")" + name + R"(", "ID": "id_)" + name +
         R"(", "IsClosed": true, "ShapeInfo": {"LineList": [)" + lines + "]}}";
}

std::string side(const std::string& name, double from, double to, bool direction) {
  return R"({"ShapeID": "id_)" + name + R"(", "LengthParam": {"fStart": )" + std::to_string(from) +
         R"(, "fEnd": )" + std::to_string(to) + R"(}, "Direction": )" +
         (direction ? "true" : "false") + "}";
}

std::string document(const std::string& pieces, const std::string& pairs) {
  return R"({"Unit": "mm", "PatternList": [)" + pieces +
         R"(], "SeamLinePairGroupList": [{"Name": "side", "bIsTurned": false, "PairList": [)" +
         pairs + "]}]}";
}

Pattern read(const std::string& text) {
  Pattern p = read_clo_json(io::parse_json(text, "clo.json"), "clo.json");
  finish_pattern(p, "clo.json");
  return p;
}

Vec2 start_of(const Pattern& p, const std::vector<Run>& side) {
  const Run& run = side.front();
  const Path& path = p.panels[run.panel].edge(run.edge).path;
  return ArcLength(path).at(run.from * length(path));
}

TEST(CloJson, SeamsJoinTheStretchesThatTheFileNames) {
  for (const bool clockwise : {false, true}) {
    // The right side of one (up) and the left side of the other (up), whichever way they are
    // listed.
    const std::string right = clockwise ? side("front", 1, 1100.0 / 1600, false)
                                        : side("front", 300.0 / 1600, 800.0 / 1600, true),
                      left = clockwise ? side("back", 300.0 / 1600, 800.0 / 1600, true)
                                       : side("back", 1, 1100.0 / 1600, false);
    const Pattern p =
        read(document(piece("front", 0, clockwise) + ", " + piece("back", 400, clockwise),
                      R"({"First": )" + right + R"(, "Second": )" + left + "}"));
    ASSERT_EQ(p.seams.size(), 1u);
    EXPECT_NEAR(side_length(p, p.seams[0].a), 0.5, 1e-9);
    EXPECT_NEAR(side_length(p, p.seams[0].b), 0.5, 1e-9);
    EXPECT_LT((start_of(p, p.seams[0].a) - Vec2(0.3, 0)).norm(), 1e-9) << clockwise;
    EXPECT_LT((start_of(p, p.seams[0].b) - Vec2(0.4, 0)).norm(), 1e-9) << clockwise;
    EXPECT_GT(p.panels[0].edge(0).path.front().p[0].x(), -1e-9) << "not mirrored";
  }
}

TEST(CloJson, AStretchOverTheStartOfTheOutlineIsTwoRuns) {
  const Pattern p = read(document(piece("front", 0, false) + ", " + piece("back", 400, false),
                                  R"({"First": )" + side("front", 0.9, 0.1, true) +
                                      R"(, "Second": )" + side("back", 0.1, 0.9, false) + "}"));
  ASSERT_EQ(p.seams.size(), 1u);
  ASSERT_EQ(p.seams[0].a.size(), 2u);
  EXPECT_NEAR(side_length(p, p.seams[0].a), 0.32, 1e-9);
  EXPECT_NEAR(side_length(p, p.seams[0].b), 0.32, 1e-9);
}

TEST(CloJson, APieceWithoutAnOutlineIsNamed) {
  try {
    read(R"({"PatternList": [{"Name": "collar", "ID": "a", "ShapeInfo": {}}]})");
    FAIL() << "was read";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("collar"), std::string::npos) << e.what();
    EXPECT_EQ(e.kind(), ErrorKind::INPUT);
  }
}

TEST(CloJson, CurvesAreSplinesAndBeziers) {
  const auto point = [](const char* type, double x, double y) {
    return R"({"PointType": ")" + std::string(type) + R"(", "Position": {"x": )" +
           std::to_string(x) + R"(, "y": )" + std::to_string(y) + "}}";
  };
  const std::string text = R"({"PatternList": [{"Name": "a", "ID": "a", "ShapeInfo": {"LineList": [
    {"PointList": [)" + point("Straight", 0, 0) +
                           ", " + point("Spline Curve", 150, -20) + ", " +
                           point("Straight", 300, 0) + R"(]},
    {"PointList": [)" + point("Straight", 300, 0) +
                           ", " + point("Bezier Curve", 300, 200) + ", " +
                           point("Bezier Curve", 0, 200) + ", " + point("Straight", 0, 0) +
                           "]}]}}]}";
  const Pattern p = read(text);
  ASSERT_EQ(p.panels[0].n_edges(), 2);
  const Path& spline = p.panels[0].edge(0).path;
  ASSERT_EQ(spline.size(), 2u);
  EXPECT_LT((spline[0].p[3] - Vec2(0.15, -0.02)).norm(), 1e-12);
  EXPECT_FALSE(p.panels[0].edge(1).path[0].line);
}

} // namespace
} // namespace sloper::pattern::test

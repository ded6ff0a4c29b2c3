/// Pieces of which names tell little: codes, kinds, turns and what is sewn to what say the rest.
#include <support/placement_patterns.hpp>
#include <support/straight_patterns.hpp>

#include <gtest/gtest.h>
#include <pattern/panel_words.hpp>
#include <pattern/roles/leg_roles.hpp>
#include <sloper/pattern/place/place_panels.hpp>

namespace sloper::pattern::test {
namespace {

/// A tank's front or back; upright, or lying along x with its hem at x = 0, as AccuMark writes
/// pieces.
std::string tank(const std::string& name, double neck, bool lying) {
  const std::vector<std::pair<const char*, Vec2>> corners = {
      {"hem", {23, 0}},          {"side_l", {21.5, 40}},     {"armhole_l", {11, 62}},
      {"shoulder_l", {7, 65}},   {"neck_l", {0, neck}},      {"neck_r", {-7, 65}},
      {"shoulder_r", {-11, 62}}, {"armhole_r", {-21.5, 40}}, {"side_r", {-23, 0}}};
  const auto point = [&](const Vec2& p) {
    const Vec2 q = lying ? Vec2(p.y(), -p.x()) : p;
    return std::to_string(q.x()) + ", " + std::to_string(q.y());
  };
  std::string outline = R"({"edge": "hem", "path": [["M", )" + point(corners.back().second) +
                        R"(], ["L", )" + point(corners[0].second) + "]]}";
  for (std::size_t k = 1; k < corners.size(); ++k)
    outline += std::string(R"(, {"edge": ")") + corners[k].first + R"(", "path": [["L", )" +
               point(corners[k].second) + "]]}";
  return R"({"name": ")" + name + R"(", "grain": )" + (lying ? "[1, 0]" : "[0, 1]") +
         R"(, "outline": [)" + outline + "]}";
}

Pattern two_panel_top(const std::string& front, const std::string& back, bool lying) {
  std::string seams;
  for (const char* edge : {"side", "shoulder"})
    for (const char* side : {"l", "r"}) {
      const std::string other = side == std::string("l") ? "r" : "l";
      seams += std::string(seams.empty() ? "" : ", ") + R"({"name": ")" + edge + side +
               R"(", "a": [{"panel": ")" + front + R"(", "edge": ")" + edge + "_" + side +
               R"("}], "b": [{"panel": ")" + back + R"(", "edge": ")" + edge + "_" + other +
               R"(", "from": 1, "to": 0}]})";
    }
  return own(
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "tank", "panels": [)" +
      tank(front, 43, lying) + ", " + tank(back, 60, lying) + R"(], "seams": [)" + seams + "]}");
}

/// Height of the middle of the points within 3 cm of a pattern height, m.
double height_at(const PanelMesh& mesh, std::size_t panel, double at, bool lying) {
  double sum = 0, n = 0;
  for (int v : mesh.panels[panel].outline) {
    const Vec2& p = mesh.pattern[v];
    if (std::abs((lying ? p.x() : p.y()) - at) < 0.03) {
      sum += mesh.placed[v].y();
      ++n;
    }
  }
  return sum / n;
}

TEST(PlacementUnnamed, ALyingTankHangsOnTheShouldersWithItsHemDown) {
  for (const bool lying : {true, false}) {
    SCOPED_TRACE(lying);
    const Pattern pattern = two_panel_top("TANK_FRONT", "TANK_BACK", lying);
    PanelMesh mesh = mesh_pattern(pattern, 0.03, "t");
    const body::Body body = stick_body(25, 1);
    const PlacementReport report = place_panels(pattern, body, mesh);
    EXPECT_EQ(report.crossings + report.vertices_inside, 0);
    for (std::size_t k : {0, 1}) {
      EXPECT_NEAR(height_at(mesh, k, 0.65, lying) - height_at(mesh, k, 0, lying), 0.65, 0.03);
      EXPECT_GT(height_at(mesh, k, 0.65, lying), 1.3);
    }
  }
}

TEST(PlacementUnnamed, OfTwoPanelsSewnTogetherAtBothSidesTheLargerIsTheBack) {
  const Pattern pattern = two_panel_top("37", "11", false);
  PanelMesh mesh = mesh_pattern(pattern, 0.03, "t");
  place_panels(pattern, stick_body(25, 1), mesh);
  EXPECT_GT(middle(mesh, 0).z(), 0.05) << "the lower neck is in front";
  EXPECT_LT(middle(mesh, 1).z(), -0.05);
}

TEST(PlacementUnnamed, ACuffGoesToTheArmOfItsSleeve) {
  const auto sleeve = [](const std::string& name) {
    return R"({"name": ")" + name +
           R"(", "outline": [{"edge": "hem", "path": [["M", -14, 0], ["L", 14, 0]]},
      {"edge": "a", "path": [["L", 18, 40]]}, {"edge": "first", "path": [["L", 0, 56]]}, {"edge": "second", "path": [["L", -18, 40]]},
      {"edge": "b", "path": [["L", -14, 0]]}]})";
  };
  const auto cuff = [](const std::string& name) {
    return R"({"name": ")" + name +
           R"(", "outline": [{"edge": "low", "path": [["M", 0, 0], ["L", 24, 0]]},
      {"edge": "end", "path": [["L", 24, 6]]}, {"edge": "top", "path": [["L", 0, 6]]}, {"edge": "start", "path": [["L", 0, 0]]}]})";
  };
  std::string seams;
  const auto sew = [&](const std::string& p, const std::string& e, const std::string& q,
                       const std::string& f) {
    seams += std::string(seams.empty() ? "" : ", ") + R"({"name": ")" + p + e +
             R"(", "kind": "gather", "a": [{"panel": ")" + p + R"(", "edge": ")" + e +
             R"("}], "b": [{"panel": ")" + q + R"(", "edge": ")" + f +
             R"(", "from": 1, "to": 0}]})";
  };
  for (const char* edge : {"side_", "shoulder_"}) {
    sew("front", std::string(edge) + "l", "back", std::string(edge) + "r");
    sew("front", std::string(edge) + "r", "back", std::string(edge) + "l");
  }
  sew("sleeve 1", "first", "front", "armhole_l");
  sew("sleeve 1", "second", "back", "armhole_r");
  sew("sleeve 2", "first", "back", "armhole_l");
  sew("sleeve 2", "second", "front", "armhole_r");
  for (const char* k : {"1", "2"}) {
    sew(std::string("sleeve ") + k, "a", std::string("sleeve ") + k, "b");
    sew(std::string("cuff ") + k, "top", std::string("sleeve ") + k, "hem");
    sew(std::string("cuff ") + k, "end", std::string("cuff ") + k, "start");
  }
  const Pattern pattern =
      own(R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "n", "panels": [)" +
          tank("front", 43, false) + ", " + tank("back", 60, false) + ", " + sleeve("sleeve 1") +
          ", " + sleeve("sleeve 2") + ", " + cuff("cuff 1") + ", " + cuff("cuff 2") +
          R"(], "seams": [)" + seams + "]}");
  PanelMesh mesh = mesh_pattern(pattern, 0.03, "t");
  place_panels(pattern, stick_body(25, 1), mesh);
  EXPECT_NE(mesh.panels[2].part, mesh.panels[3].part);
  EXPECT_EQ(mesh.panels[4].part, mesh.panels[2].part);
  EXPECT_EQ(mesh.panels[5].part, mesh.panels[3].part);
}

/// Half of a bodice: hem, middle or side, neck, shoulder, armhole, side; `width` cm at the hem.
std::string half_bodice(const std::string& name, double width, double neck, bool turned) {
  std::vector<std::pair<const char*, Vec2>> corners = {
      {"hem", {0, 0}},        {"side", {width, 0}}, {"armhole", {width + 1, 26}},
      {"shoulder", {16, 46}}, {"neck", {8, 49}},    {"middle", {0, neck}}};
  const auto point = [&](const Vec2& p) {
    return std::to_string(turned ? -p.x() : p.x()) + ", " + std::to_string(p.y());
  };
  std::string outline;
  const std::size_t n = corners.size();
  for (std::size_t k = 0; k < n; ++k) { // turned, the outline runs the other way
    const std::size_t at = turned ? n - 1 - k : k;
    const Vec2 &from = corners[turned ? (at + 1) % n : at].second,
               &to = corners[turned ? at : (at + 1) % n].second;
    outline += std::string(k ? ", " : "") + R"({"edge": ")" + corners[at].first +
               R"(", "path": [)" + (k ? "" : R"(["M", )" + point(from) + "], ") + R"(["L", )" +
               point(to) + "]]}";
  }
  return R"({"name": ")" + name + R"(", "outline": [)" + outline + "]}";
}

TEST(PlacementUnnamed, UnequalHalvesOfABodiceAreEachOnOneFace) {
  std::string seams;
  const auto sew = [&](const std::string& p, const std::string& q, const char* edge) {
    seams += std::string(seams.empty() ? "" : ", ") + R"({"name": ")" + p + edge +
             R"(", "kind": "gather", "a": [{"panel": ")" + p + R"(", "edge": ")" + edge +
             R"("}], "b": [{"panel": ")" + q + R"(", "edge": ")" + edge +
             R"(", "from": 1, "to": 0}]})";
  };
  sew("P1", "P2", "middle"); // fronts
  sew("P3", "P4", "middle"); // backs
  for (const char* edge : {"side", "shoulder"}) {
    sew("P1", "P3", edge);
    sew("P2", "P4", edge);
  }
  const Pattern pattern =
      own(R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "n", "panels": [)" +
          half_bodice("P1", 22, 33, false) + ", " + half_bodice("P2", 26, 38, true) + ", " +
          half_bodice("P3", 24, 46, true) + ", " + half_bodice("P4", 21, 44, false) +
          R"(], "seams": [)" + seams + "]}");
  PanelMesh mesh = mesh_pattern(pattern, 0.03, "t");
  place_panels(pattern, stick_body(25, 1), mesh);
  const auto front = [&](std::size_t k) { return middle(mesh, k).z() > 0; };
  EXPECT_EQ(front(0), front(1));
  EXPECT_EQ(front(2), front(3));
  EXPECT_NE(front(0), front(2));
}

/// A bodice of four halves with a hood of two, the names telling nothing: P1 and P2 are wider by
/// `bust`, as a front is.
Pattern hooded_bodice(double bust, double neck) {
  std::string seams;
  const auto sew = [&](const std::string& p, const std::string& e, const std::string& q,
                       const std::string& f) {
    seams += std::string(seams.empty() ? "" : ", ") + R"({"name": ")" + p + e + q +
             R"(", "kind": "gather", "a": [{"panel": ")" + p + R"(", "edge": ")" + e +
             R"("}], "b": [{"panel": ")" + q + R"(", "edge": ")" + f +
             R"(", "from": 1, "to": 0}]})";
  };
  const auto hood = [](const std::string& name, bool turned) {
    const double s = turned ? -1 : 1;
    const std::string sign = std::to_string(s);
    const auto at = [&](double x, double y) {
      return std::to_string(s * x) + ", " + std::to_string(y);
    };
    std::vector<std::pair<const char*, std::string>> corners = {{"f", at(12, 0)},
                                                                {"face", at(14, 32)},
                                                                {"top", at(-6, 34)},
                                                                {"middle", at(-8, 4)},
                                                                {"b", at(0, 0)}};
    std::string outline;
    const std::size_t n = corners.size();
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t own = turned ? n - 1 - k : k;
      const std::string& from = corners[turned ? own : (own + n - 1) % n].second;
      const std::string& to = corners[turned ? (own + n - 1) % n : own].second;
      outline += std::string(k ? ", " : "") + R"({"edge": ")" + corners[own].first +
                 R"(", "path": [)" + (k ? "" : R"(["M", )" + from + "], ") + R"(["L", )" + to +
                 "]]}";
    }
    return R"({"name": ")" + name + R"(", "outline": [)" + outline + "]}";
  };
  sew("P1", "middle", "P2", "middle");
  sew("P3", "middle", "P4", "middle");
  sew("P5", "middle", "P6", "middle");
  sew("P5", "top", "P6", "top");
  for (const char* edge : {"side", "shoulder"}) {
    sew("P1", edge, "P3", edge);
    sew("P2", edge, "P4", edge);
  }
  sew("P1", "neck", "P5", "f");
  sew("P3", "neck", "P5", "b");
  sew("P2", "neck", "P6", "f");
  sew("P4", "neck", "P6", "b");
  return own(
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "n", "panels": [)" +
      half_bodice("P1", 22 + bust, neck, false) + ", " + half_bodice("P2", 22 + bust, neck, true) +
      ", " + half_bodice("P3", 22, 46, true) + ", " + half_bodice("P4", 22, 46, false) + ", " +
      hood("P5", false) + ", " + hood("P6", true) + R"(], "seams": [)" + seams + "]}");
}

TEST(PlacementUnnamed, AHoodDoesNotPutTheBackOnTheFront) {
  const Pattern pattern = hooded_bodice(1.5, 41);
  PanelMesh mesh = mesh_pattern(pattern, 0.03, "t");
  place_panels(pattern, stick_body(25, 1), mesh);
  for (const std::size_t k : {0, 1})
    EXPECT_GT(middle(mesh, k).z(), 0) << "the wider one with the lower neck is the front: " << k;
  for (const std::size_t k : {2, 3})
    EXPECT_LT(middle(mesh, k).z(), 0) << k;
}

TEST(PlacementUnnamed, FrontAndBackThatAreAlikeAreAskedAboutAndAWordAnswers) {
  const auto asked = [](const PanelMesh& mesh) {
    return std::any_of(mesh.findings.begin(), mesh.findings.end(),
                       [](const Message& m) { return m.id == "placement.front-unsure"; });
  };
  Pattern pattern = hooded_bodice(0, 46);
  PanelMesh mesh = mesh_pattern(pattern, 0.03, "t");
  place_panels(pattern, stick_body(25, 1), mesh);
  EXPECT_TRUE(asked(mesh));
  const bool first = middle(mesh, 0).z() > 0;
  Pattern named = pattern;
  named.panels[first ? 0 : 2].name += " back";
  PanelMesh turned = mesh_pattern(named, 0.03, "t");
  place_panels(named, stick_body(25, 1), turned);
  EXPECT_FALSE(asked(turned));
  EXPECT_NE(middle(turned, 1).z() > 0, first) << "its other half goes with it";
}

TEST(PlacementUnnamed, WhatCannotBeMeantIsTold) {
  Pattern pattern = two_panel_top("front", "back", false);
  pattern.panels.push_back(pattern.panels[0]);
  pattern.panels.back().name = "front_low";
  for (std::size_t k = 0; k < 3; ++k) { // the third, which nothing is sewn to, far below
    Mat4 placed = Mat4::Identity();
    if (k == 1)
      placed.topLeftCorner<3, 3>() = Eigen::AngleAxisd(M_PI, Vec3::UnitY()).toRotationMatrix();
    placed(1, 3) = k == 2 ? -3 : 0.8;
    placed(2, 3) = k == 1 ? -0.3 : 0.3;
    pattern.panels[k].hint.rigid = placed;
  }
  PanelMesh mesh = mesh_pattern(pattern, 0.03, "t");
  const PlacementReport report = place_panels(pattern, stick_body(25, 1), mesh);
  ASSERT_FALSE(report.impossible.empty());
  EXPECT_NE(report.impossible.front().find("front_low starts below the floor"), std::string::npos)
      << report.impossible.front();
}

/// A closed outline of named edges, cm.
std::string outline_text(const std::string& name,
                         const std::vector<std::pair<const char*, Vec2>>& corners) {
  const auto point = [](const Vec2& p) {
    return std::to_string(p.x()) + ", " + std::to_string(p.y());
  };
  std::string outline;
  for (const auto& [edge, to] : corners)
    outline += std::string(outline.empty() ? R"({"edge": ")" : R"(, {"edge": ")") + edge +
               R"(", "path": [)" +
               (outline.empty() ? R"(["M", )" + point(corners.back().second) + "], " : "") +
               R"(["L", )" + point(to) + "]]}";
  return R"({"name": ")" + name + R"(", "outline": [)" + outline + "]}";
}

TEST(PlacementUnnamed, ASheetThatStartsMostlyBelowTheFloorIsTold) { // 3 by 2 m, alone, by CLO
  const auto fault = [](double height) -> std::string {
    const Pattern sheet =
        own(R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "t", "panels": [)" +
            outline_text("Pattern2D_4937", {{"low", {150, 0}},
                                            {"right", {150, height}},
                                            {"high", {-150, height}},
                                            {"left", {-150, 0}}}) +
            R"(], "seams": []})");
    PanelMesh mesh = mesh_pattern(sheet, 0.05, "t");
    const PlacementReport report = place_panels(sheet, stick_body(25, 1), mesh);
    return report.impossible.empty() ? "" : report.impossible.front();
  };
  EXPECT_NE(fault(260).find("of its area below the floor, down to -"), std::string::npos)
      << fault(260);
  EXPECT_EQ(fault(60), "") << "a stole";
}

TEST(PlacementUnnamed, AFlounceAtASleeveLiesAlongTheArmThoughItsSidesLeanFarOut) {
  const std::vector<std::pair<const char*, Vec2>>
      trunk = {{"hem", {25, 0}},        {"side_l", {25, 40}}, {"arm_l", {20, 60}},
               {"shoulder_l", {8, 63}}, {"neck", {-8, 63}},   {"shoulder_r", {-20, 60}},
               {"arm_r", {-25, 40}},    {"side_r", {-25, 0}}},
      sleeve = {{"hem", {14, 0}}, {"one", {17, 20}}, {"cap", {-3, 20}}, {"two", {0, 0}}},
      flounce = {{"low", {30, 0}}, {"one", {22, 6}}, {"top", {8, 6}}, {"two", {0, 0}}};
  std::string seams;
  const auto sew = [&](const std::string& a, const std::string& b) {
    const auto run = [](const std::string& text) {
      const std::size_t dot = text.find('.');
      return R"({"panel": ")" + text.substr(0, dot) + R"(", "edge": ")" + text.substr(dot + 1) +
             '"';
    };
    seams += std::string(seams.empty() ? "" : ", ") + R"({"name": ")" + a + R"(", "a": [)" +
             run(a) + R"(}], "b": [)" + run(b) + R"(, "from": 1, "to": 0}]})";
  };
  for (const char* edge : {"side", "shoulder"}) {
    sew(std::string("front.") + edge + "_l", std::string("back.") + edge + "_r");
    sew(std::string("front.") + edge + "_r", std::string("back.") + edge + "_l");
  }
  for (const char* part : {"left_sleeve", "sl_left_cuff_skirt"}) {
    sew(std::string(part) + "_f.one", std::string(part) + "_b.two");
    sew(std::string(part) + "_f.two", std::string(part) + "_b.one");
  }
  for (const char* half : {"_f", "_b"})
    sew(std::string("left_sleeve") + half + ".hem",
        std::string("sl_left_cuff_skirt") + half + ".top");
  sew("front.arm_l", "left_sleeve_f.cap");
  sew("back.arm_r", "left_sleeve_b.cap");
  const Pattern pattern =
      own(R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "n", "panels": [)" +
          outline_text("front", trunk) + ", " + outline_text("back", trunk) + ", " +
          outline_text("left_sleeve_f", sleeve) + ", " + outline_text("left_sleeve_b", sleeve) +
          ", " + outline_text("sl_left_cuff_skirt_f", flounce) + ", " +
          outline_text("sl_left_cuff_skirt_b", flounce) + R"(], "seams": [)" + seams + "]}");
  PanelMesh mesh = mesh_pattern(pattern, 0.03, "t");
  const PlacementReport report = place_panels(pattern, stick_body(45), mesh);
  EXPECT_LT(report.seam_gap_mean, 0.2);
  const Vec3 shoulder = middle(mesh, 2);
  for (const std::size_t panel : {4u, 5u}) {
    EXPECT_EQ(mesh.panels[panel].part, "arm_l");
    double near = 0, far = 0, n_near = 0, n_far = 0;
    for (int v : mesh.panels[panel].outline) {
      const double reach = (mesh.placed[v] - shoulder).norm();
      if (mesh.pattern[v].y() > 0.059) {
        near += reach;
        ++n_near;
      }
      if (mesh.pattern[v].y() < 0.001) {
        far += reach;
        ++n_far;
      }
    }
    EXPECT_GT(far / n_far, near / n_near + 0.03) << panel;
  }
}

/// Leggings of two one-piece legs and a band, all lying along x, the band's seam at its upper side.
TEST(PlacementUnnamed, ABandThatLiesStandsOnItsSeamAndGoesRoundTheSameWay) {
  const auto edge = [](const std::string& name, const std::string& to) {
    return R"({"edge": ")" + name + R"(", "path": [["L", )" + to + "]]}";
  };
  const Pattern pattern = own(
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "leggings", "panels": [
    {"name": "legging_r", "grain": [1, 0], "outline": [{"edge": "in_f", "path": [["M", 0, 0], ["L", 60, 0]]}, )" +
      edge("cr_f", "90, 6") + "," + edge("waist", "90, 44") + "," + edge("cr_b", "60, 50") + "," +
      edge("in_b", "0, 50") + "," + edge("hem", "0, 0") + R"(]},
    {"name": "legging_l", "grain": [1, 0], "outline": [{"edge": "in_b", "path": [["M", 0, -50], ["L", 60, -50]]}, )" +
      edge("cr_b", "90, -44") + "," + edge("waist", "90, -6") + "," + edge("cr_f", "60, 0") + "," +
      edge("in_f", "0, 0") + "," + edge("hem", "0, -50") + R"(]},
    {"name": "leggings_band", "grain": [1, 0], "outline": [{"edge": "end_a", "path": [["M", 0, 0], ["L", 5, 0]]}, )" +
      edge("low", "5, 76") + "," + edge("end_b", "0, 76") + "," + edge("free", "0, 0") +
      R"(]}], "seams": [
    {"name": "in_r", "a": [{"panel": "legging_r", "edge": "in_f"}], "b": [{"panel": "legging_r", "edge": "in_b"}]},
    {"name": "in_l", "a": [{"panel": "legging_l", "edge": "in_f"}], "b": [{"panel": "legging_l", "edge": "in_b"}]},
    {"name": "cr_f", "a": [{"panel": "legging_r", "edge": "cr_f"}], "b": [{"panel": "legging_l", "edge": "cr_f"}]},
    {"name": "cr_b", "a": [{"panel": "legging_r", "edge": "cr_b"}], "b": [{"panel": "legging_l", "edge": "cr_b"}]},
    {"name": "ends", "a": [{"panel": "leggings_band", "edge": "end_a"}], "b": [{"panel": "leggings_band", "edge": "end_b"}]},
    {"name": "waist", "a": [{"panel": "leggings_band", "edge": "low"}],
     "b": [{"panel": "legging_r", "edge": "waist", "from": 1, "to": 0}, {"panel": "legging_l", "edge": "waist", "from": 1, "to": 0}]}]})");
  PanelMesh mesh = mesh_pattern(pattern, 0.02, "t");
  place_panels(pattern, stick_body(45), mesh);
  const double band = middle(mesh, 2).y();
  for (const MeshSeam& seam : mesh.seams) {
    if (seam.name != "waist")
      continue;
    for (std::size_t k = 0; k < seam.a.size(); ++k) {
      const Vec3 &a = mesh.placed[seam.a[k]], &b = mesh.placed[seam.b[k]];
      EXPECT_LT(a.y(), band + 1e-9) << "the seam is below";
      if (std::min(std::abs(a.x()), std::abs(b.x())) > 0.05) {
        EXPECT_GT(a.x() * b.x(), 0) << "left is sewn to left";
      }
    }
  }
}

TEST(PlacementUnnamed, NamesAreReadAsPatternMakersWriteThem) {
  for (const char* name :
       {"SHORT SLEEVE", "SLEEVE SHORT", "SHORTSLEEVE", "FULLSLEEVE", "GMH1006FSL"}) {
    EXPECT_TRUE(says_sleeve(words_of(name))) << name;
    EXPECT_FALSE(says_legs(words_of(name))) << name;
  }
  EXPECT_FALSE(says_sleeve(words_of("sleeveless_front")));
  EXPECT_TRUE(says_legs(words_of("shorts_l")));
  EXPECT_FALSE(says_skirt(words_of("sl_left_cuff_skirt_b"))) << "the skirt of a cuff";
  EXPECT_TRUE(says_back(words_of("REGULAR TEEBK")));
  EXPECT_TRUE(name_suggests_front(words_of("REGULAR TEEFR")));
}

TEST(PlacementUnnamed, TheKindOfPieceTellsWhereACodeDoesNot) {
  Pattern pattern;
  pattern.source_format = "dxf";
  pattern.panels.resize(3);
  pattern.panels[0].name = "GMX1006S18X";
  pattern.panels[0].label = "SLEEVE SHORT";
  pattern.panels[1].name = "GLX0924S16_NEW_BK";
  pattern.panels[1].label = "FRONT"; // copied from the front, as it happens
  pattern.panels[2].name = "Y12";
  pattern.panels[2].label = "BACK";
  EXPECT_TRUE(says_sleeve(words_of(pattern, 0)));
  EXPECT_TRUE(says_back(words_of(pattern, 1)));
  EXPECT_FALSE(name_suggests_front(words_of(pattern, 1)));
  EXPECT_TRUE(says_back(words_of(pattern, 2)));
}

/// A shirt whose halves have straight middles and hollow necks, as trousers have crotches.
TEST(PlacementUnnamed, WhatHasMoreRimsThanTrousersHasNoLegs) {
  DrawnPattern shirt, trousers;
  shirt.quarters({{"hem", 26, 0},
                  {"side", 25, 44},
                  {"armhole", 24, 66},
                  {"shoulder", 9, 72},
                  {"neck", 0, 60},
                  {"middle", 0, 0}},
                 {"side", "shoulder"}, {"middle"});
  trousers.quarters(
      {{"hem", 24, 0}, {"side", 26, 100}, {"waist", 4, 102}, {"crotch", -6, 72}, {"inseam", 0, 0}},
      {"side", "inseam"}, {"crotch"});
  for (const bool top : {true, false}) {
    const Pattern pattern = top ? shirt.pattern() : trousers.pattern();
    std::vector<ShapeRole> legs(pattern.panels.size());
    for (ShapeRole& role : legs)
      role.part = LEG_PART;
    const PanelMesh mesh = mesh_pattern(pattern, 0.03, "t");
    EXPECT_EQ(more_rims_than_trousers(pattern, mesh, legs), top);
    legs[0].part = TORSO_PART;
    EXPECT_FALSE(more_rims_than_trousers(pattern, mesh, legs)) << "overalls have all of them";
    for (const ShapeRole& role : shape_roles(pattern, role_model(), false))
      EXPECT_NE(role.part, LEG_PART);
  }
}

} // namespace
} // namespace sloper::pattern::test

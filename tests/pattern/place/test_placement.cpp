#include <support/placement_patterns.hpp>

#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>
#include <pattern/layout/sleeve_bend.hpp>
#include <pattern/panel_words.hpp>
#include <sloper/pattern/place/place_panels.hpp>

namespace sloper::pattern::test {
namespace {

/// A shirt of rectangles, without a word about placement: bodies with shoulder seams, one-piece
/// sleeves.
Pattern box_shirt(double sleeve_length = 30, double width = 52) {
  const std::string sleeve_seam =
      R"(, "b": [{"panel": "SLEEVE", "edge": "top", "from": 0.5, "to": 0}]})";
  std::string text =
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "box shirt", "panels": [)" +
      rectangle("front", width, 62) + "," + rectangle("back", width, 62) + "," +
      rectangle("sleeve_l", 44, sleeve_length) + "," + rectangle("sleeve_r", 44, sleeve_length) +
      R"(], "seams": [
    {"name": "side_l", "a": [{"panel": "front", "edge": "l", "from": 0, "to": 0.645}], "b": [{"panel": "back", "edge": "r", "from": 1, "to": 0.355}]},
    {"name": "side_r", "a": [{"panel": "back", "edge": "l", "from": 0, "to": 0.645}], "b": [{"panel": "front", "edge": "r", "from": 1, "to": 0.355}]},
    {"name": "shoulder_l", "a": [{"panel": "front", "edge": "top", "from": 0, "to": 0.3}], "b": [{"panel": "back", "edge": "top", "from": 1, "to": 0.7}]},
    {"name": "shoulder_r", "a": [{"panel": "back", "edge": "top", "from": 0, "to": 0.3}], "b": [{"panel": "front", "edge": "top", "from": 1, "to": 0.7}]},
    {"name": "armhole_fl", "a": [{"panel": "front", "edge": "l", "from": 0.645, "to": 1}], "b": [{"panel": "sleeve_l", "edge": "top", "from": 1, "to": 0.5}]},
    {"name": "armhole_bl", "a": [{"panel": "back", "edge": "r", "from": 0, "to": 0.355}], "b": [{"panel": "sleeve_l", "edge": "top", "from": 0.5, "to": 0}]},
    {"name": "armhole_br", "a": [{"panel": "back", "edge": "l", "from": 0.645, "to": 1}], "b": [{"panel": "sleeve_r", "edge": "top", "from": 1, "to": 0.5}]},
    {"name": "armhole_fr", "a": [{"panel": "front", "edge": "r", "from": 0, "to": 0.355}], "b": [{"panel": "sleeve_r", "edge": "top", "from": 0.5, "to": 0}]},
    {"name": "under_l", "a": [{"panel": "sleeve_l", "edge": "l"}], "b": [{"panel": "sleeve_l", "edge": "r"}]},
    {"name": "under_r", "a": [{"panel": "sleeve_r", "edge": "l"}], "b": [{"panel": "sleeve_r", "edge": "r"}]}]})";
  return own(text);
}

TEST(Placement, AShirtWithoutHintsStandsFreeAroundBodiesOfAnyStanceAndSize) {
  const Pattern pattern = box_shirt();
  EXPECT_EQ(sew(mesh_pattern(pattern, 0.02, "t")).wrong_direction, 0);
  for (double arm : {12.0, 25.0, 45.0, 90.0})
    for (double size : {0.9, 1.1}) {
      SCOPED_TRACE(std::to_string(arm) + " degrees, size " + std::to_string(size));
      PanelMesh mesh = mesh_pattern(pattern, 0.02, "t");
      const body::Body body = stick_body(arm, size);
      const PlacementReport report = place_panels(pattern, body, mesh);
      EXPECT_EQ(report.crossings, 0);
      EXPECT_EQ(report.vertices_inside, 0);
      EXPECT_EQ(report.faces_through, 0);
      EXPECT_GT(middle(mesh, 0).z(), 0.05);
      EXPECT_LT(middle(mesh, 1).z(), -0.05);
      const double s = std::sin(arm * M_PI / 180);
      for (int side = 0; side < 2; ++side) { // sleeves lie around the arm's axis
        const Vec3 shoulder = body.landmark(side ? "shoulder_joint_r" : "shoulder_joint_l"),
                   along((side ? -1 : 1) * s, -std::cos(arm * M_PI / 180), 0);
        const Vec3 d = middle(mesh, 2 + side) - shoulder;
        EXPECT_LT((d - d.dot(along) * along).norm(), 0.05);
        EXPECT_GT(d.dot(along), 0.05);
      }
      EXPECT_EQ(mesh.panels[2].part, "arm_l");
      EXPECT_EQ(mesh.panels[3].part, "arm_r");
    }
}

TEST(Placement,
     AWideTrunkStartsInFoldsBetweenHangingArms) { // its sides would close around the arms
  for (double arm : {10.0, 15.0}) {
    SCOPED_TRACE(std::to_string(arm) + " degrees");
    const Pattern pattern = box_shirt(30, 70);
    PanelMesh mesh = mesh_pattern(pattern, 0.02, "t");
    const body::Body body = stick_body(arm);
    const PlacementReport report = place_panels(pattern, body, mesh);
    EXPECT_EQ(report.crossings, 0);
    EXPECT_EQ(report.vertices_inside, 0);
    EXPECT_EQ(report.faces_through, 0);
    const double a = arm * M_PI / 180;
    for (int v = 0; v < mesh.panels[1].first_vertex + mesh.panels[1].n_vertices; ++v) {
      const Vec3& p = mesh.placed[v];
      if (p.y() > 1.22)
        continue; // the arm pits are at 1.29 m
      EXPECT_LT(std::abs(p.x()), 0.19 + (1.36 - p.y()) * std::tan(a) - 0.03)
          << "beyond the inner side of the arm at " << p.y();
    }
    double across = 0, cloth = 0; // a level row keeps its length
    for (int f = mesh.panels[0].first_triangle;
         f < mesh.panels[0].first_triangle + mesh.panels[0].n_triangles; ++f) {
      const Triangle& t = mesh.triangles[f];
      const auto at = [&](std::size_t k) { return static_cast<std::size_t>(t[k]); };
      if (mesh.placed[at(0)].y() > 1.2)
        continue;
      across += (mesh.placed[at(1)] - mesh.placed[at(0)])
                    .cross(mesh.placed[at(2)] - mesh.placed[at(0)])
                    .norm();
      const Vec2 p = mesh.pattern[at(1)] - mesh.pattern[at(0)],
                 q = mesh.pattern[at(2)] - mesh.pattern[at(0)];
      cloth += std::abs(p.x() * q.y() - p.y() * q.x());
    }
    EXPECT_NEAR(across / cloth, 1, 0.06);
  }
}

TEST(Placement, LongSleevesEndAtTheWristAndTheirEdgesMeetBeyondTheArm) {
  for (double arm : {25.0, 60.0}) {
    SCOPED_TRACE(arm);
    PanelMesh mesh = mesh_pattern(box_shirt(90), 0.02, "t");
    const body::Body body = stick_body(arm, 1.0);
    const PlacementReport report = place_panels(box_shirt(90), body, mesh);
    EXPECT_EQ(report.crossings + report.vertices_inside + report.faces_through, 0);
    const Vec3 shoulder = body.landmark("shoulder_joint_l"), wrist = body.landmark("wrist_l");
    const Vec3 along = (wrist - shoulder).normalized();
    const PanelInfo& sleeve = mesh.panels[2];
    double farthest = 0;
    for (int v = sleeve.first_vertex; v < sleeve.first_vertex + sleeve.n_vertices; ++v)
      farthest = std::max(farthest, (mesh.placed[v] - shoulder).dot(along));
    EXPECT_NEAR(farthest, (wrist - shoulder).norm() + 0.03, 0.005);
    for (const MeshSeam& seam : mesh.seams) {
      if (seam.name != "under_l")
        continue;
      for (std::size_t k = 0; k < seam.a.size();
           ++k) { // the line between both edges passes below the arm's axis
        const Vec3 &a = mesh.placed[seam.a[k]], &b = mesh.placed[seam.b[k]];
        const Vec3 axis = shoulder + (a - shoulder).dot(along) * along;
        const Vec3 outwards =
            Vec3(1, 1, 0) - Vec3(1, 1, 0).dot(along) * along; // where the middle of the sleeve is
        EXPECT_GT((axis - 0.5 * (a + b)).dot(outwards), 0);
      }
    }
  }
}

/// Front and back with sleeves cut in one with them, drawn nearly level; `under` is how far the
/// sleeves reach down, cm.
Pattern kimono(double under = 38) {
  const auto panel = [&](const std::string& name, const std::string& l, const std::string& r,
                         double neck) {
    const std::string u = std::to_string(under), v = std::to_string(under + 4),
                      w = std::to_string(under - 5);
    return R"({"name": ")" + name +
           R"(", "outline": [{"edge": "hem", "path": [["M", -27, 0], ["L", 27, 0]]}, {"edge": "side_)" +
           l + R"(", "path": [["L", 27, )" + w + R"(]]}, {"edge": "under_)" + l +
           R"(", "path": [["Q", 27, )" + u + ", 32, " + u + R"(], ["L", 62, )" + v +
           R"(]]}, {"edge": "cuff_)" + l + R"(", "path": [["L", 59, 62]]}, {"edge": "top_)" + l +
           R"(", "path": [["L", 10, 66]]}, {"edge": "neck", "path": [["C", 8, )" +
           std::to_string(neck) + ", -8, " + std::to_string(neck) +
           R"(, -10, 66]]}, {"edge": "top_)" + r +
           R"(", "path": [["L", -59, 62]]}, {"edge": "cuff_)" + r + R"(", "path": [["L", -62, )" +
           v + R"(]]}, {"edge": "under_)" + r + R"(", "path": [["L", -32, )" + u +
           R"(], ["Q", -27, )" + u + ", -27, " + w + R"(]]}, {"edge": "side_)" + r +
           R"(", "path": [["L", -27, 0]]}]})";
  };
  std::string seams;
  for (const char* name : {"side_l", "under_l", "top_l", "side_r", "under_r", "top_r"})
    seams += std::string(seams.empty() ? "" : ", ") + R"({"name": ")" + name +
             R"(", "a": [{"panel": "front", "edge": ")" + name +
             R"("}], "b": [{"panel": "back", "edge": ")" + name + R"("}]})";
  return own(
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "kimono", "panels": [)" +
      panel("front", "l", "r", 56) + ", " + panel("back", "r", "l", 64) + R"(], "seams": [)" +
      seams + "]}");
}

TEST(Placement, SleevesCutInOneWithTheTrunkLieAlongTheArmsHoweverTheyHang) {
  for (double under : {38.0, 25.0}) // a kimono's, a batwing's
    for (double arm : {20.0, 45.0, 70.0, 90.0}) {
      SCOPED_TRACE(std::to_string(arm) + " degrees, sleeves down to " + std::to_string(under) +
                   " cm");
      const Pattern pattern = kimono(under);
      PanelMesh mesh = mesh_pattern(pattern, 0.02, "t");
      EXPECT_EQ(sew(mesh).wrong_direction, 0);
      const body::Body body = stick_body(arm);
      const PlacementReport report = place_panels(pattern, body, mesh);
      EXPECT_EQ(report.crossings, 0);
      EXPECT_EQ(report.vertices_inside, 0);
      EXPECT_EQ(report.faces_through, 0);
      for (int p = 0; p < 2; ++p) {
        const PanelInfo& info = mesh.panels[p];
        double least = 1e300; // no part of a panel lies on another: seen from outside, all
                              // triangles keep their sense
        for (int f = info.first_triangle; f < info.first_triangle + info.n_triangles; ++f) {
          const Triangle& t = mesh.triangles[f];
          const auto at = [&](std::size_t k) { return mesh.placed[t[k]]; };
          least = std::min(least, (p == 0 ? 1 : -1) * (at(1) - at(0)).cross(at(2) - at(0)).z());
        }
        EXPECT_GT(least, -1e-12) << info.name;
        for (const double side : {1.0, -1.0}) { // the end of each sleeve is about the arm
          const Vec3 shoulder(side * 0.19, 1.36, 0),
              along(side * std::sin(arm * M_PI / 180), -std::cos(arm * M_PI / 180), 0);
          Vec3 end = Vec3::Zero();
          int n = 0;
          for (int v = info.first_vertex; v < info.first_vertex + info.n_vertices; ++v)
            if (const double u = (p == 0 ? 1 : -1) * mesh.pattern[v].x(); side * u > 0.585) {
              end += mesh.placed[v];
              ++n;
            }
          end /= n;
          const Vec3 off = end - shoulder - (end - shoulder).dot(along) * along;
          EXPECT_LT(std::hypot(off.x(), off.y()), 0.06)
              << info.name << (side > 0 ? " left" : " right");
          EXPECT_GT((end - shoulder).dot(along), 0.2);
        }
      }
    }
}

TEST(Placement, AWideTrunkWithoutSleevesIsNotBent) { // a poncho's width is that of its trunk
  const std::vector<std::vector<Vec2>>
      poncho = {{{-0.6, 0.7}, {0.6, 0.7}, {0.6, 1.4}, {-0.6, 1.4}}},
      bodice = {{{-0.26, 0.9}, {0.26, 0.9}, {0.24, 1.4}, {-0.24, 1.4}}},
      skirt = {{{-0.9, 0.5}, {0.9, 0.5}, {0.18, 1.05}, {-0.18, 1.05}}};
  EXPECT_FALSE(SleeveBend::find(skirt, 1, Vec2(0.2, 1.36), -1));
  EXPECT_FALSE(SleeveBend::find(poncho, 1, Vec2(0.2, 1.36), -1));
  EXPECT_FALSE(SleeveBend::find(bodice, 1, Vec2(0.2, 1.36), -1));
}

TEST(Placement, WrappingKeepsLengths) {
  const Pattern pattern = box_shirt();
  PanelMesh mesh = mesh_pattern(pattern, 0.015, "t");
  place_panels(pattern, stick_body(45), mesh);
  double worst = 0;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t a = static_cast<std::size_t>(t[k]),
                        b = static_cast<std::size_t>(t[(k + 1) % 3]);
      worst = std::max(worst, std::abs((mesh.placed[a] - mesh.placed[b]).norm() /
                                           (mesh.pattern[a] - mesh.pattern[b]).norm() -
                                       1));
    }
  EXPECT_LT(worst, 0.03) << "only chords across the bend are shorter";
}

TEST(Placement, OutsidesLookAwayFromTheBody) {
  const Pattern pattern = box_shirt();
  PanelMesh mesh = mesh_pattern(pattern, 0.02, "t");
  place_panels(pattern, stick_body(45), mesh);
  for (int p = 0; p < 2; ++p) {
    const PanelInfo& info = mesh.panels[p];
    Vec3 normal = Vec3::Zero();
    for (int t = info.first_triangle; t < info.first_triangle + info.n_triangles; ++t) {
      const Triangle& tri = mesh.triangles[t];
      normal += area_normal(mesh.placed[tri[0]], mesh.placed[tri[1]], mesh.placed[tri[2]]);
    }
    EXPECT_GT(normal.z() * (p ? -1 : 1), 0) << info.name;
  }
}

TEST(Placement, ChineseJapaneseAndKoreanNamesTellWhereAPieceGoes) {
  EXPECT_EQ(words_of("\u5de6\u524d\u88e4\u7247"), (Words{"left", "front", "trousers"}));
  EXPECT_EQ(words_of("\u53f3\u5f8c\u8eab\u9803"), (Words{"right", "back"}));
  EXPECT_EQ(words_of("\uc18c\ub9e4 1"), (Words{"sleeve"}));
  EXPECT_EQ(words_of("\u886c\u886b"), Words{});
}

TEST(Placement, WhereNoNameTellsWhereAPieceGoesThatIsFound) {
  Pattern pattern = box_skirt(42);
  pattern.panels[0].name = "P1";
  pattern.panels[1].name = "P2";
  PanelMesh mesh = mesh_pattern(pattern, 0.02, "t");
  EXPECT_TRUE(place_panels(pattern, waisted_body(), mesh).is_guess);
  ASSERT_FALSE(mesh.findings.empty());
  EXPECT_EQ(mesh.findings.back().text.rfind("start: placed by their shapes: P1 (lower_body", 0), 0u)
      << mesh.findings.back().text;
  pattern.panels[1].name = "rear";
  mesh = mesh_pattern(pattern, 0.02, "t");
  EXPECT_FALSE(place_panels(pattern, waisted_body(), mesh).is_guess);
  EXPECT_EQ(mesh.findings.back().text.rfind("start: placed by their shapes: P1 (lower_body", 0), 0u)
      << mesh.findings.back().text;
}

/// A shirt as GarmentCode has it, four halves of the trunk and what a test adds, with all hints but
/// names of numbers.
Pattern numbered(const std::string& more_panels, const std::string& more_stitches) {
  const auto panel = [](const std::string& name, const std::string& points, double y, double z) {
    std::string edges;
    const long n = std::count(points.begin(), points.end(), '[') - 1;
    for (long k = 0; k < n; ++k)
      edges += std::string(k ? "," : "") + R"({"endpoints": [)" + std::to_string(k) + "," +
               std::to_string((k + 1) % n) + "]}";
    return "\"" + name + R"(": {"vertices": )" + points + R"(, "edges": [)" + edges +
           R"(], "translation": [0, )" + std::to_string(y) + "," + std::to_string(z) +
           R"(], "rotation": [0, 0, 0], "label": "body"})";
  };
  const auto stitch = [](const char* a, int i, const char* b, int j) {
    return std::string(R"([{"panel": ")") + a + R"(", "edge": )" + std::to_string(i) +
           R"(}, {"panel": ")" + b + R"(", "edge": )" + std::to_string(j) + "}]";
  };
  const std::string text =
      R"({"pattern": {"panels": {)" +
      panel("p0", "[[0, 0], [23, 0], [23, 23], [18, 44], [9, 46], [0, 34]]", 92, 30) + "," +
      panel("p1", "[[0, 0], [0, 43], [9, 46], [18, 44], [23, 23], [23, 0]]", 92, -25) + "," +
      panel("p2", "[[0, 0], [0, 34], [-9, 46], [-18, 44], [-23, 23], [-23, 0]]", 92, 30) + "," +
      panel("p3", "[[0, 0], [-23, 0], [-23, 23], [-18, 44], [-9, 46], [0, 43]]", 92, -25) +
      more_panels + R"(}, "stitches": [)" + stitch("p0", 3, "p1", 2) + "," +
      stitch("p0", 1, "p1", 4) + "," + stitch("p2", 2, "p3", 3) + "," + stitch("p2", 4, "p3", 1) +
      "," + stitch("p0", 5, "p2", 0) + "," + stitch("p1", 0, "p3", 5) + more_stitches +
      R"(]}, "properties": {"curvature_coords": "relative", "units_in_meter": 100}})";
  Pattern pattern = read_garmentcode(io::parse_json(text, "t"), "t");
  finish_pattern(pattern, "t");
  return pattern;
}

TEST(Placement, AHoodWithoutAWordForItGoesAroundTheHead) {
  const std::string hood =
      R"(, "p4": {"vertices": [[0.8, 0], [-12, 36], [-23, 36], [-21, -11], [-10, 5]], "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]},
      {"endpoints": [2, 3]}, {"endpoints": [3, 4]}, {"endpoints": [4, 0]}], "translation": [11, 149, -12], "rotation": [0, 90, 0], "label": "body"},
    "p5": {"vertices": [[-0.8, 0], [10, 5], [21, -11], [23, 36], [12, 36]], "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]},
      {"endpoints": [3, 4]}, {"endpoints": [4, 0]}], "translation": [-11, 149, -12], "rotation": [0, -90, 0], "label": "body"})";
  const std::string stitches =
      R"(, [{"panel": "p0", "edge": 4}, {"panel": "p4", "edge": 3}], [{"panel": "p1", "edge": 1}, {"panel": "p4", "edge": 4}],
    [{"panel": "p2", "edge": 1}, {"panel": "p5", "edge": 1}], [{"panel": "p3", "edge": 4}, {"panel": "p5", "edge": 0}],
    [{"panel": "p5", "edge": 3}, {"panel": "p4", "edge": 1}], [{"panel": "p5", "edge": 4}, {"panel": "p4", "edge": 0}])";
  const Pattern pattern = numbered(hood, stitches);
  PanelMesh mesh = mesh_pattern(pattern, 0.02, "t");
  const PlacementReport report = place_panels(pattern, stick_body(45), mesh);
  EXPECT_EQ(report.crossings + report.vertices_inside + report.faces_through, 0);
  EXPECT_EQ(mesh.panels[4].part, "neck");
  EXPECT_EQ(mesh.panels[5].part, "neck");
  EXPECT_GT(middle(mesh, 4).x(), 0.03) << "the left half on the left";
  EXPECT_LT(middle(mesh, 5).x(), -0.03);
  EXPECT_EQ(mesh.panels[0].part, "torso");
}

TEST(Placement, AShirtWithACollarStartsTheSameHoweverItsPiecesLie) {
  const auto shirt = [](const std::vector<int>& quarters) {
    const auto piece = [&](std::size_t k, const std::string& name, double w, double h) {
      const Eigen::Rotation2Dd turn(quarters[k] * M_PI / 2);
      const auto point = [&](double x, double y) {
        const Vec2 p = turn * Vec2(x, y);
        return std::to_string(p.x()) + ", " + std::to_string(p.y());
      };
      const Vec2 grain = turn * Vec2(0, 1);
      return R"({"name": ")" + name + R"(", "grain": [)" + std::to_string(grain.x()) + ", " +
             std::to_string(grain.y()) + R"(], "outline": [{"edge": "hem", "path": [["M", )" +
             point(0, 0) + R"(], ["L", )" + point(w, 0) + R"(]]}, {"edge": "l", "path": [["L", )" +
             point(w, h) + R"(]]}, {"edge": "top", "path": [["L", )" + point(0, h) +
             R"(]]}, {"edge": "r", "path": [["L", )" + point(0, 0) + "]]}]}";
    };
    return own(
        R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "shirt", "panels": [)" +
        piece(0, "front", 52, 62) + "," + piece(1, "back", 52, 62) + "," +
        piece(2, "collar", 41.6, 5) + R"(], "seams": [
    {"name": "side_l", "a": [{"panel": "front", "edge": "l", "from": 0, "to": 0.645}], "b": [{"panel": "back", "edge": "r", "from": 1, "to": 0.355}]},
    {"name": "side_r", "a": [{"panel": "back", "edge": "l", "from": 0, "to": 0.645}], "b": [{"panel": "front", "edge": "r", "from": 1, "to": 0.355}]},
    {"name": "shoulder_l", "a": [{"panel": "front", "edge": "top", "from": 0, "to": 0.3}], "b": [{"panel": "back", "edge": "top", "from": 1, "to": 0.7}]},
    {"name": "shoulder_r", "a": [{"panel": "back", "edge": "top", "from": 0, "to": 0.3}], "b": [{"panel": "front", "edge": "top", "from": 1, "to": 0.7}]},
    {"name": "neck", "a": [{"panel": "back", "edge": "top", "from": 0.3, "to": 0.7}, {"panel": "front", "edge": "top", "from": 0.3, "to": 0.7}],
     "b": [{"panel": "collar", "edge": "hem", "from": 1, "to": 0}]}]})");
  };
  const auto start = [](const Pattern& pattern) {
    PanelMesh mesh = mesh_pattern(pattern, 0.02, "t");
    const PlacementReport report = place_panels(pattern, stick_body(45), mesh);
    EXPECT_EQ(report.crossings + report.vertices_inside + report.faces_through, 0);
    return report.seam_gap_mean;
  };
  const double upright = start(shirt({0, 0, 0}));
  for (const std::vector<int>& quarters :
       {std::vector<int>{1, 1, 1}, {-1, -1, -1}, {0, 1, -1}, {0, 2, 1}})
    EXPECT_NEAR(start(shirt(quarters)), upright, 0.01);
}

TEST(Placement, PiecesOfACollarStandWhereTheyAreSewnOn) {
  Pattern pattern = box_shirt();
  const auto piece = [&](const std::string& name, double w, double h) {
    return own(R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "piece", "panels": [)" +
               rectangle(name, w, h) + R"(], "seams": []})")
        .panels[0];
  };
  const int front = pattern.find_panel("front"), back = pattern.find_panel("back"),
            first = static_cast<int>(pattern.panels.size());
  pattern.panels.push_back(piece("collar 1", 20.8, 20));
  pattern.panels.push_back(piece("collar 2", 20.8, 20));
  const auto sew = [&](const std::string& name, pattern::Run a, pattern::Run b) {
    pattern.seams.push_back({name, "seam", {a}, {b}, "", false});
  };
  enum { HEM, LEFT, TOP, RIGHT }; // edges of a rectangle
  sew("neck front", {front, TOP, 0.3, 0.7}, {first, HEM, 1, 0});
  sew("neck back", {back, TOP, 0.3, 0.7}, {first + 1, HEM, 1, 0});
  sew("collar left", {first, LEFT, 0, 1}, {first + 1, RIGHT, 1, 0});
  sew("collar right", {first, RIGHT, 0, 1}, {first + 1, LEFT, 1, 0});
  PanelMesh mesh = mesh_pattern(pattern, 0.02, "t");
  const PlacementReport report = place_panels(pattern, stick_body(45), mesh);
  EXPECT_EQ(report.crossings + report.vertices_inside + report.faces_through, 0);
  EXPECT_GT(middle(mesh, first).z(), 0.03);
  EXPECT_LT(middle(mesh, first + 1).z(), -0.03);
  EXPECT_NEAR(middle(mesh, first).y(), middle(mesh, first + 1).y(), 0.01);
}

TEST(Placement,
     AYokeOverTheShouldersCarriesFrontsThatEndFarBelowItsTop) { // where they are drawn as they
                                                                // stand, not as they hang
  Pattern pattern = own(
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "vest", "panels": [)" +
      rectangle("front", 52, 38) + "," + rectangle("back", 52, 36) + "," +
      rectangle("yoke", 52, 18) + R"(], "seams": [
    {"name": "side_l", "a": [{"panel": "front", "edge": "l", "from": 0, "to": 0.5}], "b": [{"panel": "back", "edge": "r", "from": 1, "to": 0.5}]},
    {"name": "side_r", "a": [{"panel": "back", "edge": "l", "from": 0, "to": 0.5}], "b": [{"panel": "front", "edge": "r", "from": 1, "to": 0.5}]},
    {"name": "yoke", "a": [{"panel": "back", "edge": "top"}], "b": [{"panel": "yoke", "edge": "hem"}]},
    {"name": "shoulder_l", "a": [{"panel": "front", "edge": "top", "from": 0, "to": 0.3}], "b": [{"panel": "yoke", "edge": "top", "from": 1, "to": 0.7}]},
    {"name": "shoulder_r", "a": [{"panel": "yoke", "edge": "top", "from": 0, "to": 0.3}], "b": [{"panel": "front", "edge": "top", "from": 1, "to": 0.7}]}]})");
  for (Panel& panel : pattern.panels) {
    panel.hint.rigid = Mat4::Identity();
    const bool front = panel.name == "front";
    if (!front)
      panel.hint.rigid->topLeftCorner<3, 3>() = Vec3(-1, 1, -1).asDiagonal();
    panel.hint.rigid->topRightCorner<3, 1>() =
        Vec3(front ? -0.26 : 0.26, panel.name == "yoke" ? 1.26 : 0.9, front ? 0.3 : -0.3);
  }
  const body::Body body = stick_body(45);
  PanelMesh mesh = mesh_pattern(pattern, 0.02, "t");
  place_panels(pattern, body, mesh);
  EXPECT_GT(top_of(mesh), body.landmark("neck_side_l").y() - 0.05);
}

TEST(Placement, AStraplessTopIsPutOnTheChest) {
  std::string text = tube_text();
  text.replace(text.find("\"front\""), 7, "\"bodice_front\"");
  for (std::size_t at; (at = text.find("\"panel\": \"front\"")) != std::string::npos;)
    text.replace(at, 16, "\"panel\": \"bodice_front\"");
  const Pattern pattern = own(text);
  PanelMesh mesh = mesh_pattern(pattern, 0.02, "t");
  const PlacementReport report = place_panels(pattern, stick_body(45), mesh);
  double top = 0;
  for (const Vec3& p : mesh.placed)
    top = std::max(top, p.y());
  EXPECT_NEAR(top, 0.76 * 1.7, 0.01);
  EXPECT_EQ(report.crossings + report.vertices_inside + report.faces_through, 0);
}

TEST(Placement, WithoutABodyPanelsLieFlatAndSaySo) {
  const Pattern pattern = box_shirt();
  PanelMesh mesh = mesh_pattern(pattern, 0.03, "t");
  lay_flat(pattern, mesh);
  EXPECT_EQ(mesh.placement, Placement::FLAT);
  for (const Vec3& p : mesh.placed)
    EXPECT_EQ(p.z(), 0);
  EXPECT_NE(mesh.findings.back().text.find("lie flat"), std::string::npos);
}

TEST(Placement, SharedPatternsStandFreeAroundAFigure) {
  const char* shared = std::getenv("SLOPER_SHARED");
  if (!shared)
    GTEST_SKIP() << "SLOPER_SHARED is not set";
  const body::Body body = stick_body(48, 1.0);
  int n = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(
           std::filesystem::path(shared) / "data/patterns")) {
    const std::string name = entry.path().string();
    if (name.find("_specification.json") == std::string::npos &&
        name.find(".dxf") == std::string::npos)
      continue;
    SCOPED_TRACE(name);
    const Pattern pattern = read_pattern(name, "");
    PanelMesh mesh = mesh_pattern(pattern, 0.02, name);
    const PlacementReport report = place_panels(pattern, body, mesh);
    EXPECT_EQ(report.crossings, 0);
    EXPECT_EQ(report.vertices_inside + report.faces_through, 0);
    ++n;
  }
  EXPECT_GE(n, 12);
}

} // namespace
} // namespace sloper::pattern::test

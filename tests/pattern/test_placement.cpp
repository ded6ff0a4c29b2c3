#include "pattern_texts.hpp"
#include "stick_body.hpp"

#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>
#include <pattern/place_panels.hpp>

namespace sloper::pattern::test {
namespace {

std::string rectangle(const std::string& name, double w, double h) {
  return R"({"name": ")" + name + R"(", "outline": [{"edge": "hem", "path": [["M", 0, 0], ["L", )" + std::to_string(w) +
         R"(, 0]]}, {"edge": "l", "path": [["L", )" + std::to_string(w) + ", " + std::to_string(h) + R"(]]}, {"edge": "top", "path": [["L", 0, )" +
         std::to_string(h) + R"(]]}, {"edge": "r", "path": [["L", 0, 0]]}]})";
}

/// A shirt of rectangles, without a word about placement: bodies with shoulder seams, one-piece sleeves.
Pattern box_shirt() {
  const std::string sleeve_seam = R"(, "b": [{"panel": "SLEEVE", "edge": "top", "from": 0.5, "to": 0}]})";
  std::string text = R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "box shirt", "panels": [)" + rectangle("front", 52, 62) + "," +
                     rectangle("back", 52, 62) + "," + rectangle("sleeve_l", 44, 30) + "," + rectangle("sleeve_r", 44, 30) + R"(], "seams": [
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

Vec3 middle(const PanelMesh& mesh, int panel) {
  Vec3 sum = Vec3::Zero();
  const PanelInfo& p = mesh.panels[static_cast<std::size_t>(panel)];
  for (int v = p.first_vertex; v < p.first_vertex + p.n_vertices; ++v) sum += mesh.placed[static_cast<std::size_t>(v)];
  return sum / p.n_vertices;
}

TEST(Placement, AShirtWithoutHintsStandsFreeAroundBodiesOfAnyStanceAndSize) {
  const Pattern pattern = box_shirt();
  EXPECT_EQ(sew(mesh_pattern(pattern, 0.02, "t")).wrong_direction, 0);
  for (double arm : {12.0, 25.0, 45.0, 70.0, 90.0})
    for (double size : {0.9, 1.0, 1.1}) {
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
        const Vec3 shoulder = body.landmark(side ? "shoulder_joint_r" : "shoulder_joint_l"), along((side ? -1 : 1) * s, -std::cos(arm * M_PI / 180), 0);
        const Vec3 d = middle(mesh, 2 + side) - shoulder;
        EXPECT_LT((d - d.dot(along) * along).norm(), 0.05);
        EXPECT_GT(d.dot(along), 0.05);
      }
      EXPECT_EQ(mesh.panels[2].part, "arm_l");
      EXPECT_EQ(mesh.panels[3].part, "arm_r");
    }
}

TEST(Placement, WrappingKeepsLengths) {
  const Pattern pattern = box_shirt();
  PanelMesh mesh = mesh_pattern(pattern, 0.01, "t");
  place_panels(pattern, stick_body(45), mesh);
  double worst = 0;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t a = static_cast<std::size_t>(t[k]), b = static_cast<std::size_t>(t[(k + 1) % 3]);
      worst = std::max(worst, std::abs((mesh.placed[a] - mesh.placed[b]).norm() / (mesh.pattern[a] - mesh.pattern[b]).norm() - 1));
    }
  EXPECT_LT(worst, 0.03) << "only chords across the bend are shorter";
}

TEST(Placement, OutsidesLookAwayFromTheBody) {
  const Pattern pattern = box_shirt();
  PanelMesh mesh = mesh_pattern(pattern, 0.02, "t");
  place_panels(pattern, stick_body(45), mesh);
  for (int p = 0; p < 2; ++p) {
    const PanelInfo& info = mesh.panels[static_cast<std::size_t>(p)];
    Vec3 normal = Vec3::Zero();
    for (int t = info.first_triangle; t < info.first_triangle + info.n_triangles; ++t) {
      const Triangle& tri = mesh.triangles[static_cast<std::size_t>(t)];
      normal += area_normal(mesh.placed[static_cast<std::size_t>(tri[0])], mesh.placed[static_cast<std::size_t>(tri[1])],
                            mesh.placed[static_cast<std::size_t>(tri[2])]);
    }
    EXPECT_GT(normal.z() * (p ? -1 : 1), 0) << info.name;
  }
}

TEST(Placement, ASkirtHangsAtTheWaistThatItsLengthFits) {
  const std::string text = R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "skirt", "panels": [)" + rectangle("skirt_front", 46, 50) + "," +
                           rectangle("skirt_back", 46, 50) +
                           R"(], "seams": [{"name": "a", "a": [{"panel": "skirt_front", "edge": "l"}], "b": [{"panel": "skirt_back", "edge": "r"}]},
                               {"name": "b", "a": [{"panel": "skirt_back", "edge": "l"}], "b": [{"panel": "skirt_front", "edge": "r"}]}]})";
  const Pattern pattern = own(text);
  PanelMesh mesh = mesh_pattern(pattern, 0.02, "t");
  const PlacementReport report = place_panels(pattern, stick_body(45), mesh);
  double top = 0;
  for (const Vec3& p : mesh.placed) top = std::max(top, p.y());
  EXPECT_NEAR(top, 0.95, 0.03) << "92 cm fit where the body is 91.5 cm round";
  EXPECT_EQ(report.crossings + report.vertices_inside + report.faces_through, 0);
}

TEST(Placement, AStraplessTopIsPutOnTheChest) {
  std::string text = tube_text();
  text.replace(text.find("\"front\""), 7, "\"bodice_front\"");
  for (std::size_t at; (at = text.find("\"panel\": \"front\"")) != std::string::npos;) text.replace(at, 16, "\"panel\": \"bodice_front\"");
  const Pattern pattern = own(text);
  PanelMesh mesh = mesh_pattern(pattern, 0.02, "t");
  const PlacementReport report = place_panels(pattern, stick_body(45), mesh);
  double top = 0;
  for (const Vec3& p : mesh.placed) top = std::max(top, p.y());
  EXPECT_NEAR(top, 0.76 * 1.7, 0.01);
  EXPECT_EQ(report.crossings + report.vertices_inside + report.faces_through, 0);
}

TEST(Placement, WithoutABodyPanelsLieFlatAndSaySo) {
  const Pattern pattern = box_shirt();
  PanelMesh mesh = mesh_pattern(pattern, 0.03, "t");
  lay_flat(pattern, mesh);
  for (const Vec3& p : mesh.placed) EXPECT_EQ(p.z(), 0);
  EXPECT_NE(mesh.findings.back().find("lie flat"), std::string::npos);
}

TEST(Placement, SharedPatternsStandFreeAroundAFigure) {
  const char* shared = std::getenv("SLOPER_SHARED");
  if (!shared) GTEST_SKIP() << "SLOPER_SHARED is not set";
  const body::Body body = stick_body(48, 1.0);
  int n = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(std::filesystem::path(shared) / "data/patterns")) {
    const std::string name = entry.path().string();
    if (name.find("_specification.json") == std::string::npos && name.find(".dxf") == std::string::npos) continue;
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

#include <support/placement_patterns.hpp>

#include <gtest/gtest.h>
#include <sloper/pattern/place/place_panels.hpp>

namespace sloper::pattern::test {
namespace {

/// Long trousers of four pieces, with what a test adds.
Pattern box_trousers(const std::string& more_panels = "", const std::string& more_seams = "") {
  std::string text =
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "trousers", "panels": [)";
  for (const char* name : {"front_l", "front_r", "back_l", "back_r"}) {
    const std::string mirror =
        (std::string(name) == "front_r" || std::string(name) == "back_l") ? "-" : "";
    text += R"({"name": ")" + std::string(name) + R"(", "outline": [)";
    if (mirror.empty()) // seen from outside, the crotch is on the left of a left front
      text +=
          R"({"edge": "hem", "path": [["M", 0, 0], ["L", 26, 0]]}, {"edge": "out", "path": [["L", 24, 103]]}, {"edge": "waist", "path": [["L", 0, 103]]},
        {"edge": "centre", "path": [["L", -5, 74]]}, {"edge": "in", "path": [["L", 0, 0]]}]})";
    else
      text +=
          R"({"edge": "hem", "path": [["M", -26, 0], ["L", 0, 0]]}, {"edge": "in", "path": [["L", 5, 74]]}, {"edge": "centre", "path": [["L", 0, 103]]},
        {"edge": "waist", "path": [["L", -24, 103]]}, {"edge": "out", "path": [["L", -26, 0]]}]})";
    if (std::string(name) != "back_r")
      text += ",";
  }
  text += more_panels + R"(], "seams": [)";
  const char* pairs[][3] = {{"front_l", "out", "back_l"},     {"front_r", "out", "back_r"},
                            {"front_l", "in", "back_l"},      {"front_r", "in", "back_r"},
                            {"front_l", "centre", "front_r"}, {"back_l", "centre", "back_r"}};
  for (const auto& pair : pairs)
    text += std::string(&pair == &pairs[0] ? "" : ",") + R"({"name": ")" + pair[0] + pair[1] +
            R"(", "a": [{"panel": ")" + pair[0] + R"(", "edge": ")" + pair[1] +
            R"("}], "b": [{"panel": ")" + pair[2] + R"(", "edge": ")" + pair[1] + R"("}]})";
  return own(text + more_seams + "]}");
}

body::Body body_with_ankles() {
  body::Body body = waisted_body();
  for (const char* side : {"_l", "_r"}) {
    body.landmarks[std::string("ankle") + side].p = Vec3(0.09, 0.08, 0);
    body.landmarks[std::string("knee") + side].p = Vec3(0.09, 0.5, 0);
  }
  body.landmarks["crotch"].p = Vec3(0, 0.8, 0);
  return body;
}

TEST(Placement, LongTrousersStartAsSmoothTubesAboveTheFeetWithTheirWaistInPlace) {
  const Pattern pattern = box_trousers();
  PanelMesh mesh = mesh_pattern(pattern, 0.02, "t");
  const body::Body body = body_with_ankles();
  const PlacementReport report = place_panels(pattern, body, mesh);
  EXPECT_EQ(report.crossings + report.vertices_inside + report.faces_through, 0);
  double bottom = 1e300, longest = 0, longest_above = 0;
  for (const Vec3& p : mesh.placed)
    bottom = std::min(bottom, p.y());
  EXPECT_EQ(mesh.panels[0].part, "leg_l");
  EXPECT_LT(top_of(mesh), 1.09) << "103 cm below this would end in the feet";
  EXPECT_GT(bottom, 0.08) << "above the ankles";
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t a = static_cast<std::size_t>(t[k]),
                        b = static_cast<std::size_t>(t[(k + 1) % 3]);
      double& most = mesh.placed[a].y() < 0.7 ? longest : longest_above;
      most = std::max(most, (mesh.placed[a] - mesh.placed[b]).norm() /
                                    (mesh.pattern[a] - mesh.pattern[b]).norm() -
                                1);
    }
  EXPECT_LT(longest, 0.35);
  EXPECT_LT(longest_above, 0.7) << "where the crotch goes between the legs";
  // Each leg on its own side, its seams beside each other at equal heights, and straight: no waves.
  for (const PanelInfo& info : mesh.panels)
    for (int v = info.first_vertex; v < info.first_vertex + info.n_vertices; ++v)
      EXPECT_GT(mesh.placed[v].x() * (info.part == "leg_l" ? 1 : -1), 0.004) << info.name;
  for (const MeshSeam& s : mesh.seams) {
    const bool leg = s.name.find("centre") == std::string::npos;
    for (std::size_t k = 0; leg && k < s.a.size(); ++k) {
      const Vec3 &a = mesh.placed[s.a[k]], &b = mesh.placed[s.b[k]];
      EXPECT_NEAR(a.y(), b.y(), 0.02) << s.name;
      if (a.y() < 0.7 && s.name.find("in") != std::string::npos) {
        EXPECT_LT((a - b).norm(), 0.06) << s.name;
      }
    }
  }
  for (std::size_t k = 1; k + 1 < mesh.seams[0].a.size(); ++k) {
    const auto at = [&](std::size_t i) { return mesh.placed[mesh.seams[0].a[i]]; };
    if (std::max(at(k - 1).y(), at(k + 1).y()) < 0.7) {
      EXPECT_LT((at(k - 1) - 2 * at(k) + at(k + 1)).norm(), 0.008)
          << "the side seam bends at " << at(k).y();
    }
  }
}

TEST(Placement, LeggingsInOnePieceGoAroundTheirLegs) {
  // Seen from outside a left leg has the front's middle seam on the left and the back's, which is
  // longer, on the right.
  std::string text =
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "leggings", "panels": [
    {"name": "one", "outline": [{"edge": "hem", "path": [["M", -18, 0], ["L", 18, 0]]}, {"edge": "in_back", "path": [["L", 32, 70]]},
      {"edge": "seat", "path": [["L", 24, 102]]}, {"edge": "waist", "path": [["L", -24, 98]]}, {"edge": "front", "path": [["L", -30, 70]]},
      {"edge": "in_front", "path": [["L", -18, 0]]}]},
    {"name": "two", "mirror_of": "one"}, {"name": "waistband", "outline": [{"edge": "low", "path": [["M", 0, 0], ["L", 96, 0]]},
      {"edge": "a", "path": [["L", 96, 5]]}, {"edge": "up", "path": [["L", 0, 5]]}, {"edge": "b", "path": [["L", 0, 0]]}]}], "seams": [
    {"name": "ends", "a": [{"panel": "waistband", "edge": "a"}], "b": [{"panel": "waistband", "edge": "b", "from": 1, "to": 0}]},
    {"name": "waist", "a": [{"panel": "waistband", "edge": "low"}],
     "b": [{"panel": "one", "edge": "waist", "from": 1, "to": 0}, {"panel": "two", "edge": "waist", "from": 1, "to": 0}]},
    {"name": "in one", "a": [{"panel": "one", "edge": "in_back"}], "b": [{"panel": "one", "edge": "in_front"}]},
    {"name": "in two", "a": [{"panel": "two", "edge": "in_back"}], "b": [{"panel": "two", "edge": "in_front"}]},
    {"name": "seat", "a": [{"panel": "one", "edge": "seat"}], "b": [{"panel": "two", "edge": "seat"}]},
    {"name": "front", "a": [{"panel": "one", "edge": "front"}], "b": [{"panel": "two", "edge": "front"}]}]})";
  const Pattern pattern = own(text);
  PanelMesh mesh = mesh_pattern(pattern, 0.02, "t");
  body::Body body = waisted_body();
  body.landmarks["crotch"].p = Vec3(0, 0.8, 0);
  const PlacementReport report = place_panels(pattern, body, mesh);
  EXPECT_EQ(report.crossings + report.vertices_inside + report.faces_through, 0);
  EXPECT_EQ(mesh.panels[0].part, "leg_l");
  EXPECT_EQ(mesh.panels[1].part, "leg_r");
  for (const PanelInfo& info : {mesh.panels[0], mesh.panels[1]})
    for (int v = info.first_vertex; v < info.first_vertex + info.n_vertices; ++v)
      EXPECT_GT(mesh.placed[v].x() * (info.part == "leg_l" ? 1 : -1), 0.004) << info.name;
  const Vec2 seat(24, 102);
  for (std::size_t v = 0; v < mesh.pattern.size(); ++v)
    if ((mesh.pattern[v] - 0.01 * seat).norm() < 1e-6 ||
        (mesh.pattern[v] - 0.01 * Vec2(-24, 102)).norm() < 1e-6) {
      EXPECT_LT(mesh.placed[v].z(), 0) << "the seat is behind";
    }
}

TEST(Placement, CuffsOfTrousersGoAroundTheirLegs) {
  std::string panels, seams;
  for (const char* side : {"l", "r"})
    for (const char* at : {"front", "back"}) {
      const std::string leg = std::string(at) + "_" + side, cuff = "cuff_" + leg;
      panels += "," + rectangle(cuff, 20, 6);
      seams += R"(, {"name": ")" + cuff + R"(", "a": [{"panel": ")" + leg +
               R"(", "edge": "hem"}], "b": [{"panel": ")" + cuff + R"(", "edge": "top"}]})";
      if (std::string(at) == "back")
        continue;
      for (const char* ends : {"lr", "rl"})
        seams += R"(, {"name": ")" + cuff + ends + R"(", "a": [{"panel": ")" + cuff +
                 R"(", "edge": ")" + ends[0] + R"("}], "b": [{"panel": "cuff_back_)" + side +
                 R"(", "edge": ")" + ends[1] + R"("}]})";
    }
  for (bool hinted : {false, true}) {
    Pattern pattern = box_trousers(panels, seams);
    if (hinted)
      for (Panel& panel : pattern.panels) {
        const bool front = panel.name.find("front") != std::string::npos,
                   cuff = panel.name.rfind("cuff", 0) == 0;
        panel.hint.rigid = Mat4::Identity();
        if (!front)
          panel.hint.rigid->topLeftCorner<3, 3>() = Vec3(-1, 1, -1).asDiagonal();
        double middle = 0; // a cuff is drawn from x = 0 on
        if (cuff)
          middle = (front ? -0.1 : 0.1) + (panel.name.back() == 'l' ? 0.13 : -0.13);
        panel.hint.rigid->topRightCorner<3, 1>() =
            Vec3(middle, cuff ? -0.06 : 0, front ? 0.3 : -0.3);
      }
    PanelMesh mesh = mesh_pattern(pattern, 0.02, "t");
    const PlacementReport report = place_panels(pattern, body_with_ankles(), mesh);
    EXPECT_EQ(report.crossings + report.vertices_inside + report.faces_through, 0) << hinted;
    for (std::size_t k = 4; k < 8; ++k) {
      const std::string& name = mesh.panels[k].name;
      EXPECT_EQ(mesh.panels[k].part, name.back() == 'l' ? "leg_l" : "leg_r") << name << hinted;
      const Vec3 m = middle(mesh, static_cast<int>(k));
      EXPECT_NEAR(m.x(), name.back() == 'l' ? 0.09 : -0.09, 0.06) << name << hinted;
      EXPECT_GT(m.z() * (name.find("front") != std::string::npos ? 1 : -1), 0.02) << name << hinted;
      EXPECT_LT(m.y(), 0.25) << name << hinted;
    }
  }
}

} // namespace
} // namespace sloper::pattern::test

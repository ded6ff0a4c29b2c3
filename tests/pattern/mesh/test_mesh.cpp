#include <support/mesh_quality.hpp>
#include <support/pattern_texts.hpp>

#include <ctime>
#include <gtest/gtest.h>
#include <pattern/mesh/smallest_angle.hpp>
#include <pattern/mesh/triangulate.hpp>
#include <sloper/base/error.hpp>
#include <sloper/base/parallel.hpp>
#include <sloper/pattern/panel_mesh_json.hpp>

#include <cmath>
#include <filesystem>

namespace sloper::pattern::test {
namespace {

TEST(Mesh, AreaIsThatOfTheOutline) {
  const Pattern pattern = own(tube_text());
  const PanelMesh mesh = mesh_pattern(pattern, 0.015, "test.json");
  for (std::size_t p = 0; p < pattern.panels.size(); ++p)
    EXPECT_NEAR(mesh_area(mesh, mesh.panels[p]), outline_area(pattern.panels[p]),
                1e-3 * outline_area(pattern.panels[p]));
}

TEST(Mesh, AMemoryOfPanelsChangesNothing) {
  MeshMemory memory;
  const auto same = [&](const Pattern& p, double h, double seam_h) {
    const PanelMesh with = mesh_pattern(p, h, "t", seam_h, &memory),
                    without = mesh_pattern(p, h, "t", seam_h);
    EXPECT_EQ(with.pattern, without.pattern);
    EXPECT_EQ(with.triangles, without.triangles);
    EXPECT_EQ(with.findings, without.findings);
  };
  Pattern pattern = own(tube_text());
  same(pattern, 0.015, 0);
  same(pattern, 0.015, 0);
  pattern.panels[0].lines = {{"pocket", "mark", {Segment::straight({-0.1, 0.2}, {0.1, 0.25})}}};
  same(pattern, 0.015, 0); // a line
  pattern.seams.pop_back();
  same(pattern, 0.015, 0); // a seam
  same(pattern, 0.015, 0.006);
  same(pattern, 0.012, 0.006);
  same(pattern, 0.012, 0);
}

TEST(Mesh, AnEdgeLengthFarTooSmallIsRefusedBeforeTheMemoryIsFull) {
  EXPECT_THROW(mesh_pattern(own(tube_text()), 1e-5, "t"), Error);
}

TEST(Mesh, ATriangleWithoutAreaIsRefusedWithItsPanelAndPlace) {
  const Pattern spike = own(
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "t", "panels": [{"name": "spike", "outline": [
      {"edge": "b", "path": [["M", 0, 0], ["L", 40, 0]]}, {"edge": "r", "path": [["L", 40, 40]]},
      {"edge": "t", "path": [["L", 39.9999, 0.001]]}, {"edge": "l", "path": [["L", 0, 0]]}]}]})");
  try {
    mesh_pattern(spike, 0.015, "t.json");
    FAIL() << "meshed";
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::INPUT);
    EXPECT_EQ(e.place(), "spike");
    EXPECT_NE(e.fact().find("without area at (1."), std::string::npos) << e.fact();
  }
}

TEST(Mesh, NoTriangleLiesOnThreeBoundaryVertices) {
  const PanelMesh mesh = mesh_pattern(own(tube_text()), 0.015, "test.json");
  std::vector<char> boundary(mesh.pattern.size(), 0);
  for (const PanelInfo& p : mesh.panels)
    for (int v : p.outline)
      boundary[v] = 1;
  for (const Triangle& t : mesh.triangles)
    EXPECT_FALSE(boundary[t[0]] && boundary[t[1]] && boundary[t[2]]);
}

TEST(Mesh, AnglesStayAboveTwentyFiveDegreesOverSizesAndShapes) {
  for (double h : {0.005, 0.01, 0.015, 0.03, 0.06})
    EXPECT_GT(smallest_angle_deg(mesh_pattern(own(tube_text()), h, "test.json")), 25) << h;
  for (int k = 0; k < 40; ++k) { // wavy discs with a hole
    std::vector<Vec2> outer, hole;
    const double waves = 2 + k % 5, depth = 0.02 + 0.002 * k;
    const int n = 60;
    for (int i = 0; i < n; ++i) {
      const double a = 2 * 3.14159265358979 * i / n, r = 0.2 + depth * std::sin(waves * a + k);
      outer.push_back(r * Vec2(std::cos(a), std::sin(a)));
    }
    for (int i = 0; i < 20; ++i) {
      const double a = -2 * 3.14159265358979 * i / 20;
      hole.push_back(0.05 * Vec2(std::cos(a), std::sin(a)));
    }
    const FlatMesh mesh = triangulate({outer, hole}, SizeField(0.018),
                                      std::vector<char>(outer.size() + hole.size(), 0), "disc");
    double worst = 10;
    for (const Triangle& t : mesh.triangles)
      worst =
          std::min(worst, smallest_angle(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]));
    EXPECT_GT(worst * 180 / 3.14159265358979, 25) << k;
  }
}

TEST(Mesh, StripsOfAnyWidthHaveGoodAngles) {
  for (int k = 0; k < 12; ++k) {
    const double width = 2 + 0.5 * k, bow = 0.3 * (k % 4);
    const std::string text =
        R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "band", "panels": [
      {"name": "band", "outline": [{"edge": "low", "path": [["M", -20, 0], ["Q", 0, -)" +
        std::to_string(bow) + R"(, 20, 0]]}, {"edge": "b", "path": [["L", 20, )" +
        std::to_string(width) + R"(]]}, {"edge": "top", "path": [["L", -20, )" +
        std::to_string(width) + R"(]]}, {"edge": "d", "path": [["L", -20, 0]]}]}]})";
    EXPECT_GT(smallest_angle_deg(mesh_pattern(own(text), 0.02, "test.json")), 25)
        << width << " cm, bow " << bow;
  }
}

TEST(Mesh, FinerAlongSeamsOnRequestWithGoodAnglesAndMatchingSeams) {
  const Pattern pattern = own(tube_text());
  const PanelMesh usual = mesh_pattern(pattern, 0.03, "test.json"),
                  fine = mesh_pattern(pattern, 0.03, "test.json", 0.008);
  EXPECT_GT(smallest_angle_deg(fine), 25);
  EXPECT_GT(fine.seams[0].a.size(), 3 * usual.seams[0].a.size());
  EXPECT_LT(fine.pattern.size(), mesh_pattern(pattern, 0.008, "test.json").pattern.size() / 3);
  double near = 0,
         far =
             0; // longest edge within 1 cm of the side seams, shortest further than 12 cm from them
  far = 1;
  for (const Triangle& t : fine.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 &a = fine.pattern[t[k]], &b = fine.pattern[t[(k + 1) % 3]];
      const double off = 0.2 - 0.5 * std::abs(a.x() + b.x());
      if (off < 0.01)
        near = std::max(near, (a - b).norm());
      if (off > 0.12)
        far = std::min(far, (a - b).norm());
    }
  EXPECT_LT(near, 0.018);
  EXPECT_GT(far, 0.015);
  for (std::size_t p = 0; p < pattern.panels.size(); ++p)
    EXPECT_NEAR(mesh_area(fine, fine.panels[p]), outline_area(pattern.panels[p]),
                1e-3 * outline_area(pattern.panels[p]));
}

TEST(Mesh, ASharpCornerIsListedAndTheRestIsGood) {
  const std::string text =
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "godet", "panels": [
    {"name": "godet", "outline": [{"edge": "a", "path": [["M", 0, 0], ["L", 12, 0]]}, {"edge": "b", "path": [["L", 6, 50]]}, {"edge": "c", "path": [["L", 0, 0]]}]}]})";
  const PanelMesh mesh = mesh_pattern(own(text), 0.015, "test.json");
  EXPECT_LT(smallest_angle_deg(mesh), 25);
  EXPECT_TRUE(std::any_of(mesh.findings.begin(), mesh.findings.end(), [](const Message& f) {
    return f.text.find("godet: ") == 0 && f.text.find("below 25 degrees") != std::string::npos;
  }));
}

TEST(Mesh, ANarrowStrapHasTwoRows) {
  const std::string text =
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "strap", "panels": [
    {"name": "strap", "outline": [{"edge": "a", "path": [["M", 0, 0], ["L", 40, 0]]}, {"edge": "b", "path": [["L", 40, 1.6]]}, {"edge": "c", "path": [["L", 0, 1.6]]}, {"edge": "d", "path": [["L", 0, 0]]}]}]})";
  const PanelMesh mesh = mesh_pattern(own(text), 0.015, "test.json");
  const std::size_t interior = mesh.pattern.size() - mesh.panels[0].outline.size();
  EXPECT_GT(interior, 15u) << "a row of points runs along the middle";
  for (const Triangle& t : mesh.triangles)
    EXPECT_GE(std::max({t[0], t[1], t[2]}), static_cast<int>(mesh.panels[0].outline.size()));
}

TEST(Mesh, SameBytesOnEveryRunAndForAnyThreadCount) {
  const Pattern pattern = own(tube_text());
  set_thread_count(1);
  const PanelMesh one = mesh_pattern(pattern, 0.01, "test.json");
  set_thread_count(4);
  const PanelMesh four = mesh_pattern(pattern, 0.01, "test.json");
  set_thread_count(1);
  ASSERT_EQ(one.pattern.size(), four.pattern.size());
  for (std::size_t v = 0; v < one.pattern.size(); ++v)
    EXPECT_EQ(one.pattern[v], four.pattern[v]);
  EXPECT_EQ(one.triangles, four.triangles);
}

TEST(Mesh, TenThousandVerticesTakeATenthOfASecondOfCpu) {
  const std::clock_t start = std::clock(); // of CPU, so that a busy machine does not matter
  const PanelMesh mesh = mesh_pattern(own(tube_text()), 0.0074, "test.json");
  [[maybe_unused]] const double seconds =
      static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  EXPECT_GT(mesh.pattern.size(), 9000u);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  EXPECT_LT(seconds, 0.5); // 0.12 s; the bound leaves room for slower ones
#endif
}

TEST(Mesh, DocumentReadsBackAsItWasWritten) {
  PanelMesh mesh = mesh_pattern(own(tube_text()), 0.03, "test.json");
  const std::string path = (std::filesystem::temp_directory_path() /
                            ("sloper_panels_" + std::to_string(::getpid()) + ".json"))
                               .string();
  mesh.placement = Placement::BODY;
  mesh.body_sha256 = "of a skin";
  mesh.panels[1].in_folds = true;
  write_panel_mesh(path, mesh, "test");
  const PanelMesh back = read_panel_mesh(path);
  EXPECT_EQ(back.name, mesh.name);
  ASSERT_EQ(back.pattern.size(), mesh.pattern.size());
  for (std::size_t v = 0; v < mesh.pattern.size(); ++v) {
    EXPECT_EQ(back.pattern[v], mesh.pattern[v]);
    EXPECT_EQ(back.placed[v], mesh.placed[v]);
    EXPECT_EQ(back.ids[v].s, mesh.ids[v].s);
  }
  EXPECT_EQ(back.placement, Placement::BODY);
  EXPECT_EQ(back.body_sha256, mesh.body_sha256);
  EXPECT_EQ(back.triangles, mesh.triangles);
  ASSERT_EQ(back.seams.size(), mesh.seams.size());
  for (std::size_t s = 0; s < mesh.seams.size(); ++s) {
    EXPECT_EQ(back.seams[s].a, mesh.seams[s].a);
    EXPECT_EQ(back.seams[s].b, mesh.seams[s].b);
  }
  EXPECT_EQ(back.panels[1].outline, mesh.panels[1].outline);
  EXPECT_TRUE(back.panels[1].in_folds);
  EXPECT_FALSE(back.panels[0].in_folds);
  std::filesystem::remove(path);
  std::filesystem::remove(io::mesh_path_beside(path));
}

} // namespace
} // namespace sloper::pattern::test

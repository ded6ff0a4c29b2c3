#include <support/mesh_quality.hpp>
#include <support/pattern_texts.hpp>
#include <support/stick_body.hpp>

#include <gtest/gtest.h>
#include <sloper/base/error.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/edit/edits.hpp>
#include <sloper/pattern/measure/finished_measures.hpp>
#include <sloper/pattern/mesh/folds.hpp>
#include <sloper/pattern/place/place_panels.hpp>
#include <sloper/pattern/seams/check_pattern.hpp>
#include <sloper/pattern/write/export_pattern.hpp>

#include <set>

namespace sloper::pattern::test {
namespace {

/// A skirt of two panels and a waistband; the front has a knife pleat (4 cm from target to fold)
/// and a box pleat (3 cm to both sides). Its top is 58 cm, of which 4 + 3 + 3 cm lie under pleats:
/// the band's front is 48 cm.
std::string pleated_text(const std::string& edges = R"(["top"])", const std::string& fold = "4") {
  const auto line = [](const std::string& name, const std::string& kind, const std::string& x) {
    return R"({"name": ")" + name + R"(", "kind": ")" + kind + R"(", "path": [["M", )" + x +
           R"(, 0], ["L", )" + x + R"(, 50]]})";
  };
  const std::string band =
      R"("outline": [{"edge": "low", "path": [["M", -24, 0], ["L", 24, 0]]}, {"edge": "l", "path": [["L", 24, 4]]},
      {"edge": "up", "path": [["L", -24, 4]]}, {"edge": "r", "path": [["L", -24, 0]]}])";
  return R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "pleated skirt", "panels": [
    {"name": "skirt_front", "outline": [{"edge": "hem", "path": [["M", -29, 0], ["L", 29, 0]]}, {"edge": "left", "path": [["L", 29, 50]]},
      {"edge": "top", "path": [["L", -29, 50]]}, {"edge": "right", "path": [["L", -29, 0]]}],
      "lines": [)" +
         line("t1", "mark", "0") + "," + line("f1", "fold", fold) + "," +
         line("t2", "mark", "-15") + "," + line("f2", "fold", "-18") + "," +
         line("f3", "fold", "-12") + R"(],
      "pleats": [{"name": "knife", "fold": "f1", "target": "t1", "edges": )" +
         edges + R"(}, {"name": "box_r", "fold": "f2", "target": "t2", "edges": ["top"]},
                 {"name": "box_l", "fold": "f3", "target": "t2", "edges": ["top"]}]},
    {"name": "skirt_back", "outline": [{"edge": "hem", "path": [["M", -24, 0], ["L", 24, 0]]}, {"edge": "left", "path": [["L", 24, 50]]},
      {"edge": "top", "path": [["L", -24, 50]]}, {"edge": "right", "path": [["L", -24, 0]]}]},
    {"name": "waistband_front", )" +
         band + R"(}, {"name": "waistband_back", )" + band + R"(}], "seams": [
    {"name": "side_l", "a": [{"panel": "skirt_front", "edge": "left"}], "b": [{"panel": "skirt_back", "edge": "right"}]},
    {"name": "side_r", "a": [{"panel": "skirt_back", "edge": "left"}], "b": [{"panel": "skirt_front", "edge": "right"}]},
    {"name": "band_f", "a": [{"panel": "skirt_front", "edge": "top"}], "b": [{"panel": "waistband_front", "edge": "low"}]},
    {"name": "band_b", "a": [{"panel": "skirt_back", "edge": "top"}], "b": [{"panel": "waistband_back", "edge": "low"}]},
    {"name": "band_l", "a": [{"panel": "waistband_front", "edge": "l"}], "b": [{"panel": "waistband_back", "edge": "r"}]},
    {"name": "band_r", "a": [{"panel": "waistband_back", "edge": "l"}], "b": [{"panel": "waistband_front", "edge": "r"}]}]})";
}

std::vector<int> weld_of(const PanelMesh& mesh) {
  return sew(mesh).weld;
}

TEST(Pleats, ThreeLayersAreSewnOntoEachOtherAndTheSeamTakesTheUpperOne) {
  const Pattern pattern = own(pleated_text());
  EXPECT_TRUE(check_pattern(pattern).empty())
      << "the lengths that are sewn agree: " << check_pattern(pattern)[0].fact;
  const PanelMesh mesh = mesh_pattern(pattern, 0.006, "t");
  for (const MeshSeam& s : mesh.seams)
    EXPECT_EQ(s.a.size(), s.b.size());
  const std::vector<int> weld = weld_of(mesh);
  const auto on_top = [&](double x) { // vertices of the front's top edge at x, cm
    for (int v : mesh.panels[0].outline) {
      const Vec2 p = mesh.pattern[v];
      if (std::abs(p.x() * 100 - x) < 1e-6 && std::abs(p.y() - 0.5) < 1e-9)
        return weld[v];
    }
    return -1;
  };
  for (const auto& [target, fold] :
       {std::pair(0.0, 4.0), std::pair(-15.0, -18.0), std::pair(-15.0, -12.0)}) {
    ASSERT_GE(on_top(target), 0);
    EXPECT_EQ(on_top(target), on_top(fold)) << "the fold comes to the target";
    ASSERT_GE(on_top(0.5 * (target + fold)), 0);
    EXPECT_EQ(on_top(0.5 * (target + fold)), on_top(fold + 0.5 * (fold - target)))
        << "and the line between lies under the upper layer";
  }
  EXPECT_EQ(on_top(-12), on_top(-18)) << "both folds of a box pleat meet";
  // Along the seam each particle of the pleats' upper layers has three vertices of the skirt and
  // one of the band.
  std::map<int, std::array<int, 4>> count;
  for (std::size_t p = 0; p < 4; ++p)
    for (int v : mesh.panels[p].outline)
      ++count[weld[v]][p];
  int threefold = 0;
  for (const auto& [id, n] : count)
    threefold += n[0] == 3 && n[2] == 1;
  EXPECT_GE(threefold, 3);
  EXPECT_EQ(sew(mesh).degenerate, 0);
}

TEST(Pleats, FoldLinesAreEdgesOfTheMeshAndItsAnglesAreGood) {
  for (double h : {0.008, 0.015, 0.02}) {
    const Pattern pattern = own(pleated_text());
    const PanelMesh mesh = mesh_pattern(pattern, h, "t");
    for (double x : {0.0, 0.02, 0.04, -0.15, -0.18, -0.12, -0.165, -0.135}) {
      double covered = 0; // length of mesh edges on the line, each found from both of its triangles
      for (const Triangle& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
          const Vec2 &a = mesh.pattern[t[k]], &b = mesh.pattern[t[(k + 1) % 3]];
          if (t[k] < mesh.panels[0].n_vertices && std::abs(a.x() - x) < 1e-6 &&
              std::abs(b.x() - x) < 1e-6)
            covered += 0.5 * (a - b).norm();
        }
      if (h <= 0.5 * 0.03 + 1e-9) {
        EXPECT_NEAR(covered, 0.5, 1e-6) << "line at " << x << ", edge length " << h;
      }
    }
    if (h < 0.012) {
      EXPECT_GT(smallest_angle_deg(mesh), 22) << h;
    }
    EXPECT_NEAR(mesh_area(mesh, mesh.panels[0]), outline_area(pattern.panels[0]), 1e-9);
  }
}

TEST(Pleats, EdgesOfTheirFoldsAreKnown) {
  const PanelMesh mesh = mesh_pattern(own(pleated_text()), 0.008, "t");
  std::map<long, double> length; // by place across, 0.1 mm
  for (const auto& [a, b] : pleat_edges(mesh)) {
    const Vec2 &p = mesh.pattern[a], &q = mesh.pattern[b];
    EXPECT_LT(a, b);
    EXPECT_NEAR(p.x(), q.x(), 1e-6);
    length[std::lround(1e4 * p.x())] += (q - p).norm();
  }
  ASSERT_EQ(length.size(), 6U) << "three folds, and the three lines halfway to their targets";
  for (long x : {200L, 400L, -1800L, -1650L, -1200L, -1350L})
    EXPECT_NEAR(length[x], 0.5, 1e-6) << x;
}

TEST(Pleats, TheyStartFoldedAroundTheBodyWithoutCrossing) {
  const Pattern pattern = own(pleated_text());
  PanelMesh mesh = mesh_pattern(pattern, 0.012, "t");
  const PlacementReport report = place_panels(pattern, stick_body(45), mesh);
  EXPECT_EQ(report.crossings, 0);
  EXPECT_EQ(report.vertices_inside + report.faces_through, 0);
  for (const MeshSeam& s : mesh.seams)
    for (std::size_t k = 0; s.kind == "pleat" && k < s.a.size(); ++k)
      EXPECT_LT((mesh.placed[s.a[k]] - mesh.placed[s.b[k]]).norm(), 0.015) << s.name;
  // The upper layer lies outside.
  const Folding folding = fold_panels(pattern, mesh);
  double deepest = 0;
  for (double d : folding.depth)
    deepest = std::max(deepest, d);
  EXPECT_NEAR(deepest, 0.009, 0.002);
}

TEST(Pleats, WhatDoesNotFitIsSaidInCentimetres) {
  const auto said = [](const std::string& text) {
    try {
      mesh_pattern(own(text), 0.015, "p.json");
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_NE(said(pleated_text(R"(["top"])", "25")).find("reaches 8.50 cm past the end of edge top"),
            std::string::npos)
      << said(pleated_text(R"(["top"])", "25"));
  EXPECT_NE(said(pleated_text(R"(["left"])")).find("line f1 does not end on edge left"),
            std::string::npos);
  std::string overlap = pleated_text();
  const std::string target = R"(["M", 0, 0], ["L", 0, 50])";
  overlap.replace(overlap.find(target), target.size(), R"(["M", -11, 0], ["L", -11, 50])");
  EXPECT_NE(said(overlap).find("overlaps pleat"), std::string::npos) << said(overlap);
  EXPECT_NE(said(pleated_text(R"(["tpo"])")).find("did you mean 'top'"), std::string::npos);
}

TEST(Lines, AreKeptByTheFormatsAndTheEdits) {
  const Pattern pattern = own(pleated_text());
  const Pattern again = own(io::to_text(pattern_json(pattern, "t")));
  EXPECT_EQ(io::to_text(pattern_json(again, "t")), io::to_text(pattern_json(pattern, "t")));
  std::vector<std::string> left_out;
  const Pattern dxf = read_dxf(pattern_dxf(pattern, left_out), "t.dxf");
  EXPECT_EQ(dxf.panels[dxf.find_panel("skirt_front")].lines.size(), 5u);
  EXPECT_EQ(left_out.size(), 3u) << "that pleats become lines is said";
  Pattern edited = pattern;
  apply_edits(edited,
              io::parse_json(R"({"format": "edits", "version": 1, "length_unit": "cm", "edits": [
      {"edit": "move-edge", "panel": "skirt_front", "edge": "hem", "by": [0, -10]}]})",
                             "e"),
              "e");
  for (const InnerLine& line : edited.panels[0].lines)
    EXPECT_NEAR(length(line.path), 0.6, 1e-6) << "lines go with the edges that they end on";
  PanelMesh mesh = mesh_pattern(pattern, 0.015, "t");
  EXPECT_TRUE(follow_edits(pattern, edited, mesh, 15)) << "and the mesh with them";
}

TEST(Lines, MarksInsideAPanelBecomeMeshEdges) {
  std::string text = tube_text();
  text.replace(
      text.find(R"("outline")"), 0,
      R"("lines": [{"name": "pocket", "path": [["M", -12, 22], ["C", -6, 14, 6, 30, 12, 22]]}, {"name": "free", "path": [["M", 0, 35], ["L", 5, 50]]}], )");
  const Pattern pattern = own(text);
  const PanelMesh mesh = mesh_pattern(pattern, 0.012, "t"),
                  plain = mesh_pattern(own(tube_text()), 0.012, "t");
  EXPECT_GT(smallest_angle_deg(mesh), 25);
  EXPECT_LT(
      std::abs(
          static_cast<double>(mesh.pattern.size()) / static_cast<double>(plain.pattern.size()) - 1),
      0.1);
  const ArcLength curve(pattern.panels[0].lines[0].path);
  const int n = static_cast<int>(std::lround(curve.length() / 0.012));
  std::set<std::pair<int, int>> edges;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      edges.insert({t[k], t[(k + 1) % 3]});
  const auto vertex = [&](const Vec2& p) {
    for (std::size_t v = 0; v < mesh.pattern.size(); ++v)
      if ((mesh.pattern[v] - p).norm() < 1e-9)
        return static_cast<int>(v);
    return -1;
  };
  for (int k = 0; k < n; ++k) {
    const int a = vertex(curve.at(curve.length() * k / n)),
              b = vertex(curve.at(curve.length() * (k + 1) / n));
    EXPECT_TRUE(edges.count({a, b}) == 1) << k;
  }
}

double least_height(const PanelMesh& mesh) { // of a triangle, in its longest edge
  double least = 1;
  for (const Triangle& t : mesh.triangles) {
    const Vec2 u = mesh.pattern[t[1]] - mesh.pattern[t[0]],
               v = mesh.pattern[t[2]] - mesh.pattern[t[0]];
    least =
        std::min(least, (u.x() * v.y() - u.y() * v.x()) /
                            std::max({u.squaredNorm(), v.squaredNorm(), (u - v).squaredNorm()}));
  }
  return least;
}

PanelMesh meshed_with(const std::string& lines, double h) {
  std::string text = tube_text();
  text.replace(text.find(R"("outline")"), 0, R"("lines": [)" + lines + "], ");
  return mesh_pattern(own(text), h, "t");
}

TEST(Lines, AClosedMarkIsMeshedAsARingWithoutFlatTriangles) {
  const std::string ring =
      R"({"name": "ring", "path": [["M", -8, 25], ["A", 8, 0, 1, 8, 25], ["A", 8, 0, 1, -8, 25]]})";
  for (double h : {0.008, 0.012, 0.015, 0.03}) {
    const PanelMesh mesh = meshed_with(ring, h);
    EXPECT_GT(smallest_angle_deg(mesh), 25) << h;
    int n_on = 0;
    for (const Vec2& p : mesh.pattern)
      n_on += std::abs((p - Vec2(0, 0.25)).norm() - 0.08) < 1e-6;
    EXPECT_EQ(n_on, std::lround(0.16 * units::PI / h)) << h;
  }
}

TEST(Lines, MarksThatMeetThemselvesOrOthersLeaveNoFlatTriangle) {
  const std::vector<std::string> lines = {
      // an eight; a square; a dart drawn as a V; the same line to and fro
      R"({"name": "eight", "path": [["M", 0, 25], ["C", 20, 45, 20, 5, 0, 25], ["C", -20, 45, -20, 5, 0, 25]]})",
      R"({"name": "square", "path": [["M", -6, 20], ["L", 6, 20], ["L", 6, 32], ["L", -6, 32], ["L", -6, 20]]})",
      R"({"name": "v", "path": [["M", -1, 10], ["L", 0, 30], ["L", 1, 10]]})",
      R"({"name": "twice", "path": [["M", -8, 20], ["L", 8, 20], ["L", -8, 20]]})",
      // the middle of a long stretch, halved, lies on the end of another line
      R"({"name": "end", "path": [["M", 0, 10], ["L", 0, 24]]}, {"name": "over", "path": [["M", -1.05, 24], ["L", 1.05, 24]]})",
      // a button
      R"({"name": "button", "path": [["M", -0.5, 25], ["A", 0.5, 0, 1, 0.5, 25], ["A", 0.5, 0, 1, -0.5, 25]]})"};
  for (const std::string& line : lines)
    for (double h : {0.006, 0.012, 0.015, 0.021})
      EXPECT_GT(least_height(meshed_with(line, h)), 0.1) << h << ": " << line;
}

TEST(Tapes, ShortenWhatRunsAlongThemAndNothingElse) {
  Pattern pattern = own(tube_text());
  const PanelMesh before = mesh_pattern(pattern, 0.015, "t");
  EXPECT_TRUE(tape_scales(before).empty());
  const io::Json edit =
      io::parse_json(R"({"format": "edits", "version": 1, "length_unit": "cm", "edits": [
      {"edit": "shrink", "panel": "front", "curve": [["M", -20, 30], ["Q", 0, 36, 20, 30]], "factor": 0.6, "name": "elastic"}]})",
                     "e");
  const Pattern source = pattern;
  apply_edits(pattern, edit, "e");
  PanelMesh mesh = before;
  ASSERT_TRUE(follow_edits(source, pattern, mesh, 15)) << "a tape keeps the mesh";
  EXPECT_EQ(mesh.triangles, before.triangles);
  for (std::size_t v = 0; v < mesh.pattern.size(); ++v)
    EXPECT_LT((mesh.pattern[v] - before.pattern[v]).norm(), 1e-8);
  mesh.source = std::make_shared<Pattern>(pattern);
  const auto scale = tape_scales(mesh);
  ASSERT_EQ(scale.size(), mesh.triangles.size());
  double least = 1;
  for (std::size_t f = 0; f < scale.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 &a = mesh.pattern[mesh.triangles[f][k]],
                 &b = mesh.pattern[mesh.triangles[f][(k + 1) % 3]];
      if (static_cast<int>(f) >= mesh.panels[1].first_triangle ||
          std::abs(0.5 * (a + b).y() - 0.315) > 0.03) {
        EXPECT_EQ(scale[f][k], 1);
      }
      if (std::abs((b - a).normalized().x()) < 0.1) {
        EXPECT_GT(scale[f][k], 0.95) << "across the tape";
      }
      least = std::min(least, scale[f][k]);
    }
  EXPECT_NEAR(least, 0.6, 0.03);
  Pattern back = pattern;
  apply_edits(back, inverse_edits(source, edit, "e", "t"), "undo");
  EXPECT_EQ(io::to_text(pattern_json(back, "t")), io::to_text(pattern_json(source, "t")));
}

double named(const FinishedMeasures& m, const std::string& name) {
  for (const NamedMeasure& n : m.named)
    if (n.name == name)
      return n.value;
  return 0;
}

TEST(NamedMeasures, OfAPleatedSkirtAreThoseOfTheFinishedOne) {
  const FinishedMeasures m = finished_measures(own(pleated_text()), "t");
  EXPECT_NEAR(named(m, "waist"), 0.96, 0.002);
  EXPECT_NEAR(named(m, "hip"), 1.06, 0.002) << "below the band the pleats open";
  EXPECT_NEAR(named(m, "hem"), 1.06, 0.002);
  EXPECT_NEAR(named(m, "side_seam"), 0.5, 0.002);
  EXPECT_NEAR(named(m, "length"), 0.54, 0.003);
}

TEST(NamedMeasures, OfAShirtWithSleeves) {
  // A box: 100 cm around, shoulders of 14 cm, armholes of 20 cm, sleeves of 30 cm that narrow from
  // 40 to 24 cm.
  const std::string body =
      R"("outline": [{"edge": "hem", "path": [["M", -25, 0], ["L", 25, 0]]}, {"edge": "l_side", "path": [["L", 25, 40]]}, {"edge": "l_arm", "path": [["L", 25, 60]]},
      {"edge": "l_shoulder", "path": [["L", 11, 60]]}, {"edge": "neck", "path": [["L", -11, 60]]}, {"edge": "r_shoulder", "path": [["L", -25, 60]]},
      {"edge": "r_arm", "path": [["L", -25, 40]]}, {"edge": "r_side", "path": [["L", -25, 0]]}])";
  const std::string sleeve =
      R"("outline": [{"edge": "cuff", "path": [["M", -12, 0], ["L", 12, 0]]}, {"edge": "l", "path": [["L", 20, 30]]}, {"edge": "top_1", "path": [["L", 0, 30]]},
      {"edge": "top_2", "path": [["L", -20, 30]]}, {"edge": "r", "path": [["L", -12, 0]]}])";
  const auto seam = [](const std::string& name, const std::string& p, const std::string& e,
                       const std::string& q, const std::string& g) {
    return R"({"name": ")" + name + R"(", "a": [{"panel": ")" + p + R"(", "edge": ")" + e +
           R"("}], "b": [{"panel": ")" + q + R"(", "edge": ")" + g + R"("}]})";
  };
  const FinishedMeasures m = finished_measures(
      own(R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "box", "panels": [{"name": "front", )" +
          body + R"(}, {"name": "back", )" + body + R"(}, {"name": "sleeve_l", )" + sleeve +
          R"(}, {"name": "sleeve_r", )" + sleeve + R"(}], "seams": [)" +
          seam("s1", "front", "l_side", "back", "r_side") + "," +
          seam("s2", "back", "l_side", "front", "r_side") + "," +
          seam("h1", "front", "l_shoulder", "back", "r_shoulder") + "," +
          seam("h2", "back", "l_shoulder", "front", "r_shoulder") + "," +
          seam("a1", "front", "l_arm", "sleeve_l", "top_2") + "," +
          seam("a2", "back", "r_arm", "sleeve_l", "top_1") + "," +
          seam("a3", "front", "r_arm", "sleeve_r", "top_1") + "," +
          seam("a4", "back", "l_arm", "sleeve_r", "top_2") + "," +
          seam("u1", "sleeve_l", "l", "sleeve_l", "r") + "," +
          seam("u2", "sleeve_r", "l", "sleeve_r", "r") + "]}"),
      "t");
  EXPECT_NEAR(named(m, "chest"), 1.0, 0.005);
  EXPECT_NEAR(named(m, "waist"), 1.0, 0.005);
  EXPECT_NEAR(named(m, "shoulder"), 0.14, 0.005);
  EXPECT_NEAR(named(m, "length"), 0.6, 0.005);
  EXPECT_NEAR(named(m, "side_seam"), 0.4, 0.005);
  EXPECT_NEAR(named(m, "sleeve"), 0.3, 0.005);
  EXPECT_NEAR(named(m, "cuff"), 0.24, 0.01);
  EXPECT_NEAR(named(m, "upper_arm"), 0.40 - 0.16 * 2.5 / 30, 0.01);
  EXPECT_NEAR(named(m, "neck"), 0.44, 0.005);
  EXPECT_NEAR(named(m, "hem"), 1.0, 0.005);
}

} // namespace
} // namespace sloper::pattern::test

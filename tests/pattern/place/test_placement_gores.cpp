#include <support/gored_patterns.hpp>
#include <support/placement_patterns.hpp>

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <sloper/pattern/place/place_panels.hpp>

namespace sloper::pattern::test {
namespace {

struct Placed {
  PanelMesh mesh;
  PlacementReport report;
  /// m between the two sides of each stitch of seams whose panels' names both begin so, ascending.
  std::vector<double> gaps(const std::string& begin) const {
    std::vector<double> out;
    for (const MeshSeam& s : mesh.seams)
      for (std::size_t k = 0; k < s.a.size(); ++k) {
        const auto of = [&](int v) {
          for (const PanelInfo& p : mesh.panels)
            if (v >= p.first_vertex && v < p.first_vertex + p.n_vertices)
              return p.name;
          return std::string();
        };
        if (of(s.a[k]).rfind(begin, 0) == 0 && of(s.b[k]).rfind(begin, 0) == 0)
          out.push_back((mesh.placed[s.a[k]] - mesh.placed[s.b[k]]).norm());
      }
    std::sort(out.begin(), out.end());
    return out;
  }
  /// That part of the edges of the mesh which are at least `low` and at most `high` times as long
  /// as drawn.
  double share_within(double low, double high) const {
    double within = 0, all = 0;
    for (const Triangle& t : mesh.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t a = static_cast<std::size_t>(t[k]),
                          b = static_cast<std::size_t>(t[(k + 1) % 3]);
        const double ratio =
            (mesh.placed[a] - mesh.placed[b]).norm() / (mesh.pattern[a] - mesh.pattern[b]).norm();
        within += ratio >= low && ratio <= high;
        ++all;
      }
    return within / all;
  }
  const PanelInfo& panel(const std::string& name) const {
    return *std::find_if(mesh.panels.begin(), mesh.panels.end(),
                         [&](const PanelInfo& p) { return p.name == name; });
  }
  Vec2 heights(const std::string& name) const {
    Vec2 y(1e300, -1e300);
    const PanelInfo& p = panel(name);
    for (int v = p.first_vertex; v < p.first_vertex + p.n_vertices; ++v) {
      const double at = mesh.placed[v].y();
      y = Vec2(std::min(y.x(), at), std::max(y.y(), at));
    }
    return y;
  }
  Vec3 middle_of(const std::string& name) const {
    return middle(mesh, static_cast<int>(&panel(name) - mesh.panels.data()));
  }
};

Placed place(const DrawnPattern& drawn) {
  const Pattern pattern = drawn.pattern();
  Placed out{mesh_pattern(pattern, 0.02, "t"), {}};
  out.report = place_panels(pattern, waisted_body(), out.mesh);
  return out;
}

TEST(PlacementOfGores, TheirSeamsLieClosedFromTheWaistToTheHemHoweverTheyFlare) {
  const auto of = [](int n, double girth) { return girth / n / 2; };
  for (int n : {4, 6, 8})
    for (const bool mermaid : {false, true}) {
      SCOPED_TRACE(std::to_string(n) + (mermaid ? " narrow to the knee" : ""));
      const Placed skirt = place(
          mermaid ? gored_skirt(
                        n, {{0, of(n, 86)}, {18, of(n, 108)}, {42, of(n, 104)}, {66, of(n, 260)}})
                  : gored_skirt(n, {{0, of(n, 86)}, {18, of(n, 118)}, {58, of(n, 240)}}));
      EXPECT_EQ(skirt.report.crossings + skirt.report.vertices_inside + skirt.report.faces_through,
                0);
      EXPECT_LT(skirt.gaps("skirt_front").back(), 0.025)
          << "laid flat side by side the tops are apart by what the hems are wider";
      EXPECT_LT(skirt.gaps("skirt_back").back(), 0.025);
      EXPECT_GT(skirt.share_within(0.8, 1.25), 0.98);
    }
}

TEST(PlacementOfGores, ThoseWithoutAWordForTheirSideStandAroundTheBodyAsWell) {
  DrawnPattern drawn;
  add_gores(drawn, {"gore_1", "gore_2", "gore_3", "gore_4", "gore_5", "gore_6"},
            {{0, 7.2}, {18, 9.5}, {58, 24}});
  const Placed skirt = place(drawn);
  EXPECT_EQ(skirt.report.crossings + skirt.report.vertices_inside + skirt.report.faces_through, 0);
  EXPECT_LT(skirt.report.seam_gap_max, 0.06)
      << "what the way around the waist is longer than the cloth is shared out among all seams";
  EXPECT_NEAR(skirt.middle_of("gore_1").x(), 0, 0.02) << "the first looks forwards";
  EXPECT_GT(skirt.middle_of("gore_1").z(), 0.1);
}

TEST(PlacementOfGores, AWholeCircleInQuartersStartsInFoldsAndKeepsItsShape) {
  for (const bool named : {true, false}) {
    SCOPED_TRACE(named ? "front and back" : "names that tell nothing");
    const Placed skirt =
        place(named ? circle_in_quarters(14, 64)
                    : circle_in_quarters(14, 64, {"piece 1", "piece 2", "piece 3", "piece 4"}));
    EXPECT_EQ(skirt.report.crossings + skirt.report.vertices_inside + skirt.report.faces_through,
              0);
    EXPECT_LT(skirt.report.seam_gap_max, 0.1);
    EXPECT_GT(skirt.share_within(0.65, 1.25), 0.97) << "edges go straight across folds";
    double widest = 0;
    for (const Vec3& p : skirt.mesh.placed)
      widest = std::max(widest, std::abs(p.x()));
    EXPECT_LT(widest, 0.55) << "it stays between the arms";
  }
}

TEST(PlacementOfGores, GodetsStartBetweenTheGoresThatTheyAreSewnTo) {
  for (int n : {4, 6}) {
    SCOPED_TRACE(n);
    const Placed skirt = place(skirt_with_godets(n));
    EXPECT_EQ(skirt.report.crossings + skirt.report.vertices_inside + skirt.report.faces_through,
              0);
    const std::vector<std::string> names = gore_names(n);
    for (std::size_t k = 0; k < names.size(); ++k) {
      const Vec3 godet = skirt.middle_of("piece " + std::to_string(k + 1));
      const Vec3 a = skirt.middle_of(names[k]), b = skirt.middle_of(names[(k + 1) % names.size()]);
      const Vec2 out = Vec2(godet.x(), godet.z()).normalized(),
                 between = Vec2(a.x() + b.x(), a.z() + b.z()).normalized();
      EXPECT_GT(out.dot(between), std::cos(0.35)) << k;
    }
    const std::vector<double> all = skirt.gaps("");
    EXPECT_LT(all[all.size() * 9 / 10], 0.09)
        << "side seams are open by what the way around the body is longer";
    EXPECT_LT(skirt.gaps("skirt_front").back(), 0.03);
  }
}

TEST(PlacementOfGores, AFlareInTheMiddleOfTheBackAloneIsClosedToo) {
  DrawnPattern drawn;
  drawn.panel("skirt_front", gore({{0, 21.5}, {18, 28}, {60, 34}}));
  drawn.panel("skirt_back_l", {{"hem", 34, -60},
                               {"a2", 14, -18},
                               {"a1", 10.8, 0},
                               {"waist", -10.8, 0},
                               {"b1", -14, -18},
                               {"b2", -20, -60}});
  drawn.panel("skirt_back_r", {{"hem", 20, -60},
                               {"a2", 14, -18},
                               {"a1", 10.8, 0},
                               {"waist", -10.8, 0},
                               {"b1", -14, -18},
                               {"b2", -34, -60}});
  const std::vector<std::string> names = {"skirt_front", "skirt_back_l", "skirt_back_r"};
  for (std::size_t k = 0; k < 3; ++k)
    for (const char* length : {"1", "2"})
      drawn.seam(names[k], std::string("a") + length, names[(k + 1) % 3],
                 std::string("b") + length);
  const Placed skirt = place(drawn);
  EXPECT_EQ(skirt.report.crossings + skirt.report.vertices_inside + skirt.report.faces_through, 0);
  EXPECT_LT(skirt.gaps("skirt_back").back(), 0.03);
  EXPECT_NEAR(skirt.middle_of("skirt_front").x(), 0, 0.01);
}

TEST(PlacementGores, GoresStandBesideEachOtherHoweverFlatTheirSidesLean) {
  for (const double hem : {60.0, 100.0, 120.0, 150.0}) { // of each of four, under a waist of 18 cm
    SCOPED_TRACE(hem);
    const Placed skirt = place(gored_skirt(4, {{0, 9}, {34, 0.5 * hem}}));
    EXPECT_TRUE(skirt.report.impossible.empty());
    double low = 1e300, high = -1e300;
    for (const std::string& gore : gore_names(4)) {
      const Vec2 y = skirt.heights(gore);
      low = std::min(low, y.x());
      high = std::max(high, y.y());
    }
    EXPECT_LT(high - low, 0.01 * std::hypot(0.5 * hem - 9, 34) + 0.1)
        << "in one row, no taller than its sides are long";
  }
}

/// Front and back of six gores and, above them, one piece on each side that is sewn to three of
/// them.
DrawnPattern gores_below(const std::string& name, const std::vector<DrawnEdge>& upper,
                         const std::vector<const char*>& sides) {
  DrawnPattern drawn = gored_skirt(6, {{0, 7.5}, {18, 9.8}, {58, 20}});
  for (const char* side : {"front", "back"}) {
    const std::string piece = name + "_" + side;
    drawn.panel(piece, upper);
    const std::vector<std::string> below =
        side[0] == 'f'
            ? std::vector<std::string>{"skirt_front_side_r", "skirt_front", "skirt_front_side_l"}
            : std::vector<std::string>{"skirt_back_side_l", "skirt_back", "skirt_back_side_r"};
    for (std::size_t k = 0; k < 3; ++k)
      drawn.seam(piece, "low" + std::to_string(k + 1), below[k], "waist");
  }
  for (const char* side : sides)
    drawn.seam(name + "_front", std::string(side) + "_l", name + "_back", std::string(side) + "_r");
  for (const char* side : sides)
    drawn.seam(name + "_front", std::string(side) + "_r", name + "_back", std::string(side) + "_l");
  return drawn;
}

TEST(PlacementOfGores, AWaistbandStandsOverAllOfThem) {
  const Placed skirt = place(gores_below("waistband",
                                         {{"low1", -7.5, 0},
                                          {"low2", 7.5, 0},
                                          {"low3", 22.5, 0},
                                          {"side_l", 22.5, 4},
                                          {"top", -22.5, 4},
                                          {"side_r", -22.5, 0}},
                                         {"side"}));
  EXPECT_EQ(skirt.report.crossings + skirt.report.vertices_inside + skirt.report.faces_through, 0);
  for (const char* band : {"waistband_front", "waistband_back"})
    for (const std::string& gore : gore_names(6))
      EXPECT_NEAR(skirt.heights(band).x() - skirt.heights(gore).y(), 0.01, 0.01)
          << band << " over " << gore;
  EXPECT_NEAR(skirt.middle_of("waistband_front").x(), 0, 0.01);
}

TEST(PlacementOfGores, ABodiceSewnToThreeOfThemIsOverTheMiddleOne) {
  const Placed dress = place(gores_below("bodice",
                                         {{"low1", -7.5, 0},
                                          {"low2", 7.5, 0},
                                          {"low3", 22.5, 0},
                                          {"side_l", 24, 18},
                                          {"arm_l", 17, 36},
                                          {"shoulder_l", 7, 39},
                                          {"neck1", 0, 32},
                                          {"neck2", -7, 39},
                                          {"shoulder_r", -17, 36},
                                          {"arm_r", -24, 18},
                                          {"side_r", -22.5, 0}},
                                         {"side", "shoulder"}));
  EXPECT_EQ(dress.report.crossings + dress.report.vertices_inside + dress.report.faces_through, 0);
  for (const char* bodice : {"bodice_front", "bodice_back"})
    EXPECT_NEAR(dress.middle_of(bodice).x(), 0, 0.01) << bodice;
}

TEST(PlacementOfGores, PrincessSeamsOfAFlaredDressLieClosedFromTheShouldersToTheHem) {
  DrawnPattern drawn;
  const auto front = [&](const std::string& side) {
    drawn.panel(side + "_centre", {{"hem", 22, -100},
                                   {"a3", 10, -58},
                                   {"a2", 8, -38},
                                   {"a1", 9.5, -2},
                                   {"shoulder_a", 7, 0},
                                   {"neck1", 0, -8},
                                   {"neck2", -7, 0},
                                   {"shoulder_b", -9.5, -2},
                                   {"b1", -8, -38},
                                   {"b2", -10, -58},
                                   {"b3", -22, -100}});
    const std::vector<DrawnEdge> beside = {
        {"hem", 32, -100}, {"out3", 18, -58},  {"out2", 15, -38},
        {"out1", 15, -20}, {"arm", 4, -4},     {"shoulder", 0, -2},
        {"in1", 1.5, -38}, {"in2", -0.5, -58}, {"in3", -12.5, -100}};
    drawn.panel(side + "_side_a", beside);
    drawn.panel(side + "_side_b",
                seen_in_mirror(beside)); // to the right and the left as they are drawn
    for (const char* part : {"1", "2", "3"})
      for (const char* at : {"a", "b"})
        drawn.seam(side + "_centre", std::string(at) + part, side + "_side_" + at,
                   std::string("in") + part);
  };
  front("front");
  front("back");
  for (const auto& [a, b] : {std::pair("a", "b"), std::pair("b", "a")}) {
    for (const char* part : {"1", "2", "3"})
      drawn.seam(std::string("front_side_") + a, std::string("out") + part,
                 std::string("back_side_") + b, std::string("out") + part);
    drawn.seam(std::string("front_side_") + a, "shoulder", std::string("back_side_") + b,
               "shoulder");
    drawn.seam("front_centre", std::string("shoulder_") + a, "back_centre",
               std::string("shoulder_") + b);
  }
  const Placed dress = place(drawn);
  EXPECT_EQ(dress.report.crossings + dress.report.vertices_inside + dress.report.faces_through, 0);
  EXPECT_LT(dress.gaps("front").back(), 0.03) << "the hems are 50 cm wider than the shoulders";
  EXPECT_LT(dress.gaps("back").back(), 0.03);
  EXPECT_GT(dress.middle_of("front_centre").z(), 0.1);
  EXPECT_LT(dress.middle_of("back_centre").z(), -0.1);
}

} // namespace
} // namespace sloper::pattern::test

#include <support/placement_patterns.hpp>
#include <support/straight_patterns.hpp>

#include <gtest/gtest.h>
#include <sloper/base/units.hpp>
#include <sloper/pattern/place/place_panels.hpp>

#include <cmath>

namespace sloper::pattern::test {
namespace {

/// Two of them in one pattern, not sewn to each other.
Pattern two_box_skirts(double inner, double outer) {
  Pattern both = box_skirt(inner);
  const Pattern other = box_skirt(outer);
  const int panels = std::ssize(both.panels);
  for (Panel panel : other.panels) {
    both.panels.push_back(std::move(panel));
    both.panels.back().name += "_over";
  }
  for (Seam seam : other.seams) {
    for (auto* side : {&seam.a, &seam.b})
      for (auto& part : *side)
        part.panel += panels;
    both.seams.push_back(std::move(seam));
    both.seams.back().name += "_over";
  }
  return both;
}

TEST(Placement, ALooseSkirtSlidesDownToWhereItsLengthFits) {
  const body::Body body = waisted_body();
  const Pattern pattern = box_skirt(42);
  PanelMesh mesh = mesh_pattern(pattern, 0.02, "t");
  const PlacementReport report = place_panels(pattern, body, mesh);
  // Its bottom row, 12 cm lower, is the first to be tight: the body measures 84 cm at 0.96 m.
  EXPECT_NEAR(top_of(mesh), 1.08, 0.03);
  EXPECT_EQ(report.crossings + report.vertices_inside + report.faces_through, 0);
}

TEST(Placement, ATightWaistbandStartsAtTheNarrowestPlace) {
  const body::Body body = waisted_body();
  const Pattern pattern = box_skirt(36);
  PanelMesh mesh = mesh_pattern(pattern, 0.02, "t");
  place_panels(pattern, body, mesh);
  EXPECT_NEAR(top_of(mesh), 1.05 + 0.06, 0.015)
      << "12 cm of cloth lie half above and half below the waist";
}

TEST(Placement, OfTwoSkirtsOneOverTheOtherTheNarrowerSaysWhereTheyHang) {
  const body::Body body = waisted_body();
  const Pattern one = box_skirt(36), two = two_box_skirts(36, 40);
  PanelMesh single = mesh_pattern(one, 0.02, "t"), both = mesh_pattern(two, 0.02, "t");
  place_panels(one, body, single);
  const PlacementReport report = place_panels(two, body, both);
  EXPECT_NEAR(top_of(both), top_of(single), 1e-6);
  EXPECT_EQ(report.crossings + report.vertices_inside + report.faces_through, 0);
}

TEST(Placement, ACircleSkirtHangsOnTheWaistInFoldsThoughItsSidesAreDrawnLevel) {
  std::string half =
      R"({"name": "skirt_front", "outline": [{"edge": "hem", "path": [["M", -50, 0], ["C", -50, -66, 50, -66, 50, 0]]},
    {"edge": "l", "path": [["L", 13, 0]]}, {"edge": "waist", "path": [["C", 13, -17, -13, -17, -13, 0]]}, {"edge": "r", "path": [["L", -50, 0]]}]})";
  std::string text =
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "skirt", "panels": [)" +
      half + ",";
  half.replace(half.find("front"), 5, "back");
  text +=
      half +
      R"(], "seams": [{"name": "a", "a": [{"panel": "skirt_front", "edge": "l"}], "b": [{"panel": "skirt_back", "edge": "r", "from": 1, "to": 0}]},
    {"name": "b", "a": [{"panel": "skirt_back", "edge": "l"}], "b": [{"panel": "skirt_front", "edge": "r", "from": 1, "to": 0}]}]})";
  const Pattern pattern = own(text);
  PanelMesh mesh = mesh_pattern(pattern, 0.02, "t");
  const PlacementReport report = place_panels(pattern, waisted_body(), mesh);
  EXPECT_EQ(report.crossings + report.vertices_inside + report.faces_through, 0);
  EXPECT_NEAR(top_of(mesh), 1.05, 0.15);
  double widest = 0, drawn = 0, placed = 0;
  for (const Vec3& p : mesh.placed)
    widest = std::max(widest, std::abs(p.x()));
  EXPECT_LT(widest, 0.45)
      << "it stays between the arms; laid on a cylinder it reaches out to 0.5 m";
  const auto& hem = mesh.panels[0].outline;
  for (std::size_t i = 0; i < hem.size(); ++i) {
    const int a = hem[i], b = hem[(i + 1) % hem.size()];
    drawn += (mesh.pattern[a] - mesh.pattern[b]).norm();
    placed += (mesh.placed[a] - mesh.placed[b]).norm();
  }
  EXPECT_NEAR(placed / drawn, 1, 0.1) << "folds take up what is too wide";
  for (const PanelInfo& panel : mesh.panels)
    EXPECT_TRUE(panel.in_folds) << panel.name;
}

TEST(Placement, ACircleSkirtThatIsStatedBelowTheChestIsNoCapeWhateverItsName) {
  // Its sides are drawn level, as shoulders are: it lay over the shoulders.
  const auto top_at = [](double height_cm) {
    const std::string place =
        R"("place": {"part": "torso", "theta_deg": THETA, "anchor": [0, 0], "height": )" +
        std::to_string(height_cm) + "}, ";
    std::string half =
        R"({"name": "front", PLACE "outline": [{"edge": "hem", "path": [["M", -50, 0], ["C", -50, -66, 50, -66, 50, 0]]},
    {"edge": "l", "path": [["L", 13, 0]]}, {"edge": "waist", "path": [["C", 13, -17, -13, -17, -13, 0]]}, {"edge": "r", "path": [["L", -50, 0]]}]})";
    half.replace(half.find("PLACE"), 5, place);
    std::string back = half;
    half.replace(half.find("THETA"), 5, "0");
    back.replace(back.find("THETA"), 5, "180");
    back.replace(back.find("front"), 5, "back");
    const Pattern pattern = own(
        R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "skirt", "panels": [)" +
        half + "," + back +
        R"(], "seams": [{"name": "a", "a": [{"panel": "front", "edge": "l"}], "b": [{"panel": "back", "edge": "r", "from": 1, "to": 0}]},
    {"name": "b", "a": [{"panel": "back", "edge": "l"}], "b": [{"panel": "front", "edge": "r", "from": 1, "to": 0}]}]})");
    PanelMesh mesh = mesh_pattern(pattern, 0.02, "t");
    place_panels(pattern, waisted_body(), mesh);
    return top_of(mesh);
  };
  EXPECT_NEAR(top_at(105), 1.05, 0.15);
  EXPECT_GT(top_at(145), 1.3) << "a cape, by its height";
}

/// A circle skirt in two panels on a waistband, as GarmentCode draws it: half circles in front and
/// behind, or 320 degrees each, whose sides are drawn upwards; with a second tier at their hem.
class TieredSkirt {
public:
  /// @param spread_deg  of each panel of the upper tier
  /// @param longer_m    by which the middle of the lower tier's back is longer than its sides
  TieredSkirt(double spread_deg, double longer_m) {
    const double spread = spread_deg * units::PI / 180, inner = WAIST / (2 * spread);
    const double hem = spread * (inner + LENGTH);
    for (const bool front : {true, false}) {
      const std::string name = front ? "front" : "back";
      add_band(name);
      add_sector("skirt_" + name, spread, inner, 0);
      add_sector("skirt_tier_" + name, units::PI, hem / units::PI, front ? -longer_m : longer_m);
      sew("waistband_" + name, "hem", "skirt_" + name, "waist");
      sew("skirt_" + name, "hem", "skirt_tier_" + name, "waist");
    }
    for (const std::string& piece :
         {std::string("waistband"), std::string("skirt"), std::string("skirt_tier")}) {
      sew(piece + "_front", "left", piece + "_back", "right");
      sew(piece + "_back", "left", piece + "_front", "right");
    }
  }

  Pattern pattern() const {
    return own(R"({"format": "pattern", "version": 1, "length_unit": "m", "name": "skirt", )"
               R"("panels": [)" +
               m_panels + R"(], "seams": [)" + m_seams + "]}");
  }

  static constexpr double WAIST = 0.84, LENGTH = 0.25, BAND = 0.06; // m

private:
  static std::string point(double x, double y) {
    return std::to_string(x) + ", " + std::to_string(y);
  }

  void add(const std::string& name, const std::string& outline) {
    m_panels += (m_panels.empty() ? "" : ", ") + (R"({"name": ")" + name) + R"(", "outline": [)" +
                outline + "]}";
  }

  void add_band(const std::string& name) {
    const double half = 0.25 * WAIST;
    add("waistband_" + name,
        R"({"edge": "hem", "path": [["M", )" + point(-half, 0) + R"(], ["L", )" + point(half, 0) +
            R"(]]}, {"edge": "right", "path": [["L", )" + point(half, BAND) +
            R"(]]}, {"edge": "top", "path": [["L", )" + point(-half, BAND) +
            R"(]]}, {"edge": "left", "path": [["L", )" + point(-half, 0) + "]]}");
  }

  /// The tip is at (0, 0), and the middle straight below it.
  void add_sector(const std::string& name, double spread, double inner, double longer) {
    constexpr int STEPS = 60;
    std::string hem, waist;
    for (int i = 0; i <= STEPS; ++i) {
      const double phi = spread * (static_cast<double>(i) / STEPS - 0.5);
      const double r = inner + LENGTH + longer * std::pow(std::cos(phi * units::PI / spread), 2);
      hem += (i == 0 ? R"(["M", )" : R"(, ["L", )") + point(r * std::sin(phi), -r * std::cos(phi)) +
             "]";
      waist += (i == 0 ? R"(["L", )" : R"(, ["L", )") +
               point(-inner * std::sin(phi), -inner * std::cos(phi)) + "]";
    }
    const std::string corner =
        point(inner * std::sin(0.5 * spread), -inner * std::cos(0.5 * spread));
    const std::string first = point(-(inner + LENGTH) * std::sin(0.5 * spread),
                                    -(inner + LENGTH) * std::cos(0.5 * spread));
    add(name, R"({"edge": "hem", "path": [)" + hem + R"(]}, {"edge": "right", "path": [["L", )" +
                  corner + R"(]]}, {"edge": "waist", "path": [)" +
                  waist.substr(waist.find(']') + 3) + R"(]}, {"edge": "left", "path": [["L", )" +
                  first + "]]}");
  }

  void sew(const std::string& a, const std::string& edge_a, const std::string& b,
           const std::string& edge_b) {
    m_seams += (m_seams.empty() ? "" : ", ") + (R"({"name": ")" + a) + edge_a +
               R"(", "a": [{"panel": ")" + a + R"(", "edge": ")" + edge_a +
               R"("}], "b": [{"panel": ")" + b + R"(", "edge": ")" + edge_b +
               R"(", "from": 1, "to": 0}]})";
  }

  std::string m_panels, m_seams;
};

double widest_gap(const PanelMesh& mesh) {
  double gap = 0;
  for (const MeshSeam& seam : mesh.seams)
    for (std::size_t i = 0; i < seam.a.size(); ++i)
      gap = std::max(gap, (mesh.placed[seam.a[i]] - mesh.placed[seam.b[i]]).norm());
  return gap;
}

TEST(Placement, ATierThatIsLongerBehindThanAtItsSidesIsLaidInFoldsAsItsFrontIs) {
  const Pattern pattern = TieredSkirt(180, 0.12).pattern();
  PanelMesh mesh = mesh_pattern(pattern, 0.02, "t");
  const PlacementReport report = place_panels(pattern, waisted_body(), mesh);
  EXPECT_EQ(report.crossings + report.vertices_inside + report.faces_through, 0);
  for (const PanelInfo& panel : mesh.panels) {
    double widest = 0;
    for (int v : panel.outline)
      widest = std::max(widest, std::abs(mesh.placed[v].x()));
    EXPECT_LT(widest, 0.55) << panel.name << ", which reaches 0.8 m aside as it is drawn";
  }
  EXPECT_LT(widest_gap(mesh), 0.25);
}

TEST(Placement, ASkirtOfMoreThanACircleStartsBelowItsWaistbandAndItsTierBelowItsHem) {
  const Pattern pattern = TieredSkirt(320, 0).pattern();
  PanelMesh mesh = mesh_pattern(pattern, 0.02, "t");
  const PlacementReport report = place_panels(pattern, waisted_body(), mesh);
  EXPECT_EQ(report.crossings + report.vertices_inside + report.faces_through, 0);
  EXPECT_LT(widest_gap(mesh), 0.25) << "its sides are drawn upwards by 25 cm";
}

/// A skirt of four panels with side seams in two lengths and middle seams that leave each other
/// above the hip, sewn to a waistband.
Pattern four_panel_skirt() {
  std::string
      text =
          R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "skirt", "panels": [)",
      seams;
  for (const char* name : {"front_l", "front_r", "back_r", "back_l"}) {
    const bool left = std::string(name) == "front_l" ||
                      std::string(name) == "back_r"; // its side seam is on the right as it is drawn
    const std::string theta = std::string(name).find("front") == 0 ? "45" : "225";
    text += R"({"name": ")" + std::string(name) + R"(", "place": {"part": "torso", "theta_deg": )" +
            (left ? "" : "-") + theta + R"(}, "outline": [)";
    if (left)
      text +=
          R"({"edge": "hem", "path": [["M", 0, 0], ["L", 28, 0]]}, {"edge": "side", "path": [["L", 26, 36]]}, {"edge": "side_hip", "path": [["L", 20, 56]]},
        {"edge": "waist", "path": [["L", 3, 56]]}, {"edge": "middle_hip", "path": [["L", 0, 36]]}, {"edge": "middle", "path": [["L", 0, 0]]}]},)";
    else
      text +=
          R"({"edge": "hem", "path": [["M", -28, 0], ["L", 0, 0]]}, {"edge": "middle", "path": [["L", 0, 36]]}, {"edge": "middle_hip", "path": [["L", -3, 56]]},
        {"edge": "waist", "path": [["L", -20, 56]]}, {"edge": "side_hip", "path": [["L", -26, 36]]}, {"edge": "side", "path": [["L", -28, 0]]}]},)";
  }
  for (const char* name : {"band_front", "band_back"})
    text +=
        R"({"name": ")" + std::string(name) + R"(", "place": {"part": "torso", "theta_deg": )" +
        (std::string(name) == "band_front" ? "0" : "180") +
        R"(, "anchor": [0, 0], "height": 105}, "outline": [{"edge": "r", "path": [["M", -17, 4], ["L", -17, 0]]}, {"edge": "low_r", "path": [["L", 0, 0]]},
            {"edge": "low_l", "path": [["L", 17, 0]]}, {"edge": "l", "path": [["L", 17, 4]]}, {"edge": "top", "path": [["L", -17, 4]]}]})" +
        (std::string(name) == "band_front" ? "," : "");
  const auto sew = [&](const std::string& a, const std::string& edge_a, const std::string& b,
                       const std::string& edge_b, bool against) {
    seams += std::string(seams.empty() ? "" : ",") + R"({"name": ")" + a + edge_a +
             R"(", "a": [{"panel": ")" + a + R"(", "edge": ")" + edge_a +
             R"("}], "b": [{"panel": ")" + b + R"(", "edge": ")" + edge_b +
             (against ? R"("}]})" : R"(", "from": 0, "to": 1}]})");
  };
  for (const char* edge : {"side", "side_hip"}) {
    sew("front_l", edge, "back_l", edge, true);
    sew("front_r", edge, "back_r", edge, true);
  }
  for (const char* edge : {"middle", "middle_hip"}) {
    sew("front_l", edge, "front_r", edge, true);
    sew("back_l", edge, "back_r", edge, true);
  }
  sew("front_l", "waist", "band_front", "low_l", true);
  sew("front_r", "waist", "band_front", "low_r", true);
  sew("back_r", "waist", "band_back", "low_l", true);
  sew("back_l", "waist", "band_back", "low_r", true);
  sew("band_front", "l", "band_back", "r", true);
  sew("band_front", "r", "band_back", "l", true);
  return own(text + R"(], "seams": [)" + seams + "]}");
}

TEST(Placement, ASkirtWhoseSideSeamsAreInTwoLengthsHasNoLegsAndItsHalvesHangBothSidesOfItsMiddle) {
  const Pattern pattern = four_panel_skirt();
  PanelMesh mesh = mesh_pattern(pattern, 0.02, "t");
  const PlacementReport report = place_panels(pattern, waisted_body(), mesh);
  EXPECT_EQ(report.crossings + report.vertices_inside + report.faces_through, 0);
  for (const PanelInfo& info : mesh.panels)
    EXPECT_EQ(info.part, "torso") << info.name;
  for (const int k : {0, 2}) { // front_l and front_r, back_r and back_l
    const Vec3 a = middle(mesh, k), b = middle(mesh, k + 1);
    EXPECT_NEAR(a.x() + b.x(), 0, 0.005);
    EXPECT_GT(std::abs(a.x()), 0.08);
  }
}

/// A skirt of gores as CAD lays pieces: along x, every other one upside down; their names tell
/// nothing.
Pattern lying_gores(int n) {
  std::string
      text =
          R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "gores", "panels": [)",
      seams;
  for (int k = 0; k < n; ++k) {
    const Eigen::Rotation2Dd turn(k % 2 ? M_PI / 2 : -M_PI / 2);
    const auto point = [&](double x, double y) {
      const Vec2 p = turn * Vec2(x, y);
      return std::to_string(p.x()) + ", " + std::to_string(p.y());
    };
    const Vec2 grain = turn * Vec2(0, 1);
    const std::string name = "piece " + std::to_string(k);
    text += std::string(k ? "," : "") + R"({"name": ")" + name + R"(", "grain": [)" +
            std::to_string(grain.x()) + "," + std::to_string(grain.y()) +
            R"(], "outline": [{"edge": "hem", "path": [["M", )" + point(-19, 0) + R"(], ["L", )" +
            point(19, 0) + R"(]]}, {"edge": "a", "path": [["L", )" + point(13, 50) +
            R"(]]}, {"edge": "top", "path": [["L", )" + point(-13, 50) +
            R"(]]}, {"edge": "b", "path": [["L", )" + point(-19, 0) + "]]}]}";
    seams += std::string(k ? "," : "") + R"({"name": "s)" + std::to_string(k) +
             R"(", "a": [{"panel": ")" + name + R"(", "edge": "a"}], "b": [{"panel": "piece )" +
             std::to_string((k + 1) % n) + R"(", "edge": "b"}]})";
  }
  return own(text + R"(], "seams": [)" + seams + "]}");
}

TEST(Placement, GoresThatLieAlongTheClothStandUprightInARing) {
  for (int n : {3, 4, 6}) {
    SCOPED_TRACE(n);
    const Pattern pattern = lying_gores(n);
    PanelMesh mesh = mesh_pattern(pattern, 0.02, "t");
    const PlacementReport report = place_panels(pattern, waisted_body(), mesh);
    EXPECT_EQ(report.crossings + report.vertices_inside + report.faces_through, 0);
    EXPECT_LT(report.seam_gap_mean, 0.15);
    for (const PanelInfo& info : mesh.panels) { // wide at the bottom
      double width[2] = {0, 0};
      for (int v : info.outline)
        for (int w : info.outline) {
          const Vec3 &p = mesh.placed[v], &q = mesh.placed[w];
          const Vec3 middle_of = middle(mesh, static_cast<int>(&info - mesh.panels.data()));
          double& most = width[p.y() > middle_of.y()];
          if ((p.y() > middle_of.y()) == (q.y() > middle_of.y()))
            most = std::max(most, (p - q).norm());
        }
      EXPECT_GT(width[0], width[1]) << info.name;
    }
  }
}

TEST(Placement, APanelOfAnOuterLayerLiesOverTheOneThatItIsSewnTo) {
  std::string text =
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "skirt", "panels": [)" +
      rectangle("skirt_front", 46, 40) + "," + rectangle("skirt_back", 46, 40) + "," +
      rectangle("skirt_overlay_front", 30, 25) +
      R"(], "seams": [{"name": "a", "a": [{"panel": "skirt_front", "edge": "l"}], "b": [{"panel": "skirt_back", "edge": "r"}]},
      {"name": "b", "a": [{"panel": "skirt_back", "edge": "l"}], "b": [{"panel": "skirt_front", "edge": "r"}]},
      {"name": "c", "a": [{"panel": "skirt_front", "edge": "top", "from": 0.2, "to": 0.8}], "b": [{"panel": "skirt_overlay_front", "edge": "top", "from": 0, "to": 1}]}]})";
  const std::string overlay = R"({"name": "skirt_overlay_front", )";
  text.replace(text.find(overlay), overlay.size(), overlay + R"("layer": 1, )");
  const Pattern pattern = own(text);
  PanelMesh mesh = mesh_pattern(pattern, 0.02, "t");
  const PlacementReport report = place_panels(pattern, waisted_body(), mesh);
  EXPECT_EQ(report.crossings + report.vertices_inside + report.faces_through, 0);
  for (const MeshSeam& s : mesh.seams) {
    if (s.name != "c")
      continue;
    for (std::size_t k = 0; k < s.a.size(); ++k) {
      const Vec3 &under = mesh.placed[s.a[k]], &over = mesh.placed[s.b[k]];
      EXPECT_NEAR((over - under).norm(), 0.012, 0.01);
      EXPECT_GT(over.z(), under.z());
    }
  }
}

TEST(Placement, ASkirtInQuartersIsNoTrousersThoughItsSidesAreDrawnInTwoEdges) {
  DrawnPattern skirt; // the upper part of a side is more than a third of it
  skirt.quarters({{"hem", 30, -55},
                  {"side", 25, -20},
                  {"side_hip", 22, 0},
                  {"waist", 0, 0},
                  {"middle_hip", 0, -20},
                  {"middle", 0, -55}},
                 {"side", "side_hip"}, {"middle", "middle_hip"});
  const Pattern pattern = skirt.pattern();
  PanelMesh mesh = mesh_pattern(pattern, 0.02, "t");
  const PlacementReport report = place_panels(pattern, waisted_body(), mesh);
  for (const PanelInfo& panel : mesh.panels)
    EXPECT_EQ(panel.part, "torso") << panel.name;
  EXPECT_EQ(report.crossings + report.vertices_inside + report.faces_through, 0);
}

TEST(Placement, AWholeCircleInThreeSectorsStandsAroundTheBodyInOneRow) {
  const double waist = 11.5, hem = 61.5, turn = M_PI / 3; // cm; half of a third of a circle
  const auto at = [&](double radius, double angle) {
    return std::to_string(radius * std::sin(angle)) + ", " +
           std::to_string(-radius * std::cos(angle));
  };
  std::string panels, seams;
  for (int k = 0; k < 3; ++k) {
    const std::string name = "skirt_panel_" + std::to_string(k),
                      next = "skirt_panel_" + std::to_string((k + 1) % 3), comma = k ? ", " : "";
    panels += comma + R"({"name": ")" + name + R"(", "outline": [{"edge": "hem", "path": [["M", )" +
              at(hem, -turn) + R"(], ["A", )" + std::to_string(hem) + ", 0, 1, " + at(hem, turn) +
              R"(]]}, {"edge": "l", "path": [["L", )" + at(waist, turn) +
              R"(]]}, {"edge": "waist", "path": [["A", )" + std::to_string(waist) + ", 0, 0, " +
              at(waist, -turn) + R"(]]}, {"edge": "r", "path": [["L", )" + at(hem, -turn) + "]]}]}";
    seams += comma + R"({"name": "s)" + std::to_string(k) + R"(", "a": [{"panel": ")" + name +
             R"(", "edge": "l"}], "b": [{"panel": ")" + next +
             R"(", "edge": "r", "from": 1, "to": 0}]})";
  }
  const Pattern pattern =
      own(R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "n", "panels": [)" +
          panels + R"(], "seams": [)" + seams + "]}");
  PanelMesh mesh = mesh_pattern(pattern, 0.03, "t");
  const PlacementReport report = place_panels(pattern, waisted_body(), mesh);
  EXPECT_TRUE(report.impossible.empty());
  EXPECT_LT(report.seam_gap_mean, 0.1);
  for (int k = 1; k < 3; ++k)
    EXPECT_NEAR(middle(mesh, k).y(), middle(mesh, 0).y(), 0.05);
}

} // namespace
} // namespace sloper::pattern::test

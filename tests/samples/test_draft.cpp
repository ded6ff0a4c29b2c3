/// The drafts: outlines that do not cross, seams that fit, for a range of people.
#include <gtest/gtest.h>
#include <mannequin.hpp>
#include <measures.hpp>
#include <support/made_figure.hpp>
using namespace sloper;
using namespace sloper::samples;

using Drafter = Draft (*)(const Measures&);
struct DraftedGarment {
  const char* name;
  Drafter draft;
};

namespace {

Draft draft_band_shirt(const Measures& m) {
  Draft d = draft_shirt(m);
  d.remove("collar");
  return d;
}
Draft draft_wide_skirt(const Measures& m) {
  return draft_flared_skirt(m, 0.1);
}
const DraftedGarment GARMENTS[] = {
    {"shirt", draft_shirt}, {"band_shirt", draft_band_shirt}, {"tshirt", draft_tshirt},
    {"skirt", draft_skirt}, {"wide_skirt", draft_wide_skirt}, {"trousers", draft_trousers}};

} // namespace

class EveryGarment : public testing::TestWithParam<DraftedGarment> {};

namespace {

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines)
    text += line + "; ";
  return text;
}

} // namespace

TEST_P(EveryGarment, is_sound_for_people_of_many_shapes) {
  for (double stature : {1.50, 1.65, 1.80, 1.95})
    for (double size : {0.85, 1.0, 1.2, 1.4}) {
      Measures m;
      for (const auto& [name, member] : measure_names())
        m.*member *= stature / 1.65;
      m.bust *= size;
      m.waist *= size * size;
      m.hip *= size;
      m.neck *= std::sqrt(size);
      m.upper_arm *= size;
      const std::vector<std::string> faults = draft_faults(GetParam().draft(m));
      EXPECT_TRUE(faults.empty()) << stature << " " << size << ": " << joined(faults);
    }
}

TEST_P(EveryGarment, sews_every_edge_at_most_once) {
  const Draft d = GetParam().draft(Measures{});
  std::map<std::string, int> uses;
  for (const DraftSeam& s : d.seams) {
    ++uses[s.panel_a + "." + s.edge_a];
    ++uses[s.panel_b + "." + s.edge_b];
  }
  for (const auto& [edge, n] : uses)
    EXPECT_EQ(n, 1) << edge;
}

TEST_P(EveryGarment, is_the_same_left_and_right) {
  const Draft d = GetParam().draft(Measures{});
  for (const DraftPanel& p : d.panels)
    if (p.name.size() > 2 && p.name.substr(p.name.size() - 2) == "_l") {
      const DraftPanel& other = d.panel(p.name.substr(0, p.name.size() - 2) + "_r");
      for (const DraftEdge& e : p.edges)
        EXPECT_NEAR(edge_length(p, e.name), edge_length(other, e.name), 1e-9)
            << p.name << "." << e.name;
    }
}

INSTANTIATE_TEST_SUITE_P(garments, EveryGarment, testing::ValuesIn(GARMENTS),
                         [](const auto& garment) { return std::string(garment.param.name); });

TEST(draft, the_shirt_has_its_ease_at_the_bust_and_its_neckline) {
  Measures m;
  const Draft d = draft_shirt(m);
  const DraftPanel& front = d.panel("front_l");
  const double quarter = front.points[2].x();
  EXPECT_NEAR(4 * quarter - m.bust, 0.10, 1e-9);
  const double neck = 2 * edge_length(front, "neck") + edge_length(d.panel("yoke"), "neck");
  EXPECT_GT(neck, m.neck);
  EXPECT_LT(neck, m.neck * 1.3);
}

TEST(draft, the_skirt_band_goes_round_the_waist_and_the_skirt_over_the_hip) {
  Measures m;
  const Draft d = draft_skirt(m);
  EXPECT_NEAR(edge_length(d.panel("band_front"), "top") + edge_length(d.panel("band_back"), "top"),
              m.waist, 0.02);
  EXPECT_GT(4 * (d.panel("front_l").points[2] - d.panel("front_l").points[5]).norm(), m.hip);
}

TEST(draft, trousers_go_around_the_thigh_and_between_the_legs_of_the_body_they_are_for) {
  for (const double crotch_length : {0.0, 0.70, 0.76, 0.85})
    for (const double thigh : {0.55, 0.75}) {
      Measures m;
      m.crotch_length = crotch_length;
      m.thigh = thigh;
      const Draft d = draft_trousers(m);
      const DraftPanel &front = d.panel("front_l"), &back = d.panel("back_r");
      double length = 0.035; // of the waistband, half of it in front and half behind
      for (const DraftPanel* p : {&front, &back})
        length += edge_length(*p, "middle") + edge_length(*p, "crotch");
      EXPECT_GT(length, m.crotch()) << crotch_length;
      double around = 0; // at the hip from the side to the end of the crotch, before and behind
      for (const DraftPanel* p : {&front, &back})
        around += p->points[edge_index(*p, "side_hip")].x() -
                  p->points[edge_index(*p, "inside_thigh")].x();
      EXPECT_GT(around, thigh);
      EXPECT_TRUE(draft_faults(d).empty()) << joined(draft_faults(d));
    }
}

TEST(draft, sides_of_trousers_come_in_gently_and_darts_take_the_rest) {
  for (const double waist : {0.66, 0.74, 0.98}) {
    Measures m;
    m.waist = waist;
    const Draft d = draft_trousers(m);
    for (const char* name : {"front_l", "back_r"}) {
      const DraftPanel& p = d.panel(name);
      const auto n = static_cast<int>(p.points.size());
      const int side = edge_index(p, "side_hip");
      const Vec2 seam = p.points[(side + 1) % n] - p.points[side];
      EXPECT_LT(-seam.x(), 0.2 * seam.y()) << name << waist;
      const bool darts = n > 9;
      EXPECT_EQ(darts, waist < 0.9) << name << waist;
      if (darts) {
        EXPECT_NEAR(edge_length(p, "dart_outer"), edge_length(p, "dart_inner"), 1e-9);
      }
    }
    EXPECT_NEAR(edge_length(d.panel("band_front"), "top") +
                    edge_length(d.panel("band_back"), "top"),
                waist, 0.03);
    EXPECT_TRUE(draft_faults(d).empty()) << joined(draft_faults(d));
  }
}

TEST(draft, armholes_end_below_the_arm_pits_of_the_tall) {
  for (const double scye_depth : {0.15, 0.20, 0.235}) {
    Measures m;
    m.scye_depth = scye_depth;
    const DraftPanel shirt = draft_shirt(m).panel("front_l"),
                     tshirt = draft_tshirt(m).panel("front");
    for (const DraftPanel* p : {&shirt, &tshirt})
      EXPECT_LT(p->points[2].y(), -scye_depth - 0.06) << p->name;
  }
}

TEST(draft, a_split_edge_keeps_its_shape_and_parts_its_length) {
  DraftPanel p{"p",
               {{0, 0}, {1, 0}, {0, 1}},
               {{"a", {}}, {"b", {Vec2(1, 0.5), Vec2(0.5, 1)}}, {"c", {}}},
               Vec2(0, 1),
               {}};
  const double whole = edge_length(p, "b");
  split_edge(p, "b", 0.3, "b1", "b2");
  EXPECT_NEAR(edge_length(p, "b1"), 0.3 * whole, 1e-4);
  EXPECT_NEAR(edge_length(p, "b1") + edge_length(p, "b2"), whole, 1e-4);
}

TEST(draft, faults_are_found) {
  Draft d{"bad", {}, {}};
  d.add({"bow",
         {{0, 0}, {1, 1}, {1, 0}, {0, 1}},
         {{"a", {}}, {"b", {}}, {"c", {}}, {"d", {}}},
         Vec2(0, 1),
         {}});
  d.add({"square",
         {{0, 0}, {2, 0}, {2, 2}, {0, 2}},
         {{"a", {}}, {"b", {}}, {"c", {}}, {"d", {}}},
         Vec2(0, 1),
         {}});
  d.sew("bow", "b", "square", "b");
  EXPECT_GE(draft_faults(d).size(), 2u);
}

TEST(measures, a_mannequin_gives_its_own_measures) {
  const Measures m = measures_from_body(test::made_figure("f-165-a").truth, "f-165-a");
  EXPECT_NEAR(m.stature, 1.65, 1e-3);
  EXPECT_NEAR(m.waist, 0.74, 0.02);
  EXPECT_NEAR(m.bust, 0.93, 0.03);
  EXPECT_NEAR(m.scye_depth, 0.20, 0.03);
  EXPECT_GT(m.arm_length, 0.45);
  EXPECT_LT(m.arm_length, 0.65);
  for (const DraftedGarment& g : GARMENTS)
    EXPECT_TRUE(draft_faults(g.draft(m)).empty()) << g.name;
}

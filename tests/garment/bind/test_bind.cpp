#include <support/skin_garment.hpp>

#include <garment/bind/bind_frames.hpp>
#include <sloper/base/error.hpp>
#include <sloper/collision/body_collider.hpp>
#include <sloper/garment/bind/bind.hpp>

#include <gtest/gtest.h>

namespace sloper::garment {

namespace {

double largest_difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    most = std::max(most, (a[i] - b[i]).norm());
  return most;
}

std::set<std::string> frames_used(const Garment& g) {
  std::set<std::string> names;
  for (const auto& weights : g.bind.particles)
    for (const BindWeight& w : weights)
      names.insert(g.bind.frames[w.frame]);
  return names;
}

/// Share of the particles that lie inside a body by more than `depth`.
double share_inside(const std::vector<Vec3>& positions, const body::Body& body, double depth) {
  const collision::BodyCollider skin(body.skin);
  double n = 0;
  for (const Vec3& p : positions)
    n += skin.signed_distance(p, 0.2).distance < -depth;
  return n / static_cast<double>(positions.size());
}

} // namespace

TEST(bind, a_garment_bound_and_placed_on_the_same_body_does_not_move) {
  const body::Body body = measured("f-165-a");
  for (Garment g : {skin_shirt(body), skin_trousers(body), tube_skirt(body)}) {
    bind_garment(g, body);
    EXPECT_LT(largest_difference(place_garment(g, body), g.position), 1e-9);
  }
}

TEST(bind, weights_are_positive_and_sum_to_one) {
  const body::Body body = measured("f-165-a");
  Garment g = skin_shirt(body);
  bind_garment(g, body);
  for (const auto& weights : g.bind.particles) {
    double sum = 0;
    for (const BindWeight& w : weights) {
      EXPECT_GT(w.weight, 0);
      sum += w.weight;
    }
    EXPECT_NEAR(sum, 1, 1e-12);
  }
}

TEST(bind, weights_change_little_from_one_particle_to_the_next) {
  const body::Body body = measured("f-165-a");
  Garment g = skin_shirt(body);
  bind_garment(g, body);
  const auto weight_on = [&](int i, int frame) {
    for (const BindWeight& w : g.bind.particles[i])
      if (w.frame == frame)
        return w.weight;
    return 0.0;
  };
  double steepest = 0; // per metre
  for (const auto& [i, j] : edges_of(g.particle_triangles()))
    for (int k = 0; k < std::ssize(g.bind.frames); ++k)
      steepest = std::max(steepest, std::abs(weight_on(i, k) - weight_on(j, k)) /
                                        std::max((g.position[i] - g.position[j]).norm(), 0.005));
  EXPECT_LT(steepest,
            25); // a border without blending would be 1 over an edge of 18 mm: more than 50
}

TEST(bind, a_shirt_on_a_larger_body_is_stretched_but_not_torn) {
  const body::Body from = measured("f-165-a"), to = measured("m-185-t");
  Garment g = skin_shirt(from);
  bind_garment(g, from);
  const std::vector<Vec3> placed = place_garment(g, to);
  const auto [shortest, longest] = edge_ratios(g, g.position, placed);
  EXPECT_GT(shortest, 0.25); // in the arm pit, whose fold opens from A to T stance
  EXPECT_LT(longest, 2.5);
  EXPECT_LT(share_inside(placed, to, 0.01), 0.03);
}

TEST(bind, sleeves_follow_arms_from_t_to_a_stance_and_back) {
  samples::Mannequin shape = samples::preset("f-172-t");
  const body::Body t = measured(shape);
  shape.arm_deg = 40;
  const body::Body a = measured(shape);
  ASSERT_GT(t.arm_l_deg, a.arm_l_deg + 20);
  for (const auto& [from, to] : {std::pair{&t, &a}, std::pair{&a, &t}}) {
    Garment g = skin_shirt(*from, 0.012);
    bind_garment(g, *from);
    const std::vector<Vec3> placed = place_garment(g, *to);
    EXPECT_LT(share_inside(placed, *to, 0.01), 0.03);
    // The lowest point of a sleeve's end is as near to the wrist as it was.
    const auto nearest = [](const std::vector<Vec3>& x, const Vec3& p) {
      double best = 1e300;
      for (const Vec3& q : x)
        best = std::min(best, (q - p).norm());
      return best;
    };
    for (const char* wrist : {"wrist_l", "wrist_r"})
      EXPECT_NEAR(nearest(placed, to->landmark(wrist)), nearest(g.position, from->landmark(wrist)),
                  0.02);
  }
}

TEST(bind, a_skirt_hangs_on_both_legs_together_and_stays_one_round_tube) {
  const body::Body from = measured("f-165-a"), to = measured("m-170-stout");
  Garment g;
  for (const double depth : {0.3, 0.83}) { // a narrow skirt is as flat as the legs, and the farther
                                           // apart they are, the flatter
    g = tube_skirt(from, 0.06, depth);
    bind_garment(g, from);
    const std::set<std::string> used = frames_used(g);
    EXPECT_TRUE(used.count("lower_body")) << depth;
    EXPECT_FALSE(used.count("leg_l") || used.count("leg_r")) << depth;
  }
  const std::vector<Vec3> placed = place_garment(g, to);
  const auto [shortest, longest] = edge_ratios(g, g.position, placed);
  EXPECT_GT(shortest, 0.5);
  EXPECT_LT(longest, 2.0);
}

TEST(bind, trousers_hang_on_each_leg_by_itself) {
  const body::Body from = measured("f-165-a"), to = measured("m-178-a");
  Garment g = skin_trousers(from);
  bind_garment(g, from);
  const std::set<std::string> used = frames_used(g);
  EXPECT_TRUE(used.count("leg_l") && used.count("leg_r"));
  const std::vector<Vec3> placed = place_garment(g, to);
  const auto [shortest, longest] = edge_ratios(g, g.position, placed);
  EXPECT_GT(shortest, 0.4);
  EXPECT_LT(longest, 2.2);
  EXPECT_LT(share_inside(placed, to, 0.01), 0.03);
}

TEST(bind, levels_go_to_their_like) {
  const body::Body from = measured("f-165-a"), to = measured("m-178-a");
  Garment g = skin_shirt(from);
  bind_garment(g, from);
  const std::vector<Vec3> placed = place_garment(g, to);
  for (const char* level : {"waist_semantic", "bust"}) {
    double sum = 0, n = 0;
    for (std::size_t i = 0; i < placed.size(); ++i)
      if (std::abs(g.position[i].x()) < 0.1 &&
          std::abs(g.position[i].y() - from.levels.at(level).y) < 0.01) {
        sum += placed[i].y();
        ++n;
      }
    ASSERT_GT(n, 5);
    EXPECT_NEAR(sum / n, to.levels.at(level).y, 0.02) << level;
  }
}

TEST(bind, a_waist_whose_places_lie_the_other_way_round_is_met_between_them) {
  body::Body from = measured("f-165-a"), to = measured("f-172-t");
  const auto height = [](const body::Body& body, const char* level) {
    return body.levels.at(level).y;
  };
  from.levels.at("waist_semantic").y = height(from, "waist_girth_min") - 0.02;
  to.levels.at("waist_semantic").y = height(to, "waist_girth_min") + 0.02;
  Garment g = skin_shirt(from);
  bind_garment(g, from);
  const std::vector<Vec3> placed = place_garment(g, to, Waist::OF_ALL);
  for (const auto& [level, off] : {std::pair{"waist_semantic", 0.04},
                                   std::pair{"waist_girth_min", 0.02}}) { // which is the surer one
    double sum = 0, n = 0;
    for (std::size_t i = 0; i < placed.size(); ++i)
      if (std::abs(g.position[i].x()) < 0.1 &&
          std::abs(g.position[i].y() - height(from, level)) < 0.01) {
        sum += placed[i].y();
        ++n;
      }
    ASSERT_GT(n, 5);
    EXPECT_NEAR(sum / n, height(to, level), off) << level;
  }
}

TEST(bind, a_sleeveless_top_goes_on_a_body_without_arms) {
  const body::Body whole = measured("f-165-a"), armless = without_arms(measured("f-172-t"));
  Garment g = skin_garment(whole, {body::Part::TORSO}, whole.levels.at("hip").y,
                           whole.landmark("axilla_l").y() - 0.02, 0.01);
  bind_garment(g, whole);
  const std::vector<Vec3> placed = place_garment(g, armless);
  for (const Vec3& p : placed)
    ASSERT_TRUE(p.allFinite());
  EXPECT_LT(share_inside(placed, armless, 0.01), 0.03);
}

TEST(bind, a_shirt_on_a_body_without_arms_is_refused_by_name) {
  const body::Body whole = measured("f-165-a");
  Garment g = skin_shirt(whole);
  bind_garment(g, whole);
  try {
    place_garment(g, without_arms(whole));
    FAIL() << "placed";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("arm"), std::string::npos) << e.what();
  }
}

TEST(bind, an_unsewn_garment_hangs_on_nothing) {
  Garment g;
  EXPECT_THROW(bind_garment(g, measured("f-165-a")), Error);
  EXPECT_THROW(place_garment(g, measured("f-165-a")), Error);
}

TEST(mark_map, it_is_the_identity_between_equal_bodies_and_monotone_between_others) {
  const std::map<std::string, double>
      a = {{"hip", 0.1}, {"waist", 0.4}, {"bust", 0.65}, {"neck_side", 1.0}},
      b = {{"hip", 0.0}, {"waist", 0.5}, {"bust", 0.6}, {"neck_side", 1.1}};
  const MarkMap same(a, 0.5, a, 0.5), other(a, 0.5, b, 0.6);
  double before = -1e300;
  for (double z = -1; z < 2; z += 0.001) {
    EXPECT_NEAR(same(z), z, 1e-12);
    const double now = other(z);
    EXPECT_GT(now, before) << z;
    before = now;
  }
  EXPECT_NEAR(other(0.4), 0.5, 1e-12);
}

TEST(mark_map, a_waist_lies_where_what_both_bodies_tell_of_it_does_on_average) {
  const std::map<std::string, double>
      a = {{"crotch", 0}, {"waist", 0.40}, {"waist_girth_min", 0.44}, {"bust", 0.7}},
      b = {{"crotch", 0}, {"waist", 0.44}, {"waist_girth_min", 0.40}, {"bust", 0.7}},
      c = {{"crotch", 0}, {"waist", 0.43}, {"waist_width_min", 0.5}, {"bust", 0.7}};
  const double surer = 0.04 * 9 / 13; // the least girth is told to 1 cm, the proportion to 1.5
  const auto waists = [&](const Marks& to) {
    const auto [from, there] = with_one_waist(a, to);
    return std::pair(from.at("waist"), there.at("waist"));
  };
  EXPECT_NEAR(waists(b).first, 0.40 + surer, 1e-12);
  EXPECT_NEAR(waists(b).second, 0.44 - surer, 1e-12);
  EXPECT_EQ(waists(c), std::pair(0.40, 0.43)) << "the one that both have";
  EXPECT_EQ(with_one_waist(a, {{"crotch", 0.0}}).first.count("waist"), 0u);
}

TEST(mark_map, marks_in_another_order_on_the_other_body_do_not_fold_the_cloth) {
  const std::map<std::string, double> a = {{"hip", 0.1}, {"waist", 0.4}, {"bust", 0.65}},
                                      b = {{"hip", 0.1}, {"waist", 0.8}, {"bust", 0.6}};
  const MarkMap map(a, 0.5, b, 0.5);
  double before = -1e300;
  for (double z = -1; z < 2; z += 0.001) {
    EXPECT_GT(map(z), before);
    before = map(z);
  }
}

} // namespace sloper::garment

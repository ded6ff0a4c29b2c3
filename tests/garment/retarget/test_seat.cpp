#include <support/skin_garment.hpp>

#include <garment/retarget/seat.hpp>
#include <sloper/garment/bind/bind.hpp>
#include <sloper/garment/fit/fit.hpp>
#include <sloper/garment/retarget/retarget.hpp>

#include <gtest/gtest.h>

namespace sloper::garment {

namespace {

constexpr double RAISED = 0.08; // m: at that height the trunk of the figure is wider by far

/// A skirt from the knee to the waist, whose top edge is `ease` longer than the waist, m.
Garment skirt_to_the_waist(const body::Body& body, double ease) {
  Garment g = tube_skirt(body);
  const double waist = body.levels.at("waist_semantic").y;
  const double hip = body.levels.at("hip").y;
  const Vec3 axis = body.landmark("hip_center");
  std::vector<Vec3> position = g.position;
  double top = 0;
  const std::size_t n = 72; // particles of a row; the last row is the top edge
  for (std::size_t i = position.size() - n; i < position.size(); ++i)
    top += (position[i] - position[i + 1 < position.size() ? i + 1 : position.size() - n]).norm();
  const double share = (body.levels.at("waist_semantic").girth_m + ease) / top;
  for (Vec3& p : position) {
    const double up = std::clamp((p.y() - hip) / (waist - hip), 0.0, 1.0);
    const double scale = 1 + up * (share - 1);
    p.x() = axis.x() + scale * (p.x() - axis.x());
    p.z() = axis.z() + scale * (p.z() - axis.z());
  }
  Garment skirt = sheet(position, g.panels.triangles);
  bind_garment(skirt, body);
  return skirt;
}

Garment raised(Garment g, double up) {
  for (Vec3& p : g.position)
    p.y() += up;
  return g;
}

} // namespace

TEST(seat, a_skirt_that_closes_where_it_was_placed_stays_there) {
  const body::Body body = measured("f-165-a");
  const Garment skirt = skirt_to_the_waist(body, 0.02);
  EXPECT_EQ(seat_of_waist(skirt, skirt.position, body).below_m, 0);
}

TEST(seat, a_skirt_that_was_placed_above_the_waist_is_worn_where_its_top_edge_closes) {
  const body::Body body = measured("f-165-a");
  const Garment skirt = skirt_to_the_waist(body, 0.02);
  const double below = seat_of_waist(raised(skirt, RAISED), skirt.position, body).below_m;
  EXPECT_GT(below, 0.02);
  EXPECT_LT(below, RAISED + 0.005);
}

TEST(seat, a_skirt_that_closes_nowhere_is_worn_where_the_body_is_narrowest) {
  const body::Body body = measured("f-165-a");
  const Garment skirt = skirt_to_the_waist(body, -0.06);
  const double below = seat_of_waist(raised(skirt, RAISED), skirt.position, body).below_m;
  const double waist = body.levels.at("waist_girth_min").y - body.levels.at("waist_semantic").y;
  EXPECT_NEAR(below, RAISED - waist, 0.02);
}

TEST(seat, a_shirt_is_not_lowered) {
  const body::Body body = measured("f-165-a");
  Garment shirt = skin_shirt(body);
  bind_garment(shirt, body);
  EXPECT_EQ(seat_of_waist(raised(shirt, RAISED), shirt.position, body).below_m, 0);
}

TEST(seat, a_skirt_that_closes_only_below_where_it_was_placed_is_not_refused) {
  const body::Body body = measured("f-165-a");
  const Garment skirt = skirt_to_the_waist(body, 0.005);
  body::Body to = body;
  to.levels.at("waist_semantic").y += RAISED; // it is placed that much higher there
  const collision::BodyCollider skin(to.skin);
  const Retargeted on = retarget(skirt, to, skin, RetargetMode::KEEP_FABRIC, silent_reporter());
  EXPECT_GT(on.report.seated_lower_m, 0.03);
  const FitReport fit = fit_before_drape(on.garment, skirt.position, to, standard_fit_policy());
  EXPECT_TRUE(fit.fits) << fit.reason;
  const auto highest = [](const std::vector<Vec3>& points) {
    double y = -1e300;
    for (const Vec3& p : points)
      y = std::max(y, p.y());
    return y;
  };
  // What it was lowered by counts as slip, which the fit tells.
  EXPECT_GT(highest(on.placed) - highest(on.garment.position), 0.03);
}

} // namespace sloper::garment

/// Legs of trousers that are longer than those of the body end at the ankles, with folds above.
#include <support/skin_garment.hpp>

#include <garment/bind/bind_frames.hpp>
#include <garment/retarget/leg_ends.hpp>
#include <garment/simulate/sleeve_ends.hpp>
#include <sloper/garment/bind/bind.hpp>

#include <gtest/gtest.h>

#include <algorithm>

namespace sloper::garment {

namespace {

constexpr double TOO_LONG = 0.1; // m
constexpr double RADIUS = 0.08;  // m: 1 to 3 cm off a calf

/// A tube around the left leg, from the ankle to above the knee, bound to the body.
Garment tube_on_leg(const body::Body& body) {
  const BindFrames frames = make_bind_frames(body);
  const PartFrame& leg = frames.frames[frames.index("leg_l")].frame;
  constexpr int N_AROUND = 24, N_ROWS = 30;
  std::vector<Vec3> position;
  std::vector<Triangle> triangles;
  for (int row = 0; row < N_ROWS; ++row)
    for (int k = 0; k < N_AROUND; ++k)
      position.push_back(
          leg.point({RADIUS, 2 * std::numbers::pi * k / N_AROUND, 0.6 * row / (N_ROWS - 1)}));
  for (int row = 0; row + 1 < N_ROWS; ++row)
    for (int k = 0; k < N_AROUND; ++k) {
      const int a = row * N_AROUND + k, b = row * N_AROUND + (k + 1) % N_AROUND;
      triangles.push_back({a, b, b + N_AROUND});
      triangles.push_back({a, b + N_AROUND, a + N_AROUND});
    }
  Garment tube = sheet(position, triangles);
  bind_garment(tube, body);
  return tube;
}

/// As on a shorter body: the part below the knee lies lower by TOO_LONG.
std::vector<Vec3> placed_too_low(const Garment& tube, const body::Body& body) {
  std::vector<Vec3> placed = tube.position;
  for (Vec3& p : placed)
    if (p.y() < body.landmark("knee_l").y())
      p.y() -= TOO_LONG;
  return placed;
}

double lowest(const std::vector<Vec3>& p) {
  return std::min_element(p.begin(), p.end(),
                          [](const Vec3& a, const Vec3& b) { return a.y() < b.y(); })
      ->y();
}

} // namespace

TEST(LegEnds, that_a_foot_comes_through_are_raised_to_the_ankle) {
  const body::Body body = measured("f-165-a");
  const Garment tube = tube_on_leg(body);
  std::vector<Vec3> placed = placed_too_low(tube, body);
  const std::vector<Vec3> too_low = placed;
  const std::vector<int> raised =
      raise_ends_off_feet(placed, tube, body, {tube.particle_triangles().front()});
  EXPECT_EQ(raised.size(), legs_of(tube.bind).front().end.size());
  EXPECT_GE(raised.size(), 24u) << "at least the lowest row";
  EXPECT_NEAR(lowest(placed), lowest(tube.position), 0.005);
  for (std::size_t i = 0; i < placed.size(); ++i) {
    if (tube.position[i].y() > body.landmark("knee_l").y() + 0.02) {
      EXPECT_EQ(placed[i], too_low[i]) << "above the knee";
    }
    EXPECT_LT((placed[i] - too_low[i]).norm(), TOO_LONG + 0.01);
  }
}

TEST(LegEnds, that_no_foot_comes_through_or_that_lie_as_they_did_stay) {
  const body::Body body = measured("f-165-a");
  const Garment tube = tube_on_leg(body);
  const Triangle lowest_face = tube.particle_triangles().front();
  const Triangle highest_face = tube.particle_triangles().back();
  const std::vector<Vec3> too_low = placed_too_low(tube, body);
  std::vector<Vec3> placed = too_low;
  EXPECT_TRUE(raise_ends_off_feet(placed, tube, body, {}).empty());
  EXPECT_TRUE(raise_ends_off_feet(placed, tube, body, {highest_face}).empty()) << "at the knee";
  EXPECT_EQ(placed, too_low);
  placed = tube.position;
  EXPECT_TRUE(raise_ends_off_feet(placed, tube, body, {lowest_face}).empty());
  EXPECT_EQ(placed, tube.position);
}

} // namespace sloper::garment

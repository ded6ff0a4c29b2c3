#include <support/figures.hpp>

#include <body/skin_profile.hpp>
#include <gtest/gtest.h>

using namespace sloper;
using namespace sloper::body;

TEST(SkinProfile, is_bilinear_periodic_and_clamped) {
  SkinProfile profile;
  profile.n_theta = 4;
  profile.n_z = 2;
  profile.z_low = 0;
  profile.z_high = 1;
  profile.radius = {1, 2, 3, 4, 5, 6, 7, 8};
  const double pi = 3.14159265358979323846;
  EXPECT_NEAR(profile.at(-pi, 0), 1, 1e-9);
  EXPECT_NEAR(profile.at(0, 0), 3, 1e-9);
  EXPECT_NEAR(profile.at(0.25 * pi, 0), 3.5, 1e-9);
  EXPECT_NEAR(profile.at(0.75 * pi, 0), 2.5, 1e-9); // between the last column and the first
  EXPECT_NEAR(profile.at(0, 0.5), 5, 1e-9);
  EXPECT_NEAR(profile.at(0, 9), 7, 1e-9);
  EXPECT_NEAR(profile.at(pi, 0), profile.at(-pi, 0), 1e-9);
}

TEST(SkinProfile, lies_on_the_skin_of_a_mannequin) {
  const Body body = test::measure(test::mannequin("f-165-a").mesh).body;
  for (const char* name : {"head", "torso", "arm_l", "arm_r", "leg_l", "leg_r", "lower_body"})
    ASSERT_TRUE(body.frames.count(name)) << name;
  // what a vertex says of the leg it belongs to
  for (const auto& [name, part] :
       {std::pair{"leg_l", Part::LEG_L}, std::pair{"torso", Part::TORSO}}) {
    const BodyFrame& frame = body.frames.at(name);
    double sum = 0;
    int n = 0;
    for (std::size_t t = 0; t < body.skin.triangles.size(); ++t) {
      if (body.face_part[t] != part)
        continue;
      const PartCoordinates c =
          frame.frame.coordinates(body.skin.positions[body.skin.triangles[t][0]]);
      if (c.z < 0.2 || c.z > 0.7)
        continue;
      sum += std::abs(c.r - frame.profile.at(c.theta, c.z));
      ++n;
    }
    ASSERT_GT(n, 100);
    EXPECT_LT(sum / n, 0.006) << name;
  }
}

TEST(SkinProfile, left_and_right_of_a_symmetric_figure_agree) {
  const Body body = test::measure(test::mannequin("m-185-t").mesh).body;
  for (double theta = -3; theta < 3; theta += 0.5)
    for (double z = 0.1; z < 1; z += 0.2)
      EXPECT_NEAR(body.frames.at("leg_l").profile.at(theta, z),
                  body.frames.at("leg_r").profile.at(theta, z), 0.008)
          << theta << " " << z;
}

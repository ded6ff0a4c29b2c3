#include <sloper/base/units.hpp>

#include <gtest/gtest.h>

using namespace sloper;

TEST(Units, gram_force_per_centimetre_follows_from_gravity) {
  EXPECT_DOUBLE_EQ(units::GF_PER_CM, 1e-3 * units::GRAVITY / units::CM);
  EXPECT_NEAR(units::GF_CM2_PER_CM, 1e-3 * units::GRAVITY * units::CM * units::CM / units::CM,
              1e-18); // N m2 per m
}

TEST(Units, gram_per_square_centimetre_is_ten_kilograms_per_square_metre) {
  EXPECT_DOUBLE_EQ(units::G_PER_CM2, 1e-3 / (units::CM * units::CM));
}

TEST(Units, degrees_and_radians_are_inverse) {
  EXPECT_DOUBLE_EQ(units::radians(180), units::PI);
  EXPECT_DOUBLE_EQ(units::degrees(units::radians(37.5)), 37.5);
}

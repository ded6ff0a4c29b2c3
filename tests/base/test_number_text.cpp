#include <sloper/base/number_text.hpp>

#include <gtest/gtest.h>

using namespace sloper;

TEST(number_text, is_the_shortest_that_reads_back_without_zeros_at_the_end) {
  EXPECT_EQ(number_text(0), "0");
  EXPECT_EQ(number_text(1000), "1000");
  EXPECT_EQ(number_text(-0.0001), "-0.0001");
  EXPECT_EQ(number_text(1e-6), "0.000001");
  EXPECT_EQ(number_text(1e-12), "1e-12") << "not 0";
  EXPECT_EQ(number_text(1e9), "1000000000");
  EXPECT_EQ(number_text(1e300), "1e+300");
  EXPECT_EQ(std::stod(number_text(-1.0 / 3e5)), -1.0 / 3e5);
}

TEST(rounded_text, has_four_digits) {
  EXPECT_EQ(rounded_text(0.000123456), "0.0001235");
  EXPECT_EQ(rounded_text(12345.6), "12350");
  EXPECT_EQ(rounded_text(-2.0 / 3), "-0.6667");
  EXPECT_EQ(rounded_text(0), "0");
}

TEST(range_text, names_both_ends) {
  EXPECT_EQ(range_text(0, 1000), "0 to 1000");
  EXPECT_EQ(range_text(1e-12, 0.5), "1e-12 to 0.5");
}

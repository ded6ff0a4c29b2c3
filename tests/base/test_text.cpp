#include <sloper/base/text.hpp>

#include <gtest/gtest.h>

using namespace sloper;

TEST(split, keeps_empty_pieces_but_none_at_the_end) {
  EXPECT_EQ(split("a,,b"), (std::vector<std::string>{"a", "", "b"}));
  EXPECT_EQ(split("a b ", ' '), (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(split(""), std::vector<std::string>());
}

TEST(decimals, are_as_many_as_asked_for_however_large_the_number) {
  EXPECT_EQ(decimals(1.005, 1), "1.0");
  EXPECT_EQ(decimals(-0.26, 1), "-0.3");
  EXPECT_EQ(decimals(1e300, 0).size(), 301);
}

TEST(lengths_and_shares, have_their_unit) {
  EXPECT_EQ(centimetres(0.1234), "12.3 cm");
  EXPECT_EQ(centimetres(0.1234, 2), "12.34 cm");
  EXPECT_EQ(millimetres(0.00125), "1.2 mm"); // 1.25 exactly: to even
  EXPECT_EQ(percent(0.0456), "4.6 %");
  EXPECT_EQ(place_text(1, -0.5, 0.0004), "(1.000, -0.500, 0.000)");
}

TEST(shares, are_rounded_to_even_by_percent_and_away_from_zero_by_whole_percent) {
  EXPECT_EQ(percent(0.125, 0), "12 %");
  EXPECT_EQ(whole_percent(0.125), "13 %");
}

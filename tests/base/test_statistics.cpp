#include <sloper/base/statistics.hpp>

#include <gtest/gtest.h>

using namespace sloper;

TEST(Quantiles, are_values_of_the_list_at_the_lower_place) {
  const std::vector<double> values = {5, 1, 4, 2, 3, 6};
  for (const auto& [q, expected] :
       {std::pair{0.0, 1.0}, {0.19, 1.0}, {0.2, 2.0}, {0.5, 3.0}, {0.99, 5.0}, {1.0, 6.0}}) {
    std::vector<double> copy = values;
    EXPECT_EQ(lower_quantile(copy, q), expected) << q;
  }
}

TEST(Quantiles, the_median_of_an_even_number_is_the_upper_of_two_by_its_own_name_only) {
  std::vector<double> values = {4, 1, 3, 2};
  EXPECT_EQ(upper_median(values), 3);
  EXPECT_EQ(lower_quantile(values, 0.5), 2);
  std::vector<int> one = {7};
  EXPECT_EQ(upper_median(one), 7);
}

TEST(Quantiles, a_rank_comes_to_its_place_between_smaller_and_larger) {
  std::vector<double> values = {9, 3, 7, 1, 5};
  const auto at = place_rank(values, 2);
  EXPECT_EQ(at - values.begin(), 2);
  EXPECT_EQ(*at, 5);
  EXPECT_LT(std::max(values[0], values[1]), 5);
  EXPECT_GT(std::min(values[3], values[4]), 5);
}

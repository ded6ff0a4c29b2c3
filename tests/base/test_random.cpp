#include <sloper/base/random.hpp>

#include <gtest/gtest.h>

using sloper::Random;

TEST(Random, gives_the_published_sequence_of_splitmix64) {
  Random random(1234567); // test vector of the reference implementation
  EXPECT_EQ(random.next(), 6457827717110365317ULL);
  EXPECT_EQ(random.next(), 3203168211198807973ULL);
  EXPECT_EQ(random.next(), 9817491932198370423ULL);
}

TEST(Random, stays_within_its_range_and_fills_it) {
  Random random(1);
  int low = 0, high = 0;
  for (int i = 0; i < 10000; ++i) {
    const double x = random.uniform(-2, 3);
    ASSERT_GE(x, -2);
    ASSERT_LT(x, 3);
    low += x < -1.5;
    high += x > 2.5;
  }
  EXPECT_NEAR(low, 1000, 150);
  EXPECT_NEAR(high, 1000, 150);
}

TEST(Random, differs_by_seed) {
  EXPECT_NE(Random(1).next(), Random(2).next());
}

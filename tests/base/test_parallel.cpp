#include <sloper/base/parallel.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <stdexcept>

using namespace sloper;

class Parallel : public ::testing::TestWithParam<int> {
protected:
  void SetUp() override { set_thread_count(GetParam()); }
  void TearDown() override { set_thread_count(1); }
};

TEST_P(Parallel, visits_every_item_once_for_any_grain) {
  for (const std::size_t n : {0u, 1u, 7u, 1000u})
    for (const std::size_t grain : {1u, 3u, 1000u, 5000u}) {
      std::vector<int> visits(n, 0);
      parallel_for(n, grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
          ++visits[i];
      });
      EXPECT_EQ(std::accumulate(visits.begin(), visits.end(), std::size_t{0}), n);
      for (const int v : visits)
        ASSERT_EQ(v, 1);
    }
}

TEST_P(Parallel, cuts_chunks_at_the_same_places) {
  std::vector<std::size_t> ends(10, 0);
  parallel_for(95, 10, [&](std::size_t begin, std::size_t end) { ends[begin / 10] = end; });
  EXPECT_EQ(ends, (std::vector<std::size_t>{10, 20, 30, 40, 50, 60, 70, 80, 90, 95}));
}

TEST_P(Parallel, sums_to_the_same_bits_for_any_number_of_threads) {
  auto term = [](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i)
      sum +=
          std::sin(static_cast<double>(i) * 1e3) * std::pow(10.0, static_cast<double>(i % 17) - 8);
    return sum;
  };
  std::vector<double> part;
  const double here = parallel_sum(10000, 64, part, term);
  set_thread_count(1);
  EXPECT_EQ(here, parallel_sum(10000, 64, part, term));
}

TEST_P(Parallel, passes_on_the_exception_of_the_lowest_chunk) {
  for (int repeat = 0; repeat < 20; ++repeat)
    try {
      parallel_for(100, 1, [](std::size_t begin, std::size_t) {
        if (begin % 10 == 3)
          throw std::runtime_error(std::to_string(begin));
      });
      FAIL() << "no exception came through";
    } catch (const std::runtime_error& e) {
      EXPECT_STREQ(e.what(), "3");
    }
}

INSTANTIATE_TEST_SUITE_P(threads, Parallel, ::testing::Values(1, 2, 5));

TEST(ThreadCount, zero_means_all_cores_and_at_least_one) {
  set_thread_count(0);
  EXPECT_GE(thread_count(), 1);
  set_thread_count(1);
  EXPECT_EQ(thread_count(), 1);
}

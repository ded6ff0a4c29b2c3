#include <sloper/base/random.hpp>
#include <sloper/geometry/disjoint_sets.hpp>

#include <gtest/gtest.h>

using namespace sloper;

TEST(DisjointSets, the_lowest_element_stands_for_a_set_in_whatever_order_it_was_joined) {
  DisjointSets sets(6);
  sets.unite(5, 3);
  sets.unite(3, 1);
  sets.unite(4, 2);
  const DisjointSets& same = sets;
  for (int i : {1, 3, 5}) {
    EXPECT_EQ(same.find(i), 1);
    EXPECT_EQ(sets.find(i), 1);
  }
  EXPECT_EQ(sets.find(4), 2);
  EXPECT_EQ(sets.numbers(), (std::vector<int>{0, 1, 2, 1, 2, 1}));
}

TEST(DisjointSets, joining_into_keeps_what_stands_for_the_second) {
  DisjointSets sets(4);
  sets.unite_into(0, 2);
  EXPECT_EQ(sets.find(0), 2);
  sets.unite_into(2, 3);
  EXPECT_EQ(sets.find(0), 3);
  sets.unite_into(3, 0); // one set already
  EXPECT_EQ(sets.find(2), 3);
  EXPECT_EQ(sets.find(1), 1);
}

TEST(DisjointSets, a_new_element_is_alone) {
  DisjointSets sets;
  EXPECT_EQ(sets.add(), 0);
  EXPECT_EQ(sets.add(), 1);
  EXPECT_EQ(sets.size(), 2u);
  EXPECT_EQ(sets.find(1), 1);
}

TEST(DisjointSets, are_what_spreading_the_lowest_number_over_the_pairs_gives) {
  constexpr int N = 60;
  Random random(7);
  DisjointSets sets(N);
  std::vector<int> lowest(N);
  std::iota(lowest.begin(), lowest.end(), 0);
  for (int k = 0; k < 45; ++k) {
    const int a = static_cast<int>(random.next() % N);
    const int b = static_cast<int>(random.next() % N);
    sets.unite(a, b);
    const int kept = std::min(lowest[a], lowest[b]);
    const int gone = std::max(lowest[a], lowest[b]);
    std::replace(lowest.begin(), lowest.end(), gone, kept);
    for (int i = 0; i < N; ++i)
      ASSERT_EQ(sets.find(i), lowest[i]);
  }
}

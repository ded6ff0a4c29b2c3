#pragma once
/// Elements 0, 1, 2 ... in sets that are joined one by one: a disjoint-set forest with path halving
/// (Tarjan and van Leeuwen 1984).
/// Test: tests/geometry/test_disjoint_sets.cpp
#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace sloper {

/// A partition of 0 .. size() - 1. Operations take nearly constant time.
class DisjointSets {
public:
  /// @param n  elements, each alone in its set
  explicit DisjointSets(std::size_t n = 0) : m_parent(n) {
    std::iota(m_parent.begin(), m_parent.end(), 0);
  }

  std::size_t size() const { return m_parent.size(); } ///< elements

  /// One more element, alone in its set. @returns it
  int add() {
    m_parent.push_back(std::ssize(m_parent));
    return m_parent.back();
  }

  /// The element that stands for the set of i: the lowest of the set, where only unite() joined it.
  /// 0 <= i < size()
  int find(int i) {
    while (parent(i) != i)
      i = parent(i) = parent(parent(i));
    return i;
  }
  /// The same, without shortening paths.
  int find(int i) const {
    while (m_parent[i] != i)
      i = m_parent[i];
    return i;
  }

  /// Joins the sets of a and b; the lower of their two elements stands for both, so that the order
  /// of calls does not matter.
  void unite(int a, int b) {
    a = find(a);
    b = find(b);
    parent(std::max(a, b)) = std::min(a, b);
  }

  /// The same; what stands for the set of b stands for both. For callers whose results follow the
  /// order of joining.
  void unite_into(int a, int b) {
    b = find(b);
    parent(find(a)) = b;
  }

  /// The number of each element's set, #size(); sets are counted from 0 in the order of their first
  /// elements.
  std::vector<int> numbers() {
    std::vector<int> of(size()), number(size(), -1);
    int count = 0;
    for (std::size_t i = 0; i < size(); ++i) {
      int& own = number[find(static_cast<int>(i))];
      if (own < 0)
        own = count++;
      of[i] = own;
    }
    return of;
  }

private:
  int& parent(int i) { return m_parent[i]; }
  std::vector<int> m_parent;
};

} // namespace sloper

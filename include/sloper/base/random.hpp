#pragma once
/// Seeded random numbers: the same sequence on every machine and compiler (SplitMix64, Steele et
/// al. 2014), as long as draws are not arguments of one call: compilers choose those arguments'
/// order.
/// Test: tests/base/test_random.cpp
#include <cstdint>
namespace sloper {
/// A generator of random numbers.
class Random {
public:
  /// @param seed  any number
  explicit Random(std::uint64_t seed) : m_state(seed) {}
  /// 64 uniform random bits.
  std::uint64_t next() {
    std::uint64_t z = (m_state += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }
  /// uniform in [0, 1)
  double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }
  /// uniform in [low, high)
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

private:
  std::uint64_t m_state;
};
} // namespace sloper

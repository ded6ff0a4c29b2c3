#pragma once
/// Prints what a validation test measured beside its reference, when SLOPER_FIGURES is set; tests are silent otherwise.
#include <cstdio>
#include <cstdlib>
#include <gtest/gtest.h>
#include <string>

namespace sloper {

inline void print_figure(const std::string& what, double ours, double reference) {
  ::testing::Test::RecordProperty(what, std::to_string(ours));
  if (std::getenv("SLOPER_FIGURES")) std::printf("%-60s %12.5g  reference %12.5g  (%+.2f %%)\n", what.c_str(), ours, reference, 100 * (ours / reference - 1));
}

} // namespace sloper

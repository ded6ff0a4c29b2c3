#pragma once
/// What a validation test measured, beside its reference: printed when SLOPER_FIGURES is set, and
/// as points of a plot into the folder SLOPER_PLOTS, from which scripts/validation-plots draws;
/// tests are silent otherwise.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <string>

namespace sloper {

inline void print_figure(const std::string& what, double ours, double reference) {
  ::testing::Test::RecordProperty(what, std::to_string(ours));
  if (std::getenv("SLOPER_FIGURES"))
    std::printf("%-60s %12.5g  reference %12.5g  (%+.2f %%)\n", what.c_str(), ours, reference,
                100 * (ours / reference - 1));
}

/// A point of a series of SLOPER_PLOTS/plot.dat, in the order in which they come.
inline void plot_point(const std::string& plot, const std::string& series, double x, double y) {
  if (const char* folder = std::getenv("SLOPER_PLOTS"))
    std::ofstream(std::string(folder) + "/" + plot + ".dat", std::ios::app)
        << series << '\t' << x << '\t' << y << '\n';
}

} // namespace sloper

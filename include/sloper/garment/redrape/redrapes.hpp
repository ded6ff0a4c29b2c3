#pragma once
/// The same garment draped repeatedly from starts that differ a little: the result is a
/// distribution.
/// Test: tests/garment/redrape/test_redrapes.cpp
#include <sloper/base/progress.hpp>
#include <sloper/body/body.hpp>
#include <sloper/garment/redrape/start_jitter.hpp>
#include <sloper/garment/scene/settings.hpp>
#include <sloper/garment/simulate/report.hpp>

namespace sloper::garment {

/// How many drapes, and how their starts differ.
struct RedrapeRequest {
  int count = 2;          ///< drapes, 2 and more; number 0 starts as the garment stands
  StartJitter jitter;     ///< of starts 1 and above
  std::uint64_t seed = 1; ///< of all starts
};

/// The garments and reports of all drapes.
struct RedrapeSet {
  std::vector<Garment> garments;    ///< by number, each where it ended; bound where there is a body
  std::vector<DrapeReport> reports; ///< by number
};

/// Drapes `count` times, thread_count() at once, each on one thread alone: the same bytes
/// for any number of threads. Log lines and warnings are those of number 0 alone. Memory:
/// that of a drape for each thread.
/// @param start  placed panels or a sewn garment
/// @param body  or nullptr
/// @throws Error INPUT as drape() does
RedrapeSet redrape(const Garment& start, const body::Body* body, const DrapeSettings& settings,
                   const RedrapeRequest& request, Reporter& reporter);

/// For report.json: by number, whether it came to rest, steps and wall seconds.
io::Json redrape_costs(const RedrapeSet& set);

} // namespace sloper::garment

#pragma once
/// The same garment draped again and again from starts that differ a little: what comes out is a
/// distribution.
#include <sloper/base/progress.hpp>
#include <sloper/body/body.hpp>
#include <sloper/garment/redrape/start_jitter.hpp>
#include <sloper/garment/scene/settings.hpp>
#include <sloper/garment/simulate/report.hpp>

namespace sloper::garment {

struct RedrapeRequest {
  int count = 2; ///< drapes, 2 and more; number 0 starts as the garment stands
  StartJitter jitter;
  std::uint64_t seed = 1;
};

struct RedrapeSet {
  std::vector<Garment> garments; ///< by number, each where it ended; bound where there is a body
  std::vector<DrapeReport> reports;
};

/// Drapes `count` times, thread_count() at once, each on one thread alone: the same bytes for any
/// number of threads. What a drape says is passed on of number 0 alone. Memory: that of a drape for
/// each thread.
/// @throws Error INPUT as drape() does
RedrapeSet redrape(const Garment& start, const body::Body* body, const DrapeSettings& settings,
                   const RedrapeRequest& request, Reporter& reporter);

/// For report.json: by number, whether it came to rest, steps and wall seconds.
io::Json redrape_costs(const RedrapeSet& set);

} // namespace sloper::garment

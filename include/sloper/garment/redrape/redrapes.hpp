#pragma once
/// The same garment draped repeatedly from starts that differ a little: the result is a
/// distribution.
///
/// A garment that is sewn through a coarse mesh (drape/drape.hpp) is sewn once, and each drape
/// hangs it again: from where it rests, displaced as hands would. Sewing through a coarse mesh
/// draws unlike starts together, so that panels placed otherwise would show no spread at all: 0.1
/// mm in place of 2 mm on a shirt. Panels that are sewn on the given mesh alone are placed
/// otherwise and sewn again, and so is cloth that is not sewn. Test:
/// tests/garment/redrape/test_redrapes.cpp
#include <sloper/base/progress.hpp>
#include <sloper/body/body.hpp>
#include <sloper/garment/redrape/start_jitter.hpp>
#include <sloper/garment/scene/settings.hpp>
#include <sloper/garment/simulate/report.hpp>

#include <optional>

namespace sloper::garment {

/// How many drapes, and how their starts differ.
struct RedrapeRequest {
  int count = 2;          ///< drapes, 2 and more; number 0 starts as the garment stands or rests
  StartJitter jitter;     ///< of starts 1 and above
  std::uint64_t seed = 1; ///< of all starts
};

/// The garments and reports of all drapes.
struct RedrapeSet {
  std::vector<Garment> garments;    ///< by number, each where it ended; bound where there is a body
  std::vector<DrapeReport> reports; ///< by number; number 0 with the sewing of all
  std::optional<DrapeReport> sewn;  ///< of the drape that the others hung again, where they did
};

/// Drapes `count` times, thread_count() at once, each on one thread alone: the same bytes
/// for any number of threads. Log lines and warnings are those of number 0 alone. Memory:
/// that of a drape for each thread.
/// @param start  placed panels or a sewn garment
/// @param body  or nullptr
/// @throws Error INPUT as drape() does
RedrapeSet redrape(const Garment& start, const body::Body* body, const DrapeSettings& settings,
                   const RedrapeRequest& request, Reporter& reporter);

/// The report of a drape with the sewing before it.
DrapeReport whole_report(const RedrapeSet& set, std::size_t number);

/// For report.json: by number, whether it came to rest, steps and wall seconds.
io::Json redrape_costs(const RedrapeSet& set);

} // namespace sloper::garment

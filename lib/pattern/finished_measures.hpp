#pragma once
/// What a tailor measures on the finished garment, taken from the flat pattern: no body, no drape.
#include <io/json.hpp>
#include <pattern/pattern.hpp>

namespace sloper::pattern {

/// An opening of the sewn garment: a hem, a waist, a neckline, an armhole without its sleeve.
struct Opening {
  std::vector<std::string> edges; ///< "front: hem", in the order of the panels
  double length = 0;              ///< m, around
};

struct FinishedMeasures {
  std::vector<Opening> openings;                     ///< longest first
  std::vector<std::pair<std::string, double>> seams; ///< name, m: the mean of both sides
  std::vector<std::array<double, 2>> around;         ///< m below the garment's top, m of cloth around the trunk there, every 5 cm
  double cloth_m2 = 0;
};

/// @throws Error INPUT for a pattern that cannot be meshed. Cost: one coarse mesh.
FinishedMeasures finished_measures(const Pattern& pattern, const std::string& file);

/// For the findings document: {"openings", "seams", "around", "cloth_m2"}, m.
io::Json measures_json(const FinishedMeasures& measures);

} // namespace sloper::pattern

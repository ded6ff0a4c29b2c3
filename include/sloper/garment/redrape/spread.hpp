#pragma once
/// Statistics over re-drapes: their common result and their spread.
/// Test: tests/garment/redrape/test_redrapes.cpp
#include <sloper/garment/redrape/redrapes.hpp>
#include <sloper/io/json_fwd.hpp>

#include <map>

namespace sloper::garment {

/// Mean and standard deviation (n - 1) of one number over the drapes that came to rest.
struct SpreadFigure {
  int n = 0;               ///< values
  double mean = 0, sd = 0; ///< in the unit of the values
  double error() const;    ///< standard error of the mean: sd / sqrt(n); 0 for none
};
/// Mean and standard deviation of values; sd is 0 for fewer than two.
SpreadFigure spread_figure(const std::vector<double>& values);

/// Statistics over the drapes that came to rest.
struct Spread {
  int count = 0, at_rest = 0;      ///< drapes; those that came to rest, which alone count below
  std::vector<std::string> panels; ///< names of the panels of the garment
  int medoid = 0; ///< number of the drape whose squared distances to the others are least in sum
  std::vector<double> to_medoid_m; ///< by number, root mean square over particles; -1: not at rest
  std::vector<double> particles_m; ///< #P: standard deviation of the place, of all three axes
  /// By figure of compare-drape ("rms_mm", "max_mm", "strain_p99", "girth_cm"): differences of all
  /// pairs.
  std::map<std::string, SpreadFigure> pairs;
  /// By row of the fit report and figure ("lying_cm", "ease_cm", "strain_p99", "gap_p50_mm"); empty
  /// without a body.
  std::map<std::string, std::map<std::string, SpreadFigure>> girths;
  std::map<std::string, std::map<std::string, SpreadFigure>> hems; ///< "height_cm", "length_cm"
  SpreadFigure strain_p50, strain_p99; ///< of warp and weft, by area, of the whole
  SpreadFigure folds;                  ///< of the lowest free edge (count_folds())
  SpreadFigure shadow_m2;              ///< seen from above
  SpreadFigure drape_percent;          ///< of the shadow, over the area of the cloth laid flat
};

/// @param set   of one garment   @param body  the one it hangs on, or nullptr: without it there are
/// no girths and hems
/// @throws Error INPUT where the drapes have not the same mesh
Spread measure_spread(const RedrapeSet& set, const body::Body* body);

/// Marks a garment with the spread, for its document, maps and fit reports.
void keep_spread(const Spread& spread, Garment& garment);

/// The document "spread", without its inputs.
io::Json spread_json(const Spread& spread, const RedrapeRequest& request, const std::string& tool);

} // namespace sloper::garment

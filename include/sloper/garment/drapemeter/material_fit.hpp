#pragma once
/// A fabric's bending rigidity from cheap tests: lengths that hang over an edge, and how a round
/// specimen drapes over a disc.
/// Test: tests/garment/drapemeter/test_drapemeter.cpp
#include <sloper/base/progress.hpp>
#include <sloper/garment/drapemeter/drapemeter.hpp>
#include <sloper/garment/garment.hpp>
#include <sloper/io/json_fwd.hpp>

#include <array>
#include <optional>

namespace sloper::garment {

/// Measurements of one fabric. Any may be missing, but not all.
struct FabricTests {
  Material base; ///< weight, stretch and shear, and what else is not fitted
  /// Lengths that hang over an edge until their end lies 41.5 degrees below it, along warp, weft
  /// and bias, m; several of one direction are repetitions.
  std::array<std::vector<double>, 3> overhang_m;
  std::vector<double> coefficient; ///< drape coefficients of repetitions, 0..1
  std::vector<int> folds;          ///< of repetitions
  double length_error_m = 0.002;   ///< standard error of one overhang by a ruler
  /// Of one drape, where there are too few repetitions to estimate it.
  double coefficient_error = 0.03;
  double shear_error = 0.3;   ///< relative error of the base's shear; 0 where it was measured
  double stretch_error = 0.3; ///< the same, of its stretch
  DrapemeterSetup setup;      ///< of the drape tests
};

/// A bending rigidity with its standard deviation.
struct FittedValue {
  double value = 0, sd = 0; ///< N m
};

/// The fitted material, the result of each test by itself, and undecided values.
struct MaterialFit {
  Material material;                                       ///< the base with the bending found
  std::optional<FittedValue> from_drape;                   ///< mean of warp and weft
  std::array<std::optional<FittedValue>, 3> from_overhang; ///< warp, weft, bias
  std::optional<FittedValue> mean; ///< of the material; empty: the data cannot decide it
  /// Values that the data cannot decide, with the reason.
  std::vector<std::string> cannot_tell;
  /// Contradiction of overhang and drape, as a sentence; empty: there is none. Then the
  /// overhang counts.
  std::string contradiction;
  double coefficient = 0, coefficient_sd = 0; ///< of the model at the result, of one drape
  double folds = 0;                           ///< mean of the model at the result
  int simulations = 0;                        ///< drapes simulated
};

/// Overhangs: B = W g (L / 2)^3 (Peirce 1930; BS 3356). Drapes: the logarithm of B at which the
/// mean of simulated drapes has the measured mean coefficient, by regression over drapes around it;
/// its error is that of the measured mean, of the model's, of its mesh, and of shear and stretch
/// that were not measured, over the slope of the coefficient. Both together: weighted by their
/// errors; the ratios of the directions are the overhangs'.
///
/// The data cannot tell where the coefficient hardly changes with the rigidity: cloth that hangs
/// straight down or stands straight out; where errors come to a factor of two; where overhang and
/// drape contradict each other by three times their errors.
/// The same bytes for any number of threads. At most 60 CPU seconds (44 drapes at 9 mm), 100 MB.
/// @param tests  with at least one overhang or drape coefficient
/// @throws Error INPUT for values that nothing can have
MaterialFit fit_material(const FabricTests& tests, Reporter& reporter);

/// The document "material", with the errors of its values in "fit".
/// @param tests  of the fit
io::Json material_fit_json(const MaterialFit& fit, const FabricTests& tests,
                           const std::string& tool);

} // namespace sloper::garment

#pragma once
/// The report of a drape; report.json(5) describes the document.
#include <sloper/garment/garment.hpp>
#include <sloper/garment/scene/effect_report.hpp>
#include <sloper/garment/scene/settings.hpp>
#include <sloper/garment/simulate/stop_reason.hpp>
#include <sloper/io/json.hpp>

#include <string>
#include <utility>
#include <vector>

namespace sloper::garment {

/// The meshes that panels were draped through (levels/drape_levels.hpp).
struct MeshLevels {
  int meshes = 0;           ///< 0: it did not begin with panels; 1: the given one alone
  std::string why;          ///< the coarse mesh had no part, or none in the result
  double coarse_edge_m = 0; ///< of the coarse mesh
  int coarse_particles = 0; ///< of the coarse mesh
  double coarse_residual_force_ratio = 0; ///< where the cloth was left there, in weights
};

/// Outcome of a drape: how it ended, its effort and the audit.
struct DrapeReport {
  bool converged = false;                    ///< at rest and clean
  StopReason stop_reason = StopReason::NONE; ///< stop_text() puts it into words
  std::string stop_detail;                   ///< words that belong to some of the reasons
  Misfit misfit = Misfit::NONE;              ///< what of FitBounds ended the drape
  int steps = 0;                             ///< of the solver, substeps of a motion included
  double simulated_s = 0, wall_s = 0;        ///< simulated and wall-clock time
  std::vector<EffectReport> effects;         ///< all effects, on or off, with the reason
  std::vector<std::pair<std::string, double>> phases; ///< name, wall seconds
  /// `solver` of report.json: conjugate gradients, residual, rejected steps.
  io::Json solver;
  /// `quality` of report.json: results of the audit.
  io::Json quality;
  std::vector<std::string> repairs; ///< sentences on what was moved or undone
  MeshLevels levels;                ///< meshes used
  DrapeSettings settings;           ///< that the drape ran with
};

/// Adds the effort of an earlier drape of the same garment: steps, seconds, phases, calls
/// and seconds of effects, repairs. The outcome stays that of `report`.
void add_earlier(const DrapeReport& earlier, DrapeReport& report);

/// report.json's `levels`.
io::Json mesh_levels_json(const MeshLevels& levels);

/// The sentence that report.json has as `stop_reason`: made of the reason, and of
/// `quality` and `stop_detail` where counts belong to it.
std::string stop_text(const DrapeReport& report);

/// The report document without its envelope's inputs and hashes, which the tool adds.
io::Json report_json(const DrapeReport& report, const std::string& tool);

/// SHA-256 of the bytes of the particle positions: equal for equal results.
std::string strict_hash(const Garment& garment);
/// SHA-256 of the positions rounded to cells of 10 um, to compare machines and compilers.
std::string quantised_hash(const Garment& garment);

} // namespace sloper::garment

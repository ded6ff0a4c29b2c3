#pragma once
/// What a drape reports.
#include <sloper/garment/garment.hpp>
#include <sloper/garment/scene/effect_report.hpp>
#include <sloper/garment/scene/settings.hpp>
#include <sloper/garment/simulate/stop_reason.hpp>
#include <sloper/io/json.hpp>

#include <string>
#include <utility>
#include <vector>

namespace sloper::garment {

/// Which meshes panels were draped through (levels/drape_levels.hpp).
struct MeshLevels {
  int meshes = 0;           ///< 0: it did not begin with panels; 1: the given one alone
  std::string why;          ///< the coarse mesh had no part, or none in the result
  double coarse_edge_m = 0; ///< of the coarse mesh
  int coarse_particles = 0;
  double coarse_residual_force_ratio = 0; ///< where the cloth was left there, in weights
};

struct DrapeReport {
  bool converged = false;
  StopReason stop_reason = StopReason::NONE; ///< stop_text() puts it into words
  std::string stop_detail;                   ///< words that belong to some of the reasons
  Misfit misfit = Misfit::NONE;              ///< what of FitBounds ended the drape
  int steps = 0;
  double simulated_s = 0, wall_s = 0;
  std::vector<EffectReport> effects;
  std::vector<std::pair<std::string, double>> phases; ///< name, wall seconds
  io::Json solver;  ///< as report.json has it: conjugate gradients, residual, rejected steps
  io::Json quality; ///< as report.json has it: what the audit found
  std::vector<std::string> repairs;
  MeshLevels levels;
  DrapeSettings settings;
};

/// Adds what an earlier drape of the same garment took: steps, seconds, phases, calls and seconds
/// of effects, repairs. Where it ended and how well stays that of `report`.
void add_earlier(const DrapeReport& earlier, DrapeReport& report);

/// report.json's `levels`.
io::Json mesh_levels_json(const MeshLevels& levels);

/// The sentence that report.json has as `stop_reason`: made of the reason, and of `quality` and
/// `stop_detail` where counts belong to it.
std::string stop_text(const DrapeReport& report);

/// The report document without its envelope's inputs and hashes, which the tool adds.
io::Json report_json(const DrapeReport& report, const std::string& tool);

/// SHA-256 of the particle positions: of their bytes, and of their 10 um cells (to compare machines
/// and compilers).
std::string strict_hash(const Garment& garment);
std::string quantised_hash(const Garment& garment);

} // namespace sloper::garment

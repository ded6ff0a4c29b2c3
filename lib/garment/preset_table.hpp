#pragma once
/// The presets of --accuracy: made by `make presets`, not by hand, from settings measured on three scenes going on from a sewn start.
/// Each is the cheapest of those that come to rest on all and bring 95 % of the particles within its budget of the reference on the worst scene:
/// draft 1 mm, standard 0.5 mm, fine 0.1 mm; one that keeps its budget and costs up to 25 % more than the cheapest stays what it was.
/// The reference is a definition: docs/accuracy-cost.md tells how far it moves when it is halved.
/// Measured: skirt 854, shirt 1334, trousers 1415 particles, edges of 30 mm, on AMD EPYC.
namespace sloper::garment {

struct Preset {
  const char* name;
  double cg_tolerance, settle_force_ratio, settle_speed_m_s;
  int max_steps;
  double rms_mm, worst_rms_mm;       ///< from the reference: mean of the scenes, worst scene
  double worst_p95_mm, worst_max_mm; ///< from the reference, on the worst scene: 95 % of the particles, all of them
  double cost;                       ///< CPU time with sewing, in times of the cheapest settings, mean of the scenes
};

// clang-format off
inline constexpr Preset PRESETS[] = {
    {"draft", 0.05, 0.5, 0.02, 1500, 0.26, 0.4, 0.42, 6.6, 1.05},
    {"standard", 0.01, 0.2, 0.01, 1500, 0.21, 0.4, 0.35, 6.6, 1.06},
    {"fine", 0.001, 0.05, 0.0005, 4000, 0.02, 0.055, 0.069, 0.66, 1.48},
    {"reference", 1e-05, 0.01, 0.0001, 20000, 0, 0, 0, 0, 0},
};
// clang-format on

} // namespace sloper::garment

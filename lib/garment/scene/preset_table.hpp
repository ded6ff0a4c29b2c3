#pragma once
/// The presets of --accuracy: made by `make presets`, not by hand, from settings measured on three
/// scenes going on from sewn starts. Each is the cheapest of those that come to rest on all and
/// bring 95 % of the particles within its budget of the reference from all starts but one in nine:
/// draft 1.5 mm, standard 1 mm, fine 0.2 mm; one that keeps its budget and costs up to 25 % more
/// than the cheapest stays what it was. The reference is a definition: docs/accuracy-cost.md says
/// how far it moves when it is halved. Measured: skirt 854, shirt 1334, trousers 1415 particles,
/// edges of 30 mm, 18 starts, on AMD EPYC.
namespace sloper::garment {

/// One preset: its settings, and what they were measured to cost and to miss.
struct Preset {
  const char* name;
  double cg_tolerance, settle_force_ratio, settle_speed_m_s;
  int max_steps;
  double rms_mm, worst_rms_mm; ///< from the reference: mean of the starts, the worst
  double worst_p95_mm,
      worst_max_mm; ///< from the reference, at worst: 95 % of the particles, all of them
  double cost;      ///< CPU time with sewing, in times of the cheapest settings, mean of the starts
};

// clang-format off
inline constexpr Preset PRESETS[] = {
    {"draft", 0.05, 0.5, 0.005, 1500, 0.4, 2.3, 2, 30, 1.02},
    {"standard", 0.01, 0.05, 0.0005, 1500, 0.2, 0.66, 1.5, 12, 1.08},
    {"fine", 0.001, 0.02, 0.0002, 4000, 0.062, 0.68, 1.5, 7.1, 1.14},
    {"reference", 1e-05, 0.01, 0.0001, 20000, 0, 0, 0, 0, 0},
};
// clang-format on

} // namespace sloper::garment

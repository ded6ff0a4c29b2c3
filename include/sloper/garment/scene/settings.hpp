#pragma once
/// The numbers that control a drape.
#include <string>

namespace sloper::garment {

/// All numbers that control a drape, resolved. Field names are the names of --set and of
/// report.json's `settings`; set_knob() has the ranges, preset_settings() the presets.
struct DrapeSettings {
  /// Least step while settling, which lengthens it up to 0.2 s where little moves; step of
  /// live edits.
  double time_step_s = 1.0 / 30;
  /// Relative residual at which conjugate gradients stop; from 0.01 on, while sewing and settling,
  /// also at 0.15 of the error in the energy norm, 0.025 where all is as slow as at rest.
  double cg_tolerance = 1e-2;
  int cg_max_iterations = 400; ///< of one solve
  int newton_iterations = 1;   ///< of a step while the body moves: StepOptions::newton_iterations
  /// Longest step while the body moves: with inertia, longer steps damp the swing of
  /// cloth.
  double motion_step_s = 1.0 / 60;
  /// Preconditioner of conjugate gradients: 0 smoothed aggregation, 1 block Jacobi, 2
  /// exact factorisation.
  int solver = 0;
  /// Level of contact with the body, a cloth::ContactLevel: 1 vertex, 2 face, 3 edge, 4
  /// continuous.
  int contact_level = 4;
  double contact_gap_m = 0.003; ///< distance to the skin at which contact begins
  /// Deviation, m, of the coarser skin that replaces a skin of more than 60,000 triangles
  /// until the cloth is at rest on it (coarse_skin.hpp); two and four times that where
  /// noise leaves no triangle to spare; 0: no replacement. The cloth then comes to rest
  /// on the skin itself. It halves the time on 220,000 to 430,000 triangles.
  double skin_tolerance_m = 3e-4;
  double self_thickness_m = 0.002; ///< activation distance of contact of cloth with cloth
  double settle_speed_m_s = 0.01;  ///< at rest below this speed
  double settle_force_ratio = 0.2; ///< residual force over a particle's weight
  double gravity_m_s2 = 9.80665;   ///< downwards, along -y
  int max_steps = 1500;            ///< of sewing, inflating and settling together
  /// Steps that may follow max_steps while the cloth still nears rest: of a preset half as many;
  /// none where set_knob() has set max_steps, to whatever number.
  int extra_steps = 0;
  /// Number of meshes that panels are draped through (levels/drape_levels.hpp): 1 the
  /// given one alone; 2 they are first sewn on one with edges of 48 mm. Where that is not
  /// possible, 1 is taken, and the report says why.
  int levels = 2;
  double max_seconds = 0;            ///< wall clock, 0 = no limit
  std::string effects = "auto";      ///< "auto" or a list
  std::string accuracy = "standard"; ///< name of the preset, for the report
};

} // namespace sloper::garment

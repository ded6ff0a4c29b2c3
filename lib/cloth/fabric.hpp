#pragma once
namespace sloper::cloth {

/// Mechanical properties of a fabric, per width of cloth.
struct Fabric {
  double density_kg_m2 = 0.12;
  double stretch_warp_n_m = 1000,
         stretch_weft_n_m = 800; ///< tension per width at unit strain, along and across the grain
  double shear_n_m = 60;         ///< shear force per width at unit shear angle
  double bend_n_m = 1e-5;        ///< N m: moment per width at unit curvature
  double damping_s = 0.02;       ///< stiffness-proportional damping time
  double poisson =
      0.25; ///< 0..1: narrowing over lengthening when pulled along the stiffer axis; membrane only
};

} // namespace sloper::cloth

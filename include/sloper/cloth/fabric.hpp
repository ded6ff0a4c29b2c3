#pragma once
namespace sloper::cloth {

/// Mechanical properties of a fabric, per width of cloth.
struct Fabric {
  double density_kg_m2 = 0.12; ///< area density
  /// Tension per width at unit strain, along and across the grain.
  double stretch_warp_n_m = 1000, stretch_weft_n_m = 800;
  double shear_n_m = 60; ///< shear force per width at unit shear angle
  /// N m: moment per width at unit curvature; of a fabric that bends by direction, the
  /// mean of warp and weft.
  double bend_n_m = 1e-5;
  double damping_s = 0.02; ///< stiffness-proportional damping time
  /// 0..1: narrowing over lengthening when pulled along the stiffer axis; membrane only.
  double poisson = 0.25;
  /// N m: moment per width at unit curvature of a cylinder curved along warp, weft, and at 45
  /// degrees between them; 0: not measured. Where all are 0 the fabric bends alike in all
  /// directions.
  double bend_warp_n_m = 0, bend_weft_n_m = 0, bend_bias_n_m = 0;
  /// 0..1: share of the rigidity that is lost as the cloth curves sharply (friction between yarns
  /// is overcome); 0: linear.
  double bend_soft_share = 0;
  double bend_soft_radius_m = 0.01; ///< m: radius of curvature around which the fabric softens
};

} // namespace sloper::cloth

#pragma once
/// Sews and relaxes cloth so that small differences of the start die out on the way.
///
/// What makes sewing on a fine mesh a matter of chance are decisions: flat panels that buckle one
/// way or the other, contact that turns single particles aside, steps that are shortened, solves
/// that end early. Here nothing decides. Panels are nearly rigid boards until the seams are closed,
/// contact is a smooth force (soft_body_contact.hpp), solves are exact enough, and how hard
/// stitches pull, how thick the body is and how stiff cloth bends follow from the number of the
/// step alone. Panels that were placed in folds (PanelInfo::in_folds) keep these as boards keep
/// flat: circle skirts that were pressed flat stood off like plates. Trouser legs are kept apart by
/// a plane; other cloth may pass through cloth. On
/// meshes with edges of 48 mm it costs 3 to 5 ms a step. Measured:
/// docs/decisions/drape-through-levels.md. Test: tests/garment/levels/test_levels.cpp
#include <sloper/base/progress.hpp>
#include <sloper/garment/body_model/collision_body.hpp>
#include <sloper/garment/garment.hpp>
#include <sloper/garment/scene/settings.hpp>

namespace sloper::garment {

/// What sewing came to.
struct SoftSewing {
  int steps = 0;
  double widest_gap_m = 0; ///< of the stitches, when they were welded
  bool finite = true;      ///< false: the garment is as it came
};

/// @param garment  unsewn, with placed panels; out: sewn around the body, without weight. Particles
/// may lie in the skin by millimetres, or in cloth
/// @param body  prepared; is drawn in and inflated again. Without a skin: none takes part
SoftSewing sew_softly(Garment& garment, CollisionBody& body, Reporter& reporter);

/// How relax_softly() goes.
struct SoftRelaxing {
  int steps = 40;
  double bending =
      100; ///< times that of the fabric at first; that of the fabric from half of the steps on
  double reach_m = 0.012, last_reach_m = 0.012; ///< of the soft contact, at first and at the end
  double cg_tolerance = 1e-4;                   ///< relative residual of a solve
};

/// What relaxing came to.
struct SoftRelaxed {
  bool finite = true;              ///< false: the garment is as it came
  double residual_force_ratio = 0; ///< StepResult's, of the last step
};

/// Lets sewn cloth come near its rest under its weight. It creeps on the skin as if it stuck to it,
/// since friction would decide.
SoftRelaxed relax_softly(Garment& garment, CollisionBody& body, const SoftRelaxing& how,
                         double gravity_m_s2, Reporter& reporter);

/// Cloth that is stiffer than the rest.
struct StiffRegion {
  std::vector<char> particles; ///< by particle; a hinge counts with any of its four
  double bending = 1;          ///< times the fabric's
};

/// As relax_softly(), but nothing grows softer: `how.bending` holds to the end, and what is stiff
/// springs flat, through other cloth. Fabrics bend alike in all directions here.
SoftRelaxed spring_softly(Garment& garment, CollisionBody& body, const SoftRelaxing& how,
                          const StiffRegion& stiff, double gravity_m_s2);

} // namespace sloper::garment

#pragma once
/// Sews a coarse mesh so that small differences of the start die out on the way.
///
/// What makes sewing on a fine mesh a matter of chance are decisions: flat panels that buckle one way or the other, contact that turns single
/// particles aside, steps that are shortened, solves that end early. Here nothing decides: panels are nearly rigid boards until the seams are closed,
/// contact is a smooth force (soft_body_contact.hpp), every step is solved exactly, and how hard stitches pull, how thick the body is and how stiff
/// cloth bends follow from the number of the step alone. On a coarse mesh that is cheap. Trouser legs are kept apart by a plane, other cloth may
/// pass through cloth. Measured: docs/decisions/drape-through-levels.md. Test: tests/garment/levels/test_coarse_sewing.cpp
#include <base/progress.hpp>
#include <body/body.hpp>
#include <garment/garment.hpp>
#include <garment/scene/settings.hpp>

#include <functional>

namespace sloper::garment {

struct CoarseSewing {
  int steps = 0;
  double widest_gap_m = 0; ///< of the stitches, when they were welded
};

/// @param garment   unsewn, with placed panels; out: sewn, near the body, without weight. Particles may lie in the skin by millimetres, or in cloth
/// @param body      null for none
/// @param on_step   may be empty: after each step, the positions of the unsewn garment, m
CoarseSewing sew_coarsely(Garment& garment, const body::Body* body, const DrapeSettings& settings, Reporter& reporter,
                          const std::function<void(const std::vector<Vec3>&)>& on_step = {});

/// Lets sewn cloth come towards rest under its weight, on the same smooth terms.
void relax_softly(Garment& garment, const body::Body* body, const DrapeSettings& settings, int steps, Reporter& reporter);

} // namespace sloper::garment

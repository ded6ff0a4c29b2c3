#pragma once
/// Drape: from placed panels or a kept garment to cloth at rest on a body.
/// docs/architecture.md describes the phases.
/// Test: tests/garment/drape/test_drape.cpp
#include <sloper/base/progress.hpp>
#include <sloper/body/body.hpp>
#include <sloper/garment/garment.hpp>
#include <sloper/garment/scene/settings.hpp>
#include <sloper/garment/simulate/report.hpp>
#include <sloper/garment/simulate/request.hpp>

#include <string>

namespace sloper::garment {

struct DrapeCheckpoint; ///< checkpoint.hpp

/// Drapes a garment: sews open seams, frees the start of the body, brings the cloth to
/// rest and audits it. Cost: 1.3 to 3.5 CPU seconds for garments of 3,200 to 5,800 particles from
/// panels at the preset "standard" (README.md).
/// @param garment  in: placed panels (particle_of empty: unsewn) or a sewn garment with
/// positions near the body; out: the state reached, whether or not at rest
/// @param body  nullptr for none
/// @param settings  of preset_settings() or changed by set_knob()
/// @param request  checkpoints, bounds of fit, facts of the start
/// @return the outcome; not converging is a result, not an exception
/// @throws Error INPUT for a garment that cannot be simulated
DrapeReport drape(Garment& garment, const body::Body* body, const DrapeSettings& settings,
                  Reporter& reporter, const DrapeRequest& request = {});

/// Continues a checkpoint to the garment that the uninterrupted run would have ended
/// with, bit by bit; settings are the checkpoint's.
/// @param garment  in: body_sha256 of the body, or empty to trust the caller; out: the
/// state reached
/// @param body  the one that the run began with
/// @param file  new checkpoints are written there; empty: nowhere
/// @throws Error INPUT for a file that is no checkpoint, for another body, or for a
/// checkpoint of drape_layers() or drape_in_motion(), which resume_job() continues
DrapeReport resume_drape(const std::string& checkpoint, Garment& garment, const body::Body* body,
                         Reporter& reporter, const std::string& file = "");

/// The same from a checkpoint in memory.
/// @param checkpoints  as for drape(); how often is the checkpoint's
DrapeReport resume_drape(const DrapeCheckpoint& checkpoint, Garment& garment,
                         const body::Body* body, Reporter& reporter,
                         const Checkpoints& checkpoints);

/// Draws crossing cloth apart and out of the body without draping: only cloth that
/// crosses moves, by short steps; where that does not suffice, the body is drawn in and
/// inflated again under the whole garment, without weight. Counts before and after are in
/// `quality.untangled` of the report.
/// @return converged: nothing crosses any more; a garment that was clean is unchanged, to
/// the bit
/// @throws Error INPUT for a garment that is not sewn
DrapeReport untangle_only(Garment& garment, const body::Body* body, const DrapeSettings& settings,
                          Reporter& reporter);

} // namespace sloper::garment

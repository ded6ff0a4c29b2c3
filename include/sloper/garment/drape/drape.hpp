#pragma once
/// Drape: from placed panels or a kept garment to cloth at rest on a body.
#include <sloper/base/progress.hpp>
#include <sloper/body/body.hpp>
#include <sloper/garment/garment.hpp>
#include <sloper/garment/scene/settings.hpp>
#include <sloper/garment/simulate/report.hpp>
#include <sloper/garment/simulate/request.hpp>

#include <string>

namespace sloper::garment {

struct DrapeCheckpoint; ///< checkpoint.hpp

/// Sews (when seams are open), repairs the start, drapes until at rest.
/// @param garment  in: placed panels (particle_of empty: unsewn) or a sewn garment with positions
/// near the body; out: the state reached
/// @param body     nullptr for none
/// @return what happened; not converging is a result, not an exception
/// @throws Error INPUT for a garment that cannot be simulated
DrapeReport drape(Garment& garment, const body::Body* body, const DrapeSettings& settings,
                  Reporter& reporter, const DrapeRequest& request = {});

/// Goes on from a checkpoint to the same garment, bit by bit, that the undisturbed run would have
/// come to; settings are the checkpoint's.
/// @param garment  in: body_sha256 of the body, or empty to trust the caller; out: the state
/// reached   @param body  the one that the run began with   @param file  new checkpoints go there;
/// empty: nowhere
/// @throws Error INPUT for what is no checkpoint, for another body, or for one of drape_layers() or
/// drape_in_motion(), which drape_job.hpp goes on with
DrapeReport resume_drape(const std::string& checkpoint, Garment& garment, const body::Body* body,
                         Reporter& reporter, const std::string& file = "");

/// The same from what was read. @param checkpoints  as for drape(); how often is the checkpoint's
DrapeReport resume_drape(const DrapeCheckpoint& checkpoint, Garment& garment,
                         const body::Body* body, Reporter& reporter,
                         const Checkpoints& checkpoints);

/// Draws crossing cloth apart and out of the body without draping: only what crosses moves, by
/// short steps; where that does not do, the body is drawn in and inflated again under the whole
/// garment, without weight. `quality.untangled` has the counts before and after; they are told.
/// @return converged: nothing crosses any more; a garment that was clean stays as it was, to the
/// bit
/// @throws Error INPUT for a garment that is not sewn
DrapeReport untangle_only(Garment& garment, const body::Body* body, const DrapeSettings& settings,
                          Reporter& reporter);

} // namespace sloper::garment

#pragma once
/// Panels draped through two meshes of their pattern: sewn on a coarse one where that is cheap and
/// contracts small differences, carried to the given one (coarse_start.hpp), and brought to rest
/// there, preset by preset: `draft` ends as soon as the carried cloth is clear of body and cloth,
/// and each finer preset goes on from where the one before comes to rest, so that what they differ
/// by is the error of the coarser one. Measured: docs/decisions/drape-through-levels.md. Test:
/// tests/garment/levels/test_levels.cpp
#include <sloper/base/progress.hpp>
#include <sloper/body/body.hpp>
#include <sloper/garment/garment.hpp>
#include <sloper/garment/scene/settings.hpp>
#include <sloper/garment/simulate/checkpoint.hpp>
#include <sloper/garment/simulate/report.hpp>
#include <sloper/garment/simulate/request.hpp>

namespace sloper::garment {

/// drape() of placed panels. Where refusal_of_levels() says so, and where the coarse mesh fails or
/// ends in crossings, they are sewn on the given mesh alone, as with DrapeSettings::levels = 1, and
/// DrapeReport::levels says why; what failed is in `repairs` too. `phases` has "sew coarse" and
/// "carry to the mesh" besides those of a session from a sewn start.
/// @param garment  in: placed panels, particle_of empty; out: the state reached
DrapeReport drape_through_levels(Garment& garment, const body::Body* body,
                                 const DrapeSettings& settings, Reporter& reporter,
                                 const DrapeRequest& request);

/// Goes on from a checkpoint that has `levels`, to the same bytes. @param checkpoints  as for
/// resume_drape()
DrapeReport resume_through_levels(const DrapeCheckpoint& from, Garment& garment,
                                  const body::Body* body, Reporter& reporter,
                                  const Checkpoints& checkpoints);

} // namespace sloper::garment

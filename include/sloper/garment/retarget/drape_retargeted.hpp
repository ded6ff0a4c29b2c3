#pragma once
/// The drape of a retargeted garment: from where it was placed or, where that crosses body or
/// cloth, from its own panels sewn anew around the other body.
/// Test: tests/garment/retarget/test_drape_retargeted.cpp
#include <sloper/base/progress.hpp>
#include <sloper/body/body.hpp>
#include <sloper/garment/retarget/retarget.hpp>
#include <sloper/garment/scene/settings.hpp>
#include <sloper/garment/simulate/report.hpp>
#include <sloper/garment/simulate/request.hpp>

namespace sloper::garment {

/// Drapes a retargeted garment.
///
/// There are two starts. A placed garment hangs nearly where it belongs and needs few steps. Its
/// panels, placed around the body and sewn on a coarse mesh first (DrapeSettings::levels), need
/// more, but begin without a crossing. They come first where the placed garment still crosses body
/// or cloth after it was cleared (Retargeted::is_tangled). The other start is tried where the first
/// ends in crossings, or moves no further; with KEEP_FABRIC also at the step limit. `repairs` of
/// the report says so.
///
/// Of 48 fresh bodies in natural stance and four garments, 192 drapes with KEEP_FIT, 7 ended in
/// crossings from the placed garment alone and none with both starts; the mean cell took 4.8 CPU s
/// before and 3.8 since.
/// @param retargeted  of retarget() or widen_strained_pieces(); out: the state reached, of the same
/// particles
/// @param source  that it was retargeted from
/// @param request  for the placed garment; a garment sewn anew takes its bounds
/// @return of both drapes together where there were two
/// @throws Error INPUT for a garment that cannot be simulated
DrapeReport drape_retargeted(Retargeted& retargeted, const Garment& source, const body::Body& body,
                             RetargetMode mode, const DrapeSettings& settings, Reporter& reporter,
                             const DrapeRequest& request);

/// The panels of a retargeted garment, placed around the body and unsewn, on the same mesh.
/// @param garment  on the body   @param source  that it was retargeted from
/// @return the reason why it cannot be sewn anew; empty: `panels` is set
std::string panels_anew(const Garment& garment, const Garment& source, const body::Body& body,
                        RetargetMode mode, const DrapeSettings& settings, Garment& panels);

} // namespace sloper::garment

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

#include <functional>
#include <string>

namespace sloper::garment {

/// What retarget() made a garment from.
struct RetargetedFrom {
  const Garment& source;  ///< at rest on another body
  const body::Body& body; ///< that it was placed on
  RetargetMode mode;      ///< of retarget()
};

/// Drapes a retargeted garment.
///
/// There are two starts. A placed garment hangs nearly where it belongs and needs few steps. Its
/// panels, placed around the body and sewn on a coarse mesh first (DrapeSettings::levels), need
/// more, but begin without a crossing. They come first where the placed garment still crosses body
/// or cloth after it was cleared (Retargeted::is_tangled), unless its sleeves are folded at the
/// wrists, where only the placed garment keeps them. The other start is tried where the first ends
/// in crossings or moves no further, with KEEP_FABRIC also at the step limit, and where a tangled
/// garment is not worn well from the first. `repairs` of the report says so.
///
/// Of 48 fresh bodies in natural stance and four garments, 192 drapes with KEEP_FIT, 7 ended in
/// crossings from the placed garment alone and none with both starts; the mean cell took 4.8 CPU s
/// before and 3.8 since.
/// @param retargeted  of retarget() or widen_strained_pieces(); out: the state reached, of the same
/// particles
/// @param from  its source
/// @param request  for the placed garment; a garment sewn anew takes its bounds
/// @param is_worn_well  of a clean drape, whether its fit is accepted; empty: it is
/// @return of both drapes together where there were two
/// @throws Error INPUT for a garment that cannot be simulated
DrapeReport drape_retargeted(Retargeted& retargeted, const RetargetedFrom& from,
                             const DrapeSettings& settings, Reporter& reporter,
                             const DrapeRequest& request,
                             const std::function<bool(const Garment&)>& is_worn_well = {});

/// The panels of a retargeted garment, placed around the body and unsewn, on the same mesh.
/// @param garment  on the body
/// @return the reason why it cannot be sewn anew; empty: `panels` is set
std::string panels_anew(const Garment& garment, const RetargetedFrom& from,
                        const DrapeSettings& settings, Garment& panels);

} // namespace sloper::garment

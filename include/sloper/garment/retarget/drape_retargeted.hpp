#pragma once
/// The drape of a retargeted garment: relaxed softly where it was placed or, where that fails, from
/// its own panels sewn anew around the other body.
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
/// A placed garment first relaxes under smooth contact (levels/coarse_start.hpp), where all its
/// effects are known to that (DrapeSettings::levels above 1, no pleats, roll lines or scene
/// effects), unless it is the same cloth on its own body or its sleeves reach over the hands. Folds
/// of the placing, crossings among them, go flat, and drapes whose placing differs by a micrometre
/// end 0.4 mm apart in the median, not 4. The second start is its panels, placed around the body
/// and sewn on a coarse mesh. It is tried where the first drape ends in crossings or moves no
/// further, with KEEP_FABRIC also at the step limit, and where a tangled garment
/// (Retargeted::is_tangled) is not worn well from the first. What cannot be relaxed is draped as it
/// was placed; tangled, its panels come first, unless its sleeves are folded, since only the placed
/// garment keeps them. `repairs` of the report says what was done.
///
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

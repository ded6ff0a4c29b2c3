#pragma once
/// The whole of a retargeting: place, drape, judge and, with keep-fit, let out what is too tight.
/// Test: tests/garment/retarget/test_retarget_job.cpp
#include <sloper/base/progress.hpp>
#include <sloper/body/body.hpp>
#include <sloper/collision/body_collider.hpp>
#include <sloper/garment/fit/fit_policy.hpp>
#include <sloper/garment/fit/fit_report.hpp>
#include <sloper/garment/retarget/retarget.hpp>
#include <sloper/garment/scene/settings.hpp>
#include <sloper/garment/simulate/report.hpp>

#include <string>

namespace sloper::garment {

/// What to retarget, and how.
struct RetargetJob {
  const Garment& source;                         ///< bound, at rest on the first body
  const body::Body& body;                        ///< the other body
  const collision::BodyCollider& skin;           ///< of the other body
  std::string skin_sha256;                       ///< of the other body's skin
  RetargetMode mode = RetargetMode::KEEP_FABRIC; ///< whether the pattern is graded
  DrapeSettings settings;                        ///< `max_seconds` holds for all drapes together
  const FitPolicy& policy;                       ///< by which the garment is judged
  bool no_drape = false;                         ///< only place the garment
};

/// What came of it.
struct RetargetOutcome {
  Retargeted retargeted; ///< its garment bound to the other body, in the state reached
  DrapeReport report;    ///< of the last drape; PLACED_ONLY and NOT_DRAPED where there was none
  FitReport fit;         ///< of the garment as it ended
  /// With keep-fit, after a drape: which close girths have another ease than on the first body
  /// ("has 14.4 cm more ease at the bust than on the body that it comes from: 22.6 cm, there
  /// 8.2 cm"), or empty.
  std::string changed_ease;
  std::string stretched_at; ///< stretched_place() of a garment that was draped, or empty

  /// Whether a drape was tried.
  bool was_draped() const {
    return report.stop_reason != StopReason::PLACED_ONLY &&
           report.stop_reason != StopReason::NOT_DRAPED;
  }
};

/// Retargets a garment.
///
/// A garment whose cloth does not reach round the body is judged where it was placed and not
/// draped (fit_before_drape()). With KEEP_FIT a garment that comes out too small is graded again
/// and draped again, up to MOST_GRADINGS gradings in all; each takes a drape of 1 to 3 s for 4,000
/// particles. A garment that fits but cannot come to rest on the body (why_stuck()) does not fit.
/// @throws Error INPUT when the garment is not bound, hangs on a part that the body lacks, or
/// cannot be simulated
RetargetOutcome retarget_and_judge(const RetargetJob& job, Reporter& reporter);

} // namespace sloper::garment

#pragma once
/// Retargeting: the same garment on another body, placed by body-relative coordinates and
/// freed from the skin. A short drape follows (garment::drape), warm because the placed
/// garment already lies where it belongs.
/// Test: tests/garment/retarget/test_retarget.cpp
#include <sloper/base/message.hpp>
#include <sloper/base/progress.hpp>
#include <sloper/body/body.hpp>
#include <sloper/collision/body_collider.hpp>
#include <sloper/garment/garment.hpp>
#include <sloper/garment/simulate/request.hpp>
#include <sloper/io/json_fwd.hpp>

namespace sloper::garment {

/// Whether the garment keeps its pattern or is graded.
enum class RetargetMode {
  KEEP_FABRIC, ///< the same sewn garment: rest lengths unchanged; it may not fit
  /// Graded: the pattern is changed so that the gap to the skin, and with it the ease per
  /// level, stays.
  KEEP_FIT
};
/// "keep-fabric" or "keep-fit".
/// @throws Error USAGE
RetargetMode retarget_mode_from_name(const std::string& name);

/// Penetrations of a placed garment, before any simulation.
struct PlacementState {
  int vertices_inside = 0;    ///< particles inside the body
  double deepest_m = 0;       ///< of those
  int faces_through = 0;      ///< garment triangles that cross the skin
  int self_intersections = 0; ///< pairs of garment triangles that cross
};
/// Outcome of placing a garment, for report.json.
struct PlacementReport {
  PlacementState placed;  ///< by coordinates alone
  PlacementState cleared; ///< after settle_shape()
  int clear_rounds = 0;   ///< of settle_shape()
  /// Edge length after / before - 1, placed against the source.
  double stretch_p01 = 0, stretch_p50 = 0, stretch_p99 = 0;
  double settled_p01 = 0, settled_p50 = 0, settled_p99 = 0; ///< the same after settle_shape()
  double largest_move_m = 0;                                ///< of settle_shape()
  int mirrored_panels = 0; ///< keep-fit: graded together with their mirror images
  int gradings = 0;        ///< keep-fit: by retarget() and widen_strained_pieces()
  /// keep-fabric: how much lower than by coordinates a skirt or trousers are worn, because the top
  /// edge does not close there; 0 to 0.1.
  double seated_lower_m = 0;
  std::vector<Message> findings; ///< keep-fit: of the last regrade()
};
/// `placement` of report.json.
io::Json placement_json(const PlacementReport& report);

/// The cloth of settle_shape().
struct ShapeToSettle {
  const std::vector<Vec3>& shape;         ///< #P by 3, m: at rest or nearly so
  const std::vector<Triangle>& triangles; ///< of particles
  std::vector<int> held = {};             ///< particles that stay near where they were placed
  int max_rounds = 40;                    ///< of shape and contact
};

/// Restores the shape of placed cloth and moves it out of the skin: minimises the
/// as-rigid-as-possible energy of `cloth.shape` (Sorkine and Alexa 2007) plus the squared
/// distance from where it was placed over 25 cm, under pushes that keep particles and
/// faces `gap` off the skin. Quasi-static and without inertia; the drape resolves the
/// strain that remains. About 0.1 s a round for 7,000 particles.
/// @param positions  #P by 3, m, in and out
/// @return rounds taken; at most max_rounds, four times as many while fewer than a
/// hundredth of the faces are still through the skin, as of a collar that was placed in a
/// chin. The drape resolves what is left.
int settle_shape(std::vector<Vec3>& positions, const ShapeToSettle& cloth,
                 const collision::BodyCollider& body, double gap);

/// Settled cloth at the distance from the skin that it will have once it is pressed to
/// it: cloth that was placed within `gap` of the skin is as near as it was placed, though
/// no nearer than tight cloth lies, half of the gap. If grading took the places after
/// settle_shape(), which pushes out of the gap, each close girth would get a centimetre
/// of ease.
/// @param settled, placed  #P by 3, m: after and before settle_shape()
/// @param gap  m
std::vector<Vec3> as_near_as_placed(std::vector<Vec3> settled, const std::vector<Vec3>& placed,
                                    const collision::BodyCollider& skin, double gap);

/// Why a garment cannot be worn by a body whatever its size ("hangs on upper_arm_l, which
/// the body lacks"), or empty. A shirt needs arms, but a collar that lies on the
/// shoulders does not need a head.
std::string why_impossible(const Garment& garment, const body::Body& body);

/// Why a garment could not come to rest on a body ("has a left sleeve, and no cloth goes
/// between the scan's left arm and its trunk, which touch"), or empty: it has a sleeve on
/// a side without a found arm pit.
/// @param garment  bound to a body
/// @param body  measured
std::string why_stuck(const Garment& garment, const body::Body& body);

/// A garment placed on another body, ready to be draped.
struct Retargeted {
  /// Placed on the new body and clear of its skin, still bound to the old one; converged
  /// is false.
  Garment garment;
  std::vector<Vec3> placed; ///< #P by 3, m: by coordinates alone, not yet seated lower
  /// Sleeves or legs that are longer than the limbs in them, with their ends at wrists or ankles:
  /// for StartFacts::hold_ends.
  LimbEnds folded = LimbEnds::NONE;
  /// Ease that the same cloth had on the first body, by girth: close ones (keep_ease.hpp).
  std::map<std::string, double> source_ease_m = {};
  bool is_tangled = false; ///< the garment crosses body or cloth, though it was cleared
  PlacementReport report;  ///< of the placing
};
/// Places a garment on another body and clears it from the skin; with KEEP_FIT the
/// pattern is graded.
/// @param garment  bound, at rest on the first body
/// @param to  the other body
/// @param skin  collider of the other body's skin
/// @throws Error INPUT when the garment is not bound or hangs on a part that `to` lacks
Retargeted retarget(const Garment& garment, const body::Body& to,
                    const collision::BodyCollider& skin, RetargetMode mode, Reporter& reporter);

/// With keep-fit, after a drape that ended too tight: grades the source's pattern once
/// more, for the places where its cloth lies on the other body, and wider where it is
/// stretched there. Cloth strained by more than 1 % is cut for its strain on either body,
/// and longer by twice its strain beyond; the reason is that cloth slides a little from
/// where it was placed, so that a narrow girth lies where the body is wide. Cloth in
/// folds keeps its lengths. A short drape must follow.
/// @param worn  of retarget(), its garment draped on `to`; in and out
/// @param source  the garment that retarget() was given
void widen_strained_pieces(Retargeted& worn, const Garment& source, const body::Body& to);

} // namespace sloper::garment

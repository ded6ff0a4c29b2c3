#pragma once
/// Retargeting: the same garment on another body, placed by body-relative coordinates and made free
/// of the skin.
///
/// What follows is a short drape (garment::drape), warm because the placed garment already lies
/// where it belongs.
#include <sloper/base/progress.hpp>
#include <sloper/body/body.hpp>
#include <sloper/collision/body_collider.hpp>
#include <sloper/garment/garment.hpp>
#include <sloper/io/json_fwd.hpp>

namespace sloper::garment {

enum class RetargetMode {
  KEEP_FABRIC, ///< the same sewn garment: rest lengths unchanged, which may turn out not to fit
  KEEP_FIT ///< regraded: the pattern is made over so that the gap to the skin, and with it the ease
           ///< per level, stays
};
RetargetMode retarget_mode_from_name(
    const std::string& name); ///< "keep-fabric" or "keep-fit" @throws Error USAGE

/// How a placed garment lies, before any simulation.
struct PlacementState {
  int vertices_inside = 0;    ///< particles inside the body
  double deepest_m = 0;       ///< of those
  int faces_through = 0;      ///< garment triangles that cross the skin
  int self_intersections = 0; ///< pairs of garment triangles that cross
};
struct PlacementReport {
  PlacementState placed;  ///< by coordinates alone
  PlacementState cleared; ///< after settle_shape()
  int clear_rounds = 0;
  double stretch_p01 = 0, stretch_p50 = 0,
         stretch_p99 = 0; ///< edge length after / before - 1, placed against the source
  double settled_p01 = 0, settled_p50 = 0, settled_p99 = 0; ///< the same after settle_shape()
  double largest_move_m = 0;                                ///< of settle_shape()
  int mirrored_panels = 0;           ///< keep-fit: graded together with their mirror images
  int gradings = 0;                  ///< keep-fit: by retarget() and widen_strained_pieces()
  std::vector<std::string> findings; ///< keep-fit: of the last regrade()
};
io::Json placement_json(const PlacementReport& report);

/// Brings placed cloth near its own shape and out of the skin: minimises the as-rigid-as-possible
/// energy of `shape` (Sorkine and Alexa 2007) plus the squared way from where it was placed over 25
/// cm, under pushes that keep particles and faces `gap` off the skin. Quasi-static and without
/// inertia; what strain remains is the drape's.
/// @param positions #P by 3, m, in and out   @param shape #P by 3, m: the cloth at rest or nearly
/// so
/// @param held particles that are kept near where they were placed
/// @return rounds taken; at most max_rounds, four times as many while a few faces, fewer than a
/// hundredth, are still through the skin, as of a collar that was placed in a chin. What then still
/// touches is left to the drape. About 0.1 s a round for 7k particles.
int settle_shape(std::vector<Vec3>& positions, const std::vector<Vec3>& shape,
                 const std::vector<Triangle>& triangles, const collision::BodyCollider& body,
                 double gap, const std::vector<int>& held = {}, int max_rounds = 40);

/// Settled cloth where it will lie once it is pressed to the skin: what was placed within `gap` of
/// it is as near as it was placed, though no nearer than tight cloth lies, half of the gap. Graded
/// to where settle_shape() pushed it out of the gap, each girth that fits closely would get a
/// centimetre of ease.
/// @param settled, placed  #P by 3, m: after and before settle_shape()
std::vector<Vec3> as_near_as_placed(std::vector<Vec3> settled, const std::vector<Vec3>& placed,
                                    const collision::BodyCollider& skin, double gap);

/// Why a garment cannot go on a body whatever its size ("hangs on upper_arm_l, which the body
/// lacks"), or nothing: a shirt cannot do without arms, but a collar that lies on the shoulders can
/// do without a head.
std::string why_impossible(const Garment& garment, const body::Body& body);

/// Why a garment that did not come to rest on a body could not ("has a left sleeve, and no cloth
/// goes between the scan's left arm and its trunk, which touch"), or nothing: it has a sleeve on a
/// side on which no arm pit was found.
/// @param garment bound to a body   @param body measured
std::string why_stuck(const Garment& garment, const body::Body& body);

struct Retargeted {
  Garment garment; ///< placed on the new body and clear of its skin, still bound to the old one;
                   ///< converged is false
  std::vector<Vec3> placed;        ///< #P by 3, m: by coordinates alone
  bool has_folded_sleeves = false; ///< longer than the arms, and their ends are at the wrists: for
                                   ///< StartFacts::hold_sleeve_ends
  PlacementReport report;
};
/// @throws Error INPUT when the garment is not bound or hangs on a part that `to` lacks
Retargeted retarget(const Garment& garment, const body::Body& to,
                    const collision::BodyCollider& skin, RetargetMode mode, Reporter& reporter);

/// keep-fit, after a drape that ended too tight: makes the source's pattern over once more, for
/// where its cloth came to lie on the other body and wider where it is stretched there: what is
/// strained by more than 1 % is cut for that, on either body, and longer by twice its strain
/// beyond. Cloth slides a little from where it was placed, and a narrow girth then lies where the
/// body is wide; what is tight on the first body would be tight on any. What hangs in folds keeps
/// the lengths that it has. Another drape, a short one, is to follow.
/// @param worn  of retarget(), its garment draped on `to`; in and out   @param source  what
/// retarget() was given
void widen_strained_pieces(Retargeted& worn, const Garment& source, const body::Body& to);

} // namespace sloper::garment

#pragma once
/// Retargeting: the same garment on another body, placed by body-relative coordinates and made free of the skin.
///
/// What follows is a short drape (garment::drape), warm because the placed garment already lies where it belongs.
#include <base/progress.hpp>
#include <body/body.hpp>
#include <collision/body_collider.hpp>
#include <garment/garment.hpp>
#include <io/json.hpp>

namespace sloper::garment {

enum class RetargetMode {
  KEEP_FABRIC, ///< the same sewn garment: rest lengths unchanged, which may turn out not to fit
  KEEP_FIT     ///< regraded: the pattern is made over so that the gap to the skin, and with it the ease per level, stays
};
RetargetMode retarget_mode_from_name(const std::string& name); ///< "keep-fabric" or "keep-fit" @throws Error USAGE

/// How a placed garment lies, before any simulation.
struct PlacementState {
  int vertices_inside = 0;    ///< particles inside the body
  double deepest_m = 0;       ///< of those
  int faces_through = 0;      ///< garment triangles that cross the skin
  int self_intersections = 0; ///< pairs of garment triangles that cross
};
struct PlacementReport {
  PlacementState placed;  ///< by coordinates alone
  PlacementState cleared; ///< after clear_skin()
  int clear_rounds = 0;
  double stretch_p01 = 0, stretch_p50 = 0, stretch_p99 = 0; ///< edge length after / before - 1, placed against the source
  double largest_move_m = 0;                                ///< of clear_skin()
};
io::Json placement_json(const PlacementReport& report);

/// Moves what lies in or nearer than `gap` to the skin outward, spread smoothly over the garment: minimises the squared move plus
/// the squared gradient of it over 4 cm, under the pushes of particles and of faces that the body shows through.
/// @param positions #P by 3, m, in and out   @return rounds taken; at most max_rounds, what then remains is left to the drape
int clear_skin(std::vector<Vec3>& positions, const std::vector<Triangle>& triangles, const collision::BodyCollider& body, double gap, int max_rounds = 20);

/// Frames that some of the garment hangs on mainly and the body lacks, with the share of the garment that does: a shirt cannot
/// do without arms, but a collar that lies on the shoulders can do without a head.
std::map<std::string, double> missing_frames(const Garment& garment, const body::Body& body);

struct Retargeted {
  Garment garment; ///< placed on the new body, still bound to the old one; converged is false
  PlacementReport report;
};
/// @throws Error INPUT when the garment is not bound or hangs on a part that `to` lacks
Retargeted retarget(const Garment& garment, const body::Body& to, const collision::BodyCollider& skin, RetargetMode mode, Reporter& reporter);

} // namespace sloper::garment

#pragma once
/// Scans that end above the feet: a torso with or without its head, arms and thighs.
///
/// Rules of proportion need a stature and a floor. Both are estimated from the head (its breadth,
/// and how far the neck's narrowest place lies below the crown), plain legs are set under the torso
/// so that every rule runs as usual, and afterwards everything that rests on what the scan does not
/// show is forgotten again. Test: tests/body/ingest/test_torso_only.cpp
#include <body/ingest/canonical_frame.hpp>
#include <optional>
#include <sloper/body/body.hpp>
#include <string>
namespace sloper::body {

/// A scan of a torso with plain legs under it.
struct CompletedTorso {
  TriangleMesh
      scan; ///< the scan's own vertices first, then points of plain legs; the file's unit and axes
  std::vector<char>
      is_cut; ///< one per vertex of the scan: 1 for the rim or lid where the torso ends
  Vec3 up = Vec3::UnitY();
  double seen_from =
      0; ///< height along `up` down to which the trunk is in the scan, the file's unit
  double seen_to = 1e300; ///< height along `up` up to which it is, the file's unit
  bool has_head = true;
  std::string lacks;  ///< why its own faces are not enough: "it has no legs"
  double stature = 0; ///< estimated, without a head as given, the file's unit
};

/// @param up_axis "auto", "x", "y" or "z"
/// @throws Error INPUT when there is no head above a neck and shoulders, or less of a trunk than
/// the chest
CompletedTorso complete_torso(const TriangleMesh& scan, const std::string& up_axis,
                              const SizeOptions& size, const std::string& file);

/// The same of a trunk whose neck is cut off, as a tailor's dummy: a plain head is set on it too.
/// The floor lies below the shoulders by the stature that `size` gives.
/// @return nothing where no neck widens to shoulders
/// @throws Error INPUT where `size` has no stature
std::optional<CompletedTorso> complete_headless(const TriangleMesh& scan,
                                                const std::string& up_axis, const SizeOptions& size,
                                                const std::string& file);

/// Between which heights a body is in its scan, m, body frame.
struct SeenHeights {
  double from = 0, to = 1e300;
  bool has_head = true;
};

/// Drops landmarks, levels, girths and skin that rest on what lies outside of `seen`, and says so
/// in the findings.
void forget_unseen(Body& body, const SeenHeights& seen);

} // namespace sloper::body

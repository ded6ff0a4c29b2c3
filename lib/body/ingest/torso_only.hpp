#pragma once
/// Scans that end above the feet: a torso with its head, with or without arms and thighs.
///
/// Rules of proportion need a stature and a floor. Both are estimated from the head (its breadth,
/// and how far the neck's narrowest place lies below the crown), plain legs are set under the torso
/// so that every rule runs as usual, and afterwards everything that rests on what the scan does not
/// show is forgotten again. Test: tests/body/ingest/test_torso_only.cpp
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
      0;              ///< height along `up` down to which the trunk is in the scan, the file's unit
  double stature = 0; ///< estimated, the file's unit
};

/// @param up_axis "auto", "x", "y" or "z"
/// @throws Error INPUT when there is no head above a neck and shoulders, or less of a trunk than
/// the chest
CompletedTorso complete_torso(const TriangleMesh& scan, const std::string& up_axis,
                              const std::string& file);

/// Drops landmarks, levels, girths and skin that rest on what lies below `seen_from`, m, body
/// frame, and says so in the findings.
void forget_unseen(Body& body, double seen_from);

} // namespace sloper::body

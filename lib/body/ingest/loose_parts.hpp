#pragma once
/// Shells beside the body's own: hair, hats, shoes, glasses, eyes, clothes, a stand. A body that is
/// one closed shell needs none of the others, and its stature is measured without them.
#include <sloper/body/body.hpp>
namespace sloper::body {

/// Vertices that are not the body, and findings on those that may not be.
struct LooseParts {
  std::vector<char> is_extra; ///< one per vertex of the scan; empty where there is none
  std::vector<Finding> findings;
};

/// The shells of `scan` that are not the body: where the largest one is closed but for small holes
/// and shows a whole person by itself, all others that lie within or close around it. Where it is
/// not, all are kept, and those that reach above or below the largest are reported, since the
/// stature includes them. What lies farther off, as a floor or debris does, is left to
/// segment_scan().
/// @param scan any frame and unit
/// @param up_axis as for segment_scan()
LooseParts find_loose_parts(const TriangleMesh& scan, const std::string& up_axis);

} // namespace sloper::body

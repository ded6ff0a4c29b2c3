#pragma once
/// Which way is up by the body alone: the same whichever way the scan lies in its file.
#include <body/ingest/canonical_frame.hpp>
namespace sloper::body {

/// What the body's shape says of the vertical: unit vectors in the scan's frame.
struct ShapeVertical {
  Vec3 up; ///< sideways that of the trunk's mirror plane, forwards that of posture, each drawn
           ///< towards the soles
  Vec3 by_posture; ///< by mirror plane and posture alone: the head is as far before the calves as
                   ///< people's heads are
  std::optional<Vec3> by_soles; ///< square to the plane on which both feet rest
};

/// @param points of the body, scan units
/// @param frame about the body's, by any vertical that is some degrees off at most
/// @return nothing where head, calves or trunk do not show
std::optional<ShapeVertical> vertical_of_shape(std::vector<Vec3> points,
                                               const CanonicalFrame& frame);

/// Turns `frame` to the body's own vertical, where that is sure. The body's and the file's may
/// differ by a posture that is not the usual one: the file's stays where the two are more than a
/// little apart and posture or soles agree with the file. `sorted` gets the new vertical with the
/// body's extent along it. The angle between the two is a finding of the frame. Cost: linear,
/// some 50 ms for 100,000 vertices.
/// @param points of the body, scan units
/// @param upright_file false where `frame` owes its vertical to upright_turn
void settle_vertical(const TriangleMesh& scan, const std::vector<Vec3>& points,
                     SegmentedScan& sorted, CanonicalFrame& frame, bool upright_file);

/// How far the vertical by which a body was probably scanned leans forward of its own, rad, from
/// how far head, chest and toes are before the calves: of 400 fresh bodies that stand by their own
/// vertical, half of them in natural stances, the file's is off by 0.33 degrees (standard
/// deviation) about a mean of -0.45; by this 0.19, cross validated. Both hold for natural stances
/// as for A and T.
/// @param points of the body, m, standing by its own vertical, the soles at y = 0, looking to +z
double likeliest_lean(const std::vector<Vec3>& points, double stature);

} // namespace sloper::body

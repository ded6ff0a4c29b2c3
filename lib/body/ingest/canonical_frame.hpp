#pragma once
/// From the scan's frame to the body's: unit, up axis, facing. Metres, +y up, the body faces +z, +x
/// is its left.
#include <body/ingest/segmentation.hpp>
namespace sloper::body {

struct CanonicalFrame {
  Mat4 scan_to_body = Mat4::Identity(); ///< similarity; feet at y = 0, legs' middle at x = z = 0
  std::string unit, front; ///< "m", "cm", "mm", "inch"; "+z" or a direction in the scan's frame
  double stature_m = 0;
  std::vector<Finding> findings;
};

constexpr std::size_t SHAPE_POINTS =
    60000; ///< for medians of radii, more points of the body are not needed

/// @param shape points_of_body(), about SHAPE_POINTS of them, scan units
/// @param unit "auto", "m", "cm" or "mm"
/// @throws Error INPUT (naming `file`) where the scan is no standing body or no unit makes it one
CanonicalFrame guess_frame(const TriangleMesh& scan, const SegmentedScan& sorted,
                           const std::vector<Vec3>& shape, const std::string& unit,
                           const std::string& file);

/// Turns and shifts a frame whose heading is right to a few degrees so that the trunk is its own
/// mirror image; fills `front`.
/// @param points of the body, scan units
void refine_heading(std::vector<Vec3> points, CanonicalFrame& frame);

/// A rigid turn about y by `angle` (rad, from +z towards +x) and a shift, as a 4x4.
Mat4 turn_and_shift(double angle, const Vec3& shift);
Vec3 transform(const Mat4& m, const Vec3& p);

} // namespace sloper::body

#pragma once
/// From the scan's frame to the body's: unit, up axis, facing. Metres, +y up, the body faces +z, +x
/// is its left.
#include <body/ingest/segmentation.hpp>
namespace sloper::body {

/// How a scan is brought into the body frame, and how that was found.
struct CanonicalFrame {
  Mat4 scan_to_body = Mat4::Identity(); ///< similarity; feet at y = 0, legs' middle at x = z = 0
  std::string unit, front; ///< name of a LengthUnit, "given scale" or "given stature"; "+z" or a
                           ///< direction in the scan's frame
  double stature_m = 0;
  std::vector<Finding> findings;
};

/// A unit that a scan may be in.
struct LengthUnit {
  const char* name;
  double metres;
  double rare; ///< factors of e that a stature may be more unusual before this unit is taken: files
               ///< in it are rarer
};
inline constexpr LengthUnit LENGTH_UNITS[] = {{"m", 1, 0},       {"cm", 0.01, 0},
                                              {"mm", 0.001, 0},  {"inch", 0.0254, 0.15},
                                              {"dm", 0.1, 0.35}, {"foot", 0.3048, 0.35}};

/// What a user says of the scan's size; the first that is given counts.
struct SizeOptions {
  double stature_m = 0;       ///< of the person as the scan stands, m; 0 where it is not given
  double metres_per_unit = 0; ///< of the scan's coordinates; 0 where it is not given
  std::string unit =
      "auto"; ///< name of a LengthUnit; auto: the one in which the stature is the most usual
};

/// The second guess, as "0.66 m in inch", where it is not much less likely than the unit that was
/// guessed; else empty.
std::string other_guess(double stature_m, const LengthUnit& own);

constexpr std::size_t SHAPE_POINTS =
    60000; ///< for medians of radii, more points of the body are not needed

/// @param shape points_of_body(), about SHAPE_POINTS of them, scan units
/// @throws Error INPUT (naming `file`) where the scan is no standing body or no unit makes it one
CanonicalFrame guess_frame(const TriangleMesh& scan, const SegmentedScan& sorted,
                           const std::vector<Vec3>& shape, const SizeOptions& size,
                           const std::string& file);

/// Turns and shifts a frame whose heading is right to a few degrees so that the trunk is its own
/// mirror image; fills `front`.
/// @param points of the body, scan units
void refine_heading(std::vector<Vec3> points, CanonicalFrame& frame);

/// A rigid turn about y by `angle` (rad, from +z towards +x) and a shift, as a 4x4.
Mat4 turn_and_shift(double angle, const Vec3& shift);
Vec3 transform(const Mat4& m, const Vec3& p);

} // namespace sloper::body

#pragma once
/// What in a scan is the body and what is floor, pole or debris; which way is up. Works on coarse
/// voxels, so it does not care whether the scan is a mesh, bare points, or slices, and needs no
/// unit.
#include <array>
#include <sloper/body/body.hpp>
namespace sloper::body {

/// A scan parted into the body and the rest.
struct SegmentedScan {
  Vec3 up = Vec3::UnitY();             ///< axis direction in the scan's frame
  std::string up_name;                 ///< "+y", "-z", ...
  double up_score = 0, next_score = 0; ///< of the best and of the second-best direction, 0..1
  bool falls_apart = false;            ///< large pieces over or under the body are not joined to it
  double cell = 0;                     ///< voxel size, scan units
  double low = 0, high = 0;            ///< extent of the body along up, scan units
  std::vector<char> is_body;           ///< one per vertex of the scan
  double second_share = 0; ///< voxels of the second-largest standing thing / those of the body
  double leg_share = 0,
         head_share =
             0; ///< share of the lower levels with two legs, of the upper ones with a narrow top
  bool has_floor = false;
  double floor_height = 0; ///< along up, scan units
  int n_debris = 0;        ///< loose pieces left out
};

/// @param up_axis "auto", "x", "y" or "z" (both signs are tried)
SegmentedScan segment_scan(const TriangleMesh& scan, const std::string& up_axis);

/// The same of the vertices that `is_extra` (one per vertex, or empty) does not leave out, which
/// are no body.
SegmentedScan segment_without(const std::vector<char>& is_extra, const TriangleMesh& scan,
                              const std::string& up_axis);

/// The same in one reading with cells of the longest side / `n_cells`: to compare many directions.
SegmentedScan sort_coarsely(const TriangleMesh& scan, const std::string& up_axis, int n_cells);

/// About `wanted` points of the body, scan units: every so many of its vertices, and points spread
/// over its larger faces, so that a coarse mesh shows its shape as a fine one does. @param is_body
/// one per vertex
std::vector<Vec3> points_of_body(const TriangleMesh& scan, const std::vector<char>& is_body,
                                 std::size_t wanted);

/// Two legs below, a narrow top: a whole person stands along `up`.
bool shows_a_person(const SegmentedScan& sorted);

} // namespace sloper::body

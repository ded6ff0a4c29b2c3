#pragma once
/// Landmarks on skin that the scan does not show: a hole that was closed, or a gap that a rebuilt
/// skin spans.
#include <sloper/body/body.hpp>
#include <sloper/body/landmarks/corrections.hpp>
namespace sloper::body {

/// Where a skin is far from all points of its scan.
struct MadeUpSkin {
  double far_m = 0;          ///< from here on
  std::vector<Vec3> middles; ///< of its faces that are as far, frame of the skin, m
  /// Whether a landmark at `p`, m, rests on it.
  bool is_beside(const Vec3& p, double stature) const;
};

/// @param points, on_faces  of the scan's body: its vertices, and points spread over its larger
/// faces, frame of the skin, m
MadeUpSkin made_up_skin(const TriangleMesh& skin, double stature, const std::vector<Vec3>& points,
                        const std::vector<Vec3>& on_faces);

/// Warns of each landmark of the skin that lies near a place where body.skin is made up, where
/// nothing has warned of it, and widens its spread to that distance: the arm pits of a scan with
/// holes there were 4 cm too low, where the closed skin has its fold. Crown and feet are left out:
/// what was cut off there changes them by millimetres.
/// @param confirmed  landmarks that a second method confirms: they are not warned of
void doubt_made_up_skin(Body& body, const MadeUpSkin& made_up,
                        const std::vector<std::string>& confirmed);

/// The arm pits, with their folds, that are as high as head and shoulders let expect
/// ("axilla_by_shoulders" of the corrections), which no closed gap beside the arm changes.
/// @param features of the same body
std::vector<std::string> confirmed_pits(const Body& body, const Corrections& corrections,
                                        const ShapeFeatures& features);

/// Whether the arm pits are half a standard deviation lower than head and shoulders let expect,
/// mean of both: no proof by itself that skin has grown together there. Arguments as above.
bool pits_are_low(const Body& body, const Corrections& corrections, const ShapeFeatures& features);

} // namespace sloper::body

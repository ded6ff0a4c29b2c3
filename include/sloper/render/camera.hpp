#pragma once
/// Where the scene is seen from.
#include <optional>
#include <sloper/geometry/triangle_mesh.hpp>
#include <sloper/render/scene.hpp>
namespace sloper::render {

/// A request for a camera; the rest follows from the scene.
struct CameraOptions {
  /// Direction to the viewer, rad: 0, 0 looks at the front, azimuth turns the viewer to
  /// the body's left.
  double azimuth = 0, elevation = 0;
  double field_of_view = 0.30; ///< rad, vertical; 0 is orthographic
  /// Height of the picture at the target's distance, m; 0 frames the scene.
  double field_height = 0;
  std::optional<Vec3> target; ///< m, the middle of the picture; without it the scene's middle
};

/// camera.json: {"azimuth_deg", "elevation_deg", "field_of_view_deg", "orthographic",
/// "field_height_m", "target"}, all optional.
/// @throws Error INPUT
CameraOptions read_camera(const std::string& path);

/// A camera: looks at `center` along -z of `turn`.
struct Camera {
  Mat3 turn = Mat3::Identity();                           ///< rows: right, up, towards the viewer
  Vec3 center = Vec3::Zero();                             ///< m, in the middle of the picture
  double half_height = 1, half_width = 1, half_depth = 1; ///< m, at the centre
  double distance = 0;               ///< m from the centre to the viewer; 0 is orthographic
  double azimuth = 0, elevation = 0; ///< rad
  /// World to clip space, -1..1 in each axis after division by w.
  Mat4 matrix() const;
  /// Pixel (from the upper left) and depth (0 near, 1 far) of a point.
  /// @param p  m
  /// @param width, height  of the picture, pixels
  Vec3 pixel(const Vec3& p, int width, int height) const;
};

/// A camera that frames all meshes, or as the options ask.
/// @param width_over_height  of the picture
Camera frame_scene(const std::vector<DrawMesh>& meshes, const CameraOptions& options,
                   double width_over_height);
/// The same with margins for labels and a legend.
/// @param left, right  shares of the picture's width left free there
Camera frame_beside(const std::vector<DrawMesh>& meshes, const CameraOptions& options,
                    double width_over_height, double left, double right);
/// Views at the largest scale at which each shows everything, so that a body is as tall on all
/// pictures of a sheet. Arguments as above.
/// @param views in and out; one that is null is left
void share_scale(const std::vector<DrawMesh>& meshes,
                 std::vector<std::optional<CameraOptions>>& views, double width_over_height,
                 double left, double right);
/// Azimuth and elevation of "front", "back", "left", "right", "iso". @throws Error USAGE
CameraOptions named_view(const std::string& view);
/// "front,iso,pattern,turntable:36": a camera for each view, none for the pattern laid flat.
/// @throws Error USAGE
std::vector<std::optional<CameraOptions>> parse_views(const std::string& list);

} // namespace sloper::render

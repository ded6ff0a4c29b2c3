#pragma once
/// Where the scene is seen from: an orthographic camera that frames everything.
#include <geometry/triangle_mesh.hpp>
#include <render/scene.hpp>
namespace sloper::render {
struct Camera {
  Mat3 turn = Mat3::Identity();                           ///< rows: right, up, towards the viewer
  Vec3 center = Vec3::Zero();                             ///< m
  double half_height = 1, half_width = 1, half_depth = 1; ///< m
  /// World to clip space, -1..1 in each axis.
  Mat4 matrix() const;
};
/// @param azimuth, elevation  rad; 0, 0 looks at the front, azimuth turns the viewer to the body's left
Camera frame_scene(const std::vector<DrawMesh>& meshes, double azimuth, double elevation, double width_over_height);
/// Azimuth and elevation of "front", "back", "left", "right", "iso". @throws Error USAGE
std::array<double, 2> view_angles(const std::string& view);
} // namespace sloper::render

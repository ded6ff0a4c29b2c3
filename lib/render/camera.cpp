#include <base/error.hpp>
#include <base/units.hpp>
#include <render/camera.hpp>

#include <Eigen/Geometry>

namespace sloper::render {

Mat4 Camera::matrix() const {
  Mat4 m = Mat4::Identity();
  const Vec3 scale(1 / half_width, 1 / half_height, -1 / half_depth);
  for (int r = 0; r < 3; ++r) {
    m.block<1, 3>(r, 0) = scale[r] * turn.row(r);
    m(r, 3) = -scale[r] * turn.row(r).dot(center);
  }
  return m;
}

Camera frame_scene(const std::vector<DrawMesh>& meshes, double azimuth, double elevation, double width_over_height) {
  Camera camera;
  const Vec3 towards(std::sin(azimuth) * std::cos(elevation), std::sin(elevation), std::cos(azimuth) * std::cos(elevation));
  const Vec3 right = Vec3(std::cos(azimuth), 0, -std::sin(azimuth));
  camera.turn.row(0) = right;
  camera.turn.row(1) = towards.cross(right);
  camera.turn.row(2) = towards;
  Box3 box;
  for (const DrawMesh& mesh : meshes)
    for (const Vec3& p : mesh.positions) box.add(camera.turn * p);
  const Vec3 half = 0.5 * box.size().cwiseMax(Vec3::Constant(1e-3));
  camera.center = camera.turn.transpose() * box.center();
  camera.half_height = 1.06 * std::max(half.y(), half.x() / width_over_height);
  camera.half_width = camera.half_height * width_over_height;
  camera.half_depth = 1.1 * half.z();
  return camera;
}

std::array<double, 2> view_angles(const std::string& view) {
  if (view == "front") return {0, 0};
  if (view == "back") return {units::PI, 0};
  if (view == "left") return {0.5 * units::PI, 0};
  if (view == "right") return {-0.5 * units::PI, 0};
  if (view == "iso") return {units::radians(35), units::radians(15)};
  throw Error(ErrorKind::USAGE, "", "--view " + view, "is not known", "known are front, back, left, right, iso and turntable:N");
}

} // namespace sloper::render

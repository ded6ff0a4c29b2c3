#include <sloper/base/error.hpp>
#include <sloper/base/text.hpp>
#include <sloper/base/units.hpp>
#include <sloper/io/json.hpp>
#include <sloper/render/camera.hpp>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>

namespace sloper::render {

namespace {
constexpr double MARGIN = 1.06; // of the picture around what is framed
}

CameraOptions read_camera(const std::string& path) {
  const io::Json document = io::read_json(path);
  const io::Node node(document, path);
  if (!node.is_object())
    node.fail("json.wrong-type"_id, "a camera is an object",
              R"(write for example {"azimuth_deg": 30, "elevation_deg": 10})");
  if (node.string("format", "camera") != "camera")
    throw input_error("json.wrong-format"_id, path, "/format",
                      "is a \"" + node.string("format", "") + "\" document, not a camera",
                      R"(write for example {"azimuth_deg": 30, "elevation_deg": 10})");
  if (node.has("version") && node.at("version").integer() != 1)
    node.at("version").fail("json.wrong-version"_id, "is not version 1 of a camera",
                            "leave it out, or update Sloper");
  node.allow_only({"format", "version", "azimuth_deg", "elevation_deg", "field_of_view_deg",
                   "orthographic", "field_height_m", "target"});
  CameraOptions options;
  options.azimuth = units::radians(node.number("azimuth_deg", 0));
  const double elevation = node.number("elevation_deg", 0),
               view = node.number("field_of_view_deg", units::degrees(options.field_of_view));
  if (std::abs(elevation) > 89.9)
    node.at("elevation_deg").fail("json.out-of-range"_id, "is not between -89.9 and 89.9");
  if (!(view >= 1 && view <= 120))
    node.at("field_of_view_deg")
        .fail("json.out-of-range"_id, "is not between 1 and 120",
              R"(for no perspective at all write "orthographic": true)");
  options.elevation = units::radians(elevation);
  options.field_of_view = node.boolean("orthographic", false) ? 0 : units::radians(view);
  options.field_height = node.number("field_height_m", 0);
  if (options.field_height < 0 || options.field_height > 1000)
    node.at("field_height_m").fail("json.out-of-range"_id, "is not between 0 and 1000");
  if (node.has("target"))
    options.target = node.at("target").vec3();
  return options;
}

Mat4 Camera::matrix() const {
  Mat4 view = Mat4::Identity();
  view.block<3, 3>(0, 0) = turn;
  view.block<3, 1>(0, 3) = -turn * center;
  Mat4 clip = Mat4::Zero();
  if (distance == 0) {
    clip.diagonal() << 1 / half_width, 1 / half_height, -1 / half_depth, 1;
  } else { // w is the distance from the viewer over that of the centre
    clip(0, 0) = 1 / half_width;
    clip(1, 1) = 1 / half_height;
    const double near = std::max(distance - half_depth, 0.02 * distance) / distance,
                 far = (distance + half_depth) / distance;
    clip(3, 2) = -1 / distance;
    clip(3, 3) = 1;
    // z = A w + B with z/w = -1 at near and 1 at far
    const double a = (far + near) / (far - near), b = -2 * far * near / (far - near);
    clip(2, 2) = -a / distance;
    clip(2, 3) = a + b;
  }
  return clip * view;
}

Vec3 Camera::pixel(const Vec3& p, int width, int height) const {
  const Eigen::Vector4d q = matrix() * p.homogeneous();
  const Vec3 n = q.head<3>() / q.w();
  return {0.5 * (n.x() + 1) * width, 0.5 * (1 - n.y()) * height, 0.5 * (n.z() + 1)};
}

Camera frame_scene(const std::vector<DrawMesh>& meshes, const CameraOptions& options,
                   double width_over_height) {
  Camera camera;
  camera.azimuth = options.azimuth;
  camera.elevation = options.elevation;
  const double sa = std::sin(options.azimuth), ca = std::cos(options.azimuth),
               se = std::sin(options.elevation), ce = std::cos(options.elevation);
  camera.turn.row(0) = Vec3(ca, 0, -sa);
  camera.turn.row(2) = Vec3(sa * ce, se, ca * ce);
  camera.turn.row(1) = Vec3(camera.turn.row(2)).cross(Vec3(camera.turn.row(0)));
  Box3 box;
  for (const DrawMesh& mesh : meshes)
    for (const Vec3& p : mesh.positions)
      box.add(camera.turn * p);
  const Vec3 half = 0.5 * box.size().cwiseMax(Vec3::Constant(1e-3));
  camera.center = options.target ? *options.target : Vec3(camera.turn.transpose() * box.center());
  const Vec3 c = camera.turn * camera.center;
  const double depth = std::max(box.high.z() - c.z(), c.z() - box.low.z());
  const double tangent = std::tan(0.5 * options.field_of_view);
  if (options.field_height > 0) {
    camera.half_height = 0.5 * options.field_height;
    if (tangent > 0)
      camera.distance = camera.half_height / tangent;
  } else if (tangent == 0) {
    camera.half_height = MARGIN * std::max(half.y(), half.x() / width_over_height);
  } else { // as near as all points allow
    for (const DrawMesh& mesh : meshes)
      for (const Vec3& p : mesh.positions) {
        const Vec3 q = camera.turn * p - c;
        camera.distance = std::max(
            camera.distance,
            q.z() +
                MARGIN * std::max(std::abs(q.y()), std::abs(q.x()) / width_over_height) / tangent);
      }
    camera.half_height = camera.distance * tangent;
  }
  camera.half_width = camera.half_height * width_over_height;
  camera.half_depth = 1.1 * std::max(depth, 1e-3) + box.size().norm();
  return camera;
}

Camera frame_beside(const std::vector<DrawMesh>& meshes, const CameraOptions& options,
                    double width_over_height, double left, double right) {
  Camera camera = frame_scene(meshes, options, width_over_height * (1 - left - right));
  camera.half_width = camera.half_height * width_over_height;
  camera.center += camera.turn.transpose() * Vec3((right - left) * camera.half_width, 0, 0);
  return camera;
}

void share_scale(const std::vector<DrawMesh>& meshes,
                 std::vector<std::optional<CameraOptions>>& views, double width_over_height,
                 double left, double right) {
  double half_height = 0;
  for (const auto& view : views)
    if (view)
      half_height = std::max(
          half_height, frame_beside(meshes, *view, width_over_height, left, right).half_height);
  for (auto& view : views)
    if (view)
      view->field_height = 2 * half_height;
}

CameraOptions named_view(const std::string& view) {
  CameraOptions options;
  options.elevation = units::radians(6);
  if (view == "front")
    return options;
  options.azimuth = units::PI;
  if (view == "back")
    return options;
  options.azimuth = 0.5 * units::PI;
  if (view == "left")
    return options;
  options.azimuth = -0.5 * units::PI;
  if (view == "right")
    return options;
  options.azimuth = units::radians(35);
  options.elevation = units::radians(14);
  if (view == "iso")
    return options;
  throw unknown_word("--view", view,
                     {"front", "back", "left", "right", "iso", "pattern", "turntable:8"},
                     "known are front, back, left, right, iso, pattern and turntable:N");
}

std::vector<std::optional<CameraOptions>> parse_views(const std::string& list) {
  std::vector<std::optional<CameraOptions>> views;
  for (const std::string& word : split(list)) {
    int turns = 0;
    char end = 0;
    if (word == "pattern") {
      views.emplace_back();
    } else if (std::sscanf(word.c_str(), "turntable:%d%c", &turns, &end) == 1) {
      if (turns < 1 || turns > 360)
        throw Error(ErrorKind::USAGE, "option.wrong-value"_id, "", "--view " + word,
                    "needs 1 to 360 views");
      for (int k = 0; k < turns; ++k) {
        views.emplace_back(named_view("front"));
        views.back()->azimuth = 2 * units::PI * k / turns;
      }
    } else {
      views.emplace_back(named_view(word));
    }
  }
  if (views.empty())
    throw Error(ErrorKind::USAGE, "option.wrong-value"_id, "", "--view", "names no view");
  return views;
}

} // namespace sloper::render

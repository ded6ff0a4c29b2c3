#include "targets.hpp"

#include <base/error.hpp>
#include <body/pose_file.hpp>
#include <io/json.hpp>
#include <io/obj.hpp>
#include <io/scan_reader.hpp>

#include <cstdlib>

namespace sloper::fuzz {

namespace {

/// Whatever was read must be usable: finite, and no face beyond the vertices.
void must_be_sound(const TriangleMesh& mesh) {
  for (const Vec3& p : mesh.positions)
    if (!p.allFinite()) std::abort();
  for (const Triangle& t : mesh.triangles)
    for (const int v : t)
      if (v < 0 || v >= static_cast<int>(mesh.positions.size())) std::abort();
}

body::Body person() {
  body::Body b;
  b.scan.stature_m = 1.7;
  auto bone = [&](const char* name, const char* parent, const Vec3& head, const Vec3& tail) { b.bones.push_back({name, parent, head, tail}); };
  bone("spine", "", Vec3(0, 0.9, 0), Vec3(0, 1.4, 0));
  bone("head", "spine", Vec3(0, 1.4, 0), Vec3(0, 1.7, 0));
  for (const bool left : {true, false}) {
    const std::string s = left ? "_l" : "_r";
    const double x = left ? 1 : -1;
    bone(("upper_arm" + s).c_str(), "spine", Vec3(0.18 * x, 1.4, 0), Vec3(0.4 * x, 1.2, 0));
    bone(("forearm" + s).c_str(), ("upper_arm" + s).c_str(), Vec3(0.4 * x, 1.2, 0), Vec3(0.6 * x, 1, 0));
    bone(("thigh" + s).c_str(), "", Vec3(0.1 * x, 0.9, 0), Vec3(0.12 * x, 0.5, 0));
    bone(("shin" + s).c_str(), ("thigh" + s).c_str(), Vec3(0.12 * x, 0.5, 0), Vec3(0.14 * x, 0.08, 0));
  }
  return b;
}

} // namespace

void read_scan_bytes(std::string_view bytes) {
  if (bytes.empty()) return;
  const char kind = bytes[0];
  bytes.remove_prefix(1);
  try {
    if (kind == 'o') {
      const io::ObjMesh obj = io::parse_obj(bytes, "fuzz.obj");
      must_be_sound({obj.positions, obj.triangles});
    } else if (kind == 'p') must_be_sound(io::parse_ply(bytes, "fuzz.ply"));
    else if (kind == 's') must_be_sound(io::parse_stl(bytes, "fuzz.stl"));
    else if (kind == '3') must_be_sound(io::parse_with_assimp(bytes, "3ds", "fuzz.3ds"));
    else must_be_sound(io::parse_xyz(bytes, "fuzz.xyz"));
  } catch (const Error& e) {
    if (e.kind() != ErrorKind::INPUT) std::abort();
  }
}

void read_json_bytes(std::string_view bytes) {
  try {
    const io::Json document = io::parse_json(std::string(bytes), "fuzz.json");
    const std::string text = io::to_text(document);
    if (io::to_text(io::parse_json(text, "again.json")) != text) std::abort(); // what we write, we read
  } catch (const Error& e) {
    if (e.kind() != ErrorKind::INPUT) std::abort();
  }
}

void read_bvh_bytes(std::string_view bytes) {
  static const body::Body body = person();
  try {
    const body::Motion motion = body::parse_bvh(bytes, "fuzz.bvh", body, 0.05);
    for (const body::Pose& pose : motion.poses) body::joint_motions(body, pose);
  } catch (const Error& e) {
    if (e.kind() != ErrorKind::INPUT) std::abort();
  }
}

} // namespace sloper::fuzz

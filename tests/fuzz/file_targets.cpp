#include "targets.hpp"

#include <io/pcd.hpp>
#include <sloper/base/error.hpp>
#include <sloper/io/json.hpp>
#include <sloper/io/mesh_file.hpp>
#include <sloper/io/obj.hpp>
#include <sloper/io/scan_reader.hpp>

#include <cstdlib>

namespace sloper::fuzz {

namespace {

/// Whatever was read must be usable: finite, and no face beyond the vertices.
void must_be_sound(const TriangleMesh& mesh) {
  for (const Vec3& p : mesh.positions)
    if (!p.allFinite())
      std::abort();
  for (const Triangle& t : mesh.triangles)
    for (const int v : t)
      if (v < 0 || v >= std::ssize(mesh.positions))
        std::abort();
}

std::string format_of_mesh(char kind) {
  if (kind == 'o')
    return "obj";
  return kind == 'p' ? "ply" : "glb";
}

} // namespace

void read_scan_bytes(std::string_view bytes) {
  if (bytes.empty())
    return;
  const char kind = bytes[0];
  bytes.remove_prefix(1);
  try {
    if (kind == 'o') {
      const io::ObjMesh obj = io::parse_obj(bytes, "fuzz.obj");
      must_be_sound({obj.positions, obj.triangles});
    } else if (kind == 'p')
      must_be_sound(io::parse_ply(bytes, "fuzz.ply"));
    else if (kind == 's')
      must_be_sound(io::parse_stl(bytes, "fuzz.stl"));
    else if (kind == '3')
      must_be_sound(io::parse_3ds(bytes, "fuzz.3ds"));
    else if (kind == 'd')
      must_be_sound(io::parse_pcd(bytes, "fuzz.pcd"));
    else
      must_be_sound(io::parse_xyz(bytes, "fuzz.xyz"));
  } catch (const Error& e) {
    if (e.kind() != ErrorKind::INPUT)
      std::abort();
  }
}

void read_mesh_file_bytes(std::string_view bytes) {
  if (bytes.empty())
    return;
  const char kind = bytes[0];
  bytes.remove_prefix(1);
  const std::string format = format_of_mesh(kind);
  try {
    const io::MeshFile file = io::parse_mesh_file(std::string(bytes), format, "fuzz");
    for (const std::vector<int>& corners : file.face_texture)
      for (const int t : corners)
        if (t < -1 || t >= std::ssize(file.texture))
          std::abort();
    std::vector<Vec3> moved = file.positions;
    for (Vec3& p : moved)
      p = 0.5 * p + Vec3(0.1, 0.2, 0.3);
    const std::vector<Mat3> turned(moved.size(), Mat3::Identity());
    const std::string again = io::moved_mesh_file(file, moved, turned);
    const io::MeshFile back = io::parse_mesh_file(again, format, "again");
    if (back.faces != file.faces || back.positions.size() != moved.size())
      std::abort();
  } catch (const Error& e) {
    if (e.kind() != ErrorKind::INPUT)
      std::abort();
  }
}

void read_json_bytes(std::string_view bytes) {
  try {
    const io::Json document = io::parse_json(std::string(bytes), "fuzz.json");
    const std::string text = io::to_text(document);
    if (io::to_text(io::parse_json(text, "again.json")) != text)
      std::abort(); // what we write, we read
  } catch (const Error& e) {
    if (e.kind() != ErrorKind::INPUT)
      std::abort();
  }
}

} // namespace sloper::fuzz

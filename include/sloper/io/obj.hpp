#pragma once
/// Our own OBJ files: v and vt stay apart and in file order, faces as v/vt, groups as runs of
/// faces.
/// Test: tests/io/test_obj.cpp
#include <sloper/geometry/types.hpp>
#include <string>
#include <vector>
namespace sloper::io {

/// A run of faces under one `g`.
struct ObjGroup {
  std::string name;   ///< after `g`
  int first_triangle; ///< into triangles; runs to the next group's first
};

/// An OBJ file in memory.
struct ObjMesh {
  std::vector<Vec3> positions;     ///< #V by 3, the file's own unit
  std::vector<Vec2> texture;       ///< #VT by 2
  std::vector<Triangle> triangles; ///< #F by 3 into positions; polygons are cut into fans
  /// #F by 3 into texture, -1 where absent; empty when no face has vt.
  std::vector<Triangle> texture_triangles;
  std::vector<ObjGroup> groups; ///< in face order; empty when the file has none
};

/// Reads OBJ text; "-" is not accepted. Refuses non-finite numbers, indices out of range, binary
/// bytes; read_obj() also a file without a vertex.
/// @throws Error INPUT naming file and line. Cost: one pass, about 25 ms per 10 MB.
ObjMesh read_obj(const std::string& path);
/// The same from text; a text without a vertex is accepted.
/// @param name  for messages
/// @param keep_texture  false: vt is not read, and faces may name vt and vn that the file
/// lacks, as programs write for scans without a texture
ObjMesh parse_obj(std::string_view text, const std::string& name, bool keep_texture = true);

/// OBJ text with shortest round-trip numbers; faces `f v/vt` when texture_triangles is filled, else
/// `f v`.
/// @param comment  first line, after "# "
/// @throws Error INTERNAL when a number is not finite.
std::string obj_text(const ObjMesh& mesh, const std::string& comment);
/// Writes obj_text().
/// @throws Error OUTPUT, INTERNAL as obj_text()
void write_obj(const std::string& path, const ObjMesh& mesh, const std::string& comment);

} // namespace sloper::io

#pragma once
/// Our own OBJ files: v and vt stay apart and in file order, faces as v/vt, groups as runs of
/// faces.
#include <sloper/geometry/types.hpp>
#include <string>
#include <vector>
namespace sloper::io {

struct ObjGroup {
  std::string name;
  int first_triangle; ///< into triangles; runs to the next group's first
};

struct ObjMesh {
  std::vector<Vec3> positions;     ///< #V by 3, the file's own unit
  std::vector<Vec2> texture;       ///< #VT by 2
  std::vector<Triangle> triangles; ///< #F by 3 into positions; polygons are cut into fans
  std::vector<Triangle>
      texture_triangles; ///< #F by 3 into texture, -1 where absent; empty when no face has vt
  std::vector<ObjGroup> groups; ///< in face order; empty when the file has none
};

/// Reads OBJ text; "-" is not accepted. Refuses non-finite numbers, indices out of range, binary
/// bytes; read_obj() also a file without a vertex.
/// @throws Error INPUT naming file and line. Cost: one pass, about 25 ms per 10 MB.
ObjMesh read_obj(const std::string& path);
/// @param keep_texture false: vt is not read, and faces may name vt and vn that the file lacks, as
/// programs write for scans without a texture
ObjMesh parse_obj(std::string_view text, const std::string& name, bool keep_texture = true);

/// OBJ text with shortest round-trip numbers; faces `f v/vt` when texture_triangles is filled, else
/// `f v`.
/// @throws Error INTERNAL when a number is not finite.
std::string obj_text(const ObjMesh& mesh, const std::string& comment);
void write_obj(const std::string& path, const ObjMesh& mesh, const std::string& comment);

} // namespace sloper::io

#pragma once
/// Raw scans in: OBJ, PLY, STL, 3DS, XYZ and PCD by readers of our own that keep the file's
/// vertices, other formats through assimp. No unit, no axis, no meaning: that is the business of
/// body/.
#include <sloper/geometry/triangle_mesh.hpp>
#include <string>
#include <string_view>
namespace sloper::io {

struct Scan {
  std::string
      format; ///< "obj", "ply", "stl", "3ds", "xyz", "pcd", or the extension that assimp reads
  std::string sha256; ///< of the file's bytes
  /// But for assimp (assimp_reader.hpp): positions in the file's own order and count and its own
  /// unit; triangles may be empty (bare points). STL has no shared vertices: its positions are the
  /// three corners of each facet in turn.
  TriangleMesh mesh;
};

/// Reads a scan by its extension; an unknown extension is read by what the bytes look like.
/// Refuses what is missing, empty, truncated, not of its format, or holds a number that is not
/// finite.
/// @throws Error INPUT naming file, line or element, and the fact
/// Cost: OBJ about 25 ms per 10 MB; the other formats less.
Scan read_scan(const std::string& path);

/// The readers by themselves; `name` is for messages.
TriangleMesh parse_ply(std::string_view bytes, const std::string& name);
TriangleMesh parse_stl(std::string_view bytes, const std::string& name);
TriangleMesh parse_xyz(std::string_view bytes,
                       const std::string& name); ///< x y z [anything] per line; # starts a comment
/// Every mesh of the file, one after the other, as the coordinates stand in it: 3D Studio's own
/// (0x4110 and 0x4120 in 0x4100 of Autodesk's 3DS chunks).
TriangleMesh parse_3ds(std::string_view bytes, const std::string& name);

} // namespace sloper::io

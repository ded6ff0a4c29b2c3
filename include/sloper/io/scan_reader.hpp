#pragma once
/// Raw scans in: OBJ, PLY, STL, 3DS, XYZ and PCD by readers of our own that keep the file's
/// vertices, other formats through assimp. No unit, no axis, no meaning: that is the business of
/// body/.
/// Test: tests/io/test_reader_mutations.cpp
#include <sloper/geometry/triangle_mesh.hpp>
#include <sloper/io/skin_pose.hpp>
#include <string>
#include <string_view>
namespace sloper::io {

/// A scan as the file has it.
struct Scan {
  /// "obj", "ply", "stl", "3ds", "xyz", "pcd", or the extension that assimp reads.
  std::string format;
  std::string sha256; ///< of the file's bytes
  /// But for assimp (assimp_reader.hpp): positions in the file's own order and count and its own
  /// unit; triangles may be empty (bare points). STL has no shared vertices: its positions are the
  /// three corners of each facet in turn.
  TriangleMesh mesh;
};

/// Reads a scan by its extension; the format of an unknown extension is recognised by the
/// content. Refuses files that are missing, empty, truncated, of another format, or that
/// hold a number that is not finite. OBJ takes about 25 ms per 10 MB; the other formats
/// less.
/// @throws Error INPUT naming file, line or element, and the fact
Scan read_scan(const std::string& path, SkinPose pose = SkinPose::AS_SHOWN);

/// PLY bytes, text or binary.
/// @param name  for messages
/// @throws Error INPUT, as the other readers
TriangleMesh parse_ply(std::string_view bytes, const std::string& name);
/// STL bytes, text or binary.
TriangleMesh parse_stl(std::string_view bytes, const std::string& name);
/// Text with x y z [anything] per line; # starts a comment.
TriangleMesh parse_xyz(std::string_view bytes, const std::string& name);
/// Every mesh of the file, one after the other, as the coordinates stand in it: 3D Studio's own
/// (0x4110 and 0x4120 in 0x4100 of Autodesk's 3DS chunks).
TriangleMesh parse_3ds(std::string_view bytes, const std::string& name);

} // namespace sloper::io

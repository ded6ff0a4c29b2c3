#pragma once
/// A polygon mesh of another program that is to come out as it went in, with other positions: OBJ,
/// PLY (text and binary) and binary glTF.
///
/// The file's bytes are kept, and moved_mesh_file() replaces coordinates and normals in them. So
/// everything else comes out as it went in: the order of vertices and faces, polygons, texture
/// coordinates, groups, materials, comments, elements that only their program knows.
#include <sloper/geometry/types.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace sloper::io {

/// A file as read: its bytes, and what is in them. #V vertices.
struct MeshFile {
  std::string name;   ///< for messages
  std::string format; ///< "obj", "ply" or "glb"
  std::string bytes;  ///< of the whole file
  /// #V by 3, the file's own unit and axes, in the file's own order; of a GLB those of its POSITION
  /// accessors, in the order in which its nodes come to them, where the nodes put them.
  std::vector<Vec3> positions;
  std::vector<std::vector<int>> faces; ///< corners, three and more, into `positions`
  std::vector<Vec2> texture;           ///< #VT by 2; empty where the file has none that is known
  std::vector<std::vector<int>> face_texture; ///< the same into `texture`, -1 where a corner has
                                              ///< none; empty where there is no texture
  std::vector<std::string> companions; ///< files beside it that it names, such as its materials
  std::vector<std::string> findings; ///< of what cannot follow the positions, such as morph targets
};

/// Whether a name ends as one of the formats, in any case.
bool is_mesh_file(const std::string& path);

/// Reads a file by the ending of its name.
/// @throws Error INPUT naming file, line or element: an index out of range, a coordinate that is
/// not finite, a face of fewer than three corners; of a GLB what is compressed, sparse, skinned, or
/// used by two nodes. Cost: one pass.
MeshFile read_mesh_file(const std::string& path);
/// The same of bytes in memory.
/// @param format  "obj", "ply" or "glb"
/// @param name  for messages
MeshFile parse_mesh_file(std::string bytes, const std::string& format, const std::string& name);

/// The bytes of the file with its vertices elsewhere. Normals (and tangents of a GLB) are turned
/// with them; where vertices of an OBJ share a normal that turns differently, each gets one of its
/// own.
/// @param positions  #V by 3, as MeshFile::positions
/// @param turned     #V: how the surface at a vertex was turned
std::string moved_mesh_file(const MeshFile& file, const std::vector<Vec3>& positions,
                            const std::vector<Mat3>& turned);

/// Copies what the file names beside it, its materials and their textures, to the folder of `to`,
/// where that is another one and has no such file yet. @return what could not be copied, with why
std::vector<std::string> copy_companions(const MeshFile& file, const std::string& to);

/// The reader and the writer of each format, which parse_mesh_file() and moved_mesh_file() call.
MeshFile parse_obj_mesh(std::string bytes, const std::string& name);
/// See parse_obj_mesh().
MeshFile parse_ply_mesh(std::string bytes, const std::string& name);
/// See parse_obj_mesh().
MeshFile parse_glb_mesh(std::string bytes, const std::string& name);
/// Arguments as of moved_mesh_file().
std::string moved_obj_mesh(const MeshFile&, const std::vector<Vec3>&, const std::vector<Mat3>&);
/// See moved_obj_mesh().
std::string moved_ply_mesh(const MeshFile&, const std::vector<Vec3>&, const std::vector<Mat3>&);
/// See moved_obj_mesh().
std::string moved_glb_mesh(const MeshFile&, const std::vector<Vec3>&, const std::vector<Mat3>&);

} // namespace sloper::io

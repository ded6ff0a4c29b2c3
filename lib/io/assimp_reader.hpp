#pragma once
/// Scans in formats that others keep alive: glTF, FBX, Collada, OFF, X3D and VRML through assimp.
#include <sloper/geometry/triangle_mesh.hpp>
#include <sloper/io/skin_pose.hpp>
#include <string>

namespace sloper::io {

/// Whether assimp is asked for files of this extension (lower case, no dot).
bool is_read_by_assimp(const std::string& extension);

/// Every mesh of the file, at its place in the scene; one with a skin in the pose that its joints
/// have in the file, as viewers show it (glTF 2.0, 3.7.3.2). Assimp multiplies vertices where
/// texture or normals change: those at the very same place are one again, in the order in which
/// assimp gives them, so that no seam of a texture is a hole. It works in a process of its own: a
/// file that crashes it, or keeps it busy for a minute, is refused as any other bad file.
/// @param path       of the file
/// @param extension  lower case, no dot, one that is_read_by_assimp()
/// @param pose       of meshes with a skin
/// @return vertices in the unit and axes of the file, with the transforms of its nodes applied;
/// triangles only, larger faces cut Cost: that of assimp, which reads the file itself, and the
/// transfer of the mesh between two processes
/// @throws Error INPUT
TriangleMesh read_with_assimp(const std::string& path, const std::string& extension, SkinPose pose);

} // namespace sloper::io

#pragma once
/// A polygon mesh as one surface: vertices at one place are one, polygons are triangles, faces that
/// are none or stand twice are left out, neighbours face the same way.
#include <sloper/geometry/types.hpp>
#include <sloper/io/mesh_file.hpp>

namespace sloper::garment {

/// #N places, #F triangles; #V vertices of the file.
struct MeshSurface {
  std::vector<Vec3> position;      ///< #N by 3, m: the places of the file's vertices, each once
  std::vector<int> place_of;       ///< #V of the file, into `position`
  std::vector<Triangle> triangles; ///< #F, over places
  std::vector<Triangle> texture;   ///< #F, into MeshFile::texture, -1 where there is none; or empty
  std::vector<int> component;      ///< #F: connected piece, from 0
  int n_components = 0;            ///< connected pieces
  int polygons = 0;           ///< faces of more than three corners, cut along the shorter diagonal
  int degenerate = 0;         ///< triangles without area, left out
  int duplicates = 0;         ///< triangles that stood there already, whichever way they face
  int non_manifold_edges = 0; ///< that more than two triangles share
  int open_edges = 0;         ///< that one triangle has
};

/// @param positions  #V by 3, m, of the file's vertices
/// Vertices nearer than 10 um are one. Neighbours over an edge of two triangles face the same way;
/// which way a piece faces is that of its first triangle. Deterministic. Cost: O(n log n).
MeshSurface make_surface(const io::MeshFile& file, const std::vector<Vec3>& positions);

/// All triangles of the file's faces over places, also those that make_surface() leaves out: for
/// audits. Polygons are cut as there.
std::vector<Triangle> all_triangles(const io::MeshFile& file, const MeshSurface& surface);

/// Turns the triangles of each connected piece (over edges of two triangles) so that most of its
/// area looks along `outward`. @param outward  #N, at places
void face_outward(const std::vector<Vec3>& position, const std::vector<Vec3>& outward,
                  std::vector<Triangle>& triangles, std::vector<Triangle>& texture);

} // namespace sloper::garment

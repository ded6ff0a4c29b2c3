#pragma once
/// What a scan's own faces need before cloth can lie on them: joined, oriented, closed.
#include <array>
#include <cstdint>
#include <sloper/geometry/triangle_mesh.hpp>
#include <vector>
namespace sloper::body {

/// A side of a face; both sides of an edge have one key.
struct HalfEdge {
  std::uint64_t key;
  int face;
  bool forward; ///< from the lower to the higher vertex
};

/// Edges of a mesh that no closed, oriented surface has.
struct EdgeCounts {
  int border = 0;  ///< edges with one face
  int crowded = 0; ///< with more than two
  int flipped = 0; ///< with two that disagree about outside
};

/// The scan's faces whose corners are all body; degenerate and duplicate ones and unused vertices
/// are left out.
/// @param number filled with the skin vertex of every scan vertex, -1 where there is none
TriangleMesh own_faces(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                       const std::vector<char>& is_body, std::vector<int>& number);
/// STL and some exporters give every face its own corners: joins vertices at the same place.
/// @return whether there were any
bool weld(TriangleMesh& mesh, std::vector<int>& of_scan);
/// Leaves out pieces of less than a hundredth of all faces: eyes, inner shells, crumbs. @return how
/// many pieces
int drop_small_pieces(TriangleMesh& mesh, std::vector<int>& of_scan);
/// All half edges, those of one edge together, in order of vertices, then faces.
std::vector<HalfEdge> half_edges(const TriangleMesh& mesh);
EdgeCounts count_edges(const std::vector<HalfEdge>& list);
/// Turns faces so that neighbours agree, piece by piece, and each piece so that its volume is
/// positive.
void orient_faces(TriangleMesh& mesh, const std::vector<HalfEdge>& list);
/// A place where the border of the faces goes around.
struct Hole {
  Vec3 center = Vec3::Zero();
  double width = 0; ///< diagonal of the box around its border, m
  int edges = 0;
};
/// Every connected piece of the border of at least `least` width, m; the widest first, at most
/// `most` of them.
std::vector<Hole> holes_of(const TriangleMesh& mesh, const std::vector<HalfEdge>& list,
                           double least, std::size_t most);
/// A border as simple loops. Where holes meet in a vertex a walk comes back to it: what it went
/// around is a loop of its own.
/// @param border  edges from vertex to vertex, sorted, in the direction in which the loops shall
/// run
/// @return empty where the border does not close
std::vector<std::vector<int>> border_loops(const std::vector<std::array<int, 2>>& border);
/// Closes every hole with a fan around its middle.
/// @param widest m; holes that lie wholly below `low` or above `high` may be of any width: soles
/// and a crown that were cut off are as good as flat
/// @return false, with the mesh untouched, where a hole is wider and more than a few edges long, or
/// where the border does not close
bool fill_holes(TriangleMesh& mesh, const std::vector<HalfEdge>& list, double widest, double low,
                double high);

} // namespace sloper::body

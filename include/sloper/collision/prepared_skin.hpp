#pragma once
/// What a BodyCollider finds out about a skin before cloth can meet it, and cannot be had cheaply;
/// as bytes for a file. Test: tests/collision/test_prepared_skin.cpp
#include <sloper/geometry/triangle_mesh.hpp>

#include <optional>
#include <string>
#include <string_view>
namespace sloper::collision {

/// What was wrong with the body's mesh and how it was met.
struct BodyFindings {
  int flipped_triangles = 0; ///< turned to agree with their neighbours, or with their whole piece
  int boundary_edges = 0;
  int non_manifold_edges =
      0; ///< of three or more triangles, or of two that cannot be made to agree
  int self_intersections = 0;  ///< pairs of body triangles
  int untrusted_triangles = 0; ///< whose side is decided by winding number
  int buried_triangles = 0;    ///< inside the body, left out of closest points
  bool operator==(const BodyFindings&) const = default;
};

/// Lists are ascending; triangles are numbered as in the mesh.
struct PreparedSkin {
  std::vector<int> turned;          ///< triangles whose corners 1 and 2 change places
  std::vector<int> buried;          ///< triangles that are no skin
  std::vector<int> untrusted_faces; ///< triangles
  std::vector<int>
      untrusted_edges; ///< 3 times the edge's first triangle plus its side there, once turned
  std::vector<int> untrusted_vertices; ///< vertices
  std::vector<int> order, skin_order;  ///< of the trees: of all triangles, and, where some are
                                       ///< buried, of the others by their rank among these
  BodyFindings findings;
  bool operator==(const PreparedSkin&) const = default;

  /// Indices are in range, lists ascending, orders are permutations: whatever else it says, a
  /// collider can be made of it.
  bool fits(std::size_t n_vertices, std::size_t n_triangles) const;
};

/// To be raised by one with every change of what a collider finds out, or of its bytes: what older
/// programs kept then counts for nothing. tests/collision/test_prepared_skin.cpp fails where that
/// was forgotten.
inline constexpr int PREPARED_SKIN_VERSION = 1;

/// A name for the bytes of a mesh, this version and this machine's order of bytes: 64 hexadecimal
/// digits.
std::string skin_key(const TriangleMesh& skin);

/// Header (mark, order of bytes, size of a number, version, key), numbers, SHA-256 of all that.
std::string to_bytes(const PreparedSkin& prepared, const std::string& key);
/// Nothing where the bytes are not whole, not of this version and key, or do not fit a mesh of that
/// size.
std::optional<PreparedSkin> prepared_from_bytes(std::string_view bytes, const std::string& key,
                                                std::size_t n_vertices, std::size_t n_triangles);

} // namespace sloper::collision

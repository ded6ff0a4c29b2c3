#pragma once
/// The results of preparing a skin for contact (BodyCollider's constructor), which are
/// not cheap to compute; as bytes for a file. Test:
/// tests/collision/test_prepared_skin.cpp
#include <sloper/geometry/triangle_mesh.hpp>

#include <optional>
#include <string>
#include <string_view>
namespace sloper::collision {

/// Defects of the body's mesh, and how they are handled.
struct BodyFindings {
  int flipped_triangles = 0; ///< turned to agree with their neighbours, or with their whole piece
  int boundary_edges = 0;    ///< of holes and rims
  /// Of three or more triangles, or of two that cannot be made to agree.
  int non_manifold_edges = 0;
  int self_intersections = 0;  ///< pairs of body triangles
  int untrusted_triangles = 0; ///< whose side is decided by winding number
  int buried_triangles = 0;    ///< inside the body, left out of closest points
  bool operator==(const BodyFindings&) const = default;
};

/// The results for one mesh. Lists are ascending; triangles are numbered as in the mesh.
struct PreparedSkin {
  std::vector<int> turned;          ///< triangles whose corners 1 and 2 change places
  std::vector<int> buried;          ///< triangles that are no skin
  std::vector<int> untrusted_faces; ///< triangles
  /// Edges as 3 times the edge's first triangle plus its side there, once turned.
  std::vector<int> untrusted_edges;
  std::vector<int> untrusted_vertices; ///< vertices
  /// Of the trees: of all triangles, and, where some are buried, of the others by their
  /// rank among these.
  std::vector<int> order, skin_order;
  BodyFindings findings; ///< of the mesh
  bool operator==(const PreparedSkin&) const = default;

  /// Whether a collider can be made of it for a mesh of these sizes: indices are in
  /// range, lists ascending, orders are permutations.
  bool fits(std::size_t n_vertices, std::size_t n_triangles) const;
};

/// Version of the results and of their bytes; raise it with every change of either, so
/// that older files are ignored. tests/collision/test_prepared_skin.cpp fails where that
/// was forgotten.
inline constexpr int PREPARED_SKIN_VERSION = 1;

/// Key of a mesh, this version and the machine's byte order: 64 hexadecimal digits. O(#V
/// + #F).
std::string skin_key(const TriangleMesh& skin);

/// Header (mark, byte order, size of a number, version, key), numbers, SHA-256 of all
/// before it.
std::string to_bytes(const PreparedSkin& prepared, const std::string& key);
/// Inverse of to_bytes(); empty where the bytes are incomplete, of another version or
/// key, or do not fit a mesh of that size.
std::optional<PreparedSkin> prepared_from_bytes(std::string_view bytes, const std::string& key,
                                                std::size_t n_vertices, std::size_t n_triangles);

} // namespace sloper::collision

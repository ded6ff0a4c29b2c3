#pragma once
/// A body as cloth meets it: signed distance, inside and outside, intersecting faces,
/// face and edge contacts.
///
/// The sign comes from angle-weighted pseudonormals (Baerentzen and Aanaes 2005) where
/// the surface around the closest point is an oriented manifold that bounds a volume, and
/// from the generalized winding number (Jacobson et al. 2013) where it is not: at holes,
/// non-manifold edges and self-intersections of the skin. Flipped faces are turned first,
/// by their neighbours; a piece that is inside out as a whole is turned as a whole. Skin
/// buried inside the body (an arm that a scan has merged with the trunk) is never a
/// closest point. Test: tests/collision/test_body_collider.cpp
#include <sloper/collision/prepared_skin.hpp>
#include <sloper/collision/topology.hpp>
#include <sloper/collision/triangle_tree.hpp>
#include <sloper/collision/winding_number.hpp>

#include <memory>
#include <mutex>
namespace sloper::collision {

/// The nearest place of the skin to a point.
struct SignedDistance {
  double distance = std::numeric_limits<double>::infinity(); ///< m, negative inside
  /// Unit, the direction in which the distance grows (outward at the skin)
  Vec3 normal = Vec3::Zero();
  Vec3 point = Vec3::Zero(); ///< closest point of the skin, m
  /// Of the body; -1: no skin within the distance asked for, whether inside or outside.
  int triangle = -1;
  Vec3 barycentric = Vec3::Zero(); ///< of `point` in `triangle`
};

/// FACE: body vertex against cloth face; EDGE: body edge against cloth edge.
enum class ContactKind : unsigned char { FACE, EDGE };

/// A cloth face or edge near a body vertex or a convex body edge; both closest points are inside
/// their features.
struct FaceContact {
  ContactKind kind;      ///< which elements
  int triangle;          ///< of the cloth; for EDGE the first triangle of that edge
  Vec3 barycentric;      ///< closest point in the cloth triangle; for EDGE one weight is zero
  int body_triangle;     ///< a body triangle at the closest feature
  Vec3 body_barycentric; ///< closest point in `body_triangle`
  Vec3 body_point;       ///< m
  Vec3 normal;           ///< unit, outward
  /// m, along `normal` from body point to cloth point; negative where the body shows
  /// through.
  double distance;
};

/// Elements of a cloth and of the skin that are near each other.
struct BodyPairs {
  /// Cloth vertex and body triangle.
  struct VertexFace {
    int vertex, body_triangle; ///< of the cloth; of the body
    double distance;           ///< m, as of the others
  };
  /// Cloth edge and body edge.
  struct EdgeEdge {
    int edge;                ///< of the cloth's topology
    int body_triangle, side; ///< the body's edge from corner `side` to the next
    double distance;         ///< m
  };
  /// Cloth triangle and body vertex.
  struct FaceVertex {
    int triangle, body_vertex; ///< of the cloth; of the body
    double distance;           ///< m
  };
  std::vector<VertexFace> vertex_face; ///< cloth vertices
  /// Convex edges of the body only: in a hollow its faces are at least as near.
  std::vector<EdgeEdge> edge_edge;
  std::vector<FaceVertex> face_vertex; ///< cloth triangles
};

/// Distances and contacts with one skin. Copies the mesh. Queries are const and may run
/// on several threads.
class BodyCollider {
public:
  BodyCollider() = default;
  /// Prepares a skin: orients faces, finds buried and unreliable parts, sorts the tree.
  /// About 0.5 s for 300,000 triangles (docs/performance.md).
  /// @param body  body frame, m; faces may be flipped, open, non-manifold, zero-area
  /// @param k  see TriangleTree
  explicit BodyCollider(const TriangleMesh& body, int k = 6);
  /// The same collider, to the bit, from prepared() of one over the same mesh. O(#F).
  /// @param known  of any k, or anything that fits() the mesh
  BodyCollider(const TriangleMesh& body, const PreparedSkin& known, int k = 6);
  /// Results of the constructor, for a cache; also after set_positions().
  PreparedSkin prepared() const;

  /// Moves the body; same triangles. Which skin is trusted or buried stays as at
  /// construction. O(#F).
  /// @param positions  #V by 3, m
  void set_positions(const std::vector<Vec3>& positions);

  /// Signed distance of a point to the skin.
  /// @param p  m
  /// @param max_distance  m, may be infinite
  /// @param hint_triangle  the last answer, or -1 (cost only)
  SignedDistance signed_distance(const Vec3& p, double max_distance, int hint_triangle = -1) const;
  /// Winding number about p, m: 1 inside, 0 outside; after turning flipped faces. Within
  /// about 0.005 of the exact sum. O(log #F).
  double winding_number(const Vec3& p) const;
  /// Whether p, m, is inside: winding_number() above a half.
  bool is_inside(const Vec3& p) const { return winding_number(p) > 0.5; }

  /// Cloth triangles (ascending) that intersect any body triangle; exact, touching
  /// counts.
  /// @param positions  m
  std::vector<int> faces_through(const std::vector<Vec3>& positions,
                                 const std::vector<Triangle>& triangles) const;

  /// The deepest FACE contact of each cloth triangle and the deepest EDGE contact of each
  /// cloth edge, within `radius` (m), sorted by kind, triangle, edge. Contacts of cloth
  /// vertices are signed_distance()'s.
  /// @param topology  of `triangles`
  std::vector<FaceContact> face_contacts(const std::vector<Vec3>& positions,
                                         const std::vector<Triangle>& triangles,
                                         const Topology& topology, double radius) const;
  /// The same, with a topology made for the call.
  std::vector<FaceContact> face_contacts(const std::vector<Vec3>& positions,
                                         const std::vector<Triangle>& triangles,
                                         double radius) const;

  /// All pairs within the radii, buried skin left out, in an order that depends on
  /// neither threads nor time. Vertices and edges of the cloth belong to their first
  /// triangle.
  /// @param positions  of the cloth, m
  /// @param asked  #F of the cloth, 0: this triangle is known to be far
  /// @param vertex_radius  m, of cloth vertices
  /// @param edge_radius  m, of edges and faces
  /// @param pairs  replaced
  void near_pairs(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                  const Topology& topology, const std::vector<char>& asked, double vertex_radius,
                  double edge_radius, BodyPairs& pairs) const;

  const TriangleMesh& mesh() const { return m_mesh; } ///< triangles turned
  const TriangleTree& tree() const { return m_tree; }
  const BodyFindings& findings() const { return m_findings; }
  /// Vertex normals, unit, weighted by angle, #V by 3.
  const std::vector<Vec3>& vertex_normals() const { return m_vertex_normals; }

private:
  void turn_faces();
  void turn(int triangle);
  void assess_sign_reliability();
  void number_skin(const std::vector<char>& buried);
  std::vector<Triangle> skin_triangles() const; ///< without buried ones
  std::vector<char> ask_winding_numbers();
  void assign_features(); ///< of the topology alone: who owns which vertex and edge
  void compute_normals();
  void find_convex_edges();
  Vec3 pseudonormal(int triangle, int feature) const; ///< not unit
  bool is_trusted(int triangle, int feature) const;

  TriangleMesh m_mesh;
  Topology m_topology;
  TriangleTree m_tree;              ///< all triangles
  TriangleTree m_skin;              ///< without buried ones; empty when none is
  std::vector<int> m_skin_triangle; ///< of m_skin, in m_mesh
  std::vector<int> m_skin_of;       ///< back: -1 for buried triangles
  /// Moments for the winding number, made when first asked for after a move: a clean body never
  /// asks.
  struct LazyWinding {
    std::once_flag once;
    WindingNumber winding;
  };
  std::shared_ptr<LazyWinding> m_winding = std::make_shared<LazyWinding>();
  std::vector<Vec3> m_face_normals, m_vertex_normals;
  std::vector<int> m_turned; ///< triangles, ascending
  std::vector<char> m_trusted_face, m_trusted_edge, m_trusted_vertex;
  /// Per triangle and side: the edge's other triangle, if it has two and this is the
  /// first; else below zero.
  std::vector<std::array<int, 3>> m_beyond;
  /// Per triangle: bits 0-2 vertices, 3-5 convex edges of which it is the first triangle.
  std::vector<unsigned char> m_owned;
  BodyFindings m_findings;
};

} // namespace sloper::collision

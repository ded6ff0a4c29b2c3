#pragma once
/// Hands in mittens, toes in socks: the skin that sleeves and trousers meet has each
/// hand, and the front of each foot, inside a convex hull, so that no hem is caught
/// between fingers or toes. A hull holds all skin beyond the wrist, or of the toes and
/// the ball of the foot, so cloth outside it is outside of that skin. Test:
/// tests/garment/body_model/test_extremity_hulls.cpp
#include <sloper/body/body.hpp>

namespace sloper::garment {

/// The skin with the hulls of its ends added.
class ExtremityHulls {
public:
  /// Bits for the ends that can be covered.
  enum Ends : unsigned { HANDS = 1, FEET = 2 };
  /// Both hands and both feet.
  static constexpr unsigned ALL_ENDS = HANDS | FEET;
  /// Hands and feet whose landmarks were not found stay as they are. Cost O(vertices of an end
  /// times shell faces).
  /// @param ends which to cover, of Ends
  ExtremityHulls(const body::Body& body, unsigned ends);
  /// The body's vertices and triangles, then those of the shells, which bury the ends.
  const TriangleMesh& mesh() const { return m_mesh; }
  bool has_shells() const { return !m_shells.empty(); }
  /// Positions of mesh() for moved skin. @param skin as many as the body's skin has, m
  std::vector<Vec3> positions(const std::vector<Vec3>& skin) const;
  /// Which of the covered ends, of Ends, have any of these points beside or beyond them, m.
  unsigned concerned(const std::vector<Vec3>& points) const;

private:
  TriangleMesh m_mesh;
  std::vector<int> m_source;   // of the shells' vertices, in the skin
  std::vector<Vec3> m_outward; // m, added to them
  struct Shell {
    Ends end;
    Vec3 root, tip;
  };
  std::vector<Shell> m_shells;
};

/// Triangles of the convex hull, counter-clockwise seen from outside; empty when the points lie in
/// a plane. Exact, incremental.
std::vector<Triangle> convex_hull_of(const std::vector<Vec3>& points);

} // namespace sloper::garment

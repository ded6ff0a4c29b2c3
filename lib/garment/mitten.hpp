#pragma once
/// Hands as mittens: the skin that long sleeves meet has each hand inside a convex shell, so that no cuff is caught between fingers.
/// The shell holds all skin beyond the wrist, so cloth outside it is outside the hand.
/// Test: tests/garment/test_mitten.cpp
#include <body/body.hpp>

namespace sloper::garment {

class MittenSkin {
public:
  /// Hands whose wrist or tip was not found stay as they are. Cost O(hand vertices times shell faces).
  explicit MittenSkin(const body::Body& body);
  /// The body's vertices and triangles, then those of the shells, which bury the hands.
  const TriangleMesh& mesh() const { return m_mesh; }
  bool has_shells() const { return !m_source.empty(); }
  /// Positions of mesh() for moved skin. @param skin as many as the body's skin has, m
  std::vector<Vec3> positions(const std::vector<Vec3>& skin) const;
  /// Whether any of these points is beside a hand or beyond a wrist, m.
  bool concerns(const std::vector<Vec3>& points) const;

private:
  TriangleMesh m_mesh;
  std::vector<int> m_source;   // of the shells' vertices, in the skin
  std::vector<Vec3> m_outward; // m, added to them
  struct Hand {
    Vec3 wrist, tip;
  };
  std::vector<Hand> m_hands;
};

/// Triangles of the convex hull, counter-clockwise seen from outside; empty when the points lie in a plane. Exact, incremental.
std::vector<Triangle> convex_hull_of(const std::vector<Vec3>& points);

} // namespace sloper::garment

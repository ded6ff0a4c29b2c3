#pragma once
/// Which skin is an arm's: by connection with the hand along the arm's bent centre line, wherever
/// the arm and its hand are.
#include <sloper/body/measure/arm_trace.hpp>
#include <vector>
namespace sloper::body {

/// The skin of one arm. A vertex belongs to it where the way from the finger's end over the skin is
/// hardly longer than to the nearest section of the arm: the trunk's side beside a hanging arm is
/// reached only around the arm pit. Where skins touch, and the way leads over, it must also be as
/// near to the centre line as the arm is thick. The border with the trunk is not drawn here: beyond
/// the last section all near skin is taken.
class ArmRegion {
public:
  /// @param stature m
  ArmRegion(const ArmTrace& arm, const TriangleMesh& skin, double stature);
  /// Vertices of the skin, each once, in ascending order.
  const std::vector<int>& vertices() const { return m_vertices; }

private:
  struct Place {
    double along, off,
        radius; ///< m: along the centre line from the hand's end, from the line, of the arm there
  };
  Place nearest(const Vec3& p) const;
  bool is_within(const Place& place) const;
  const ArmTrace& m_arm;
  double m_s;
  std::vector<Vec3> m_points; ///< of the centre line, from the hand's end to beyond the shoulder
  std::vector<double> m_along, m_radius; ///< at each of them
  std::vector<int> m_vertices;
};

} // namespace sloper::body

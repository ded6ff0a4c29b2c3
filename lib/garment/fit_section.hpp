#pragma once
/// A garment cut by a plane: the lines of cloth in it, as they lie and as they would be unstretched.
#include <garment/garment.hpp>

namespace sloper::garment {

struct SectionSegment {
  int triangle; ///< of the garment
  Vec3 a, b;    ///< m
  double rest;  ///< m: length of the same line of cloth in the (edited) pattern
};

/// One connected line of cloth, closed or open.
struct SectionChain {
  std::vector<SectionSegment> segments; ///< end to end
  bool closed = false;
  double length = 0;      ///< m, as it lies
  double rest_length = 0; ///< m, unstretched
  double opening = 0;     ///< m, straight from end to end where open
  /// Turns around `axis_point` seen along the plane's normal: about 1 for a line that goes round a trunk or limb.
  double turns(const Vec3& axis_point, const Vec3& normal) const;
};

/// @param use #F: which triangles take part; empty for all   @param normal unit
/// Chains are in the order of their lowest triangle; the plane is moved by 1e-7 m where it would pass through a particle.
std::vector<SectionChain> cut_garment(const Garment& garment, const std::vector<char>& use, const Vec3& point, const Vec3& normal);

} // namespace sloper::garment

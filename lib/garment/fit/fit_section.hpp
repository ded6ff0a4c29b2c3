#pragma once
/// A garment cut by a plane: the lines of cloth in it, as they lie and as they would be
/// unstretched.
#include <sloper/garment/garment.hpp>

#include <optional>

namespace sloper::garment {

/// The line of cloth that the plane cuts from one triangle.
struct SectionSegment {
  int triangle;         ///< of the garment
  Vec3 a, b;            ///< m
  double rest;          ///< m: length of the same line of cloth in the (edited) pattern
  double elsewhere = 0; ///< m: its length where the particles were elsewhere
};

/// One connected line of cloth, closed or open.
struct SectionChain {
  std::vector<SectionSegment> segments; ///< end to end
  bool closed = false;
  double length = 0;      ///< m, as it lies
  double rest_length = 0; ///< m, unstretched
  double elsewhere = 0;   ///< m, where the particles were elsewhere
  double opening = 0;     ///< m, straight from end to end where open
  /// Turns around `axis_point` seen along the plane's normal: about 1 for a line that goes round a
  /// trunk or limb.
  double turns(const Vec3& axis_point, const Vec3& normal) const;
  void reverse(); ///< the same line from its other end
};

/// @param use #F: which triangles take part; empty for all   @param normal unit
/// @param elsewhere  other positions of the particles, #P, in which the lines are measured too;
/// nullptr for none Chains are in the order of their lowest triangle; the plane is moved by 1e-7 m
/// where it would pass through a particle.
std::vector<SectionChain> cut_garment(const Garment& garment, const std::vector<char>& use,
                                      const Vec3& point, const Vec3& normal,
                                      const std::vector<Vec3>* elsewhere = nullptr);

/// One line of cloth around an axis, of one chain or of several whose ends are bridged straight
/// (under the arms, across an opening).
struct SectionLine {
  std::vector<SectionChain> chains; ///< in order around the axis
  double lying = 0, rest = 0; ///< m, girth as it lies and unstretched, bridges included in both
  double elsewhere = 0;       ///< m, where the particles were elsewhere, bridges as they lie
  double bridged = 0;         ///< m, of the girth
  bool closed() const { return bridged == 0; }
  std::size_t n_segments() const;
};

/// Chains that together go round the axis, front and back of a trunk whose arms were left out;
/// nothing when they leave more than `open` turns bare. Of chains that lie over each other the
/// innermost one counts.
std::optional<SectionLine> assemble_line(std::vector<SectionChain> chains, const Vec3& axis_point,
                                         const Vec3& normal, double open);

} // namespace sloper::garment

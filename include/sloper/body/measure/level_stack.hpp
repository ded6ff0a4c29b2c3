#pragma once
/// The skin in level slices: the legs followed up to the crotch, the trunk from there to the neck,
/// the head above it.
/// Test: tests/body/measure/test_level_stack.cpp
#include <map>
#include <optional>
#include <sloper/body/measure/section.hpp>
namespace sloper::body {

/// Crotch in front of the middles of the legs just below it, share of stature (sd 0.0075)
constexpr double CROTCH_BEFORE_LEGS = 0.0235;

/// All loops of the skin at one height, and which of them are legs and trunk.
struct Slice {
  double y = 0;            ///< m, body frame
  std::vector<Loop> loops; ///< largest area first
  int leg[2] = {-1, -1};   ///< loop of the left (0) and right (1) leg, below the crotch
  int trunk = -1;          ///< loop of the trunk, neck or head; arms may hang on it
};

/// All level slices of a closed skin that stands in (about) the body frame. It caches
/// cuts: use it from one thread at a time.
class LevelStack {
public:
  /// Cuts the skin and follows legs and trunk. O(slices and the triangles they meet).
  /// @param skin  outlives this
  /// @param stature  m
  /// @param spacing  m between levels
  /// @param roughness  m by which heights of a rebuilt skin are uncertain; 0 for a scan's
  /// own faces
  /// @param up unit vector within a few degrees of +y, the vertical by which the lower of two ends
  /// of a crotch is found
  LevelStack(const TriangleMesh& skin, double stature, double spacing, double roughness = 0,
             const Vec3& up = Vec3::UnitY());
  /// Slices from the soles upwards.
  const std::vector<Slice>& slices() const { return m_slices; }
  /// The slice whose band holds height y, m, and its index in slices(); clamped to the
  /// first and last.
  const Slice& at(double y) const;
  /// Index in slices() of the band that holds height y, m; clamped.
  int index(double y) const;
  /// Distance between levels, stature, m, and the skin, as given to the constructor.
  double spacing() const { return m_spacing; }
  double stature() const { return m_stature; }
  const TriangleMesh& skin() const { return *m_skin; }
  /// Loops of an exact cut at height y, m. Only the triangles of that level are visited.
  std::vector<Loop> exact(double y) const;
  /// The trunk (neck, head) loop of an exact cut at y, m; empty when there is none. The
  /// reference is valid as long as the stack.
  const std::optional<Loop>& trunk_at(double y) const;
  /// Loop of a leg in an exact cut at y, m. Thighs that touch are cut apart in the middle
  /// plane.
  /// @param side  0 left, 1 right
  /// @return empty above the crotch or where there is none
  std::optional<Loop> leg_at(double y, int side) const;
  /// Height at which the two leg loops become one, m, by bisection to 0.2 mm; empty when the legs
  /// are never apart.
  std::optional<double> crotch() const { return m_crotch; }
  Vec2 crotch_point() const { return m_crotch_point; } ///< (x, z) where they meet
  /// Rise of what is level by the likeliest vertical, `up` of the constructor, per length
  /// backwards.
  double rise() const { return m_rise; }
  /// A place before or behind that is as low as the crotch within the uncertainty of the
  /// vertical: either may be the crotch. Empty where there is none.
  const std::optional<Vec3>& other_crotch() const { return m_other_crotch; }

  /// Sets the crotch where the scan does not show it, m: legs are cut apart in the middle
  /// plane up to there.
  void move_crotch(double y, double z);

private:
  struct Underside {
    double plane = 0, lowest = 0; ///< x of the cut, height of its lowest place, m
    double best = 0, z = 0;       ///< favoured() height and depth of the place that is the crotch
    std::vector<std::array<Vec2, 2>> bottom; ///< (z, y)
  };
  Underside underside(double plane, double low, double high, double between,
                      const std::vector<int>& near) const;
  double favoured(const Vec2& q, double between) const;
  void settle_crotch(double low, double high, double middle, double between);
  void follow_legs();
  void follow_trunk();
  int trunk_of(const std::vector<Loop>& loops, const Loop& from) const;
  const TriangleMesh* m_skin;
  double m_stature, m_spacing, m_roughness;
  double m_rise; ///< of what is level by `up`, per length backwards
  std::vector<Slice> m_slices;
  LevelledMesh m_levelled;
  /// Cuts made before: several rules ask for the same heights.
  mutable std::map<double, std::optional<Loop>> m_trunk_at;
  std::optional<double> m_crotch;
  Vec2 m_crotch_point = Vec2::Zero();
  std::optional<Vec3> m_other_crotch;
};

} // namespace sloper::body

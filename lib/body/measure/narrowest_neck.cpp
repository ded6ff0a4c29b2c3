#include <body/measure/narrowest_neck.hpp>
#include <sloper/base/units.hpp>
#include <sloper/body/measure/section.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace sloper::body {

namespace {

constexpr double NECK_LOW = 0.025, NECK_HIGH = 0.05,
                 STEP = 0.005;   ///< of stature along the axis above the base
constexpr double REACH = 0.12;   ///< of stature from the base: skin farther off is no neck
constexpr double LEANS_DEG = 35; ///< of the neck's axis forward; on 23 bodies 21 to 49
constexpr std::array<double, 3> TURNS_DEG = {8, 4, 2}; ///< of the plane, from coarse to fine
constexpr double MOST_DEG = 70;                        ///< that a plane leans
constexpr double SHORTER_M = 1e-5;                     ///< what counts as shorter

struct Tilt {
  double pitch, roll; ///< rad: forward, to the body's left
  Vec3 normal() const {
    return {std::sin(roll), std::cos(roll) * std::cos(pitch), std::cos(roll) * std::sin(pitch)};
  }
};

class Neck {
public:
  Neck(const TriangleMesh& skin, const Vec3& base, double reach)
      : m_skin(skin), m_spheres(skin, near(skin, base, reach)) {}

  /// Taut girth of the section around p; nothing where none is.
  std::optional<double> girth(const Vec3& p, const Tilt& tilt) {
    const Plane plane = cross_plane(p, tilt.normal());
    for (const Loop& loop : cut(m_skin, plane, &m_spheres.near(plane)))
      if (loop.closed && loop.area > 0 && encloses(loop, Vec2::Zero()))
        return taut_girth(loop);
    return std::nullopt;
  }

  /// Turns the plane through p until no turn shortens its section. @return that girth
  std::optional<double> turn_to_least(const Vec3& p, Tilt& tilt) {
    std::optional<double> least = girth(p, tilt);
    for (const double degrees : TURNS_DEG)
      while (turn(p, units::radians(degrees), tilt, least)) {}
    return least;
  }

private:
  static std::vector<int> near(const TriangleMesh& skin, const Vec3& base, double reach) {
    std::vector<int> faces;
    for (std::size_t f = 0; f < skin.triangles.size(); ++f)
      if ((skin.positions[skin.triangles[f][0]] - base).squaredNorm() < reach * reach)
        faces.push_back(static_cast<int>(f));
    return faces;
  }

  /// The best of four turns by `angle`, rad. @return whether it shortens the section
  bool turn(const Vec3& p, double angle, Tilt& tilt, std::optional<double>& least) {
    const Tilt from = tilt;
    bool is_shorter = false;
    for (const auto& [pitch, roll] :
         {std::pair(angle, 0.0), {-angle, 0.0}, {0.0, angle}, {0.0, -angle}}) {
      const Tilt turned{from.pitch + pitch, from.roll + roll};
      const double most = units::radians(MOST_DEG);
      if (std::max(std::abs(turned.pitch), std::abs(turned.roll)) > most)
        continue;
      const auto length = girth(p, turned);
      if (!length || (least && *length > *least - SHORTER_M))
        continue;
      least = length;
      tilt = turned;
      is_shorter = true;
    }
    return is_shorter;
  }

  const TriangleMesh& m_skin;
  TriangleSpheres m_spheres;
};

} // namespace

std::optional<NeckSection> narrowest_neck(const TriangleMesh& skin, const Vec3& base,
                                          const Vec3& normal, double stature) {
  const double leans = units::radians(LEANS_DEG);
  const Vec3 axis(0, std::cos(leans), std::sin(leans));
  Neck neck(skin, base, REACH * stature);
  Tilt tilt{std::atan2(normal.z(), normal.y()), std::asin(normal.x())};
  std::optional<NeckSection> narrowest;
  for (double along = NECK_LOW; along < NECK_HIGH + 0.5 * STEP; along += STEP) {
    const Vec3 p = base + along * stature * axis;
    const auto girth = neck.turn_to_least(p, tilt);
    if (girth && (!narrowest || *girth < narrowest->girth_m))
      narrowest = NeckSection{*girth, p, tilt.normal()};
  }
  return narrowest;
}

} // namespace sloper::body

#include <body/ingest/plain_limbs.hpp>
#include <sloper/base/units.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace sloper::body {

namespace {

constexpr int N_OUTLINE_ANGLES = 48;
constexpr double CROTCH = 0.463; ///< Drillis and Contini 1966 give 0.47 to 0.48
// Plain legs that complete a torso: they carry no measurement, cloth hangs beside them.
constexpr double ROWS = 230; ///< of points over a stature
constexpr double ANKLE_HEIGHT = 0.045, ANKLE_ASIDE = 0.06, ANKLE_BEHIND = 0.005,
                 ANKLE_RADIUS = 0.020;
constexpr double KNEE_HEIGHT = 0.285, KNEE_RADIUS = 0.033;
constexpr double THIGH_ASIDE = 0.053, THIGH_RADIUS = 0.049;
constexpr double FOOT_BACK = -0.035, FOOT_FRONT = 0.112, FOOT_HALF_BREADTH = 0.021;
constexpr double INSTEP_FROM = 0.03, INSTEP_LENGTH = 0.082, INSTEP_FALL = 0.75;
constexpr double FOOT_CLOSED_BEHIND = -0.03, FOOT_CLOSED_BEFORE = 0.107;
constexpr double FOOT_STEP = 0.04, FOOT_END = 1.0001; ///< of its breadth and height
constexpr double LEGS_APART = 0.004; ///< a rim with nothing so near the middle is two thighs
constexpr std::size_t LEAST_RIM = 8; ///< points of one thigh

// A plain head, shares of stature: breadth 0.10, depth 0.12, height 0.13 (kit bodies and
// mannequins have about these).
constexpr double HEAD_MIDDLE = 0.935, HEAD_HALF_HEIGHT = 0.065, HEAD_HALF_BREADTH = 0.05;
constexpr double HEAD_HALF_DEPTH = 0.06, HEAD_BEFORE_NECK = 0.012;
constexpr double NECK_NARROW = 0.78; ///< of what is cut off: the neck's radius below the head

/// Points of plain legs in a frame of left, up, forward, m-like units of stature s; `outline` is
/// the trunk's, as radius over angle.
class Legs {
public:
  Legs(double s) : m_s(s), m_step(s / ROWS) {}
  std::vector<Vec3> points;

  void tube(const Vec3& top, const Vec3& bottom, const std::array<double, N_OUTLINE_ANGLES>& above,
            double below) {
    const int rows = std::max(1, static_cast<int>((top.y() - bottom.y()) / m_step));
    for (int k = 0; k <= rows; ++k) {
      const double t = static_cast<double>(k) / rows;
      const Vec3 c = top + t * (bottom - top);
      for (int a = 0; a < 2 * N_OUTLINE_ANGLES; ++a) {
        const double r0 =
            a % 2 ? 0.5 * (above[a / 2] + above[(a / 2 + 1) % N_OUTLINE_ANGLES]) : above[a / 2];
        const double r = below < 0 ? r0 : r0 + t * (below - r0),
                     theta = units::PI * a / N_OUTLINE_ANGLES;
        points.emplace_back(c.x() + r * std::cos(theta), c.y(), c.z() + r * std::sin(theta));
      }
    }
  }
  void foot(const Vec3& ankle) {
    const double high = ankle.y();
    const double half = FOOT_HALF_BREADTH * m_s, instep = INSTEP_FROM * m_s;
    for (double z = FOOT_BACK * m_s; z <= FOOT_FRONT * m_s; z += m_step)
      for (double t = 0; t <= FOOT_END; t += FOOT_STEP) {
        const double fall = INSTEP_FALL * (z - instep) / (INSTEP_LENGTH * m_s);
        const double top = z < instep ? high : high * (1 - fall);
        const double x = half * (2 * t - 1);
        points.emplace_back(ankle.x() + x, top, ankle.z() + z);
        points.emplace_back(ankle.x() + x, 0, ankle.z() + z);
        for (const double side : {-half, half})
          points.emplace_back(ankle.x() + side, t * top, ankle.z() + z);
        if (z < FOOT_CLOSED_BEHIND * m_s || z > FOOT_CLOSED_BEFORE * m_s)
          points.emplace_back(ankle.x() + x, 0.5 * top, ankle.z() + z);
      }
  }
  static std::array<double, N_OUTLINE_ANGLES> circle(double r) {
    std::array<double, N_OUTLINE_ANGLES> all;
    all.fill(r);
    return all;
  }

private:
  double m_s, m_step;
};

/// Radius over angle of points around a centre, gaps filled by their neighbours.
std::array<double, N_OUTLINE_ANGLES> outline_of(const std::vector<Vec2>& points,
                                                const Vec2& center) {
  std::array<double, N_OUTLINE_ANGLES> radius;
  radius.fill(-1);
  for (const Vec2& p : points) {
    const Vec2 d = p - center;
    const int k = static_cast<int>(
                      std::lround(std::atan2(d.y(), d.x()) / (2 * units::PI) * N_OUTLINE_ANGLES) +
                      N_OUTLINE_ANGLES) %
                  N_OUTLINE_ANGLES;
    radius[k] = std::max(radius[k], d.norm());
  }
  for (int k = 0; k < N_OUTLINE_ANGLES; ++k)
    for (int j = 1; j < N_OUTLINE_ANGLES && radius[k] < 0; ++j)
      radius[k] = std::max(radius[(k + j) % N_OUTLINE_ANGLES],
                           radius[(k + N_OUTLINE_ANGLES - j) % N_OUTLINE_ANGLES]);
  return radius;
}

Vec2 box_middle(const std::vector<Vec2>& points) {
  Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
  for (const Vec2& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return 0.5 * (low + high);
}

} // namespace

std::vector<Vec3> plain_legs(const std::vector<Vec2>& rim, double cut, double s) {
  Legs legs(s);
  std::vector<Vec2> side[2];
  bool apart = cut < 0.5 * s;
  const Vec2 middle = box_middle(rim);
  for (const Vec2& p : rim) {
    side[p.x() > middle.x() ? 0 : 1].push_back(p);
    apart &= std::abs(p.x() - middle.x()) > LEGS_APART * s;
  }
  if (!apart && cut > CROTCH * s)
    legs.tube({middle.x(), cut, middle.y()}, {middle.x(), CROTCH * s, middle.y()},
              outline_of(rim, middle), -1);
  for (int k = 0; k < 2; ++k) {
    const double sign = k == 0 ? 1 : -1, ankle_y = ANKLE_HEIGHT * s;
    Vec3 top(middle.x() + sign * THIGH_ASIDE * s, std::min(cut, CROTCH * s), middle.y());
    std::array<double, N_OUTLINE_ANGLES> above = Legs::circle(THIGH_RADIUS * s);
    if (apart && side[k].size() > LEAST_RIM) {
      const Vec2 c = box_middle(side[k]);
      top = Vec3(c.x(), cut, c.y());
      above = outline_of(side[k], c);
    }
    const Vec3 ankle(middle.x() + sign * ANKLE_ASIDE * s, ankle_y, middle.y() - ANKLE_BEHIND * s);
    const double knee_y = KNEE_HEIGHT * s, knee_radius = KNEE_RADIUS * s;
    const double to_knee = knee_y < top.y() ? (top.y() - knee_y) / (top.y() - ankle_y) : 0.0;
    const Vec3 knee = top + to_knee * (ankle - top);
    const bool thigh = knee.y() < top.y();
    if (thigh)
      legs.tube(top, knee, above, knee_radius);
    legs.tube(knee, ankle, thigh ? Legs::circle(knee_radius) : above, ANKLE_RADIUS * s);
    legs.foot(ankle);
  }
  return legs.points;
}

std::vector<Vec3> plain_head(const std::vector<Vec2>& rim, double cut, double s) {
  const Vec2 middle = box_middle(rim);
  const std::array<double, N_OUTLINE_ANGLES> above = outline_of(rim, middle);
  double mean = 0;
  for (const double r : above)
    mean += r / N_OUTLINE_ANGLES;
  Legs neck(s); // from the head down to the rim, its rows are as dense as those of legs
  const double end = (HEAD_MIDDLE - 0.5 * HEAD_HALF_HEIGHT) * s;
  if (cut < end)
    neck.tube({middle.x(), cut, middle.y()}, {middle.x(), end, middle.y() + HEAD_BEFORE_NECK * s},
              above, NECK_NARROW * mean);
  const int rows = static_cast<int>(2 * HEAD_HALF_HEIGHT * ROWS);
  for (int k = 0; k <= rows; ++k) {
    const double latitude = units::PI * (static_cast<double>(k) / rows - 0.5);
    for (int a = 0; a < 2 * N_OUTLINE_ANGLES; ++a) {
      const double theta = units::PI * a / N_OUTLINE_ANGLES, ring = std::cos(latitude);
      const Vec3 p(middle.x() + HEAD_HALF_BREADTH * s * ring * std::cos(theta),
                   (HEAD_MIDDLE + HEAD_HALF_HEIGHT * std::sin(latitude)) * s,
                   middle.y() + HEAD_BEFORE_NECK * s +
                       HEAD_HALF_DEPTH * s * ring * std::sin(theta));
      const Vec2 from_neck(p.x() - middle.x(), p.z() - middle.y() - HEAD_BEFORE_NECK * s);
      const bool is_within_neck = p.y() < end && from_neck.norm() < NECK_NARROW * mean;
      if (!is_within_neck)
        neck.points.push_back(p);
    }
  }
  return neck.points;
}

} // namespace sloper::body

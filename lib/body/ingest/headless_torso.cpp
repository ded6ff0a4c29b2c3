#include <body/ingest/canonical_frame.hpp>
#include <body/ingest/plain_limbs.hpp>
#include <body/ingest/torso_only.hpp>
#include <sloper/base/error.hpp>
#include <sloper/base/statistics.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace sloper::body {

namespace {

// Shares of stature. Of 26 bodies, 6 of them mannequins, each cut off at three heights of the neck,
// the turn lies at 0.842 (standard deviation 0.009); the middle of the neck lies before that of the
// shoulders by 0.02 (0.01), and on one of these 78 cuts behind it, by 0.001.
constexpr double TURN_HEIGHT = 0.843;    ///< where the neck has turned into the shoulders
constexpr double STATURE_OF_TRUNK = 2.4; ///< statures in the height of the scan: a first guess
constexpr double TRUNK_RADIUS = 0.13;    ///< of the trunk without arms, around the neck
constexpr double RIM_WIDTH = 0.012;      ///< left out where the trunk ends
constexpr double LID = 0.003;            ///< left out where the neck ends
constexpr double STEP = 0.005, HALF_BAND = 0.006;    ///< of sections of the trunk, and half of each
constexpr double NECK_SEARCH = 0.16;                 ///< from the top down to the turn at most
constexpr double TURNED = 1.9;                       ///< times as broad as the neck: shoulders
constexpr double SHOULDER_BROADER = 0.08;            ///< or broader by this: over a thick neck
constexpr int NECK_SECTIONS = 6;                     ///< in which the neck is the narrowest
constexpr double CHEST_FROM = 0.12, CHEST_TO = 0.35; ///< below the top: what is broader than deep
constexpr double SHOULDERS_BELOW_TURN = 0.015;
constexpr double TRUNK_SECTIONS[] = {0.03, 0.08, 0.14}; ///< below the turn
constexpr double MOST_ASKEW = 0.03; ///< middle of a trunk's section beside the neck's
/// From the end of the neck to that of the trunk; what is less high is a trunk seen along another
/// axis, or does not reach down to the hips.
constexpr double LEAST_HEIGHT = 0.36;
constexpr double LEGS_REACH = 0.75;     ///< below the turn: the scan shows the legs too
constexpr std::size_t LEAST_POINTS = 6; ///< of a section, and of the neck's end

/// A trunk below a neck that is cut off, the file's unit.
struct Trunk {
  double s = 0;                      ///< stature, estimated
  double top = 0, turn = 0, low = 0; ///< heights: end of the neck, its turn, end of the trunk
  Vec2 center = Vec2::Zero(), left = Vec2::UnitX(), forward = Vec2::UnitY();
  double clear = 0;         ///< shoulders to neck
  std::vector<Vec3> points; ///< left, height, forward of the neck's middle
};

struct Extent {
  double low = 1e300, high = -1e300;
  std::size_t n = 0;
  void add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
    ++n;
  }
  double size() const { return high - low; }
  double middle() const { return 0.5 * (low + high); }
};

/// Extent along `axis` (0 left, 2 forward) of what lies about a height, arms left out.
Extent section_at(const Trunk& t, double height, int axis) {
  Extent extent;
  for (const Vec3& p : t.points)
    if (std::abs(p.y() - height) < HALF_BAND * t.s && std::abs(p.x()) < TRUNK_RADIUS * t.s)
      extent.add(p[axis]);
  return extent;
}

/// Puts the neck's end in the middle, and the longer axis of the chest to the left.
bool turn_trunk(const TriangleMesh& scan, const Upright& upright, Trunk& t) {
  Extent across[2];
  for (const Vec3& p : scan.positions)
    if (upright.height(p) > t.top - 2 * LID * t.s) {
      across[0].add(upright.across(p).x());
      across[1].add(upright.across(p).y());
    }
  if (across[0].n < LEAST_POINTS)
    return false;
  t.center = Vec2(across[0].middle(), across[1].middle());
  double xx = 0, xy = 0, yy = 0;
  for (const Vec3& p : scan.positions) {
    const Vec2 a = upright.across(p) - t.center;
    const double below = t.top - upright.height(p);
    if (a.norm() > TRUNK_RADIUS * t.s || below < CHEST_FROM * t.s || below > CHEST_TO * t.s)
      continue;
    xx += a.x() * a.x();
    xy += a.x() * a.y();
    yy += a.y() * a.y();
  }
  const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
  t.left = Vec2(std::cos(angle), std::sin(angle));
  t.forward = Vec2(-std::sin(angle), std::cos(angle));
  t.points.clear();
  for (const Vec3& p : scan.positions) {
    const Vec2 a = upright.across(p) - t.center;
    t.points.emplace_back(t.left.dot(a), upright.height(p), t.forward.dot(a));
  }
  return true;
}

/// The turn of the neck into the shoulders, from the top down.
bool find_turn(Trunk& t) {
  double narrow = 1e300;
  for (int k = 0; k * STEP < NECK_SEARCH; ++k) {
    const double y = t.top - (HALF_BAND + k * STEP) * t.s;
    const Extent breadth = section_at(t, y, 0);
    if (breadth.n < LEAST_POINTS)
      continue;
    if (k < NECK_SECTIONS)
      narrow = std::min(narrow, breadth.size());
    if (breadth.size() < std::min(TURNED * narrow, narrow + SHOULDER_BROADER * t.s))
      continue;
    t.turn = y;
    t.clear = section_at(t, y - SHOULDERS_BELOW_TURN * t.s, 0).size() / narrow;
    return true;
  }
  return false;
}

/// The trunk is as broad on both sides of the neck: seen along another axis the end of a shoulder
/// looks like a neck, and the trunk lies on one side of it.
bool is_upright(const Trunk& t) {
  for (const double below : TRUNK_SECTIONS) {
    Extent breadth;
    for (const Vec3& p : t.points)
      if (std::abs(p.y() - t.turn + below * t.s) < HALF_BAND * t.s &&
          std::abs(p.x()) < 2 * TRUNK_RADIUS * t.s)
        breadth.add(p.x());
    if (breadth.n < LEAST_POINTS || std::abs(breadth.middle()) > MOST_ASKEW * t.s)
      return false;
  }
  return true;
}

/// The neck lies before the shoulders.
bool face_forward(Trunk& t) {
  const Extent neck = section_at(t, t.top - HALF_BAND * t.s, 2);
  const Extent shoulders = section_at(t, t.turn - SHOULDERS_BELOW_TURN * t.s, 2);
  if (neck.n < LEAST_POINTS || shoulders.n < LEAST_POINTS)
    return false;
  if (neck.middle() < shoulders.middle()) {
    t.forward = -t.forward;
    for (Vec3& p : t.points)
      p.z() = -p.z();
  }
  return true;
}

/// @param stature the file's unit; 0 where it is not known yet
std::optional<Trunk> find_trunk(const TriangleMesh& scan, const Upright& upright, double stature) {
  constexpr double LOW_END = 0.0005, HIGH_END = 0.9995; // shares of the points
  std::vector<double> heights;
  for (const Vec3& p : scan.positions)
    heights.push_back(upright.height(p));
  Trunk t;
  t.low = lower_quantile(heights, LOW_END);
  t.top = lower_quantile(heights, HIGH_END);
  t.s = stature > 0 ? stature : STATURE_OF_TRUNK * (t.top - t.low);
  if (!(t.s > 0) || !turn_trunk(scan, upright, t) || !find_turn(t) || !is_upright(t) ||
      !face_forward(t))
    return std::nullopt;
  return t;
}

/// Stature in the file's unit where the user says it in metres: the unit is the one in which the
/// trunk's own is the nearest.
double given_stature(const Trunk& t, const SizeOptions& size) {
  double best = 1e300, s = t.s;
  for (const LengthUnit& unit : LENGTH_UNITS)
    if (const double off = std::abs(std::log(t.s * unit.metres / size.stature_m)); off < best) {
      best = off;
      s = size.stature_m / unit.metres;
    }
  return s;
}

} // namespace

std::optional<CompletedTorso> complete_headless(const TriangleMesh& scan,
                                                const std::string& up_axis, const SizeOptions& size,
                                                const std::string& file) {
  std::optional<Trunk> best;
  Upright upright;
  bool shows_neck = false;
  for (const int axis : {1, 2, 0})
    for (const double sign : {1.0, -1.0}) {
      if (up_axis != "auto" && up_axis[0] - 'x' != axis)
        continue;
      auto found = find_trunk(scan, {axis, sign}, 0);
      shows_neck |= found.has_value();
      if (found && size.stature_m > 0)
        found = find_trunk(scan, {axis, sign}, given_stature(*found, size));
      if (!found || (best && found->clear <= best->clear))
        continue;
      if (found->top - found->low < LEAST_HEIGHT * found->s)
        continue;
      best = std::move(found);
      upright = {axis, sign};
    }
  if (shows_neck && size.stature_m <= 0)
    throw input_error("scan.no-stature"_id, file, "",
                      "the neck is cut off: nothing shows how tall the person is",
                      "give --stature, the person's whom the dummy stands for");
  if (!best)
    return std::nullopt;
  Trunk& t = *best;
  const double s = t.s, floor = t.turn - TURN_HEIGHT * s, cut = t.low - floor, top = t.top - floor;
  const bool has_legs = t.turn - t.low > LEGS_REACH * s;
  for (Vec3& p : t.points)
    p.y() -= floor;
  CompletedTorso made;
  made.scan = scan;
  made.has_head = false;
  made.lacks = "it has no head";
  made.is_cut.assign(t.points.size(), 0);
  std::vector<Vec2> rim, neck;
  for (std::size_t v = 0; v < t.points.size(); ++v) {
    const Vec3& p = t.points[v];
    const bool of_trunk = std::hypot(p.x(), p.z()) < 1.3 * TRUNK_RADIUS * s;
    made.is_cut[v] =
        of_trunk && ((!has_legs && p.y() < cut + RIM_WIDTH * s) || p.y() > top - LID * s);
    if (of_trunk && p.y() > cut + RIM_WIDTH * s && p.y() < cut + 3 * RIM_WIDTH * s)
      rim.emplace_back(p.x(), p.z());
    if (of_trunk && p.y() > top - RIM_WIDTH * s)
      neck.emplace_back(p.x(), p.z());
  }
  if (rim.size() < LEAST_POINTS || neck.size() < LEAST_POINTS)
    return std::nullopt;
  std::vector<Vec3> plain = plain_head(neck, top - LID * s, s);
  if (!has_legs) {
    const std::vector<Vec3> legs = plain_legs(rim, cut + RIM_WIDTH * s, s);
    plain.insert(plain.end(), legs.begin(), legs.end());
  }
  for (const Vec3& q : plain)
    made.scan.positions.push_back(
        upright.point(t.center + q.x() * t.left + q.z() * t.forward, floor + q.y()));
  made.up = upright.point(Vec2::Zero(), 1);
  made.seen_from = has_legs ? floor - s : floor + cut + RIM_WIDTH * s;
  made.seen_to = t.top - LID * s;
  made.stature = s;
  return made;
}

} // namespace sloper::body

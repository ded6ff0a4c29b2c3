#include <body/ingest/plain_limbs.hpp>
#include <body/ingest/torso_only.hpp>
#include <sloper/base/error.hpp>
#include <sloper/base/statistics.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

namespace sloper::body {

namespace {

/// From a height to a height.
struct Band {
  double low, high;
  constexpr Band times(double s) const { return {low * s, high * s}; }
  bool holds(double y) const { return y > low && y < high; }
};

// shares of stature
constexpr double NECK_BELOW_CROWN = 0.122; ///< narrowest place of the neck
constexpr double HEAD_BREADTH = 0.1015;    ///< at its broadest; varies less than the neck's height
constexpr double BREADTH_WEIGHT = 0.75;
constexpr double LEAST_TRUNK = 0.7; ///< a torso reaches down to here at least: the chest
constexpr double COLUMN = 0.13;     ///< of the trunk without arms, around the neck
constexpr double RIM = 0.012;       ///< left out where the torso ends: a lid, or torn edges
constexpr int N_LAYERS = 120;

// A head on a neck above shoulders, by half diagonals of layers. Measured on the shared torso scans
// and cut mannequins of the tests, on no population.
constexpr double HEAD_OVER_NECK = 1.15;     ///< a head is broader than its neck by this
constexpr double SHOULDERS_OVER_HEAD = 1.3; ///< shoulders are broader than the head by this
constexpr double DOME_UNDER_HEAD = 0.85;    ///< a crown is round: its top layers are narrower
constexpr double HEAD_HIGH = 2.4;           ///< times its half diagonal, at most
constexpr double HEAD_OF_HEIGHT = 0.32;     ///< of the scan; two hands that hang are farther apart
constexpr double SHOULDERS_COUNT = 2.0;     ///< shoulders broader than this count no more
constexpr double STATURE_AGREES = 0.15;     ///< factors of e: a head shows it to 4 in 100
constexpr double BOTH_ENDS = 0.4;           ///< clearness where both ends look like a head
constexpr double LOW_END = 0.0005, HIGH_END = 0.9995; ///< shares of the points: few lie outside
constexpr int DOME_LAYERS = 3;                        ///< the crown's
constexpr int HEAD_LAYERS = 5;                        ///< a head has more

// Which way a torso faces.
constexpr Band CHEST_BAND{0.68, 0.76}, SHOULDER_BAND{0.79, 0.81}; ///< heights
constexpr double HEAD_ABOVE = 0.90;                               ///< height
constexpr double HEAD_RADIUS = 0.1;                               ///< around the neck
constexpr std::size_t LEAST_CHEST = 40; ///< points; fewer: the shoulders tell

// The head's breadth.
constexpr Band HEAD_BAND{0.89, 0.97};
constexpr double HEAD_STEP = 0.008, HEAD_HALF_STEP = 0.006;

constexpr std::size_t LEAST_TRUNK_RIM = 12;
constexpr double TRUNK_COLUMN = 1.3 * COLUMN; ///< of the trunk where it is cut, around the neck

// What is believed near the place where a torso is cut.
constexpr double HAND_AT_RIM = 0.03; ///< a stump that ends so near to it is no hand
constexpr double ABOVE_RIM = 0.02;   ///< an extremum nearer to it is the rim itself
constexpr double WITH_CROTCH = 0.8, WITHOUT_CROTCH = 0.5; ///< factors of the confidence of ratios

struct Neck {
  double crown = 0, height = 0; ///< the file's unit
  double clear = 0;             ///< how much the neck is narrower than head and shoulders
  Vec2 center = Vec2::Zero();
};

/// A head that narrows to a neck and widens to shoulders, from the top down; empty where there is
/// none.
std::optional<Neck> find_neck(const TriangleMesh& scan, const Upright& upright) {
  std::vector<double> heights;
  for (const Vec3& p : scan.positions)
    heights.push_back(upright.height(p));
  const double low = lower_quantile(heights, LOW_END), high = lower_quantile(heights, HIGH_END),
               step = (high - low) / N_LAYERS;
  if (!(step > 0))
    return std::nullopt;
  std::vector<std::vector<Vec2>> layers(N_LAYERS);
  for (const Vec3& p : scan.positions) {
    const int k = static_cast<int>((upright.height(p) - low) / step);
    if (k >= 0 && k < N_LAYERS)
      layers[k].push_back(upright.across(p));
  }
  std::array<double, N_LAYERS> radius{};
  std::array<Vec2, N_LAYERS> middle;
  for (int k = 0; k < N_LAYERS;
       ++k) { // half the diagonal of the box: dense faces do not count more
    Vec2 least = Vec2::Constant(1e300), most = Vec2::Constant(-1e300);
    for (const Vec2& q : layers[k]) {
      least = least.cwiseMin(q);
      most = most.cwiseMax(q);
    }
    radius[k] = layers[k].size() < 4 ? -1 : 0.5 * (most - least).norm();
    middle[k] = 0.5 * (most + least);
  }
  double dome = 0; // a crown is round; where a body is cut off, its end is as broad as what follows
  for (int k = N_LAYERS - DOME_LAYERS; k < N_LAYERS; ++k)
    dome = std::max(dome, radius[k]);
  std::optional<Neck> best;
  double clearest = 0;
  for (int k = N_LAYERS - HEAD_LAYERS; k > N_LAYERS * 2 / 5; --k) {
    if (radius[k] <= 0)
      continue;
    const auto head = std::max_element(radius.begin() + k, radius.end());
    const int centre = static_cast<int>(head - radius.begin());
    const auto below =
        std::max_element(radius.begin() + std::max(0, k - (N_LAYERS - k)), radius.begin() + k);
    if (*head < HEAD_OVER_NECK * radius[k])
      continue;
    if (*below < SHOULDERS_OVER_HEAD * *head || dome > DOME_UNDER_HEAD * *head)
      continue;
    // a head is about as high as it is broad, and nothing of the body is higher
    const double height = (N_LAYERS - k) * step;
    if (height < *head || height > HEAD_HIGH * *head)
      continue;
    if (*head > HEAD_OF_HEIGHT * (high - low))
      continue;
    const double clear = (*head / radius[k]) * std::min(SHOULDERS_COUNT, *below / *head);
    if (clear > clearest) {
      clearest = clear;
      best = Neck{high, low + (k + 0.5) * step, clear, 0.5 * (middle[k] + middle[centre])};
    }
  }
  return best;
}

/// The left-right axis of the trunk (first), and forward (second): the trunk is wider than deep,
/// the head lies before the shoulders.
struct Heading {
  Vec2 left, forward;
};

Heading find_heading(const std::vector<Vec3>& p, const Neck& neck,
                     double s) { // p: across, height above the floor, across
  Vec2 mean = Vec2::Zero();
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  std::vector<Vec2> chest, shoulder, head;
  for (const Vec3& q : p) {
    const Vec2 a(q.x(), q.z());
    if ((a - neck.center).norm() > COLUMN * s)
      continue;
    if (CHEST_BAND.times(s).holds(q.y()))
      chest.push_back(a);
    if (SHOULDER_BAND.times(s).holds(q.y()))
      shoulder.push_back(a);
    if (q.y() > HEAD_ABOVE * s && (a - neck.center).norm() < HEAD_RADIUS * s)
      head.push_back(a);
  }
  const std::vector<Vec2>& of = chest.size() > LEAST_CHEST ? chest : shoulder;
  for (const Vec2& a : of)
    mean += a / static_cast<double>(std::max<std::size_t>(1, of.size()));
  for (const Vec2& a : of)
    spread += (a - mean) * (a - mean).transpose();
  const double angle = 0.5 * std::atan2(2 * spread(0, 1), spread(0, 0) - spread(1, 1));
  Heading heading{Vec2(std::cos(angle), std::sin(angle)), Vec2(-std::sin(angle), std::cos(angle))};
  auto middle = [&](const std::vector<Vec2>& points) {
    double low = 1e300, high = -1e300;
    for (const Vec2& a : points) {
      low = std::min(low, heading.forward.dot(a));
      high = std::max(high, heading.forward.dot(a));
    }
    return 0.5 * (low + high);
  };
  if (!head.empty() && !shoulder.empty() && middle(head) < middle(shoulder))
    heading.forward = -heading.forward;
  return heading; // which side is left does not matter here: legs are alike
}

/// The scan around its neck, stature estimated.
struct Stand {
  double s = 0, cut = 1e300; ///< stature; height at which the trunk ends
  Heading heading;
  std::vector<Vec3> points; ///< left, height above the floor, forward
};

Stand stand_up(const TriangleMesh& scan, const Upright& upright, const Neck& neck) {
  Stand stand;
  std::vector<Vec3>& p = stand.points;
  p.resize(scan.positions.size());
  double s = (neck.crown - neck.height) / NECK_BELOW_CROWN;
  const auto put = [&] { // across, height above the floor, across
    for (std::size_t v = 0; v < p.size(); ++v) {
      const Vec2 a = upright.across(scan.positions[v]);
      p[v] = Vec3(a.x(), upright.height(scan.positions[v]) - (neck.crown - s), a.y());
    }
  };
  put();
  stand.heading = find_heading(p, neck, s);
  double breadth = 0;
  for (double y = HEAD_BAND.low * s; y < HEAD_BAND.high * s; y += HEAD_STEP * s) {
    double low = 1e300, high = -1e300;
    for (const Vec3& q : p)
      if (const Vec2 a = Vec2(q.x(), q.z()) - neck.center;
          std::abs(q.y() - y) < HEAD_HALF_STEP * s && a.norm() < HEAD_RADIUS * s) {
        low = std::min(low, stand.heading.left.dot(a));
        high = std::max(high, stand.heading.left.dot(a));
      }
    breadth = std::max(breadth, high - low);
  }
  s = BREADTH_WEIGHT * breadth / HEAD_BREADTH + (1 - BREADTH_WEIGHT) * s;
  put();
  stand.heading = find_heading(p, neck, s);
  for (Vec3& q : p) {
    const Vec2 a = Vec2(q.x(), q.z()) - neck.center;
    q = Vec3(stand.heading.left.dot(a), q.y(), stand.heading.forward.dot(a));
    if (std::hypot(q.x(), q.z()) < COLUMN * s)
      stand.cut = std::min(stand.cut, q.y());
  }
  stand.s = s;
  return stand;
}

} // namespace

CompletedTorso complete_torso(const TriangleMesh& scan, const std::string& up_axis,
                              const SizeOptions& size, const std::string& file) {
  struct Candidate {
    Upright upright;
    Neck neck;
  };
  std::vector<Candidate> candidates;
  for (const int axis : {1, 2, 0}) {
    if (up_axis != "auto" && up_axis[0] - 'x' != axis)
      continue;
    const auto up = find_neck(scan, {axis, 1}), down = find_neck(scan, {axis, -1});
    for (const double sign : {1.0, -1.0}) {
      auto found = sign > 0 ? up : down;
      if (!found)
        continue;
      if (up && down)
        found->clear *=
            BOTH_ENDS; // a hand on its wrist looks like a head, but there are two of them
      candidates.push_back({{axis, sign}, *found});
    }
  }
  // what looks like a head and gives another stature than the user is none
  if (size.stature_m > 0)
    std::erase_if(candidates, [&](const Candidate& c) {
      const double s = stand_up(scan, c.upright, c.neck).s;
      return std::none_of(
          std::begin(LENGTH_UNITS), std::end(LENGTH_UNITS), [&](const LengthUnit& unit) {
            return std::abs(std::log(s * unit.metres / size.stature_m)) < STATURE_AGREES;
          });
    });
  if (candidates.empty())
    if (auto made = complete_headless(scan, up_axis, size, file))
      return std::move(*made);
  if (candidates.empty())
    throw input_error("scan.no-torso"_id, file, "",
                      "no torso: no neck above shoulders in any axis direction",
                      "a torso scan must show the neck; check --up");
  std::stable_sort(
      candidates.begin(), candidates.end(),
      [](const Candidate& a, const Candidate& b) { return a.neck.clear > b.neck.clear; });
  for (const auto& [upright, neck] : candidates) {
    const Stand stand = stand_up(scan, upright, neck);
    const double s = stand.s;
    std::vector<Vec2> rim;
    for (const Vec3& p : stand.points)
      if (std::hypot(p.x(), p.z()) < TRUNK_COLUMN * s && p.y() > stand.cut + RIM * s &&
          p.y() < stand.cut + 3 * RIM * s)
        rim.emplace_back(p.x(), p.z());
    if (stand.cut > LEAST_TRUNK * s || rim.size() < LEAST_TRUNK_RIM)
      continue;
    CompletedTorso made;
    made.is_cut.assign(stand.points.size(), 0);
    for (std::size_t v = 0; v < stand.points.size(); ++v)
      made.is_cut[v] = std::hypot(stand.points[v].x(), stand.points[v].z()) < TRUNK_COLUMN * s &&
                       stand.points[v].y() < stand.cut + RIM * s;
    const double floor = neck.crown - s;
    made.scan = scan;
    for (const Vec3& q : plain_legs(rim, stand.cut + RIM * s, s))
      made.scan.positions.push_back(upright.point(
          neck.center + q.x() * stand.heading.left + q.z() * stand.heading.forward, floor + q.y()));
    made.up = upright.point(Vec2::Zero(), 1);
    made.seen_from = floor + stand.cut + RIM * s;
    made.lacks = "it has no legs";
    made.stature = s;
    return made;
  }
  throw input_error("scan.ends-above-waist"_id, file, "", "the scan ends above the waist",
                    "a torso scan must reach down to the waist");
}

/// What a plain head shows is no measurement.
template<class Forget> static void forget_head(Body& body, double seen_to, const Forget& forget) {
  constexpr double NECK_GIRTH_UP = 0.0235; // of stature: the neck's girth runs above its centre
  forget("head_tip");
  std::vector<std::string> high;
  for (const auto& [name, landmark] : body.landmarks)
    if (name.starts_with("neck") && landmark.p.y() > seen_to)
      high.push_back(name);
  for (const std::string& name : high)
    forget(name);
  const bool shows_neck =
      body.has_landmark("neck_center") &&
      body.landmark("neck_center").y() + NECK_GIRTH_UP * body.scan.stature_m < seen_to;
  if (!shows_neck)
    body.girths.erase("neck");
}

void forget_unseen(Body& body, const SeenHeights& seen) {
  const double s = body.scan.stature_m, sure = seen.from + 0.015 * s;
  std::vector<std::string> lost;
  auto forget = [&](const std::string& name) {
    if (body.landmarks.erase(name))
      lost.push_back(name);
  };
  const bool has_crotch = body.has_landmark("crotch") &&
                          body.landmark("crotch").y() > sure + 0.005 * s &&
                          body.landmarks.at("crotch").confidence > 0.4;
  std::vector<std::string> names;
  for (const auto& [name, landmark] : body.landmarks)
    names.push_back(name);
  bool hand_is_cut[2] = {false, false}; // a stump that ends where the trunk ends is no hand
  for (int side = 0; side < 2; ++side)
    if (const auto tip = body.landmarks.find(side == 0 ? "hand_tip_l" : "hand_tip_r");
        tip != body.landmarks.end())
      hand_is_cut[side] = std::abs(tip->second.p.y() - seen.from) < HAND_AT_RIM * s;
  for (const std::string& name : names) {
    const bool of_arm = name.starts_with("hand") || name.starts_with("wrist") ||
                        name.starts_with("elbow") || name.starts_with("olecranon");
    if (of_arm) {
      if (hand_is_cut[name.ends_with("_l") ? 0 : 1])
        forget(name);
      continue;
    }
    const bool of_crotch = name.starts_with("hip_joint") || name == "hip_center" ||
                           name == "crotch" || name.starts_with("leg_top");
    const bool of_leg = name.starts_with("knee") || name.starts_with("patella") ||
                        name.starts_with("ankle") || name.starts_with("malleolus") ||
                        name.starts_with("foot") || name.starts_with("heel");
    const bool is_extreme = name == "buttock_back" || name == "abdomen_front" ||
                            name == "hip_section_center"; // at the rim it is the rim
    Landmark& landmark = body.landmarks.at(name);
    if (of_leg || (of_crotch && !has_crotch) || landmark.p.y() < sure ||
        (is_extreme && landmark.p.y() < sure + ABOVE_RIM * s))
      forget(name);
    else if (landmark.rule.find("ratio") != std::string::npos || landmark.rule == "proportion")
      landmark.confidence *= has_crotch ? WITH_CROTCH : WITHOUT_CROTCH;
  }
  if (!seen.has_head)
    forget_head(body, seen.to, forget);
  std::erase_if(body.levels, [&](const auto& level) {
    return level.second.y < sure || level.second.y > seen.to ||
           (level.first == "crotch" && !has_crotch) ||
           (level.first == "hip" && !body.has_landmark("buttock_back")) ||
           (level.first == "hip_girth_max" && level.second.y < sure + ABOVE_RIM * s);
  });
  for (int side = 0; side < 2; ++side)
    if (hand_is_cut[side])
      body.girths.erase(side == 0 ? "wrist_l" : "wrist_r");
  std::erase_if(body.girths, [&](const auto& girth) {
    const std::string& name = girth.first;
    return name.starts_with("knee") || name.starts_with("calf") || name.starts_with("ankle") ||
           (name.starts_with("thigh") && !has_crotch);
  });
  // the legs' skin goes; the rest is open below
  TriangleMesh kept;
  std::vector<Part> part;
  std::vector<int> number(body.skin.positions.size(), -1);
  for (std::size_t f = 0; f < body.skin.triangles.size(); ++f) {
    Triangle t = body.skin.triangles[f];
    const bool of_arm = body.face_part[f] == Part::ARM_L || body.face_part[f] == Part::ARM_R;
    const auto [low, high] =
        std::minmax({body.skin.positions[t[0]].y(), body.skin.positions[t[1]].y(),
                     body.skin.positions[t[2]].y()});
    if (!of_arm && (low < seen.from || high > seen.to))
      continue;
    for (int& v : t) {
      if (number[v] < 0) {
        number[v] = static_cast<int>(kept.positions.size());
        kept.positions.push_back(body.skin.positions[v]);
      }
      v = number[v];
    }
    kept.triangles.push_back(t);
    part.push_back(body.face_part[f]);
  }
  body.skin = std::move(kept);
  body.face_part = std::move(part);
  char text[200];
  const char* how = seen.has_head ? "estimated from the head, to about 4 in 100"
                                  : "put below the shoulders by what is given, to about 1 in 100";
  std::snprintf(text, sizeof text, "torso only: stature %.2f m and floor are %s", s, how);
  body.scan.findings.push_back({"scan.torso-only"_id, "warning", text, "scan"});
  std::string all;
  for (const std::string& name : lost)
    all += (all.empty() ? "" : ", ") + name;
  body.scan.findings.push_back(
      {"scan.parts-absent"_id, "info", "not in this scan: " + all, "legs"});
}

} // namespace sloper::body

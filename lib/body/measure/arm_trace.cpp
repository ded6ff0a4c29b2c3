#include <sloper/body/measure/arm_trace.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::body {

namespace {

// all shares of stature
constexpr double SEED_LEVEL = 0.60; ///< trunk level from which arms are the farthest reach
constexpr double FINGER_END = 0.02,
                 AS_FAR = 0.006; ///< around the point farthest over the skin: of an open hand's
                                 ///< end, not of a fist's knuckles
constexpr double OTHER_FINGER = 0.12; ///< over the skin to another finger's end at most
constexpr double ROUND_CLEFT = 1.8;   ///< of the straight distance
constexpr double STRETCHED =
    0.067; ///< straight to the middle of what is 0.11 to 0.13 away over the skin
constexpr double HAND_SKIP = 0.030; ///< fingers: no single section
constexpr double TRACE_STEP = 0.005;
constexpr double ARM_REACH = 0.46; ///< over the skin from finger tip to beyond the shoulder
constexpr double MAX_ARM_GIRTH = 0.36;
constexpr double JUMP = 1.35;       ///< of the girth, where the section runs into the trunk
constexpr double LEAST_JUMP = 0.05; ///< and by this much at least: from its wrist a stout forearm
                                    ///< swells as fast (one of 48 bodies, by 0.035)
constexpr double MIN_ARM = 0.24;    ///< a shorter trace is no arm
constexpr double MIN_STUMP = 0.13; ///< unless it leads to an arm pit: a stump, cut off or a dummy's
constexpr double MIN_REACH = 0.27; ///< from the waist over the skin to a hand: arms that touch the
                                   ///< trunk from the elbow up lead to it by the shortest way
constexpr double BLUNT = 0.0015;   ///< m

/// Legs below the crotch, flooded from the calves.
std::vector<char> leg_vertices(const LevelStack& levels, const TriangleMesh& skin) {
  const double crotch = *levels.crotch(), s = levels.stature();
  const std::vector<int> piece = [&] {
    std::vector<Triangle> below;
    for (const Triangle& t : skin.triangles)
      if (skin.positions[t[0]].y() < crotch - 0.01 * s &&
          skin.positions[t[1]].y() < crotch - 0.01 * s &&
          skin.positions[t[2]].y() < crotch - 0.01 * s)
        below.push_back(t);
    return connected_components(skin.positions.size(), below);
  }();
  // the pieces that hold the leg loops at knee height
  std::vector<char> is_leg_piece(skin.positions.size(), 0), blocked(skin.positions.size(), 0);
  double seed = 0.2 * s; // lower where thighs and knees touch
  while (seed > 0.06 * s && (levels.at(seed).leg[0] < 0 || levels.at(seed).leg[1] < 0))
    seed -= levels.spacing();
  const Slice& slice = levels.at(seed);
  for (std::size_t v = 0; v < skin.positions.size(); ++v) {
    const Vec3& p = skin.positions[v];
    if (std::abs(p.y() - slice.y) > 0.02 * s)
      continue;
    for (int side = 0; side < 2; ++side)
      if (slice.leg[side] >= 0) {
        const Loop& loop = slice.loops[slice.leg[side]];
        if (p.x() > loop.low.x() - 0.01 * s && p.x() < loop.high.x() + 0.01 * s &&
            p.z() > loop.low.y() - 0.02 * s && p.z() < loop.high.y() + 0.02 * s)
          is_leg_piece[piece[v]] = 1;
      }
  }
  for (std::size_t v = 0; v < skin.positions.size(); ++v)
    blocked[v] = skin.positions[v].y() < crotch - 0.01 * s && is_leg_piece[piece[v]];
  return blocked;
}

/// The level from which reach is measured: at the waist, or, where arms hang on the trunk there,
/// where the trunk alone is cut.
const Slice& free_level(const LevelStack& levels) {
  constexpr double WITH_ARMS = 1.4; // of the trunk's least breadth
  const double s = levels.stature();
  const Slice* usual = &levels.at(SEED_LEVEL * s);
  const Slice* narrowest = usual;
  auto breadth = [](const Slice& slice) {
    return slice.trunk < 0 ? 1e300 : slice.loops[slice.trunk].size().x();
  };
  for (double y = *levels.crotch() + 0.05 * s; y < 0.70 * s; y += levels.spacing())
    if (const Slice& slice = levels.at(y); breadth(slice) < breadth(*narrowest))
      narrowest = &slice;
  return breadth(*usual) > WITH_ARMS * breadth(*narrowest) ? *narrowest : *usual;
}

/// Mean of the vertices between two distances from the tip.
std::optional<Vec3> ring_center(const TriangleMesh& skin, const std::vector<double>& from_tip,
                                double near, double far) {
  Box3 box;
  Vec3 sum = Vec3::Zero();
  int n = 0;
  for (std::size_t v = 0; v < from_tip.size(); ++v)
    if (from_tip[v] >= near && from_tip[v] < far) {
      box.add(skin.positions[v]);
      sum += skin.positions[v];
      ++n;
    }
  if (n == 0)
    return std::nullopt;
  return 0.5 * (sum / n + box.center());
}

/// Of fingers that reach as far over the skin, the one whose end is farthest from the wrist: the
/// middle one; `tip` where there is no other. From a finger's end to another's the skin leads
/// around through the cleft between them. The folded fingers of a fist are left as they are.
int middle_finger(const TriangleMesh& skin, const std::vector<double>& reach,
                  const std::vector<double>& from_tip, int tip, double s) {
  const auto wrist = ring_center(skin, from_tip, 0.11 * s, 0.13 * s);
  if (!wrist || (skin.positions[tip] - *wrist).norm() < STRETCHED * s)
    return tip;
  auto length = [&](int v) {
    return reach[v] + (skin.positions[v] - *wrist).norm();
  }; // over the skin and straight, for each alone may be a tie
  int best = tip;
  for (int v = 0; v < std::ssize(reach); ++v) {
    if (from_tip[v] < FINGER_END * s || from_tip[v] > OTHER_FINGER * s || reach[v] > 1e199 ||
        reach[v] < reach[tip] - AS_FAR * s)
      continue;
    if (from_tip[v] < ROUND_CLEFT * (skin.positions[v] - skin.positions[tip]).norm())
      continue;
    if (length(v) > length(best))
      best = v;
  }
  return best;
}

/// The mean of the three scan points of the hand that are farthest from its wrist: a rebuilt skin
/// rounds the fingers off.
void reach_for_fingers(ArmTrace& arm, const Vec3& wrist, const std::vector<Vec3>& scan_points,
                       double s) {
  const double length = (arm.tip - wrist).norm();
  if (scan_points.empty() || length < 1e-6)
    return;
  const Vec3 axis = (arm.tip - wrist) / length;
  std::vector<std::pair<double, int>> far;
  for (std::size_t i = 0; i < scan_points.size(); ++i) {
    const Vec3 d = scan_points[i] - wrist;
    const double along = d.dot(axis);
    if (along < 0.5 * length || along > length + 0.05 * s || (d - along * axis).norm() > 0.045 * s)
      continue;
    far.emplace_back(d.norm(), static_cast<int>(i));
  }
  if (far.size() < 3)
    return;
  std::partial_sort(far.begin(), far.begin() + 3, far.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first > b.first : a.second < b.second;
  });
  const Vec3 tip =
      (scan_points[far[0].second] + scan_points[far[1].second] + scan_points[far[2].second]) / 3;
  if ((tip - wrist).norm() > length)
    arm.tip = tip;
}

void follow(ArmTrace& arm, const TriangleMesh& skin, const std::vector<double>& reach,
            const std::vector<double>& from_tip, const std::vector<Vec3>& scan_points, double s) {
  const auto start = ring_center(skin, from_tip, (HAND_SKIP - 0.008) * s, (HAND_SKIP + 0.008) * s);
  const auto ahead = ring_center(skin, from_tip, 0.11 * s, 0.13 * s);
  if (!start || !ahead)
    return;
  // of the finger ends, the one farthest along the hand: over the skin a broad hand's corners are
  // as far
  const Vec3 distal = (*start - *ahead).normalized();
  Vec3 tip = arm.tip;
  double farthest = 0;
  for (const int t : arm.triangles)
    for (const int v : skin.triangles[t])
      if (from_tip[v] == 0)
        farthest = reach[v];
  for (const int t : arm.triangles)
    for (const int v : skin.triangles[t])
      if (from_tip[v] < FINGER_END * s && reach[v] > farthest - AS_FAR * s &&
          distal.dot(skin.positions[v] - tip) > 0)
        tip = skin.positions[v];
  Vec3 sum = Vec3::Zero(); // of a blunt end its middle; the knuckles of a fist reach farther than
                           // its finger ends
  double weight = 0;
  bool is_fist = false;
  for (const int t : arm.triangles)
    for (const int v : skin.triangles[t]) {
      const double less = distal.dot(tip - skin.positions[v]);
      if (less > BLUNT || from_tip[v] > 2 * FINGER_END * s)
        continue;
      is_fist |= less < -4 * BLUNT;
      sum += (BLUNT - less) * skin.positions[v];
      weight += BLUNT - less;
    }
  arm.tip = tip;
  if (!is_fist && weight > 0)
    arm.tip = sum / weight + distal.dot(tip - sum / weight) * distal;
  reach_for_fingers(arm, *ahead, scan_points, s);
  Vec3 center = *start, axis = (*ahead - *start).normalized();
  double along = (center - arm.tip).norm();
  TriangleSpheres spheres(skin, arm.triangles);
  for (int step = 0; step < 120; ++step) {
    LimbSection section;
    section.plane = cross_plane(center, axis);
    section.axis = axis;
    std::vector<Loop> loops = cut(skin, section.plane, &spheres.near(section.plane));
    int best = -1;
    double nearest = 0.06 * s;
    for (std::size_t i = 0; i < loops.size(); ++i) {
      if (loops[i].area <= 0)
        continue;
      const double d = encloses(loops[i], Vec2::Zero()) ? 0 : loops[i].centroid.norm();
      if (d < nearest) {
        nearest = d;
        best = static_cast<int>(i);
      }
    }
    if (best < 0)
      break;
    section.loop = std::move(loops[best]);
    section.girth = taut_girth(section.loop);
    section.center = section.plane.point(section.loop.centroid);
    if (section.girth > MAX_ARM_GIRTH * s || !section.loop.closed)
      break;
    const std::size_t n = arm.sections.size();
    if (n > 24) { // the girth of the last few centimetres
      double usual = 0;
      for (std::size_t k = n - 8; k < n - 2; ++k)
        usual += arm.sections[k].girth / 6;
      if (section.girth > std::max(JUMP * usual, usual + LEAST_JUMP * s) ||
          section.girth < 0.6 * usual)
        break;
    }
    // centres wander in the hand: there the straight distance from the tip is the better measure
    const double straight = (section.center - arm.tip).norm();
    along = n == 0 || straight < 0.10 * s
                ? straight
                : along + (section.center - arm.sections.back().center).norm();
    section.along = along;
    arm.sections.push_back(std::move(section));
    if (n >= 8) {
      const Vec3 chord = arm.sections.back().center - arm.sections[n - 8].center;
      if (chord.norm() > 1e-6)
        axis = (0.5 * axis + 0.5 * chord.normalized()).normalized();
    }
    center = arm.sections.back().center + TRACE_STEP * s * axis;
  }
  // the last sections lean into the shoulder
  while (arm.sections.size() > 30 &&
         arm.sections.back().girth > 1.12 * arm.sections[arm.sections.size() - 5].girth)
    arm.sections.pop_back();
}

/// What was found of an arm that is none.
void forget(ArmTrace& arm) {
  arm.sections.clear();
  arm.axilla = arm.axilla_front = arm.axilla_back = std::nullopt;
  arm.is_stump = arm.pit_hidden = arm.pit_low = false;
}

} // namespace

Vec3 ArmTrace::at(double along) const {
  if (sections.empty())
    return tip;
  if (along <= sections.front().along)
    return sections.front().center + (along - sections.front().along) * sections.front().axis;
  if (along >= sections.back().along) {
    const Vec3 chord = sections.size() > 24
                           ? Vec3(sections.back().center - sections[sections.size() - 24].center)
                           : sections.back().axis;
    return sections.back().center + (along - sections.back().along) * chord.normalized();
  }
  const auto next = std::lower_bound(sections.begin(), sections.end(), along,
                                     [](const LimbSection& a, double x) { return a.along < x; });
  const auto& b = *next;
  const auto& a = *(next - 1);
  const double w = b.along > a.along ? (along - a.along) / (b.along - a.along) : 0;
  return a.center + w * (b.center - a.center);
}

std::array<ArmTrace, 2> trace_arms(const LevelStack& levels, const EdgeGraph& graph,
                                   const std::vector<Vec3>& scan_points, const Rules& rules) {
  std::array<ArmTrace, 2> arms;
  arms[1].left = false;
  if (!levels.crotch())
    return arms;
  const TriangleMesh& skin = levels.skin();
  const double s = levels.stature();
  const std::vector<char> legs = leg_vertices(levels, skin);
  const Slice& seed = free_level(levels);
  if (seed.trunk < 0)
    return arms;
  const Loop& trunk = seed.loops[seed.trunk];
  auto is_in = [](const Loop& loop, const Vec3& p, double margin) {
    return p.x() > loop.low.x() - margin && p.x() < loop.high.x() + margin &&
           p.z() > loop.low.y() - margin && p.z() < loop.high.y() + margin;
  };
  auto is_of_arm = [&](const Vec3& p) { // one that hangs close to the trunk
    for (std::size_t i = 0; i < seed.loops.size(); ++i)
      if (static_cast<int>(i) != seed.trunk && seed.loops[i].area > 0 &&
          is_in(seed.loops[i], p, 0.003 * s))
        return !is_in(trunk, p, 0.003 * s);
    return false;
  };
  std::vector<int> sources;
  for (std::size_t v = 0; v < skin.positions.size(); ++v) {
    const Vec3& p = skin.positions[v];
    if (std::abs(p.y() - seed.y) < 0.015 * s && is_in(trunk, p, 0.01 * s) && !is_of_arm(p))
      sources.push_back(static_cast<int>(v));
  }
  const std::vector<double> reach = graph.distances(sources, 1e200, legs);
  for (ArmTrace& arm : arms) {
    int tip = -1;
    for (std::size_t v = 0; v < reach.size(); ++v) {
      const Vec3& p = skin.positions[v];
      if (reach[v] > 1e199 || (p.x() > 0) != arm.left || p.y() > 0.93 * s ||
          std::abs(p.x()) < 0.06 * s)
        continue;
      if (tip < 0 || reach[v] > reach[tip])
        tip = static_cast<int>(v);
    }
    if (tip < 0 || reach[tip] < MIN_REACH * s)
      continue;
    arm.tip = skin.positions[tip];
    std::vector<double> from_tip = graph.distances({tip}, ARM_REACH * s, legs);
    if (const int other = middle_finger(skin, reach, from_tip, tip, s); other != tip) {
      arm.tip = skin.positions[other];
      from_tip = graph.distances({other}, ARM_REACH * s, legs);
    }
    for (std::size_t f = 0; f < skin.triangles.size(); ++f) {
      const Triangle& t = skin.triangles[f];
      if (from_tip[t[0]] < 1e199 && from_tip[t[1]] < 1e199 && from_tip[t[2]] < 1e199)
        arm.triangles.push_back(static_cast<int>(f));
    }
    follow(arm, skin, reach, from_tip, scan_points, s);
    if (arm.sections.empty() || arm.length() < MIN_STUMP * s) {
      arm.sections.clear();
      continue;
    }
    arm.is_stump = arm.length() < MIN_ARM * s;
    const double end = arm.length();
    arm.out = (arm.at(end - 0.12 * s) - arm.at(end)).normalized();
    find_axilla(arm, levels, rules);
    if (arm.is_stump && (arm.pit_hidden || arm.pit_low)) { // a forearm on the trunk, or a shoulder
      forget(arm);
      continue;
    }
    if (!arm.pit_hidden)
      find_merge(arm, levels);
    arm.from_tip = std::move(from_tip);
  }
  compare_pits(arms, rules, s);
  return arms;
}

} // namespace sloper::body

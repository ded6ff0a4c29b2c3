#include <body/arm_trace.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::body {

namespace {

// all shares of stature
constexpr double SEED_LEVEL = 0.60;                 ///< trunk level from which arms are the farthest reach
constexpr double FINGER_END = 0.02, AS_FAR = 0.006; ///< around the point farthest over the skin: of an open hand's end, not of a fist's knuckles
constexpr double HAND_SKIP = 0.030;                 ///< fingers: no single section
constexpr double STEP = 0.005;
constexpr double ARM_REACH = 0.46; ///< over the skin from finger tip to beyond the shoulder
constexpr double MAX_ARM_GIRTH = 0.36;
constexpr double JUMP = 1.35;      ///< of the girth, where the section runs into the trunk
constexpr double MIN_ARM = 0.24;   ///< a shorter trace is no arm
constexpr double MIN_REACH = 0.27; ///< from the waist over the skin to a hand: arms that touch the trunk from the elbow up lead to it by the shortest way
constexpr double BLUNT = 0.0015;   ///< m
constexpr double POCKET = 0.001;   ///< what is thinner is no limb: where faces were dropped and closed again, skin has pockets
constexpr double AS_NEAR = 0.0003; ///< m
constexpr double TRUNK_LEAN = 0.5; ///< of the bisector between arm and trunk
constexpr double LEAP = 0.008;     ///< the arm's underside bends away by more than this: no longer the pit
constexpr double ROOF = 0.005;     ///< half breadth of the pit's roof at most

/// Legs below the crotch, flooded from the calves.
std::vector<char> leg_vertices(const LevelStack& levels, const TriangleMesh& skin) {
  const double crotch = *levels.crotch(), s = levels.stature();
  const std::vector<int> piece = [&] {
    std::vector<Triangle> below;
    for (const Triangle& t : skin.triangles)
      if (skin.positions[t[0]].y() < crotch - 0.01 * s && skin.positions[t[1]].y() < crotch - 0.01 * s && skin.positions[t[2]].y() < crotch - 0.01 * s)
        below.push_back(t);
    return connected_components(skin.positions.size(), below);
  }();
  // the pieces that hold the leg loops at knee height
  std::vector<char> is_leg_piece(skin.positions.size(), 0), blocked(skin.positions.size(), 0);
  double seed = 0.2 * s; // lower where thighs and knees touch
  while (seed > 0.06 * s && (levels.at(seed).leg[0] < 0 || levels.at(seed).leg[1] < 0)) seed -= levels.spacing();
  const Slice& slice = levels.at(seed);
  for (std::size_t v = 0; v < skin.positions.size(); ++v) {
    const Vec3& p = skin.positions[v];
    if (std::abs(p.y() - slice.y) > 0.02 * s) continue;
    for (int side = 0; side < 2; ++side)
      if (slice.leg[side] >= 0) {
        const Loop& loop = slice.loops[slice.leg[side]];
        if (p.x() > loop.low.x() - 0.01 * s && p.x() < loop.high.x() + 0.01 * s && p.z() > loop.low.y() - 0.02 * s && p.z() < loop.high.y() + 0.02 * s)
          is_leg_piece[piece[v]] = 1;
      }
  }
  for (std::size_t v = 0; v < skin.positions.size(); ++v) blocked[v] = skin.positions[v].y() < crotch - 0.01 * s && is_leg_piece[piece[v]];
  return blocked;
}

/// The level from which reach is measured: at the waist, or, where arms hang on the trunk there, where the trunk alone is cut.
const Slice& free_level(const LevelStack& levels) {
  constexpr double WITH_ARMS = 1.4; // of the trunk's least breadth
  const double s = levels.stature();
  const Slice* usual = &levels.at(SEED_LEVEL * s);
  const Slice* narrowest = usual;
  auto breadth = [](const Slice& slice) { return slice.trunk < 0 ? 1e300 : slice.loops[slice.trunk].size().x(); };
  for (double y = *levels.crotch() + 0.05 * s; y < 0.70 * s; y += levels.spacing())
    if (const Slice& slice = levels.at(y); breadth(slice) < breadth(*narrowest)) narrowest = &slice;
  return breadth(*usual) > WITH_ARMS * breadth(*narrowest) ? *narrowest : *usual;
}

/// Mean of the vertices between two distances from the tip.
std::optional<Vec3> ring_center(const TriangleMesh& skin, const std::vector<double>& from_tip, double near, double far) {
  Box3 box;
  Vec3 sum = Vec3::Zero();
  int n = 0;
  for (std::size_t v = 0; v < from_tip.size(); ++v)
    if (from_tip[v] >= near && from_tip[v] < far) {
      box.add(skin.positions[v]);
      sum += skin.positions[v];
      ++n;
    }
  if (n == 0) return std::nullopt;
  return 0.5 * (sum / n + box.center());
}

/// The mean of the three scan points of the hand that are farthest from its wrist: a rebuilt skin rounds the fingers off.
void reach_for_fingers(ArmTrace& arm, const Vec3& wrist, const std::vector<Vec3>& scan_points, double s) {
  const double length = (arm.tip - wrist).norm();
  if (scan_points.empty() || length < 1e-6) return;
  const Vec3 axis = (arm.tip - wrist) / length;
  std::vector<std::pair<double, int>> far;
  for (std::size_t i = 0; i < scan_points.size(); ++i) {
    const Vec3 d = scan_points[i] - wrist;
    const double along = d.dot(axis);
    if (along < 0.5 * length || along > length + 0.05 * s || (d - along * axis).norm() > 0.045 * s) continue;
    far.emplace_back(d.norm(), static_cast<int>(i));
  }
  if (far.size() < 3) return;
  std::partial_sort(far.begin(), far.begin() + 3, far.end(),
                    [](const auto& a, const auto& b) { return a.first != b.first ? a.first > b.first : a.second < b.second; });
  const Vec3 tip = (scan_points[far[0].second] + scan_points[far[1].second] + scan_points[far[2].second]) / 3;
  if ((tip - wrist).norm() > length) arm.tip = tip;
}

void follow(ArmTrace& arm, const TriangleMesh& skin, const std::vector<double>& reach, const std::vector<double>& from_tip,
            const std::vector<Vec3>& scan_points, double s) {
  const auto start = ring_center(skin, from_tip, (HAND_SKIP - 0.008) * s, (HAND_SKIP + 0.008) * s);
  const auto ahead = ring_center(skin, from_tip, 0.11 * s, 0.13 * s);
  if (!start || !ahead) return;
  // of the finger ends, the one farthest along the hand: over the skin a broad hand's corners are as far
  const Vec3 distal = (*start - *ahead).normalized();
  Vec3 tip = arm.tip;
  double farthest = 0;
  for (const int t : arm.triangles)
    for (const int v : skin.triangles[t])
      if (from_tip[v] == 0) farthest = reach[v];
  for (const int t : arm.triangles)
    for (const int v : skin.triangles[t])
      if (from_tip[v] < FINGER_END * s && reach[v] > farthest - AS_FAR * s && distal.dot(skin.positions[v] - tip) > 0) tip = skin.positions[v];
  Vec3 sum = Vec3::Zero(); // of a blunt end its middle; the knuckles of a fist reach farther than its finger ends
  double weight = 0;
  bool is_fist = false;
  for (const int t : arm.triangles)
    for (const int v : skin.triangles[t]) {
      const double less = distal.dot(tip - skin.positions[v]);
      if (less > BLUNT || from_tip[v] > 2 * FINGER_END * s) continue;
      is_fist |= less < -4 * BLUNT;
      sum += (BLUNT - less) * skin.positions[v], weight += BLUNT - less;
    }
  arm.tip = tip;
  if (!is_fist && weight > 0) arm.tip = sum / weight + distal.dot(tip - sum / weight) * distal;
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
      if (loops[i].area <= 0) continue;
      const double d = encloses(loops[i], Vec2::Zero()) ? 0 : loops[i].centroid.norm();
      if (d < nearest) nearest = d, best = static_cast<int>(i);
    }
    if (best < 0) break;
    section.loop = std::move(loops[best]);
    section.girth = taut_girth(section.loop);
    section.center = section.plane.point(section.loop.centroid);
    if (section.girth > MAX_ARM_GIRTH * s || !section.loop.closed) break;
    const std::size_t n = arm.sections.size();
    if (n > 24) { // the girth of the last few centimetres
      double usual = 0;
      for (std::size_t k = n - 8; k < n - 2; ++k) usual += arm.sections[k].girth / 6;
      if (section.girth > JUMP * usual || section.girth < 0.6 * usual) break;
    }
    // centres wander in the hand: there the straight distance from the tip is the better measure
    const double straight = (section.center - arm.tip).norm();
    along = n == 0 || straight < 0.10 * s ? straight : along + (section.center - arm.sections.back().center).norm();
    section.along = along;
    arm.sections.push_back(std::move(section));
    if (n >= 8) {
      const Vec3 chord = arm.sections.back().center - arm.sections[n - 8].center;
      if (chord.norm() > 1e-6) axis = (0.5 * axis + 0.5 * chord.normalized()).normalized();
    }
    center = arm.sections.back().center + STEP * s * axis;
  }
  // the last sections lean into the shoulder
  while (arm.sections.size() > 30 && arm.sections.back().girth > 1.12 * arm.sections[arm.sections.size() - 5].girth) arm.sections.pop_back();
}

/// Crossings of the line q + t e with the outline, sorted.
std::vector<double> crossings(const std::vector<Loop>& loops, const Vec2& q, const Vec2& e) {
  const Vec2 normal(-e.y(), e.x());
  std::vector<double> at;
  for (const Loop& loop : loops)
    for (const auto& segment : loop.segments) {
      const double a = normal.dot(segment[0] - q), b = normal.dot(segment[1] - q);
      if ((a >= 0) == (b >= 0)) continue;
      const Vec2 p = segment[0] + a / (a - b) * (segment[1] - segment[0]);
      at.push_back(e.dot(p - q));
    }
  std::sort(at.begin(), at.end());
  return at;
}

/// Apex of the gap between arm and trunk in the plane z = depth: walks along the arm towards the shoulder and watches the
/// gap close. Lines are square to the bisector of arm and hanging direction.
std::optional<Vec2> gap_apex(const std::vector<Loop>& loops, const ArmTrace& arm, double s) {
  Vec2 out(arm.out.x(), arm.out.y());
  if (out.norm() < 0.2) return std::nullopt;
  out.normalize();
  // leaning to the trunk: in a level arm the fold is a wide fillet, and the pit is on its trunk side
  const Vec2 bisector = ((out + Vec2(0, -1)).normalized() + Vec2(arm.left ? TRUNK_LEAN : -TRUNK_LEAN, 0)).normalized();
  Vec2 e(-bisector.y(), bisector.x()); // square to the bisector, from the arm to the trunk
  if (e.dot(Vec2(arm.left ? -1 : 1, -1)) < 0) e = -e;
  std::optional<Vec2> apex;
  double last_leave = 0, last_enter = 0;
  const double end = arm.length();
  for (double along = end - 0.09 * s; along < end + 0.08 * s; along += 0.001 * s) {
    const Vec3 c = arm.at(along);
    const Vec2 q(c.x(), c.y());
    std::vector<double> t = crossings(loops, q, e);
    for (std::size_t k = 0; k + 1 < t.size();) // body between an odd and the next crossing
      if (t[k + 1] - t[k] < POCKET * s) t.erase(t.begin() + static_cast<std::ptrdiff_t>(k), t.begin() + static_cast<std::ptrdiff_t>(k) + 2);
      else k += 2;
    const auto first = std::upper_bound(t.begin(), t.end(), 0.0);
    if (first == t.end() || (first - t.begin()) % 2 == 0) continue; // not inside the arm in this plane
    const double leave = *first;
    if (first + 1 == t.end() || leave > (apex ? 0.2 : 0.12) * s) {
      if (apex) break;
      continue;
    }
    const double enter = *(first + 1);
    // another gap than that of the last line, or a fold of the trunk's side below the pit
    if (apex && (leave > last_enter || enter < last_leave || leave > last_leave + LEAP * s)) break;
    last_leave = leave, last_enter = enter;
    // a gap that ends while it is wide has its roof on the arm's side: below it the trunk falls away
    apex = q + (leave + std::min(0.5 * (enter - leave), ROOF * s)) * e;
    if (enter - leave < 0.0008 * s) break;
  }
  return apex;
}

void find_axilla(ArmTrace& arm, const LevelStack& levels, const Rules& rules) {
  const double s = levels.stature();
  if (arm.sections.empty()) return;
  const TriangleMesh& skin = levels.skin();
  std::vector<int> near;
  const double sign = arm.left ? 1 : -1;
  for (std::size_t f = 0; f < skin.triangles.size(); ++f) {
    const Vec3& p = skin.positions[skin.triangles[f][0]];
    if (sign * p.x() > 0.02 * s && p.y() > 0.5 * s && p.y() < 0.9 * s) near.push_back(static_cast<int>(f));
  }
  // around the arm the fold between arm and trunk rises to both sides: its roof lies under the joint, its ends in front
  // of and behind the arm, at distances that go with the arm's radius
  const double radius = arm.sections[arm.sections.size() * 3 / 4].girth / (2 * 3.14159265358979);
  const double depth = arm.at(arm.length() + 0.01 * s).z() + 0.009 * s;
  auto apex_at = [&](double z) {
    const std::vector<Loop> loops = cut(skin, {Vec3(0, 0, z), Vec3::UnitX(), Vec3::UnitY()}, &near);
    return gap_apex(loops, arm, s);
  };
  arm.axilla = std::nullopt;
  std::vector<double> xs, ys; // the middle of three planes, for a single one may run along a fold
  for (const double offset : {0.0, -0.15, 0.15, -0.4, 0.4}) {
    if (xs.size() == 3 || (!xs.empty() && std::abs(offset) > 0.3)) break;
    if (const auto apex = apex_at(depth + offset * radius)) xs.push_back(apex->x()), ys.push_back(apex->y());
  }
  if (!xs.empty()) {
    std::sort(xs.begin(), xs.end());
    std::sort(ys.begin(), ys.end());
    const std::size_t n = xs.size();
    auto middle = [&](const std::vector<double>& v) { return n == 3 && v[2] - v[0] < 0.01 * s ? (v[0] + v[1] + v[2]) / 3 : v[n / 2]; };
    arm.axilla = Vec3(middle(xs), middle(ys), depth);
  }
  // arm and trunk touch, a hole was closed there, or a sleeve spans the pit
  const double aside = rules.number("axilla.aside") * s, height = rules.number("axilla.height") * s;
  arm.pit_hidden = !arm.axilla || arm.axilla->y() < rules.number("axilla.lowest") * s || std::abs(arm.axilla->x()) > rules.number("axilla.widest") * s;
  if (arm.pit_hidden) {
    const bool is_near = arm.axilla && std::abs(arm.axilla->x()) <= rules.number("axilla.widest") * s;
    arm.axilla = Vec3(sign * (is_near ? 0.5 * (std::abs(arm.axilla->x()) + aside) : aside), height, depth);
  }
  arm.axilla_front = *arm.axilla + Vec3(-sign * 0.0021 * s, 0.22 * radius, 0.75 * radius);
  arm.axilla_back = *arm.axilla + Vec3(-sign * 0.0035 * s, 0.16 * radius, -1.2 * radius);
}

/// Going up, the level at which the loops of a hanging arm and of the trunk become one, by bisection to 0.02 mm: front and
/// back fold often meet within a tenth of a millimetre of each other.
void find_merge(ArmTrace& arm, const LevelStack& levels) {
  const double s = levels.stature();
  double reach = 0.01 * s, from = 0; // sections this near the level, this far from the hand
  bool is_level = false;
  auto loops_at = [&](double y, int& trunk, int& limb) {
    std::vector<Loop> loops = levels.exact(y);
    trunk = limb = -1;
    double nearest = 0.03 * s;
    for (std::size_t i = 0; i < loops.size(); ++i) {
      if (loops[i].area <= 0) continue;
      const bool is_trunk = trunk < 0 && std::abs(loops[i].centroid.x()) < 0.06 * s; // the largest near the middle
      if (is_trunk) trunk = static_cast<int>(i);
      if (is_trunk && is_level) continue; // it reaches below the arm's middle even while the arm's underside is a loop of its own
      double d = 1e300;
      for (const LimbSection& section : arm.sections) {
        if (std::abs(section.center.y() - y) > reach || section.along < from) continue;
        const Vec2 c(section.center.x(), section.center.z());
        d = std::min(d, encloses(loops[i], c) ? 0.0 : (c - loops[i].centroid).norm());
      }
      if (d < nearest) nearest = d, limb = static_cast<int>(i);
    }
    return loops;
  };
  auto apart = [&](double y) {
    int trunk, limb;
    loops_at(y, trunk, limb);
    return trunk >= 0 && limb >= 0 && trunk != limb;
  };
  double low = 0, high = 0;
  auto search = [&](double top, double bottom, double step) {
    low = high = 0;
    for (double y = top; y > bottom && low == 0; y -= step) (apart(y) ? low : high) = y;
  };
  if (arm.out.y() < -0.12) search(0.80 * s, 0.62 * s, 0.005 * s);
  if (low == 0 || high == 0) { // a level through a level arm's underside is further from its middle, and the hand may hang
    reach = 0.035 * s, from = 0.6 * arm.length(), is_level = true;
    const double middle = arm.at(0.85 * arm.length()).y();
    search(middle, middle - 0.05 * s, 0.0006 * s);
  }
  if (low == 0 || high == 0) return; // a level arm may never stand apart in level sections
  while (high - low > 2e-5) {
    const double y = 0.5 * (low + high);
    (apart(y) ? low : high) = y;
  }
  int trunk, limb;
  const std::vector<Loop> loops = loops_at(low, trunk, limb);
  if (trunk < 0 || limb < 0) return;
  // both folds of the pit may come as near: of places as near as makes no difference the middle
  struct Near {
    Vec2 middle;
    double gap, length;
  };
  std::vector<Near> all;
  double least = 1e300;
  for (const auto& a : loops[trunk].segments)
    for (const double t : {0.1, 0.3, 0.5, 0.7, 0.9}) {
      const Vec2 p = (1 - t) * a[0] + t * a[1];
      Near near{p, 1e300, (a[1] - a[0]).norm()};
      for (const auto& b : loops[limb].segments) {
        const Vec2 along = b[1] - b[0];
        const Vec2 q = b[0] + std::clamp((p - b[0]).dot(along) / std::max(along.squaredNorm(), 1e-20), 0.0, 1.0) * along;
        if (const double gap = (p - q).norm(); gap < near.gap) near.gap = gap, near.middle = 0.5 * (p + q);
      }
      least = std::min(least, near.gap);
      all.push_back(near);
    }
  Vec2 sum = Vec2::Zero();
  double weight = 0;
  for (const Near& near : all)
    if (const double w = (least + AS_NEAR - near.gap) * near.length; w > 0) sum += w * near.middle, weight += w;
  if (weight > 0) arm.merge = Vec3(sum.x() / weight, low, sum.y() / weight);
}

} // namespace

Vec3 ArmTrace::at(double along) const {
  if (sections.empty()) return tip;
  if (along <= sections.front().along) return sections.front().center + (along - sections.front().along) * sections.front().axis;
  if (along >= sections.back().along) {
    const Vec3 chord = sections.size() > 24 ? Vec3(sections.back().center - sections[sections.size() - 24].center) : sections.back().axis;
    return sections.back().center + (along - sections.back().along) * chord.normalized();
  }
  const auto next = std::lower_bound(sections.begin(), sections.end(), along, [](const LimbSection& a, double x) { return a.along < x; });
  const auto& b = *next;
  const auto& a = *(next - 1);
  const double w = b.along > a.along ? (along - a.along) / (b.along - a.along) : 0;
  return a.center + w * (b.center - a.center);
}

std::array<ArmTrace, 2> trace_arms(const LevelStack& levels, const EdgeGraph& graph, const std::vector<Vec3>& scan_points, const Rules& rules) {
  std::array<ArmTrace, 2> arms;
  arms[1].left = false;
  if (!levels.crotch()) return arms;
  const TriangleMesh& skin = levels.skin();
  const double s = levels.stature();
  const std::vector<char> legs = leg_vertices(levels, skin);
  const Slice& seed = free_level(levels);
  if (seed.trunk < 0) return arms;
  const Loop& trunk = seed.loops[seed.trunk];
  auto is_in = [](const Loop& loop, const Vec3& p, double margin) {
    return p.x() > loop.low.x() - margin && p.x() < loop.high.x() + margin && p.z() > loop.low.y() - margin && p.z() < loop.high.y() + margin;
  };
  auto is_of_arm = [&](const Vec3& p) { // one that hangs close to the trunk
    for (std::size_t i = 0; i < seed.loops.size(); ++i)
      if (static_cast<int>(i) != seed.trunk && seed.loops[i].area > 0 && is_in(seed.loops[i], p, 0.003 * s)) return !is_in(trunk, p, 0.003 * s);
    return false;
  };
  std::vector<int> sources;
  for (std::size_t v = 0; v < skin.positions.size(); ++v) {
    const Vec3& p = skin.positions[v];
    if (std::abs(p.y() - seed.y) < 0.015 * s && is_in(trunk, p, 0.01 * s) && !is_of_arm(p)) sources.push_back(static_cast<int>(v));
  }
  const std::vector<double> reach = graph.distances(sources, 1e200, legs);
  for (ArmTrace& arm : arms) {
    int tip = -1;
    for (std::size_t v = 0; v < reach.size(); ++v) {
      const Vec3& p = skin.positions[v];
      if (reach[v] > 1e199 || (p.x() > 0) != arm.left || p.y() > 0.93 * s || std::abs(p.x()) < 0.06 * s) continue;
      if (tip < 0 || reach[v] > reach[tip]) tip = static_cast<int>(v);
    }
    if (tip < 0 || reach[tip] < MIN_REACH * s) continue;
    arm.tip = skin.positions[tip];
    const std::vector<double> from_tip = graph.distances({tip}, ARM_REACH * s, legs);
    for (std::size_t f = 0; f < skin.triangles.size(); ++f) {
      const Triangle& t = skin.triangles[f];
      if (from_tip[t[0]] < 1e199 && from_tip[t[1]] < 1e199 && from_tip[t[2]] < 1e199) arm.triangles.push_back(static_cast<int>(f));
    }
    follow(arm, skin, reach, from_tip, scan_points, s);
    if (arm.sections.empty() || arm.length() < MIN_ARM * s) {
      arm.sections.clear();
      continue;
    }
    const double end = arm.length();
    arm.out = (arm.at(end - 0.12 * s) - arm.at(end)).normalized();
    find_axilla(arm, levels, rules);
    if (!arm.pit_hidden) find_merge(arm, levels);
  }
  return arms;
}

} // namespace sloper::body

#include <sloper/base/units.hpp>
#include <sloper/body/measure/arm_trace.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::body {

namespace {

// shares of stature, unless said otherwise
constexpr double POCKET = 0.001;   ///< what is thinner is no limb: where faces were dropped and
                                   ///< closed again, skin has pockets
constexpr double AS_NEAR = 0.0003; ///< m
constexpr double TRUNK_LEAN = 0.5; ///< of the bisector between arm and trunk
constexpr double LEAP =
    0.008; ///< the skin bends away from the arm by more than this between two lines
constexpr double FROM_PIT = 0.06; ///< aside: a level arm's underside meets the trunk's level
                                  ///< anywhere along it, and what lies farther off is no arm pit
constexpr double TOUCHES_BELOW =
    0.015;                     ///< of 64 fresh bodies three had a pit as much below the lowest
constexpr double ROOF = 0.005; ///< half breadth of the pit's roof at most
/// Lines, a thousandth of the stature apart: a gap that ends sooner is a fold of the arm beside the
/// way. It took the arm pits of one body of 704.
constexpr int LEAST_LINES = 6;

/// Crossings of the line q + t e with the outline, sorted.
std::vector<double> crossings(const std::vector<Loop>& loops, const Vec2& q, const Vec2& e) {
  const Vec2 normal(-e.y(), e.x());
  std::vector<double> at;
  for (const Loop& loop : loops)
    for (const auto& segment : loop.segments) {
      const double a = normal.dot(segment[0] - q), b = normal.dot(segment[1] - q);
      if ((a >= 0) == (b >= 0))
        continue;
      const Vec2 p = segment[0] + a / (a - b) * (segment[1] - segment[0]);
      at.push_back(e.dot(p - q));
    }
  std::sort(at.begin(), at.end());
  return at;
}

/// Apex of the gap between arm and trunk in the plane z = depth: walks along the arm towards the
/// shoulder and watches the gap close. Lines are square to the bisector of arm and hanging
/// direction. Where the skin between arm and trunk runs along the lines, or bends away to a fold of
/// the trunk's side, the pit is at most as far below the arm's axis as pits usually are.
/// @param usual distance of the pit from the arm's axis, m
std::optional<Vec2> gap_apex(const std::vector<Loop>& loops, const ArmTrace& arm, double s,
                             double usual) {
  Vec2 out(arm.out.x(), arm.out.y());
  if (out.norm() < 0.2)
    return std::nullopt;
  out.normalize();
  // leaning to the trunk: in a level arm the fold is a wide fillet, and the pit is on its trunk
  // side
  const Vec2 bisector =
      ((out + Vec2(0, -1)).normalized() + Vec2(arm.left ? TRUNK_LEAN : -TRUNK_LEAN, 0))
          .normalized();
  Vec2 e(-bisector.y(), bisector.x()); // square to the bisector, from the arm to the trunk
  if (e.dot(Vec2(arm.left ? -1 : 1, -1)) < 0)
    e = -e;
  const double leave_usual = usual / std::abs(e.x() * out.y() - e.y() * out.x());
  Vec2 apex = Vec2::Zero();
  double last_leave = 0, last_enter = 0;
  int lines = 0; // on which the gap was met
  const double end = arm.length();
  for (double along = end - 0.09 * s; along < end + 0.08 * s; along += 0.001 * s) {
    const Vec3 c = arm.at(along);
    const Vec2 q(c.x(), c.y());
    std::vector<double> t = crossings(loops, q, e);
    for (std::size_t k = 0; k + 1 < t.size();) // body between an odd and the next crossing
      if (t[k + 1] - t[k] < POCKET * s)
        t.erase(t.begin() + static_cast<std::ptrdiff_t>(k),
                t.begin() + static_cast<std::ptrdiff_t>(k) + 2);
      else
        k += 2;
    const auto first = std::upper_bound(t.begin(), t.end(), 0.0);
    if (first == t.end() || (first - t.begin()) % 2 == 0)
      continue; // not inside the arm in this plane
    const double leave = *first;
    if (first + 1 == t.end() || leave > (lines > 0 ? 0.2 : 0.12) * s) {
      if (lines > 0)
        break;
      continue;
    }
    const double enter = *(first + 1);
    // another gap than that of the last line, or a fold of the trunk's side below the pit
    if (lines > 0 && (leave > last_enter || enter < last_leave)) {
      if (lines >= LEAST_LINES)
        break;
      lines = 0;
    }
    // a gap that ends while it is wide has its roof on the arm's side: below it the trunk falls
    // away
    const Vec2 next = q + (leave + std::min(0.5 * (enter - leave), ROOF * s)) * e;
    if (lines > 0 && leave > last_leave + LEAP * s && leave > leave_usual) {
      apex +=
          std::clamp((leave_usual - last_leave) / (leave - last_leave), 0.0, 1.0) * (next - apex);
      break;
    }
    last_leave = leave;
    last_enter = enter;
    apex = next;
    ++lines;
    if (enter - leave < 0.0008 * s) {
      if (lines >= LEAST_LINES)
        break;
      lines = 0;
    }
  }
  return lines > 0 ? std::optional(apex) : std::nullopt;
}

} // namespace

void find_axilla(ArmTrace& arm, const LevelStack& levels, const Rules& rules) {
  const double s = levels.stature();
  if (arm.sections.empty())
    return;
  const TriangleMesh& skin = levels.skin();
  std::vector<int> near;
  const double sign = arm.left ? 1 : -1;
  for (std::size_t f = 0; f < skin.triangles.size(); ++f) {
    const Vec3& p = skin.positions[skin.triangles[f][0]];
    if (sign * p.x() > 0.02 * s && p.y() > 0.5 * s && p.y() < 0.9 * s)
      near.push_back(static_cast<int>(f));
  }
  // around the arm the fold between arm and trunk rises to both sides: its roof lies under the
  // joint, its ends in front of and behind the arm, at distances that go with the arm's radius
  const double radius = arm.sections[arm.sections.size() * 3 / 4].girth / (2 * 3.14159265358979);
  const double depth = arm.at(arm.length() + 0.01 * s).z() + 0.009 * s;
  const double raised =
      units::degrees(std::acos(std::clamp(-arm.out.y(), -1.0, 1.0))); // 0 hanging, 90 level
  const double usual = (rules.number("axilla.below_level_arm") -
                        rules.number("axilla.below_arm_per_degree") * (90 - raised)) *
                           s +
                       rules.number("axilla.below_arm_of_radius") * radius;
  auto apex_at = [&](double z) {
    const std::vector<Loop> loops = cut(skin, {Vec3(0, 0, z), Vec3::UnitX(), Vec3::UnitY()}, &near);
    return gap_apex(loops, arm, s, usual);
  };
  arm.axilla = std::nullopt;
  std::vector<double> xs, ys; // the middle of three planes, for a single one may run along a fold
  for (const double offset : {0.0, -0.15, 0.15, -0.4, 0.4}) {
    if (xs.size() == 3 || (!xs.empty() && std::abs(offset) > 0.3))
      break;
    if (const auto apex = apex_at(depth + offset * radius)) {
      xs.push_back(apex->x());
      ys.push_back(apex->y());
    }
  }
  if (!xs.empty()) {
    std::sort(xs.begin(), xs.end());
    std::sort(ys.begin(), ys.end());
    const std::size_t n = xs.size();
    auto middle = [&](const std::vector<double>& v) { // the mean, without what is far off, and
                                                      // nothing jumps where it is a little nearer
      if (n < 3)
        return v[n / 2];
      const auto share = [&](double x) {
        return std::clamp(1.5 - std::abs(x - v[1]) / (0.01 * s), 0.0, 1.0);
      };
      return (v[1] + share(v[0]) * v[0] + share(v[2]) * v[2]) / (1 + share(v[0]) + share(v[2]));
    };
    arm.axilla = Vec3(middle(xs), middle(ys), depth);
  }
  // arm and trunk touch, a hole was closed there, or a sleeve spans the pit
  const double aside = rules.number("axilla.aside") * s, height = rules.number("axilla.height") * s;
  // a little lower than any pit, skin touches below it, and the other arm tells how much, if it can
  const double lowest = rules.number("axilla.lowest") * s;
  arm.pit_low = arm.axilla && arm.axilla->y() < lowest;
  arm.pit_hidden = !arm.axilla || arm.axilla->y() < lowest - TOUCHES_BELOW * s ||
                   std::abs(arm.axilla->x()) > rules.number("axilla.widest") * s;
  if (arm.pit_hidden) {
    const bool is_near =
        arm.axilla && std::abs(arm.axilla->x()) <= rules.number("axilla.widest") * s;
    arm.axilla =
        Vec3(sign * (is_near ? 0.5 * (std::abs(arm.axilla->x()) + aside) : aside), height, depth);
  }
  arm.axilla_front = *arm.axilla + Vec3(-sign * 0.0021 * s, 0.22 * radius, 0.75 * radius);
  arm.axilla_back = *arm.axilla + Vec3(-sign * 0.0035 * s, 0.16 * radius, -1.2 * radius);
}

namespace {

void move_pit(ArmTrace& arm, const Vec3& by) {
  for (std::optional<Vec3>* p : {&arm.axilla, &arm.axilla_front, &arm.axilla_back})
    if (*p)
      **p += by;
}

/// Lower than any pit, with no other arm to tell by how much.
void hide_pit(ArmTrace& arm, const Rules& rules, double s) {
  const double aside = 0.5 * (std::abs(arm.axilla->x()) + rules.number("axilla.aside") * s);
  move_pit(arm,
           Vec3((arm.left ? 1 : -1) * aside, rules.number("axilla.height") * s, arm.axilla->z()) -
               *arm.axilla);
  arm.pit_hidden = true;
  arm.merge.reset();
}

/// As the other's mirror image, at its own depth.
void mirror_pit(ArmTrace& hidden, const ArmTrace& seen) {
  move_pit(hidden, Vec3(-seen.axilla->x(), seen.axilla->y(), hidden.axilla->z()) - *hidden.axilla);
  hidden.pit_mirrored = true;
}

} // namespace

void compare_pits(std::array<ArmTrace, 2>& arms, const Rules& rules, double s) {
  constexpr double UNLIKE = 0.008; // of stature: of 48 people in natural stances 0.015 at most
  constexpr double KEPT =
      0.3; // of what is beyond; four of their 96 pits were found 23 to 61 mm too low
  constexpr double FADES = 0.01; // of stature above the lowest: from there down less is kept
  for (int k = 0; k < 2; ++k)
    if (arms[k].pit_low && !arms[k].pit_hidden &&
        (!arms[1 - k].axilla || arms[1 - k].pit_hidden || arms[1 - k].pit_low))
      hide_pit(arms[k], rules, s);
  if (!arms[0].axilla || !arms[1].axilla)
    return;
  for (int k = 0; k < 2; ++k)
    if (arms[k].pit_hidden && !arms[1 - k].pit_hidden)
      mirror_pit(arms[k], arms[1 - k]);
  if (arms[0].pit_hidden || arms[1].pit_hidden)
    return;
  ArmTrace& lower = arms[arms[0].axilla->y() < arms[1].axilla->y() ? 0 : 1];
  const ArmTrace& higher = &lower == &arms[0] ? arms[1] : arms[0];
  const double lowest = rules.number("axilla.lowest") * s;
  const double doubted =
      std::clamp((lowest + FADES * s - lower.axilla->y()) / (FADES * s), 0.0, 1.0);
  const double beyond = higher.axilla->y() - lower.axilla->y() - (1 - doubted) * UNLIKE * s;
  if (beyond <= 0)
    return;
  lower.lifted_m = (1 - (1 - doubted) * KEPT) * beyond;
  move_pit(lower, Vec3(0, lower.lifted_m, 0));
}

namespace {

/// Of 160 arm pits of fresh bodies none was farther outside of the merge than 0.007 of the stature.
constexpr double OUTSIDE_MERGE = 0.02;
constexpr double LEVEL_ARM = -0.12;   ///< height of the unit vector to the hand of an arm that is
                                      ///< looked for apart from the trunk all the way down
constexpr double SECTION_NEAR = 0.01; ///< of stature: sections of the arm this near a level
constexpr double HANGS = -0.4; ///< height of the unit vector to the hand: a more level arm meets
                               ///< the trunk's levels anywhere along it

/// Of stature about the middle of a level arm: heights at which its underside is met, and the step
/// between the levels.
constexpr double LEVEL_BELOW = 0.05, LEVEL_ABOVE = 0.02, LEVEL_RISE = 0.0006;
/// A trunk whose outline leaps out by more has taken in a piece of the arm's underside; along the
/// underside itself it runs out without a leap.
constexpr double TAKEN_IN = 0.008;
constexpr double BISECTED_M = 2e-5;

/// Level sections just below the height at which two loops become one.
struct Junction {
  double y = 0; ///< m
  std::vector<Loop> loops;
  int trunk = -1, limb = -1; ///< of loops
};

/// The largest loop that spans the middle; -1 where there is none.
int middle_loop(const std::vector<Loop>& loops) {
  for (std::size_t i = 0; i < loops.size(); ++i)
    if (loops[i].area > 0 && loops[i].low.x() < 0 && loops[i].high.x() > 0)
      return static_cast<int>(i);
  return -1;
}

double outer_end(const Loop& loop, bool left) {
  return left ? loop.high.x() : -loop.low.x();
}

/// Where the trunk's section first takes in a piece of a level arm's underside, going up from below
/// the arm. Such an arm meets the levels in several pieces, and those far out join last.
std::optional<Junction> level_arm_joins(const ArmTrace& arm, const LevelStack& levels) {
  const double s = levels.stature(), middle = arm.at(0.85 * arm.length()).y();
  auto reach = [&](double y) {
    const std::vector<Loop> loops = levels.exact(y);
    const int trunk = middle_loop(loops);
    return trunk < 0 ? 0.0 : outer_end(loops[trunk], arm.left);
  };
  double low = middle - LEVEL_BELOW * s, reach_low = reach(low);
  for (double y = low + LEVEL_RISE * s; y < middle + LEVEL_ABOVE * s; y += LEVEL_RISE * s) {
    double high = y, reach_high = reach(y);
    const double next = high, reach_next = reach_high;
    while (reach_high - reach_low > TAKEN_IN * s && high - low > BISECTED_M) {
      const double half = 0.5 * (low + high), at_half = reach(half);
      if (at_half - reach_low > reach_high - at_half) {
        high = half;
        reach_high = at_half;
      } else {
        low = half;
        reach_low = at_half;
      }
    }
    if (reach_high - reach_low > TAKEN_IN * s) {
      Junction junction{low, levels.exact(low), -1, -1};
      junction.trunk = middle_loop(junction.loops);
      double least = 1e300;
      for (std::size_t i = 0; i < junction.loops.size(); ++i) {
        const Loop& loop = junction.loops[i];
        const double inner_end = arm.left ? loop.low.x() : -loop.high.x();
        if (static_cast<int>(i) == junction.trunk || loop.area <= 0 || inner_end < 0 ||
            std::abs(inner_end - reach_low) > least)
          continue;
        least = std::abs(inner_end - reach_low);
        junction.limb = static_cast<int>(i);
      }
      if (junction.trunk >= 0 && junction.limb >= 0)
        return junction;
    }
    low = next;
    reach_low = reach_next;
  }
  return std::nullopt;
}

/// Highest level below which a hanging arm and the trunk are two loops.
std::optional<Junction> hanging_arm_joins(const ArmTrace& arm, const LevelStack& levels) {
  const double s = levels.stature();
  auto loops_at = [&](double y) {
    Junction cut{y, levels.exact(y), -1, -1};
    double nearest = 0.03 * s;
    for (std::size_t i = 0; i < cut.loops.size(); ++i) {
      const Loop& loop = cut.loops[i];
      if (loop.area <= 0)
        continue;
      if (cut.trunk < 0 && std::abs(loop.centroid.x()) < 0.06 * s) // the largest near the middle
        cut.trunk = static_cast<int>(i);
      double d = 1e300;
      for (const LimbSection& section : arm.sections) {
        if (std::abs(section.center.y() - y) > SECTION_NEAR * s)
          continue;
        const Vec2 c(section.center.x(), section.center.z());
        d = std::min(d, encloses(loop, c) ? 0.0 : (c - loop.centroid).norm());
      }
      if (d < nearest) {
        nearest = d;
        cut.limb = static_cast<int>(i);
      }
    }
    return cut;
  };
  auto apart = [&](double y) {
    const Junction cut = loops_at(y);
    return cut.trunk >= 0 && cut.limb >= 0 && cut.trunk != cut.limb;
  };
  double low = 0, high = 0;
  for (double y = 0.80 * s; y > 0.62 * s && low == 0; y -= 0.005 * s)
    (apart(y) ? low : high) = y;
  if (low == 0 || high == 0)
    return std::nullopt;
  while (high - low > BISECTED_M) {
    const double y = 0.5 * (low + high);
    (apart(y) ? low : high) = y;
  }
  return loops_at(low);
}

} // namespace

void find_merge(ArmTrace& arm, const LevelStack& levels) {
  const double s = levels.stature();
  std::optional<Junction> joined;
  if (arm.out.y() < LEVEL_ARM)
    joined = hanging_arm_joins(arm, levels);
  if (!joined)
    joined = level_arm_joins(arm, levels);
  if (!joined) // a level arm may never stand apart in level sections
    return;
  // both folds of the pit may come as near: of places as near as makes no difference the middle
  struct Near {
    Vec2 middle;
    double gap, length;
  };
  std::vector<Near> all;
  double least = 1e300;
  for (const auto& a : joined->loops[joined->trunk].segments)
    for (const double t : {0.1, 0.3, 0.5, 0.7, 0.9}) {
      const Vec2 p = (1 - t) * a[0] + t * a[1];
      Near near{p, 1e300, (a[1] - a[0]).norm()};
      for (const auto& b : joined->loops[joined->limb].segments) {
        const Vec2 along = b[1] - b[0];
        const Vec2 q =
            b[0] +
            std::clamp((p - b[0]).dot(along) / std::max(along.squaredNorm(), 1e-20), 0.0, 1.0) *
                along;
        if (const double gap = (p - q).norm(); gap < near.gap) {
          near.gap = gap;
          near.middle = 0.5 * (p + q);
        }
      }
      least = std::min(least, near.gap);
      all.push_back(near);
    }
  Vec2 sum = Vec2::Zero();
  double weight = 0;
  for (const Near& near : all)
    if (const double w = (least + AS_NEAR - near.gap) * near.length; w > 0) {
      sum += w * near.middle;
      weight += w;
    }
  if (weight <= 0)
    return;
  const Vec3 merge(sum.x() / weight, joined->y, sum.y() / weight);
  const bool hangs = arm.out.y() < HANGS;
  if (hangs || std::abs(merge.x() - arm.axilla->x()) < FROM_PIT * s)
    arm.merge = merge;
  // of an arm that hangs both are one place; a gap that closes far outside ran into a bulge of the
  // arm
  const double outside = (arm.left ? 1 : -1) * (arm.axilla->x() - merge.x());
  if (hangs && outside > OUTSIDE_MERGE * s) {
    arm.moved_to_merge_m = (merge - *arm.axilla).norm();
    move_pit(arm, Vec3(merge.x(), merge.y(), arm.axilla->z()) - *arm.axilla);
  }
}

Vec3 merge_by_pit(const Vec3& pit, const ArmTrace& arm, const Rules& rules, double s) {
  const double raised = std::max(0.0, arm.out.y() - rules.number("axilla_merge.raised"));
  auto of = [&](const std::string& name) {
    return rules.number("axilla_merge." + name) +
           rules.number("axilla_merge." + name + "_of_raised") * raised;
  };
  const double outside = of("outside");
  return pit + s * Vec3(arm.left ? outside : -outside, of("above"), of("before"));
}

Vec3 drawn_to_pit(const Vec3& merge, const Vec3& pit, const ArmTrace& arm, const Rules& rules,
                  double s) {
  const Vec3 expected = merge_by_pit(pit, arm, rules, s);
  auto drawn = [&](int axis, const std::string& most) {
    const double off = merge[axis] - expected[axis];
    const double share = std::min(1.0, s * rules.number(most) / std::max(1e-9, std::abs(off)));
    return expected[axis] + share * share * share * off;
  };
  return {drawn(0, "axilla_merge.most_aside"), drawn(1, "axilla_merge.most_above"), merge.z()};
}

} // namespace sloper::body

#include <body/landmarks/crotch.hpp>
#include <body/measure/plateau.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace sloper::body {

namespace {

constexpr double CROTCH_FLAT = 0.003; ///< m: as far back as makes no difference
constexpr double SAG = 0.015; ///< a closed hole hangs this much lower than the skin that was there
/// Half sizes of the box in which points of the scan show the crotch: thin, for the thighs beside a
/// hole are near.
const Vec3 SEEN(0.004, 0.012, 0.025);

constexpr const char* BY_BODY = "by_rest_of_body";
constexpr const char* BY_SEAT = "below_buttocks";

/// Names of the crotch's rules that apply to such a skin, in the tree's order. Figure and stance
/// are not known yet: of the tree's conditions only the skin's counts here.
std::vector<std::string> rules_of(const CrotchEvidence& evidence) {
  std::vector<std::string> order;
  for (const RuleChoice& rule : evidence.rules.order("crotch"))
    if (rule.skin.empty() || (rule.skin == "rebuilt") == evidence.rebuilt)
      order.push_back(rule.name);
  return order;
}

/// Height and depth of the rearmost part of the trunk below the waist.
struct Seat {
  double y, z;
  bool is_end; ///< it only runs out upwards, as of a back that leans
};
std::optional<Seat> seat_of(const LevelStack& levels) {
  const double s = levels.stature(), top = 0.60 * s;
  std::vector<Vec2> backs; // height, depth
  for (double y = 0.46 * s; y < top; y += levels.spacing()) {
    const Slice& slice = levels.at(y);
    if (slice.trunk >= 0)
      backs.emplace_back(slice.y, slice.loops[slice.trunk].low.y());
  }
  if (backs.empty())
    return std::nullopt;
  const Lowest rearmost = lowest_of(backs, CROTCH_FLAT);
  double z = 0;
  for (const Vec2& back : backs)
    z = std::min(z, back.y());
  return Seat{rearmost.middle, z, rearmost.least > top - 0.025 * s};
}

/// One of the two ends of the trunk's underside, m.
struct CrotchDepth {
  double z, sd;
  double likely; ///< probability of this end
};

/// Both ends for a crotch of height y: the farther the seat is behind the legs and the nearer to
/// the crotch, the likelier the one behind (logistic regression). Of 226 fresh bodies the ends are
/// 74 to 119 mm apart, and where either is likely over 100: no place between is near both.
struct CrotchEnds {
  CrotchDepth behind, before;
  const CrotchDepth& likelier() const { return behind.likely > 0.5 ? behind : before; }
  /// The end that skin with its crotch at depth z shows.
  const CrotchDepth& shown(double z) const {
    auto density = [z](const CrotchDepth& end) {
      const double off = (z - end.z) / end.sd;
      return std::log(end.likely / end.sd) - 0.5 * off * off;
    };
    return density(behind) > density(before) ? behind : before;
  }
};
std::optional<CrotchEnds> crotch_ends(const LevelStack& levels, const Rules& rules, double y) {
  constexpr double LEGS_AT = 0.85; // of the crotch's height: there thighs are apart
  const double s = levels.stature();
  const auto seat = seat_of(levels);
  const auto left = levels.leg_at(LEGS_AT * y, 0), right = levels.leg_at(LEGS_AT * y, 1);
  if (!seat || !left || !right)
    return std::nullopt;
  const double legs = 0.5 * (left->centroid.y() + right->centroid.y());
  const double above = (seat->y - y) / s, behind = (legs - seat->z) / s;
  const double behind_score = rules.number("crotch.behind") +
                              rules.number("crotch.behind_of_seat_height") * above +
                              rules.number("crotch.behind_of_seat_depth") * behind;
  const double is_behind = 1 / (1 + std::exp(-behind_score));
  return CrotchEnds{{legs + rules.number("crotch.end_behind") * s,
                     rules.number("crotch.end_behind_sd") * s, is_behind},
                    {legs + (rules.number("crotch.end_before") +
                             rules.number("crotch.end_before_of_seat_height") * above +
                             rules.number("crotch.end_before_of_seat_depth") * behind) *
                                s,
                     rules.number("crotch.end_before_sd") * s, 1 - is_behind}};
}

/// How surely the legs become one in skin that spans the gap between thighs, 0 to 1: just above the
/// place it is thin from front to back in the middle. Of 350 fresh bodies no trunk was thinner
/// there than 0.061 of the stature, and of ten scans whose legs had grown together none was thicker
/// than 0.044.
double grown_together(const LevelStack& levels) {
  constexpr double ABOVE = 0.01, THIN = 0.048, THICK = 0.057; // of stature
  const double s = levels.stature(), middle = levels.crotch_point().x();
  const auto& loop = levels.trunk_at(*levels.crotch() + ABOVE * s);
  if (!loop)
    return 0;
  double low = 1e300, high = -1e300;
  for (const auto& segment : loop->segments) {
    const double a = segment[0].x() - middle, b = segment[1].x() - middle;
    if ((a >= 0) == (b >= 0))
      continue;
    const double z = segment[0].y() + a / (a - b) * (segment[1].y() - segment[0].y());
    low = std::min(low, z);
    high = std::max(high, z);
  }
  if (low > high)
    return 0;
  return std::clamp((THICK - (high - low) / s) / (THICK - THIN), 0.0, 1.0);
}

/// Warns of a crotch that lies far from the likelier end of the trunk's underside, on a skin that
/// cannot show which of them is lower. It is not moved: bodies of other makes have it between both.
void doubt_depth(const LevelStack& levels, const CrotchDepth& depth,
                 std::vector<Finding>& findings) {
  constexpr double AWAY = 2; // standard deviations
  constexpr double LIKELY = 0.6;
  const double off = depth.z - levels.crotch_point().y();
  if (depth.likely < LIKELY || std::abs(off) < AWAY * depth.sd)
    return;
  char text[160];
  std::snprintf(text, sizeof text,
                "the rebuilt skin is rough between the legs: the crotch may lie %.0f mm farther %s",
                1000 * std::abs(off), off > 0 ? "forward" : "back");
  findings.push_back({"scan.crotch-estimated"_id, "warning", text, "crotch"});
}

/// A crotch that the skin shows between both ends, where people have none: the skin is rounded
/// there. Of 226 fresh bodies three are by over two standard deviations of either, off by 7, 44 and
/// 58 mm; of 40 corrupted scans five, off in depth by 12, 30, 56, 58 and 59. Rebuilt skin is drawn
/// to the end that it shows, the more the farther it is from there: four of the five are 7 to 21 mm
/// off so. The scan's own skin stays.
void doubt_rounded(LevelStack& levels, const CrotchEnds& ends, const CrotchEvidence& evidence,
                   std::vector<Finding>& findings, std::vector<std::string>& trail) {
  constexpr double BETWEEN = 2; // standard deviations of either end
  constexpr double BELONGS = 0.5;
  const bool rebuilt = evidence.rebuilt;
  const double z = levels.crotch_point().y();
  const CrotchDepth& end = ends.shown(z);
  const double off = end.z - z;
  const double from_behind = (z - ends.behind.z) / ends.behind.sd,
               from_before = (ends.before.z - z) / ends.before.sd;
  const double between = std::min(from_behind, from_before);
  if (between <= 0 || evidence.at_an_end <= 0)
    return;
  const double deviations = off / end.sd;
  const double weight =
      evidence.at_an_end * deviations * deviations / (deviations * deviations + 1);
  if (rebuilt)
    levels.move_crotch(*levels.crotch(), z + weight * off);
  char text[200];
  std::snprintf(text, sizeof text,
                "crotch: the skin shows it between both ends of the trunk's underside, %.1f "
                "deviations from either, %.0f mm from the likelier%s",
                between, 1000 * std::abs(off), rebuilt ? ", and is drawn there" : "");
  trail.emplace_back(text);
  if (between < BETWEEN || evidence.at_an_end < BELONGS)
    return;
  const char* const where = off > 0 ? "forward" : "back";
  if (rebuilt)
    std::snprintf(text, sizeof text,
                  "the skin is rounded between the legs: the crotch is put %.0f mm farther %s, "
                  "where the trunk's underside ends",
                  1000 * weight * std::abs(off), where);
  else
    std::snprintf(text, sizeof text,
                  "the skin is rounded between the legs: the crotch may lie %.0f mm farther %s",
                  1000 * std::abs(off), where);
  findings.push_back({"scan.crotch-rounded"_id, "warning", text, "crotch"});
}

/// What the skin shows of the crotch's depth may be wrong in two manners.
void doubt_shown_depth(LevelStack& levels, const CrotchEnds& ends, const CrotchEvidence& evidence,
                       std::vector<Finding>& findings, std::vector<std::string>& trail) {
  const std::size_t before = findings.size();
  doubt_rounded(levels, ends, evidence, findings, trail);
  if (evidence.rebuilt && findings.size() == before)
    doubt_depth(levels, ends.likelier(), findings);
}

} // namespace

bool doubt_crotch(LevelStack& levels, const CrotchEvidence& evidence,
                  std::vector<Finding>& findings, std::vector<std::string>& trail) {
  if (!levels.crotch())
    return false;
  const auto& [scan_points, rules, rebuilt, whole, at_an_end] = evidence;
  const std::vector<std::string> order = rules_of(evidence);
  if (std::find(order.begin(), order.end(), BY_SEAT) == order.end())
    return false;
  const bool always = order.front() == BY_SEAT;
  const double s = levels.stature(), found = *levels.crotch();
  const Vec3 place(levels.crotch_point().x(), found, levels.crotch_point().y());
  int seen = 0;
  for (const Vec3& p : scan_points)
    seen += ((p - place).cwiseAbs() - s * SEEN).maxCoeff() < 0;
  const auto buttock = seat_of(levels);
  const double by_stature = rules.number("crotch.of_stature") * s;
  const double expected =
      buttock && !buttock->is_end
          ? by_stature + rules.number("crotch.buttock_weight") *
                             (buttock->y - rules.number("crotch.below_buttocks") * s - by_stature)
          : by_stature;
  // from one to the other over half of that depth: a coarser mesh must not make it jump
  // the skins of a mesh of separate legs may touch or pass through each other: its legs are
  // followed all the same
  const double limit = rules.number(rebuilt ? "crotch.too_low_rebuilt" : "crotch.too_low") * s;
  const double too_low = (expected - found) / limit,
               doubt = always ? 1 : std::clamp(2 * (too_low - 0.75), 0.0, 1.0);
  const bool fused = doubt > 0;
  if ((whole || seen >= 3) && !fused)
    return false;
  const double y = fused ? found + doubt * (expected - found) : 0.5 * (expected + found + SAG * s),
               moved = fused ? doubt : 1;
  levels.move_crotch(y, place.z());
  if (const auto l = levels.leg_at(y - 0.01, 0))
    if (const auto r = levels.leg_at(y - 0.01, 1))
      levels.move_crotch(
          y, (1 - moved) * place.z() +
                 moved * (0.5 * (l->centroid.y() + r->centroid.y()) + CROTCH_BEFORE_LEGS * s));
  char text[200];
  std::snprintf(text, sizeof text,
                "crotch: the slices join at %.3f m, %s; put at %.3f m by the level of the buttocks",
                found, fused ? "too low: the thighs touch" : "in a hole", y);
  trail.push_back(text);
  findings.push_back({"scan.crotch-estimated"_id, "warning",
                      fused ? "the thighs touch: the crotch is hidden, its height is estimated"
                            : "the crotch is not in the scan, its height is estimated",
                      "crotch"});
  return true;
}

bool expect_crotch(LevelStack& levels, const Corrections::Expected& expected,
                   const CrotchEvidence& evidence, CrotchSource& source,
                   std::vector<Finding>& findings, std::vector<std::string>& trail) {
  constexpr double SEAT_SD = 0.016; // of stature: the seat's level knows the crotch as well
  const std::vector<std::string> order = rules_of(evidence);
  const auto by_body = std::find(order.begin(), order.end(), BY_BODY);
  const bool is_asked = source == CrotchSource::SKIN
                            ? by_body != order.end()
                            : by_body < std::find(order.begin(), order.end(), BY_SEAT);
  if (!levels.crotch() || !is_asked || expected.sd > SEAT_SD)
    return false;
  const double s = levels.stature(), found = *levels.crotch(), z = levels.crotch_point().y();
  const double low = (expected.height - found / s) / expected.sd;
  double share = 1;
  if (source == CrotchSource::SKIN)
    share = low > 0 ? grown_together(levels) : 0;
  const double y = found + share * (expected.height * s - found);
  const auto ends = crotch_ends(levels, evidence.rules, y);
  if (share == 0) {
    if (ends)
      doubt_shown_depth(levels, *ends, evidence, findings, trail);
    return false;
  }
  levels.move_crotch(y, ends ? z + share * (ends->likelier().z - z) : z);
  char text[200];
  std::snprintf(text, sizeof text,
                "crotch: by the rest of the body %.3f m high, %.1f deviations above what the skin "
                "shows, %.0f mm farther %s",
                expected.height * s, low, 1000 * std::abs(levels.crotch_point().y() - z),
                levels.crotch_point().y() > z ? "forward" : "back");
  trail.emplace_back(text);
  if (source == CrotchSource::SKIN)
    findings.push_back(
        {"scan.crotch-estimated"_id, "warning",
         "the skin has grown together between the legs: the crotch is where the rest of the body "
         "lets expect it",
         "crotch"});
  source = CrotchSource::REST_OF_BODY;
  return true;
}

} // namespace sloper::body

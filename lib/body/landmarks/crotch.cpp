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

/// Height of the rearmost part of the trunk below the waist; none where it only runs out upwards,
/// as of a back that leans.
std::optional<double> buttock_level(const LevelStack& levels) {
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
  if (rearmost.least > top - 0.025 * s)
    return std::nullopt;
  return rearmost.middle;
}

} // namespace

bool doubt_crotch(LevelStack& levels, const CrotchEvidence& evidence,
                  std::vector<Finding>& findings, std::vector<std::string>& trail) {
  if (!levels.crotch())
    return false;
  const auto& [scan_points, rules, rebuilt, whole] = evidence;
  // figure and stance are not known yet: of the tree's conditions only the skin's counts here
  std::vector<std::string> order;
  for (const RuleChoice& rule : rules.order("crotch"))
    if (rule.skin.empty() || (rule.skin == "rebuilt") == rebuilt)
      order.push_back(rule.name);
  if (std::find(order.begin(), order.end(), "below_buttocks") == order.end())
    return false;
  const bool always = order.front() == "below_buttocks";
  const double s = levels.stature(), found = *levels.crotch();
  const Vec3 place(levels.crotch_point().x(), found, levels.crotch_point().y());
  int seen = 0;
  for (const Vec3& p : scan_points)
    seen += ((p - place).cwiseAbs() - s * SEEN).maxCoeff() < 0;
  const auto buttock = buttock_level(levels);
  const double by_stature = rules.number("crotch.of_stature") * s;
  const double expected =
      buttock ? by_stature + rules.number("crotch.buttock_weight") *
                                 (*buttock - rules.number("crotch.below_buttocks") * s - by_stature)
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

} // namespace sloper::body

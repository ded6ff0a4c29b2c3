#include <body/ingest/canonical_frame.hpp>
#include <body/ingest/segmentation.hpp>
#include <body/scan_findings.hpp>

#include <algorithm>
#include <cstdio>

namespace sloper::body {

void add_findings(Body& body, const SegmentedScan& sorted, const SkinSurface& skin) {
  char text[160];
  auto add = [&](MessageId id, const char* severity, const char* place) {
    body.scan.findings.push_back({id, severity, text, place});
  };
  std::snprintf(text, sizeof text, "up is %s: score %.2f against %.2f for the next best direction",
                sorted.up_name.c_str(), sorted.up_score, std::max(0.0, sorted.next_score));
  add("scan.up"_id,
      sorted.up_score - sorted.next_score < 0.15 && sorted.next_score > 0 ? "warning" : "info",
      "scan");
  std::snprintf(text, sizeof text, "roughness %.1f mm", 1000 * skin.noise_m);
  add("scan.roughness"_id, "info", "skin");
  if (sorted.has_floor) {
    std::snprintf(text, sizeof text, "a floor was left out");
    add("scan.floor-left-out"_id, "info", "feet");
  }
  if (sorted.n_debris) {
    std::snprintf(text, sizeof text, "%d loose pieces were left out", sorted.n_debris);
    add("scan.pieces-left-out"_id, "info", "scan");
  }
  std::snprintf(text, sizeof text, "stance %s: arms %.0f and %.0f degrees from hanging down",
                body.stance_class.c_str(), body.arm_l_deg, body.arm_r_deg);
  add("scan.stance"_id, "info", "arms");
}

void add_holes(Body& body, const std::vector<Hole>& holes, const Vec3& origin) {
  constexpr double WIDE = 0.03;                           // m: there the skin is made up
  constexpr double SOLE_HEIGHT = 0.03, SOLE_WIDTH = 0.08; // of stature, at most and at least
  const double s = body.scan.stature_m;
  const bool is_open_below = std::any_of(holes.begin(), holes.end(), [&](const Hole& hole) {
    return hole.center.y() < SOLE_HEIGHT * s && hole.width > SOLE_WIDTH * s;
  });
  if (is_open_below)
    body.scan.findings.push_back(
        {"scan.soles-open"_id, "warning",
         "the feet have no soles: if they are cut off above the floor, the stature and all heights "
         "are too small by what is missing",
         "scan"});
  for (const Hole& hole : holes) {
    const Vec3 p = hole.center + origin;
    std::string near;
    double nearest = 1e300;
    for (const auto& [name, landmark] : body.landmarks)
      if (const double d = (landmark.p - p).norm(); d < nearest) {
        nearest = d;
        near = " near " + name;
      }
    char text[160], place[80];
    std::snprintf(text, sizeof text, "a hole %.0f mm wide (%d open edges)%s", 1000 * hole.width,
                  hole.edges, near.c_str());
    std::snprintf(place, sizeof place, "(%.3f, %.3f, %.3f)", p.x(), p.y(), p.z());
    body.scan.findings.push_back(
        {"scan.hole"_id, hole.width > WIDE ? "warning" : "info", text, place});
  }
}

void add_missing(Body& body) {
  constexpr const char* IN_THE_MIDDLE[] = {
      "abdomen_front",      "buttock_back", "crotch",      "head_tip",   "hip_center",
      "hip_section_center", "neck_back",    "neck_center", "neck_front", "omphalion"};
  constexpr const char* ON_BOTH_SIDES[] = {
      "acromion",   "ankle",          "axilla",     "axilla_back", "axilla_front",  "axilla_merge",
      "bust_point", "bust_prominent", "elbow",      "foot_tip",    "hand_extreme",  "hand_tip",
      "heel",       "hip_joint",      "knee",       "leg_top",     "malleolus",     "neck_side",
      "olecranon",  "patella",        "waist_side", "wrist",       "shoulder_joint"};
  std::vector<std::string> names(std::begin(IN_THE_MIDDLE), std::end(IN_THE_MIDDLE));
  for (const std::string place : ON_BOTH_SIDES) {
    names.push_back(place + "_l");
    names.push_back(place + "_r");
  }
  std::vector<Finding>& all = body.scan.findings;
  for (const std::string& name : names) {
    const bool is_named =
        std::any_of(all.begin(), all.end(), [&](const Finding& f) { return f.place == name; });
    if (!body.has_landmark(name) && !is_named)
      all.push_back({"scan.landmark-not-found"_id, "info", "landmark not found", name});
  }
}

void add_unit_finding(Body& body, bool given) {
  constexpr double SMALL = 1.3, TALL = 2.1; // m
  constexpr double RARE = 0.3;              // decimetres and feet
  char text[160];
  std::snprintf(text, sizeof text, "unit %s%s: %.2f m tall", body.scan.unit.c_str(),
                given ? ", as given" : ", guessed", body.scan.stature_m);
  std::string what = text, other;
  bool is_rare = false; // a scale of no unit is as likely
  for (const LengthUnit& unit : LENGTH_UNITS)
    if (!given && body.scan.unit == unit.name) {
      other = other_guess(body.scan.stature_m, unit);
      is_rare = unit.rare > RARE;
    }
  if (!other.empty())
    what += "; it may as well be " + other + ": give --unit, --scale or --stature";
  const bool is_doubtful = !given && (!other.empty() || is_rare || body.scan.stature_m < SMALL ||
                                      body.scan.stature_m > TALL);
  if (is_rare && other.empty())
    what += ", in which few files are: give --unit, --scale or --stature if that is wrong";
  else if (is_doubtful && other.empty())
    what += ", as few people are: give --unit, --scale or --stature if that is wrong";
  body.scan.findings.push_back({"scan.unit"_id, is_doubtful ? "warning" : "info", what, "scan"});
}

} // namespace sloper::body

#include <body/landmarks/dependents.hpp>

#include <algorithm>
#include <cstdio>

namespace sloper::body {

namespace {

struct Rests {
  const char *landmark, *on;
  bool has_warning; ///< of its own
};
/// No warning where it named a right place, within 15 mm, in over six of ten cases (704 bodies).
constexpr Rests RESTS[] = {{"bust_prominent_l", "bust_point_l", true},
                           {"bust_prominent_r", "bust_point_r", true},
                           {"neck_side_l", "neck_back", false},
                           {"neck_side_r", "neck_back", false},
                           {"neck_center", "neck_back", true},
                           {"neck_center", "neck_front", false},
                           {"olecranon_l", "elbow_l", true},
                           {"olecranon_r", "elbow_r", true},
                           {"axilla_merge_l", "axilla_l", false},
                           {"axilla_merge_r", "axilla_r", false},
                           {"leg_top_l", "crotch", true},
                           {"leg_top_r", "crotch", true},
                           {"hip_joint_l", "crotch", true},
                           {"hip_joint_r", "crotch", true},
                           {"hip_center", "crotch", true}};
/// Girths, and the landmarks whose place decides on their length: a centimetre of
/// height is two of a thigh.
struct GirthRests {
  const char *girth, *on;
};
constexpr GirthRests GIRTH_RESTS[] = {{"thigh_l", "crotch"},       {"thigh_r", "crotch"},
                                      {"crotch_length", "crotch"}, {"neck", "neck_back"},
                                      {"neck", "neck_front"},      {"neck_base", "neck_back"},
                                      {"neck_base", "neck_front"}};
/// Of stature, of the merge below the arm pit: of 1408 arm pits 11 merges are 0.0075 to 0.01 below,
/// all of them right within 15 mm.
constexpr double MERGE_BELOW = 0.0125;
constexpr double MERGE_DOUBT = 0.5; ///< of the confidence
constexpr double ROUNDED = 0.5;     ///< of the confidence of a crotch where the skin is rounded
/// Of the confidence: off by more than 25 mm are 13 % of the landmarks of bodies stranger than
/// those learned from, and 0.4 % of the others'.
constexpr double STRANGE = 0.6;
constexpr int TERMINAL = 1; ///< Landmark::step
/// Of 11,001 landmarks of 204 fresh bodies 32 moved by more than this share of stature when the
/// rules ran on jittered skins; 8 of them were off by more than 40 mm, 13 by more than 25 mm.
constexpr double UNSTEADY = 0.023;
/// Of the same landmarks 14 had a confidence below; 2 were off by more than 25 mm, 9 by 15 mm.
constexpr double HARDLY_BELIEVED = 0.15;

/// Places whose own rules say where they are ambiguous. Of 26 that moved in 704 bodies, and of
/// which these rules said nothing, one was off by more than 15 mm.
bool tells_itself(const std::string& name) {
  return name == "crotch" || name == "abdomen_front";
}

bool is_warned_of(const Body& body, const std::string& name) {
  const std::vector<Finding>& all = body.scan.findings;
  return std::any_of(all.begin(), all.end(), [&](const Finding& finding) {
    return finding.place == name && finding.severity == "warning";
  });
}

/// A crotch that the skin shows may be in doubt from front to back alone: what is above it does not
/// care, unless the rest of the body lets expect it elsewhere.
bool may_mislead(const Body& body, const std::string& name) {
  if (name != "crotch" || body.landmarks.at(name).rule == "below_buttocks")
    return true;
  const std::vector<Finding>& all = body.scan.findings;
  return std::any_of(all.begin(), all.end(), [&](const Finding& finding) {
    return finding.place == name && finding.id == "scan.landmark-unlikely"_id.text();
  });
}

bool is_found(const Body& body, const char* id) {
  const std::vector<Finding>& all = body.scan.findings;
  return std::any_of(all.begin(), all.end(), [&](const Finding& f) { return f.id == id; });
}

/// A scanner's own faces that have grown together between the legs may have between arms and trunk:
/// of four such scans the merges were 27 to 44 mm too low on three. Skin that is rounded between
/// the legs has grown together where the pits are low as well.
bool has_grown_together(const Body& body, bool pits_are_low) {
  const auto crotch = body.landmarks.find("crotch");
  if (crotch == body.landmarks.end() || is_found(body, "scan.skin-rebuilt"))
    return false;
  return crotch->second.rule == "by_rest_of_body" ||
         (is_found(body, "scan.crotch-rounded") && pits_are_low);
}

/// Of eight arm pits of such scans four were 25 to 60 mm too low, with the folds beside them.
void doubt_grown_pit(Body& body, const std::string& side) {
  for (const std::string place : {"axilla", "axilla_front", "axilla_back"}) {
    const auto it = body.landmarks.find(place + side);
    if (it == body.landmarks.end() || is_warned_of(body, it->first))
      continue;
    it->second.confidence *= MERGE_DOUBT;
    body.scan.findings.push_back({"scan.landmark-unlikely"_id, "warning",
                                  "the skin has grown together between the legs, and may have "
                                  "between arm and trunk: look at it",
                                  it->first});
  }
}

void doubt_merge(Body& body, const std::string& side, bool has_grown) {
  const auto merge = body.landmarks.find("axilla_merge" + side);
  if (merge == body.landmarks.end() || !body.has_landmark("axilla" + side))
    return;
  const double below = body.landmark("axilla" + side).y() - merge->second.p.y();
  const bool is_below = below > MERGE_BELOW * body.scan.stature_m;
  if (!is_below && !has_grown)
    return;
  merge->second.confidence *= MERGE_DOUBT;
  char text[160];
  if (is_below)
    std::snprintf(
        text, sizeof text,
        "level sections of arm and trunk join %.0f mm below the arm pit: they touch there",
        1000 * below);
  else
    std::snprintf(text, sizeof text,
                  "the skin has grown together between the legs, and may have between arm and "
                  "trunk: look at it");
  body.scan.findings.push_back({"scan.landmark-unlikely"_id, "warning", text, merge->first});
}

/// Warns of every landmark that other poses of the same skin put elsewhere, or that its own rules
/// hardly believe, and of which nothing has warned so far.
void doubt_unsure(Body& body) {
  for (const auto& [name, landmark] : body.landmarks) {
    const bool is_unsteady =
        landmark.spread_m > UNSTEADY * body.scan.stature_m && !tells_itself(name);
    if ((!is_unsteady && landmark.confidence >= HARDLY_BELIEVED) || is_warned_of(body, name))
      continue;
    char text[160];
    if (is_unsteady)
      std::snprintf(text, sizeof text,
                    "it moves by %.0f mm when the scan is turned by a degree and roughened by a "
                    "millimetre: look at it",
                    1000 * landmark.spread_m);
    else
      std::snprintf(text, sizeof text, "its confidence is %.2f: look at it", landmark.confidence);
    body.scan.findings.push_back({"scan.landmark-unsure"_id, "warning", text, name});
  }
}

/// Warns of every girth that is measured where an unsure landmark is.
void doubt_girths(Body& body) {
  for (const GirthRests& rests : GIRTH_RESTS)
    if (body.girths.count(rests.girth) && body.has_landmark(rests.on) &&
        is_warned_of(body, rests.on) && may_mislead(body, rests.on) &&
        !is_warned_of(body, rests.girth))
      body.scan.findings.push_back(
          {"scan.girth-unsure"_id, "warning",
           std::string("it is measured beside ") + rests.on + ", which is unsure", rests.girth});
}

} // namespace

void doubt_dependents(Body& body, double strangeness, bool pits_are_low) {
  if (is_found(body, "scan.crotch-rounded"))
    body.landmarks["crotch"].confidence *= ROUNDED;
  const bool has_grown = has_grown_together(body, pits_are_low);
  for (const char* side : {"_l", "_r"}) {
    doubt_merge(body, side, has_grown);
    if (has_grown)
      doubt_grown_pit(body, side);
  }
  if (strangeness > 1)
    for (auto& [name, landmark] : body.landmarks)
      if (landmark.step != TERMINAL)
        landmark.confidence *= STRANGE;
  doubt_unsure(body);
  for (const Rests& rests : RESTS) {
    const auto it = body.landmarks.find(rests.landmark);
    if (it == body.landmarks.end() || !body.has_landmark(rests.on))
      continue;
    if (!is_warned_of(body, rests.on) || !may_mislead(body, rests.on))
      continue;
    it->second.confidence = std::min(it->second.confidence, body.landmarks[rests.on].confidence);
    if (!rests.has_warning || is_warned_of(body, rests.landmark))
      continue;
    body.scan.findings.push_back({"scan.landmark-unlikely"_id, "warning",
                                  std::string("it rests on ") + rests.on + ", which is unsure",
                                  rests.landmark});
  }
  doubt_girths(body);
}

} // namespace sloper::body

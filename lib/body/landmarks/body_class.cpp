#include <body/landmarks/landmark_finder.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

namespace sloper::body {

namespace {

std::string line(const char* format, double a, double b = 0, double c = 0) {
  char text[200];
  std::snprintf(text, sizeof text, format, a, b, c);
  return text;
}

constexpr double BREADTH_STEP = 0.006; // of stature, between the levels whose breadth is compared
constexpr double JOINED_STEP = 0.002; // of stature, up to the first level in which the legs are one
constexpr double LEAST_BREADTH_M = 1e-6; // what is divided by
constexpr double BULGE = 1.02;           // times as deep as the chest: a belly

/// How far a measure speaks for female proportions: its distance below the border between the
/// figures, in units of the clue, no farther than the clue may decide. `direction` is -1 for a
/// measure that is greater on female figures.
double vote(const Rules& rules, const std::string& clue, double measure, double direction = 1) {
  const double away = direction * (rules.number(clue) - measure) / rules.number(clue + "_unit");
  return std::clamp(away, -rules.number(clue + "_most_male"), rules.number(clue + "_most_female"));
}

/// Greatest and least breadth of the trunk between two heights; arms that hang on it are no concern
/// below the arm pits.
void breadths(const LevelStack& levels, double low, double high, double& least, double& most) {
  least = 1e300;
  most = 0;
  for (double y = low; y <= high; y += BREADTH_STEP * levels.stature()) {
    const Slice& slice = levels.at(y);
    if (slice.trunk < 0)
      continue;
    const double width = slice.loops[slice.trunk].size().x();
    least = std::min(least, width);
    most = std::max(most, width);
  }
}

/// Volume within a skin, m3.
double volume(const TriangleMesh& skin) {
  constexpr double TETRAHEDRON = 1.0 / 6; // of the parallelepiped of its edges
  double sum = 0;
  for (const Triangle& t : skin.triangles)
    sum += skin.positions[t[0]].dot(skin.positions[t[1]].cross(skin.positions[t[2]]));
  return TETRAHEDRON * sum;
}

std::optional<double> front_of(const LevelStack& levels, double y) {
  const auto& loop = levels.trunk_at(y);
  return loop ? std::optional(loop->high.y()) : std::nullopt;
}

} // namespace

Box3 navel_box(const Rules& rules, double stature) {
  const double aside = rules.number("figure.navel_aside") * stature;
  Box3 box;
  box.low = Vec3(-aside, rules.number("figure.navel_low") * stature, -1);
  box.high = Vec3(aside, rules.number("figure.navel_high") * stature, 1);
  return box;
}

FigureClass classify_figure(const LevelStack& levels, const std::array<ArmTrace, 2>& arms,
                            const Rules& rules, std::vector<std::string>& trail) {
  FigureClass figure;
  if (!levels.crotch())
    return figure;
  const double s = levels.stature(), crotch = *levels.crotch();
  const TriangleMesh& skin = levels.skin();
  double least, hip, unused;
  const double hip_end = crotch + rules.number("figure.hips_end") * s;
  breadths(levels, crotch + rules.number("figure.hips_begin") * s, hip_end, unused, hip);
  breadths(levels, hip_end, rules.number("figure.waist_end") * s, least, unused);
  double score = 0;
  const double waist_to_hip = least / std::max(hip, LEAST_BREADTH_M);
  score += vote(rules, "figure.waist_to_hip", waist_to_hip);
  // the front just above the crotch, from where the legs are one: skin between them may hang lower
  double joined = crotch + rules.number("figure.groin_begin") * s;
  const double joined_end = crotch + rules.number("figure.groin_end") * s;
  while (joined < joined_end && !levels.trunk_at(joined))
    joined += JOINED_STEP * s;
  const auto groin = front_of(levels, joined);
  const auto above = front_of(levels, joined + rules.number("figure.groin_span") * s);
  const double rise = groin && above ? (*above - *groin) / s : rules.number("figure.groin_rise");
  score += vote(rules, "figure.groin_rise", rise);
  // bumps of the chest
  const double radius = rules.number("figure.relief_radius") * s;
  const double inner = rules.number("figure.chest_inner") * s;
  const double outer = rules.number("figure.chest_outer") * s;
  for (int side = 0; side < 2; ++side) {
    Box3 box;
    box.low = Vec3(side == 0 ? inner : -outer, rules.number("figure.chest_low") * s, -1);
    box.high = Vec3(side == 0 ? outer : -inner, rules.number("figure.chest_high") * s, 1);
    figure.nipple[side] = strongest_relief(skin, box, radius, 1);
  }
  figure.navel = strongest_relief(skin, navel_box(rules, s), radius, -1);
  const double to_usual_stature = rules.number("figure.usual_stature") / s;
  for (auto* relief : {&figure.nipple[0], &figure.nipple[1], &figure.navel})
    if (*relief)
      (*relief)->height *= to_usual_stature;
  const double bump = figure.nipple[0] && figure.nipple[1]
                          ? std::min(figure.nipple[0]->height, figure.nipple[1]->height)
                          : 0;
  score += vote(rules, "figure.bump", bump, -1);
  if (arms[0].axilla && arms[1].axilla) {
    const double shoulder_to_hip =
        (arms[0].axilla->x() - arms[1].axilla->x()) / std::max(hip, LEAST_BREADTH_M);
    score += vote(rules, "figure.shoulder_to_hip", shoulder_to_hip);
  }
  figure.female = 1 / (1 + std::exp(-rules.number("figure.steepness") * score));
  trail.push_back(line("figure: waist to hip breadth %.3f, front rises %.4f of stature above the "
                       "crotch, chest bump %.1f mm",
                       waist_to_hip, rise, 1000 * bump));
  trail.push_back(line("figure: %.2f female proportions", figure.female));
  for (int side = 0; side < 2; ++side)
    if (figure.nipple[side])
      trail.push_back(
          line(side == 0 ? "chest: strongest bump on the left at x %.3f, y %.3f, %.1f mm high"
                         : "chest: strongest bump on the right at x %.3f, y %.3f, %.1f mm high",
               figure.nipple[side]->p.x(), figure.nipple[side]->p.y(),
               1000 * figure.nipple[side]->height));
  if (figure.navel)
    trail.push_back(line("belly: strongest dimple at x %.3f, y %.3f, %.1f mm deep",
                         figure.navel->p.x(), figure.navel->p.y(), -1000 * figure.navel->height));
  return figure;
}

void name_body_class(const Finder& f) {
  Body& body = f.body;
  body.body_class = f.figure.female > 0.5 ? "female figure" : "male figure";
  body.body_class_why.push_back(
      line("%.2f female proportions by waist to hip breadth, groin and chest", f.figure.female));
  // of 104 bodies of two makes the three that were taken for the other sex scored up to 0.85; 13 of
  // the others are as unsure
  constexpr double SURE = 0.87;
  // m3 over the square of the stature in m: of 362 bodies of one make the thinnest has 0.0170; a
  // man of another make with 0.0163 scores 0.94 female
  constexpr double LEAST_BUILD = 0.0165;
  const double build = volume(f.levels.skin()) / (f.s * f.s);
  if (build < LEAST_BUILD) {
    const std::string text =
        line("the figure is unsure: the body is thinner (%.1f litres to the square of its stature) "
             "than those on which the two classes were learned",
             1000 * build);
    body.body_class_why.push_back(text);
    body.scan.findings.push_back({"scan.figure-unsure"_id, "info", text, "figure"});
  } else if (std::max(f.figure.female, 1 - f.figure.female) < SURE) {
    const std::string text =
        line("the figure is unsure: %.2f female proportions, %.2f male; numbers of both are mixed",
             f.figure.female, 1 - f.figure.female);
    body.body_class_why.push_back(text);
    body.scan.findings.push_back({"scan.figure-unsure"_id, "info", text, "figure"});
  }
  const bool indented =
      body.levels.count("waist_girth_min") != 0 || body.levels.count("waist_width_min") != 0;
  const bool hidden = std::any_of(body.scan.findings.begin(), body.scan.findings.end(),
                                  [](const Finding& finding) { return finding.place == "waist"; });
  const char* const other_waist = hidden ? ", hidden waist" : ", straight waist";
  body.body_class += indented ? ", indented waist" : other_waist;
  if (!indented && !hidden)
    body.body_class_why.emplace_back("neither girth nor breadth has a minimum between chest and "
                                     "hip: the waist is taken by proportion");
  if (body.levels.count("abdomen") && body.levels.count("bust")) {
    const double bulge = body.levels["abdomen"].depth_m / body.levels["bust"].depth_m;
    if (bulge > BULGE) {
      body.body_class += ", belly";
      body.body_class_why.push_back(line("abdomen is %.2f times as deep as the chest", bulge));
    }
  }
  body.body_class += ", stance " + body.stance_class;
}

} // namespace sloper::body

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

/// Greatest and least breadth of the trunk between two heights; arms that hang on it are no concern
/// below the arm pits.
void breadths(const LevelStack& levels, double low, double high, double& least, double& most) {
  least = 1e300, most = 0;
  for (double y = low; y <= high; y += 0.006 * levels.stature()) {
    const Slice& slice = levels.at(y);
    if (slice.trunk < 0) continue;
    const double width = slice.loops[slice.trunk].size().x();
    least = std::min(least, width);
    most = std::max(most, width);
  }
}

std::optional<double> front_of(const LevelStack& levels, double y) {
  const auto& loop = levels.trunk_at(y);
  return loop ? std::optional(loop->high.y()) : std::nullopt;
}

} // namespace

FigureClass classify_figure(const LevelStack& levels, const std::array<ArmTrace, 2>& arms,
                            const std::vector<Vec3>& normals, const Rules& rules,
                            std::vector<std::string>& trail) {
  FigureClass figure;
  if (!levels.crotch()) return figure;
  const double s = levels.stature(), crotch = *levels.crotch();
  const TriangleMesh& skin = levels.skin();
  double least, hip, unused;
  breadths(levels, crotch + 0.01 * s, crotch + 0.12 * s, unused, hip);
  breadths(levels, crotch + 0.12 * s, 0.70 * s, least, unused);
  double score = 0;
  const double waist_to_hip = least / std::max(hip, 1e-6);
  score += std::clamp((rules.number("figure.waist_to_hip") - waist_to_hip) / 0.04, -2.5, 2.0);
  // the front just above the crotch, from where the legs are one: skin between them may hang lower
  double joined = crotch + 0.012 * s;
  while (joined < crotch + 0.030 * s && !levels.trunk_at(joined)) joined += 0.002 * s;
  const auto groin = front_of(levels, joined), above = front_of(levels, joined + 0.018 * s);
  const double rise = groin && above ? (*above - *groin) / s : rules.number("figure.groin_rise");
  score += std::clamp((rules.number("figure.groin_rise") - rise) / 0.002, -1.5, 1.5);
  // bumps of the chest
  for (int side = 0; side < 2; ++side) {
    Box3 box;
    box.low = Vec3(side == 0 ? 0.03 * s : -0.11 * s, 0.655 * s, -1);
    box.high = Vec3(side == 0 ? 0.11 * s : -0.03 * s, 0.765 * s, 1);
    figure.nipple[side] = strongest_relief(skin, normals, box, 0.011 * s, 1);
  }
  Box3 box;
  box.low = Vec3(-0.02 * s, 0.55 * s, -1);
  box.high = Vec3(0.02 * s, 0.65 * s, 1);
  figure.navel = strongest_relief(skin, normals, box, 0.011 * s, -1);
  for (auto* relief : {&figure.nipple[0], &figure.nipple[1],
                       &figure.navel}) // the rules' heights are those of a person of 1.68 m
    if (*relief) (*relief)->height *= 1.68 / s;
  const double bump = figure.nipple[0] && figure.nipple[1]
                          ? std::min(figure.nipple[0]->height, figure.nipple[1]->height)
                          : 0;
  score += std::clamp((bump - rules.number("figure.bump")) / 0.0008, -1.5, 2.0);
  if (arms[0].axilla && arms[1].axilla) {
    const double shoulder_to_hip =
        (arms[0].axilla->x() - arms[1].axilla->x()) / std::max(hip, 1e-6);
    score +=
        std::clamp((rules.number("figure.shoulder_to_hip") - shoulder_to_hip) / 0.08, -1.0, 1.0);
  }
  figure.female = 1 / (1 + std::exp(-1.5 * score));
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
  if (std::max(f.figure.female, 1 - f.figure.female) < SURE) {
    const std::string text =
        line("the figure is unsure: %.2f female proportions, %.2f male; numbers of both are mixed",
             f.figure.female, 1 - f.figure.female);
    body.body_class_why.push_back(text);
    body.scan.findings.push_back({"info", text, "figure"});
  }
  const bool indented =
      body.levels.count("waist_girth_min") != 0 || body.levels.count("waist_width_min") != 0;
  const bool hidden = std::any_of(body.scan.findings.begin(), body.scan.findings.end(),
                                  [](const Finding& finding) { return finding.place == "waist"; });
  body.body_class += indented ? ", indented waist" : hidden ? ", hidden waist" : ", straight waist";
  if (!indented && !hidden)
    body.body_class_why.emplace_back("neither girth nor breadth has a minimum between chest and "
                                     "hip: the waist is taken by proportion");
  if (body.levels.count("abdomen") && body.levels.count("bust")) {
    const double bulge = body.levels["abdomen"].depth_m / body.levels["bust"].depth_m;
    if (bulge > 1.02) {
      body.body_class += ", belly";
      body.body_class_why.push_back(line("abdomen is %.2f times as deep as the chest", bulge));
    }
  }
  body.body_class += ", stance " + body.stance_class;
}

} // namespace sloper::body

#include <body/landmarks/made_up_skin.hpp>
#include <body/surface/point_grid.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace sloper::body {

namespace {

constexpr double FROM_POINTS =
    0.008; ///< of stature: a place of the skin farther from all points is made up
constexpr double SPACINGS = 2.5;      ///< ... or so many spacings of the points, where that is more
constexpr double RESTS_NEAR = 0.03;   ///< of stature: a landmark this near to it rests on it
constexpr double MADE_UP_DOUBT = 0.5; ///< of the confidence
/// Standard deviations, of 13 mm, within which a pit is confirmed: the pits of a scan with holes
/// there that were 40 mm too low are three off.
constexpr double CONFIRMED = 1.5;
/// Standard deviations, mean of both sides: of 226 fresh bodies the pits of 52 are as low, and of
/// the three whose crotch looks rounded none; of a fused scan whose crotch does they are 0.8
/// low, and 26 and 29 mm.
constexpr double LOW = 0.5;
/// What stands or falls together: one place of skin or one fold.
const std::vector<std::vector<std::string>> SKIN_PLACES = {
    {"axilla_l", "axilla_front_l", "axilla_back_l", "axilla_merge_l"},
    {"axilla_r", "axilla_front_r", "axilla_back_r", "axilla_merge_r"},
    {"acromion_l"},
    {"acromion_r"},
    {"bust_point_l"},
    {"bust_point_r"},
    {"bust_prominent_l"},
    {"bust_prominent_r"},
    {"waist_side_l"},
    {"waist_side_r"},
    {"olecranon_l"},
    {"olecranon_r"},
    {"crotch"},
    {"neck_front"},
    {"neck_back"},
    {"omphalion"},
    {"abdomen_front"},
    {"buttock_back"}};

double skin_area(const TriangleMesh& skin) {
  double twice = 0;
  for (const Triangle& t : skin.triangles)
    twice += area_normal(skin.positions[t[0]], skin.positions[t[1]], skin.positions[t[2]]).norm();
  return 0.5 * twice;
}

} // namespace

MadeUpSkin made_up_skin(const TriangleMesh& skin, double stature, const std::vector<Vec3>& points,
                        const std::vector<Vec3>& on_faces) {
  MadeUpSkin made_up;
  if (points.empty() || skin.triangles.empty())
    return made_up;
  const double spacing = std::sqrt(skin_area(skin) / static_cast<double>(points.size()));
  made_up.far_m = std::max(FROM_POINTS * stature, SPACINGS * spacing);
  const PointGrid vertices(points, made_up.far_m), faces(on_faces, made_up.far_m);
  for (const Triangle& t : skin.triangles) {
    const Vec3 middle = (skin.positions[t[0]] + skin.positions[t[1]] + skin.positions[t[2]]) / 3;
    if (vertices.nearest(middle) < 0 && faces.nearest(middle) < 0)
      made_up.middles.push_back(middle);
  }
  return made_up;
}

bool MadeUpSkin::is_beside(const Vec3& p, double stature) const {
  return std::any_of(middles.begin(), middles.end(), [&](const Vec3& middle) {
    return (middle - p).norm() < RESTS_NEAR * stature;
  });
}

std::vector<std::string> confirmed_pits(const Body& body, const Corrections& corrections,
                                        const ShapeFeatures& features) {
  constexpr const char* PITS[] = {"axilla_l", "axilla_r"};
  const double s = body.scan.stature_m;
  std::vector<std::string> confirmed;
  for (int side = 0; side < 2; ++side) {
    const auto expected = corrections.expected("axilla_by_shoulders", features, side);
    if (!expected || !body.has_landmark(PITS[side]))
      continue;
    if (std::abs(body.landmark(PITS[side]).y() / s - expected->height) > CONFIRMED * expected->sd)
      continue;
    const std::string suffix = side == 0 ? "_l" : "_r";
    for (const char* name : {"axilla", "axilla_front", "axilla_back"})
      confirmed.push_back(name + suffix);
  }
  return confirmed;
}

bool pits_are_low(const Body& body, const Corrections& corrections, const ShapeFeatures& features) {
  constexpr const char* PITS[] = {"axilla_l", "axilla_r"};
  double sum = 0;
  for (int side = 0; side < 2; ++side) {
    const auto expected = corrections.expected("axilla_by_shoulders", features, side);
    if (!expected || !body.has_landmark(PITS[side]))
      return false;
    sum += (body.landmark(PITS[side]).y() / body.scan.stature_m - expected->height) / expected->sd;
  }
  return 0.5 * sum < -LOW;
}

void doubt_made_up_skin(Body& body, const MadeUpSkin& made_up,
                        const std::vector<std::string>& confirmed) {
  auto rests_on_it = [&](const std::string& name) {
    return body.has_landmark(name) && made_up.is_beside(body.landmark(name), body.scan.stature_m);
  };
  auto is_warned = [&](const std::string& name) {
    return std::any_of(body.scan.findings.begin(), body.scan.findings.end(), [&](const Finding& f) {
      return f.place == name && f.severity == "warning";
    });
  };
  char text[160];
  std::snprintf(text, sizeof text,
                "the skin beside it is made up: the scan has no points within %.0f mm there",
                1000 * made_up.far_m);
  for (const std::vector<std::string>& together : SKIN_PLACES) {
    if (std::none_of(together.begin(), together.end(), rests_on_it))
      continue;
    for (const std::string& name : together) {
      const auto it = body.landmarks.find(name);
      if (it == body.landmarks.end() || is_warned(name))
        continue;
      if (std::find(confirmed.begin(), confirmed.end(), name) != confirmed.end())
        continue;
      it->second.spread_m = std::max(it->second.spread_m, made_up.far_m);
      it->second.confidence *= MADE_UP_DOUBT;
      body.scan.findings.push_back({"scan.landmark-unsure"_id, "warning", text, name});
    }
  }
}

} // namespace sloper::body

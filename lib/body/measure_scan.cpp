#include <base/units.hpp>
#include <body/canonical_frame.hpp>
#include <body/crotch.hpp>
#include <body/measure_scan.hpp>
#include <body/part_labels.hpp>
#include <body/skin_profile.hpp>
#include <body/skin_surface.hpp>
#include <io/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace sloper::body {

namespace {

constexpr const char* ESSENTIAL[] = {"head_tip",         "crotch",           "hip_center", "neck_center", "neck_back",  "neck_front",
                                     "shoulder_joint_l", "shoulder_joint_r", "hand_tip_l", "hand_tip_r",  "acromion_l", "acromion_r",
                                     "hip_joint_l",      "hip_joint_r",      "ankle_l",    "ankle_r"};

void describe_stance(Body& body, const std::array<ArmTrace, 2>& arms) {
  double sum = 0;
  int n = 0;
  for (int side = 0; side < 2; ++side) {
    if (arms[side].sections.empty()) continue;
    const double deg = units::degrees(std::acos(std::clamp(-arms[side].out.y(), -1.0, 1.0)));
    (side == 0 ? body.arm_l_deg : body.arm_r_deg) = deg;
    sum += deg, ++n;
  }
  const double mean = n ? sum / n : 0;
  body.stance_class = mean > 70 ? "T" : mean > 15 ? "A" : "I";
}

/// What a user should know of this scan, good or bad.
void add_findings(Body& body, const SortedScan& sorted, const SkinSurface& skin) {
  char text[160];
  auto add = [&](const char* severity, const char* place) { body.scan.findings.push_back({severity, text, place}); };
  std::snprintf(text, sizeof text, "up is %s: score %.2f against %.2f for the next best direction", sorted.up_name.c_str(), sorted.up_score,
                std::max(0.0, sorted.next_score));
  add(sorted.up_score - sorted.next_score < 0.15 && sorted.next_score > 0 ? "warning" : "info", "scan");
  std::snprintf(text, sizeof text, "roughness %.1f mm", 1000 * skin.noise_m);
  add("info", "skin");
  if (sorted.has_floor) {
    std::snprintf(text, sizeof text, "a floor was left out");
    add("info", "feet");
  }
  if (sorted.n_debris) {
    std::snprintf(text, sizeof text, "%d loose pieces were left out", sorted.n_debris);
    add("info", "scan");
  }
  std::snprintf(text, sizeof text, "stance %s: arms %.0f and %.0f degrees from hanging down", body.stance_class.c_str(), body.arm_l_deg, body.arm_r_deg);
  add("info", "arms");
}

void shift(Body& body, const Vec3& by) {
  for (auto& [name, landmark] : body.landmarks) {
    landmark.p += by;
    for (Vec3& p : landmark.alternatives) p += by;
  }
  for (Vec3& p : body.skin.positions) p += by;
}

} // namespace

MeasuredScan measure_scan(const TriangleMesh& scan, const std::string& file, const std::string& sha256, const ScanOptions& options, Reporter& reporter) {
  MeasuredScan result;
  Body& body = result.body;
  const SortedScan sorted = sort_scan(scan, options.up);
  const CanonicalFrame frame = guess_frame(scan, sorted, options.unit, file);
  body.scan = {io::file_name(file),
               sha256,
               frame.unit,
               sorted.up_name,
               frame.front,
               static_cast<int>(scan.positions.size()),
               static_cast<int>(scan.triangles.size()),
               frame.stature_m,
               frame.findings};
  std::vector<Vec3> positions(scan.positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v) positions[v] = transform(frame.scan_to_body, scan.positions[v]);
  reporter.info("unit " + frame.unit + ", up " + sorted.up_name + ", stature " + std::to_string(frame.stature_m) + " m");
  SkinSurface skin = make_skin(positions, scan.triangles, sorted.is_body, frame.stature_m);
  body.skin = std::move(skin.mesh);
  body.scan.findings.insert(body.scan.findings.end(), skin.findings.begin(), skin.findings.end());

  const double s = frame.stature_m;
  LevelStack levels(body.skin, s, 0.0025 * s, skin.rebuilt ? 0.002 : 0);
  std::vector<Vec3> scan_points;
  for (std::size_t v = 0; v < positions.size(); ++v)
    if (sorted.is_body[v]) scan_points.push_back(positions[v]);
  const bool crotch_moved = doubt_crotch(levels, scan_points, body.scan.findings, result.trail);
  const EdgeGraph graph(body.skin);
  const std::array<ArmTrace, 2> arms = trace_arms(levels, graph, skin.rebuilt ? scan_points : std::vector<Vec3>{});
  describe_stance(body, arms);
  for (const ArmTrace& arm : arms) {
    if (arm.sections.empty()) {
      result.trail.push_back(std::string("arm ") + (arm.left ? "left" : "right") + ": cannot be told from the trunk");
      continue;
    }
    char line[200];
    std::snprintf(line, sizeof line, "arm %s: %zu sections, %.3f m from the hand to the trunk, last girth %.3f m, pit %s", arm.left ? "left" : "right",
                  arm.sections.size(), arm.length(), arm.sections.back().girth, arm.axilla ? "found" : "not found");
    result.trail.push_back(line);
  }
  const std::vector<Vec3> normals = vertex_normals(body.skin);
  const FigureClass figure = classify_figure(levels, arms, normals, options.rules, result.trail);
  const Finder finder{levels, arms, normals, scan_points, skin.rebuilt, crotch_moved, options.rules, figure, body, result.trail, s};
  find_leg_landmarks(finder);
  find_head_landmarks(finder);
  find_arm_landmarks(finder);
  find_trunk_landmarks(finder);
  find_girths(finder);
  name_body_class(finder);
  const std::vector<Part> skin_part = label_skin(finder);
  body.face_part = label_faces(body.skin.triangles, skin_part);
  result.vertex_part = label_scan(positions, sorted.is_body, skin.of_scan, body.skin, skin_part, 0.03 * s);
  // the origin goes below the middle of the hip joints
  Vec3 origin = Vec3::Zero();
  if (body.has_landmark("hip_center")) origin = Vec3(-body.landmark("hip_center").x(), 0, -body.landmark("hip_center").z());
  shift(body, origin);
  body.scan_to_body = turn_and_shift(0, origin) * frame.scan_to_body;
  build_frames(body);
  build_bones(body);
  add_findings(body, sorted, skin);
  for (const char* name : ESSENTIAL)
    if (!body.has_landmark(name)) {
      result.missing.push_back(name);
      body.scan.findings.push_back({"error", "landmark not found", name});
    }
  return result;
}

} // namespace sloper::body

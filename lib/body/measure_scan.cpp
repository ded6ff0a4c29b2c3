#include <Eigen/Geometry>
#include <body/ingest/canonical_frame.hpp>
#include <body/ingest/loose_parts.hpp>
#include <body/ingest/torso_only.hpp>
#include <body/ingest/upright.hpp>
#include <body/ingest/vertical.hpp>
#include <body/landmarks/crotch.hpp>
#include <body/landmarks/dependents.hpp>
#include <body/landmarks/gate.hpp>
#include <body/landmarks/made_up_skin.hpp>
#include <body/landmarks/second_opinion.hpp>
#include <body/part_labels.hpp>
#include <body/scan_findings.hpp>
#include <body/skin_profile.hpp>
#include <body/surface/head_sacs.hpp>
#include <body/surface/skin_surface.hpp>
#include <body/surface/touching_skin.hpp>
#include <sloper/base/random.hpp>
#include <sloper/base/units.hpp>
#include <sloper/body/measure_scan.hpp>
#include <sloper/io/json_fwd.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

namespace sloper::body {

namespace {

/// 1 for the skin that cloth lies on and between: all but head, hands and feet, whose folds are no
/// concern of cloth.
std::vector<char> dressed_skin(const Body& body, const std::vector<Part>& part) {
  std::vector<char> dressed(part.size(), 1);
  const double ankle = body.has_landmark("ankle_l") && body.has_landmark("ankle_r")
                           ? std::max(body.landmark("ankle_l").y(), body.landmark("ankle_r").y())
                           : 0.06 * body.scan.stature_m;
  for (std::size_t v = 0; v < part.size(); ++v) {
    const Vec3& p = body.skin.positions[v];
    if (part[v] == Part::HEAD || part[v] == Part::NONE || p.y() < ankle)
      dressed[v] = 0;
    if (part[v] != Part::ARM_L && part[v] != Part::ARM_R)
      continue;
    const std::string side = part[v] == Part::ARM_L ? "_l" : "_r";
    if (!body.has_landmark("wrist" + side) || !body.has_landmark("hand_tip" + side))
      continue;
    const Vec3 wrist = body.landmark("wrist" + side);
    if ((p - wrist).dot(body.landmark("hand_tip" + side) - wrist) > 0)
      dressed[v] = 0;
  }
  return dressed;
}

/// m between parts that touch: two layers of cloth and their contact.
constexpr double CLOTH_BETWEEN = 0.004;
constexpr const char* ESSENTIAL[] = {
    "head_tip",         "crotch",           "hip_center", "neck_center", "neck_back",  "neck_front",
    "shoulder_joint_l", "shoulder_joint_r", "hand_tip_l", "hand_tip_r",  "acromion_l", "acromion_r",
    "hip_joint_l",      "hip_joint_r",      "ankle_l",    "ankle_r"};

/// What a torso without head, legs or arms need not show.
bool may_lack(const std::string& name) {
  return name == "head_tip" || name == "crotch" || name.starts_with("hip") ||
         name.starts_with("ankle") || name.starts_with("hand_tip") ||
         name.starts_with("shoulder") || name.starts_with("acromion");
}

constexpr int STANDARD_JITTER = 3;
constexpr std::size_t MOST_FACES_TO_JITTER =
    80'000;                      ///< beyond, three more runs of the rules would cost a second
constexpr double UNSURE = 0.012; ///< of stature: a landmark that moves as much by a little jitter

void describe_stance(Body& body, const std::array<ArmTrace, 2>& arms) {
  double sum = 0;
  int n = 0;
  for (int side = 0; side < 2; ++side) {
    if (arms[side].sections.empty())
      continue;
    const double deg = units::degrees(std::acos(std::clamp(-arms[side].out.y(), -1.0, 1.0)));
    (side == 0 ? body.arm_l_deg : body.arm_r_deg) = deg;
    sum += deg;
    ++n;
  }
  body.stance_class = stance_of(n ? sum / n : 0);
}

/// How far the shape is from the bodies learned from, for --explain.
void describe_likeness(const Corrections& corrections, MeasuredScan& result) {
  char text[160];
  std::snprintf(text, sizeof text, "shape: %.2f standard deviations from the bodies learned from",
                corrections.unlikeness(result.features));
  result.trail.emplace_back(text);
  std::string line = "shape: distance from each make of bodies";
  for (const double d : corrections.distances(result.features)) {
    std::snprintf(text, sizeof text, " %.2f", d);
    line += text;
  }
  std::snprintf(text, sizeof text, ", alike to %.2f", corrections.likeness(result.features));
  result.trail.push_back(line + text);
}

void shift(Body& body, const Vec3& by) {
  for (auto& [name, landmark] : body.landmarks) {
    landmark.p += by;
    for (Vec3& p : landmark.alternatives)
      p += by;
  }
  for (Vec3& p : body.skin.positions)
    p += by;
}

/// Says after each phase how long it took; with -v only, and nothing depends on it.
class Phases {
public:
  explicit Phases(Reporter& reporter) : m_reporter(reporter) {}
  void done(const char* phase) {
    const auto now = std::chrono::steady_clock::now();
    char text[80];
    std::snprintf(text, sizeof text, "%s: %.3f s", phase,
                  std::chrono::duration<double>(now - m_last).count());
    m_reporter.info(text);
    m_last = now;
  }

private:
  Reporter& m_reporter;
  std::chrono::steady_clock::time_point m_last = std::chrono::steady_clock::now();
};

struct RuleInput {
  const std::vector<Vec3>& scan_points; ///< the scan's own points of the body, body frame
  /// Vertices and points spread over the scan's larger faces about the height of a crotch: a coarse
  /// mesh has few vertices there.
  const std::vector<Vec3>& seat_points;
  const MadeUpSkin& made_up;
  bool rebuilt, whole; ///< as in SkinSurface
  double s;            ///< stature, m
  Vec3 up;             ///< the likeliest vertical, unit, body frame
  const Rules& rules;
  const Corrections& corrections;
};

/// Points of the scan in the body frame, m.
std::vector<Vec3> points_in(const CanonicalFrame& frame, std::vector<Vec3> points) {
  for (Vec3& p : points)
    p = transform(frame.scan_to_body, p);
  return points;
}

/// Of points spread over the body what lies about the height of a crotch.
std::vector<Vec3> points_at_seat(const std::vector<Vec3>& spread, double stature) {
  constexpr double LOW = 0.36, HIGH = 0.6; // of stature
  std::vector<Vec3> points;
  for (const Vec3& p : spread)
    if (p.y() > LOW * stature && p.y() < HIGH * stature)
      points.push_back(p);
  return points;
}

/// All rules on body.skin; fills landmarks, levels, girths, stance and class. @return part per
/// vertex of the skin
std::vector<Part> apply_rules(const RuleInput& in, Body& body, std::vector<std::string>& trail,
                              Phases* phases, ShapeFeatures& shape) {
  LevelStack levels(body.skin, in.s, 0.0025 * in.s, in.rebuilt ? 0.002 : 0, in.up);
  if (phases)
    phases->done("slicing");
  CrotchEvidence evidence{in.seat_points, in.rules, in.rebuilt, in.whole};
  CrotchSource source = doubt_crotch(levels, evidence, body.scan.findings, trail)
                            ? CrotchSource::BUTTOCKS
                            : CrotchSource::SKIN;
  const EdgeGraph graph(body.skin);
  const std::array<ArmTrace, 2> arms =
      trace_arms(levels, graph, in.rebuilt ? in.scan_points : std::vector<Vec3>{}, in.rules);
  describe_stance(body, arms);
  for (const ArmTrace& arm : arms) {
    if (arm.sections.empty()) {
      trail.push_back(std::string("arm ") + (arm.left ? "left" : "right") +
                      ": cannot be separated from the trunk");
      continue;
    }
    char line[200];
    std::snprintf(
        line, sizeof line,
        "arm %s: %zu sections, %.3f m from the hand to the trunk, last girth %.3f m, pit %s",
        arm.left ? "left" : "right", arm.sections.size(), arm.length(), arm.sections.back().girth,
        arm.axilla ? "found" : "not found");
    trail.push_back(line);
  }
  FigureClass figure = classify_figure(levels, arms, in.rules, trail);
  shape = shape_features(levels, arms, figure.female);
  const auto expected = in.corrections.extrapolated("crotch", shape, -1);
  evidence.at_an_end = in.corrections.crotch_at_an_end(shape);
  if (expected && expect_crotch(levels, *expected, evidence, source, body.scan.findings, trail)) {
    figure = classify_figure(levels, arms, in.rules, trail);
    shape = shape_features(levels, arms, figure.female);
  }
  const Situation situation{figure.female > 0.5, body.stance_class.front(), in.rebuilt};
  const Finder finder{levels, arms,     in.scan_points, in.made_up, in.rebuilt,
                      source, in.rules, in.corrections, shape,      situation,
                      figure, body,     trail,          in.s};
  find_leg_landmarks(finder);
  find_head_landmarks(finder);
  find_arm_landmarks(finder);
  find_trunk_landmarks(finder);
  find_girths(finder);
  name_body_class(finder);
  return label_skin(finder);
}

/// Runs the rules again on the skin turned, tilted and lifted a little and made rough: the spread
/// of a landmark is the root mean square of how far it moves, and one that is lost in some of the
/// runs loses confidence by their share.
void measure_spread(const RuleInput& in, int runs, double noise_m, Body& body, Reporter& reporter) {
  struct Sum {
    double squares = 0;
    int n = 0;
    double rms() const { return n ? std::sqrt(squares / n) : 0; }
  };
  std::map<std::string, Sum> landmarks, girths, heights, level_girths;
  const std::vector<Vec3> normals = runs > 0 ? vertex_normals(body.skin) : std::vector<Vec3>{};
  const double sigma = std::clamp(noise_m, 0.0004, 0.001);
  for (int run = 0; run < runs && !reporter.stop_requested(); ++run) {
    Random random(static_cast<std::uint64_t>(run) + 1);
    auto angle = [&](double degrees) { return units::radians(random.uniform(-degrees, degrees)); };
    const double about_z = angle(0.5), about_x = angle(0.5), about_y = angle(1.5);
    const Eigen::Matrix3d turn =
        (Eigen::AngleAxisd(about_y, Vec3::UnitY()) * Eigen::AngleAxisd(about_x, Vec3::UnitX()) *
         Eigen::AngleAxisd(about_z, Vec3::UnitZ()))
            .toRotationMatrix();
    const Vec3 lift(0, random.uniform(0, 0.0025) * in.s, 0); // where the slices lie
    Body trial;
    trial.scan.stature_m = body.scan.stature_m;
    trial.skin.triangles = body.skin.triangles;
    trial.skin.positions.reserve(body.skin.positions.size());
    for (std::size_t v = 0; v < body.skin.positions.size(); ++v) {
      double bump = -2;
      for (int k = 0; k < 4; ++k)
        bump += random.uniform();
      trial.skin.positions.push_back(
          turn * (body.skin.positions[v] + 1.7 * sigma * bump * normals[v]) + lift);
    }
    std::vector<Vec3> points;
    points.reserve(in.scan_points.size());
    for (const Vec3& p : in.scan_points)
      points.push_back(turn * p + lift);
    std::vector<Vec3> seat_points;
    seat_points.reserve(in.seat_points.size());
    for (const Vec3& p : in.seat_points)
      seat_points.push_back(turn * p + lift);
    MadeUpSkin made_up{in.made_up.far_m, {}};
    for (const Vec3& p : in.made_up.middles)
      made_up.middles.push_back(turn * p + lift);
    std::vector<std::string> unheard;
    ShapeFeatures shape;
    apply_rules({points, seat_points, made_up, in.rebuilt, in.whole, in.s, turn * in.up, in.rules,
                 in.corrections},
                trial, unheard, nullptr, shape);
    auto add = [](Sum& sum, double miss) {
      sum.squares += miss * miss;
      ++sum.n;
    };
    for (const auto& [name, landmark] : trial.landmarks)
      if (body.has_landmark(name))
        add(landmarks[name], (turn.transpose() * (landmark.p - lift) - body.landmark(name)).norm());
    for (const auto& [name, girth] : trial.girths)
      if (const auto it = body.girths.find(name); it != body.girths.end())
        add(girths[name], girth.value_m - it->second.value_m);
    for (const auto& [name, level] : trial.levels)
      if (const auto it = body.levels.find(name); it != body.levels.end()) {
        add(heights[name], level.y - lift.y() - it->second.y);
        add(level_girths[name], level.girth_m - it->second.girth_m);
      }
  }
  for (auto& [name, landmark] : body.landmarks) {
    landmark.spread_m = std::max(landmarks[name].rms(), 1e-4);
    landmark.confidence *= 0.5 + 0.5 * landmarks[name].n / runs;
    if (landmark.spread_m > UNSURE * in.s)
      landmark.confidence *= 0.7;
  }
  // a length that does not move may still be off by what its rule usually is
  for (auto& [name, girth] : body.girths)
    girth.spread_m = std::max(girth.spread_m, girths[name].rms());
  for (auto& [name, level] : body.levels) {
    level.y_spread_m = heights[name].rms();
    level.girth_spread_m = level_girths[name].rms();
  }
}

std::string point_text(const Vec3& p) {
  char text[80];
  std::snprintf(text, sizeof text, "(%.3f, %.3f, %.3f)", p.x(), p.y(), p.z());
  return text;
}

} // namespace

MeasuredScan measure_scan(const TriangleMesh& as_given, const std::string& file,
                          const std::string& sha256, const ScanOptions& options,
                          Reporter& reporter) {
  for (std::size_t v = 0; v < as_given.positions.size();
       ++v) // the readers refuse such files; a caller may hand over anything
    if (!as_given.positions[v].allFinite())
      throw input_error("scan.not-finite"_id, file, "vertex " + std::to_string(v + 1),
                        "is not a finite number");
  MeasuredScan result;
  Body& body = result.body;
  Phases phases(reporter);
  const LooseParts loose =
      options.torso_only ? LooseParts{} : find_loose_parts(as_given, options.up);
  SegmentedScan sorted = segment_without(loose.is_extra, as_given, options.up);
  // a scan that lies or leans in its file is set upright first
  std::optional<Eigen::Matrix3d> upright;
  if (options.up == "auto" && !options.torso_only)
    upright = upright_turn(as_given, sorted);
  TriangleMesh turned;
  if (upright) {
    turned.triangles = as_given.triangles;
    turned.positions.reserve(as_given.positions.size());
    for (const Vec3& p : as_given.positions)
      turned.positions.push_back(*upright * p);
    sorted = segment_without(loose.is_extra, turned, "y");
    const Vec3 up = upright->row(1).transpose();
    char text[80];
    std::snprintf(text, sizeof text, "%.4f %.4f %.4f", up.x(), up.y(), up.z());
    sorted.up_name = text;
  }
  const TriangleMesh& given = upright ? turned : as_given;
  CompletedTorso torso; // a scan of the torso alone stands on plain legs until the rules are done
  const bool is_torso =
      options.torso_only &&
      !(shows_a_person(sorted) && sorted.up_score > 0.8); // hanging arms look a little like legs
  if (is_torso) {
    torso = complete_torso(given, options.up,
                           {options.stature_m, options.metres_per_unit, options.unit}, file);
    int up_axis = torso.up.y() != 0 ? 1 : 2;
    if (torso.up.cwiseAbs().maxCoeff() == std::abs(torso.up.x()))
      up_axis = 0;
    sorted = segment_scan(torso.scan, {"xyz"[up_axis]});
  }
  const std::vector<char> labelled = sorted.is_body; // the rim of a torso is body, but no skin
  for (std::size_t v = 0; v < torso.is_cut.size(); ++v)
    if (torso.is_cut[v])
      sorted.is_body[v] = 0;
  const TriangleMesh& scan = is_torso ? torso.scan : given;
  const std::vector<Vec3> shape = points_of_body(scan, sorted.is_body, SHAPE_POINTS);
  CanonicalFrame frame = guess_frame(
      scan, sorted, shape, {options.stature_m, options.metres_per_unit, options.unit}, file);
  // the same body gets the same vertical however it lies in its file; a floor, or a user, knows
  // better
  const Mat4 as_in_file = frame.scan_to_body;
  if (options.up == "auto" && !is_torso && (upright || !sorted.has_floor))
    settle_vertical(scan, shape, sorted, frame, !upright);
  const bool is_own_vertical = upright || frame.scan_to_body != as_in_file;
  frame.findings.insert(frame.findings.end(), loose.findings.begin(), loose.findings.end());
  body.scan = {io::file_name(file),
               sha256,
               frame.unit,
               sorted.up_name,
               frame.front,
               static_cast<int>(given.positions.size()),
               static_cast<int>(given.triangles.size()),
               frame.stature_m,
               frame.findings};
  std::vector<Vec3> positions(scan.positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v)
    positions[v] = transform(frame.scan_to_body, scan.positions[v]);
  reporter.info("unit " + frame.unit + ", up " + sorted.up_name + ", stature " +
                std::to_string(frame.stature_m) + " m");
  SkinSurface skin =
      make_skin(positions, scan.triangles, sorted.is_body, frame.stature_m, torso.lacks);
  body.skin = std::move(skin.mesh);
  phases.done("frame and skin");
  body.scan.findings.insert(body.scan.findings.end(), skin.findings.begin(), skin.findings.end());

  const double s = frame.stature_m;
  std::vector<Vec3> scan_points;
  for (std::size_t v = 0; v < positions.size(); ++v)
    if (sorted.is_body[v])
      scan_points.push_back(positions[v]);
  const std::vector<Vec3> shape_points = points_in(frame, shape);
  const double lean = is_own_vertical ? likeliest_lean(shape_points, s) : 0;
  const Vec3 up = Vec3(0, std::cos(lean), std::sin(lean));
  const std::vector<Vec3> seat_points = points_at_seat(shape_points, s);
  const MadeUpSkin made_up =
      skin.whole ? MadeUpSkin{} : made_up_skin(body.skin, s, scan_points, shape_points);
  const RuleInput input{scan_points, seat_points, made_up,       skin.rebuilt,        skin.whole,
                        s,           up,          options.rules, *options.corrections};
  reporter.progress("rules", -1);
  const std::vector<Part> skin_part =
      apply_rules(input, body, result.trail, &phases, result.features);
  if (!is_torso) {
    const std::vector<Finding> opinions =
        second_opinions(body, *options.corrections, result.features, skin.rebuilt, result.trail);
    body.scan.findings.insert(body.scan.findings.end(), opinions.begin(), opinions.end());
  }
  phases.done("rules");
  const int usual_jitter = body.skin.triangles.size() < MOST_FACES_TO_JITTER ? STANDARD_JITTER : 0;
  const int jitter = options.jitter >= 0 ? options.jitter : usual_jitter;
  if (jitter > 0)
    measure_spread(input, jitter, skin.noise_m, body, reporter);
  if (jitter > 0)
    phases.done("spread");
  else
    result.trail.push_back("spread: not measured, the usual one of each rule is given");
  if (!skin.whole && !is_torso)
    doubt_made_up_skin(body, made_up, confirmed_pits(body, *options.corrections, result.features));
  doubt_dependents(body, options.corrections->strangeness(result.features),
                   pits_are_low(body, *options.corrections, result.features));
  body.face_part = label_faces(body.skin.triangles, skin_part);
  result.vertex_part =
      label_scan(positions, labelled, skin.of_scan, body.skin, skin_part, 0.03 * s);
  result.vertex_part.resize(given.positions.size());
  const OpenedSkin opened =
      open_touching_skin(body.skin, dressed_skin(body, skin_part), CLOTH_BETWEEN);
  if (opened.vertices > 0) {
    char text[200];
    std::snprintf(text, sizeof text,
                  "parts touch: %d vertices of the skin drawn back by up to %.1f mm, so that cloth "
                  "finds a way between",
                  opened.vertices, 1000 * opened.largest_m);
    body.scan.findings.push_back({"scan.parts-touch"_id, "info", text, point_text(opened.place)});
  }
  if (const ClosedSacs closed = close_head_sacs(body.skin, body.face_part); closed.sacs > 0) {
    char text[200];
    std::snprintf(
        text, sizeof text,
        "the head is hollow: %d faces (%.0f cm2) of mouth and eyes that cannot be seen from "
        "outside are left out of the skin",
        closed.faces, 1e4 * closed.area_m2);
    body.scan.findings.push_back({"scan.hollow-head"_id, "info", text, point_text(closed.place)});
  }
  // the origin goes below the middle of the hip joints
  Vec3 origin = Vec3::Zero();
  if (body.has_landmark("hip_center"))
    origin = Vec3(-body.landmark("hip_center").x(), 0, -body.landmark("hip_center").z());
  shift(body, origin);
  if (is_torso) {
    const auto height = [&](double y) { return transform(frame.scan_to_body, y * torso.up).y(); };
    forget_unseen(body, {height(torso.seen_from), torso.has_head ? 1e300 : height(torso.seen_to),
                         torso.has_head});
    if (!torso.has_head)
      body.scan.findings.push_back(
          {"scan.no-head"_id, "warning",
           "without a head the neck and the bust are less sure: compare both girths with a tape",
           "scan"});
  }
  body.scan_to_body = turn_and_shift(0, origin) * frame.scan_to_body;
  if (upright) {
    body.scan_to_body.block<3, 3>(0, 0) *= *upright;
    const Vec3 facing = body.scan_to_body.block<1, 3>(2, 0).transpose().normalized();
    char text[80];
    std::snprintf(text, sizeof text, "%.4f %.4f %.4f", facing.x(), facing.y(), facing.z());
    body.scan.front = text;
    body.scan.findings.push_back(
        {"scan.set-upright"_id, "info",
         "the scan leans or lies in its file: set upright on the soles of its feet", "scan"});
  }
  build_frames(body);
  build_bones(body);
  phases.done("parts and frames");
  add_unit_finding(body,
                   options.unit != "auto" || options.metres_per_unit > 0 || options.stature_m > 0);
  add_findings(body, sorted, skin);
  add_holes(body, skin.holes, origin);
  describe_likeness(*options.corrections, result);
  for (const Finding& finding : body.scan.findings)
    if (finding.severity == "error" && !is_torso)
      result.doubts.push_back(finding);
  if (!is_torso || !torso.has_head)
    for (const Finding& doubt :
         doubts_of(body, options.corrections->strangeness(result.features))) {
      body.scan.findings.push_back(doubt);
      if (doubt.severity == "error")
        result.doubts.push_back(doubt);
    }
  for (const char* name : ESSENTIAL)
    if (!body.has_landmark(name) && !(is_torso && may_lack(name))) {
      result.missing.push_back(name);
      body.scan.findings.push_back(
          {"scan.landmark-not-found"_id, "error", "landmark not found", name});
    }
  if (!is_torso)
    add_missing(body);
  return result;
}

} // namespace sloper::body

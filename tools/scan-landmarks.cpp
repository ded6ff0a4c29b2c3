/// scan-landmarks: a raw 3D body scan to landmarks, levels, girths, parts, frames and a skin.
#include <sloper/body/body_json.hpp>
#include <sloper/body/export/exports.hpp>
#include <sloper/body/measure_scan.hpp>
#include <sloper/cli/run_tool.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/json_fwd.hpp>
#include <sloper/io/scan_reader.hpp>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>

using namespace sloper;

namespace {

struct Options {
  std::string scan, output, rules, corrections, features, parts, csv, skeleton, vit, garmentcode,
      pose;
  std::string unit = "auto", up = "auto";
  double pose_fps = 30, metres_per_unit = 0, stature_m = 0;
  int jitter = -1;
  bool explain = false, anonymise = false, torso_only = false;
};

void write_parts(const std::string& path, const std::vector<body::Part>& parts) {
  std::string bytes(parts.size(), '\0');
  for (std::size_t v = 0; v < parts.size(); ++v)
    bytes[v] = static_cast<char>(parts[v]);
  io::write_file(path, bytes);
}

/// A line a feature: its name, left, right; nothing where the body does not show it.
std::string features_text(const body::ShapeFeatures& features) {
  std::string text = "feature,left,right\n";
  const std::vector<std::string>& names = body::shape_feature_names();
  for (std::size_t k = 0; k < names.size(); ++k) {
    text += names[k];
    for (const std::vector<double>& side : features.side) {
      char number[40] = ",";
      if (std::isfinite(side[k]))
        std::snprintf(number, sizeof number, ",%.7g", side[k]);
      text += number;
    }
    text += "\n";
  }
  return text;
}

/// A pose changes the body; a motion writes a sequence of skins beside it.
void strike_pose(cli::Tool& tool, const Options& o, body::Body& body) {
  const body::SkinWeights weights = body::skin_weights(body);
  if (o.pose.size() > 4 && o.pose.substr(o.pose.size() - 4) == ".bvh") {
    const body::Motion motion = body::read_bvh(o.pose, body, o.pose_fps > 0 ? 1 / o.pose_fps : 0);
    body::write_motion(o.output, body, weights, motion, tool.name(), tool.reporter());
    tool.reporter().info(std::to_string(motion.poses.size()) + " poses, " +
                         std::to_string(motion.frame_s) + " s apart");
  } else
    body = body::posed_body(body, weights, body::read_pose(o.pose, body));
}

/// What is estimated or not found, a line each, and the widest hole; a scanner leaves a dozen, and
/// a surface that must be closed again.
void tell_findings(cli::Tool& tool, const std::string& file, const body::Body& body) {
  std::size_t n_holes = 0;
  Message widest{"scan.hole"_id, ""};
  for (const body::Finding& finding : body.scan.findings) {
    if (finding.severity != "warning")
      continue; // landmarks that were not found are reported at the end
    const std::string text = file + ": " + finding.place + ": " + finding.what;
    const bool is_hole =
        finding.place[0] == '('; // its place is a point, and they come widest first
    if (is_hole && n_holes++ == 0)
      widest.text = text;
    if (is_hole || finding.place == "body.obj")
      tool.reporter().info(text);
    else
      tool.reporter().warning(Message::read(finding.id, text));
  }
  if (n_holes > 1)
    widest.text += ", and " + std::to_string(n_holes - 1) + " less wide: scan.findings has them";
  if (n_holes > 0)
    tool.reporter().warning(widest);
}

/// OBJ is a format of meshes: one without faces may be a mesh that lost its end, where they stand.
void tell_missing_faces(cli::Tool& tool, const std::string& file, const io::Scan& scan) {
  if (scan.format == "obj" && scan.mesh.triangles.empty())
    tool.reporter().warning(
        {"scan.no-faces"_id,
         io::file_name(file) + " has points and no faces, and the skin is made up between them; if "
                               "it should have faces it was cut off: copy it again"});
}

bool stands(const body::MeasuredScan& measured) {
  return measured.doubts.empty() && measured.missing.empty();
}

/// The pose that the meshes of `o.scan` were bound in, where that is another than is shown and a
/// person stands in it.
std::optional<body::MeasuredScan> measure_bound(cli::Tool& tool, const Options& o,
                                                const io::Scan& shown,
                                                const body::ScanOptions& options) {
  const io::Scan bound = io::read_scan(o.scan, io::SkinPose::BIND);
  if (bound.mesh.positions == shown.mesh.positions)
    return std::nullopt;
  try {
    body::MeasuredScan measured =
        body::measure_scan(bound.mesh, o.scan, bound.sha256, options, tool.reporter());
    if (!stands(measured))
      return std::nullopt;
    measured.body.scan.findings.push_back(
        {"scan.bind-pose"_id, "warning",
         "as its joints hold it, the figure does not stand: it is measured in the pose in which it "
         "was bound to them",
         "scan"});
    return measured;
  } catch (const Error& e) {
    tool.reporter().info(std::string("the bind pose is no standing person either: ") + e.what());
    return std::nullopt;
  }
}

/// As the scan is shown, or, of a figure that its joints hold in another pose, as it was bound.
body::MeasuredScan measure(cli::Tool& tool, const Options& o, const io::Scan& scan,
                           const body::ScanOptions& options) {
  try {
    body::MeasuredScan measured =
        body::measure_scan(scan.mesh, o.scan, scan.sha256, options, tool.reporter());
    if (stands(measured))
      return measured;
    auto bound = measure_bound(tool, o, scan, options);
    return bound ? std::move(*bound) : std::move(measured);
  } catch (const Error& e) {
    if (e.kind() != ErrorKind::INPUT)
      throw;
    if (auto bound = measure_bound(tool, o, scan, options))
      return std::move(*bound);
    throw;
  }
}

int run(cli::Tool& tool, const Options& o) {
  const bool is_sized = o.metres_per_unit > 0 || o.stature_m > 0;
  if (is_sized && o.unit != "auto")
    tool.reporter().warning({"scan.unit-overruled"_id,
                             "--unit " + o.unit +
                                 " is not used: " + (o.stature_m > 0 ? "--stature" : "--scale") +
                                 " says the size; leave one of them out"});
  body::ScanOptions options;
  options.unit = o.unit;
  options.metres_per_unit = o.metres_per_unit;
  options.stature_m = o.stature_m;
  options.up = o.up;
  options.jitter = o.jitter;
  options.torso_only = o.torso_only;
  if (!o.rules.empty())
    options.rules = body::Rules::read(o.rules);
  body::Corrections corrections;
  if (!o.corrections.empty()) {
    corrections = body::Corrections::parse(io::read_file(o.corrections), o.corrections);
    options.corrections = &corrections;
  }
  tool.reporter().progress("reading", -1);
  const auto start = std::chrono::steady_clock::now();
  const io::Scan scan = io::read_scan(o.scan);
  char took[60];
  std::snprintf(took, sizeof took, "reading: %.3f s",
                std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  tool.reporter().info(took);
  tell_missing_faces(tool, o.scan, scan);
  body::MeasuredScan measured = measure(tool, o, scan, options);
  tool.require_not_stopped(o.output); // spreads of fewer runs are not those that were asked for
  const std::string vit = o.vit.empty() ? "" : body::valentina_measurements(measured.body);
  const std::string garmentcode =
      o.garmentcode.empty() ? "" : body::garmentcode_body(measured.body);
  if (!o.pose.empty())
    strike_pose(tool, o, measured.body);
  if (o.anonymise)
    body::anonymise(measured.body);
  body::write_body(o.output, measured.body, tool.name());
  if (!o.parts.empty())
    write_parts(o.parts, measured.vertex_part);
  if (!o.features.empty())
    io::write_file(o.features, features_text(measured.features));
  if (!o.csv.empty())
    io::write_file(o.csv, body::measurements_csv(measured.body));
  if (!o.vit.empty())
    io::write_file(o.vit, vit);
  if (!o.garmentcode.empty())
    io::write_file(o.garmentcode, garmentcode);
  if (!o.skeleton.empty())
    io::write_file(o.skeleton, body::skeleton_obj(measured.body));
  if (o.explain)
    for (const std::string& line : measured.trail)
      tool.tell(line);
  tell_findings(tool, io::file_name(o.scan), measured.body);
  if (!measured.doubts.empty()) {
    std::string doubts;
    for (const body::Finding& doubt : measured.doubts)
      doubts += (doubts.empty() ? "" : "; ") + doubt.place + ": " + doubt.what;
    throw Error(ErrorKind::FAILED, "scan.not-standing"_id, o.scan, "",
                "this does not look like a person standing upright: " + doubts,
                "the result is written to " + o.output +
                    ", with these findings; look at it before you use it");
  }
  if (measured.missing.empty())
    return 0;
  std::string names;
  for (const std::string& name : measured.missing)
    names += (names.empty() ? "" : ", ") + name;
  throw Error(ErrorKind::FAILED, "scan.landmark-not-found"_id, o.scan, "",
              "landmarks not found: " + names,
              "the rest is written to " + o.output + ", marked in scan.findings");
}

} // namespace

int main(int argc, char** argv) {
  cli::Tool tool("scan-landmarks",
                 "Find landmarks, levels, girths, parts and frames on a raw body scan");
  Options o;
  tool.option(
          "SCAN", o.scan,
          "scan of one standing person: OBJ, PLY, STL, 3DS, XYZ or PCD, mesh or bare points; glTF, "
          "FBX, Collada, OFF, X3D through assimp")
      .required()
      .check(cli::input_file());
  tool.option("--unit", o.unit, "unit of the scan's coordinates (default: auto, from the stature)")
      .check(cli::one_of({"auto", "m", "cm", "mm", "dm", "inch", "foot"}));
  tool.option("--scale", o.metres_per_unit,
              "metres in a unit of the scan's coordinates, in place of --unit")
      .check(cli::finite_in(1e-9, 1e9, "m"));
  tool.option("--stature", o.stature_m,
              "the person's stature as the scan stands, in place of --unit: for what has no unit")
      .check(cli::finite_in(0.5, 2.5, "m"));
  tool.option("--up", o.up,
              "axis along which the body stands, taken as it is (default: auto, the vertical is "
              "found from the body)")
      .check(cli::one_of({"auto", "x", "y", "z"}));
  tool.flag("--torso-only", o.torso_only,
            "take a scan without legs too: what it shows is found, stature and floor are estimated "
            "from the head; without a head give --stature");
  tool.option("--jitter", o.jitter,
              "runs of the rules on a slightly turned, lifted and roughened skin, which measure "
              "each landmark's spread (default: 3, none beyond 80,000 faces)")
      .check(cli::finite_in(0, 100, ""));
  tool.option("--rules", o.rules, "landmark rules to use in place of the built-in numbers")
      .check(cli::input_file());
  tool.option("--corrections", o.corrections,
              "learned corrections of landmarks in place of those built in "
              "(scripts/derive-corrections makes them)")
      .check(cli::input_file());
  tool.option("--features", o.features, "write what the corrections look at, as a table")
      .check(cli::output_file());
  tool.option("--parts", o.parts,
              "write one byte for each vertex of the scan: 0 head, 1 torso, 2 arm_l, 3 arm_r, 4 "
              "leg_l, 5 leg_r, 255 not body")
      .check(cli::output_file());
  tool.option("--csv", o.csv,
              "write the measurements as a table, with ISO 8559-1 names beside ours")
      .check(cli::output_file());
  tool.option("--vit", o.vit, "write the measurements for Valentina (.vit, cm)")
      .check(cli::output_file());
  tool.option("--garmentcode", o.garmentcode,
              "write the measurements as a GarmentCode body file (YAML, cm)")
      .check(cli::output_file());
  tool.option("--skeleton", o.skeleton, "write the bones as an OBJ of lines")
      .check(cli::output_file());
  tool.option("--pose", o.pose,
              "joint angles (JSON): the body is written in that pose; or BVH motion: "
              "body.0001.obj, ... are written beside it")
      .check(cli::input_file());
  tool.option("--pose-fps", o.pose_fps,
              "poses per second kept of a BVH motion; 0 keeps all (default: 30)")
      .check(cli::finite_in(0, 1000, "1/s"));
  tool.flag("--anonymise", o.anonymise,
            "drop the skin and the scan's name; keep landmarks, measurements, frames and bones");
  tool.flag("--explain", o.explain, "print the decision path to stderr");
  tool.option("-o,--output", o.output, "body.json; body.obj is written beside it")
      .required()
      .check(cli::document_file());
  tool.example("scan-landmarks -o body.json scan.obj",
               "measure a scan; unit, up axis and facing are found out");
  tool.example("scan-landmarks --unit mm --parts parts.u8 -o body.json scan.ply",
               "measure a scan in millimetres and label its vertices");
  tool.example("scan-landmarks --pose walk.bvh -o body.json scan.obj",
               "also write the body walking: body.0001.obj, body.0002.obj, ...");
  tool.formats("OBJ, PLY, STL, 3DS, XYZ, PCD, glTF, FBX, Collada, OFF, X3D",
               "body.json (version 1), OBJ");
  return tool.run(argc, argv, [&] { return run(tool, o); });
}

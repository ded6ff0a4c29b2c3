#include <sloper/base/error.hpp>
#include <sloper/base/version.hpp>
#include <sloper/body/body_json.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/json.hpp>
#include <sloper/io/obj.hpp>

#include <cmath>
#include <cstdio>

namespace sloper::body {

namespace {

using io::Json;

/// Metres are written to the micrometre: finer digits are noise and cost bytes.
double micron(double x) {
  return std::round(x * 1e6) / 1e6;
}
Json point(const Vec3& p) {
  return Json::array({micron(p.x()), micron(p.y()), micron(p.z())});
}

Json profile_json(const SkinProfile& profile) {
  Json j = Json::object();
  j["n_theta"] = profile.n_theta;
  j["n_z"] = profile.n_z;
  j["z_low"] = profile.z_low;
  j["z_high"] = profile.z_high;
  Json radius = Json::array();
  for (double r : profile.radius)
    radius.push_back(micron(r));
  j["radius"] = std::move(radius);
  return j;
}

/// @param mesh_name, mesh  file name and bytes of the skin; both empty where it is not written
Json document_of(const Body& body, const std::string& tool, const std::string& mesh_name,
                 std::string_view mesh) {
  Json j = io::new_document("body", BODY_VERSION, tool);
  Json& scan = j["scan"] = Json::object();
  scan["file"] = body.scan.file;
  scan["sha256"] = body.scan.sha256;
  scan["vertices"] = body.scan.vertices;
  scan["faces"] = body.scan.faces;
  scan["unit"] = body.scan.unit;
  scan["up"] = body.scan.up;
  scan["front"] = body.scan.front;
  scan["stature_m"] = micron(body.scan.stature_m);
  scan["findings"] = Json::array();
  for (const Finding& finding : body.scan.findings) {
    scan["findings"].push_back(
        {{"severity", finding.severity}, {"what", finding.what}, {"place", finding.place}});
    if (!finding.id.empty())
      scan["findings"].back()["id"] = finding.id;
  }
  Json matrix = Json::array();
  for (int r = 0; r < 4; ++r) {
    Json row = Json::array();
    for (int c = 0; c < 4; ++c)
      row.push_back(body.scan_to_body(r, c));
    matrix.push_back(row);
  }
  j["scan_to_body"] = matrix;
  if (!mesh_name.empty()) {
    j["mesh"] = mesh_name;
    j["mesh_faces"] = body.skin.triangles.size(); // an OBJ that was cut off is still an OBJ
    io::put_mesh_hash(j, mesh);
  }
  j["stance"] = {{"class", body.stance_class},
                 {"arm_l_deg", micron(body.arm_l_deg)},
                 {"arm_r_deg", micron(body.arm_r_deg)}};
  Json& landmarks = j["landmarks"] = Json::object();
  for (const auto& [name, landmark] : body.landmarks) {
    Json entry = {{"p", point(landmark.p)},
                  {"step", landmark.step},
                  {"rule", landmark.rule},
                  {"confidence", micron(landmark.confidence)},
                  {"spread_m", micron(landmark.spread_m)}};
    entry["alternatives"] = Json::array();
    for (const Vec3& p : landmark.alternatives)
      entry["alternatives"].push_back(point(p));
    landmarks[name] = std::move(entry);
  }
  Json& levels = j["levels"] = Json::object();
  for (const auto& [name, level] : body.levels)
    levels[name] = {{"y", micron(level.y)},
                    {"girth_m", micron(level.girth_m)},
                    {"width_m", micron(level.width_m)},
                    {"depth_m", micron(level.depth_m)},
                    {"rule", level.rule}};
  Json& girths = j["girths"] = Json::object();
  for (const auto& [name, girth] : body.girths)
    girths[name] = {{"value_m", micron(girth.value_m)}, {"spread_m", micron(girth.spread_m)}};
  Json& frames = j["frames"] = Json::object();
  for (const auto& [name, frame] : body.frames) {
    Json entry = Json::object();
    entry["lower"] = io::to_json(frame.frame.lower);
    entry["upper"] = io::to_json(frame.frame.upper);
    entry["theta_zero"] = io::to_json(frame.frame.theta_zero);
    entry["mirrored"] = frame.frame.mirrored;
    entry["profile"] = profile_json(frame.profile);
    frames[name] = std::move(entry);
  }
  Json& bones = j["bones"] = Json::array();
  for (const Bone& bone : body.bones)
    bones.push_back({{"name", bone.name},
                     {"parent", bone.parent},
                     {"head", point(bone.head)},
                     {"tail", point(bone.tail)}});
  j["body_class"] = {{"class", body.body_class}, {"why", body.body_class_why}};
  return j;
}

SkinProfile read_profile(const io::Node& node) {
  SkinProfile profile;
  profile.n_theta = node.at("n_theta").integer();
  profile.n_z = node.at("n_z").integer();
  profile.z_low = node.at("z_low").number();
  profile.z_high = node.at("z_high").number();
  const io::Node radius = node.at("radius");
  if (profile.n_theta < 1 || profile.n_z < 1 || profile.n_theta > 10000 || profile.n_z > 10000 ||
      radius.size() != static_cast<std::size_t>(profile.n_theta) * profile.n_z)
    node.fail("json.wrong-count"_id, "does not hold n_theta * n_z radii");
  if (!(profile.z_high > profile.z_low))
    node.fail("body.bad-frame"_id, "z_high is not above z_low");
  profile.radius.reserve(radius.size());
  for (const Json& r : radius.json()) {
    if (!r.is_number() || !(r.get<double>() > 0))
      radius.fail("json.out-of-range"_id, "a radius is not a positive number");
    profile.radius.push_back(r.get<double>());
  }
  return profile;
}

void read_scan_info(const io::Node& node, ScanInfo& scan) {
  scan.file = node.string("file", "");
  scan.sha256 = node.string("sha256", "");
  scan.vertices = node.integer("vertices", 0);
  scan.faces = node.integer("faces", 0);
  scan.unit = node.string("unit", "");
  scan.up = node.string("up", "");
  scan.front = node.string("front", "");
  scan.stature_m = node.number("stature_m", 0);
  if (!node.has("findings"))
    return;
  const io::Node findings = node.at("findings");
  for (std::size_t i = 0; i < findings.size(); ++i) {
    Finding& finding = scan.findings.emplace_back();
    finding.id = findings.at(i).string("id", "");
    finding.severity = findings.at(i).string("severity", "info");
    finding.what = findings.at(i).string("what", "");
    finding.place = findings.at(i).string("place", "");
  }
}

void read_frames(const io::Node& node, Body& body) {
  for (const std::string& name : node.keys()) {
    const io::Node entry = node.at(name);
    BodyFrame frame;
    frame.frame.lower = entry.at("lower").vec3();
    frame.frame.upper = entry.at("upper").vec3();
    frame.frame.theta_zero = entry.at("theta_zero").vec3();
    frame.frame.mirrored = entry.boolean("mirrored", false);
    if (frame.frame.length() < 1e-6)
      entry.fail("body.bad-frame"_id, "lower and upper centre coincide");
    if (std::abs(frame.frame.theta_zero.norm() - 1) > 1e-3 ||
        std::abs(frame.frame.theta_zero.dot(frame.frame.axis())) > 1e-3)
      entry.fail("body.bad-frame"_id, "theta_zero is not a unit vector square to the axis");
    frame.profile = read_profile(entry.at("profile"));
    body.frames[name] = std::move(frame);
  }
}

void read_skin(const std::string& path, Body& body) {
  io::ObjMesh obj = io::read_obj(path);
  body.face_part.assign(obj.triangles.size(), Part::NONE);
  for (std::size_t g = 0; g < obj.groups.size(); ++g) {
    const auto part = part_from_name(obj.groups[g].name);
    if (!part)
      continue;
    const std::size_t end = g + 1 < obj.groups.size()
                                ? static_cast<std::size_t>(obj.groups[g + 1].first_triangle)
                                : obj.triangles.size();
    for (std::size_t t = static_cast<std::size_t>(obj.groups[g].first_triangle); t < end; ++t)
      body.face_part[t] = *part;
  }
  body.skin.positions = std::move(obj.positions);
  body.skin.triangles = std::move(obj.triangles);
}

} // namespace

Body read_body(const std::string& path) {
  const Json document = io::read_document(path, "body", BODY_VERSION);
  const io::Node root(document, path);
  Body body;
  read_scan_info(root.at("scan"), body.scan);
  const io::Node matrix = root.at("scan_to_body");
  if (matrix.size() != 4)
    matrix.fail("json.wrong-type"_id, "is not a 4x4 matrix");
  for (std::size_t r = 0; r < 4; ++r)
    for (std::size_t c = 0; c < 4; ++c)
      body.scan_to_body(static_cast<int>(r), static_cast<int>(c)) = matrix.at(r).at(c).number();
  if (root.has("stance")) {
    const io::Node stance = root.at("stance");
    body.stance_class = stance.string("class", "");
    body.arm_l_deg = stance.number("arm_l_deg", 0);
    body.arm_r_deg = stance.number("arm_r_deg", 0);
  }
  const io::Node landmarks = root.at("landmarks");
  for (const std::string& name : landmarks.keys()) {
    const io::Node entry = landmarks.at(name);
    Landmark landmark;
    landmark.p = entry.at("p").vec3();
    landmark.step = entry.integer("step", 1);
    landmark.rule = entry.string("rule", "");
    landmark.confidence = entry.number("confidence", 0);
    landmark.spread_m = entry.number("spread_m", 0);
    if (entry.has("alternatives"))
      for (std::size_t i = 0; i < entry.at("alternatives").size(); ++i)
        landmark.alternatives.push_back(entry.at("alternatives").at(i).vec3());
    body.landmarks[name] = std::move(landmark);
  }
  if (root.has("levels"))
    for (const std::string& name : root.at("levels").keys()) {
      const io::Node entry = root.at("levels").at(name);
      body.levels[name] = {entry.at("y").number(), entry.number("girth_m", 0),
                           entry.number("width_m", 0), entry.number("depth_m", 0),
                           entry.string("rule", "")};
    }
  if (root.has("girths"))
    for (const std::string& name : root.at("girths").keys())
      body.girths[name] = {root.at("girths").at(name).at("value_m").number(),
                           root.at("girths").at(name).number("spread_m", 0)};
  read_frames(root.at("frames"), body);
  if (root.has("bones"))
    for (std::size_t i = 0; i < root.at("bones").size(); ++i) {
      const io::Node bone = root.at("bones").at(i);
      body.bones.push_back({bone.at("name").string(), bone.string("parent", ""),
                            bone.at("head").vec3(), bone.at("tail").vec3()});
    }
  if (root.has("body_class")) {
    body.body_class = root.at("body_class").string("class", "");
    if (root.at("body_class").has("why"))
      for (std::size_t i = 0; i < root.at("body_class").at("why").size(); ++i)
        body.body_class_why.push_back(root.at("body_class").at("why").at(i).string());
  }
  if (root.has("mesh") && root.at("mesh").is_string()) { // --anonymise leaves it out
    const std::string mesh_path = io::file_beside(root.at("mesh"));
    read_skin(mesh_path, body);
    body.file_findings = io::mesh_findings(root, mesh_path);
    const int faces = std::ssize(body.skin.triangles);
    if (const int expected = root.integer("mesh_faces", faces); faces != expected)
      throw input_error("body.mesh-differs"_id, mesh_path, "",
                        "has " + std::to_string(faces) + " faces where " + io::file_name(path) +
                            " says " + std::to_string(expected),
                        "it was cut off or replaced; run scan-landmarks again");
  }
  return body;
}

std::string skin_sha256(const std::string& path) {
  const Json document = io::read_document(path, "body", BODY_VERSION);
  const io::Node root(document, path);
  if (!root.has("mesh") || !root.at("mesh").is_string())
    throw input_error("body.no-skin"_id, path, "/mesh",
                      "the body was written without its skin, which cloth would hang on",
                      "give one that scan-landmarks wrote to a file and without --anonymise");
  return io::sha256(io::read_file(io::file_beside(root.at("mesh"))));
}

namespace {

/// Faces in order of part, so that every part is one group.
io::ObjMesh in_groups(const Body& body) {
  io::ObjMesh obj;
  obj.positions = body.skin.positions;
  obj.triangles.reserve(body.skin.triangles.size());
  for (int k = 0; k <= N_PARTS; ++k) {
    const Part part = k < N_PARTS ? static_cast<Part>(k) : Part::NONE;
    const int first = std::ssize(obj.triangles);
    for (std::size_t t = 0; t < body.skin.triangles.size(); ++t)
      if (body.face_part[t] == part)
        obj.triangles.push_back(body.skin.triangles[t]);
    if (static_cast<int>(obj.triangles.size()) > first)
      obj.groups.push_back({part_name(part), first});
  }
  return obj;
}

} // namespace

void write_body(const std::string& path, const Body& body, const std::string& tool) {
  const std::string mesh_path = io::mesh_path_beside(path);
  if (path == "-" || body.skin.triangles.empty()) {
    io::write_file(path, io::to_text(document_of(body, tool, {}, {})));
    return;
  }
  const std::string mesh = io::obj_text(in_groups(body), generator_stamp(tool));
  // Refuses what is not finite before any file is touched.
  const std::string text = io::to_text(document_of(body, tool, io::file_name(mesh_path), mesh));
  io::write_file(mesh_path, mesh);
  io::write_file(path, text);
}

void write_motion(const std::string& path, const Body& body, const SkinWeights& weights,
                  const Motion& motion, const std::string& tool, Reporter& reporter) {
  io::ObjMesh obj = in_groups(body);
  std::string base = io::mesh_path_beside(path);
  base.resize(base.size() - 4);
  for (std::size_t k = 0; k < motion.poses.size() && !reporter.stop_requested(); ++k) {
    reporter.progress("posing", static_cast<double>(k) / static_cast<double>(motion.poses.size()));
    obj.positions = posed_skin(body, weights, motion.poses[k]);
    char number[40];
    std::snprintf(number, sizeof number, ".%04zu.obj", k + 1);
    io::write_obj(base + number, obj, generator_stamp(tool));
  }
}

} // namespace sloper::body

/// Documents and scans with something wrong in them: refused with file, place and fact, or
/// repaired; never half understood.
#include <support/drape_scene.hpp>

#include "scene_tools.hpp"

#include <filesystem>
#include <fstream>
#include <mannequin.hpp>
#include <sloper/body/body_json.hpp>
#include <sloper/body/measure_scan.hpp>
#include <sloper/garment/garment_json.hpp>
#include <sloper/garment/scene/scene.hpp>
#include <sloper/garment/sewing.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/scan_reader.hpp>
#include <sloper/pattern/panel_mesh_json.hpp>
#include <sloper/pattern/read/read_pattern.hpp>
#include <unistd.h>

namespace sloper::hard {

namespace {

/// A folder of its own, gone at the end.
struct Folder {
  std::filesystem::path path;
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "sloper-hard-XXXXXX").string();
    if (!mkdtemp(name.data()))
      throw std::runtime_error("no temporary folder");
    path = name;
  }
  ~Folder() { std::filesystem::remove_all(path); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
};

/// Puts `word` in the place of a number in the text, which one is random. @return false when there
/// is none
bool replace_number(std::string& text, const std::string& word, std::uint64_t seed,
                    std::size_t from) {
  std::vector<std::pair<std::size_t, std::size_t>> numbers;
  bool quoted = false;
  for (std::size_t i = from; i < text.size();) {
    if (text[i] == '"')
      quoted = !quoted;
    const bool digit = std::isdigit(static_cast<unsigned char>(text[i])) != 0;
    if (quoted || !digit || (i > 0 && std::isalnum(static_cast<unsigned char>(text[i - 1])))) {
      ++i;
      continue;
    }
    std::size_t end = i;
    while (end < text.size() &&
           (std::isalnum(static_cast<unsigned char>(text[end])) || text[end] == '.'))
      ++end;
    numbers.emplace_back(i, end - i);
    i = end;
  }
  if (numbers.empty())
    return false;
  Random random(seed + 5);
  const auto [at, length] = numbers[random.next() % numbers.size()];
  text.replace(at, length, word);
  return true;
}

const char* PATTERN = R"({"format": "pattern", "version": 1, "name": "square", "length_unit": "m",
  "panels": [{"name": "front", "outline": [[0, 0], [0.3, 0], [0.3, 0.4], [0, 0.4]]},
             {"name": "back", "outline": [[0.5, 0], [0.8, 0], [0.8, 0.4], [0.5, 0.4]]}],
  "seams": []})";

/// A small OBJ with one thing wrong in it.
std::string broken_obj(const std::string& what) {
  const std::string good =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 2 3 4\nf 1 3 4\n";
  if (what == "nan")
    return "v nan 0 0\n" + good;
  if (what == "infinity")
    return "v 1e999 0 0\n" + good;
  if (what == "text")
    return "v one two three\n" + good;
  if (what == "index_beyond")
    return good + "f 1 2 99\n";
  if (what == "index_zero")
    return good + "f 0 1 2\n";
  if (what == "index_negative")
    return good + "f -9 -8 -7\n";
  if (what == "empty")
    return "";
  if (what == "no_vertices")
    return "# nothing\n";
  if (what == "no_faces")
    return "v 0 0 0\nv 1 0 0\n";
  if (what == "binary")
    return std::string("v 0 0 0\n\0\1\2\3", 12);
  if (what == "two_numbers")
    return "v 0 0\n" + good;
  if (what == "repeated_corner")
    return good + "f 1 1 2\n";
  if (what == "duplicate_faces")
    return good + "f 1 2 3\nf 1 2 3\n";
  if (what == "lone_vertex")
    return good + "v 5 5 5\n";
  throw input_error("hard.bad-scene"_id, "", "broken", what + " is no fault of these scenes");
}

} // namespace

Outcome file_scene(const Parameters& p, std::uint64_t seed) {
  const Folder folder;
  const std::string kind = p.text("document", "panels"), word = p.text("word", "NaN"),
                    into = p.text("into", "json");
  Outcome out;
  if (kind == "scan") {
    const std::string path = (folder.path / "scan.obj").string();
    std::ofstream(path, std::ios::binary) << broken_obj(p.text("broken", "nan"));
    const io::Scan scan = io::read_scan(path);
    body::measure_scan(scan.mesh, path, scan.sha256, {}, silent_reporter());
    return out;
  }
  std::string path = (folder.path / (kind + ".json")).string();
  garment::Garment g = garment::make_skirt(0.75, 0.2, 0.05);
  if (kind == "panels") {
    pattern::write_panel_mesh(path, g.panels, "test");
  } else if (kind == "garment") {
    garment::weld(g, g.panels.placed);
    garment::write_garment(path, g, "test");
  } else if (kind == "body") {
    body::Body b = make_body(garment::make_pillar(16, 8).skin);
    b.stance_class = "A";
    body::write_body(path, b, "test");
  } else if (kind == "scene") {
    std::ofstream(path)
        << R"({"format": "scene", "version": 1, "settings": {"time_step_s": 0.03, "cg_tolerance": 0.01}, "wind_m_s": [0, 0, 1]})";
  } else if (kind == "pattern") {
    std::ofstream(path) << PATTERN;
  }
  const std::string target = into == "obj" ? io::mesh_path_beside(path) : path;
  std::string text = io::read_file(target);
  const std::size_t from = into == "obj" ? text.find("\nv ") : text.find("version") + 12;
  if (word == "cut")
    text.resize(text.size() / 2 + seed % 7);
  else if (!replace_number(text, word, seed, from))
    throw std::runtime_error("no number in " + target);
  std::ofstream(target, std::ios::binary | std::ios::trunc) << text;
  if (kind == "panels")
    pattern::read_panel_mesh(path);
  else if (kind == "garment")
    garment::read_garment(path);
  else if (kind == "body")
    body::read_body(path);
  else if (kind == "scene")
    garment::read_scene(path);
  else
    pattern::read_pattern(path, "");
  return out;
}

Outcome scan_scene(const Parameters& p, std::uint64_t seed) {
  samples::Mannequin shape;
  shape.cell_m = p.number("cell_m", 0.025);
  TriangleMesh mesh = samples::make_mannequin(shape).mesh;
  jitter(mesh.positions, p.number("jitter_m", 2e-4), seed);
  damage(mesh, p.text("damage", "none"), seed);
  for (Vec3& q : mesh.positions)
    q *= p.number("unit", 1);
  if (p.flag("points_only", false))
    mesh.triangles.clear();
  body::ScanOptions options;
  options.jitter = 0;
  options.unit = p.text("say_unit", "auto");
  const body::MeasuredScan found =
      body::measure_scan(mesh, "scan.obj", "", options, silent_reporter());
  Outcome out;
  out.value["stature_m"] = found.body.scan.stature_m;
  bool finite = true;
  for (const auto& [name, l] : found.body.landmarks)
    finite = finite && l.p.allFinite();
  out.value["finite"] = finite;
  out.value["landmarks"] = static_cast<double>(found.body.landmarks.size());
  for (const body::Finding& f : found.body.scan.findings)
    out.said += f.what + "; ";
  fingerprint(out, found.body.skin.positions);
  return out;
}

} // namespace sloper::hard

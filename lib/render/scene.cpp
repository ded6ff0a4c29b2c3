#include <render/srgb.hpp>
#include <sloper/base/error.hpp>
#include <sloper/body/body_json.hpp>
#include <sloper/collision/intersections.hpp>
#include <sloper/garment/garment_json.hpp>
#include <sloper/garment/inputs.hpp>
#include <sloper/garment/materials.hpp>
#include <sloper/geometry/triangle_mesh.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/json.hpp>
#include <sloper/io/obj.hpp>
#include <sloper/io/scan_reader.hpp>
#include <sloper/pattern/mesh/mesh_pattern.hpp>
#include <sloper/pattern/panel_mesh_json.hpp>
#include <sloper/pattern/read/read_pattern.hpp>
#include <sloper/render/scene.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

namespace sloper::render {

namespace {

constexpr double PATTERN_EDGE = 0.02; // m: a flat pattern needs no fine mesh
constexpr int SKIN = 0xcfc3b8;

DrawMesh plain_mesh(const TriangleMesh& source, const Vec3& color) {
  DrawMesh mesh;
  mesh.positions = source.positions;
  mesh.triangles = source.triangles;
  mesh.normals = vertex_normals(source);
  mesh.colors.assign(mesh.positions.size(), color);
  return mesh;
}

DrawMesh obj_mesh(const io::ObjMesh& obj) {
  TriangleMesh plain{obj.positions, obj.triangles};
  DrawMesh mesh = plain_mesh(plain, linear_color(SKIN));
  if (obj.texture_triangles.empty())
    return mesh;
  mesh.is_cloth = true;
  for (std::size_t g = 0; g < obj.groups.size(); ++g) {
    const std::size_t end =
        g + 1 < obj.groups.size() ? obj.groups[g + 1].first_triangle : obj.triangles.size();
    for (std::size_t f = obj.groups[g].first_triangle; f < end; ++f)
      for (int v : obj.triangles[f])
        mesh.colors[v] = panel_color(static_cast<int>(g));
  }
  return mesh;
}

/// A document's "format"; files of pattern programs, which have none, count as "pattern".
std::string format_of(const io::Json& document, const std::string& path) {
  const std::string format = io::Node(document, path).string("format", "");
  return format == "sewing-spec" || (format.empty() && document.is_object() &&
                                     (document.contains("pattern") || document.contains("panels")))
             ? "pattern"
             : format;
}

constexpr const char* DRAWABLE =
    "give body.json, shirt.json, panels.json, a pattern, or an OBJ, PLY or STL mesh";

/// @throws Error INPUT for what can be no document
void refuse_no_document(const std::string& path) {
  const std::string text = io::read_file(path);
  if (text.rfind("\x89PNG", 0) == 0)
    throw input_error("render.is-picture"_id, path, "", "is a picture already",
                      "--sheet puts pictures side by side, --compare compares two");
  const std::size_t first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (first == std::string::npos)
    throw input_error("file.empty"_id, path, "", "the file is empty", DRAWABLE);
  if (text[first] != '{')
    throw input_error("render.unknown-kind"_id, path, "",
                      "is neither a document nor a mesh by its ending", DRAWABLE);
}

void add_findings(Scene& scene, const std::vector<Message>& findings) {
  scene.findings.insert(scene.findings.end(), findings.begin(), findings.end());
}

/// The edges that questions are about: of each the one asked for, and those that its answers sew.
std::vector<AskedEdge> asked_edges(const io::Json& document, const std::string& path) {
  std::vector<AskedEdge> out;
  const io::Node root(document, path);
  if (!root.has("questions"))
    return out;
  const io::Node questions = root.at("questions");
  int number = 0;
  for (std::size_t q = 0; q < questions.size(); ++q) {
    const io::Node question = questions.at(q), candidates = question.at("candidates");
    ++number;
    if (!question.has("run"))
      continue; // which of several pieces
    const std::size_t first = out.size();
    const auto add = [&](int answer, const io::Node& run) {
      const AskedEdge edge{number, answer, run.at("panel").string(), run.at("run").string()};
      const bool known = std::any_of(
          out.begin() + static_cast<long>(first), out.end(), [&](const AskedEdge& other) {
            return other.panel == edge.panel && other.edge == edge.edge && other.answer == 0;
          });
      if (!known)
        out.push_back(edge);
    };
    for (std::size_t c = 0; c < candidates.size(); ++c)
      for (const char* side : {"a", "b"}) {
        const io::Node runs = candidates.at(c).at(side);
        const bool asked = c == 0 && std::string(side) == "a";
        for (std::size_t r = 0; r < runs.size(); ++r)
          add(asked ? 0 : static_cast<int>(c) + 1, runs.at(r));
      }
  }
  return out;
}

/// Whether a document is a sidecar of seams. Standard input is read once, so it is none.
bool is_sidecar(const std::string& path) {
  if (path == "-" || io::ending_of(path) != ".json" ||
      io::read_file(path).find("\"sewing-seams\"") == std::string::npos)
    return false;
  return format_of(io::read_json(path), path) == "sewing-seams";
}

/// @param sidecar  with the seams of patterns, or empty
void read_one(Scene& scene, const std::string& path, const std::string& sidecar) {
  const std::string ending = io::ending_of(path);
  if (ending == ".obj") {
    scene.meshes.push_back(obj_mesh(io::read_obj(path)));
    return;
  }
  if (ending == ".ply" || ending == ".stl") {
    scene.meshes.push_back(plain_mesh(io::read_scan(path).mesh, linear_color(SKIN)));
    return;
  }
  const bool drawing = ending == ".dxf";
  if (!drawing && path != "-")
    refuse_no_document(path);
  const io::Json document = drawing ? io::Json::object() : io::read_json(path);
  const std::string format = drawing ? "pattern" : format_of(document, path);
  if (format == "body") {
    scene.body = body::read_body(path);
    add_findings(scene, scene.body->file_findings);
    scene.body_mesh = static_cast<int>(scene.meshes.size());
    scene.meshes.push_back(plain_mesh(scene.body->skin, linear_color(SKIN)));
    scene.meshes.back().is_closed = is_closed(scene.body->skin);
  } else if (format == "garment") {
    scene.garments.push_back(garment::read_garment(path));
    const garment::Garment& g = scene.garments.back();
    add_findings(scene, g.file_findings);
    scene.garment_mesh.push_back(std::ssize(scene.meshes));
    scene.meshes.push_back(cloth_mesh(g));
    scene.draped = true;
    if (!g.converged)
      scene.findings.push_back(
          {"garment.not-at-rest"_id, io::file_name(path) +
                                         " is not at rest: it was placed without a drape, or its "
                                         "drape did not end; the picture says nothing of its fit"});
  } else if (format == "panels") {
    garment::Garment g;
    g.panels = pattern::read_panel_mesh(path);
    add_findings(scene, g.panels.file_findings);
    g.position = g.panels.placed;
    for (std::size_t v = 0; v < g.position.size(); ++v)
      g.particle_of.push_back(static_cast<int>(v));
    scene.garment_mesh.push_back(std::ssize(scene.meshes));
    scene.meshes.push_back(cloth_mesh(g));
    scene.garments.push_back(std::move(g));
  } else if (format == "pattern") {
    garment::Garment g;
    g.panels = pattern::mesh_pattern(pattern::read_pattern(path, sidecar), PATTERN_EDGE, path);
    g.position = g.panels.placed;
    for (std::size_t v = 0; v < g.position.size(); ++v)
      g.particle_of.push_back(static_cast<int>(v));
    scene.garment_mesh.push_back(std::ssize(scene.meshes));
    scene.meshes.push_back(cloth_mesh(g));
    scene.garments.push_back(std::move(g));
  } else {
    throw input_error("render.unknown-kind"_id, path, "/format",
                      format.empty() ? "is not a Sloper document"
                                     : "a \"" + format + "\" document cannot be drawn",
                      DRAWABLE);
  }
}

/// How many triangles of a garment another one passes through.
std::size_t crossed_triangles(const garment::Garment& a, const garment::Garment& b) {
  const std::vector<Triangle> of_b = b.particle_triangles();
  const collision::TriangleTree tree(b.position, of_b);
  return collision::triangles_through(a.position, a.particle_triangles(), tree).size();
}

/// Warnings of garments that were draped apart and pass through each other.
/// @param files  of the garments   @param which  of the scene's garments
void tell_crossings(Scene& scene, const std::vector<std::string>& files,
                    const std::vector<std::size_t>& which) {
  for (std::size_t i = 0; i < which.size(); ++i)
    for (std::size_t j = i + 1; j < which.size(); ++j) {
      const garment::Garment &a = scene.garments[which[i]], &b = scene.garments[which[j]];
      if (a.panels.name == b.panels.name && a.panels.triangles == b.panels.triangles)
        continue; // two drapes of one pattern, to be compared
      if (const std::size_t n = crossed_triangles(a, b); n > 0)
        scene.findings.push_back(
            {"render.garments-cross"_id,
             io::file_name(files[i]) + " and " + io::file_name(files[j]) +
                 " pass through each other, at " + std::to_string(n) +
                 " triangles of the first: they were draped apart; drape puts one over the other "
                 "(--over)"});
    }
}

} // namespace

DrawMesh cloth_mesh(const garment::Garment& g) {
  const pattern::PanelMesh& panels = g.panels;
  DrawMesh mesh;
  mesh.is_cloth = true;
  const std::vector<Vec3> normals = vertex_normals({g.position, g.particle_triangles()});
  mesh.triangles = panels.triangles;
  for (int particle : g.particle_of) {
    mesh.positions.push_back(g.position[particle]);
    mesh.normals.push_back(normals[particle]);
  }
  mesh.colors.resize(g.particle_of.size());
  mesh.uv.resize(g.particle_of.size());
  for (const pattern::PanelInfo& panel : panels.panels) {
    mesh.panel_of.insert(mesh.panel_of.end(), panel.n_vertices,
                         static_cast<int>(mesh.panels.size()));
    mesh.panels.push_back(panel.name);
    const Vec2 warp = panel.grain.normalized(), weft(warp.y(), -warp.x());
    for (int v = panel.first_vertex; v < panel.first_vertex + panel.n_vertices; ++v)
      mesh.uv[v] = {panels.pattern[v].dot(weft), panels.pattern[v].dot(warp)};
  }
  std::map<std::array<int, 2>, int> uses, welded_uses;
  auto sorted = [](int a, int b) { return std::array<int, 2>{std::min(a, b), std::max(a, b)}; };
  for (const Triangle& t : panels.triangles)
    for (int k = 0; k < 3; ++k) {
      ++uses[sorted(t[k], t[(k + 1) % 3])];
      ++welded_uses[sorted(g.particle_of[t[k]], g.particle_of[t[(k + 1) % 3]])];
    }
  for (const auto& [edge, count] : uses) {
    if (count != 1)
      continue; // inside a panel
    const bool is_hem = welded_uses[sorted(g.particle_of[edge[0]], g.particle_of[edge[1]])] == 1;
    // the panels of a mesh without a pattern are cut where it unrolls, and nothing is sewn there
    if (g.strain_unknown && !is_hem)
      continue;
    mesh.lines.push_back(edge);
    mesh.is_hem.push_back(is_hem);
  }
  const auto material = g.materials.find("");
  mesh.thickness = material != g.materials.end() ? material->second.thickness_m : 0.0005;
  return mesh;
}

Vec3 linear_color(int hex) {
  auto channel = [](int c) { return from_srgb(c / 255.0); };
  return {channel(hex >> 16 & 255), channel(hex >> 8 & 255), channel(hex & 255)};
}

Vec3 panel_color(int k) {
  static const int palette[] = {0x5b8db8, 0xe3a55b, 0x7fb69a, 0xc98aa8,
                                0xd9c867, 0x8f86bd, 0xc97b5f, 0x79b7d0};
  return linear_color(palette[k % 8]);
}

void color_cloth(Scene& scene, ClothColors how, const std::vector<int>& colors) {
  static const int garment_palette[] = {0x4f7396, 0xb5654a, 0x6f8f72, 0x8a6f9e};
  std::map<std::string, int> of_material = {{"denim", 0x34475f},
                                            {"silk", 0xb89c84},
                                            {"wool-suiting", 0x5b5c61},
                                            {"jersey", 0x86919c},
                                            {"canvas", 0x9c8c6a}};
  int k = 0;
  for (DrawMesh& mesh : scene.meshes) {
    if (!mesh.is_cloth || mesh.panel_of.empty())
      continue;
    int color = garment_palette[k % 4];
    const auto g =
        static_cast<std::size_t>(std::find(scene.garment_mesh.begin(), scene.garment_mesh.end(),
                                           &mesh - scene.meshes.data()) -
                                 scene.garment_mesh.begin());
    if (k < std::ssize(colors))
      color = colors[k];
    else if (g < scene.garments.size())
      if (const auto own = of_material.extract(garment::main_material(scene.garments[g])))
        color = own.mapped(); // one garment alone has it
    const Vec3 one = linear_color(color);
    for (std::size_t v = 0; v < mesh.colors.size(); ++v)
      mesh.colors[v] = how == ClothColors::PANELS ? panel_color(mesh.panel_of[v]) : one;
    ++k;
  }
}

// Edges are distinguished by a hash that changes its sign with their direction: a sum of nothing
// left over is chance once in 2^64.
bool is_closed(const TriangleMesh& mesh) {
  const auto mixed = [](std::uint64_t x) { // splitmix64
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
    return x ^ (x >> 31);
  };
  std::uint64_t left = 0;
  double volume = 0;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto a = static_cast<std::uint64_t>(t[k]),
                 b = static_cast<std::uint64_t>(t[(k + 1) % 3]);
      const std::uint64_t h =
          mixed((std::min(a, b) << 32 | std::max(a, b)) + 0x9e3779b97f4a7c15ULL);
      left += a < b ? h : std::uint64_t{0} - h;
    }
    const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    volume += a.dot(b.cross(c));
  }
  return left == 0 && volume > 0;
}

Scene read_scene(const std::vector<std::string>& paths) {
  Scene scene;
  std::string body;
  std::vector<std::string> draped; // garments' files
  std::vector<std::size_t> which;  // of the scene's garments
  std::string sidecar;
  for (const std::string& path : paths)
    if (is_sidecar(path)) {
      if (!sidecar.empty())
        throw Error(ErrorKind::USAGE, "option.wrong-count"_id, "", path,
                    "is a second sidecar of seams", "draw one pattern with its sidecar at a time");
      sidecar = path;
      scene.asked = asked_edges(io::read_json(path), path);
    }
  for (const std::string& path : paths) {
    if (path == sidecar)
      continue;
    const std::size_t before = scene.meshes.size(), garments = scene.garments.size();
    const int body_before = scene.body_mesh;
    read_one(scene, path, sidecar);
    if (scene.body_mesh != body_before)
      body = path;
    if (scene.garments.size() > garments && !scene.garments.back().body_sha256.empty()) {
      draped.push_back(path);
      which.push_back(garments);
    }
    scene.names.push_back(io::file_name(path));
    for (std::size_t m = before; m < scene.meshes.size(); ++m)
      scene.meshes[m].name = scene.names.back().substr(0, scene.names.back().rfind('.'));
  }
  if (!body.empty() && body != "-" && !scene.body->skin.positions.empty() && !draped.empty()) {
    const std::string skin = body::skin_sha256(body);
    for (std::size_t k = 0; k < draped.size(); ++k)
      for (const Message& finding :
           garment::start_findings(scene.garments[which[k]], {draped[k], body, skin, true}))
        scene.findings.push_back(finding);
  }
  tell_crossings(scene, draped, which);
  std::size_t triangles = 0;
  for (const DrawMesh& m : scene.meshes)
    triangles += m.triangles.size();
  if (triangles == 0 && scene.body)
    throw input_error("body.no-skin"_id, paths.front(), "",
                      "the body was written without its skin, and there is nothing else to draw",
                      "give one written without --anonymise");
  if (triangles == 0)
    throw input_error("render.nothing-to-draw"_id, paths.front(), "",
                      "there is no triangle to draw",
                      "points are made a body by scan-landmarks: draw its body.json");
  return scene;
}

} // namespace sloper::render

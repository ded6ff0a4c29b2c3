#include <sloper/base/version.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/json.hpp>
#include <sloper/io/json_lists.hpp>
#include <sloper/io/obj.hpp>
#include <sloper/pattern/panel_mesh_json.hpp>
#include <sloper/pattern/read/read_pattern.hpp>
#include <sloper/pattern/write/export_pattern.hpp>

#include <cmath>

namespace sloper::pattern {
namespace {

io::Json numbers(const std::vector<int>& list) {
  io::Json out = io::Json::array();
  for (int v : list)
    out.push_back(v);
  return out;
}

std::vector<int> vertex_list(const io::Node& node, std::size_t n_vertices) {
  std::vector<int> out;
  for (std::size_t k = 0; k < node.size(); ++k) {
    const int v = node.at(k).integer();
    if (v < 0 || static_cast<std::size_t>(v) >= n_vertices)
      node.fail("json.bad-index"_id, "vertex " + std::to_string(v) + " is not in the mesh");
    out.push_back(v);
  }
  return out;
}

/// In the order of Placement; UNKNOWN is not written.
const char* const PLACEMENTS[] = {"", "flat", "stated", "body"};

Placement placement_of(const io::Node& by) {
  for (const Placement p : {Placement::FLAT, Placement::STATED, Placement::BODY})
    if (by.string() == PLACEMENTS[static_cast<int>(p)])
      return p;
  return Placement::UNKNOWN;
}

} // namespace

void write_panel_mesh(const std::string& path, const PanelMesh& mesh, const std::string& tool) {
  io::ObjMesh obj;
  obj.positions = mesh.placed;
  obj.texture = mesh.pattern;
  obj.triangles = mesh.triangles;
  obj.texture_triangles = mesh.triangles;
  for (const PanelInfo& p : mesh.panels)
    obj.groups.push_back({p.name, p.first_triangle});
  const std::string mesh_path = io::mesh_path_beside(path);

  io::Json doc = io::new_document("panels", PANELS_VERSION, tool);
  doc["name"] = mesh.name;
  doc["mesh"] = io::file_name(mesh_path);
  doc["edge_length"] = mesh.edge_length;
  if (mesh.seam_length > 0)
    doc["seam_edge_length"] = mesh.seam_length;
  if (mesh.placement != Placement::UNKNOWN)
    doc["placement"] = {{"by", PLACEMENTS[static_cast<int>(mesh.placement)]}};
  if (!mesh.body_sha256.empty())
    doc["placement"]["body_sha256"] = mesh.body_sha256;
  io::Json panels = io::Json::array();
  for (std::size_t k = 0; k < mesh.panels.size(); ++k) {
    const PanelInfo& p = mesh.panels[k];
    io::Json st = io::Json::array();
    for (int v = p.first_vertex; v < p.first_vertex + p.n_vertices; ++v) {
      const StableId& id = mesh.ids[v];
      st.push_back(id.s);
      st.push_back(id.t);
    }
    panels.push_back({{"name", p.name},
                      {"part", p.part},
                      {"material", p.material},
                      {"layer", p.layer},
                      {"grain", io::to_json(p.grain)},
                      {"vertices", io::Json::array({p.first_vertex, p.n_vertices})},
                      {"triangles", io::Json::array({p.first_triangle, p.n_triangles})},
                      {"outline", numbers(p.outline)},
                      {"st", st}});
    if (p.in_folds)
      panels.back()["in_folds"] = true;
  }
  doc["panels"] = panels;
  io::Json seams = io::Json::array();
  for (const MeshSeam& s : mesh.seams) {
    seams.push_back({{"name", s.name},
                     {"kind", s.kind},
                     {"length_a", s.length_a},
                     {"length_b", s.length_b},
                     {"ease", s.length_b > 0 ? s.length_a / s.length_b - 1 : 0.0},
                     {"a", numbers(s.a)},
                     {"b", numbers(s.b)}});
    if (s.open)
      seams.back()["open"] = true;
  }
  doc["seams"] = seams;
  io::put_findings(doc, mesh.findings);
  if (!mesh.faults.empty())
    doc["faults"] = mesh.faults;
  if (mesh.source)
    doc["pattern"] = pattern_json(*mesh.source, tool, PatternNumbers::EXACT);
  const std::string bytes = io::obj_text(obj, generator_stamp(tool));
  io::put_mesh_hash(doc, bytes);
  const std::string text = io::to_text(doc); // before anything is written
  io::write_file(mesh_path, bytes);
  io::write_file(path, text);
}

PanelMesh read_panel_mesh(const std::string& path) {
  const io::Json json = io::read_document(path, "panels", PANELS_VERSION);
  const io::Node doc(json, path);
  const std::string mesh_path = io::file_beside(doc.at("mesh"));
  const io::ObjMesh obj = io::read_obj(mesh_path);
  PanelMesh mesh;
  mesh.file_findings = io::mesh_findings(doc, mesh_path);
  mesh.name = doc.string("name", "");
  mesh.edge_length = doc.number("edge_length", 0);
  mesh.seam_length = doc.number("seam_edge_length", 0);
  mesh.placed = obj.positions;
  mesh.pattern = obj.texture;
  mesh.triangles = obj.triangles;
  if (doc.has("placement")) {
    mesh.placement = placement_of(doc.at("placement").at("by"));
    mesh.body_sha256 = doc.at("placement").string("body_sha256", "");
  }
  const std::size_t n = mesh.placed.size();
  if (mesh.pattern.size() != n)
    doc.at("mesh").fail("panels.mesh-differs"_id,
                        "the mesh has " + std::to_string(n) + " v and " +
                            std::to_string(mesh.pattern.size()) + " vt",
                        "write both files with one pattern-mesh run");
  const io::Node panels = doc.at("panels");
  int vertex = 0, triangle = 0;
  for (std::size_t k = 0; k < panels.size(); ++k) {
    const io::Node node = panels.at(k);
    PanelInfo p;
    p.name = node.at("name").string();
    p.part = node.string("part", "");
    p.material = node.string("material", "");
    p.layer = node.integer("layer", 0);
    p.in_folds = node.boolean("in_folds", false);
    p.grain = node.at("grain").vec2();
    p.first_vertex = node.at("vertices").at(0).integer();
    p.n_vertices = node.at("vertices").at(1).integer();
    p.first_triangle = node.at("triangles").at(0).integer();
    p.n_triangles = node.at("triangles").at(1).integer();
    if (p.first_vertex != vertex || p.n_vertices < 0 || p.first_triangle != triangle ||
        p.n_triangles < 0)
      node.fail("panels.mesh-differs"_id,
                "panel " + p.name + " does not follow the panel before it");
    vertex += p.n_vertices;
    triangle += p.n_triangles;
    p.outline = vertex_list(node.at("outline"), n);
    const io::Node st = node.at("st");
    if (st.size() != 2 * static_cast<std::size_t>(p.n_vertices))
      st.fail("panels.mesh-differs"_id, "there are " + std::to_string(st.size()) + " numbers for " +
                                            std::to_string(p.n_vertices) + " vertices");
    for (std::size_t v = 0; v < static_cast<std::size_t>(p.n_vertices); ++v)
      mesh.ids.push_back({static_cast<int>(k), st.at(2 * v).number(), st.at(2 * v + 1).number()});
    mesh.panels.push_back(p);
  }
  if (static_cast<std::size_t>(vertex) != n ||
      static_cast<std::size_t>(triangle) != mesh.triangles.size())
    panels.fail("panels.mesh-differs"_id,
                "panels have " + std::to_string(vertex) + " vertices and " +
                    std::to_string(triangle) + " triangles, the mesh " + std::to_string(n) +
                    " and " + std::to_string(mesh.triangles.size()),
                "write both files with one pattern-mesh run");
  const io::Node seams = doc.at("seams");
  for (std::size_t k = 0; k < seams.size(); ++k) {
    const io::Node node = seams.at(k);
    MeshSeam s{node.string("name", ""),
               node.string("kind", "seam"),
               vertex_list(node.at("a"), n),
               vertex_list(node.at("b"), n),
               node.number("length_a", 0),
               node.number("length_b", 0),
               node.has("open") && node.at("open").boolean()};
    if (s.a.size() != s.b.size() || s.a.size() < 2)
      node.fail("panels.mesh-differs"_id, "seam " + s.name + " has " + std::to_string(s.a.size()) +
                                              " and " + std::to_string(s.b.size()) + " vertices");
    mesh.seams.push_back(std::move(s));
  }
  mesh.findings = io::read_findings(doc);
  if (doc.has("faults"))
    mesh.faults = io::read_strings(doc.at("faults"));
  if (doc.has("pattern"))
    mesh.source = std::make_shared<Pattern>(read_pattern_json(doc.at("pattern").json(), path));
  return mesh;
}

} // namespace sloper::pattern

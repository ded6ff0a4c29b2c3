#include <garment/redrape/redrapes_json.hpp>
#include <garment/scene/scene_effects_json.hpp>
#include <sloper/garment/garment_json.hpp>
#include <sloper/garment/material_json.hpp>

#include <sloper/base/version.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/json.hpp>
#include <sloper/io/json_lists.hpp>
#include <sloper/io/obj.hpp>
#include <sloper/pattern/read/read_pattern.hpp>
#include <sloper/pattern/write/export_pattern.hpp>

#include <cmath>
#include <utility>

namespace sloper::garment {

namespace {

using io::Json;
using io::Node;

constexpr double WEIGHT_SUM_TOLERANCE =
    1e-6; ///< binding weights are written in full, so this only catches damage

/// Keys and fields of a material, for reading; material_json() writes them.
constexpr std::pair<const char*, double Material::*> MATERIAL_NUMBERS[] = {
    {"density_kg_m2", &Material::density_kg_m2},
    {"stretch_warp_n_m", &Material::stretch_warp_n_m},
    {"stretch_weft_n_m", &Material::stretch_weft_n_m},
    {"shear_n_m", &Material::shear_n_m},
    {"bend_n_m", &Material::bend_n_m},
    {"friction_body", &Material::friction_body},
    {"friction_self", &Material::friction_self},
    {"damping_s", &Material::damping_s},
    {"thickness_m", &Material::thickness_m},
    {"poisson", &Material::poisson},
};
/// Those that are 0 where a document has none.
constexpr std::pair<const char*, double Material::*> MATERIAL_EXTRAS[] = {
    {"bend_warp_n_m", &Material::bend_warp_n_m},
    {"bend_weft_n_m", &Material::bend_weft_n_m},
    {"bend_bias_n_m", &Material::bend_bias_n_m},
    {"bend_soft_share", &Material::bend_soft_share},
};

Json panel_json(const pattern::PanelInfo& panel) {
  Json j;
  j["name"] = panel.name;
  j["vertices"] = panel.n_vertices;
  j["triangles"] = panel.n_triangles;
  j["grain"] = io::to_json(panel.grain);
  j["material"] = panel.material;
  j["layer"] = panel.layer;
  if (panel.in_folds)
    j["in_folds"] = true;
  j["part"] = panel.part;
  j["outline"] = Json(panel.outline);
  return j;
}

Json seam_json(const pattern::MeshSeam& seam) {
  Json j;
  j["name"] = seam.name;
  j["kind"] = seam.kind;
  j["length_a_m"] = seam.length_a;
  j["length_b_m"] = seam.length_b;
  j["a"] = Json(seam.a);
  j["b"] = Json(seam.b);
  if (seam.open)
    j["open"] = true;
  return j;
}

Json rest_scale_json(const Garment& garment) {
  Json rows = Json::array();
  for (std::size_t f = 0; f < garment.rest_scale.size(); ++f) {
    const auto& s = garment.rest_scale[f];
    if (s[0] != 1 || s[1] != 1 || s[2] != 1)
      rows.push_back({f, s[0], s[1], s[2]});
  }
  return rows;
}

Json bind_json(const Bind& bind) {
  Json j;
  j["frames"] = bind.frames;
  j["lengths_m"] = bind.lengths_m;
  j["marks"] = Json::array();
  for (const auto& marks : bind.marks) {
    Json row = Json::object();
    for (const auto& [name, z] : marks)
      row[name] = z;
    j["marks"].push_back(row);
  }
  j["columns"] = {"frame", "weight", "theta", "z", "gap"};
  j["particles"] = Json::array();
  for (const auto& weights : bind.particles) {
    Json row = Json::array();
    for (const BindWeight& w : weights)
      for (const Json& value :
           {Json(w.frame), Json(w.weight), Json(w.theta), Json(w.z), Json(w.gap)})
        row.push_back(value);
    j["particles"].push_back(row);
  }
  return j;
}

std::vector<int> read_indices(const Node& node, int end) {
  std::vector<int> list;
  list.reserve(node.size());
  for (std::size_t i = 0; i < node.size(); ++i) {
    list.push_back(node.at(i).integer());
    if (list.back() < 0 || list.back() >= end)
      node.at(i).fail("json.bad-index"_id, "the index is out of range: the mesh has " +
                                               std::to_string(end) + " panel vertices");
  }
  return list;
}

int count(const Node& node) {
  const int n = node.integer();
  if (n < 0)
    node.fail("json.out-of-range"_id, "a count is negative");
  return n;
}

double positive(const Node& node) {
  const double x = node.number();
  if (x <= 0)
    node.fail("json.out-of-range"_id, "expected a number above zero");
  return x;
}

void read_panels(const Node& node, pattern::PanelMesh& mesh) {
  const int n_vertices = static_cast<int>(mesh.pattern.size()),
            n_triangles = static_cast<int>(mesh.triangles.size());
  int vertex = 0, triangle = 0;
  for (std::size_t k = 0; k < node.size(); ++k) {
    const Node p = node.at(k);
    pattern::PanelInfo panel;
    panel.name = p.at("name").string();
    panel.first_vertex = vertex;
    panel.n_vertices = count(p.at("vertices"));
    panel.first_triangle = triangle;
    panel.n_triangles = count(p.at("triangles"));
    if (panel.n_vertices > n_vertices - vertex || panel.n_triangles > n_triangles - triangle)
      p.fail("garment.mesh-differs"_id, "the panels have more vertices or triangles than the mesh");
    panel.grain = p.at("grain").vec2();
    if (std::abs(panel.grain.norm() - 1) > 1e-6)
      p.at("grain").fail("garment.damaged"_id, "the grain is not a unit direction");
    panel.material = p.string("material", "");
    panel.layer = p.integer("layer", 0);
    panel.in_folds = p.boolean("in_folds", false);
    panel.part = p.string("part", "");
    panel.outline = read_indices(p.at("outline"), n_vertices);
    vertex += panel.n_vertices;
    triangle += panel.n_triangles;
    for (int f = panel.first_triangle; f < triangle; ++f)
      for (const int v : mesh.triangles[f])
        if (v < panel.first_vertex || v >= vertex)
          p.fail("garment.mesh-differs"_id,
                 "triangle " + std::to_string(f) + " has a vertex of another panel");
    mesh.panels.push_back(std::move(panel));
  }
  if (vertex != n_vertices || triangle != n_triangles)
    node.fail("garment.mesh-differs"_id,
              "the panels have fewer vertices or triangles than the mesh",
              "document and OBJ belong to different garments");
}

void read_ids(const Node& node, pattern::PanelMesh& mesh) {
  const Node s = node.at("s"), t = node.at("t");
  for (const Node& list : {s, t})
    if (list.size() != mesh.pattern.size())
      list.fail("json.wrong-count"_id, "has " + std::to_string(list.size()) + " numbers for " +
                                           std::to_string(mesh.pattern.size()) + " panel vertices");
  mesh.ids.reserve(mesh.pattern.size());
  for (std::size_t k = 0; k < mesh.panels.size(); ++k)
    for (int i = 0; i < mesh.panels[k].n_vertices; ++i) {
      const std::size_t v = mesh.ids.size();
      mesh.ids.push_back({static_cast<int>(k), s.at(v).number(), t.at(v).number()});
    }
}

void read_seams(const Node& node, pattern::PanelMesh& mesh) {
  const int n = std::ssize(mesh.pattern);
  for (std::size_t k = 0; k < node.size(); ++k) {
    const Node s = node.at(k);
    pattern::MeshSeam seam{s.at("name").string(),
                           s.at("kind").string(),
                           read_indices(s.at("a"), n),
                           read_indices(s.at("b"), n),
                           s.at("length_a_m").number(),
                           s.at("length_b_m").number(),
                           s.has("open") && s.at("open").boolean()};
    if (seam.a.size() != seam.b.size() || seam.a.size() < 2)
      s.fail("json.wrong-count"_id,
             "the two runs of the seam need the same number of vertices, two or more");
    mesh.seams.push_back(std::move(seam));
  }
}

std::map<std::string, Material> read_materials(const Node& node) {
  std::map<std::string, Material> materials;
  for (const std::string& key : node.keys()) {
    const Node m = node.at(key);
    Material material;
    material.name = m.string("name", material.name);
    for (const auto& [name, field] : MATERIAL_NUMBERS) {
      material.*field = m.number(name, material.*field);
      if (material.*field < 0)
        m.at(name).fail("json.out-of-range"_id, "a material property is negative");
    }
    for (const auto& [name, field] : MATERIAL_EXTRAS) {
      material.*field = m.number(name, 0);
      if (material.*field < 0)
        m.at(name).fail("json.out-of-range"_id, "a material property is negative");
    }
    if (material.bend_soft_share > 1)
      m.at("bend_soft_share").fail("json.out-of-range"_id, "is more than all of it");
    if (m.has("bend_soft_radius_m"))
      material.bend_soft_radius_m = positive(m.at("bend_soft_radius_m"));
    if (m.has("density_kg_m2"))
      positive(m.at("density_kg_m2"));
    material.source = m.string("source", "");
    materials[key] = material;
  }
  return materials;
}

std::vector<std::array<double, 3>> read_rest_scale(const Node& node, std::size_t n_triangles) {
  std::vector<std::array<double, 3>> scale;
  if (node.size() == 0)
    return scale;
  scale.assign(n_triangles, {1, 1, 1});
  for (std::size_t k = 0; k < node.size(); ++k) {
    const Node row = node.at(k);
    if (row.size() != 4)
      row.fail("json.wrong-type"_id, "expected [triangle, factor, factor, factor]");
    const int f = row.at(std::size_t{0}).integer();
    if (f < 0 || static_cast<std::size_t>(f) >= n_triangles)
      row.fail("json.bad-index"_id, "refers to a triangle that the mesh does not have");
    for (std::size_t e = 0; e < 3; ++e)
      scale[f][e] = positive(row.at(e + 1));
  }
  return scale;
}

Bind read_bind(const Node& node, std::size_t n_particles) {
  Bind bind;
  const Node frames = node.at("frames"), marks = node.at("marks"), particles = node.at("particles");
  for (std::size_t k = 0; k < frames.size(); ++k)
    bind.frames.push_back(frames.at(k).string());
  const Node lengths = node.at("lengths_m");
  if (lengths.size() != frames.size())
    lengths.fail("json.wrong-count"_id, "there must be one length for each frame");
  for (std::size_t k = 0; k < lengths.size(); ++k)
    bind.lengths_m.push_back(positive(lengths.at(k)));
  if (marks.size() != frames.size())
    marks.fail("json.wrong-count"_id, "there must be one object of marks for each frame");
  for (std::size_t k = 0; k < marks.size(); ++k) {
    bind.marks.emplace_back();
    for (const std::string& name : marks.at(k).keys())
      bind.marks.back()[name] = marks.at(k).at(name).number();
  }
  if (particles.size() != 0 && particles.size() != n_particles)
    particles.fail("json.wrong-count"_id, "binds " + std::to_string(particles.size()) + " of " +
                                              std::to_string(n_particles) + " particles");
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const Node row = particles.at(p);
    if (row.size() == 0 || row.size() % 5 != 0)
      row.fail("json.wrong-type"_id, "expected groups of frame, weight, theta, z, gap");
    std::vector<BindWeight> weights;
    double sum = 0;
    for (std::size_t i = 0; i < row.size(); i += 5) {
      const BindWeight w{row.at(i).integer(), positive(row.at(i + 1)), row.at(i + 2).number(),
                         row.at(i + 3).number(), row.at(i + 4).number()};
      if (w.frame < 0 || static_cast<std::size_t>(w.frame) >= bind.frames.size())
        row.fail("json.bad-index"_id, "refers to a frame that is not listed");
      sum += w.weight;
      weights.push_back(w);
    }
    if (std::abs(sum - 1) > WEIGHT_SUM_TOLERANCE)
      row.fail("garment.damaged"_id, "the weights do not sum to one");
    bind.particles.push_back(std::move(weights));
  }
  return bind;
}

/// Panel mesh and particles from the OBJ. Unsewn garments have one `v` for each `vt`.
void take_mesh(const io::ObjMesh& obj, const std::string& path, bool sewn, Garment& garment) {
  if (obj.texture_triangles.size() != obj.triangles.size())
    throw input_error("garment.no-pattern-coordinates"_id, path, "",
                      "the faces have no pattern coordinates (vt)",
                      "give the OBJ that was written with the document");
  std::vector<int> particle_of(obj.texture.size(), -1);
  for (std::size_t f = 0; f < obj.triangles.size(); ++f)
    for (int k = 0; k < 3; ++k) {
      const int t = obj.texture_triangles[f][k], v = obj.triangles[f][k];
      if (t < 0)
        throw input_error("garment.no-pattern-coordinates"_id, path,
                          "face " + std::to_string(f + 1),
                          "a corner has no pattern coordinates (vt)");
      if (particle_of[t] >= 0 && particle_of[t] != v)
        throw input_error("garment.damaged"_id, path, "face " + std::to_string(f + 1),
                          "vt " + std::to_string(t + 1) + " belongs to two particles");
      particle_of[t] = v;
    }
  std::vector<char> used(obj.positions.size(), 0);
  for (std::size_t t = 0; t < particle_of.size(); ++t) {
    if (particle_of[t] < 0)
      throw input_error("garment.damaged"_id, path, "vt " + std::to_string(t + 1),
                        "the panel vertex is in no triangle");
    used[particle_of[t]] = 1;
  }
  for (std::size_t v = 0; v < used.size(); ++v)
    if (!used[v])
      throw input_error("garment.damaged"_id, path, "v " + std::to_string(v + 1),
                        "the particle is in no triangle");
  garment.panels.pattern = obj.texture;
  garment.panels.triangles = obj.texture_triangles;
  garment.panels.placed.reserve(particle_of.size());
  for (const int p : particle_of)
    garment.panels.placed.push_back(obj.positions[p]);
  if (!sewn) {
    for (std::size_t t = 0; t < particle_of.size(); ++t)
      if (particle_of[t] != static_cast<int>(t))
        throw input_error("garment.damaged"_id, path, "vt " + std::to_string(t + 1),
                          "an unsewn garment must have one v for each vt, in the same order");
    return;
  }
  garment.particle_of = std::move(particle_of);
  garment.position = obj.positions;
}

void check_whole(const Garment& garment) {
  const std::size_t n = garment.panels.pattern.size();
  const bool sewn = !garment.particle_of.empty();
  const bool whole = garment.panels.ids.size() == n &&
                     (sewn ? garment.particle_of.size() == n : garment.panels.placed.size() == n);
  if (!whole)
    throw Error(ErrorKind::INTERNAL, "general.internal"_id, "", "",
                "a garment to be written is not whole");
}

} // namespace

Garment read_garment(const std::string& path) {
  const Json document = io::read_document(path, "garment", GARMENT_VERSION);
  const Node root(document, path);
  const std::string mesh_path = io::file_beside(root.at("mesh"));
  Garment garment = garment_from(root, io::read_obj(mesh_path), mesh_path);
  garment.file_findings = io::mesh_findings(root, mesh_path);
  return garment;
}

Garment garment_from(const io::Node& root, const io::ObjMesh& mesh, const std::string& mesh_name) {
  Garment garment;
  garment.panels.name = root.string("name", "");
  garment.panels.edge_length = root.number("edge_length_m", 0);
  garment.panels.seam_length = root.number("seam_edge_length_m", 0);
  take_mesh(mesh, mesh_name, root.boolean("sewn", true), garment);
  read_panels(root.at("panels"), garment.panels);
  read_ids(root.at("vertex_ids"), garment.panels);
  read_seams(root.at("seams"), garment.panels);
  garment.panels.findings = io::read_findings(root);
  if (root.has("faults"))
    garment.panels.faults = io::read_strings(root.at("faults"));
  if (root.has("pattern"))
    garment.panels.source = std::make_shared<pattern::Pattern>(
        pattern::read_pattern_json(root.at("pattern").json(), root.file()));
  if (root.has("materials"))
    garment.materials = read_materials(root.at("materials"));
  if (root.has("rest_scale"))
    garment.rest_scale = read_rest_scale(root.at("rest_scale"), garment.panels.triangles.size());
  garment.offset_m = root.number("offset_m", garment.offset_m);
  if (garment.offset_m < 0)
    root.at("offset_m").fail("json.out-of-range"_id, "the contact gap is negative");
  garment.converged = root.boolean("converged", false);
  garment.strain_unknown = root.boolean("strain_unknown", false);
  if (root.has("body")) {
    const Node body = root.at("body");
    garment.body_sha256 = body.string("sha256", "");
    if (body.has("girths_m"))
      for (const std::string& name : body.at("girths_m").keys())
        garment.body_girths_m[name] = positive(body.at("girths_m").at(name));
  }
  if (root.has("scene"))
    garment.scene = read_scene_effects(root.at("scene"));
  if (root.has("bind"))
    garment.bind = read_bind(root.at("bind"), garment.position.size());
  if (root.has("redrapes"))
    garment.redrapes = read_redrapes(root.at("redrapes"), garment.position.size());
  return garment;
}

GarmentText garment_text(const Garment& garment, const std::string& mesh_name,
                         const std::string& tool) {
  check_whole(garment);
  const bool sewn = !garment.particle_of.empty();
  io::ObjMesh obj;
  obj.positions = sewn ? garment.position : garment.panels.placed;
  obj.texture = garment.panels.pattern;
  obj.triangles = garment.particle_triangles();
  obj.texture_triangles = garment.panels.triangles;

  Json document = io::new_document("garment", GARMENT_VERSION, tool);
  document["name"] = garment.panels.name;
  document["mesh"] = mesh_name;
  document["converged"] = garment.converged;
  if (garment.strain_unknown)
    document["strain_unknown"] = true;
  document["sewn"] = sewn;
  document["offset_m"] = garment.offset_m;
  document["edge_length_m"] = garment.panels.edge_length;
  if (garment.panels.seam_length > 0)
    document["seam_edge_length_m"] = garment.panels.seam_length;
  Json girths = Json::object();
  for (const auto& [name, value] : garment.body_girths_m)
    girths[name] = value;
  document["body"] = {{"sha256", garment.body_sha256}, {"girths_m", girths}};
  document["materials"] = Json::object();
  for (const auto& [name, material] : garment.materials)
    document["materials"][name] = material_json(material);
  document["panels"] = Json::array();
  for (const pattern::PanelInfo& panel : garment.panels.panels) {
    document["panels"].push_back(panel_json(panel));
    obj.groups.push_back({panel.name, panel.first_triangle});
  }
  document["seams"] = Json::array();
  for (const pattern::MeshSeam& seam : garment.panels.seams)
    document["seams"].push_back(seam_json(seam));
  io::put_findings(document, garment.panels.findings);
  if (!garment.panels.faults.empty())
    document["faults"] = garment.panels.faults;
  if (garment.panels.source)
    document["pattern"] =
        pattern::pattern_json(*garment.panels.source, tool, pattern::PatternNumbers::EXACT);
  document["rest_scale"] = rest_scale_json(garment);
  Json s = Json::array(), t = Json::array();
  for (const pattern::StableId& id : garment.panels.ids) {
    s.push_back(id.s);
    t.push_back(id.t);
  }
  document["vertex_ids"] = {{"s", s}, {"t", t}};
  if (!garment.scene.empty())
    document["scene"] = scene_effects_json(garment.scene);
  if (!garment.bind.empty())
    document["bind"] = bind_json(garment.bind);
  if (garment.redrapes.count > 0)
    document["redrapes"] = redrapes_json(garment.redrapes, garment.position.size());
  std::string mesh = io::obj_text(obj, "garment of " + generator_stamp(tool));
  io::put_mesh_hash(document, mesh);
  return {std::move(document), std::move(mesh)};
}

void write_garment(const std::string& path, const Garment& garment, const std::string& tool) {
  const std::string mesh_path = io::mesh_path_beside(path);
  const GarmentText garment_and_mesh = garment_text(garment, io::file_name(mesh_path), tool);
  const std::string text = io::to_text(
      garment_and_mesh.document); // refuses what is not finite before any file is touched
  io::write_file(mesh_path, garment_and_mesh.mesh);
  io::write_file(path, text);
}

} // namespace sloper::garment

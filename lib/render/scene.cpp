#include <base/error.hpp>
#include <body/body_json.hpp>
#include <garment/garment_json.hpp>
#include <geometry/triangle_mesh.hpp>
#include <io/json.hpp>
#include <io/obj.hpp>
#include <pattern/panel_mesh_json.hpp>
#include <render/scene.hpp>

#include <cmath>
#include <map>

namespace sloper::render {

namespace {

Vec3 linear(int hex) {
  auto channel = [](int c) {
    const double s = c / 255.0;
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
  };
  return {channel(hex >> 16 & 255), channel(hex >> 8 & 255), channel(hex & 255)};
}

/// Muted panel colours that differ for colour-blind eyes too (after Okabe and Ito 2008, softened).
Vec3 panel_color(int k) {
  static const int palette[] = {0x5b8db8, 0xe3a55b, 0x7fb69a, 0xc98aa8, 0xd9c867, 0x8f86bd, 0xc97b5f, 0x79b7d0};
  return linear(palette[k % 8]);
}

const Vec3 SKIN = linear(0xcdbfb2);

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// Cloth: one drawn vertex per panel vertex, normals from the welded particles.
DrawMesh cloth_mesh(const pattern::PanelMesh& panels, const std::vector<int>& particle_of, const std::vector<Vec3>& position) {
  DrawMesh mesh;
  mesh.is_cloth = true;
  TriangleMesh welded;
  welded.positions = position;
  std::map<std::array<int, 2>, int> uses;
  for (const Triangle& t : panels.triangles) {
    welded.triangles.push_back({particle_of[t[0]], particle_of[t[1]], particle_of[t[2]]});
    for (int k = 0; k < 3; ++k) ++uses[{std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])}];
  }
  const std::vector<Vec3> normals = vertex_normals(welded);
  mesh.triangles = panels.triangles;
  for (std::size_t v = 0; v < particle_of.size(); ++v) {
    mesh.positions.push_back(position[particle_of[v]]);
    mesh.normals.push_back(normals[particle_of[v]]);
  }
  mesh.colors.resize(particle_of.size());
  for (std::size_t p = 0; p < panels.panels.size(); ++p)
    for (int v = panels.panels[p].first_vertex; v < panels.panels[p].first_vertex + panels.panels[p].n_vertices; ++v)
      mesh.colors[v] = panel_color(static_cast<int>(p));
  for (const auto& [edge, count] : uses)
    if (count == 1) mesh.lines.push_back(edge); // a panel's border: a seam or a hem
  return mesh;
}

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
  DrawMesh mesh = plain_mesh(plain, SKIN);
  if (obj.texture_triangles.empty()) return mesh;
  mesh.is_cloth = true;
  for (std::size_t g = 0; g < obj.groups.size(); ++g) {
    const std::size_t end = g + 1 < obj.groups.size() ? obj.groups[g + 1].first_triangle : obj.triangles.size();
    for (std::size_t f = obj.groups[g].first_triangle; f < end; ++f)
      for (int v : obj.triangles[f]) mesh.colors[v] = panel_color(static_cast<int>(g));
  }
  return mesh;
}

} // namespace

Scene read_scene(const std::vector<std::string>& paths) {
  Scene scene;
  for (const std::string& path : paths) {
    scene.names.push_back(io::file_name(path));
    if (ends_with(path, ".obj")) {
      scene.meshes.push_back(obj_mesh(io::read_obj(path)));
      continue;
    }
    const io::Json document = io::read_json(path);
    const std::string format = io::Node(document, path).string("format", "");
    if (format == "body") {
      scene.body = body::read_body(path);
      scene.meshes.push_back(plain_mesh(scene.body->skin, SKIN));
    } else if (format == "garment") {
      scene.garments.push_back(garment::read_garment(path));
      const garment::Garment& g = scene.garments.back();
      scene.meshes.push_back(cloth_mesh(g.panels, g.particle_of, g.position));
    } else if (format == "panels") {
      garment::Garment g;
      g.panels = pattern::read_panel_mesh(path);
      g.position = g.panels.placed;
      for (std::size_t v = 0; v < g.position.size(); ++v) g.particle_of.push_back(static_cast<int>(v));
      scene.meshes.push_back(cloth_mesh(g.panels, g.particle_of, g.position));
      scene.garments.push_back(std::move(g));
    } else {
      throw input_error(path, "/format", format.empty() ? "is not a Sloper document" : "a \"" + format + "\" document cannot be drawn",
                        "give body.json, shirt.json, panels.json or an OBJ file");
    }
  }
  std::size_t triangles = 0;
  for (const DrawMesh& m : scene.meshes) triangles += m.triangles.size();
  if (triangles == 0) throw input_error(paths.front(), "", "there is no triangle to draw");
  return scene;
}

} // namespace sloper::render

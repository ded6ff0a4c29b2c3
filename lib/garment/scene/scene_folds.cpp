#include <garment/levels/finer_mesh.hpp>
#include <garment/scene/fold_edges.hpp>
#include <garment/scene/panel_runs.hpp>
#include <sloper/garment/scene/scene_folds.hpp>
#include <sloper/pattern/mesh/fold_lines.hpp>
#include <sloper/pattern/mesh/folds.hpp>
#include <sloper/pattern/mesh/mesh_pattern.hpp>
#include <sloper/pattern/place/place_panels.hpp>

#include <algorithm>

namespace sloper::garment {

namespace {

constexpr double SNAP = 0.25;          // edge lengths: a line's end so near to a corner lies in it
constexpr double SAME_ID = 1e-6;       // in (s, t), of a vertex before and after
constexpr double MESHED_SHARE = 0.8;   // of a line that the mesh has edges along
const std::string OF_SCENE = "scene-"; // begins the names of its lines

/// A fold of a scene, as messages name it.
struct NamedFold {
  const SceneCrease* crease;
  std::string key, place; ///< "roll_lines-1", and its JSON pointer
};

/// Creases come before roll lines, each in the order of the document.
std::vector<NamedFold> folds_of(const Garment& garment) {
  int creases = 0, roll_lines = 0;
  std::vector<NamedFold> out;
  for (const SceneCrease& crease : garment.scene.creases) {
    const std::string index = std::to_string(crease.turns ? roll_lines++ : creases++);
    const std::string kind = crease.turns ? "roll_lines" : "creases";
    out.push_back({&crease, kind + "-" + index, "/" + kind + "/" + index});
  }
  return out;
}

bool has_roll_line(const pattern::Panel& panel) {
  return std::any_of(panel.lines.begin(), panel.lines.end(),
                     [](const pattern::InnerLine& line) { return line.kind == "roll"; });
}

/// A fold of a scene in the pattern.
struct DrawnFold {
  int panel;
  std::string place; ///< its JSON pointer
  pattern::Path path;
};

/// The pattern with the folds that the mesh lacks. @return these
std::vector<DrawnFold> draw_folds(const Garment& garment, const std::string& file,
                                  pattern::Pattern& pattern) {
  const pattern::Pattern& given = *garment.panels.source;
  std::vector<DrawnFold> out;
  for (const NamedFold& fold : folds_of(garment)) {
    const int p = given.find_panel(fold.crease->run.panel);
    if (p < 0)
      continue;
    const bool is_there =
        is_meshed(garment, *fold.crease) && (!fold.crease->turns || has_roll_line(given.panels[p]));
    if (is_there)
      continue;
    const pattern::Path path =
        pattern::on_panel(given.panels[p], fold_path(garment, *fold.crease),
                          SNAP * garment.panels.edge_length, file, fold.place);
    const std::string name = OF_SCENE + fold.key;
    pattern.panels[p].lines.push_back(fold.crease->turns
                                          ? pattern::roll_line(pattern, p, name, path)
                                          : pattern::InnerLine{name, "fold", path});
    out.push_back({p, fold.place, path});
  }
  return out;
}

/// Ids of edited panels stay as in the drawing before the edits.
void keep_ids(const pattern::PanelMesh& given, pattern::PanelMesh& mesh) {
  std::vector<Vec3> ids;
  for (const pattern::StableId& id : given.ids)
    ids.emplace_back(id.s, id.t, 0);
  const std::vector<Vec3> kept = interpolate(given, ids, mesh);
  for (std::size_t v = 0; v < kept.size(); ++v) {
    pattern::StableId& id = mesh.ids[v];
    const bool moved =
        std::abs(kept[v].x() - id.s) > SAME_ID || std::abs(kept[v].y() - id.t) > SAME_ID;
    if (moved)
      id = {id.panel, kept[v].x(), kept[v].y()};
  }
}

/// Folds of a mesh that stays.
std::vector<Message> off_mesh(const Garment& garment, const std::string& file) {
  std::vector<Message> out;
  for (const NamedFold& fold : folds_of(garment))
    if (!is_meshed(garment, *fold.crease))
      out.push_back({"scene.fold-off-mesh"_id,
                     file + ": " + fold.place + ": the mesh of panel " + fold.crease->run.panel +
                         " has no edges along this line, and is folded along those near it; drape "
                         "loose panels that know their pattern, or draw the line there"});
  return out;
}

/// Folds that a mesh of the pattern that draws them has no room for. Their ends may lie between
/// the outline and the first vertex off it.
std::vector<Message> left_out(const pattern::PanelMesh& mesh, const std::vector<DrawnFold>& folds,
                              const std::string& file) {
  std::vector<Message> out;
  for (const DrawnFold& fold : folds) {
    const pattern::PanelInfo& panel = mesh.panels[fold.panel];
    double meshed = 0;
    for (const auto& [a, b] : pattern::edges_along(mesh, panel, fold.path))
      meshed += (mesh.pattern[a] - mesh.pattern[b]).norm();
    if (meshed < MESHED_SHARE * (pattern::length(fold.path) - 2 * mesh.edge_length))
      out.push_back({"scene.fold-left-out"_id,
                     file + ": " + fold.place + ": the mesh of panel " + panel.name +
                         " has no edges along some of this line, which runs too near to the "
                         "outline or to another line for edges of " +
                         pattern::centimetres(mesh.edge_length) +
                         "; give a smaller --edge-length, or move the line"});
  }
  return out;
}

} // namespace

std::vector<Message> mesh_along_folds(Garment& garment, const body::Body* body,
                                      const std::string& skin, const std::string& file) {
  const bool is_loose = garment.particle_of.empty() && garment.panels.source;
  if (!is_loose)
    return off_mesh(garment, file);
  pattern::Pattern drawn = *garment.panels.source;
  const std::vector<DrawnFold> folds = draw_folds(garment, file, drawn);
  if (folds.empty())
    return {};
  const pattern::PanelMesh given = garment.panels;
  pattern::PanelMesh mesh = pattern::mesh_pattern(
      drawn, pattern::lengths_for_rolls(drawn, given.edge_length, given.seam_length), file);
  const bool is_placed_here =
      body && given.placement == pattern::Placement::BODY && given.body_sha256 == skin;
  if (is_placed_here)
    pattern::place_panels(drawn, *body, mesh);
  else
    mesh.placed = interpolate(given, given.placed, mesh);
  take_over(given, mesh);
  mesh.findings = given.findings;
  mesh.faults = given.faults;
  keep_ids(given, mesh);
  garment.panels = std::move(mesh);
  if (!garment.rest_scale.empty())
    garment.rest_scale = pattern::tape_scales(garment.panels);
  return left_out(garment.panels, folds, file);
}

} // namespace sloper::garment

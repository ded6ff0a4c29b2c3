#include <garment/retarget/drawn_pattern.hpp>

#include <sloper/pattern/mesh/boundary.hpp>
#include <sloper/pattern/mesh/folds.hpp>

namespace sloper::garment {

namespace {

constexpr double SAME_POINT = 1e-6; // m
constexpr double SAME_ID =
    1e-4; // of a panel's width and height: stable ids of what is the same vertex

/// Whether an outline of the mesh has the points of a drawn one: as many, at the same stable ids.
bool is_meshed_from(const Garment& garment, const pattern::PanelInfo& panel,
                    const std::vector<Vec2>& drawn) {
  if (panel.outline.size() != drawn.size())
    return false;
  Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
  for (const Vec2& p : drawn) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    const pattern::StableId& id = garment.panels.ids[panel.outline[i]];
    const Vec2 at = (drawn[i] - low).cwiseQuotient(high - low);
    if (!((at - Vec2(id.s, id.t)).cwiseAbs().maxCoeff() < SAME_ID))
      return false;
  }
  return true;
}

/// Of each edge of an outline that was cut where inner lines end on it, the edge that it was drawn
/// as.
std::vector<int> drawn_edges(const pattern::Panel& cut, const pattern::Panel& drawn) {
  std::vector<int> edges;
  std::size_t at = 0;
  for (const pattern::PanelEdge& piece : cut.loops[0]) {
    edges.push_back(static_cast<int>(at));
    const bool ends =
        (piece.path.back().p[3] - drawn.loops[0][at].path.back().p[3]).norm() < SAME_POINT;
    if (ends && at + 1 < drawn.loops[0].size())
      ++at;
  }
  return edges;
}

} // namespace

std::optional<DrawnPattern> drawn_pattern(const Garment& garment) {
  const pattern::PanelMesh& mesh = garment.panels;
  if (!mesh.source || mesh.source->panels.size() != mesh.panels.size() || !(mesh.edge_length > 0) ||
      mesh.ids.size() != mesh.pattern.size())
    return std::nullopt;
  DrawnPattern result;
  result.pattern = mesh.source.get();
  const pattern::Pattern cut = pattern::with_folds(*mesh.source, mesh.name); // as it was meshed
  const pattern::Boundary boundary =
      pattern::sample_boundary(cut, mesh.edge_length, mesh.name, mesh.seam_length);
  for (std::size_t k = 0; k < mesh.panels.size(); ++k) {
    const std::vector<Vec2>& drawn = boundary.panels[k].loops[0];
    if (mesh.panels[k].name != cut.panels[k].name ||
        !is_meshed_from(garment, mesh.panels[k], drawn))
      return std::nullopt;
    const std::vector<int> edges = drawn_edges(cut.panels[k], mesh.source->panels[k]);
    result.outlines.push_back(drawn);
    result.edge_of.emplace_back();
    for (std::size_t i = 0; i < drawn.size(); ++i)
      result.edge_of.back().push_back(edges[boundary.panels[k].edge_of[i]]);
  }
  return result;
}

} // namespace sloper::garment

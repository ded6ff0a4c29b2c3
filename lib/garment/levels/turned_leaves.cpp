#include <garment/levels/turned_leaves.hpp>
#include <sloper/collision/triangle_tree.hpp>
#include <sloper/pattern/mesh/folds.hpp>

#include <algorithm>

namespace sloper::garment {

namespace {

// m: a leaf of 7 cm that is turned under lies at most half of that beneath the fronts.
constexpr double DEEPEST_LEAF = 0.035;
constexpr double ROLL_ZONE = 0.008; // m from a roll line, in depth: there cloth is folded
// Cosine between the nearest cloth's normal and the direction from it: beside a free edge less.
constexpr double ABOVE = 0.7;
constexpr int LAYING_ROUNDS = 3; // the nearest cloth may be another once a particle has moved

/// Which vertices are turned over, and which triangles of the garment are neither turned nor
/// folded.
struct TurnedCloth {
  std::vector<char> leaf; ///< #P
  std::vector<Triangle> under;
};

TurnedCloth turned_cloth(const Garment& garment) {
  const pattern::PanelMesh& panels = garment.panels;
  const pattern::Folding folding = pattern::fold_panels(*panels.source, panels);
  TurnedCloth out;
  out.leaf.assign(garment.position.size(), 0);
  if (folding.depth.empty())
    return out;
  const std::vector<Triangle> triangles = garment.particle_triangles();
  std::vector<char> elsewhere(garment.position.size(), 0);
  for (std::size_t p = 0; p < panels.panels.size(); ++p) {
    const pattern::PanelInfo& info = panels.panels[p];
    const bool whole = pattern::turned_whole(panels.source->panels[p]);
    const auto depth = [&](int v) { return folding.depth[v]; };
    for (int v = info.first_vertex; v < info.first_vertex + info.n_vertices; ++v) {
      const int particle = garment.particle_of[v];
      if (whole || depth(v) <= -ROLL_ZONE)
        out.leaf[particle] = 1;
      else
        elsewhere[particle] = 1;
    }
    for (int f = info.first_triangle; f < info.first_triangle + info.n_triangles && !whole; ++f) {
      const Triangle& t = panels.triangles[f];
      if (std::all_of(t.begin(), t.end(), [&](int v) { return depth(v) >= 0; }))
        out.under.push_back(triangles[f]);
    }
  }
  for (std::size_t i = 0; i < out.leaf.size(); ++i)
    if (elsewhere[i])
      out.leaf[i] = 0; // sewn to what is not turned
  return out;
}

} // namespace

int lay_leaves_over(Garment& garment, double gap_m) {
  const pattern::PanelMesh& panels = garment.panels;
  if (!panels.source || panels.source->panels.size() != panels.panels.size())
    return 0;
  const TurnedCloth cloth = turned_cloth(garment);
  if (cloth.under.empty() || std::find(cloth.leaf.begin(), cloth.leaf.end(), 1) == cloth.leaf.end())
    return 0;
  const collision::TriangleTree tree(garment.position, cloth.under);
  const std::vector<Vec3> normals = vertex_normals({garment.position, cloth.under});
  std::vector<char> moved(garment.position.size(), 0);
  for (int round = 0; round < LAYING_ROUNDS; ++round)
    for (std::size_t i = 0; i < cloth.leaf.size(); ++i) {
      if (!cloth.leaf[i])
        continue;
      const collision::ClosestPoint near = tree.closest_point(garment.position[i], DEEPEST_LEAF);
      if (near.triangle < 0)
        continue;
      const Triangle& t = cloth.under[near.triangle];
      Vec3 normal = Vec3::Zero();
      for (std::size_t k = 0; k < 3; ++k)
        normal += near.barycentric[static_cast<int>(k)] * normals[t[k]];
      normal.normalize();
      const Vec3 off = garment.position[i] - near.point;
      const double above = off.dot(normal);
      if (above >= gap_m || std::abs(above) < ABOVE * off.norm())
        continue;
      garment.position[i] = near.point + gap_m * normal;
      moved[i] = 1;
    }
  return static_cast<int>(std::count(moved.begin(), moved.end(), 1));
}

} // namespace sloper::garment

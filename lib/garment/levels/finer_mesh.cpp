#include <garment/levels/finer_mesh.hpp>
#include <sloper/base/error.hpp>
#include <sloper/garment/sewing.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::garment {

namespace {

constexpr double ROUND = 0.75; // share of the way to the rounded surface (Boubekeur and Alexa 2008)
constexpr double MOST_BEYOND =
    0.6; // of a triangle: its plane is not followed further, beyond the outline

/// A place on a mesh.
struct Place {
  int triangle;
  Vec3 weights;
};

Vec3 barycentric_of(const std::array<Vec2, 3>& t, const Vec2& p) {
  const Vec2 e = t[1] - t[0], f = t[2] - t[0], d = p - t[0];
  const double area = e.x() * f.y() - e.y() * f.x();
  if (std::abs(area) < 1e-18)
    return {1, 0, 0};
  const double v = (d.x() * f.y() - d.y() * f.x()) / area,
               w = (e.x() * d.y() - e.y() * d.x()) / area;
  return {1 - v - w, v, w};
}

double distance2_to_edge(const Vec2& p, const Vec2& a, const Vec2& b) {
  const double length2 = (b - a).squaredNorm();
  const double s = length2 > 0 ? std::clamp((p - a).dot(b - a) / length2, 0.0, 1.0) : 0.0;
  return (a + s * (b - a) - p).squaredNorm();
}

Vec3 limited(const Vec3& weights) {
  const Vec3 w = weights.cwiseMax(-MOST_BEYOND).cwiseMin(1 + MOST_BEYOND);
  return w / w.sum();
}

const pattern::PanelInfo& panel_of_name(const pattern::PanelMesh& mesh, const std::string& name) {
  for (const pattern::PanelInfo& p : mesh.panels)
    if (p.name == name)
      return p;
  throw input_error("mesh.other-pattern"_id, "", "panel " + name,
                    "is not in the coarser mesh of the same pattern", "mesh the pattern again");
}

/// Looks at the last triangle first: neighbours come one after the other. Cost: vertices of one
/// times triangles of the other, by panel.
Place place_in(const pattern::PanelMesh& mesh, const pattern::PanelInfo& panel, const Vec2& p,
               int last) {
  const auto corners = [&](int f) {
    const Triangle& t = mesh.triangles[f];
    return std::array<Vec2, 3>{mesh.pattern[t[0]], mesh.pattern[t[1]], mesh.pattern[t[2]]};
  };
  double least = 1e300;
  Place nearest{panel.first_triangle, {1, 0, 0}};
  for (int k = -1; k < panel.n_triangles; ++k) {
    const int f = k < 0 ? last : panel.first_triangle + k;
    if (f < 0)
      continue;
    const std::array<Vec2, 3> t = corners(f);
    const Vec3 w = barycentric_of(t, p);
    if (w.minCoeff() >= 0)
      return {f, w};
    double off = 1e300;
    for (std::size_t side = 0; side < 3; ++side)
      off = std::min(off, distance2_to_edge(p, t[side], t[(side + 1) % 3]));
    if (off < least) {
      least = off;
      nearest = {f, limited(w)};
    }
  }
  return nearest;
}

std::vector<Place> places_of(const pattern::PanelMesh& from, const pattern::PanelMesh& mesh) {
  std::vector<Place> places(mesh.pattern.size());
  for (const pattern::PanelInfo& panel : mesh.panels) {
    const pattern::PanelInfo& same = panel_of_name(from, panel.name);
    int last = -1;
    for (int v = panel.first_vertex; v < panel.first_vertex + panel.n_vertices; ++v) {
      places[v] = place_in(from, same, mesh.pattern[v], last);
      last = places[v].triangle;
    }
  }
  return places;
}

} // namespace

std::vector<Vec3> interpolate(const pattern::PanelMesh& from, const std::vector<Vec3>& at,
                              const pattern::PanelMesh& mesh) {
  std::vector<Vec3> out;
  for (const Place& place : places_of(from, mesh)) {
    const Triangle& t = from.triangles[place.triangle];
    Vec3 p = Vec3::Zero();
    for (int k = 0; k < 3; ++k)
      p += place.weights[k] * at[t[k]];
    out.push_back(p);
  }
  return out;
}

void take_over(const pattern::PanelMesh& given, pattern::PanelMesh& mesh) {
  mesh.placement = given.placement;
  mesh.body_sha256 = given.body_sha256;
  for (pattern::PanelInfo& panel : mesh.panels)
    for (const pattern::PanelInfo& same : given.panels)
      if (same.name == panel.name) {
        panel.part = same.part;
        panel.material = same.material;
        panel.layer = same.layer;
        panel.in_folds = same.in_folds;
      }
  for (pattern::MeshSeam& seam : mesh.seams)
    for (const pattern::MeshSeam& same : given.seams)
      if (same.name == seam.name)
        seam.open = same.open;
}

Garment on_finer_mesh(const Garment& coarse, const pattern::PanelMesh& mesh) {
  const std::vector<Triangle> triangles = coarse.particle_triangles();
  std::vector<Vec3> normal(coarse.position.size(), Vec3::Zero());
  const auto at = [&](int i) -> const Vec3& { return coarse.position[i]; };
  for (const Triangle& t : triangles) {
    const Vec3 n = (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0]));
    for (int i : t)
      normal[i] += n;
  }
  for (Vec3& n : normal)
    n.normalize();
  std::vector<Vec3> position;
  for (const Place& place : places_of(coarse.panels, mesh)) {
    const Triangle& t = triangles[place.triangle];
    Vec3 flat = Vec3::Zero(), round = Vec3::Zero();
    for (int k = 0; k < 3; ++k)
      flat += place.weights[k] * at(t[k]);
    for (int k = 0; k < 3; ++k) {
      const int i = t[k];
      const Vec3& n = normal[i];
      round += place.weights[k] * (flat - n.dot(flat - at(i)) * n);
    }
    position.push_back((1 - ROUND) * flat + ROUND * round);
  }
  Garment fine = coarse;
  fine.panels = mesh;
  fine.bind = {};
  fine.rest_scale.clear();
  fine.converged = false;
  weld(fine, position);
  return fine;
}

} // namespace sloper::garment

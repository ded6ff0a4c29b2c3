#include <sloper/base/error.hpp>
#include <sloper/cloth/cloth_mesh.hpp>
#include <sloper/geometry/triangle_mesh.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace sloper::cloth {

namespace {

struct EdgeUse {
  int i, j;     // particles, i < j
  int triangle; // that has the edge
  int corner;   // edge runs from this corner to the next
  bool operator<(const EdgeUse& o) const {
    return std::tie(i, j, triangle) < std::tie(o.i, o.j, o.triangle);
  }
};

double flat_area(const RestTriangle& t) {
  const Vec2 a = t.flat[1] - t.flat[0], b = t.flat[2] - t.flat[0];
  return 0.5 * std::abs(a.x() * b.y() - a.y() * b.x());
}

double cotangent(const Vec2& at, const Vec2& p, const Vec2& q) {
  const Vec2 a = p - at, b = q - at;
  // A sliver's cotangent would make a hinge arbitrarily stiff; beyond 5.7 degrees it carries no
  // more shape.
  return std::clamp(a.dot(b) / std::max(std::abs(a.x() * b.y() - a.y() * b.x()), 1e-12), -10.0,
                    10.0);
}

/// Young's modulus per width along a direction of the pattern (warp is +y): linear in cos^2, as for
/// a plain weave's axes.
double stretch_along(const Fabric& fabric, const Vec2& direction) {
  const double c2 = direction.y() * direction.y() / std::max(direction.squaredNorm(), 1e-30);
  return c2 * fabric.stretch_warp_n_m + (1 - c2) * fabric.stretch_weft_n_m;
}

void add_hinge(ClothMesh& mesh, const EdgeUse& first, const EdgeUse& second) {
  const RestTriangle& s = mesh.triangles[first.triangle];
  const RestTriangle& t = mesh.triangles[second.triangle];
  Hinge hinge;
  hinge.particle = {first.i, first.j, s.particle[(first.corner + 2) % 3],
                    t.particle[(second.corner + 2) % 3]};
  if (hinge.particle[2] == hinge.particle[3])
    return;
  hinge.triangle = {first.triangle, second.triangle};
  hinge.corner = {first.corner, second.corner};
  // Cotangents at the two ends of the edge, each in its own triangle's flat shape: a seam has two.
  auto cotangents = [&](const RestTriangle& r, const EdgeUse& use) {
    const int from = use.corner, to = (use.corner + 1) % 3, apex = (use.corner + 2) % 3;
    const double at_from = cotangent(r.flat[from], r.flat[to], r.flat[apex]),
                 at_to = cotangent(r.flat[to], r.flat[from], r.flat[apex]);
    return r.particle[from] == use.i ? std::array<double, 2>{at_from, at_to}
                                     : std::array<double, 2>{at_to, at_from};
  };
  const auto ca = cotangents(s, first), cb = cotangents(t, second);
  hinge.coefficient = {ca[1] + cb[1], ca[0] + cb[0], -(ca[0] + ca[1]), -(cb[0] + cb[1])};
  const double areas = flat_area(s) + flat_area(t);
  // Weight 1 / (A0 + A1): with it an equilateral mesh has the rigidity B (Seung and Nelson 1988);
  // the 3 / (A0 + A1) of Bergou et al. 2006 is three times too stiff against the elastica.
  hinge.stiffness =
      1.0 / areas * 0.5 * (mesh.fabrics[s.fabric].bend_n_m + mesh.fabrics[t.fabric].bend_n_m);
  mesh.hinges.push_back(hinge);
}

} // namespace

std::vector<Triangle> ClothMesh::particle_triangles() const {
  std::vector<Triangle> out;
  out.reserve(triangles.size());
  for (const RestTriangle& t : triangles)
    out.push_back(t.particle);
  return out;
}

ClothMesh make_cloth_mesh(int n_particles, std::vector<RestTriangle> triangles,
                          std::vector<Fabric> fabrics,
                          const std::vector<std::array<double, 3>>& rest_scale) {
  ClothMesh mesh;
  mesh.n_particles = n_particles;
  mesh.triangles = std::move(triangles);
  mesh.fabrics = std::move(fabrics);
  const auto n = static_cast<std::size_t>(n_particles);
  mesh.mass.assign(n, 0);
  mesh.area.assign(n, 0);
  mesh.shortest_edge.assign(n, 1e300);

  std::vector<EdgeUse> uses;
  uses.reserve(mesh.triangles.size() * 3);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const RestTriangle& t = mesh.triangles[f];
    const double area = flat_area(t);
    if (area < 1e-12)
      throw input_error("garment.flat-triangle"_id, "", "triangle " + std::to_string(f),
                        "has no area in the pattern", "mesh the pattern again with pattern-mesh");
    for (int k = 0; k < 3; ++k) {
      mesh.area[t.particle[k]] += area / 3;
      mesh.mass[t.particle[k]] += area / 3 * mesh.fabrics[t.fabric].density_kg_m2;
      const int a = t.particle[k], b = t.particle[(k + 1) % 3];
      uses.push_back({std::min(a, b), std::max(a, b), static_cast<int>(f), k});
    }
  }
  for (int p = 0; p < n_particles; ++p)
    if (mesh.mass[p] <= 0)
      throw input_error("garment.damaged"_id, "", "particle " + std::to_string(p),
                        "belongs to no triangle");

  std::sort(uses.begin(), uses.end());
  for (std::size_t u = 0; u < uses.size();) {
    std::size_t end = u;
    EdgeSpring spring{uses[u].i, uses[u].j, 0, 0, 0};
    double areas = 0, lengths = 0, modulus = 0, damping = 0;
    for (; end < uses.size() && uses[end].i == uses[u].i && uses[end].j == uses[u].j; ++end) {
      const RestTriangle& t = mesh.triangles[uses[end].triangle];
      const int k = uses[end].corner;
      const Vec2 d = t.flat[(k + 1) % 3] - t.flat[k];
      const double area = flat_area(t),
                   scale = rest_scale.empty() ? 1 : rest_scale[uses[end].triangle][k];
      lengths += d.norm() * scale;
      areas += area;
      modulus += area * stretch_along(mesh.fabrics[t.fabric], d);
      damping += area * mesh.fabrics[t.fabric].damping_s;
    }
    const auto count = static_cast<double>(end - u);
    spring.rest_length = std::max(lengths / count, 1e-6);
    spring.stiffness = modulus / (spring.rest_length * spring.rest_length);
    spring.damping_s = damping / areas;
    mesh.edges.push_back({spring.i, spring.j});
    mesh.springs.push_back(spring);
    for (int p : {spring.i, spring.j})
      mesh.shortest_edge[p] = std::min(mesh.shortest_edge[p], spring.rest_length);
    if (end - u == 2)
      add_hinge(mesh, uses[u],
                uses[u + 1]); // three or more panels on one line bend freely against each other
    u = end;
  }
  return mesh;
}

double ClothMesh::mean_edge() const {
  double sum = 0;
  for (const EdgeSpring& s : springs)
    sum += s.rest_length;
  return sum / static_cast<double>(springs.size());
}

} // namespace sloper::cloth

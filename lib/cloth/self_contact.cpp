#include <cloth/self_contact.hpp>
#include <collision/intersections.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::cloth {

/// A particle may use this share of the distance to its neighbours before they are looked at again; below 1/2 nothing crosses.
static constexpr double GAMMA = 0.45;
/// Contact thickness is at most this share of the shortest edge around, so that cloth does not push its own next row away.
static constexpr double THICKNESS_PER_EDGE = 0.35;
/// Friction reaches its full size at this sliding distance per step, m.
static constexpr double FULL_FRICTION_SLIDE = 1e-4;

SelfContactEffect::SelfContactEffect(const ClothMesh& mesh, const SelfContactOptions& options, std::vector<std::vector<int>> never_collide)
    : m_mesh(mesh), m_options(options), m_proximity(mesh.n_particles, mesh.particle_triangles(), never_collide), m_thickness(mesh.n_particles),
      m_last_dx(mesh.n_particles, Vec3::Zero()) {
  for (int i = 0; i < mesh.n_particles; ++i) m_thickness[i] = std::min(options.thickness_m, THICKNESS_PER_EDGE * mesh.shortest_edge[i]);
}

void SelfContactEffect::set_search(double search_m) {
  m_options.search_m = search_m;
  m_stale = true;
}

void SelfContactEffect::search(const std::vector<Vec3>& x) {
  m_proximity.update(x, m_options.search_m, m_crossings);
  if (m_look_for_crossings) {
    m_crossings = collision::self_intersections(x, m_proximity.triangles(), m_proximity.tree());
    if (!m_crossings.empty()) m_proximity.update(x, m_options.search_m, m_crossings);
    m_look_for_crossings = !m_crossings.empty();
  }
  m_bound = m_proximity.displacement_bound(GAMMA);
  m_searched_at = x;
  m_stale = false;
  ++searches;
}

void SelfContactEffect::begin_step(const std::vector<Vec3>& x, double) {
  if (m_stale) search(x);
}

void SelfContactEffect::add_pair(StepContext& c, const std::array<int, 4>& particle, const std::array<double, 4>& weight) {
  // weight is +w on one side and -w on the other, so that the weighted sum is the vector from the second point to the first
  Vec3 d = Vec3::Zero();
  double thickness = 1e300, area = 0;
  for (int k = 0; k < 4; ++k) {
    d += weight[k] * c.x[particle[k]];
    thickness = std::min(thickness, m_thickness[particle[k]]);
    area += std::abs(weight[k]) * m_mesh.area[particle[k]];
  }
  const double distance = d.norm();
  if (distance >= thickness || distance < 1e-12) return;
  // E = k A (t - d)^3 / (6 t), as for the body; where little distance is left both grow with 1/d, so that a gap remains.
  const double barrier = std::max(1.0, 0.4 * thickness / distance), depth = thickness - distance;
  const double stiff = 0.5 * m_options.stiffness_n_m3 * area * depth / thickness * barrier;
  ContactElement e;
  e.n = 4;
  e.particle = particle;
  e.weight = weight;
  e.normal = d / distance;
  const double push = 0.5 * stiff * depth;
  e.normal_stiffness = stiff * barrier;
  e.force = push * e.normal;
  if (m_options.friction > 0) { // regularised Coulomb on the slide of the last step
    Vec3 slide = Vec3::Zero();
    for (int k = 0; k < 4; ++k) slide += weight[k] * m_last_dx[particle[k]];
    slide -= slide.dot(e.normal) * e.normal;
    e.tangent_stiffness = m_options.friction * push / std::max(slide.norm(), FULL_FRICTION_SLIDE);
  }
  c.elements.push_back(e);
}

void SelfContactEffect::add(StepContext& c) {
  for (const auto& pair : m_proximity.vertex_face()) {
    if (pair.exempt) continue;
    const Triangle& t = m_proximity.triangles()[pair.triangle];
    const auto p = collision::point_triangle(c.x[pair.vertex], c.x[t[0]], c.x[t[1]], c.x[t[2]]);
    add_pair(c, {pair.vertex, t[0], t[1], t[2]}, {1, -p.barycentric[0], -p.barycentric[1], -p.barycentric[2]});
  }
  for (const auto& pair : m_proximity.edge_edge()) {
    if (pair.exempt) continue;
    const auto& a = m_proximity.topology().edges[pair.edge_a];
    const auto& b = m_proximity.topology().edges[pair.edge_b];
    const auto p = collision::edge_edge(c.x[a[0]], c.x[a[1]], c.x[b[0]], c.x[b[1]]);
    if (p.s <= 0 || p.s >= 1 || p.t <= 0 || p.t >= 1) continue; // an end point: a vertex-face pair speaks for it
    add_pair(c, {a[0], a[1], b[0], b[1]}, {1 - p.s, p.s, p.t - 1, -p.t});
  }
}

double SelfContactEffect::room(int particle, const Vec3& x) const { return std::max(0.0, m_bound[particle] - (x - m_searched_at[particle]).norm()); }

void SelfContactEffect::limit(const std::vector<Vec3>& x, std::vector<Vec3>& dx) {
  for (std::size_t i = 0; i < dx.size(); ++i) {
    const double move = dx[i].norm();
    // The bound is on the way from where the search was made; staying inside its ball needs no step length.
    if ((x[i] + dx[i] - m_searched_at[i]).norm() > m_bound[i]) {
      const double have = room(static_cast<int>(i), x[i]);
      if (move > have) {
        dx[i] *= have / move;
        m_stale = true;
      }
    }
    m_last_dx[i] = dx[i];
  }
}

} // namespace sloper::cloth

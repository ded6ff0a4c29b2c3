#include <cloth/self_contact.hpp>
#include <collision/intersections.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::cloth {

/// A particle goes at most this share of the search radius before the next search; below 1/2 nothing unseen crosses.
static constexpr double GAMMA = 0.45;
/// A particle stays this share of half the distance away from the separating plane.
static constexpr double PLANE_MARGIN = 0.1;
/// Contact thickness is at most this share of the shortest edge around, so that cloth does not push its own next row away.
static constexpr double THICKNESS_PER_EDGE = 0.35;
/// A seam counts as closed at a stitch of this length, m.
static constexpr double CLOSED_SEAM = 0.0015;
/// Friction reaches its full size at this sliding distance per step, m.
static constexpr double FULL_FRICTION_SLIDE = 1e-4;

SelfContactEffect::SelfContactEffect(const ClothMesh& mesh, const SelfContactOptions& options, std::vector<int> seam_class)
    : m_mesh(mesh), m_options(options), m_proximity(mesh.n_particles, mesh.particle_triangles()), m_seam_class(std::move(seam_class)),
      m_thickness(mesh.n_particles), m_last_dx(mesh.n_particles, Vec3::Zero()) {
  for (int i = 0; i < mesh.n_particles; ++i) m_thickness[i] = std::min(options.thickness_m, THICKNESS_PER_EDGE * mesh.shortest_edge[i]);
  m_closed.assign(m_seam_class.empty() ? 0 : 1 + std::max(-1, *std::max_element(m_seam_class.begin(), m_seam_class.end())), 0);
}

SelfContactEffect::Pair SelfContactEffect::kind_of(const int* a, int n_a, const int* b, int n_b) const {
  if (m_seam_class.empty()) return Pair::FREE;
  Pair kind = Pair::FREE;
  for (int i = 0; i < n_a; ++i)
    for (int j = 0; j < n_b; ++j) {
      const int c = m_seam_class[a[i]];
      if (c < 0 || c != m_seam_class[b[j]]) continue;
      if (m_closed[c]) return Pair::CLOSED_SEAM;
      kind = Pair::OPEN_SEAM;
    }
  return kind;
}

void SelfContactEffect::find_closed_seams(const std::vector<Vec3>& x) {
  std::vector<int> first(m_closed.size(), -1);
  std::fill(m_closed.begin(), m_closed.end(), 1);
  for (int i = 0; i < m_mesh.n_particles; ++i) {
    const int c = m_seam_class[i];
    if (c < 0) continue;
    if (first[c] < 0) first[c] = i;
    else if ((x[i] - x[first[c]]).norm() > CLOSED_SEAM) m_closed[c] = 0;
  }
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
  if (!m_seam_class.empty()) find_closed_seams(x);
  m_pairs.clear();
  auto take = [&](const std::array<int, 4>& p, int n_first, bool is_edge, const Vec3& first, const Vec3& second) {
    const Pair kind = kind_of(p.data(), n_first, p.data() + n_first, 4 - n_first);
    const double distance = (first - second).norm();
    if (kind == Pair::CLOSED_SEAM || distance < 1e-12) return;
    const Vec3 normal = (first - second) / distance;
    m_pairs.push_back({p, is_edge, kind == Pair::FREE, normal, 0.5 * normal.dot(first + second), distance});
  };
  for (const auto& pair : m_proximity.vertex_face()) {
    const Triangle& t = m_proximity.triangles()[pair.triangle];
    if (!pair.exempt)
      take({pair.vertex, t[0], t[1], t[2]}, 1, false, x[pair.vertex],
           pair.barycentric[0] * x[t[0]] + pair.barycentric[1] * x[t[1]] + pair.barycentric[2] * x[t[2]]);
  }
  for (const auto& pair : m_proximity.edge_edge()) {
    const auto& a = m_proximity.topology().edges[pair.edge_a];
    const auto& b = m_proximity.topology().edges[pair.edge_b];
    if (!pair.exempt) take({a[0], a[1], b[0], b[1]}, 2, true, (1 - pair.s) * x[a[0]] + pair.s * x[a[1]], (1 - pair.t) * x[b[0]] + pair.t * x[b[1]]);
  }
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
  for (const Near& near : m_pairs) {
    if (!near.repels) continue;
    const auto& p = near.particle;
    if (near.is_edge) {
      const auto e = collision::edge_edge(c.x[p[0]], c.x[p[1]], c.x[p[2]], c.x[p[3]]);
      if (e.s <= 0 || e.s >= 1 || e.t <= 0 || e.t >= 1) continue; // an end point: a vertex-face pair speaks for it
      add_pair(c, p, {1 - e.s, e.s, e.t - 1, -e.t});
    } else {
      const auto t = collision::point_triangle(c.x[p[0]], c.x[p[1]], c.x[p[2]], c.x[p[3]]);
      add_pair(c, p, {1, -t.barycentric[0], -t.barycentric[1], -t.barycentric[2]});
    }
  }
}

void SelfContactEffect::limit(const std::vector<Vec3>& x, std::vector<Vec3>& dx, std::vector<char>& held) {
  // First the part of a motion that runs into a plane is taken off, which leaves sliding; then what still breaks a plane or
  // the ball around the place of the search is shortened, which always helps: the present state keeps them all.
  auto over = [&](const Near& near, int k, double& along) { // by how much dx may not go towards the plane; > 0: too far
    const int i = near.particle[k];
    const double side = k < (near.is_edge ? 2 : 1) ? 1 : -1;
    const double room = std::max(0.0, side * (near.normal.dot(x[i]) - near.level) - PLANE_MARGIN * 0.5 * near.distance);
    along = -side * near.normal.dot(dx[i]);
    return along - room;
  };
  for (const Near& near : m_pairs)
    for (int k = 0; k < 4; ++k) {
      double along;
      const double excess = over(near, k, along);
      if (excess <= 0) continue;
      dx[near.particle[k]] += (k < (near.is_edge ? 2 : 1) ? 1 : -1) * excess * near.normal;
      held[near.particle[k]] = 1;
      m_stale = true;
    }
  m_share.assign(dx.size(), 1);
  for (const Near& near : m_pairs)
    for (int k = 0; k < 4; ++k) {
      double along;
      const double excess = over(near, k, along);
      if (excess > 1e-9 * near.distance) m_share[near.particle[k]] = std::min(m_share[near.particle[k]], std::max(0.0, (along - excess) / along));
    }
  const double radius = GAMMA * m_options.search_m;
  for (std::size_t i = 0; i < dx.size(); ++i) {
    if (m_share[i] < 1) dx[i] *= m_share[i];
    const double move = dx[i].norm();
    if ((x[i] + dx[i] - m_searched_at[i]).norm() > radius) {
      const double have = std::max(0.0, radius - (x[i] - m_searched_at[i]).norm());
      if (move > have) dx[i] *= have / move;
      m_stale = true;
    }
    m_last_dx[i] = dx[i];
  }
}

} // namespace sloper::cloth

#include <sloper/cloth/contact/self_contact.hpp>
#include <sloper/collision/intersections.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::cloth {

/// A particle goes at most this share of the search radius before the next search; below 1/2
/// nothing unseen crosses.
static constexpr double GAMMA = 0.45;
/// Cloth is searched again when a particle has used this share of that.
static constexpr double USED = 0.6;
/// A particle stays this share of half the distance away from the separating plane.
static constexpr double PLANE_MARGIN = 0.1;
/// Contact thickness is at most this share of the shortest edge around, so that cloth does not push
/// its own next row away.
static constexpr double THICKNESS_PER_EDGE = 0.35;
/// The search radius is at most this share of the mean edge: flat cloth finds few of its own next
/// rows.
static constexpr double SEARCH_PER_EDGE = 0.6;
/// A seam counts as closed at a stitch of this length, m.
static constexpr double CLOSED_SEAM = 0.0015;
/// Friction reaches its full size at this sliding distance per step, m.
static constexpr double FULL_FRICTION_SLIDE = 1e-4;

SelfContactEffect::SelfContactEffect(const ClothMesh& mesh, const SelfContactOptions& options,
                                     std::vector<int> seam_class)
    : m_mesh(mesh), m_options(options), m_proximity(mesh.n_particles, mesh.particle_triangles()),
      m_closing(m_proximity.triangles(), m_proximity.topology()),
      m_seam_class(std::move(seam_class)), m_thickness(mesh.n_particles),
      m_last_dx(mesh.n_particles, Vec3::Zero()) {
  for (int i = 0; i < mesh.n_particles; ++i)
    m_thickness[i] = std::min(options.thickness_m, THICKNESS_PER_EDGE * mesh.shortest_edge[i]);
  if (!m_thickness.empty())
    m_reach = *std::max_element(m_thickness.begin(), m_thickness.end());
  double mean_edge = 0;
  for (const EdgeSpring& s : mesh.springs)
    mean_edge += s.rest_length / static_cast<double>(mesh.springs.size());
  if (mean_edge > 0)
    m_options.search_m = std::min(m_options.search_m, SEARCH_PER_EDGE * mean_edge);
  m_reach = std::min(m_reach, m_options.search_m);
  m_closed.assign(m_seam_class.empty() ? 0
                                       : 1 + std::max(-1, *std::max_element(m_seam_class.begin(),
                                                                            m_seam_class.end())),
                  0);
}

SelfContactEffect::Pair SelfContactEffect::kind_of(const int* a, int n_a, const int* b,
                                                   int n_b) const {
  const auto passes = [&](int particle) { return m_passes[particle] != 0; };
  if (!m_passes.empty() && std::all_of(a, a + n_a, passes) && std::all_of(b, b + n_b, passes))
    return Pair::PASSES;
  if (m_seam_class.empty())
    return Pair::FREE;
  Pair kind = Pair::FREE;
  for (int i = 0; i < n_a; ++i)
    for (int j = 0; j < n_b; ++j) {
      const int c = m_seam_class[a[i]];
      if (c < 0 || c != m_seam_class[b[j]])
        continue;
      if (m_closed[c])
        return Pair::PASSES;
      kind = Pair::OPEN_SEAM;
    }
  return kind;
}

void SelfContactEffect::let_pass(std::vector<char> passes) {
  m_passes = std::move(passes);
  refresh();
}

void SelfContactEffect::find_closed_seams(const std::vector<Vec3>& x) {
  std::vector<int> first(m_closed.size(), -1);
  std::fill(m_closed.begin(), m_closed.end(), 1);
  for (int i = 0; i < m_mesh.n_particles; ++i) {
    const int c = m_seam_class[i];
    if (c < 0)
      continue;
    if (first[c] < 0)
      first[c] = i;
    else if ((x[i] - x[first[c]]).norm() > CLOSED_SEAM)
      m_closed[c] = 0;
  }
}

void SelfContactEffect::search(const std::vector<Vec3>& x) {
  m_radius = m_fast && !m_look_for_crossings ? m_reach : m_options.search_m;
  m_crossings.clear(); // those of before say nothing of x
  m_proximity.update(x, m_radius);
  if (m_look_for_crossings) {
    m_crossings = collision::self_intersections(x, m_proximity.triangles(), m_proximity.tree());
    if (!m_crossings.empty())
      m_proximity.update(x, m_radius, m_crossings);
    m_look_for_crossings = !m_crossings.empty();
  }
  if (!m_seam_class.empty())
    find_closed_seams(x);
  m_pairs.clear();
  auto take = [&](const std::array<int, 4>& p, int n_first, bool is_edge, double distance) {
    const Pair kind = kind_of(p.data(), n_first, p.data() + n_first, 4 - n_first);
    if (kind == Pair::PASSES)
      return;
    Near near{p, is_edge, distance};
    if (kind == Pair::FREE)
      near.reach = std::min(std::min(m_thickness[p[0]], m_thickness[p[1]]),
                            std::min(m_thickness[p[2]], m_thickness[p[3]]));
    m_pairs.push_back(near);
  };
  for (const auto& pair : m_proximity.vertex_face()) {
    const Triangle& t = m_proximity.triangles()[pair.triangle];
    if (!pair.exempt)
      take({pair.vertex, t[0], t[1], t[2]}, 1, false, pair.distance);
  }
  for (const auto& pair : m_proximity.edge_edge()) {
    const auto& a = m_proximity.topology().edges[pair.edge_a];
    const auto& b = m_proximity.topology().edges[pair.edge_b];
    if (!pair.exempt)
      take({a[0], a[1], b[0], b[1]}, 2, true, pair.distance);
  }
  m_searched_at = x;
  m_stale = false;
  ++searches;
}

const std::vector<std::array<int, 2>>&
SelfContactEffect::find_crossings(const std::vector<Vec3>& x) {
  m_look_for_crossings = true;
  search(x);
  return m_crossings;
}

void SelfContactEffect::begin_step(const std::vector<Vec3>& x, double) {
  look(x);
  m_x_before = x;
  m_again = false;
}

void SelfContactEffect::update_contacts(const std::vector<Vec3>& x, double) {
  look(x);
  m_again = true;
}

void SelfContactEffect::look(const std::vector<Vec3>& x) {
  const double used = USED * GAMMA * m_radius;
  m_stale = m_stale || !m_crossings.empty();
  for (std::size_t i = 0; !m_stale && i < x.size(); ++i)
    m_stale = (x[i] - m_searched_at[i]).squaredNorm() > used * used;
  if (m_stale)
    search(x);
  m_moved.resize(x.size());
  for (std::size_t i = 0; i < x.size(); ++i)
    m_moved[i] = (x[i] - m_searched_at[i]).norm();
  m_closing_stale = true;
  for (auto& guarded : m_guarded_closing)
    guarded.clear();
}

SelfContactEffect::Closest SelfContactEffect::closest(const Near& near,
                                                      const std::vector<Vec3>& x) const {
  const auto& p = near.particle;
  Closest c;
  if (near.is_edge) {
    const auto e = collision::edge_edge(x[p[0]], x[p[1]], x[p[2]], x[p[3]]);
    c.weight = {1 - e.s, e.s, e.t - 1, -e.t};
  } else {
    const auto t = collision::point_triangle(x[p[0]], x[p[1]], x[p[2]], x[p[3]]);
    c.weight = {1, -t.barycentric[0], -t.barycentric[1], -t.barycentric[2]};
  }
  c.first = c.second = Vec3::Zero();
  for (int k = 0; k < near.n_first(); ++k)
    c.first += c.weight[k] * x[p[k]];
  for (int k = near.n_first(); k < 4; ++k)
    c.second -= c.weight[k] * x[p[k]];
  c.distance = (c.first - c.second).norm();
  return c;
}

double SelfContactEffect::stiffness_of(const Near& near, const Closest& c,
                                       const std::vector<Vec3>& x) const {
  const auto& p = near.particle;
  double area = 0;
  for (int k = 0; k < 4; ++k)
    area += std::abs(c.weight[k]) * m_mesh.area[p[k]];
  const double share = near.is_edge ? edge_edge_mollifier(x[p[1]] - x[p[0]], x[p[3]] - x[p[2]]) : 1;
  return 0.5 * share * m_options.stiffness_n_m3 * area;
}

double SelfContactEffect::closing(const Near& near, const std::vector<double>& length) {
  const auto& p = near.particle;
  const double last = std::max(length[p[2]], length[p[3]]);
  return near.is_edge ? std::max(length[p[0]], length[p[1]]) + last
                      : length[p[0]] + std::max(length[p[1]], last);
}

/// Most pairs are too far apart to repel each other or to meet in one step, and are not looked at.
void SelfContactEffect::add(StepContext& context) {
  for (Near& near : m_pairs) {
    near.guarded = false;
    near.stiffness = -1;
    if (near.distance - closing(near, m_moved) >= near.reach)
      continue;
    const Closest c = closest(near, context.x);
    if (c.distance < 1e-12) {
      near.guarded = true;
      continue;
    }
    near.stiffness = stiffness_of(near, c, context.x);
    const ContactResponse p = evaluate_contact_potential(c.distance, near.reach, near.stiffness);
    if (p.force > 0) {
      ContactElement e;
      e.n = 4;
      e.particle = near.particle;
      e.weight = c.weight;
      e.normal = (c.first - c.second) / c.distance;
      e.normal_stiffness = p.stiffness;
      e.force = p.force * e.normal;
      if (m_options.friction > 0) { // regularised Coulomb on the slide of the last step
        Vec3 last = Vec3::Zero(), now = Vec3::Zero();
        for (int k = 0; k < 4; ++k) {
          last += c.weight[k] * m_last_dx[near.particle[k]];
          if (m_again)
            now += c.weight[k] * (context.x[near.particle[k]] - m_x_before[near.particle[k]]);
        }
        last -= last.dot(e.normal) * e.normal;
        e.tangent_stiffness =
            m_options.friction * p.force / std::max(last.norm(), FULL_FRICTION_SLIDE);
        if (m_again)
          e.force -= e.tangent_stiffness * (now - now.dot(e.normal) * e.normal);
      }
      context.elements.push_back(e);
    }
    if (context.limits) {
      guard(near, c, *context.limits);
      near.guarded = true;
    }
  }
}

void SelfContactEffect::guard(const Near& near, const Closest& c, MotionLimits& limits) const {
  const Vec3 normal = (c.first - c.second) / c.distance;
  const double middle = 0.5 * normal.dot(c.first + c.second),
               margin = 0.5 * PLANE_MARGIN * c.distance;
  limits.planes.push_back(
      {4, near.n_first(), near.particle, normal, middle + margin, middle - margin});
}

/// How far a particle may go whatever the others do, m.
double SelfContactEffect::safe_move(std::size_t particle) const {
  return std::max(0.0, GAMMA * m_radius - m_moved[particle]);
}

bool SelfContactEffect::guard_closing(const std::vector<std::array<int, 2>>& pairs, bool is_edge,
                                      const std::vector<Vec3>& x, MotionLimits& limits) {
  bool added = false;
  for (const std::array<int, 2>& pair : pairs) {
    if (is_edge ? m_proximity.has_edge_edge(pair) : m_proximity.has_vertex_face(pair))
      continue; // add() guards those that it should
    Near near{{}, is_edge};
    if (is_edge) {
      const auto &a = m_proximity.topology().edges[pair[0]],
                 &b = m_proximity.topology().edges[pair[1]];
      near.particle = {a[0], a[1], b[0], b[1]};
    } else {
      const Triangle& t = m_proximity.triangles()[pair[1]];
      near.particle = {pair[0], t[0], t[1], t[2]};
    }
    const int n_first = is_edge ? 2 : 1;
    if (kind_of(near.particle.data(), n_first, near.particle.data() + n_first, 4 - n_first) ==
        Pair::PASSES)
      continue;
    const Closest c = closest(near, x);
    if (c.distance < 1e-12 || !m_guarded_closing[is_edge].insert(pair).second)
      continue;
    guard(near, c, limits);
    added = true;
  }
  return added;
}

/// Guards those near pairs that add() left out and that the displacement may bring together.
bool SelfContactEffect::guard_near(const std::vector<Vec3>& x, const std::vector<Vec3>& dx,
                                   MotionLimits& limits) {
  m_length.resize(dx.size());
  for (std::size_t i = 0; i < dx.size(); ++i)
    m_length[i] = dx[i].norm();
  bool added = false;
  for (Near& near : m_pairs) {
    if (near.guarded ||
        closing(near, m_length) < (1 - PLANE_MARGIN) * (near.distance - closing(near, m_moved)))
      continue;
    near.guarded = true;
    const Closest c = closest(near, x);
    if (c.distance < 1e-12)
      continue; // no plane separates them
    guard(near, c, limits);
    added = true;
  }
  return added;
}

bool SelfContactEffect::add_separating_planes(const std::vector<Vec3>& x,
                                              const std::vector<Vec3>& dx, MotionLimits& limits,
                                              bool last) {
  const bool more = guard_near(x, dx, limits);
  m_far.resize(x.size());
  for (std::size_t i = 0; i < x.size(); ++i)
    m_far[i] = m_length[i] > safe_move(i) + 1e-12;
  if (std::find(m_far.begin(), m_far.end(), 1) == m_far.end())
    return more;
  if (last || !m_crossings.empty()) { // of cloth that crosses nobody can tell which side is right
    for (std::size_t i = 0; i < x.size(); ++i)
      limits.max_displacement[i] = std::min(limits.max_displacement[i], safe_move(i));
    return true;
  }
  const double farthest = *std::max_element(m_moved.begin(), m_moved.end());
  const double apart = std::max(0.0, m_radius - 2 * farthest); // all nearer pairs were found
  m_closing.find(x, dx, m_far, !m_closing_stale, apart);
  m_closing_stale = false;
  ++far_searches;
  const bool faces = guard_closing(m_closing.vertex_face(), false, x, limits);
  return guard_closing(m_closing.edge_edge(), true, x, limits) || faces || more;
}

double SelfContactEffect::energy(const std::vector<Vec3>& x) const {
  if (m_pairs.empty())
    return 0;
  m_length.resize(x.size());
  for (std::size_t i = 0; i < x.size(); ++i)
    m_length[i] = (x[i] - m_searched_at[i]).norm();
  double sum = 0;
  for (const Near& near : m_pairs) {
    if (near.distance - closing(near, m_length) >= near.reach)
      continue;
    const Closest c = closest(near, x);
    if (c.distance < near.reach)
      sum += evaluate_contact_potential(c.distance, near.reach,
                                        near.stiffness >= 0 ? near.stiffness
                                                            : stiffness_of(near, c, x))
                 .energy;
  }
  return sum;
}

void SelfContactEffect::end_step(const std::vector<Vec3>& x) {
  double farthest2 = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    m_last_dx[i] = x[i] - m_x_before[i];
    farthest2 = std::max(farthest2, m_last_dx[i].squaredNorm());
  }
  const double safe = GAMMA * m_options.search_m;
  m_fast = farthest2 > safe * safe;
}

} // namespace sloper::cloth

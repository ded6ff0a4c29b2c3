#include <sloper/base/parallel.hpp>
#include <sloper/base/units.hpp>
#include <sloper/cloth/contact/body_contact.hpp>
#include <sloper/cloth/contact/contact_element.hpp>
#include <sloper/cloth/contact/contact_potential.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::cloth {

namespace {

/// In one step an element uses at most this share of its distance to the skin.
constexpr double APPROACH = 0.7;
/// A crossed pair is pushed as if at most this deep, m: a deep start is pushed out, not shot out.
constexpr double DEEPEST = 0.002;
/// Each time that crossings are looked for and found, crossed pairs are pushed harder by this
/// factor, up to a limit.
constexpr double HARDER = 1.3, HARDEST = 100;
/// The line between a crossed pair is along its normal only within 60 degrees of the skin's:
/// beyond, its sign would be noise.
constexpr double CONE = 0.5;
/// m; at less the line between the closest points of a pair has no direction.
constexpr double TOUCHING = 1e-12;

/// Of a crossed pair, d <= 0 below the skin: a spring of constant stiffness beyond the reach.
ContactResponse push_out_of(double d, double reach, double k) {
  ContactResponse p;
  if (d >= reach)
    return p;
  const double depth = std::min(reach - d, reach + DEEPEST);
  p.force = 0.5 * k * depth;
  p.stiffness = 0.5 * k;
  p.energy = 0.25 * k * depth * depth;
  return p;
}

} // namespace

BodyContactEffect::BodyContactEffect(const ClothMesh& mesh, collision::BodyCollider& body,
                                     const BodyContactOptions& options)
    : m_mesh(mesh), m_body(body), m_options(options), m_triangles(mesh.particle_triangles()),
      m_topology(collision::make_topology(mesh.n_particles, m_triangles)),
      m_clearance(mesh.n_particles), m_load(mesh.n_particles, Vec3::Zero()),
      m_load_stiffness(mesh.n_particles), m_tangent(mesh.n_particles),
      m_anchor(mesh.n_particles, Vec3::Zero()), m_carried(m_anchor),
      m_has_anchor(mesh.n_particles, 0) {
  m_edge_area.assign(m_topology.edges.size(), 0);
  for (std::size_t f = 0; f < m_triangles.size(); ++f) {
    const auto& flat = mesh.triangles[f].flat;
    const Vec2 a = flat[1] - flat[0], b = flat[2] - flat[0];
    m_face_area.push_back(0.5 * std::abs(a.x() * b.y() - a.y() * b.x()));
    m_longest_edge.push_back(std::max({a.norm(), b.norm(), (b - a).norm()}));
    for (int e : m_topology.triangle_edges[f])
      m_edge_area[e] += m_face_area.back() / 3;
  }
  weigh_skin();
}

/// Which share of the reach each face and vertex of the skin covers.
void BodyContactEffect::weigh_skin() {
  const TriangleMesh& skin = m_body.mesh();
  const double disc = units::PI * m_options.gap_m * m_options.gap_m,
               edge_disc = disc * EDGE_REACH * EDGE_REACH;
  m_body_vertex_weight.assign(skin.positions.size(), 0);
  for (const Triangle& t : skin.triangles) {
    const Vec3 a = skin.positions[t[1]] - skin.positions[t[0]],
               b = skin.positions[t[2]] - skin.positions[t[0]];
    const double area = 0.5 * a.cross(b).norm();
    m_body_face_weight.push_back(area / (area + disc));
    for (int v : t)
      m_body_vertex_weight[v] += area / 3;
  }
  for (double& w : m_body_vertex_weight)
    w /= w + edge_disc;
}

void BodyContactEffect::declare(Couplings& couplings) const {
  couplings.symmetric.insert(couplings.symmetric.end(), m_topology.edges.begin(),
                             m_topology.edges.end());
}

void BodyContactEffect::bind(const BlockMatrix& matrix) {
  m_edge_slot.clear();
  for (const auto& e : m_topology.edges)
    m_edge_slot.push_back(matrix.slot(e[0], e[1]));
  m_stale = true; // pairs hold slots
}

void BodyContactEffect::refresh() {
  m_stale = m_look_for_crossings = true;
}

void BodyContactEffect::recall(const Memory& memory) {
  m_anchor = memory.anchor;
  m_has_anchor = memory.has_anchor;
  m_push = memory.push;
}

Vec3 BodyContactEffect::crossing_place() const {
  const auto first = std::find(m_crossing.begin(), m_crossing.end(), 1);
  return first == m_crossing.end() ? Vec3(Vec3::Zero())
                                   : m_searched_at[m_triangles[first - m_crossing.begin()][0]];
}

void BodyContactEffect::begin_step(const std::vector<Vec3>& x, double) {
  const double edge_radius = EDGE_REACH * m_options.gap_m + m_options.slack_m;
  m_stale = m_stale || m_n_crossing > 0;
  for (std::size_t i = 0; !m_stale && i < x.size(); ++i) {
    const double moved = (x[i] - m_searched_at[i]).norm() + m_skin_moved[i];
    m_stale =
        moved > (m_reach_now[i] > edge_radius ? USED * m_reach_now[i] : USED * m_options.slack_m);
  }
  if (m_stale)
    search(x);
}

void BodyContactEffect::find_crossed(const std::vector<Vec3>& x) {
  m_crossing.assign(m_triangles.size(), 0);
  m_inside.assign(x.size(), 0);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const collision::SignedDistance d = m_body.signed_distance(x[i], FAR, m_clearance[i].triangle);
    m_clearance[i].triangle = d.triangle;
    m_inside[i] = d.triangle >= 0 ? d.distance < 0 : m_body.is_inside(x[i]);
  }
  for (int f : m_body.faces_through(x, m_triangles))
    m_crossing[f] = 1;
  m_n_crossing = 0;
  for (std::size_t f = 0; f < m_triangles.size(); ++f) {
    for (int i : m_triangles[f])
      m_crossing[f] |= m_inside[i];
    m_n_crossing += m_crossing[f];
  }
  m_look_for_crossings = m_n_crossing > 0;
  m_push = m_n_crossing == 0 ? 1 : std::min(HARDER * m_push, HARDEST);
}

/// Fills m_asked and m_reach_now from lower bounds of the distances to the skin.
void BodyContactEffect::measure_clearance(const std::vector<Vec3>& x) {
  const double near = m_options.gap_m + m_options.slack_m,
               edge_radius = EDGE_REACH * m_options.gap_m + m_options.slack_m;
  std::vector<double> bound(x.size());
  parallel_for(x.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Clearance& c = m_clearance[i];
      const double moved = (x[i] - c.at).norm();
      // What was near is taken for near for a while without asking; what is surely far is not asked
      // either.
      const bool still_near = c.distance >= 0 && c.distance <= near && moved < near;
      const bool still_far = c.distance - moved > 0.5 * FAR;
      if (!still_near && !still_far) {
        const collision::SignedDistance d = m_body.signed_distance(x[i], FAR, c.triangle);
        c = {x[i], d.triangle < 0 ? FAR : std::abs(d.distance), d.triangle};
      }
      bound[i] = still_near ? 0 : c.distance - (x[i] - c.at).norm();
    }
  });
  m_asked.assign(m_triangles.size(), 0);
  m_reach_now.assign(x.size(), 1e300);
  for (std::size_t f = 0; f < m_triangles.size(); ++f) {
    const Triangle& t = m_triangles[f];
    // a point of the face is at most this far from one of its corners
    const double clear = std::min({bound[t[0]], bound[t[1]], bound[t[2]]}) - m_longest_edge[f];
    m_asked[f] = clear <= near;
    for (int i : t)
      m_reach_now[i] = std::min(m_reach_now[i], std::max(edge_radius, clear));
  }
}

void BodyContactEffect::collect_pairs() {
  m_pairs.clear();
  const TriangleMesh& skin = m_body.mesh();
  const double k = m_options.stiffness_n_m3;
  const bool clean = m_n_crossing == 0;
  for (const auto& found : m_found.vertex_face) {
    if (!clean && m_inside[found.vertex])
      continue; // pushed out along the nearest skin's normal
    Pair p{{},
           {found.vertex, 0, 0},
           skin.triangles[found.body_triangle],
           1,
           3,
           false,
           m_options.gap_m,
           k * m_mesh.area[found.vertex] * m_body_face_weight[found.body_triangle]};
    p.clear = found.distance;
    m_pairs.push_back(p);
  }
  for (const auto& found : m_found.edge_edge) {
    const auto& e = m_topology.edges[found.edge];
    const Triangle& t = skin.triangles[found.body_triangle];
    const int b0 = t[found.side], b1 = t[(found.side + 1) % 3];
    const double length = (skin.positions[b1] - skin.positions[b0]).norm();
    const double reach = EDGE_REACH * m_options.gap_m;
    bool crossed = false;
    if (!clean)
      for (int f : m_topology.triangles_of_edge(found.edge))
        crossed |= m_crossing[f];
    m_pairs.push_back({{m_edge_slot[found.edge], 0, 0},
                       {e[0], e[1], 0},
                       {b0, b1, 0},
                       2,
                       2,
                       crossed,
                       reach,
                       k * m_edge_area[found.edge] * length / (length + 2 * reach)});
    m_pairs.back().clear = found.distance;
  }
  for (const auto& found : m_found.face_vertex) {
    const auto& edges = m_topology.triangle_edges[found.triangle];
    m_pairs.push_back({{m_edge_slot[edges[0]], m_edge_slot[edges[1]], m_edge_slot[edges[2]]},
                       m_triangles[found.triangle],
                       {found.body_vertex, 0, 0},
                       3,
                       1,
                       !clean && m_crossing[found.triangle],
                       EDGE_REACH * m_options.gap_m,
                       k * m_face_area[found.triangle] * m_body_vertex_weight[found.body_vertex]});
    m_pairs.back().clear = found.distance;
  }
}

void BodyContactEffect::search(const std::vector<Vec3>& x) {
  if (m_look_for_crossings || m_n_crossing > 0 || !guarded())
    find_crossed(x);
  measure_clearance(x);
  m_body.near_pairs(x, m_triangles, m_topology, m_asked, m_options.gap_m + m_options.slack_m,
                    EDGE_REACH * m_options.gap_m + m_options.slack_m, m_found);
  if (m_options.level < ContactLevel::EDGE)
    m_found.edge_edge.clear();
  if (m_options.level < ContactLevel::FACE)
    m_found.face_vertex.clear();
  collect_pairs();
  m_searched_at = m_added_at = x;
  m_skin_moved.assign(x.size(), 0);
  m_stale = false;
  ++searches;
}

BodyContactEffect::Closest BodyContactEffect::closest(const Pair& pair,
                                                      const std::vector<Vec3>& x) const {
  const std::vector<Vec3>& skin = m_body.mesh().positions;
  Closest c;
  Vec3 away;
  if (pair.n == 1) {
    const auto d = collision::point_triangle(x[pair.particle[0]], skin[pair.body[0]],
                                             skin[pair.body[1]], skin[pair.body[2]]);
    c.weight = {1, 0, 0};
    c.body_weight = {d.barycentric[0], d.barycentric[1], d.barycentric[2]};
    away = x[pair.particle[0]] - d.point;
  } else if (pair.n == 2) {
    const Vec3 &a0 = x[pair.particle[0]], &a1 = x[pair.particle[1]], &b0 = skin[pair.body[0]],
               &b1 = skin[pair.body[1]];
    const auto d = collision::edge_edge(a0, a1, b0, b1);
    c.weight = {1 - d.s, d.s, 0};
    c.body_weight = {1 - d.t, d.t, 0};
    away = a0 + d.s * (a1 - a0) - b0 - d.t * (b1 - b0);
  } else {
    const Vec3& b = skin[pair.body[0]];
    const auto d =
        collision::point_triangle(b, x[pair.particle[0]], x[pair.particle[1]], x[pair.particle[2]]);
    c.weight = {d.barycentric[0], d.barycentric[1], d.barycentric[2]};
    c.body_weight = {1, 0, 0};
    away = d.point - b;
  }
  c.distance = away.norm();
  c.valid = c.distance > TOUCHING;
  if (!pair.crossed && c.valid) {
    c.normal = away / c.distance;
    return c;
  }
  Vec3 skin_normal = Vec3::Zero();
  for (int k = 0; k < pair.n_body; ++k)
    skin_normal += c.body_weight[k] * m_body.vertex_normals()[pair.body[k]];
  skin_normal.normalize();
  if (!pair.crossed) { // on the skin: outside is where its normal points, for all pairs alike
    c.normal = skin_normal;
    c.distance = 0;
    c.valid = skin_normal.squaredNorm() > 0.5;
    return c;
  }
  const double height = away.dot(skin_normal);
  if (c.valid && std::abs(height) >= CONE * c.distance) {
    if (height < 0)
      c.distance = -c.distance;
    c.normal = away / c.distance;
  } else { // the line between the two shows no side: the skin's normal does
    c.normal = skin_normal;
    c.distance = height;
    c.valid = skin_normal.squaredNorm() > 0.5;
  }
  return c;
}

double BodyContactEffect::share_of(const Pair& pair, const std::vector<Vec3>& x) const {
  if (pair.n != 2)
    return 1;
  const std::vector<Vec3>& skin = m_body.mesh().positions;
  return edge_edge_mollifier(x[pair.particle[1]] - x[pair.particle[0]],
                             skin[pair.body[1]] - skin[pair.body[0]]);
}

void BodyContactEffect::measure_moved(const std::vector<Vec3>& x) const {
  m_moved.assign(x.size(), 0);
  if (m_added_at.size() == x.size())
    for (std::size_t i = 0; i < x.size(); ++i)
      m_moved[i] = (x[i] - m_added_at[i]).norm();
}

/// Of the pair's particles, by m_moved.
double BodyContactEffect::farthest(const Pair& pair) const {
  double most = m_moved[pair.particle[0]];
  for (int k = 1; k < pair.n; ++k)
    most = std::max(most, m_moved[pair.particle[k]]);
  return most;
}

void BodyContactEffect::guard(const Pair& pair, const Closest& c, MotionLimits& limits) const {
  double body = 0;
  for (int b = 0; b < pair.n_body; ++b)
    body += c.body_weight[b] * c.normal.dot(m_body.mesh().positions[pair.body[b]]);
  limits.planes.push_back({pair.n,
                           pair.n,
                           {pair.particle[0], pair.particle[1], pair.particle[2], 0},
                           c.normal,
                           body + std::max((1 - APPROACH) * c.distance,
                                           std::min(c.distance, LEAST_DISTANCE * pair.reach)),
                           0});
}

void BodyContactEffect::add_pair(const Pair& pair, const Closest& c, StepContext& context) {
  const double stiffness = pair.share * pair.stiffness;
  const ContactResponse push = pair.crossed
                                   ? push_out_of(c.distance, pair.reach, m_push * stiffness)
                                   : evaluate_contact_potential(c.distance, pair.reach, stiffness);
  if (push.force <= 0)
    return;
  const Mat3 block = push.stiffness * c.normal * c.normal.transpose();
  for (int k = 0; k < pair.n; ++k) {
    const double w = c.weight[k];
    if (w <= 0)
      continue;
    const int i = pair.particle[k];
    m_load[i] += w * push.force * c.normal;
    m_load_stiffness[i] += w * push.stiffness;
    context.stiffness.add_diagonal(i, w * w * block);
    const int l = (k + 1) % pair.n;
    if (pair.n > 1 && (pair.n > 2 || k == 0) && c.weight[l] > 0)
      context.stiffness.add_off_diagonal(pair.slot[k], w * c.weight[l] * block);
  }
}

void BodyContactEffect::push_out(int i, StepContext& context) {
  const collision::SignedDistance d =
      m_body.signed_distance(context.x[i], FAR, m_clearance[i].triangle);
  if (d.triangle < 0)
    return;
  const ContactResponse push =
      push_out_of(d.distance, m_options.gap_m, m_push * m_options.stiffness_n_m3 * m_mesh.area[i]);
  m_load[i] += push.force * d.normal;
  m_load_stiffness[i] += push.stiffness;
  context.stiffness.add_diagonal(i, push.stiffness * d.normal * d.normal.transpose());
}

void BodyContactEffect::add(StepContext& context) {
  std::fill(m_load.begin(), m_load.end(), Vec3::Zero());
  std::fill(m_load_stiffness.begin(), m_load_stiffness.end(), 0);
  const std::vector<Vec3>& x = context.x;
  measure_moved(x);
  m_added_at = x;
  for (Pair& pair : m_pairs) {
    pair.guarded = false;
    pair.share = -1;
    pair.clear -= farthest(pair);
    if (!pair.crossed && pair.clear >= pair.reach)
      continue;
    const Closest c = closest(pair, x);
    pair.clear = c.valid ? c.distance : 0;
    if (!c.valid)
      continue;
    pair.share = share_of(pair, x);
    if (c.distance < pair.reach)
      add_pair(pair, c, context);
    if (pair.crossed || !context.limits || !guarded())
      continue;
    guard(pair, c, *context.limits);
    pair.guarded = true;
  }
  if (m_n_crossing > 0)
    for (int i = 0; i < m_mesh.n_particles; ++i)
      if (m_inside[i])
        push_out(i, context);
  for (int i = 0; i < m_mesh.n_particles; ++i)
    context.force[i] += m_load[i];
  if (context.limits && guarded())
    for (std::size_t i = 0; i < x.size(); ++i) {
      double& most = context.limits->max_displacement[i];
      most = std::min(
          most, std::max(0.0, m_reach_now[i] - m_skin_moved[i] - (x[i] - m_searched_at[i]).norm()));
    }
  if (m_options.friction > 0)
    add_friction(context);
  m_carried.assign(x.size(), Vec3::Zero());
}

/// Guards those near pairs that add() left out and that the displacement may bring nearer than a
/// step may.
bool BodyContactEffect::add_separating_planes(const std::vector<Vec3>& x,
                                              const std::vector<Vec3>& dx, MotionLimits& limits,
                                              bool) {
  if (!guarded())
    return false;
  m_moved.resize(dx.size());
  for (std::size_t i = 0; i < dx.size(); ++i)
    m_moved[i] = dx[i].norm();
  bool added = false;
  for (Pair& pair : m_pairs) {
    if (pair.guarded || pair.crossed || farthest(pair) <= APPROACH * pair.clear)
      continue;
    pair.guarded = true;
    const Closest c = closest(pair, x);
    if (!c.valid)
      continue; // no plane separates them
    guard(pair, c, limits);
    added = true;
  }
  return added;
}

double BodyContactEffect::energy(const std::vector<Vec3>& x) const {
  double sum = 0;
  measure_moved(x);
  for (const Pair& pair : m_pairs) {
    if (!pair.crossed && pair.clear - farthest(pair) >= pair.reach)
      continue;
    const Closest c = closest(pair, x);
    if (!c.valid || (!pair.crossed && c.distance >= pair.reach))
      continue;
    const double k = (pair.share >= 0 ? pair.share : share_of(pair, x)) * pair.stiffness;
    sum += pair.crossed ? push_out_of(c.distance, pair.reach, m_push * k).energy
                        : evaluate_contact_potential(c.distance, pair.reach, k).energy;
  }
  if (m_n_crossing > 0)
    for (int i = 0; i < m_mesh.n_particles; ++i) {
      if (!m_inside[i])
        continue;
      const collision::SignedDistance d =
          m_body.signed_distance(x[i], FAR, m_clearance[i].triangle);
      if (d.triangle >= 0)
        sum += push_out_of(d.distance, m_options.gap_m,
                           m_push * m_options.stiffness_n_m3 * m_mesh.area[i])
                   .energy;
    }
  return sum + friction_energy(x);
}

} // namespace sloper::cloth

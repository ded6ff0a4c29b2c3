#include <base/parallel.hpp>
#include <cloth/body_contact.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::cloth {

/// In one step a particle comes down at most to this share of its gap, or uses this share of what it has below that.
static constexpr double APPROACH = 0.5;
/// Below this share of the gap the push grows as 1/d, up to a factor.
static constexpr double BARRIER = 0.3, LARGEST_BARRIER = 10;
/// Along the skin a touching particle moves at most this far in one step, m: the normal is only known here.
static constexpr double LARGEST_SLIDE = 0.01;
/// Clearance beyond the gap below which a particle is asked again, m.
static constexpr double MARGIN = 0.006;

BodyContactEffect::BodyContactEffect(const ClothMesh& mesh, collision::BodyCollider& body, const BodyContactOptions& options)
    : m_mesh(mesh), m_body(body), m_options(options), m_state(mesh.n_particles), m_gap(mesh.n_particles, options.gap_m) {}

void BodyContactEffect::move_body(const std::vector<Vec3>& positions) {
  double motion = 1e300;
  if (m_body_positions.size() == positions.size()) {
    motion = 0;
    for (std::size_t i = 0; i < positions.size(); ++i) motion = std::max(motion, (positions[i] - m_body_positions[i]).norm());
  }
  m_body_positions = positions;
  m_body.set_positions(positions);
  for (State& s : m_state) {
    s.clearance -= motion;
    s.has_anchor = false;
  }
}

void BodyContactEffect::begin_step(const std::vector<Vec3>& x, double) {
  std::vector<long> asked((m_state.size() + 255) / 256, 0);
  parallel_for(m_state.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      State& s = m_state[i];
      const bool was_near = s.near;
      s.near = false;
      const double clearance = s.clearance - (x[i] - s.asked_at).norm();
      if (clearance > m_gap[i] + MARGIN) continue;
      const collision::SignedDistance d = m_body.signed_distance(x[i], m_options.search_m, s.triangle);
      ++asked[begin / 256];
      s.asked_at = x[i];
      const int last_triangle = s.triangle;
      s.triangle = d.triangle;
      if (d.triangle < 0) {
        s.clearance = m_options.search_m;
        s.has_anchor = false;
        continue;
      }
      s.near = true;
      s.distance = d.distance;
      // Where the nearest triangle has changed, the mean of both normals keeps a particle from flipping between two facets.
      const bool changed = was_near && d.triangle != last_triangle && s.normal.dot(d.normal) > 0.3;
      s.normal = changed ? Vec3((s.normal + d.normal).normalized()) : d.normal;
      s.clearance = std::abs(d.distance);
      if (d.distance < 0) s.clearance = -1;
    }
  });
  for (long n : asked) queries += n;
}

void BodyContactEffect::add(StepContext& c) {
  if (m_options.friction > 0) ++friction_calls;
  if (!m_watched.empty()) add_face_contacts(c);
  for (int i = 0; i < m_mesh.n_particles; ++i) {
    State& s = m_state[i];
    s.normal_force = 0;
    if (!s.near || s.distance >= m_gap[i]) {
      s.has_anchor = false;
      continue;
    }
    // E = k A depth^3 / (6 gap): stiffness grows from 0, so that particles that come and go do not kick the rest, and Newton
    // comes from the deep side without overshooting. Near the skin both grow with 1/d: pinched cloth shares what room there is.
    const double depth = std::min(m_gap[i] - s.distance, m_gap[i] + 0.002); // a deep start is pushed out, not shot out
    const double barrier = std::clamp(BARRIER * m_gap[i] / std::max(s.distance, 1e-9), 1.0, LARGEST_BARRIER);
    double k = m_options.stiffness_n_m3 * m_mesh.area[i] * depth / m_gap[i] * barrier;
    s.normal_force = 0.5 * k * depth;
    k *= barrier;
    Vec3 force = s.normal_force * s.normal;
    double tangent = 0;
    if (m_options.friction > 0) {
      if (!s.has_anchor) s.anchor = c.x[i];
      s.has_anchor = true;
      Vec3 u = c.x[i] - s.anchor;
      u -= u.dot(s.normal) * s.normal;
      tangent = m_options.tangent_ratio * k;
      const double pull = tangent * u.norm(), most = m_options.friction * s.normal_force;
      if (pull > most) {
        u *= most / pull;
        force -= tangent * u;
        s.anchor = c.x[i] - u;
        tangent = m_options.slide_ratio * k;
      } else {
        force -= tangent * u;
      }
    }
    c.force[i] += force;
    c.stiffness.add_diagonal(i, tangent * Mat3::Identity() + (k - tangent) * s.normal * s.normal.transpose());
  }
}

void BodyContactEffect::watch_faces(const std::vector<Triangle>& triangles) {
  m_watched = triangles;
  m_watched_topology = collision::make_topology(m_mesh.n_particles, m_watched);
}

void BodyContactEffect::add_face_contacts(StepContext& c) {
  for (const collision::FaceContact& contact : m_body.face_contacts(c.x, m_watched, m_watched_topology, m_options.gap_m)) {
    const Triangle& t = m_watched[contact.triangle];
    double area = 0;
    for (int k = 0; k < 3; ++k) area += contact.barycentric[k] * m_mesh.area[t[k]];
    const double depth = std::min(m_options.gap_m - contact.distance, m_options.gap_m + 0.002);
    if (depth <= 0) continue;
    const double k = 0.5 * m_options.stiffness_n_m3 * area * depth / m_options.gap_m;
    ContactElement e;
    e.n = 3;
    e.particle = {t[0], t[1], t[2], 0};
    e.weight = {contact.barycentric[0], contact.barycentric[1], contact.barycentric[2], 0};
    e.normal = contact.normal;
    e.normal_stiffness = k;
    e.force = 0.5 * k * depth * contact.normal;
    c.elements.push_back(e);
  }
}

void BodyContactEffect::limit(const std::vector<Vec3>& x, std::vector<Vec3>& dx, std::vector<char>& held) {
  for (std::size_t i = 0; i < m_state.size(); ++i) {
    const State& s = m_state[i];
    if (!s.near) {
      const double clearance = s.clearance - (x[i] - s.asked_at).norm(), move = dx[i].norm();
      if (move > clearance && clearance > 0) dx[i] *= clearance / move;
      continue;
    }
    double along = dx[i].dot(s.normal);
    const Vec3 slide = dx[i] - along * s.normal;
    const double slide_length = slide.norm(), slide_most = LARGEST_SLIDE + std::max(s.distance, 0.0);
    const double wanted = along;
    along = std::max(along, -std::max({s.distance - APPROACH * m_gap[i], APPROACH * s.distance, 0.0}));
    if (along > wanted) held[i] = 1;
    dx[i] = along * s.normal + (slide_length > slide_most ? slide_most / slide_length : 1.0) * slide;
  }
}

} // namespace sloper::cloth

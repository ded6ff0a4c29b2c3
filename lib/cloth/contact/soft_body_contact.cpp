#include <sloper/base/parallel.hpp>
#include <sloper/cloth/contact/soft_body_contact.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::cloth {

namespace {

constexpr double FAR = 0.06;     // m: distances to the skin are not measured beyond this
constexpr double FAR_INSIDE = 1; // m: nor beyond this for what lies deep inside
constexpr std::size_t SAMPLE_GRAIN = 128;
constexpr double LEAST_STIFFNESS =
    0.05; // of the full one: a force that only begins has none of its own

} // namespace

SoftBodyContactEffect::SoftBodyContactEffect(const ClothMesh& mesh,
                                             const collision::BodyCollider& body,
                                             const SoftBodyContactOptions& options)
    : m_body(body), m_options(options) {
  const double share = options.on_edges ? 1.0 / 3 : 1; // of the area, to the particles
  for (int i = 0; i < mesh.n_particles; ++i)
    m_samples.push_back({.particle = {i, i, i}, .n = 1, .area = share * mesh.area[i]});
  if (options.on_edges)
    add_edges_and_faces(mesh);
}

/// A third of each triangle's area goes to its corners, a third to its three edges, a third to its
/// middle.
void SoftBodyContactEffect::add_edges_and_faces(const ClothMesh& mesh) {
  m_edges = mesh.edges;
  std::vector<double> edge_area(m_edges.size(), 0), face_area;
  const std::vector<Triangle> triangles = mesh.particle_triangles();
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    const auto& flat = mesh.triangles[f].flat;
    const Vec2 a = flat[1] - flat[0], b = flat[2] - flat[0];
    const double area = 0.5 * std::abs(a.x() * b.y() - a.y() * b.x());
    std::array<int, 3>& edges = m_face_edges.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const int i = triangles[f][k], j = triangles[f][(k + 1) % 3];
      const std::array pair{std::min(i, j), std::max(i, j)};
      const auto edge = std::lower_bound(m_edges.begin(), m_edges.end(), pair);
      edges[k] = static_cast<int>(edge - m_edges.begin());
      edge_area[edges[k]] += area / (3 * 3); // a third of its edges' third
    }
    face_area.push_back(area / 3);
  }
  for (std::size_t e = 0; e < m_edges.size(); ++e) {
    const auto& [i, j] = m_edges[e];
    m_samples.push_back({.particle = {i, j, 0}, .n = 2, .area = edge_area[e]});
  }
  for (std::size_t f = 0; f < triangles.size(); ++f)
    m_samples.push_back({.particle = triangles[f], .n = 3, .area = face_area[f]});
}

void SoftBodyContactEffect::declare(Couplings& couplings) const {
  couplings.symmetric.insert(couplings.symmetric.end(), m_edges.begin(), m_edges.end());
}

void SoftBodyContactEffect::bind(const BlockMatrix& matrix) {
  m_slots.clear();
  for (const auto& e : m_edges)
    m_slots.push_back({matrix.slot(e[0], e[1]), -1, -1});
  for (const auto& edges : m_face_edges) {
    std::array<int, 3>& slots = m_slots.emplace_back();
    for (std::size_t k = 0; k < 3; ++k)
      slots[k] = m_slots[edges[k]][0];
  }
}

void SoftBodyContactEffect::body_moved(double largest_displacement) {
  for (Sample& s : m_samples)
    s.clear -= largest_displacement;
}

void SoftBodyContactEffect::push(const Sample& sample, const int* slots,
                                 const collision::SignedDistance& d, StepContext& context) const {
  const double reach = m_options.reach_m;
  const double k = m_options.stiffness_n_m3 * sample.area;
  const double depth = std::min(reach - d.distance, m_options.deepest_m);
  // The force rises as a parabola within the reach and on along its tangent below it.
  const double force = depth < reach ? 0.5 * k * depth * depth / reach : k * (depth - 0.5 * reach);
  const double stiffness = std::max(k * std::min(1.0, depth / reach), LEAST_STIFFNESS * k);
  const double share = 1.0 / sample.n;
  const double drag = m_options.drag;
  const Mat3 block = share * share * stiffness *
                     (drag * Mat3::Identity() + (1 - drag) * d.normal * d.normal.transpose());
  for (int p = 0; p < sample.n; ++p) {
    const int i = sample.particle[p];
    context.force[i] += share * force * d.normal;
    context.stiffness.add_diagonal(i, block);
  }
  const int n_slots = sample.n == 1 ? 0 : 2 * sample.n - 3;
  for (int s = 0; s < n_slots; ++s)
    context.stiffness.add_off_diagonal(slots[s], block);
}

/// The skin near the middle of a sample; a triangle of -1 where it is out of reach. What was
/// outside and moved by less than its distance to the skin still is.
collision::SignedDistance SoftBodyContactEffect::look(Sample& sample, const Vec3& at) const {
  const double moved = (at - sample.at).norm();
  if (sample.clear - moved > m_options.reach_m)
    return {};
  const bool outside = sample.clear > moved;
  collision::SignedDistance d = m_body.signed_distance(at, FAR, sample.triangle);
  sample.at = at;
  sample.clear = FAR;
  if (d.triangle < 0) {
    if (outside || !m_body.is_inside(at))
      return {};
    sample.clear = -FAR;
    d = m_body.signed_distance(at, FAR_INSIDE);
    if (d.triangle < 0)
      return {};
  }
  sample.triangle = d.triangle;
  sample.clear = std::max(d.distance, 0.0);
  return d;
}

void SoftBodyContactEffect::add(StepContext& context) {
  const std::size_t n_particles = m_samples.size() - m_slots.size();
  m_found.resize(m_samples.size());
  parallel_for(m_samples.size(), SAMPLE_GRAIN, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      Sample& sample = m_samples[s];
      Vec3 at = context.x[sample.particle[0]];
      for (int p = 1; p < sample.n; ++p)
        at += context.x[sample.particle[p]];
      m_found[s] = look(sample, at / sample.n);
    }
  });
  for (std::size_t s = 0; s < m_samples.size(); ++s)
    if (m_found[s].triangle >= 0 && m_found[s].distance < m_options.reach_m)
      push(m_samples[s], s < n_particles ? nullptr : m_slots[s - n_particles].data(), m_found[s],
           context);
}

} // namespace sloper::cloth

#include <sloper/cloth/contact/soft_body_contact.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::cloth {

namespace {

constexpr double FAR = 0.06;     // m: distances to the skin are not measured beyond this
constexpr double FAR_INSIDE = 1; // m: nor beyond this for what lies deep inside
constexpr double LEAST_STIFFNESS =
    0.05; // of the full one: a force that only begins has none of its own

} // namespace

SoftBodyContactEffect::SoftBodyContactEffect(const ClothMesh& mesh,
                                             const collision::BodyCollider& body,
                                             const SoftBodyContactOptions& options)
    : m_body(body), m_options(options) {
  const double share = options.on_edges ? 1.0 / 3 : 1; // of the area, to the particles
  for (int i = 0; i < mesh.n_particles; ++i)
    m_samples.push_back(
        {.particle = {i, i, i}, .n = 1, .area = share * mesh.area[static_cast<std::size_t>(i)]});
  if (!options.on_edges) return;
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
      const auto edge = std::lower_bound(m_edges.begin(), m_edges.end(),
                                         std::array{std::min(i, j), std::max(i, j)});
      edges[k] = static_cast<int>(edge - m_edges.begin());
      edge_area[static_cast<std::size_t>(edges[k])] += area / 9;
    }
    face_area.push_back(area / 3);
  }
  for (std::size_t e = 0; e < m_edges.size(); ++e)
    m_samples.push_back(
        {.particle = {m_edges[e][0], m_edges[e][1], 0}, .n = 2, .area = edge_area[e]});
  for (std::size_t f = 0; f < triangles.size(); ++f)
    m_samples.push_back({.particle = triangles[f], .n = 3, .area = face_area[f]});
}

void SoftBodyContactEffect::declare(Couplings& couplings) const {
  couplings.symmetric.insert(couplings.symmetric.end(), m_edges.begin(), m_edges.end());
}

void SoftBodyContactEffect::bind(const BlockMatrix& matrix) {
  m_slots.clear();
  for (const auto& e : m_edges) m_slots.push_back({matrix.slot(e[0], e[1]), -1, -1});
  for (const auto& edges : m_face_edges) {
    std::array<int, 3>& slots = m_slots.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) slots[k] = m_slots[static_cast<std::size_t>(edges[k])][0];
  }
}

void SoftBodyContactEffect::body_moved(double largest_way) {
  for (Sample& s : m_samples) s.clear -= largest_way;
}

void SoftBodyContactEffect::push(const Sample& sample, const int* slots,
                                 const collision::SignedDistance& d, StepContext& context) const {
  const double reach = m_options.reach_m, k = m_options.stiffness_n_m3 * sample.area;
  const double depth = std::min(reach - d.distance, m_options.deepest_m);
  const double force = depth < reach ? 0.5 * k * depth * depth / reach : k * (depth - 0.5 * reach);
  const double stiffness = std::max(k * std::min(1.0, depth / reach), LEAST_STIFFNESS * k);
  const double share = 1.0 / sample.n;
  const Mat3 block =
      share * share * stiffness *
      (m_options.drag * Mat3::Identity() + (1 - m_options.drag) * d.normal * d.normal.transpose());
  for (std::size_t p = 0; p < static_cast<std::size_t>(sample.n); ++p) {
    context.force[static_cast<std::size_t>(sample.particle[p])] += share * force * d.normal;
    context.stiffness.add_diagonal(sample.particle[p], block);
  }
  const int n_slots = sample.n == 1 ? 0 : 2 * sample.n - 3;
  for (int s = 0; s < n_slots; ++s) context.stiffness.add_off_diagonal(slots[s], block);
}

void SoftBodyContactEffect::add(StepContext& context) {
  const std::size_t n_particles = m_samples.size() - m_slots.size();
  for (std::size_t s = 0; s < m_samples.size(); ++s) {
    Sample& sample = m_samples[s];
    const auto x = [&](std::size_t p) -> const Vec3& {
      return context.x[static_cast<std::size_t>(sample.particle[p])];
    };
    Vec3 at = x(0);
    for (std::size_t p = 1; p < static_cast<std::size_t>(sample.n); ++p) at += x(p);
    at /= sample.n;
    if (sample.clear - (at - sample.at).norm() > m_options.reach_m) continue;
    collision::SignedDistance d = m_body.signed_distance(at, FAR, sample.triangle);
    sample.at = at;
    sample.clear = FAR;
    if (d.triangle < 0) {
      if (!m_body.is_inside(at)) continue;
      d = m_body.signed_distance(at, FAR_INSIDE);
      if (d.triangle < 0) continue;
    }
    sample.triangle = d.triangle;
    sample.clear = std::max(d.distance, 0.0);
    if (d.distance < m_options.reach_m)
      push(sample, s < n_particles ? nullptr : m_slots[s - n_particles].data(), d, context);
  }
}

} // namespace sloper::cloth

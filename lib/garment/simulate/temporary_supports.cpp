#include <garment/simulate/sleeve_ends.hpp>
#include <sloper/base/units.hpp>
#include <sloper/cloth/forces/pins.hpp>
#include <sloper/cloth/forces/pressure.hpp>
#include <sloper/collision/intersections.hpp>
#include <sloper/garment/materials.hpp>
#include <sloper/garment/simulate/temporary_supports.hpp>
#include <sloper/io/json.hpp>
#include <sloper/io/json_lists.hpp>

#include <cmath>
#include <map>

namespace sloper::garment {

namespace {

constexpr double TANGLE_REACH =
    0.04; // m: how far around what crosses after sewing cloth may be tucked in
constexpr double TANGLE_LENGTH = 0.25;  // m: crossing pairs of such a place times the mesh edge;
                                        // knots had 0.4 and more, what comes apart 0.2 and less
constexpr double INFLATION_WEIGHTS = 1; // of the cloth on its area: the pressure from within

/// Marks all vertices of triangles that have one marked, so many times. @param marked  #V, in and
/// out
void grow(std::vector<char>& marked, const std::vector<Triangle>& triangles, int rings) {
  for (int ring = 0; ring < rings; ++ring) {
    const std::vector<char> before = marked;
    for (const Triangle& t : triangles)
      if (before[t[0]] || before[t[1]] || before[t[2]])
        marked[t[0]] = marked[t[1]] = marked[t[2]] = 1;
  }
}

std::vector<char> around(const std::vector<std::array<int, 2>>& crossing,
                         const std::vector<Triangle>& triangles, std::size_t n_particles,
                         int rings) {
  std::vector<char> near(n_particles, 0);
  for (const std::array<int, 2>& pair : crossing)
    for (int f : pair)
      for (int i : triangles[f])
        near[i] = 1;
  grow(near, triangles, rings);
  return near;
}

int rings_within(double reach, double edge) {
  return static_cast<int>(std::lround(reach / edge));
}

} // namespace

std::vector<char> near_crossings(const std::vector<Vec3>& position,
                                 const std::vector<Triangle>& triangles, int rings) {
  const collision::TriangleTree tree(position, triangles);
  const auto crossing = collision::self_intersections(position, triangles, tree);
  if (crossing.empty())
    return {};
  return around(crossing, triangles, position.size(), rings);
}

TemporarySupports::TemporarySupports(SimulatedCloth& cloth, const DrapeSettings& settings,
                                     PenetrationResolver& resolver, Telemetry& telemetry)
    : m_cloth(cloth), m_settings(settings), m_resolver(resolver), m_telemetry(telemetry) {}

bool TemporarySupports::may_help(const std::string& effect) const {
  return m_settings.effects.starts_with("auto") &&
         m_settings.effects.find("-" + effect) == std::string::npos;
}

void TemporarySupports::forget_effects() {
  m_pressure = nullptr;
  m_hold = nullptr;
}

void TemporarySupports::remove_temporary_effect(const cloth::Effect*& effect) {
  if (!effect)
    return;
  const std::unique_ptr<cloth::Effect> taken = m_cloth.solver().remove(*effect);
  effect = nullptr;
  for (EffectReport& r : m_telemetry.report.effects)
    if (r.name == taken->name()) {
      r.calls += taken->calls;
      r.wall_s += taken->wall_s;
    }
}

void TemporarySupports::add_inflation_pressure() {
  if (m_pressure || !m_cloth.is_active("sewing") || !may_help("pressure"))
    return;
  if (!m_cloth.is_active("pressure"))
    m_telemetry.activate("pressure", "for a moment after sewing: it turns out dents");
  const double weight = material_of(m_cloth.garment(), "").density_kg_m2 * units::GRAVITY;
  m_pressure = &m_cloth.solver().emplace<cloth::PressureEffect>(m_cloth.mesh().particle_triangles(),
                                                                INFLATION_WEIGHTS * weight);
}

void TemporarySupports::remove_inflation_pressure() {
  remove_temporary_effect(m_pressure);
}

void TemporarySupports::find_ends(LimbEnds ends) {
  if (!may_help("pins"))
    return;
  m_state.ends = ends;
  for (const cloth::Pin& pin : hold_ends(m_cloth.garment(), ends))
    m_state.held.push_back(pin.target);
}

void TemporarySupports::find_tangles() {
  m_state.tangles.clear();
  if (!m_cloth.is_active("self_contact"))
    return;
  const std::vector<Vec3>& position = m_cloth.garment().position;
  const std::vector<Triangle> triangles = m_cloth.garment().particle_triangles();
  const collision::TriangleTree tree(position, triangles);
  const auto crossing = collision::self_intersections(position, triangles, tree);
  const double edge = m_cloth.mean_edge();
  const std::vector<char> near =
      around(crossing, triangles, position.size(), rings_within(TANGLE_REACH, edge));
  std::vector<Triangle> patches;
  for (const Triangle& t : triangles)
    if (near[t[0]] && near[t[1]] && near[t[2]])
      patches.push_back(t);
  const std::vector<int> patch = connected_components(near.size(), patches);
  std::map<int, int> pairs; // by patch
  for (const auto& pair : crossing)
    ++pairs[patch[triangles[pair[0]][0]]];
  for (std::size_t i = 0; i < near.size(); ++i)
    if (near[i] && pairs[patch[i]] * edge > TANGLE_LENGTH)
      m_state.tangles.push_back(static_cast<int>(i));
  if (!m_state.tangles.empty())
    m_telemetry.add_repair(
        "sewing left cloth tucked in: " + std::to_string(m_state.tangles.size()) +
        " particles passed through each other until weight came");
}

void TemporarySupports::apply() {
  if (!m_state.held.empty()) {
    std::vector<cloth::Pin> pins = hold_ends(m_cloth.garment(), m_state.ends);
    if (!pins.empty() && pins.size() == m_state.held.size()) {
      for (std::size_t k = 0; k < pins.size(); ++k)
        pins[k].target = m_state.held[k];
      if (!m_cloth.is_active("pins"))
        m_telemetry.activate(
            "pins",
            m_state.ends == LimbEnds::SLEEVES
                ? "sleeve ends are held at the wrists until the cloth above has found its folds"
                : "ends of sleeves and legs are held until the cloth above has found its folds");
      m_hold = &m_cloth.solver().emplace<cloth::PinsEffect>(std::move(pins));
    }
  }
  let_tangles_pass();
}

void TemporarySupports::let_tangles_pass() {
  if (m_state.tangles.empty() || !m_cloth.self_contact())
    return;
  std::vector<char> passes(m_cloth.garment().position.size(), 0);
  for (int i : m_state.tangles)
    passes[i] = 1;
  m_cloth.self_contact()->let_pass(std::move(passes));
}

void TemporarySupports::open_knots(double reach) {
  const std::vector<char> near =
      near_crossings(m_cloth.garment().position, m_cloth.garment().particle_triangles(),
                     rings_within(reach, m_cloth.mean_edge()));
  for (std::size_t i = 0; i < near.size(); ++i)
    if (near[i])
      m_state.tangles.push_back(static_cast<int>(i));
  m_telemetry.add_repair(
      "cloth at rest crossed itself still: " + std::to_string(m_state.tangles.size()) +
      " particles passed through each other for a while");
  let_tangles_pass();
}

void TemporarySupports::release_ends() {
  remove_temporary_effect(m_hold);
  m_state.held.clear();
}

void TemporarySupports::close_tangles() {
  if (m_state.tangles.empty() || !m_cloth.self_contact())
    return;
  m_state.tangles.clear();
  m_cloth.self_contact()->let_pass({});
  m_resolver.untangle_in_flight();
}

} // namespace sloper::garment

/// The part of a drape that draws the panels together, and the breath after it.
#include <cloth/forces/pressure.hpp>
#include <collision/intersections.hpp>
#include <garment/materials.hpp>
#include <garment/scene/effects.hpp>
#include <garment/sewing.hpp>
#include <garment/simulate/drape_run.hpp>

#include <algorithm>
#include <base/units.hpp>
#include <cmath>
#include <map>

namespace sloper::garment {

namespace {

constexpr double SEWN_GAP = 5e-4;  // m: a stitch this short is welded
constexpr int SEW_STEPS = 600;     // at most
constexpr double SEW_PULL = 10;    // of a stitch at reach, in weights of a particle
constexpr double SEW_MOVE = 0.8;   // of the mesh edge: of any particle in one step
constexpr double SEW_GROWTH = 1.6; // of the pull where seams hardly close on, in five steps by a part of SEW_SLOW
constexpr double SEW_SLOW = 0.06;  // at 0.04 a tenth more steps; at 0.1 a long sleeve is strained by up to 20 % instead of 10
constexpr double SEW_STEP_S = 0.1;
constexpr double SEW_STRONGEST = 20; // N at reach: closes seams of garments that fit tightly
constexpr double TUCK = 0.04;        // m: how far around what crosses after sewing cloth may be tucked in
constexpr double TUCKED = 0.25;      // m: crossing pairs of such a place times the mesh edge; knots had 0.4 and more, what comes apart 0.2 and less
constexpr double BREATH = 1;         // weights of the cloth on its area: pressure from within meanwhile, which turns out dents that sewing left

} // namespace

void DrapeRun::sew() {
  const Phase phase(*this, "sew");
  if (m_at.phase != DrapePhase::SEW) { // it begins; else it goes on from a checkpoint
    build_solver(true);
    log_crossings("start");
    double weight = 0;
    for (double m : m_cloth->mass) weight += m * units::GRAVITY / m_cloth->n_particles;
    m_at.phase = DrapePhase::SEW;
    m_at.step = 0;
    m_at.pull = SEW_PULL * weight;
  }
  for (int& k = m_at.step; k < SEW_STEPS; ++k) {
    checkpoint();
    m_sewing->set_stiffness(m_at.pull / SEW_REACH);
    std::vector<double>& gaps = m_at.gaps;
    gaps.push_back(m_sewing->widest(m_solver->x()).length);
    m_reporter.progress("sew", 0.4 * k / SEW_STEPS);
    if (k % 20 == 0)
      m_reporter.info("sew step " + std::to_string(k) + ": largest gap " + millimetres(gaps.back()) + ", pull " + std::to_string(m_at.pull) + " N");
    if (gaps.back() < SEWN_GAP) break;
    const bool slow = k >= m_at.pull_changed + 5 && gaps[k] > (1 - SEW_SLOW) * gaps[k - 5];
    if (slow && m_at.pull >= SEW_STRONGEST && k >= m_at.pull_changed + 20) break; // it will not come closer
    if (slow && m_at.pull < SEW_STRONGEST) {
      m_at.pull = std::min(SEW_GROWTH * m_at.pull, SEW_STRONGEST);
      m_at.pull_changed = k;
    }
    if (!step(SEW_STEP_S, 0, SEW_MOVE * mean_edge())) return;
  }
  const auto [gap, where] = m_sewing->widest(m_solver->x());
  if (gap > 5 * SEWN_GAP) m_report.repairs.push_back("seams were still open by " + millimetres(gap) + " at " + place_text(where) + " when they were welded");
  m_garment.position = m_solver->x();
  std::vector<Vec3> vertex_position(m_garment.particle_of.size());
  for (std::size_t v = 0; v < vertex_position.size(); ++v) vertex_position[v] = m_garment.position[m_garment.particle_of[v]];
  log_crossings("sewn");
  weld(m_garment, vertex_position);
  log_crossings("welded");
  find_tucks();
}

/// Where seams meet, panels that were drawn together may be tucked into each other, and once nothing crosses contact would keep them so.
/// What crosses, and cloth around it, passes through itself until weight comes; bending and the breath smooth it meanwhile. Where only
/// a little crosses, it is drawn apart for good: letting that pass too left knots in arm pits.
void DrapeRun::find_tucks() {
  m_at.tucks.clear();
  if (!active("self_contact")) return;
  const std::vector<Triangle> triangles = m_garment.particle_triangles();
  const collision::TriangleTree tree(m_garment.position, triangles);
  const auto crossing = collision::self_intersections(m_garment.position, triangles, tree);
  std::vector<char> near(m_garment.position.size(), 0);
  for (const auto& pair : crossing)
    for (int f : pair)
      for (int i : triangles[f]) near[i] = 1;
  const int rings = static_cast<int>(std::lround(TUCK / mean_edge()));
  for (int ring = 0; ring < rings; ++ring) {
    const std::vector<char> before = near;
    for (const Triangle& t : triangles)
      if (before[t[0]] || before[t[1]] || before[t[2]]) near[t[0]] = near[t[1]] = near[t[2]] = 1;
  }
  std::vector<Triangle> patches;
  for (const Triangle& t : triangles)
    if (near[t[0]] && near[t[1]] && near[t[2]]) patches.push_back(t);
  const std::vector<int> patch = connected_components(near.size(), patches);
  std::map<int, int> pairs; // by patch
  for (const auto& pair : crossing) ++pairs[patch[triangles[pair[0]][0]]];
  for (std::size_t i = 0; i < near.size(); ++i)
    if (near[i] && pairs[patch[i]] * mean_edge() > TUCKED) m_at.tucks.push_back(static_cast<int>(i));
  if (!m_at.tucks.empty())
    m_report.repairs.push_back("sewing left cloth tucked in: " + std::to_string(m_at.tucks.size()) + " particles passed through each other until weight came");
}

void DrapeRun::let_tucks_pass() {
  if (m_at.tucks.empty() || !m_self_contact) return;
  std::vector<char> passes(m_garment.position.size(), 0);
  for (int i : m_at.tucks) passes[i] = 1;
  m_self_contact->let_pass(std::move(passes));
}

void DrapeRun::close_tucks() {
  if (m_at.tucks.empty() || !m_self_contact) return;
  m_at.tucks.clear();
  m_self_contact->let_pass({});
  untangle_now();
}

/// A flared hem that sewing has dented inwards may stay so: a cone turned in is a state of rest too. Cloth without seams would fly off.
void DrapeRun::breathe() {
  if (m_breath || !active("sewing") || !may_pass("pressure")) return;
  if (!active("pressure")) activate("pressure", "for a moment after sewing: it turns out dents");
  const double weight = material_of(m_garment, "").density_kg_m2 * units::GRAVITY;
  m_breath = &m_solver->emplace<cloth::PressureEffect>(m_cloth->particle_triangles(), BREATH * weight);
}

/// Effects that help for a moment come with `auto` only, and not where they are switched off.
bool DrapeRun::may_pass(const std::string& effect) const {
  return m_settings.effects.starts_with("auto") && m_settings.effects.find("-" + effect) == std::string::npos;
}

void DrapeRun::stop_breathing() { take_back(m_breath); }

void DrapeRun::take_back(const cloth::Effect*& effect) {
  if (!effect) return;
  const std::unique_ptr<cloth::Effect> taken = m_solver->remove(*effect);
  effect = nullptr;
  for (EffectReport& r : m_report.effects)
    if (r.name == taken->name()) r.calls += taken->calls, r.wall_s += taken->wall_s;
}

} // namespace sloper::garment

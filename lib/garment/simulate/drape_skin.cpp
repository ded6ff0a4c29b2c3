/// The part of a drape that decides which skin the cloth meets: with hands as mittens and toes in a sock, coarser than a dense scan's, drawn in.
#include <garment/retarget/retarget.hpp>
#include <garment/simulate/drape_run.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::garment {

namespace {

constexpr double SEW_LEG_SCALE = 0.7;     // of the body's thickness while trousers are sewn
constexpr std::size_t DENSE_SKIN = 60000; // triangles: with less, a coarser skin saves too little
constexpr double ROUGHEST = 4;            // of the tolerance: what a noisy scan is given, which at less has no triangle to spare

} // namespace

void DrapeRun::collide_with(const TriangleMesh& skin) { m_collider.emplace(collision::make_collider(skin, m_body->skin_cache.get())); }

void DrapeRun::prepare_body(unsigned covered) {
  m_at.covered = covered;
  m_covered.reset();
  if (covered) m_covered.emplace(*m_body, covered);
  const TriangleMesh& whole = m_covered ? m_covered->mesh() : m_body->skin;
  if (!m_at.whole_skin && m_settings.skin_tolerance_m > 0 && whole.triangles.size() > DENSE_SKIN) {
    for (double tolerance = m_settings.skin_tolerance_m; !m_coarse && tolerance <= ROUGHEST * m_settings.skin_tolerance_m; tolerance *= 2) {
      m_coarse.emplace(whole, tolerance);
      if (!m_coarse->pays()) m_coarse.reset();
    }
  }
  collide_with(m_coarse ? m_coarse->mesh() : whole);
  if (m_coarse)
    m_reporter.info("a coarser skin: " + std::to_string(m_coarse->mesh().triangles.size()) + " of " + std::to_string(whole.triangles.size()) + " triangles");
  if (covered & CoveredSkin::HANDS) m_reporter.info("hands as mittens: cloth is near them");
  if (covered & CoveredSkin::FEET) m_reporter.info("toes as in a sock: cloth is near them");
}

std::vector<Vec3> DrapeRun::placed_on(const std::string& part) const {
  std::vector<Vec3> points;
  if (m_garment.panels.placed.empty()) return points;
  for (const pattern::PanelInfo& p : m_garment.panels.panels)
    for (int v = p.first_vertex; p.part.starts_with(part) && v < p.first_vertex + p.n_vertices; ++v) points.push_back(m_garment.panels.placed[v]);
  return points;
}

void DrapeRun::take_forearms() {
  m_forearms.emplace(*m_body);
  m_forearms->leave_in(body::Part::ARM_L, placed_on("arm_l"));
  m_forearms->leave_in(body::Part::ARM_R, placed_on("arm_r"));
}

void DrapeRun::start_outside_body(bool unsewn) {
  if (!m_body || m_body->skin.triangles.empty()) return;
  const Phase phase(*this, "prepare body");
  const bool sewn_on_legs = unsewn && !placed_on("leg").empty();
  if (unsewn && active("body_contact")) { // a skirt is sewn around the body as if the arms were held up, where no sleeve needs them
    take_forearms();
    const bool covered = m_forearms->is_covered(body::Part::ARM_L, placed_on("arm_l")) || m_forearms->is_covered(body::Part::ARM_R, placed_on("arm_r"));
    m_at.arms_aside = !covered && m_forearms->are_near(placed_on("lower_body"));
  }
  prepare_body(CoveredSkin(*m_body, CoveredSkin::HANDS | CoveredSkin::FEET).concerned(m_garment.position) | (m_at.arms_aside ? CoveredSkin::HANDS : 0u));
  if (m_at.arms_aside) m_collider->set_positions(skin_at(1));
  const std::vector<Triangle> triangles = m_garment.particle_triangles();
  auto trouble = [&] {
    std::size_t count = m_collider->faces_through(m_garment.position, triangles).size();
    for (const Vec3& p : m_garment.position) count += m_collider->is_inside(p);
    return count;
  };
  // Trousers are sewn around legs drawn in: between thighs that touch there is no room for a seam to close.
  std::size_t least = trouble();
  if (least == 0 && sewn_on_legs) {
    m_shrink.emplace(*m_body);
    m_at.scale = SEW_LEG_SCALE;
    m_collider->set_positions(skin_at(m_at.scale));
  }
  if (least == 0 || (!unsewn && part_few_at_start(least))) return;
  m_shrink.emplace(*m_body);
  double best = 1;
  const std::size_t at_start = least;
  for (double s : {0.9, 0.8, 0.65, 0.5, 0.35, 0.2}) {
    m_collider->set_positions(skin_at(s));
    const std::size_t count = trouble();
    if (count < least) {
      least = count;
      best = s;
    }
    if (count == 0) break;
  }
  m_at.scale = best;
  m_collider->set_positions(skin_at(best));
  m_report.repairs.push_back("start: " + std::to_string(at_start) + " vertices or faces in the body; body drawn in to " +
                             std::to_string(std::lround(best * 100)) + " % of its thickness and inflated again" +
                             (least ? ", " + std::to_string(least) + " remained" : ""));
}

std::vector<Vec3> DrapeRun::skin_at(double scale) const {
  const std::vector<Vec3> skin = scale < 1 ? m_shrink->positions(scale) : m_body->skin.positions;
  return as_met(m_at.arms_aside ? m_forearms->drawn_in(skin) : skin);
}

std::vector<Vec3> DrapeRun::as_met(const std::vector<Vec3>& skin) const {
  std::vector<Vec3> all = m_covered ? m_covered->positions(skin) : skin;
  return m_coarse ? m_coarse->positions(all) : all;
}

void DrapeRun::meet_bare_skin() {
  if (!m_covered && !m_coarse) return;
  m_covered.reset();
  m_coarse.reset();
  collide_with(m_body->skin);
}

void DrapeRun::let_arms_hang() {
  m_garment.position = m_solver->x();
  m_at.contact = m_body_contact->memory();
  m_at.arms_aside = false;
  m_forearms.reset();
  m_collider->set_positions(skin_at(m_at.scale));
  const std::vector<Vec3> hung = m_garment.position;
  std::vector<char> on_arms(hung.size(), 0);
  for (const pattern::PanelInfo& p : m_garment.panels.panels)
    for (int v = p.first_vertex; p.part.starts_with("arm") && v < p.first_vertex + p.n_vertices; ++v) on_arms[m_garment.particle_of[v]] = 1;
  if (const std::size_t moved = bring_under_arms(m_garment.position, on_arms, *m_body, m_settings.contact_gap_m); moved > 0) {
    settle_shape(m_garment.position, hung, m_garment.particle_triangles(), *m_collider, m_settings.contact_gap_m);
    m_report.repairs.push_back("arms: " + std::to_string(moved) + " particles in forearms or hands or beyond them were brought between those and the body");
    untangle();
    m_at.contact = {};
  }
  rebuild();
}

void DrapeRun::leave_coarse_skin() {
  m_garment.position = m_solver->x();
  if (m_body_contact) m_at.contact = m_body_contact->memory();
  m_at.whole_skin = true;
  m_coarse.reset();
  prepare_body(m_at.covered);
  rebuild();
}

} // namespace sloper::garment

#include <sloper/collision/skin_cache.hpp>
#include <sloper/garment/body_model/collision_body.hpp>
#include <sloper/io/json.hpp>

namespace sloper::garment {

namespace {

constexpr std::size_t DENSE_SKIN = 60000; // triangles: with less, a coarser skin saves too little
constexpr double ROUGHEST =
    4; // of the tolerance: what a noisy scan is given, which at less has no triangle to spare

} // namespace

CollisionBody::CollisionBody(const body::Body* body, double coarse_tolerance_m, Reporter& reporter)
    : m_body(body), m_coarse_tolerance(coarse_tolerance_m), m_reporter(reporter) {}

void CollisionBody::collide_with(const TriangleMesh& skin) {
  m_collider.emplace(collision::make_collider(skin, m_body->skin_cache.get()));
}

void CollisionBody::prepare(unsigned covered) {
  m_state.covered = covered;
  m_extremity_hulls.reset();
  if (covered)
    m_extremity_hulls.emplace(*m_body, covered);
  const TriangleMesh& whole = m_extremity_hulls ? m_extremity_hulls->mesh() : m_body->skin;
  if (!m_state.full_skin && m_coarse_tolerance > 0 && whole.triangles.size() > DENSE_SKIN) {
    for (double tolerance = m_coarse_tolerance;
         !m_coarse && tolerance <= ROUGHEST * m_coarse_tolerance; tolerance *= 2) {
      m_coarse.emplace(whole, tolerance);
      if (!m_coarse->pays())
        m_coarse.reset();
    }
  }
  collide_with(m_coarse ? m_coarse->mesh() : whole);
  if (m_coarse)
    m_reporter.info("a coarser skin: " + std::to_string(m_coarse->mesh().triangles.size()) +
                    " of " + std::to_string(whole.triangles.size()) + " triangles");
  if (covered & ExtremityHulls::HANDS)
    m_reporter.info("hands as mittens: cloth is near them");
  if (covered & ExtremityHulls::FEET)
    m_reporter.info("toes as in a sock: cloth is near them");
}

void CollisionBody::restore(const State& state, const Garment& garment) {
  m_state = state;
  prepare(m_state.covered);
  if (m_state.shrunk)
    m_shrink.emplace(*m_body);
  if (m_state.arms_aside)
    make_forearms(garment);
}

unsigned CollisionBody::ends_near(const std::vector<Vec3>& points) const {
  return ExtremityHulls(*m_body, ExtremityHulls::ALL_ENDS).concerned(points);
}

void CollisionBody::use_full_skin() {
  if (!has_skin() || (m_collider && !m_extremity_hulls && !m_coarse))
    return;
  m_extremity_hulls.reset();
  m_coarse.reset();
  collide_with(m_body->skin);
}

void CollisionBody::drop_coarse_proxy() {
  m_state.full_skin = true;
  m_coarse.reset();
  prepare(m_state.covered);
}

void CollisionBody::draw_in(double scale) {
  if (!m_shrink)
    m_shrink.emplace(*m_body);
  m_state.shrunk = true;
  m_state.scale = scale;
  m_collider->set_positions(skin_at(scale));
}

void CollisionBody::make_forearms(const Garment& garment) {
  m_forearms.emplace(*m_body);
  m_forearms->leave_in(body::Part::ARM_L, placed_on(garment, "arm_l"));
  m_forearms->leave_in(body::Part::ARM_R, placed_on(garment, "arm_r"));
}

void CollisionBody::find_arms_aside(const Garment& garment) {
  make_forearms(garment);
  const bool covered = m_forearms->is_covered(body::Part::ARM_L, placed_on(garment, "arm_l")) ||
                       m_forearms->is_covered(body::Part::ARM_R, placed_on(garment, "arm_r"));
  m_state.arms_aside = !covered && m_forearms->are_near(placed_on(garment, "lower_body"));
}

void CollisionBody::put_arms_aside() {
  if (m_state.arms_aside)
    m_collider->set_positions(skin_at(1));
}

void CollisionBody::let_arms_hang() {
  m_state.arms_aside = false;
  m_forearms.reset();
  m_collider->set_positions(skin_at(m_state.scale));
}

std::vector<Vec3> CollisionBody::skin_at(double scale) const {
  const std::vector<Vec3> skin = scale < 1 ? m_shrink->positions(scale) : m_body->skin.positions;
  return collision_surface(m_state.arms_aside ? m_forearms->drawn_in(skin) : skin);
}

std::vector<Vec3> CollisionBody::collision_surface(const std::vector<Vec3>& skin) const {
  std::vector<Vec3> all = m_extremity_hulls ? m_extremity_hulls->positions(skin) : skin;
  return m_coarse ? m_coarse->positions(all) : all;
}

void CollisionBody::stand_at(const std::vector<Vec3>& skin) {
  m_end_body = *m_body;
  m_end_body.skin.positions = skin;
  m_body = &m_end_body;
}

std::vector<Vec3> placed_on(const Garment& garment, const std::string& part) {
  std::vector<Vec3> points;
  if (garment.panels.placed.empty())
    return points;
  for (const pattern::PanelInfo& p : garment.panels.panels)
    for (int v = p.first_vertex; p.part.starts_with(part) && v < p.first_vertex + p.n_vertices; ++v)
      points.push_back(garment.panels.placed[v]);
  return points;
}

} // namespace sloper::garment

/// The part of a drape that brings the sewn garment to rest.
#include <garment/simulate/drape_run.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::garment {

namespace {

constexpr int GLIDE_STEPS = 40;          // after sewing, free of weight and friction, which would keep the strain that sewing left
constexpr int STALLED_STEPS = 400;       // without a residual that is a tenth less, and more than the weight: it will not come to rest
constexpr int UNMOVED_STEPS = 25;        // one after the other in which nothing can move at all
constexpr int MOST_UNTANGLINGS = 8;      // of cloth that crosses itself, half of them before it is at rest
constexpr int PART_EVERY = 40;           // steps between looks whether cloth still crosses itself or a few faces are still through the skin
constexpr int JUDGE_EVERY = 10;          // steps between looks whether the garment can still fit
constexpr double SUNK = 2e-4;            // m that all cloth together may sink, when what was kept in place is let go, and be at rest
constexpr double NEAR_RESIDUAL = 1;      // weights: below, steps may grow faster
constexpr double HUNG_SPEED = 0.02;      // m/s: slower, a skirt hangs, and arms that were held up can come down beside it
constexpr double HUNG_RESIDUAL = 10;     // weights: likewise
constexpr double LARGEST_STEP_S = 0.2;   // s, while settling
constexpr int LOOK_EVERY = 60;           // steps between looks whether cloth is still on its way
constexpr int WAY_STEPS = 20;            // before a look: of these the way counts
constexpr double ON_ITS_WAY = 5e-4;      // m root mean square in them
constexpr int FREE_STEPS = 60;           // with its inertia, at most
constexpr int LEAST_FREE = 10;           // likewise, at least: it begins to move
constexpr double FREE_STEP_S = 1.0 / 60; // s of them
constexpr double FREE_INERTIA = 0.98;    // share of the velocity that is carried over
constexpr double FREE_CALM = 0.005;      // m/s of the fastest particle: it has arrived

} // namespace

int DrapeRun::glide() const { return m_at.disturbed ? GLIDE_STEPS : 0; }

/// Particles that a line search keeps in place for a while may be nails that a skirt hangs by. So rest counts once letting them go moves nothing.
bool DrapeRun::thaw() {
  double height = 0;
  for (const Vec3& p : m_solver->x()) height += p.y() / static_cast<double>(m_solver->x().size());
  if (m_at.thawed_at && std::abs(height - *m_at.thawed_at) < SUNK) return false;
  m_at.thawed_at = height;
  return m_solver->thaw();
}

/// Where each step must end lower than it began, cloth that slides, or sways, and has folds to pass on its way comes down by a tenth of a
/// millimetre a step, for hundreds of steps. With its inertia it goes there in less than a second of its time. So cloth that still goes
/// somewhere is let go for a while; it comes to rest as any other.
void DrapeRun::look_for_way() {
  const int k = m_at.step;
  if (k < glide() || m_at.free_steps > 0) return;
  const std::vector<Vec3>& x = m_solver->x();
  if (k == glide()) m_at.looked_at = k;
  if (k == m_at.looked_at + LOOK_EVERY - WAY_STEPS) m_at.looked_from = x;
  if (k < m_at.looked_at + LOOK_EVERY) return;
  m_at.looked_at = k;
  if (m_at.looked_from.empty()) return; // a checkpoint of an older version
  double way2 = 0;
  for (std::size_t i = 0; i < x.size(); ++i) way2 += (x[i] - m_at.looked_from[i]).squaredNorm();
  const double way = std::sqrt(way2 / static_cast<double>(x.size()));
  m_reporter.info("settle step " + std::to_string(k) + ": went " + millimetres(way) + " in " + std::to_string(WAY_STEPS) + " steps");
  if (way < ON_ITS_WAY) return;
  m_solver->thaw();
  m_solver->stop();
  m_at.free_steps = FREE_STEPS;
  m_at.h = FREE_STEP_S;
}

void DrapeRun::end_free_step() {
  --m_at.free_steps;
  const bool arrived = FREE_STEPS - m_at.free_steps >= LEAST_FREE && m_at.last.largest_move_m < FREE_CALM * m_at.last_h;
  if (!arrived && m_at.free_steps > 0) return;
  m_solver->stop();
  m_at.free_steps = 0;
  m_at.looked_at = m_at.step;
  m_at.h = m_settings.time_step_s;
}

void DrapeRun::settle() {
  const Phase phase(*this, "settle");
  m_settling = true;
  if (m_at.phase != DrapePhase::SETTLE) {
    m_at.phase = DrapePhase::SETTLE;
    m_at.step = 0;
    m_at.h = m_settings.time_step_s;
    m_at.thawed_at.reset();
    m_at.looked_from.clear();
    m_at.start_height.clear();
    for (const Vec3& p : m_solver->x()) m_at.start_height.push_back(p.y());
  }
  int &k = m_at.step, &calm = m_at.calm;
  double &h = m_at.h, &best = m_at.best;
  for (; !m_stopped; ++k) {
    checkpoint();
    if (k < glide()) breathe();
    if (k == glide()) {
      stop_breathing();
      close_tucks();
      let_sleeves_go();
      add_load();
      h = m_settings.time_step_s;
    }
    look_for_way();
    const bool free = m_at.free_steps > 0;
    if (!step(h, free ? FREE_INERTIA : 0)) break;
    const double speed = m_at.last.largest_move_m / h, residual = m_at.last.residual_force_ratio;
    if (k % 20 == 0)
      m_reporter.info("settle step " + std::to_string(k) + ": h " + std::to_string(h) + " s, speed " + std::to_string(speed) + " m/s, residual force " +
                      std::to_string(residual) + " of the weight, at most " + std::to_string(m_at.last.residual_force_ratio_max) + crossing_text());
    m_reporter.progress("settle", -1);
    if (free) end_free_step();
    else if (m_at.last.halvings > 0) h = std::max(h * 0.7, m_settings.time_step_s);
    else if (m_at.last.largest_move_m < 0.003) h = std::min(h * (residual > NEAR_RESIDUAL ? 1.15 : 1.3), LARGEST_STEP_S);
    else if (m_at.last.largest_move_m > 0.01) h = std::max(h * 0.8, m_settings.time_step_s);
    if (k <= glide() || residual < 0.9 * best) {
      best = residual;
      m_at.best_at = k;
    } else if (best > 1 && k > m_at.best_at + STALLED_STEPS) {
      m_stopped = true;
      m_report.stop_reason = "no nearer to rest in " + std::to_string(STALLED_STEPS) + " steps";
      break;
    }
    m_at.unmoved = m_at.last.largest_move_m > 0 ? 0 : m_at.unmoved + 1;
    const bool stuck = m_at.unmoved >= UNMOVED_STEPS && residual >= m_settings.settle_force_ratio;
    if ((stuck || (k > glide() && k % PART_EVERY == 0)) && part_the_few()) {
      h = m_settings.time_step_s;
      calm = m_at.unmoved = 0;
      m_at.best_at = k;
      continue;
    }
    if (stuck) {
      m_stopped = true;
      m_report.stop_reason = "stuck: nothing could move in " + std::to_string(UNMOVED_STEPS) + " steps";
      break;
    }
    if (k > glide() && k % PART_EVERY == 0 && m_self_contact && !m_self_contact->crossings().empty() && m_at.untanglings < MOST_UNTANGLINGS / 2) untangle_now();
    if (k > glide() && k % JUDGE_EVERY == 0) judge_fit();
    const bool still = speed < m_settings.settle_speed_m_s && residual < m_settings.settle_force_ratio;
    calm = still && k >= glide() ? calm + 1 : 0;
    if (m_at.arms_aside && k > glide() && speed < HUNG_SPEED && residual < HUNG_RESIDUAL) {
      let_arms_hang();
      h = m_settings.time_step_s;
      calm = 0;
      continue;
    }
    if (calm < 3) continue;
    if (thaw()) {
      calm = 0;
      continue;
    }
    if (m_body_contact && m_body_contact->n_crossing() > 0 && ++m_at.pushed < MOST_PUSH_STEPS) continue; // what is through the skin is pushed harder each step
    if (m_coarse) {
      m_reporter.info("at rest on the coarser skin after " + std::to_string(k) + " steps, on to the whole one");
      leave_coarse_skin();
      calm = 0;
      continue;
    }
    if (m_at.untanglings < MOST_UNTANGLINGS && m_self_contact && !m_self_contact->find_crossings(m_solver->x()).empty()) {
      untangle_now();
      calm = 0;
      continue;
    }
    m_report.converged = true;
    m_report.stop_reason = "at rest";
    break;
  }
  if (m_at.arms_aside) let_arms_hang(); // stopped before
}

} // namespace sloper::garment

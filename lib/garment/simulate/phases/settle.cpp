#include <sloper/garment/retarget/retarget.hpp>
#include <sloper/garment/simulate/phases/settle.hpp>
#include <sloper/io/json.hpp>
#include <sloper/io/json_lists.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::garment {

namespace {

constexpr int UNLOADED_STEPS = 40; // after sewing, free of weight and friction
constexpr int MAX_UNTANGLINGS =
    8; // of cloth that crosses itself, half of them before it is at rest
// With DrapeRequest::only_clear, in place of those without CLEARING:
constexpr int MAX_UNTANGLINGS_CLEARING = 2;
// Found on one random GarmentCode of 38, the only one that ended with crossings: 43 pairs, then
// none. With a return to rest between openings 19 were left at the step limit.
constexpr int MAX_KNOT_OPENINGS = 3;
constexpr int KNOT_STEPS = 60;      // in which a knot may pass through itself
constexpr double KNOT_REACH = 0.04; // m around what crosses, at first; then twice, four times
constexpr int RESOLVE_EVERY_CLEARING = 8;
constexpr int MAX_PUSH_STEPS_CLEARING = 30;
constexpr int RESOLVE_EVERY = 40; // steps between looks whether cloth still crosses itself or a few
                                  // faces are still through the skin
constexpr int JUDGE_EVERY = 10;   // steps between looks whether the garment can still fit
constexpr int CALM_STEPS = 3;     // within the tolerances, one after the other: at rest
constexpr double NEARLY = 4;      // times the tolerances: nearly at rest
constexpr int LATELY = 100;       // steps
constexpr double SUNK =
    2e-4; // m that all cloth together may sink, when what was blocked is released, and be at rest
constexpr double NEAR_RESIDUAL = 1;      // weights: below, steps may grow faster
constexpr double GROWTH = 1.15;          // of the time step while little moves
constexpr double GROWTH_NEAR_REST = 1.3; // of the time step, near rest
constexpr double SHRINK_MUCH_MOVED = 0.8;
constexpr double SHRINK_HALVED = 0.7;   // after a step that the line search halved
constexpr double LITTLE_MOVED = 0.003;  // m, of the fastest particle in a step
constexpr double MUCH_MOVED = 0.01;     // m, of the fastest particle in a step
constexpr double BETTER_RESIDUAL = 0.9; // of the best so far: progress
constexpr double HUNG_SPEED =
    0.02; // m/s: slower, a skirt hangs, and arms that were held up can come down beside it
constexpr double HUNG_RESIDUAL = 10;     // weights: below, arms can come down
constexpr double LARGEST_STEP_S = 0.2;   // s
constexpr int PROBE_EVERY = 60;          // steps between looks whether cloth still drifts
constexpr int FIRST_PROBE_CARRIED = 240; // steps before the first look at cloth from a coarser mesh
constexpr int PROBE_STEPS = 20;          // before a look: over these drift is measured
constexpr double DRIFTS = 5e-4;          // m root mean square in them
constexpr int DYNAMIC_STEPS = 60;        // with inertia, at most
constexpr int LEAST_DYNAMIC_STEPS = 10;  // with inertia, at least: cloth begins to move
constexpr double DYNAMIC_STEP_S = 1.0 / 60;
constexpr double DYNAMIC_INERTIA = 0.98; // share of the velocity that is carried over
constexpr double ARRIVED_SPEED = 0.005;  // m/s of the fastest particle

} // namespace

int SettlePhase::unloaded_steps(const SimContext& context) const {
  return context.disturbed ? UNLOADED_STEPS : 0;
}

bool SettlePhase::is_loaded(const SimContext& context) const {
  return m_state.step > unloaded_steps(context);
}

void SettlePhase::begin(SimContext& context, bool resumed) {
  if (resumed)
    return;
  m_state.step = 0;
  m_state.h = context.settings.time_step_s;
  m_state.release_height_m.reset();
  m_state.probe_position.clear();
  m_state.start_height.clear();
  for (const Vec3& p : context.cloth.x())
    m_state.start_height.push_back(p.y());
}

void SettlePhase::forget_progress() {
  m_state.calm = m_state.pushed = m_state.best_residual_step = 0;
  m_state.best_residual = std::numeric_limits<double>::infinity();
}

/// Particles that a line search blocks for a while may be nails that a skirt hangs by. So rest
/// counts once releasing them moves nothing.
/// @return whether there is more to wait for
bool SettlePhase::release_blocked(SimContext& context) {
  const std::vector<Vec3>& x = context.cloth.x();
  double height = 0;
  for (const Vec3& p : x)
    height += p.y() / static_cast<double>(x.size());
  if (m_state.release_height_m && std::abs(height - *m_state.release_height_m) < SUNK)
    return false;
  m_state.release_height_m = height;
  return context.cloth.solver().release_blocked_particles();
}

/// A monotone energy descent moves cloth that slides or sways, and has folds to pass, by a tenth of
/// a millimetre a step, for hundreds of steps. With inertia it arrives within a second of simulated
/// time. So cloth that still drifts makes some steps with inertia.
void SettlePhase::look_for_drift(SimContext& context) {
  const int k = m_state.step;
  const int unloaded = unloaded_steps(context);
  if (k < unloaded || m_state.dynamic_steps > 0)
    return;
  const std::vector<Vec3>& x = context.cloth.x();
  if (k == unloaded)
    m_state.probe_step = context.carried ? k + FIRST_PROBE_CARRIED - PROBE_EVERY : k;
  if (k == m_state.probe_step + PROBE_EVERY - PROBE_STEPS)
    m_state.probe_position = x;
  if (k < m_state.probe_step + PROBE_EVERY)
    return;
  m_state.probe_step = k;
  if (m_state.probe_position.empty())
    return; // a checkpoint of an older version
  double squares = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    squares += (x[i] - m_state.probe_position[i]).squaredNorm();
  const double drift = std::sqrt(squares / static_cast<double>(x.size()));
  context.telemetry.reporter.info("settle step " + std::to_string(k) + ": went " +
                                  millimetres_text(drift) + " in " + std::to_string(PROBE_STEPS) +
                                  " steps");
  if (drift < DRIFTS || context.stepper.last().residual_force_ratio > HUNG_RESIDUAL)
    return; // the latter is drawn by its tension, which inertia would only stir
  context.cloth.solver().release_blocked_particles();
  context.cloth.solver().stop();
  m_state.dynamic_steps = DYNAMIC_STEPS;
  m_state.h = DYNAMIC_STEP_S;
}

void SettlePhase::end_dynamic_step(SimContext& context) {
  --m_state.dynamic_steps;
  const StepController& stepper = context.stepper;
  const bool arrived = DYNAMIC_STEPS - m_state.dynamic_steps >= LEAST_DYNAMIC_STEPS &&
                       stepper.last().largest_move_m < ARRIVED_SPEED * stepper.last_h();
  if (!arrived && m_state.dynamic_steps > 0)
    return;
  context.cloth.solver().stop();
  m_state.dynamic_steps = 0;
  m_state.probe_step = m_state.step;
  m_state.h = context.settings.time_step_s;
}

void SettlePhase::prepare_step(SimContext& context) {
  const int unloaded = unloaded_steps(context);
  if (m_state.step < unloaded)
    context.supports.add_inflation_pressure();
  if (m_state.step == unloaded) {
    context.supports.remove_inflation_pressure();
    context.supports.close_tangles();
    context.supports.release_ends();
    context.cloth.add_load();
    m_state.h = context.settings.time_step_s;
  }
  look_for_drift(context);
}

void SettlePhase::adapt_step(SimContext& context) {
  const cloth::StepResult& last = context.stepper.last();
  const double least = context.settings.time_step_s;
  double& h = m_state.h;
  if (last.halvings > 0)
    h = std::max(h * SHRINK_HALVED, least);
  else if (last.largest_move_m < LITTLE_MOVED)
    h = std::min(h * (last.residual_force_ratio > NEAR_RESIDUAL ? GROWTH : GROWTH_NEAR_REST),
                 LARGEST_STEP_S);
  else if (last.largest_move_m > MUCH_MOVED)
    h = std::max(h * SHRINK_MUCH_MOVED, least);
}

bool SettlePhase::has_stalled(SimContext& context) {
  const double residual = context.stepper.last().residual_force_ratio;
  if (m_state.step <= unloaded_steps(context) ||
      residual < BETTER_RESIDUAL * m_state.best_residual) {
    m_state.best_residual = residual;
    m_state.best_residual_step = m_state.step;
    return false;
  }
  return m_state.best_residual > 1 && m_state.step > m_state.best_residual_step + STALLED_STEPS;
}

/// Whether it would be a pity to stop: cloth that is all but at rest, or that came nearer to it
/// lately.
bool SettlePhase::nears_rest(SimContext& context) const {
  if (context.only_clear || m_state.step <= unloaded_steps(context))
    return false;
  const StepController& stepper = context.stepper;
  const bool nearly =
      stepper.speed() < NEARLY * context.settings.settle_speed_m_s &&
      stepper.last().residual_force_ratio < NEARLY * context.settings.settle_force_ratio;
  return nearly || m_state.step < m_state.best_residual_step + LATELY;
}

void SettlePhase::judge_fit(SimContext& context) {
  const Misfit misfit = context.fit.judge(m_state.start_height, context.stepper.last(),
                                          context.telemetry.report.steps);
  if (misfit == Misfit::NONE)
    return;
  context.telemetry.report.misfit = misfit;
  context.stepper.stop(StopReason::MISFIT);
}

PhaseStatus SettlePhase::step(SimContext& context) {
  if (context.stepper.stopped())
    return PhaseStatus::STOP;
  const PhaseStatus status = iterate(context);
  if (status == PhaseStatus::CONTINUE)
    ++m_state.step;
  return status;
}

PhaseStatus SettlePhase::iterate(SimContext& context) {
  context.checkpoints->offer();
  prepare_step(context);
  const int k = m_state.step;
  const int unloaded = unloaded_steps(context);
  const bool dynamic = m_state.dynamic_steps > 0;
  const cloth::BodyContactEffect* contact = context.cloth.body_contact();
  const bool crosses = contact && contact->n_crossing() > 0; // a pinch, if any is
  StepRequest request{.h = m_state.h,
                      .kind = StepKind::DESCEND,
                      .unloaded = k < unloaded,
                      .exact = context.carried,
                      .warm = !context.disturbed && !context.carried && !crosses};
  if (dynamic) {
    request.kind = StepKind::PLAIN;
    request.inertia = DYNAMIC_INERTIA;
  }
  context.stepper.set_patient(nears_rest(context));
  if (!context.stepper.advance(request))
    return PhaseStatus::STOP;
  const cloth::StepResult& last = context.stepper.last();
  const double speed = last.largest_move_m / m_state.h, residual = last.residual_force_ratio;
  if (k % 20 == 0)
    context.telemetry.reporter.info(
        "settle step " + std::to_string(k) + ": h " + std::to_string(m_state.h) + " s, speed " +
        std::to_string(speed) + " m/s, residual force " + std::to_string(residual) +
        " of the weight, at most " + std::to_string(last.residual_force_ratio_max) +
        context.cloth.crossing_text());
  context.telemetry.reporter.progress("settle", -1);
  if (dynamic)
    end_dynamic_step(context);
  else
    adapt_step(context);
  if (has_stalled(context)) {
    context.stepper.stop(StopReason::STALLED);
    return PhaseStatus::STOP;
  }
  m_state.unmoved = last.largest_move_m > 0 ? 0 : m_state.unmoved + 1;
  const bool stuck =
      m_state.unmoved >= UNMOVED_STEPS && residual >= context.settings.settle_force_ratio;
  const int resolve_every = context.only_clear ? RESOLVE_EVERY_CLEARING : RESOLVE_EVERY;
  const bool looks = k > unloaded && k % resolve_every == 0;
  if ((stuck || looks) && context.resolver.resolve_residual()) {
    restart_calm(context);
    m_state.unmoved = 0;
    m_state.best_residual_step = k;
    return PhaseStatus::CONTINUE;
  }
  if (stuck) {
    context.stepper.stop(StopReason::STUCK);
    return PhaseStatus::STOP;
  }
  if (k == m_state.knots_close_at)
    close_knots(context);
  cloth::SelfContactEffect* self_contact = context.cloth.self_contact();
  if (looks && self_contact && !self_contact->crossings().empty() &&
      context.resolver.state().untanglings < MAX_UNTANGLINGS / 2)
    context.resolver.untangle_in_flight();
  if (k > unloaded && k % JUDGE_EVERY == 0)
    judge_fit(context);
  const bool still = context.only_clear || (speed < context.settings.settle_speed_m_s &&
                                            residual < context.settings.settle_force_ratio);
  m_state.calm = still && k >= unloaded ? m_state.calm + 1 : 0;
  const bool hangs = context.only_clear || (speed < HUNG_SPEED && residual < HUNG_RESIDUAL);
  if (context.body.state().arms_aside && k > unloaded && hangs) {
    let_arms_hang(context);
    restart_calm(context);
    return PhaseStatus::CONTINUE;
  }
  return m_state.calm < CALM_STEPS ? PhaseStatus::CONTINUE : conclude(context);
}

/// Cloth is calm: what may still be wrong is looked at, before it counts as at rest.
PhaseStatus SettlePhase::conclude(SimContext& context) {
  if (m_state.knots_close_at >= 0) {
    close_knots(context);
    return PhaseStatus::CONTINUE;
  }
  if (release_blocked(context)) {
    m_state.calm = 0;
    return PhaseStatus::CONTINUE;
  }
  const cloth::BodyContactEffect* contact = context.cloth.body_contact();
  const int push_steps = context.only_clear ? MAX_PUSH_STEPS_CLEARING : MAX_PUSH_STEPS;
  if (contact && contact->n_crossing() > 0 && ++m_state.pushed < push_steps)
    return PhaseStatus::CONTINUE; // pushed harder each step
  if (context.body.has_coarse_proxy()) {
    context.telemetry.reporter.info("at rest on the coarser skin after " +
                                    std::to_string(m_state.step) + " steps, on to the whole one");
    drop_coarse_proxy(context);
    m_state.calm = 0;
    return PhaseStatus::CONTINUE;
  }
  cloth::SelfContactEffect* self_contact = context.cloth.self_contact();
  const int untanglings = context.only_clear ? MAX_UNTANGLINGS_CLEARING : MAX_UNTANGLINGS;
  if (context.resolver.state().untanglings < untanglings && self_contact &&
      !self_contact->find_crossings(context.cloth.x()).empty()) {
    context.resolver.untangle_in_flight();
    m_state.calm = 0;
    return PhaseStatus::CONTINUE;
  }
  if (open_knots(context))
    return PhaseStatus::CONTINUE;
  context.telemetry.report.converged = true;
  context.telemetry.report.stop_reason = StopReason::AT_REST;
  return PhaseStatus::DONE;
}

/// The last resort for cloth that crosses itself where it cannot be drawn apart.
bool SettlePhase::open_knots(SimContext& context) {
  cloth::SelfContactEffect* self_contact = context.cloth.self_contact();
  if (context.only_clear || m_state.knots_opened >= MAX_KNOT_OPENINGS || !self_contact ||
      self_contact->find_crossings(context.cloth.x()).empty())
    return false;
  m_state.knots_close_at = m_state.step + KNOT_STEPS;
  context.supports.open_knots(KNOT_REACH * (1 << m_state.knots_opened));
  ++m_state.knots_opened;
  restart_calm(context);
  return true;
}

/// What is left of them then is let pass again at once, within twice the reach.
void SettlePhase::close_knots(SimContext& context) {
  m_state.knots_close_at = -1;
  context.supports.close_tangles();
  m_state.calm = 0;
  open_knots(context);
}

void SettlePhase::restart_calm(SimContext& context) {
  m_state.h = context.settings.time_step_s;
  m_state.calm = 0;
}

/// Arms come down beside cloth that came to hang while they were aside: outside of it.
void SettlePhase::let_arms_hang(SimContext& context) {
  Garment& garment = context.cloth.garment();
  const double gap = context.settings.contact_gap_m;
  cloth::BodyContactEffect::Memory contact = context.cloth.body_contact()->memory();
  context.body.let_arms_hang();
  const std::vector<Vec3> hung = garment.position;
  std::vector<char> on_arms(hung.size(), 0);
  for (const pattern::PanelInfo& p : garment.panels.panels)
    for (int v = p.first_vertex; p.part.starts_with("arm") && v < p.first_vertex + p.n_vertices;
         ++v)
      on_arms[garment.particle_of[v]] = 1;
  const std::size_t moved = bring_under_arms(garment.position, on_arms, *context.body.body(), gap);
  if (moved > 0) {
    settle_shape(garment.position, {hung, garment.particle_triangles()}, *context.body.collider(),
                 gap);
    context.telemetry.add_repair(
        "arms: " + std::to_string(moved) +
        " particles in forearms or hands or beyond them were brought between those and the body");
    context.resolver.untangle();
    contact = {};
  }
  rebuild(context, *this, contact, false);
}

void SettlePhase::drop_coarse_proxy(SimContext& context) {
  cloth::BodyContactEffect::Memory contact;
  if (context.cloth.body_contact())
    contact = context.cloth.body_contact()->memory();
  context.body.drop_coarse_proxy();
  rebuild(context, *this, contact, false);
}

void SettlePhase::end(SimContext& context) {
  if (context.body.state().arms_aside)
    let_arms_hang(context); // stopped before
}

} // namespace sloper::garment

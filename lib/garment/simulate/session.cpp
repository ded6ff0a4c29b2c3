#include <garment/simulate/session.hpp>
#include <sloper/base/error.hpp>
#include <sloper/garment/sewing.hpp>

#include <cmath>

namespace sloper::garment {

namespace {

constexpr double SEW_LEG_SCALE = 0.7; // of the body's thickness while trousers are sewn
constexpr double SHRINK_SCALES[] = {0.9,  0.8, 0.65, 0.5,
                                    0.35, 0.2}; // tried one after the other until nothing is inside
constexpr std::size_t INFLATE_INDEX = 1, SETTLE_INDEX = 2, MOVE_INDEX = 3,
                      RESETTLE_INDEX = 4; // in the plan

std::size_t plan_index(const DrapeState& state) {
  switch (state.phase) {
  case DrapePhase::START:
  case DrapePhase::SEW: return 0;
  case DrapePhase::INFLATE: return INFLATE_INDEX;
  case DrapePhase::SETTLE: return state.move.over ? RESETTLE_INDEX : SETTLE_INDEX;
  case DrapePhase::MOVE: return MOVE_INDEX;
  }
  return 0;
}

} // namespace

DrapeSession::DrapeSession(const SessionInputs& inputs, const DrapeSettings& settings,
                           Reporter& reporter)
    : m_context(inputs.garment, inputs.body, settings, inputs.request.bounds, reporter),
      m_start(inputs.request.start), m_audits(inputs.request.audit),
      m_checkpoints(inputs.request.checkpoints),
      m_move(inputs.moves, inputs.on_frame), m_plan{&m_sew, &m_inflate, &m_settle, &m_move,
                                                    &m_settle} {
  m_context.checkpoints = this;
  m_context.only_clear = inputs.request.only_clear;
  m_context.carried = inputs.request.carried;
}

DrapeSession::DrapeSession(const SessionInputs& inputs, const DrapeCheckpoint& from,
                           Reporter& reporter)
    : m_context(inputs.garment = from.garment, inputs.body, from.report.settings, from.bounds,
                reporter),
      m_audits(inputs.request.audit), m_checkpoints(inputs.request.checkpoints),
      m_move(inputs.moves, inputs.on_frame), m_plan{&m_sew, &m_inflate, &m_settle, &m_move,
                                                    &m_settle} {
  m_context.checkpoints = this;
  m_context.only_clear = inputs.request.only_clear;
  m_context.carried = inputs.request.carried;
  restore(from);
}

DrapeSession::~DrapeSession() = default;

void DrapeSession::begin() {
  m_begun = true;
  Garment& garment = m_context.cloth.garment();
  const bool unsewn = garment.particle_of.empty();
  if (unsewn)
    unsew(garment);
  m_context.cloth.choose_effects();
  if (m_move.moves())
    m_context.telemetry.activate("body_motion", "the body moves");
  start_outside_body(unsewn);
  m_context.disturbed = unsewn || m_context.body.state().scale < 1 ||
                        m_start.hold_ends != LimbEnds::NONE || m_start.relax_first;
  if (!unsewn && m_context.disturbed)
    m_context.supports.find_ends(std::max(m_start.hold_ends, LimbEnds::SLEEVES));
  m_index = unsewn ? 0 : INFLATE_INDEX;
}

/// Sees to it that nothing of the garment starts inside the body. What is sewn around the lower
/// body is sewn as if the arms were held up, where no sleeve needs them; trousers around legs drawn
/// in, since between thighs that touch there is no room for a seam to close.
void DrapeSession::start_outside_body(bool unsewn) {
  CollisionBody& body = m_context.body;
  if (!body.has_skin())
    return;
  const PhaseTimer timer(m_context.telemetry, "prepare body");
  const Garment& garment = m_context.cloth.garment();
  const bool sewn_on_legs = unsewn && !placed_on(garment, "leg").empty();
  // A garment that was worn before is placed beside the arms as they are.
  const bool from_panels = unsewn || (m_start.around_body && garment.bind.empty());
  if (from_panels && m_context.cloth.is_active("body_contact"))
    body.find_arms_aside(garment);
  body.prepare(body.ends_near(garment.position) |
               (body.state().arms_aside ? ExtremityHulls::HANDS : 0u));
  body.put_arms_aside();
  const std::size_t violations = m_context.resolver.count_in_body();
  if (violations == 0 && sewn_on_legs)
    body.draw_in(SEW_LEG_SCALE);
  if (violations == 0 || (!unsewn && m_context.resolver.resolve_initial(violations)))
    return;
  if (m_start.around_body) {
    m_context.telemetry.add_repair("start: " + std::to_string(violations) +
                                   " vertices or faces in the body, left to contact");
    return;
  }
  double best = 1;
  std::size_t least = violations;
  for (double scale : SHRINK_SCALES) {
    body.draw_in(scale);
    const std::size_t count = m_context.resolver.count_in_body();
    if (count < least) {
      least = count;
      best = scale;
    }
    if (count == 0)
      break;
  }
  body.draw_in(best);
  m_context.telemetry.add_repair(
      "start: " + std::to_string(violations) + " vertices or faces in the body; body drawn in to " +
      std::to_string(std::lround(best * 100)) + " % of its thickness and inflated again" +
      (least ? ", " + std::to_string(least) + " remained" : ""));
}

void DrapeSession::close_seams() {
  m_context.resolver.untangle();
  if (m_start.around_body && m_context.body.collider()) { // cloth drawn apart may be in the body
    const std::size_t violations = m_context.resolver.count_in_body();
    if (violations > 0)
      m_context.resolver.resolve_initial(violations);
  }
  m_context.build_cloth(false);
}

void DrapeSession::enter(std::size_t index, bool resumed) {
  m_index = index;
  m_phase = m_plan[index];
  if (*m_phase->name())
    m_timer = std::make_unique<PhaseTimer>(m_context.telemetry, m_phase->name());
  if (index == RESETTLE_INDEX && !resumed)
    m_settle.forget_progress();
  m_phase->begin(m_context, resumed);
}

void DrapeSession::leave() {
  m_phase->end(m_context);
  m_timer.reset();
  m_phase = nullptr;
  ++m_index;
}

bool DrapeSession::advance_to_next_phase() {
  if (m_resumed) {
    m_resumed = false;
    enter(m_index, true);
    return true;
  }
  for (; m_index < m_plan.size(); ++m_index) {
    if (m_index == INFLATE_INDEX)
      close_seams();
    const bool is_second_rest = m_index == RESETTLE_INDEX;
    if (is_second_rest && !m_move.state(m_context).over)
      continue;
    if (!m_plan[m_index]->is_needed(m_context))
      continue;
    enter(m_index, false);
    return true;
  }
  return false;
}

bool DrapeSession::step() {
  if (!m_begun)
    begin();
  if (!m_phase)
    return advance_to_next_phase();
  if (m_phase->step(m_context) == PhaseStatus::CONTINUE)
    return true;
  const bool goes_on =
      !stopped() ||
      m_phase == &m_inflate; // a garment that was stopped meanwhile is still let down onto its arms
  leave();
  return goes_on && m_index < m_plan.size();
}

DrapeReport DrapeSession::run() {
  while (step()) {}
  return finish();
}

/// The whole phase, for clients that lead the session themselves.
void DrapeSession::inflate_now() {
  if (!m_inflate.is_needed(m_context))
    return;
  enter(INFLATE_INDEX, false);
  while (m_inflate.step(m_context) == PhaseStatus::CONTINUE) {}
  leave();
}

void DrapeSession::start_live(bool loaded) {
  m_begun = true;
  m_context.cloth.choose_effects();
  start_outside_body(false);
  m_context.build_cloth(false);
  inflate_now();
  if (loaded)
    m_context.cloth.add_load();
}

bool DrapeSession::advance(const StepRequest& request) {
  return m_context.stepper.advance(request);
}

void DrapeSession::set_positions(const std::vector<Vec3>& x) {
  m_context.cloth.garment().position = x;
  m_context.cloth.solver().positions_changed();
}

void DrapeSession::rebuild_cloth(bool loaded) {
  m_context.build_cloth(false);
  if (loaded)
    m_context.cloth.add_load();
}

void DrapeSession::forget_simulated_time() {
  m_context.stepper.forget_iterations();
  m_context.telemetry.report.simulated_s = 0;
}

void DrapeSession::settle() {
  m_context.disturbed = false;
  enter(SETTLE_INDEX, false);
  while (m_settle.step(m_context) == PhaseStatus::CONTINUE) {}
  leave();
}

void DrapeSession::choose_contact_alone() {
  m_context.cloth.choose_effects();
  for (EffectReport& e : m_context.telemetry.report.effects)
    e.active = e.active && (e.name == "body_contact" || e.name == "self_contact");
}

const collision::BodyCollider* DrapeSession::full_skin() {
  m_context.body.use_full_skin();
  return m_context.body.collider();
}

void DrapeSession::push_apart(int max_push_steps) {
  m_context.cloth.choose_effects();
  start_outside_body(false);
  close_seams();
  inflate_now();
  const StepRequest request{.h = m_context.settings.time_step_s};
  for (int k = 0; k < max_push_steps && !stopped(); ++k) {
    const cloth::BodyContactEffect* contact = m_context.cloth.body_contact();
    if (!contact || contact->n_crossing() == 0)
      break;
    advance(request);
  }
  m_context.cloth.tear_down();
  m_context.body.use_full_skin();
}

bool DrapeSession::takes_checkpoints() const {
  return !m_checkpoints.file.empty() || m_checkpoints.renew;
}

bool DrapeSession::offer() {
  const int steps = m_context.telemetry.report.steps;
  if (!takes_checkpoints() || steps == m_checkpoint_step || steps % m_checkpoints.every_steps != 0)
    return false;
  take_checkpoint();
  return true;
}

bool DrapeSession::offer(int count, int& last) {
  if (!takes_checkpoints() || count - last < m_checkpoints.every_steps)
    return false;
  last = count;
  take_checkpoint();
  return true;
}

/// The solver begins anew here, whether a file is written or not: so does the run that goes on from
/// it.
void DrapeSession::take_checkpoint() {
  DrapeReport& report = m_context.telemetry.report;
  m_checkpoint_step = report.steps;
  const DrapeState state = save();
  m_context.cloth.tear_down();
  if (!m_checkpoints.file.empty()) {
    report.wall_s = elapsed();
    DrapeCheckpoint checkpoint{.garment = m_context.cloth.garment(),
                               .state = state,
                               .report = report,
                               .every_steps = m_checkpoints.every_steps,
                               .bounds = m_context.fit.bounds(),
                               .has_body = m_context.body.body() != nullptr,
                               .motion = m_checkpoints.motion,
                               .layers = {},
                               .levels = {},
                               .file = {}};
    if (m_checkpoints.layers)
      checkpoint.layers = *m_checkpoints.layers;
    if (m_checkpoints.levels)
      checkpoint.levels = *m_checkpoints.levels;
    write_checkpoint(m_checkpoints.file, checkpoint);
  }
  rebuild(m_context, *m_phase, state.contact, m_phase->keeps_velocity());
}

DrapeState DrapeSession::save() const {
  DrapeState state;
  state.phase = m_phase->id();
  state.disturbed = m_context.disturbed;
  state.body = m_context.body.state();
  state.stepper = m_context.stepper.state();
  state.resolver = m_context.resolver.state();
  state.supports = m_context.supports.state();
  if (m_context.cloth.body_contact())
    state.contact = m_context.cloth.body_contact()->memory();
  state.sew = m_sew.state();
  state.inflate = m_inflate.state();
  if (state.phase == DrapePhase::INFLATE)
    state.inflate.skin = m_context.body.collider()->mesh().positions;
  state.settle = m_settle.state();
  if (state.settle.dynamic_steps > 0)
    state.settle.velocity = m_context.cloth.v();
  state.move = m_move.state(m_context);
  state.fit = m_context.fit.state();
  return state;
}

void DrapeSession::restore(const DrapeCheckpoint& from) {
  const DrapeState& state = from.state;
  from.check_body(m_context.body.body(), "");
  // The body stands still while a garment of several is alone, and while levels of mesh are gone
  // through.
  const bool on_a_rung = from.levels && !from.levels->rung.empty();
  if (!on_a_rung && (!from.layers || from.layers->alone == from.layers->garments.size()))
    from.check_moves(m_move.moves());
  DrapeReport& report = m_context.telemetry.report;
  report.steps = m_checkpoint_step = from.report.steps;
  report.simulated_s = from.report.simulated_s;
  report.effects = from.report.effects;
  report.phases = from.report.phases;
  report.repairs = from.report.repairs;
  m_context.telemetry.add_elapsed_before(from.report.wall_s);
  m_checkpoints.every_steps = from.every_steps;
  m_checkpoints.renew = true;
  if (state.phase == DrapePhase::START)
    return;
  m_begun = true;
  m_context.disturbed = state.disturbed;
  m_context.stepper.restore(state.stepper);
  m_context.resolver.restore(state.resolver);
  m_context.supports.restore(state.supports);
  m_sew.restore(state.sew);
  m_inflate.restore(state.inflate);
  m_settle.restore(state.settle);
  m_move.restore(state.move);
  m_context.fit.restore(state.fit);
  restore_body(from);
  m_context.cloth.set_velocity(state.phase == DrapePhase::MOVE ? state.move.velocity
                                                               : state.settle.velocity);
  m_index = plan_index(state);
  Phase& phase = *m_plan[m_index];
  const bool keep_velocity = phase.keeps_velocity() && !m_context.cloth.v().empty();
  rebuild(m_context, phase, state.contact, keep_velocity);
  m_resumed = true;
}

void DrapeSession::restore_body(const DrapeCheckpoint& from) {
  CollisionBody& body = m_context.body;
  if (!body.has_skin())
    return;
  const PhaseTimer timer(m_context.telemetry, "prepare body");
  const DrapeState& state = from.state;
  body.restore(state.body, m_context.cloth.garment());
  if (state.move.frame > 0) {
    const std::vector<Vec3> skin = m_move.moves()->skin(state.move.frame - 1);
    body.collider()->set_positions(body.collision_surface(skin));
    if (!state.move.over)
      return;
    body.stand_at(skin);
    m_context.stepper.allow_more_steps(state.move.parts);
  } else if (state.body.shrunk || state.body.arms_aside) {
    const bool inflating = state.phase == DrapePhase::INFLATE;
    if (inflating && state.inflate.skin.size() != body.collider()->mesh().positions.size())
      throw input_error("checkpoint.other-run"_id, from.file, "", "belongs to another body",
                        "give the same --body as before");
    body.collider()->set_positions(inflating ? state.inflate.skin : body.skin_at(state.body.scale));
  }
}

} // namespace sloper::garment

#include <sloper/garment/simulate/phases/inflate.hpp>
#include <sloper/io/json.hpp>
#include <sloper/io/json_lists.hpp>

#include <algorithm>

namespace sloper::garment {

namespace {

constexpr double SKIN_MOVE_M = 0.002; // how far the skin moves per step
constexpr double MAX_SKIN_LAG_M = 0.01;
constexpr int LAG_STEPS = 40; // in which what stayed back comes home
constexpr double STEP_S = 1.0 / 30;

} // namespace

bool InflatePhase::is_needed(const SimContext& context) const {
  return context.body.state().scale < 1 && context.cloth.body_contact();
}

void InflatePhase::begin(SimContext& context, bool resumed) {
  m_skin = context.body.collider()->mesh().positions;
  if (!resumed)
    m_state = {.max_skin_lag_m = MAX_SKIN_LAG_M, .skin = {}};
  context.stepper.advance({.h = STEP_S}); // contact knows how far skin may move from its last step
}

bool InflatePhase::is_done(const SimContext& context) const {
  return context.stepper.stopped() || (context.body.state().scale >= 1 && m_state.skin_lag_m <= 0);
}

void InflatePhase::move_skin(SimContext& context) {
  const std::vector<Vec3> target = context.body.skin_at(context.body.state().scale);
  const std::vector<double> room =
      context.cloth.body_contact()->max_safe_skin_displacement(context.cloth.x());
  m_state.skin_lag_m = 0;
  for (std::size_t v = 0; v < m_skin.size(); ++v) {
    const Vec3 displacement = target[v] - m_skin[v];
    const double length = displacement.norm();
    const double lag = std::min(length - room[v], m_state.max_skin_lag_m);
    if (lag > 0) {
      m_skin[v] = target[v] - lag / length * displacement;
      m_state.skin_lag_m = std::max(m_state.skin_lag_m, lag);
    } else {
      m_skin[v] = target[v];
    }
  }
}

PhaseStatus InflatePhase::step(SimContext& context) {
  if (is_done(context))
    return PhaseStatus::DONE;
  const double scale = context.body.state().scale;
  if (scale < 1)
    context.body.set_scale(std::min(1.0, scale + SKIN_MOVE_M / context.body.reach()));
  else
    m_state.max_skin_lag_m = std::max(0.0, m_state.max_skin_lag_m - MAX_SKIN_LAG_M / LAG_STEPS);
  move_skin(context);
  cloth::BodyContactEffect& contact = *context.cloth.body_contact();
  contact.move_body(m_skin, context.cloth.x());
  if (m_state.skin_lag_m >= m_state.max_skin_lag_m)
    contact.refresh(); // some of it had to go through
  context.stepper.advance({.h = STEP_S});
  if (!context.stepper.stopped() && context.checkpoints->offer())
    context.stepper.advance({.h = STEP_S}); // as in begin()
  return is_done(context) ? PhaseStatus::DONE : PhaseStatus::CONTINUE;
}

void InflatePhase::end(SimContext& context) {
  cloth::BodyContactEffect& contact = *context.cloth.body_contact();
  contact.move_body(context.body.skin_at(1), context.cloth.x()); // also when stopped before the end
  contact.refresh();
}

} // namespace sloper::garment

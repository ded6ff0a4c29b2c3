#include <sloper/collision/intersections.hpp>
#include <sloper/garment/simulate/phases/move.hpp>
#include <sloper/io/json.hpp>
#include <sloper/io/json_lists.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sloper::garment {

namespace {

constexpr double MOTION_SLACK =
    0.008; // m: pairs are kept this far beyond their reach, so that parts of the motion can be long
constexpr double WAKE_DISTANCE =
    0.05; // m: around the box of sleeping cloth; skin that moves in there wakes it
constexpr double REST_DISTANCE = 1e-4; // m: no particle comes farther
constexpr double REST_S = 0.2;         // s
constexpr double LARGEST_MOVE_M = 1;   // of a particle in a step
constexpr double CG_TOLERANCE = 1e-3;  // relative residual, at most
constexpr double AUDIT_REACH = 0.05; // m: nearer to the skin, its normal tells inside from outside

} // namespace

void RestClock::note(const std::vector<Vec3>& x, double frame_s) {
  bool same = m_from.size() == x.size();
  for (std::size_t i = 0; same && i < x.size(); ++i)
    same = (x[i] - m_from[i]).norm() <= REST_DISTANCE;
  m_s = same ? m_s + frame_s : 0;
  if (!same)
    m_from = x;
}

bool RestClock::is_at_rest() const {
  return !m_from.empty() && m_s >= REST_S;
}

bool MovePhase::is_needed(const SimContext& context) const {
  return m_moves && !m_state.over && context.cloth.body_contact();
}

MovePhase::State MovePhase::state(const SimContext& context) const {
  State state = m_state;
  if (!state.over && m_motion) {
    state.elapsed_s = context.telemetry.elapsed() - m_began;
    state.velocity = context.cloth.v();
  }
  return state;
}

void MovePhase::make_motion(SimContext& context) {
  cloth::BodyContactEffect& contact = *context.cloth.body_contact();
  contact.set_slack(MOTION_SLACK);
  m_motion.emplace(context.cloth.solver(), contact, *context.body.collider(),
                   context.cloth.self_contact());
  m_motion->parts = m_state.parts;
  m_motion->forced = m_state.forced;
  m_motion->largest_way_m = m_state.largest_way_m;
  m_motion->wall_s = m_state.wall_s;
}

void MovePhase::begin(SimContext& context, bool resumed) {
  m_began = context.telemetry.elapsed() - m_state.elapsed_s;
  context.telemetry.report.converged = false;
  if (!resumed)
    context.cloth.solver().stop();
  make_motion(context);
  m_skin =
      m_state.frame > 0 ? m_moves->skin(m_state.frame - 1) : context.body.body()->skin.positions;
}

MovePhase::Substeps MovePhase::substeps(const SimContext& context) const {
  const DrapeSettings& settings = context.settings;
  const auto count = static_cast<std::size_t>(
      std::max(1.0, std::ceil(m_moves->frame_s / settings.motion_step_s - 1e-9)));
  cloth::StepOptions options;
  options.h = m_moves->frame_s / static_cast<double>(count);
  options.inertia = 1;
  options.largest_move_m = LARGEST_MOVE_M;
  options.cg_tolerance = std::min(settings.cg_tolerance, CG_TOLERANCE);
  options.cg_max_iterations = settings.cg_max_iterations;
  options.newton_iterations = settings.newton_iterations;
  options.guard_energy = true;
  return {count, options};
}

/// Whether sleeping cloth must take part in a frame: skin near it moves, or wind blows.
bool MovePhase::wakes(const SimContext& context, const std::vector<Vec3>& from,
                      const std::vector<Vec3>& to) const {
  if (context.cloth.is_active("wind"))
    return true;
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Vec3& p : context.cloth.x()) {
    low = low.cwiseMin(p - Vec3::Constant(WAKE_DISTANCE));
    high = high.cwiseMax(p + Vec3::Constant(WAKE_DISTANCE));
  }
  for (std::size_t v = 0; v < from.size(); ++v) {
    if (from[v] == to[v])
      continue;
    if ((from[v].cwiseMin(to[v]).array() <= high.array()).all() &&
        (from[v].cwiseMax(to[v]).array() >= low.array()).all())
      return true;
  }
  return false;
}

void MovePhase::audit(const SimContext& context, MotionFrame& frame) const {
  const Garment& garment = context.cloth.garment();
  const collision::BodyCollider& skin = *context.body.collider();
  const std::vector<Triangle> triangles = garment.particle_triangles();
  const collision::TriangleTree tree(garment.position, triangles);
  frame.vertices_inside = 0;
  frame.self_intersections =
      collision::self_intersections(garment.position, triangles, tree).size();
  frame.faces_through = skin.faces_through(garment.position, triangles).size();
  for (const Vec3& p : garment.position) {
    const collision::SignedDistance d = skin.signed_distance(p, AUDIT_REACH);
    frame.vertices_inside += d.triangle >= 0 ? d.distance < 0 : skin.is_inside(p);
  }
}

/// From where the skin stands to the frame's own.
void MovePhase::move_skin(SimContext& context, const std::vector<Vec3>& from, MotionFrame& frame) {
  const Substeps steps = substeps(context);
  std::vector<Vec3> target = m_skin;
  for (std::size_t s = 1; s <= steps.count && !context.stepper.stopped(); ++s) {
    const double t = static_cast<double>(s) / static_cast<double>(steps.count);
    for (std::size_t v = 0; v < m_skin.size(); ++v)
      target[v] = s < steps.count ? Vec3((1 - t) * from[v] + t * m_skin[v]) : m_skin[v];
    const cloth::StepResult result =
        m_motion->advance(context.body.collision_surface(target), steps.options);
    frame.speed_m_s = std::max(frame.speed_m_s, result.largest_move_m / steps.options.h);
    context.stepper.note(result, "frame " + std::to_string(m_state.frame + 1) + " of the motion");
  }
}

/// Into the sums of the report.
void MovePhase::count(MotionFrame& frame) {
  m_state.simulated_s += m_moves->frame_s;
  frame.number = static_cast<int>(++m_state.frame);
  frame.pose = std::max(0, frame.number - static_cast<int>(m_moves->lead_in));
  frame.time_s = m_state.simulated_s;
  frame.parts = m_motion->parts - m_state.parts;
  frame.forced = m_motion->forced > m_state.forced;
  m_state.parts = static_cast<int>(m_motion->parts);
  m_state.forced = static_cast<int>(m_motion->forced);
  m_state.largest_way_m = m_motion->largest_way_m;
  m_state.wall_s = m_motion->wall_s;
  m_state.forced_frames += frame.forced;
}

PhaseStatus MovePhase::step(SimContext& context) {
  if (m_state.frame >= m_moves->n_frames || context.stepper.stopped())
    return PhaseStatus::DONE;
  if (context.checkpoints->offer(m_state.parts, m_state.noted)) {
    make_motion(context);
    m_rest.reset(); // a run that continues from here knows nothing of it
  }
  context.telemetry.reporter.progress("body motion", static_cast<double>(m_state.frame) /
                                                         static_cast<double>(m_moves->n_frames));
  const std::vector<Vec3> from = std::move(m_skin);
  m_skin = m_moves->skin(m_state.frame);
  MotionFrame frame = m_last;
  frame.speed_m_s = 0;
  if (wakes(context, from, m_skin))
    m_rest.reset();
  const bool asleep = m_rest.is_at_rest();
  if (asleep) {
    ++m_state.asleep_frames;
    context.cloth.body_contact()->move_body(context.body.collision_surface(m_skin),
                                            context.cloth.x());
  } else {
    move_skin(context, from, frame);
    m_rest.note(context.cloth.x(), m_moves->frame_s);
    if (m_rest.is_at_rest())
      context.cloth.solver().stop();
  }
  count(frame);
  if (!asleep)
    audit(context, frame);
  m_last = frame;
  const std::size_t found[3] = {frame.faces_through, frame.vertices_inside,
                                frame.self_intersections};
  for (int i = 0; i < 3; ++i) {
    m_state.bad_frames[i] += found[i] > 0;
    m_state.most[i] = std::max(m_state.most[i], static_cast<int>(found[i]));
  }
  if (m_on_frame)
    m_on_frame(frame, context.cloth.garment());
  context.stepper.check_time();
  return PhaseStatus::CONTINUE;
}

void MovePhase::end(SimContext& context) {
  m_state.elapsed_s = context.telemetry.elapsed() - m_began;
  m_state.velocity.clear();
  m_state.over = true;
  m_motion.reset();
  DrapeReport& report = context.telemetry.report;
  context.telemetry.add_phase_time("body motion", m_state.elapsed_s);
  report.simulated_s += m_state.simulated_s;
  report.steps += m_state.parts;
  for (EffectReport& e : report.effects)
    if (e.name == "body_motion") {
      e.calls = m_state.parts;
      e.wall_s = m_state.wall_s;
    }
  context.body.stand_at(m_skin);
  context.stepper.allow_more_steps(m_state.parts);
  context.cloth.solver().stop();
  context.disturbed = false;
  context.cloth.body_contact()->set_slack(cloth::BodyContactOptions{}.slack_m);
}

int MovePhase::bad_frames() const {
  return *std::max_element(std::begin(m_state.bad_frames), std::end(m_state.bad_frames));
}

io::Json MovePhase::report() const {
  const State& m = m_state;
  const auto count = [&](int k) {
    return io::Json{{"frames", m.bad_frames[k]}, {"most", m.most[k]}};
  };
  return {
      {"frames", m.frame},
      {"lead_in", std::min(m_moves->lead_in, m.frame)},
      {"frame_s", m_moves->frame_s},
      {"parts", m.parts},
      {"forced_frames", m.forced_frames},
      {"asleep_frames", m.asleep_frames},
      {"largest_way_m", m.largest_way_m},
      {"ms_per_frame", 1000 * m.elapsed_s / static_cast<double>(std::max<std::size_t>(m.frame, 1))},
      {"faces_through_body", count(0)},
      {"vertices_inside_body", count(1)},
      {"self_intersections", count(2)}};
}

} // namespace sloper::garment

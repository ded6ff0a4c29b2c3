/// What each part of a session saves, as JSON: apart from the parts themselves, so that who reads a
/// checkpoint needs no solver.
#include <sloper/garment/simulate/checkpoint.hpp>
#include <sloper/io/json.hpp>
#include <sloper/io/json_lists.hpp>

#include <algorithm>

namespace sloper::garment {

namespace {

io::Json step_json(const cloth::StepResult& s) {
  return {{"cg_iterations", s.cg.iterations},
          {"cg_residual", s.cg.residual},
          {"largest_move_m", s.largest_move_m},
          {"halvings", s.halvings},
          {"residual_force_ratio", s.residual_force_ratio},
          {"residual_force_ratio_max", s.residual_force_ratio_max},
          {"held", s.held}};
}

cloth::StepResult read_step(const io::Node& node) {
  cloth::StepResult s;
  s.cg.iterations = node.at("cg_iterations").integer();
  s.cg.residual = node.at("cg_residual").number();
  s.largest_move_m = node.at("largest_move_m").number();
  s.halvings = node.at("halvings").integer();
  s.residual_force_ratio = node.at("residual_force_ratio").number();
  s.residual_force_ratio_max = node.at("residual_force_ratio_max").number();
  s.held = static_cast<std::size_t>(std::max(0, node.at("held").integer()));
  return s;
}

} // namespace

void CollisionBody::State::write(io::Json& state) const {
  state["covered"] = covered;
  state["whole_skin"] = full_skin;
  state["shrunk"] = shrunk;
  state["arms_aside"] = arms_aside;
  state["scale"] = scale;
}

CollisionBody::State CollisionBody::State::read(const io::Node& node) {
  State state;
  int covered = 0;
  if (node.has("covered"))
    covered = node.at("covered").integer();
  else if (node.at("mitten").boolean())
    covered = static_cast<int>(ExtremityHulls::HANDS); // older ones: hands alone
  if (covered < 0 || covered > static_cast<int>(ExtremityHulls::ALL_ENDS))
    node.at("covered").fail("checkpoint.damaged"_id,
                            "has unknown bits; the checkpoint is damaged or of a newer version");
  state.covered = static_cast<unsigned>(covered);
  state.full_skin = node.has("whole_skin") && node.at("whole_skin").boolean();
  state.shrunk = node.at("shrunk").boolean();
  state.arms_aside = node.has("arms_aside") && node.at("arms_aside").boolean();
  state.scale = node.at("scale").number();
  return state;
}

void StepController::State::write(io::Json& state) const {
  state["last"] = step_json(last);
  state["last_h"] = last_h;
  state["cg_iterations"] = cg_iterations;
  state["solves"] = solves;
  state["rejected"] = rejected;
}

StepController::State StepController::State::read(const io::Node& node) {
  State state;
  state.last = read_step(node.at("last"));
  state.last_h = node.at("last_h").number();
  state.cg_iterations = io::read_integers(node.at("cg_iterations"));
  state.solves = node.has("solves")
                     ? node.at("solves").integer()
                     : static_cast<int>(state.cg_iterations.size()); // older ones: one a step
  state.rejected = io::read_strings(node.at("rejected"));
  return state;
}

void PenetrationResolver::State::write(io::Json& state) const {
  state["untanglings"] = untanglings;
  state["partings"] = partings;
}

PenetrationResolver::State PenetrationResolver::State::read(const io::Node& node) {
  State state;
  state.untanglings = node.at("untanglings").integer();
  state.partings = node.at("partings").integer();
  return state;
}

void TemporarySupports::State::write(io::Json& state) const {
  state["held"] = io::flat_points(held);
  state["held_legs"] = ends == LimbEnds::SLEEVES_AND_LEGS;
  state["tucks"] = tangles;
}

TemporarySupports::State TemporarySupports::State::read(const io::Node& node,
                                                        std::size_t n_particles) {
  State state;
  if (node.has("held"))
    state.held = io::read_flat_points(node.at("held"));
  if (!state.held.empty())
    state.ends = node.has("held_legs") && node.at("held_legs").boolean()
                     ? LimbEnds::SLEEVES_AND_LEGS
                     : LimbEnds::SLEEVES;
  if (node.has("tucks"))
    state.tangles = io::read_integers(node.at("tucks"));
  for (int i : state.tangles)
    if (i < 0 || static_cast<std::size_t>(i) >= n_particles)
      node.at("tucks").fail("checkpoint.damaged"_id, "does not belong to this garment");
  return state;
}

io::Json FitMonitor::State::to_json() const {
  return {{"strains", strains},
          {"least_strain", least_strain},
          {"strain_fell_at", strain_fell_at},
          {"slip_m", slip}};
}

FitMonitor::State FitMonitor::State::read(const io::Node& node) {
  State state;
  state.strains = io::read_numbers(node.at("strains"));
  state.least_strain = node.at("least_strain").number();
  state.strain_fell_at = node.at("strain_fell_at").integer();
  state.slip = node.at("slip_m").number();
  return state;
}

void SewPhase::State::write(io::Json& state) const {
  state["pull"] = pull;
  state["pull_changed"] = pull_changed;
  state["gaps"] = gaps;
}

SewPhase::State SewPhase::State::read(const io::Node& node) {
  State state;
  state.pull = node.at("pull").number();
  state.pull_changed = node.at("pull_changed").integer();
  state.gaps = io::read_numbers(node.at("gaps"));
  return state;
}

void InflatePhase::State::write(io::Json& state) const {
  state["latest"] = max_skin_lag_m;
  state["farthest"] = skin_lag_m;
  state["skin"] = io::flat_points(skin);
}

InflatePhase::State InflatePhase::State::read(const io::Node& node) {
  State state;
  state.max_skin_lag_m = node.at("latest").number();
  state.skin_lag_m = node.at("farthest").number();
  state.skin = io::read_flat_points(node.at("skin"));
  return state;
}

void SettlePhase::State::write(io::Json& state) const {
  state["h"] = h;
  state["calm"] = calm;
  state["unmoved"] = unmoved;
  state["pushed"] = pushed;
  state["best_at"] = best_residual_step;
  if (best_residual < std::numeric_limits<double>::infinity())
    state["best"] = best_residual;
  state["start_height"] = start_height;
  if (release_height_m)
    state["thawed_at"] = *release_height_m;
  state["looked_at"] = probe_step;
  state["looked_from"] = io::flat_points(probe_position);
  state["free_steps"] = dynamic_steps;
  state["velocity"] = io::flat_points(velocity);
  if (knots_opened > 0) {
    state["knots_opened"] = knots_opened;
    state["knots_close_at"] = knots_close_at;
  }
}

SettlePhase::State SettlePhase::State::read(const io::Node& node, std::size_t n_particles) {
  State state;
  state.h = node.at("h").number();
  state.calm = node.at("calm").integer();
  state.pushed = node.at("pushed").integer();
  state.best_residual_step = node.at("best_at").integer();
  if (node.has("unmoved"))
    state.unmoved = node.at("unmoved").integer();
  if (node.has("best"))
    state.best_residual = node.at("best").number();
  state.start_height = io::read_numbers(node.at("start_height"));
  if (node.has("thawed_at"))
    state.release_height_m = node.at("thawed_at").number();
  if (node.has("knots_opened")) {
    state.knots_opened = node.at("knots_opened").integer();
    state.knots_close_at = node.at("knots_close_at").integer();
  }
  if (node.has("looked_at")) { // older ones: from here on
    state.probe_step = node.at("looked_at").integer();
    state.probe_position = io::read_flat_points(node.at("looked_from"));
    state.dynamic_steps = node.at("free_steps").integer();
    state.velocity = io::read_flat_points(node.at("velocity"));
    for (const std::vector<Vec3>* of_particles : {&state.probe_position, &state.velocity})
      if (!of_particles->empty() && of_particles->size() != n_particles)
        node.at("looked_from").fail("checkpoint.damaged"_id, "does not belong to this garment");
  }
  return state;
}

io::Json MovePhase::State::to_json() const {
  return {{"frame", frame},
          {"over", over},
          {"velocity", io::flat_points(velocity)},
          {"parts", parts},
          {"forced", forced},
          {"noted", noted},
          {"forced_frames", forced_frames},
          {"asleep_frames", asleep_frames},
          {"bad_frames", bad_frames},
          {"most", most},
          {"largest_way_m", largest_way_m},
          {"simulated_s", simulated_s},
          {"wall_s", wall_s},
          {"elapsed_s", elapsed_s}};
}

MovePhase::State MovePhase::State::read(const io::Node& node) {
  State state;
  if (node.at("frame").integer() < 1)
    node.at("frame").fail("json.out-of-range"_id, "expected a number above zero");
  state.frame = static_cast<std::size_t>(node.at("frame").integer());
  state.over = node.at("over").boolean();
  state.velocity = io::read_flat_points(node.at("velocity"));
  state.parts = node.at("parts").integer();
  state.forced = node.at("forced").integer();
  state.noted = node.at("noted").integer();
  state.forced_frames = node.at("forced_frames").integer();
  if (node.has("asleep_frames"))
    state.asleep_frames = node.at("asleep_frames").integer(); // older ones have none
  for (std::size_t i = 0; i < 3; ++i) {
    state.bad_frames[i] = node.at("bad_frames").at(i).integer();
    state.most[i] = node.at("most").at(i).integer();
  }
  state.largest_way_m = node.at("largest_way_m").number();
  state.simulated_s = node.at("simulated_s").number();
  state.wall_s = node.at("wall_s").number();
  state.elapsed_s = node.at("elapsed_s").number();
  return state;
}

} // namespace sloper::garment

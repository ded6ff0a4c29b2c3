#include <sloper/garment/garment_json.hpp>
#include <sloper/garment/scene/scene.hpp>
#include <sloper/garment/simulate/checkpoint.hpp>

#include <sloper/base/error.hpp>
#include <sloper/io/json.hpp>
#include <sloper/io/json_lists.hpp>

#include <algorithm>

namespace sloper::garment {

namespace {

using io::Json;
using io::Node;

constexpr int MOST_EXTRA_STEPS = 1000000; // as many as max_steps allows
constexpr const char* PHASES[] = {"start", "sew", "inflate", "settle", "move"};

Json contact_json(const cloth::BodyContactEffect::Memory& contact) {
  return {{"anchor", io::flat_points(contact.anchor)},
          {"has_anchor", std::vector<int>(contact.has_anchor.begin(), contact.has_anchor.end())},
          {"push", contact.push}};
}

cloth::BodyContactEffect::Memory read_contact(const Node& node, std::size_t n_particles) {
  cloth::BodyContactEffect::Memory contact;
  contact.anchor = io::read_flat_points(node.at("anchor"));
  for (int has : io::read_integers(node.at("has_anchor")))
    contact.has_anchor.push_back(static_cast<char>(has != 0));
  contact.push = node.at("push").number();
  if (contact.anchor.size() != contact.has_anchor.size() ||
      (!contact.anchor.empty() && contact.anchor.size() != n_particles))
    node.fail("checkpoint.damaged"_id, "does not belong to this garment");
  return contact;
}

Json state_json(const DrapeState& s) {
  Json j;
  j["phase"] = PHASES[static_cast<int>(s.phase)];
  j["step"] = s.step();
  j["disturbed"] = s.disturbed;
  s.body.write(j);
  s.stepper.write(j);
  j["contact"] = contact_json(s.contact);
  s.resolver.write(j);
  s.supports.write(j);
  s.sew.write(j);
  s.inflate.write(j);
  s.settle.write(j);
  if (s.move.frame > 0)
    j["motion"] = s.move.to_json();
  j["fit"] = s.fit.to_json();
  return j;
}

DrapeState read_state(const Node& node, std::size_t n_particles) {
  DrapeState s;
  const std::string phase = node.at("phase").string();
  const auto found = std::find(std::begin(PHASES), std::end(PHASES), phase);
  if (found == std::end(PHASES))
    node.at("phase").fail("checkpoint.damaged"_id, "is not a phase of a drape");
  s.phase = static_cast<DrapePhase>(found - std::begin(PHASES));
  s.disturbed = node.at("disturbed").boolean();
  s.body = CollisionBody::State::read(node);
  s.stepper = StepController::State::read(node);
  s.contact = read_contact(node.at("contact"), n_particles);
  s.resolver = PenetrationResolver::State::read(node);
  s.supports = TemporarySupports::State::read(node, n_particles);
  s.sew = SewPhase::State::read(node);
  s.inflate = InflatePhase::State::read(node);
  s.settle = SettlePhase::State::read(node, n_particles);
  s.sew.step = s.settle.step = node.at("step").integer();
  if (s.phase == DrapePhase::SEW && static_cast<int>(s.sew.gaps.size()) != s.sew.step)
    node.at("gaps").fail("checkpoint.damaged"_id, "must have one number for each step");
  if (s.phase == DrapePhase::SETTLE && s.settle.start_height.size() != n_particles)
    node.at("start_height").fail("checkpoint.damaged"_id, "does not belong to this garment");
  if (node.has("motion") || s.phase == DrapePhase::MOVE)
    s.move = MovePhase::State::read(node.at("motion"));
  if (node.has("fit"))
    s.fit = FitMonitor::State::read(node.at("fit")); // older ones have none
  if (s.phase == DrapePhase::MOVE && s.move.velocity.size() != n_particles)
    node.at("motion")
        .at("velocity")
        .fail("checkpoint.damaged"_id, "does not belong to this garment");
  return s;
}

Json bounds_json(const FitBounds& b) {
  return {{"slip_m", b.slip_m}, {"strain_p99", b.strain_p99}, {"tight", b.tight}};
}

FitBounds read_bounds(const Node& node) {
  return {.slip_m = node.at("slip_m").number(),
          .strain_p99 = node.at("strain_p99").number(),
          .tight = node.at("tight").boolean()};
}

Json progress_json(const DrapeReport& r) {
  Json j;
  j["steps"] = r.steps;
  j["simulated_s"] = r.simulated_s;
  j["wall_s"] = r.wall_s;
  j["effects"] = Json::array();
  for (const EffectReport& e : r.effects)
    j["effects"].push_back({{"name", e.name},
                            {"active", e.active},
                            {"why", e.why},
                            {"calls", e.calls},
                            {"wall_s", e.wall_s}});
  j["phases"] = Json::array();
  for (const auto& [name, wall_s] : r.phases)
    j["phases"].push_back({{"name", name}, {"wall_s", wall_s}});
  j["repairs"] = r.repairs;
  return j;
}

DrapeSettings read_settings(const Node& node) {
  DrapeSettings s;
  for (const std::string& name : node.keys()) {
    if (name == "accuracy")
      s.accuracy = node.at(name).string();
    else if (name == "effects")
      s.effects = node.at(name).string();
    else if (name != "extra_steps")
      set_knob(s, name, node.at(name));
  }
  if (!node.has("extra_steps"))
    return s; // written before there was one: the limit holds
  const Node extra = node.at("extra_steps");
  s.extra_steps = extra.integer();
  if (s.extra_steps < 0 || s.extra_steps > MOST_EXTRA_STEPS)
    extra.fail("checkpoint.damaged"_id, "is out of range");
  return s;
}

DrapeReport read_progress(const Node& node, const Node& settings) {
  DrapeReport r;
  r.steps = node.at("steps").integer();
  r.simulated_s = node.at("simulated_s").number();
  r.wall_s = node.at("wall_s").number();
  for (std::size_t k = 0; k < node.at("effects").size(); ++k) {
    const Node e = node.at("effects").at(k);
    r.effects.push_back({e.at("name").string(), e.at("active").boolean(), e.at("why").string(),
                         e.at("calls").integer(), e.at("wall_s").number()});
  }
  for (std::size_t k = 0; k < node.at("phases").size(); ++k)
    r.phases.emplace_back(node.at("phases").at(k).at("name").string(),
                          node.at("phases").at(k).at("wall_s").number());
  r.repairs = io::read_strings(node.at("repairs"));
  r.settings = read_settings(settings);
  return r;
}

/// Into a document: what garment_text() says of it, and where its panels were placed.
void put_garment(Json& document, const Garment& garment) {
  GarmentText text = garment_text(garment, "", "drape");
  document["garment"] = std::move(text.document);
  document["mesh"] = std::move(text.mesh);
  document["placed"] = io::flat_points(garment.panels.placed);
}

Garment take_garment(const Node& node) {
  Garment garment = garment_from(node.at("garment"),
                                 io::parse_obj(node.at("mesh").string(), node.file()), node.file());
  garment.panels.placed = io::read_flat_points(node.at("placed"));
  if (!garment.panels.placed.empty() &&
      garment.panels.placed.size() != garment.panels.pattern.size())
    node.at("placed").fail("checkpoint.damaged"_id, "does not belong to this garment");
  return garment;
}

Json layers_json(const LayersProgress& l) {
  Json j = {{"settings", settings_json(l.settings)},
            {"alone", l.alone},
            {"alone_s", l.alone_s},
            {"repairs", l.repairs},
            {"garments", Json::array()}};
  for (const Garment& g : l.garments) {
    j["garments"].push_back(Json::object());
    put_garment(j["garments"].back(), g);
  }
  return j;
}

LayersProgress read_layers(const Node& node, std::size_t n_particles) {
  LayersProgress l;
  l.settings = read_settings(node.at("settings"));
  const Node garments = node.at("garments");
  std::size_t n = 0;
  for (std::size_t k = 0; k < garments.size(); ++k) {
    l.garments.push_back(take_garment(garments.at(k)));
    n += l.garments.back().position.size();
  }
  const int alone = node.at("alone").integer();
  if (l.garments.empty() || alone < 0 || static_cast<std::size_t>(alone) > l.garments.size())
    node.at("alone").fail("checkpoint.damaged"_id, "is not the index of one of the garments");
  l.alone = static_cast<std::size_t>(alone);
  if (l.alone == l.garments.size() && n != n_particles)
    garments.fail("checkpoint.damaged"_id, "do not match the garments of the checkpoint");
  l.alone_s = node.at("alone_s").number();
  l.repairs = io::read_strings(node.at("repairs"));
  return l;
}

Json levels_json(const LevelsProgress& l) {
  return {{"settings", settings_json(l.settings)}, {"rung", l.rung},
          {"on_given_mesh", l.on_given_mesh},      {"sprung", l.sprung},
          {"before", progress_json(l.before)},     {"meshes", mesh_levels_json(l.before.levels)}};
}

LevelsProgress read_levels(const Node& node) {
  LevelsProgress l;
  l.settings = read_settings(node.at("settings"));
  l.rung = node.at("rung").string();
  const std::vector<std::string> names = accuracy_names();
  if (!l.rung.empty() && std::find(names.begin(), names.end(), l.rung) == names.end())
    node.at("rung").fail("checkpoint.damaged"_id, "is no preset");
  l.on_given_mesh = node.at("on_given_mesh").boolean();
  l.sprung = node.has("sprung") && node.at("sprung").boolean(); // older ones do not name it
  l.before = read_progress(node.at("before"), node.at("settings"));
  MeshLevels& levels = l.before.levels;
  const Node meshes = node.at("meshes");
  levels.meshes = meshes.at("meshes").integer();
  levels.why = meshes.string("why", "");
  if (!meshes.has("coarse"))
    return l;
  const Node coarse = meshes.at("coarse");
  levels.coarse_edge_m = coarse.at("edge_m").number();
  levels.coarse_particles = coarse.at("particles").integer();
  levels.coarse_residual_force_ratio = coarse.at("residual_force_ratio").number();
  return l;
}

} // namespace

int DrapeState::step() const {
  return phase == DrapePhase::SEW ? sew.step : settle.step;
}

void write_checkpoint(const std::string& path, const DrapeCheckpoint& c) {
  Json document = io::new_document("checkpoint", CHECKPOINT_VERSION, "drape");
  document["every_steps"] = c.every_steps;
  document["has_body"] = c.has_body;
  document["bounds"] = bounds_json(c.bounds);
  document["settings"] = settings_json(c.report.settings);
  document["progress"] = progress_json(c.report);
  document["state"] = state_json(c.state);
  if (c.motion)
    document["motion"] = {{"sha256", c.motion->sha256}, {"fps", c.motion->fps}};
  if (c.layers)
    document["layers"] = layers_json(*c.layers);
  if (c.levels)
    document["levels"] = levels_json(*c.levels);
  put_garment(document, c.garment);
  io::write_json(path, document);
}

bool is_checkpoint(const std::string& path) {
  const Json document = io::read_json(path);
  return document.is_object() && document.contains("format") && document["format"] == "checkpoint";
}

DrapeCheckpoint read_checkpoint(const std::string& path) {
  const Json document = io::read_document(path, "checkpoint", CHECKPOINT_VERSION);
  const Node root(document, path);
  DrapeCheckpoint c;
  c.file = path;
  c.every_steps = root.at("every_steps").integer();
  if (c.every_steps < 1)
    root.at("every_steps").fail("json.out-of-range"_id, "expected a number above zero");
  c.has_body = root.at("has_body").boolean();
  if (root.has("bounds"))
    c.bounds = read_bounds(root.at("bounds")); // older ones: none
  c.garment = take_garment(root);
  c.report = read_progress(root.at("progress"), root.at("settings"));
  c.state = read_state(root.at("state"), c.garment.position.size());
  if (root.has("motion")) {
    c.motion = {root.at("motion").at("sha256").string(), root.at("motion").at("fps").number()};
    if (!(c.motion->fps > 0))
      root.at("motion").at("fps").fail("json.out-of-range"_id, "expected a number above zero");
  } else if (c.state.move.frame > 0) {
    root.at("state").at("motion").fail("checkpoint.damaged"_id,
                                       "belongs to a motion that the checkpoint does not name");
  }
  if (root.has("layers"))
    c.layers = read_layers(root.at("layers"), c.garment.position.size());
  if (root.has("levels"))
    c.levels = read_levels(root.at("levels"));
  return c;
}

void DrapeCheckpoint::check_moves(const BodyMoves* moves) const {
  if (motion.has_value() == (moves != nullptr) && (!moves || state.move.frame <= moves->n_frames))
    return;
  throw input_error("checkpoint.other-run"_id, file, "",
                    motion ? "was written with another motion" : "was written without --motion",
                    "give the same --motion as before");
}

void DrapeCheckpoint::check_body(const body::Body* body, const std::string& body_sha256) const {
  const std::string& began_on = layers ? layers->garments.back().body_sha256 : garment.body_sha256;
  const bool same =
      has_body == (body != nullptr) && (body_sha256.empty() || body_sha256 == began_on);
  if (same)
    return;
  std::string fact = "this drape began without a body";
  if (has_body)
    fact =
        body ? "the body is not the one on which this drape began" : "this drape began on a body";
  throw input_error("checkpoint.other-run"_id, file, "", fact,
                    has_body ? "give the same --body as before" : "leave --body out");
}

} // namespace sloper::garment

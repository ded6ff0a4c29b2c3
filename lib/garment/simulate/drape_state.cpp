#include <garment/body_model/covered_skin.hpp>
#include <garment/garment_json.hpp>
#include <garment/scene/scene.hpp>
#include <garment/simulate/drape_state.hpp>

#include <base/error.hpp>
#include <io/json.hpp>

#include <algorithm>

namespace sloper::garment {

namespace {

using io::Json;
using io::Node;

constexpr const char* PHASES[] = {"start", "sew", "inflate", "settle", "move"};

Json flat(const std::vector<Vec3>& list) {
  Json out = Json::array();
  for (const Vec3& p : list)
    for (int k = 0; k < 3; ++k) out.push_back(p[k]);
  return out;
}

std::vector<Vec3> read_flat(const Node& node) {
  if (node.size() % 3 != 0) node.fail("is no list of points");
  std::vector<Vec3> list(node.size() / 3);
  for (std::size_t i = 0; i < node.size(); ++i) list[i / 3][static_cast<int>(i % 3)] = node.at(i).number();
  return list;
}

std::vector<double> read_numbers(const Node& node) {
  std::vector<double> list(node.size());
  for (std::size_t i = 0; i < list.size(); ++i) list[i] = node.at(i).number();
  return list;
}

std::vector<int> read_integers(const Node& node) {
  std::vector<int> list(node.size());
  for (std::size_t i = 0; i < list.size(); ++i) list[i] = node.at(i).integer();
  return list;
}

std::vector<std::string> read_strings(const Node& node) {
  std::vector<std::string> list(node.size());
  for (std::size_t i = 0; i < list.size(); ++i) list[i] = node.at(i).string();
  return list;
}

Json step_json(const cloth::StepResult& s) {
  return {{"cg_iterations", s.cg.iterations},
          {"cg_residual", s.cg.residual},
          {"largest_move_m", s.largest_move_m},
          {"halvings", s.halvings},
          {"residual_force_ratio", s.residual_force_ratio},
          {"residual_force_ratio_max", s.residual_force_ratio_max},
          {"held", s.held}};
}

cloth::StepResult read_step(const Node& node) {
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

Json motion_json(const MotionState& m) {
  return {{"frame", m.frame},           {"over", m.over},          {"velocity", flat(m.velocity)},     {"parts", m.parts},
          {"forced", m.forced},         {"noted", m.noted},        {"forced_frames", m.forced_frames}, {"asleep_frames", m.asleep_frames},
          {"bad_frames", m.bad_frames}, {"most", m.most},          {"largest_way_m", m.largest_way_m}, {"simulated_s", m.simulated_s},
          {"wall_s", m.wall_s},         {"elapsed_s", m.elapsed_s}};
}

MotionState read_motion(const Node& node) {
  MotionState m;
  if (node.at("frame").integer() < 1) node.at("frame").fail("expected a number above zero");
  m.frame = static_cast<std::size_t>(node.at("frame").integer());
  m.over = node.at("over").boolean();
  m.velocity = read_flat(node.at("velocity"));
  m.parts = node.at("parts").integer(), m.forced = node.at("forced").integer(), m.noted = node.at("noted").integer();
  m.forced_frames = node.at("forced_frames").integer();
  if (node.has("asleep_frames")) m.asleep_frames = node.at("asleep_frames").integer(); // older ones have none
  for (std::size_t i = 0; i < 3; ++i) m.bad_frames[i] = node.at("bad_frames").at(i).integer(), m.most[i] = node.at("most").at(i).integer();
  m.largest_way_m = node.at("largest_way_m").number(), m.simulated_s = node.at("simulated_s").number();
  m.wall_s = node.at("wall_s").number(), m.elapsed_s = node.at("elapsed_s").number();
  return m;
}

Json state_json(const DrapeState& s) {
  Json j;
  j["phase"] = PHASES[static_cast<int>(s.phase)];
  j["step"] = s.step;
  j["covered"] = s.covered, j["whole_skin"] = s.whole_skin, j["shrunk"] = s.shrunk, j["disturbed"] = s.disturbed;
  j["arms_aside"] = s.arms_aside;
  j["scale"] = s.scale;
  j["skin"] = flat(s.skin);
  j["last"] = step_json(s.last);
  j["last_h"] = s.last_h;
  j["contact"] = {
      {"anchor", flat(s.contact.anchor)}, {"has_anchor", std::vector<int>(s.contact.has_anchor.begin(), s.contact.has_anchor.end())}, {"push", s.contact.push}};
  j["cg_iterations"] = s.cg_iterations;
  j["solves"] = s.solves;
  j["rejected"] = s.rejected;
  j["pull"] = s.pull, j["pull_changed"] = s.pull_changed, j["gaps"] = s.gaps;
  j["latest"] = s.latest, j["farthest"] = s.farthest, j["held"] = flat(s.held), j["tucks"] = s.tucks;
  j["h"] = s.h;
  j["calm"] = s.calm, j["unmoved"] = s.unmoved, j["pushed"] = s.pushed, j["best_at"] = s.best_at, j["untanglings"] = s.untanglings, j["partings"] = s.partings;
  if (s.best < std::numeric_limits<double>::infinity()) j["best"] = s.best;
  j["start_height"] = s.start_height;
  if (s.thawed_at) j["thawed_at"] = *s.thawed_at;
  j["looked_at"] = s.looked_at, j["looked_from"] = flat(s.looked_from);
  j["free_steps"] = s.free_steps, j["velocity"] = flat(s.velocity);
  if (s.motion.frame > 0) j["motion"] = motion_json(s.motion);
  return j;
}

DrapeState read_state(const Node& node, std::size_t n_particles) {
  DrapeState s;
  const std::string phase = node.at("phase").string();
  const auto found = std::find(std::begin(PHASES), std::end(PHASES), phase);
  if (found == std::end(PHASES)) node.at("phase").fail("is no phase of a drape");
  s.phase = static_cast<DrapePhase>(found - std::begin(PHASES));
  s.step = node.at("step").integer();
  const int covered = node.has("covered")           ? node.at("covered").integer()
                      : node.at("mitten").boolean() ? static_cast<int>(CoveredSkin::HANDS)
                                                    : 0; // older ones: hands alone
  if (covered < 0 || covered > static_cast<int>(CoveredSkin::HANDS | CoveredSkin::FEET)) node.at("covered").fail("names no ends of limbs");
  s.covered = static_cast<unsigned>(covered);
  s.whole_skin = node.has("whole_skin") && node.at("whole_skin").boolean(), s.shrunk = node.at("shrunk").boolean();
  s.disturbed = node.at("disturbed").boolean();
  s.arms_aside = node.has("arms_aside") && node.at("arms_aside").boolean();
  s.scale = node.at("scale").number();
  s.skin = read_flat(node.at("skin"));
  s.last = read_step(node.at("last"));
  s.last_h = node.at("last_h").number();
  const Node contact = node.at("contact");
  s.contact.anchor = read_flat(contact.at("anchor"));
  for (int has : read_integers(contact.at("has_anchor"))) s.contact.has_anchor.push_back(static_cast<char>(has != 0));
  s.contact.push = contact.at("push").number();
  if (s.contact.anchor.size() != s.contact.has_anchor.size() || (!s.contact.anchor.empty() && s.contact.anchor.size() != n_particles))
    contact.fail("does not belong to this garment");
  s.cg_iterations = read_integers(node.at("cg_iterations"));
  s.solves = node.has("solves") ? node.at("solves").integer() : static_cast<int>(s.cg_iterations.size()); // older ones: one a step
  s.rejected = read_strings(node.at("rejected"));
  s.pull = node.at("pull").number(), s.pull_changed = node.at("pull_changed").integer(), s.gaps = read_numbers(node.at("gaps"));
  if (s.phase == DrapePhase::SEW && static_cast<int>(s.gaps.size()) != s.step) node.at("gaps").fail("is not one number for each step");
  s.latest = node.at("latest").number(), s.farthest = node.at("farthest").number();
  if (node.has("held")) s.held = read_flat(node.at("held"));
  if (node.has("tucks")) s.tucks = read_integers(node.at("tucks"));
  for (int i : s.tucks)
    if (i < 0 || static_cast<std::size_t>(i) >= n_particles) node.at("tucks").fail("does not belong to this garment");
  s.h = node.at("h").number();
  s.calm = node.at("calm").integer(), s.pushed = node.at("pushed").integer();
  s.best_at = node.at("best_at").integer(), s.untanglings = node.at("untanglings").integer(), s.partings = node.at("partings").integer();
  if (node.has("unmoved")) s.unmoved = node.at("unmoved").integer();
  if (node.has("best")) s.best = node.at("best").number();
  s.start_height = read_numbers(node.at("start_height"));
  if (node.has("thawed_at")) s.thawed_at = node.at("thawed_at").number();
  if (node.has("looked_at")) { // older ones: from here on
    s.looked_at = node.at("looked_at").integer(), s.looked_from = read_flat(node.at("looked_from"));
    s.free_steps = node.at("free_steps").integer(), s.velocity = read_flat(node.at("velocity"));
    for (const std::vector<Vec3>* of_particles : {&s.looked_from, &s.velocity})
      if (!of_particles->empty() && of_particles->size() != n_particles) node.at("looked_from").fail("does not belong to this garment");
  }
  if (s.phase == DrapePhase::SETTLE && s.start_height.size() != n_particles) node.at("start_height").fail("does not belong to this garment");
  if (node.has("motion") || s.phase == DrapePhase::MOVE) s.motion = read_motion(node.at("motion"));
  if (s.phase == DrapePhase::MOVE && s.motion.velocity.size() != n_particles) node.at("motion").at("velocity").fail("does not belong to this garment");
  return s;
}

Json progress_json(const DrapeReport& r) {
  Json j;
  j["steps"] = r.steps;
  j["simulated_s"] = r.simulated_s;
  j["wall_s"] = r.wall_s;
  j["effects"] = Json::array();
  for (const EffectReport& e : r.effects)
    j["effects"].push_back({{"name", e.name}, {"active", e.active}, {"why", e.why}, {"calls", e.calls}, {"wall_s", e.wall_s}});
  j["phases"] = Json::array();
  for (const auto& [name, wall_s] : r.phases) j["phases"].push_back({{"name", name}, {"wall_s", wall_s}});
  j["repairs"] = r.repairs;
  return j;
}

DrapeSettings read_settings(const Node& node) {
  DrapeSettings s;
  for (const std::string& name : node.keys())
    if (name == "accuracy") s.accuracy = node.at(name).string();
    else if (name == "effects") s.effects = node.at(name).string();
    else set_knob(s, name, node.at(name));
  return s;
}

DrapeReport read_progress(const Node& node, const Node& settings) {
  DrapeReport r;
  r.steps = node.at("steps").integer();
  r.simulated_s = node.at("simulated_s").number();
  r.wall_s = node.at("wall_s").number();
  for (std::size_t k = 0; k < node.at("effects").size(); ++k) {
    const Node e = node.at("effects").at(k);
    r.effects.push_back({e.at("name").string(), e.at("active").boolean(), e.at("why").string(), e.at("calls").integer(), e.at("wall_s").number()});
  }
  for (std::size_t k = 0; k < node.at("phases").size(); ++k)
    r.phases.emplace_back(node.at("phases").at(k).at("name").string(), node.at("phases").at(k).at("wall_s").number());
  r.repairs = read_strings(node.at("repairs"));
  r.settings = read_settings(settings);
  return r;
}

/// Into a document: what garment_text() says of it, and where its panels were placed.
void put_garment(Json& document, const Garment& garment) {
  GarmentText text = garment_text(garment, "", "drape");
  document["garment"] = std::move(text.document);
  document["mesh"] = std::move(text.mesh);
  document["placed"] = flat(garment.panels.placed);
}

Garment take_garment(const Node& node) {
  Garment garment = garment_from(node.at("garment"), io::parse_obj(node.at("mesh").string(), node.file()), node.file());
  garment.panels.placed = read_flat(node.at("placed"));
  if (!garment.panels.placed.empty() && garment.panels.placed.size() != garment.panels.pattern.size())
    node.at("placed").fail("does not belong to this garment");
  return garment;
}

Json layers_json(const LayersProgress& l) {
  Json j = {{"settings", settings_json(l.settings)}, {"alone", l.alone}, {"alone_s", l.alone_s}, {"repairs", l.repairs}, {"garments", Json::array()}};
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
  if (l.garments.empty() || alone < 0 || static_cast<std::size_t>(alone) > l.garments.size()) node.at("alone").fail("is none of the garments");
  l.alone = static_cast<std::size_t>(alone);
  if (l.alone == l.garments.size() && n != n_particles) garments.fail("are not the garments that are draped together");
  l.alone_s = node.at("alone_s").number();
  l.repairs = read_strings(node.at("repairs"));
  return l;
}

} // namespace

void write_checkpoint(const std::string& path, const DrapeCheckpoint& c) {
  Json document = io::new_document("checkpoint", CHECKPOINT_VERSION, "drape");
  document["every_steps"] = c.every_steps;
  document["has_body"] = c.has_body;
  document["settings"] = settings_json(c.report.settings);
  document["progress"] = progress_json(c.report);
  document["state"] = state_json(c.state);
  if (c.motion) document["motion"] = {{"sha256", c.motion->sha256}, {"fps", c.motion->fps}};
  if (c.layers) document["layers"] = layers_json(*c.layers);
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
  if (c.every_steps < 1) root.at("every_steps").fail("expected a number above zero");
  c.has_body = root.at("has_body").boolean();
  c.garment = take_garment(root);
  c.report = read_progress(root.at("progress"), root.at("settings"));
  c.state = read_state(root.at("state"), c.garment.position.size());
  if (root.has("motion")) {
    c.motion = {root.at("motion").at("sha256").string(), root.at("motion").at("fps").number()};
    if (!(c.motion->fps > 0)) root.at("motion").at("fps").fail("expected a number above zero");
  } else if (c.state.motion.frame > 0) {
    root.at("state").at("motion").fail("is of a motion that the checkpoint does not name");
  }
  if (root.has("layers")) c.layers = read_layers(root.at("layers"), c.garment.position.size());
  return c;
}

} // namespace sloper::garment

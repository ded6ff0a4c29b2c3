#include <garment/drape_state.hpp>
#include <garment/garment_json.hpp>
#include <garment/scene.hpp>

#include <base/error.hpp>
#include <io/json.hpp>

#include <algorithm>

namespace sloper::garment {

namespace {

using io::Json;
using io::Node;

constexpr const char* PHASES[] = {"start", "sew", "inflate", "settle"};

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

Json state_json(const DrapeState& s) {
  Json j;
  j["phase"] = PHASES[static_cast<int>(s.phase)];
  j["step"] = s.step;
  j["mitten"] = s.mitten, j["shrunk"] = s.shrunk, j["disturbed"] = s.disturbed;
  j["scale"] = s.scale;
  j["skin"] = flat(s.skin);
  j["last"] = step_json(s.last);
  j["last_h"] = s.last_h;
  j["contact"] = {
      {"anchor", flat(s.contact.anchor)}, {"has_anchor", std::vector<int>(s.contact.has_anchor.begin(), s.contact.has_anchor.end())}, {"push", s.contact.push}};
  j["cg_iterations"] = s.cg_iterations;
  j["rejected"] = s.rejected;
  j["pull"] = s.pull, j["pull_changed"] = s.pull_changed, j["gaps"] = s.gaps;
  j["latest"] = s.latest, j["farthest"] = s.farthest;
  j["h"] = s.h;
  j["calm"] = s.calm, j["unmoved"] = s.unmoved, j["pushed"] = s.pushed, j["best_at"] = s.best_at, j["untanglings"] = s.untanglings, j["partings"] = s.partings;
  if (s.best < std::numeric_limits<double>::infinity()) j["best"] = s.best;
  j["start_height"] = s.start_height;
  return j;
}

DrapeState read_state(const Node& node, std::size_t n_particles) {
  DrapeState s;
  const std::string phase = node.at("phase").string();
  const auto found = std::find(std::begin(PHASES), std::end(PHASES), phase);
  if (found == std::end(PHASES)) node.at("phase").fail("is no phase of a drape");
  s.phase = static_cast<DrapePhase>(found - std::begin(PHASES));
  s.step = node.at("step").integer();
  s.mitten = node.at("mitten").boolean(), s.shrunk = node.at("shrunk").boolean(), s.disturbed = node.at("disturbed").boolean();
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
  s.rejected = read_strings(node.at("rejected"));
  s.pull = node.at("pull").number(), s.pull_changed = node.at("pull_changed").integer(), s.gaps = read_numbers(node.at("gaps"));
  if (s.phase == DrapePhase::SEW && static_cast<int>(s.gaps.size()) != s.step) node.at("gaps").fail("is not one number for each step");
  s.latest = node.at("latest").number(), s.farthest = node.at("farthest").number();
  s.h = node.at("h").number();
  s.calm = node.at("calm").integer(), s.pushed = node.at("pushed").integer();
  s.best_at = node.at("best_at").integer(), s.untanglings = node.at("untanglings").integer(), s.partings = node.at("partings").integer();
  if (node.has("unmoved")) s.unmoved = node.at("unmoved").integer();
  if (node.has("best")) s.best = node.at("best").number();
  s.start_height = read_numbers(node.at("start_height"));
  if (s.phase == DrapePhase::SETTLE && s.start_height.size() != n_particles) node.at("start_height").fail("does not belong to this garment");
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
  for (const std::string& name : settings.keys())
    if (name == "accuracy") r.settings.accuracy = settings.at(name).string();
    else if (name == "effects") r.settings.effects = settings.at(name).string();
    else set_knob(r.settings, name, settings.at(name));
  return r;
}

} // namespace

void write_checkpoint(const std::string& path, const DrapeCheckpoint& c) {
  GarmentText garment = garment_text(c.garment, "", "drape");
  Json document = io::new_document("checkpoint", CHECKPOINT_VERSION, "drape");
  document["every_steps"] = c.every_steps;
  document["has_body"] = c.has_body;
  document["settings"] = settings_json(c.report.settings);
  document["progress"] = progress_json(c.report);
  document["state"] = state_json(c.state);
  document["garment"] = std::move(garment.document);
  document["mesh"] = std::move(garment.mesh);
  document["placed"] = flat(c.garment.panels.placed);
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
  c.every_steps = root.at("every_steps").integer();
  if (c.every_steps < 1) root.at("every_steps").fail("expected a number above zero");
  c.has_body = root.at("has_body").boolean();
  c.garment = garment_from(root.at("garment"), io::parse_obj(root.at("mesh").string(), path), path);
  c.garment.panels.placed = read_flat(root.at("placed"));
  if (!c.garment.panels.placed.empty() && c.garment.panels.placed.size() != c.garment.panels.pattern.size())
    root.at("placed").fail("does not belong to this garment");
  c.report = read_progress(root.at("progress"), root.at("settings"));
  c.state = read_state(root.at("state"), c.garment.position.size());
  return c;
}

} // namespace sloper::garment

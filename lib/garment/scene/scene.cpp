#include <garment/scene/panel_runs.hpp>
#include <garment/scene/preset_table.hpp>
#include <garment/scene/scene_effects_json.hpp>
#include <sloper/base/error.hpp>
#include <sloper/base/number_text.hpp>
#include <sloper/garment/material_json.hpp>
#include <sloper/garment/materials.hpp>
#include <sloper/garment/scene/scene.hpp>
#include <sloper/io/json.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>

namespace sloper::garment {

namespace {

/// One number that decides a drape: its name, range, and place in the settings.
struct Knob {
  const char* name;
  double low, high;
  double DrapeSettings::*real;
  int DrapeSettings::*whole;
};

const std::vector<Knob>& knobs() {
  using S = DrapeSettings;
  static const std::vector<Knob> table = {
      {"time_step_s", 1e-4, 1, &S::time_step_s, nullptr},
      {"cg_tolerance", 1e-12, 0.5, &S::cg_tolerance, nullptr},
      {"cg_max_iterations", 1, 100000, nullptr, &S::cg_max_iterations},
      {"newton_iterations", 1, 1000, nullptr, &S::newton_iterations},
      {"motion_step_s", 1e-4, 1, &S::motion_step_s, nullptr},
      {"solver", 0, 2, nullptr, &S::solver},
      {"contact_level", 1, 4, nullptr, &S::contact_level},
      {"contact_gap_m", 1e-4, 0.02, &S::contact_gap_m, nullptr},
      {"skin_tolerance_m", 0, 0.005, &S::skin_tolerance_m, nullptr},
      {"self_thickness_m", 1e-4, 0.02, &S::self_thickness_m, nullptr},
      {"settle_speed_m_s", 1e-6, 1, &S::settle_speed_m_s, nullptr},
      {"settle_force_ratio", 1e-6, 10, &S::settle_force_ratio, nullptr},
      {"gravity_m_s2", 0, 100, &S::gravity_m_s2, nullptr},
      {"max_steps", 1, 1e6, nullptr, &S::max_steps},
      {"levels", 1, 2, nullptr, &S::levels},
      {"max_seconds", 0, 1e6, &S::max_seconds, nullptr},
  };
  return table;
}

void mention(const io::Node& panel, std::vector<Scene::PanelMention>& mentions) {
  mentions.push_back({panel.string(), panel.file(), panel.pointer()});
}

/// The panels that a scene's effects and interfacing name.
std::vector<Scene::PanelMention> panels_mentioned(const io::Node& root) {
  std::vector<Scene::PanelMention> mentions;
  for (const char* key : {"pins", "bands", "attachments", "shrink", "creases", "roll_lines",
                          "weights", "closures", "interfacing"}) {
    if (!root.has(key))
      continue;
    const io::Node list = root.at(key);
    for (std::size_t k = 0; k < list.size(); ++k) {
      const io::Node item = list.at(k);
      if (!item.string("panel", "").empty()) // shrink without one is of all panels
        mention(item.at("panel"), mentions);
      if (item.has("with"))
        mention(item.at("with").at("panel"), mentions);
      if (item.has("panels"))
        for (std::size_t p = 0; p < item.at("panels").size(); ++p)
          mention(item.at("panels").at(p), mentions);
    }
  }
  return mentions;
}

} // namespace

Scene read_scene(const std::string& path) {
  const io::Json document = io::read_document(path, "scene", SCENE_VERSION);
  const io::Node root(document, path);
  root.allow_only({"format",   "version",     "generator",   "length_unit", "body",       "panels",
                   "accuracy", "effects",     "materials",   "settings",    "membrane",   "bending",
                   "pins",     "bands",       "attachments", "shrink",      "creases",    "weights",
                   "wind_m_s", "pressure_pa", "closures",    "roll_lines",  "interfacing"});
  Scene scene;
  if (root.has("body"))
    scene.body = io::path_beside(path, root.at("body").string());
  if (root.has("panels"))
    scene.panels = io::path_beside(path, root.at("panels").string());
  scene.accuracy = root.string("accuracy", "");
  if (root.has("effects")) {
    const io::Node effects = root.at("effects");
    if (effects.is_string())
      scene.effects = effects.string();
    else
      for (std::size_t i = 0; i < effects.size(); ++i)
        scene.effects.append(i ? "," : "").append(effects.at(i).string());
  }
  scene.extras = read_scene_effects(root);
  if (root.has("materials"))
    for (const std::string& name : root.at("materials").keys())
      scene.materials[name == "default" ? "" : name] = read_material(root.at("materials").at(name));
  if (root.has("interfacing"))
    for (std::size_t k = 0; k < root.at("interfacing").size(); ++k) {
      const io::Node item = root.at("interfacing").at(k);
      item.allow_only({"panels", "material", "bond", "side"});
      if (item.at("panels").size() == 0)
        item.at("panels").fail("scene.no-panels"_id, "names no panel",
                               "name the panels that it goes on, or leave it out");
      Scene::Interfacing interfacing;
      for (std::size_t p = 0; p < item.at("panels").size(); ++p)
        interfacing.panels.push_back(item.at("panels").at(p).string());
      interfacing.layer = read_cloth_layer(item);
      scene.interfacing.push_back(std::move(interfacing));
    }
  if (root.has("settings"))
    for (const std::string& name : root.at("settings").keys()) {
      const io::Node value = root.at("settings").at(name);
      DrapeSettings probe;
      set_knob(probe, name, value);
      scene.settings.emplace_back(name, value.number());
    }
  scene.mentions = panels_mentioned(root);
  return scene;
}

void apply_scene(const Scene& scene, Garment& garment) {
  for (const Scene::PanelMention& m : scene.mentions)
    panel_named(garment, m.panel, m.file, m.place); // or it is said that there is none
  for (const auto& [name, material] : scene.materials)
    garment.materials[name] = material;
  const SceneEffects& from = scene.extras;
  SceneEffects& to = garment.scene;
  if (!from.membrane.empty())
    to.membrane = from.membrane;
  if (!from.bending.empty())
    to.bending = from.bending;
  if (!from.pins.empty())
    to.pins = from.pins;
  if (!from.bands.empty())
    to.bands = from.bands;
  if (!from.attachments.empty())
    to.attachments = from.attachments;
  if (!from.shrink.empty())
    to.shrink = from.shrink;
  if (!from.creases.empty())
    to.creases = from.creases;
  if (!from.weights.empty())
    to.weights = from.weights;
  if (!from.closures.empty())
    to.closures = from.closures;
  if (from.air) {
    to.air = true;
    to.wind_m_s = from.wind_m_s;
  }
  if (from.pressure_pa != 0)
    to.pressure_pa = from.pressure_pa;
}

std::vector<Message> unused_materials(const Scene& scene, const std::string& path,
                                      const Garment& garment) {
  std::vector<std::string> used;
  std::string list;
  for (const pattern::PanelInfo& panel : garment.panels.panels) {
    if (panel.material.empty() || std::find(used.begin(), used.end(), panel.material) != used.end())
      continue;
    used.push_back(panel.material);
    list += (list.empty() ? "" : ", ") + panel.material;
  }
  std::vector<Message> out;
  for (const auto& [name, material] : scene.materials)
    if (!name.empty() && std::find(used.begin(), used.end(), name) == used.end())
      out.push_back(
          {"material.unused"_id, path + ": /materials/" + name + ": no panel is of this material" +
                                     did_you_mean(name, used) +
                                     (list.empty() ? "; panels name none, and are of \"default\""
                                                   : "; panels are of " + list)});
  return out;
}

void apply_interfacing(const Scene& scene, Garment& garment) {
  for (const Scene::Interfacing& interfacing : scene.interfacing)
    for (const std::string& name : interfacing.panels) {
      const std::string wanted = panel_named(garment, name).name;
      for (pattern::PanelInfo& panel : garment.panels.panels) {
        if (panel.name != wanted)
          continue;
        const Material material =
            layered(material_of(garment, panel.material), {interfacing.layer});
        std::string key = material.name;
        const auto is_another = [&] { // two fabrics of one name
          const auto there = garment.materials.find(key);
          return there != garment.materials.end() &&
                 material_json(there->second) != material_json(material);
        };
        while (is_another())
          key += "'";
        panel.material = key;
        garment.materials[key] = material;
      }
    }
}

std::vector<std::string> accuracy_names() {
  std::vector<std::string> names;
  for (const Preset& p : PRESETS)
    names.emplace_back(p.name);
  return names;
}

DrapeSettings preset_settings(const std::string& accuracy) {
  DrapeSettings s;
  for (const Preset& p : PRESETS)
    if (accuracy == p.name) {
      s.accuracy = p.name;
      s.cg_tolerance = p.cg_tolerance;
      s.settle_force_ratio = p.settle_force_ratio;
      s.settle_speed_m_s = p.settle_speed_m_s;
      s.max_steps = p.max_steps;
      s.extra_steps = p.max_steps / 2;
      return s;
    }
  throw Error(ErrorKind::USAGE, "option.unknown-word"_id, "", "--accuracy",
              "\"" + accuracy + "\" is not known", "known are draft, standard, fine, reference");
}

std::vector<std::string> knob_names() {
  std::vector<std::string> names;
  for (const Knob& k : knobs())
    names.emplace_back(k.name);
  return names;
}

void set_knob(DrapeSettings& settings, const std::string& name, double value) {
  std::string names;
  std::vector<std::string> words;
  for (const Knob& k : knobs()) {
    if (name == k.name) {
      if (!(value >= k.low && value <= k.high))
        throw Error(ErrorKind::USAGE, "option.wrong-value"_id, "", name, "is out of range",
                    "give a value from " + range_text(k.low, k.high));
      if (k.real)
        settings.*k.real = value;
      else
        settings.*k.whole = static_cast<int>(value);
      if (k.whole == &DrapeSettings::max_steps)
        settings.extra_steps = 0;
      return;
    }
    words.emplace_back(k.name);
    names += (names.empty() ? "" : ", ") + words.back();
  }
  throw Error(ErrorKind::USAGE, "option.unknown-word"_id, "", name,
              "is not a setting" + did_you_mean(name, words), "settings are " + names);
}

void set_knob(DrapeSettings& settings, const std::string& name, const io::Node& value) {
  const double number = value.number();
  try {
    set_knob(settings, name, number);
  } catch (const Error& e) {
    value.fail(e.id(), e.what());
  }
}

void set_knob(DrapeSettings& settings, const std::string& assignment) {
  const auto equals = assignment.find('=');
  double value = 0;
  const char* end = assignment.data() + assignment.size();
  if (equals == std::string::npos)
    throw Error(ErrorKind::USAGE, "option.wrong-value"_id, "", "--set " + assignment,
                "is not KNOB=VALUE");
  if (const auto r = std::from_chars(assignment.data() + equals + 1, end, value);
      r.ec != std::errc() || r.ptr != end || !std::isfinite(value))
    throw Error(ErrorKind::USAGE, "option.wrong-value"_id, "", "--set " + assignment,
                "the value is not a number");
  set_knob(settings, assignment.substr(0, equals), value);
}

io::Json settings_json(const DrapeSettings& settings) {
  io::Json out;
  out["accuracy"] = settings.accuracy;
  out["effects"] = settings.effects;
  for (const Knob& k : knobs()) {
    if (k.real)
      out[k.name] = settings.*k.real;
    else
      out[k.name] = settings.*k.whole;
  }
  out["extra_steps"] = settings.extra_steps;
  return out;
}

} // namespace sloper::garment

#include <garment/scene/effect_registry.hpp>
#include <garment/scene/effects.hpp>
#include <sloper/base/error.hpp>
#include <sloper/cloth/bending_plates.hpp>
#include <sloper/garment/materials.hpp>
#include <sloper/garment/sewing.hpp>

#include <algorithm>
#include <sstream>

namespace sloper::garment {

/// Models of the same thing: only one of each takes part.
static std::vector<const char*> models_of(EffectModel model) {
  std::vector<const char*> names;
  for (const EffectSpec& spec : effect_registry())
    if (spec.model == model)
      names.push_back(spec.name);
  return names;
}

static EffectReport& named(std::vector<EffectReport>& effects, const std::string& name) {
  const auto found = std::find_if(effects.begin(), effects.end(),
                                  [&](const EffectReport& e) { return e.name == name; });
  if (found != effects.end())
    return *found;
  std::string names;
  std::vector<std::string> known;
  for (const EffectReport& e : effects) {
    known.push_back(e.name);
    names += (names.empty() ? "" : ", ") + e.name;
  }
  throw Error(ErrorKind::USAGE, "option.unknown-word"_id, "", "effect \"" + name + "\"",
              "is not known" + did_you_mean(name, known), "known are " + names);
}

/// One that is named takes the place of the others of its kind.
static void replace_others(std::vector<EffectReport>& effects, const std::string& name) {
  auto replace = [&](const auto& models) {
    if (std::find(std::begin(models), std::end(models), name) == std::end(models))
      return;
    for (const char* other : models)
      if (other != name && named(effects, other).active) {
        named(effects, other).active = false;
        named(effects, other).why = name + " takes its place";
      }
  };
  replace(models_of(EffectModel::STRETCH));
  replace(models_of(EffectModel::BENDING));
  if (name == "membrane" && named(effects, "shear").active) {
    named(effects, "shear").active = false;
    named(effects, "shear").why = "the finite elements carry shear";
  }
}

static void check_models(const std::vector<EffectReport>& effects) {
  auto only_one = [&](const auto& models, const char* of) {
    std::string both;
    int n = 0;
    for (const char* m : models)
      if (is_active(effects, m)) {
        ++n;
        both += (both.empty() ? "" : " and ") + std::string(m);
      }
    if (n > 1)
      throw Error(ErrorKind::USAGE, "scene.effects-conflict"_id, "", "effects",
                  both + " are models of the same " + of, "name one of them");
  };
  only_one(models_of(EffectModel::STRETCH), "stretch");
  only_one(models_of(EffectModel::BENDING), "bending");
  if (is_active(effects, "membrane") && is_active(effects, "shear"))
    throw Error(ErrorKind::USAGE, "scene.effects-conflict"_id, "", "effects",
                "membrane and shear both carry shear", "leave shear out");
}

static EffectFacts facts_of(const Garment& garment, const body::Body* body,
                            const DrapeSettings& settings) {
  const SceneEffects& scene = garment.scene;
  const std::size_t open = garment.particle_of.empty() ? 1 : open_stitches(garment).size();
  EffectFacts facts{.garment = garment,
                    .body = body,
                    .settings = settings,
                    .scene = scene,
                    .has_open_seams = open > 0,
                    .touches_body = body && !body->skin.triangles.empty(),
                    .has_shear = false,
                    .has_bending = false,
                    .has_damping = false,
                    .has_friction = false,
                    .is_fem = scene.membrane == "fem",
                    .is_triangles = false,
                    .is_dihedral = false,
                    .is_directional = false};
  for (const pattern::PanelInfo& panel : garment.panels.panels) {
    const Material& m = material_of(garment, panel.material);
    facts.has_shear |= m.shear_n_m > 0;
    facts.has_bending |= m.bend_n_m > 0;
    facts.is_directional |= cloth::bends_by_direction(m);
    facts.has_damping |= m.damping_s > 0;
    facts.has_friction |= m.friction_body > 0 || m.friction_self > 0;
  }
  facts.is_triangles = scene.membrane == "triangles" || (!scene.shrink.empty() && !facts.is_fem);
  facts.is_dihedral = facts.has_bending && (scene.bending == "dihedral" || !scene.creases.empty());
  return facts;
}

std::vector<EffectReport> choose_effects(const Garment& garment, const body::Body* body,
                                         const DrapeSettings& settings) {
  const EffectFacts facts = facts_of(garment, body, settings);
  if (facts.is_fem && !facts.scene.shrink.empty())
    throw input_error("scene.effects-conflict"_id, "", "shrink",
                      "the finite-element membrane has no b_u, b_v",
                      "choose \"membrane\": \"triangles\", which the scene gets by itself");
  std::vector<EffectReport> effects;
  for (const EffectSpec& spec : effect_registry()) {
    const EffectChoice choice = spec.choose(facts);
    effects.push_back({spec.name, choice.wanted, choice.why, 0, 0});
  }
  std::vector<std::string> list;
  std::stringstream stream(settings.effects);
  for (std::string name; std::getline(stream, name, ',');)
    list.push_back(name);
  const bool changes =
      !list.empty() &&
      list[0] == "auto"; // auto, then what is to be on (name) or off (-name) all the same
  if (changes)
    list.erase(list.begin());
  else
    for (EffectReport& e : effects) {
      e.active = false;
      e.why = "not named in the list of effects";
    }
  for (const std::string& name : list) {
    const bool off = changes && name.size() > 1 && name[0] == '-';
    EffectReport& e = named(effects, off ? name.substr(1) : name);
    e.active = !off;
    e.why = off ? "switched off by the list of effects" : "named in the list of effects";
    if (changes && !off)
      replace_others(effects, name);
  }
  check_models(effects);
  return effects;
}

void prepare_mesh(cloth::ClothMesh& mesh, const Garment& garment,
                  const std::vector<EffectReport>& chosen) {
  for (const EffectSpec& spec : effect_registry())
    if (spec.prepare)
      spec.prepare(mesh, garment, is_active(chosen, spec.name));
}

void add_effects(EffectStage stage, EffectBuild& build, const std::vector<EffectReport>& chosen) {
  for (const EffectSpec& spec : effect_registry())
    if (spec.stage == stage && spec.add && is_active(chosen, spec.name))
      spec.add(build);
}

bool is_active(const std::vector<EffectReport>& effects, const std::string& name) {
  return std::any_of(effects.begin(), effects.end(),
                     [&](const EffectReport& e) { return e.name == name && e.active; });
}

} // namespace sloper::garment

#include <base/error.hpp>
#include <garment/materials.hpp>
#include <garment/scene/effects.hpp>
#include <garment/sewing.hpp>

#include <algorithm>
#include <sstream>

namespace sloper::garment {

/// Models of the same thing: only one of each takes part.
static constexpr const char* STRETCH_MODELS[] = {"edge_springs", "triangle_stretch", "membrane"};
static constexpr const char* BENDING_MODELS[] = {"bending", "dihedral_bending"};

static EffectReport& named(std::vector<EffectReport>& effects, const std::string& name) {
  const auto found = std::find_if(effects.begin(), effects.end(), [&](const EffectReport& e) { return e.name == name; });
  if (found != effects.end()) return *found;
  std::string names;
  std::vector<std::string> known;
  for (const EffectReport& e : effects) {
    known.push_back(e.name);
    names += (names.empty() ? "" : ", ") + e.name;
  }
  throw Error(ErrorKind::USAGE, "", "effect \"" + name + "\"", "is not known" + did_you_mean(name, known), "known are " + names);
}

/// One that is named takes the place of the others of its kind.
static void replace_others(std::vector<EffectReport>& effects, const std::string& name) {
  auto replace = [&](const auto& models) {
    if (std::find(std::begin(models), std::end(models), name) == std::end(models)) return;
    for (const char* other : models)
      if (other != name && named(effects, other).active) {
        named(effects, other).active = false;
        named(effects, other).why = name + " takes its place";
      }
  };
  replace(STRETCH_MODELS);
  replace(BENDING_MODELS);
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
    if (n > 1) throw Error(ErrorKind::USAGE, "", "effects", both + " are models of the same " + of, "name one of them");
  };
  only_one(STRETCH_MODELS, "stretch");
  only_one(BENDING_MODELS, "bending");
  if (is_active(effects, "membrane") && is_active(effects, "shear"))
    throw Error(ErrorKind::USAGE, "", "effects", "membrane and shear both carry shear", "leave shear out");
}

std::vector<EffectReport> choose_effects(const Garment& garment, const body::Body* body, const DrapeSettings& settings) {
  const std::size_t open = garment.particle_of.empty() ? 1 : open_stitches(garment).size();
  bool shear = false, bend = false, damped = false, rubs = false;
  for (const pattern::PanelInfo& panel : garment.panels.panels) {
    const Material& m = material_of(garment, panel.material);
    shear |= m.shear_n_m > 0;
    bend |= m.bend_n_m > 0;
    damped |= m.damping_s > 0;
    rubs |= m.friction_body > 0 || m.friction_self > 0;
  }
  std::vector<EffectReport> effects;
  auto consider = [&](const char* name, bool wanted, const char* yes, const char* no) { effects.push_back({name, wanted, wanted ? yes : no, 0, 0}); };
  const SceneEffects& scene = garment.scene;
  const bool fem = scene.membrane == "fem", triangles = scene.membrane == "triangles" || (!scene.shrink.empty() && !fem);
  if (fem && !scene.shrink.empty())
    throw input_error("", "shrink", "the finite-element membrane has no b_u, b_v", "choose \"membrane\": \"triangles\", which the scene gets by itself");
  consider("edge_springs", !fem && !triangles, "cloth resists stretch", "another model carries the stretch");
  consider("triangle_stretch", triangles, scene.shrink.empty() ? "the scene chose triangles" : "the scene shrinks a region",
           "edge springs or finite elements do it");
  consider("membrane", fem, "the scene chose finite elements", "the scene did not choose finite elements");
  consider("shear", shear && !fem, "a fabric has shear stiffness", fem ? "the finite elements carry shear" : "no fabric has shear stiffness");
  const bool dihedral = bend && (scene.bending == "dihedral" || !scene.creases.empty());
  consider("bending", bend && !dihedral, "a fabric has bending rigidity", bend ? "dihedral bending takes its place" : "no fabric has bending rigidity");
  consider("dihedral_bending", dihedral, scene.creases.empty() ? "the scene chose it" : "the scene has creases",
           bend ? "there is no crease" : "no fabric has bending rigidity");
  consider("damping", damped, "a fabric has internal damping", "no fabric has internal damping");
  consider("sewing", open > 0 && !garment.panels.seams.empty(), "seams are open", "no seam is open");
  consider("gravity", settings.gravity_m_s2 > 0, "the scene has gravity", "gravity is 0");
  consider("pins", !scene.pins.empty(), "the scene has pins", "the scene has no pins");
  consider("attachments", !scene.attachments.empty(), "the scene has elastic attachments", "the scene has no attachments");
  consider("elastic_bands", !scene.bands.empty(), "the scene has elastic bands", "the scene has no elastic bands");
  consider("wind", scene.air, "the scene has air", "the scene names no wind");
  consider("pressure", scene.pressure_pa != 0, "the scene has pressure", "the pressure is 0");
  const bool touches = body && !body->skin.triangles.empty();
  consider("body_contact", touches, "there is a body", "there is no body");
  consider("body_motion", false, "", touches ? "the body stands still" : "there is no body");
  consider("friction", touches && rubs, "cloth rests on the body by it", touches ? "no fabric has friction" : "there is no body to rest on");
  consider("self_contact", garment.panels.panels.size() > 1 || bend, "panels can touch each other", "one panel without bending");
  int layers = 0;
  for (const pattern::PanelInfo& panel : garment.panels.panels) layers = std::max(layers, panel.layer);
  consider("layers", layers > 0 && touches, "cloth lies over cloth: self contact keeps the order", "there is one layer");
  std::vector<std::string> list;
  std::stringstream stream(settings.effects);
  for (std::string name; std::getline(stream, name, ',');) list.push_back(name);
  const bool changes = !list.empty() && list[0] == "auto"; // auto, then what is to be on (name) or off (-name) all the same
  if (changes) list.erase(list.begin());
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
    if (changes && !off) replace_others(effects, name);
  }
  check_models(effects);
  return effects;
}

bool is_active(const std::vector<EffectReport>& effects, const std::string& name) {
  return std::any_of(effects.begin(), effects.end(), [&](const EffectReport& e) { return e.name == name && e.active; });
}

} // namespace sloper::garment

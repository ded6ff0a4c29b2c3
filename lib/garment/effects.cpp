#include <base/error.hpp>
#include <garment/effects.hpp>
#include <garment/materials.hpp>
#include <garment/sewing.hpp>

#include <algorithm>
#include <sstream>

namespace sloper::garment {

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
  consider("edge_springs", true, "cloth resists stretch", "");
  consider("shear", shear, "a fabric has shear stiffness", "no fabric has shear stiffness");
  consider("bending", bend, "a fabric has bending rigidity", "no fabric has bending rigidity");
  consider("damping", damped, "a fabric has internal damping", "no fabric has internal damping");
  consider("sewing", open > 0 && !garment.panels.seams.empty(), "seams are open", "no seam is open");
  consider("gravity", settings.gravity_m_s2 > 0, "the scene has gravity", "gravity is 0");
  const bool touches = body && !body->skin.triangles.empty();
  consider("body_contact", touches, "there is a body", "there is no body");
  consider("friction", touches && rubs, "cloth rests on the body by it", touches ? "no fabric has friction" : "there is no body to rest on");
  consider("self_contact", garment.panels.panels.size() > 1 || bend, "panels can touch each other", "one panel without bending");
  if (settings.effects == "auto") return effects;

  std::vector<std::string> known;
  for (EffectReport& e : effects) {
    known.push_back(e.name);
    e.active = false;
    e.why = "not named in the list of effects";
  }
  std::stringstream list(settings.effects);
  for (std::string name; std::getline(list, name, ',');) {
    const auto found = std::find_if(effects.begin(), effects.end(), [&](const EffectReport& e) { return e.name == name; });
    if (found == effects.end()) {
      std::string names;
      for (const std::string& k : known) names += (names.empty() ? "" : ", ") + k;
      const std::string near = nearest_word(name, known.data(), known.data() + known.size());
      throw Error(ErrorKind::USAGE, "", "effect \"" + name + "\"", "is not known" + (near.empty() ? std::string() : " (did you mean \"" + near + "\"?)"),
                  "known are " + names);
    }
    found->active = true;
    found->why = "named in the list of effects";
  }
  return effects;
}

bool is_active(const std::vector<EffectReport>& effects, const std::string& name) {
  return std::any_of(effects.begin(), effects.end(), [&](const EffectReport& e) { return e.name == name && e.active; });
}

} // namespace sloper::garment

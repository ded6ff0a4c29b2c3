#include <garment/scene/panel_runs.hpp>
#include <sloper/cloth/forces/pins.hpp>
#include <sloper/garment/scene/effect_spec.hpp>

#include <algorithm>

namespace sloper::garment {

namespace {

std::vector<cloth::Pin> pins_of(const Garment& garment) {
  std::vector<cloth::Pin> pins;
  for (const ScenePin& pin : garment.scene.pins)
    for (int v : run_vertices(garment, pin.run)) {
      const int p = particle_at(garment, v);
      if (std::any_of(pins.begin(), pins.end(),
                      [&](const cloth::Pin& other) { return other.particle == p; }))
        continue;
      const Vec3 placed =
          garment.panels.placed.empty() ? garment.position[p] : garment.panels.placed[v];
      pins.push_back({p, pin.has_target ? pin.target : placed, pin.stiffness_n_m, Vec3::Zero()});
    }
  return pins;
}

EffectChoice choose_pins(const EffectFacts& facts) {
  if (!facts.scene.pins.empty())
    return {true, "the scene has pins"};
  return {false, "the scene has no pins"};
}

void add_pins(EffectBuild& build) {
  if (!build.garment.scene.pins.empty())
    build.solver.emplace<cloth::PinsEffect>(pins_of(build.garment));
}

} // namespace

EffectSpec pins_effect() {
  return {.name = "pins", .stage = EffectStage::SCENE, .choose = choose_pins, .add = add_pins};
}

} // namespace sloper::garment

#include <sloper/cloth/forces/wind.hpp>
#include <sloper/garment/scene/effect_spec.hpp>

namespace sloper::garment {

namespace {

EffectChoice choose_wind(const EffectFacts& facts) {
  if (facts.scene.air)
    return {true, "the scene has air"};
  return {false, "the scene names no wind"};
}

void add_wind(EffectBuild& build) {
  if (build.open_seams)
    return;
  cloth::WindOptions options;
  options.velocity = build.garment.scene.wind_m_s;
  build.solver.emplace<cloth::WindEffect>(build.mesh.particle_triangles(), options);
}

} // namespace

EffectSpec wind_effect() {
  return {.name = "wind", .stage = EffectStage::SCENE, .choose = choose_wind, .add = add_wind};
}

} // namespace sloper::garment

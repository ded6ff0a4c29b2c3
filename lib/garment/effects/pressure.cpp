#include <sloper/cloth/forces/pressure.hpp>
#include <sloper/garment/scene/effect_spec.hpp>

namespace sloper::garment {

namespace {

EffectChoice choose_pressure(const EffectFacts& facts) {
  if (facts.scene.pressure_pa != 0)
    return {true, "the scene has pressure"};
  return {false, "the pressure is 0"};
}

void add_pressure(EffectBuild& build) {
  const double pressure_pa = build.garment.scene.pressure_pa;
  if (build.open_seams || pressure_pa == 0)
    return;
  build.solver.emplace<cloth::PressureEffect>(build.mesh.particle_triangles(), pressure_pa);
}

} // namespace

EffectSpec pressure_effect() {
  return {.name = "pressure",
          .stage = EffectStage::SCENE,
          .choose = choose_pressure,
          .add = add_pressure};
}

} // namespace sloper::garment

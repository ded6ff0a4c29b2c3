#include <sloper/cloth/forces/gravity.hpp>
#include <sloper/garment/scene/effect_spec.hpp>

namespace sloper::garment {

namespace {

EffectChoice choose_gravity(const EffectFacts& facts) {
  if (facts.settings.gravity_m_s2 > 0)
    return {true, "the scene has gravity"};
  return {false, "gravity is 0"};
}

void add_gravity(EffectBuild& build) {
  build.solver.emplace<cloth::GravityEffect>(build.mesh, Vec3(0, -build.settings.gravity_m_s2, 0));
}

} // namespace

EffectSpec gravity_effect() {
  return {
      .name = "gravity", .stage = EffectStage::LOAD, .choose = choose_gravity, .add = add_gravity};
}

} // namespace sloper::garment

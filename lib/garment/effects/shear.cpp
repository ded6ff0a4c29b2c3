#include <sloper/cloth/forces/shear.hpp>
#include <sloper/garment/scene/effect_spec.hpp>

namespace sloper::garment {

namespace {

EffectChoice choose_shear(const EffectFacts& facts) {
  if (facts.is_fem)
    return {false, "the finite elements carry shear"};
  if (!facts.has_shear)
    return {false, "no fabric has shear stiffness"};
  return {true, "a fabric has shear stiffness"};
}

void add_shear(EffectBuild& build) {
  build.solver.emplace<cloth::ShearEffect>(build.mesh);
}

} // namespace

EffectSpec shear_effect() {
  return {.name = "shear", .stage = EffectStage::FABRIC, .choose = choose_shear, .add = add_shear};
}

} // namespace sloper::garment

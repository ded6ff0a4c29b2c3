#include <sloper/cloth/forces/membrane.hpp>
#include <sloper/garment/scene/effect_spec.hpp>

namespace sloper::garment {

namespace {

EffectChoice choose_membrane(const EffectFacts& facts) {
  if (facts.is_fem)
    return {true, "the scene chose finite elements"};
  return {false, "the scene did not choose finite elements"};
}

void add_membrane(EffectBuild& build) {
  build.solver.emplace<cloth::MembraneEffect>(build.mesh);
}

} // namespace

EffectSpec membrane_effect() {
  return {.name = "membrane",
          .stage = EffectStage::MODEL,
          .model = EffectModel::STRETCH,
          .choose = choose_membrane,
          .add = add_membrane};
}

} // namespace sloper::garment

#include <sloper/cloth/forces/bending.hpp>
#include <sloper/garment/scene/effect_spec.hpp>

namespace sloper::garment {

namespace {

EffectChoice choose_bending(const EffectFacts& facts) {
  if (!facts.has_bending)
    return {false, "no fabric has bending rigidity"};
  if (facts.is_directional)
    return {false, "orthotropic bending takes its place"};
  if (facts.is_dihedral)
    return {false, "dihedral bending takes its place"};
  return {true, "a fabric has bending rigidity"};
}

void add_bending(EffectBuild& build) {
  build.solver.emplace<cloth::BendingEffect>(build.mesh);
}

} // namespace

EffectSpec bending_effect() {
  return {.name = "bending",
          .stage = EffectStage::FABRIC,
          .model = EffectModel::BENDING,
          .choose = choose_bending,
          .add = add_bending};
}

} // namespace sloper::garment

#include <garment/scene/crease_angles.hpp>
#include <sloper/cloth/forces/orthotropic_bending.hpp>
#include <sloper/garment/scene/effect_spec.hpp>

namespace sloper::garment {

namespace {

EffectChoice choose_orthotropic_bending(const EffectFacts& facts) {
  if (!facts.has_bending)
    return {false, "no fabric has bending rigidity"};
  if (!facts.is_directional)
    return {false, "all fabrics bend alike in all directions"};
  return {true, "a fabric bends by direction"};
}

void add_orthotropic_bending(EffectBuild& build) {
  const SceneEffects& scene = build.garment.scene;
  std::optional<std::vector<double>> rest;
  if (scene.bending == "dihedral" || !scene.creases.empty())
    rest = crease_angles(build.mesh, build.garment, build.open_seams);
  build.solver.emplace<cloth::OrthotropicBendingEffect>(build.mesh, std::move(rest));
}

} // namespace

EffectSpec orthotropic_bending_effect() {
  return {.name = "orthotropic_bending",
          .stage = EffectStage::MODEL,
          .model = EffectModel::BENDING,
          .choose = choose_orthotropic_bending,
          .add = add_orthotropic_bending};
}

} // namespace sloper::garment

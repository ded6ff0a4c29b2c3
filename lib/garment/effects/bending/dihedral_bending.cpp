#include <garment/scene/crease_angles.hpp>
#include <sloper/cloth/forces/dihedral_bending.hpp>
#include <sloper/garment/scene/effect_spec.hpp>

namespace sloper::garment {

namespace {

EffectChoice choose_dihedral_bending(const EffectFacts& facts) {
  if (facts.is_dihedral && facts.is_directional)
    return {false, "orthotropic bending takes its place"};
  if (facts.is_dihedral)
    return {true, facts.scene.creases.empty() ? "the scene chose it" : "the scene has creases"};
  return {false, facts.has_bending ? "there is no crease" : "no fabric has bending rigidity"};
}

/// Whichever model has the rest angles.
void prepare_creases(cloth::ClothMesh& mesh, const Garment& garment, bool /*is_on*/) {
  firm_creases(mesh, garment);
}

void add_dihedral_bending(EffectBuild& build) {
  build.solver.emplace<cloth::DihedralBendingEffect>(
      build.mesh, crease_angles(build.mesh, build.garment, build.open_seams));
}

} // namespace

EffectSpec dihedral_bending_effect() {
  return {.name = "dihedral_bending",
          .stage = EffectStage::MODEL,
          .model = EffectModel::BENDING,
          .choose = choose_dihedral_bending,
          .add = add_dihedral_bending,
          .prepare = prepare_creases};
}

} // namespace sloper::garment

#include <sloper/garment/scene/effect_spec.hpp>

namespace sloper::garment {

namespace {

EffectChoice choose_damping(const EffectFacts& facts) {
  if (facts.has_damping)
    return {true, "a fabric has internal damping"};
  return {false, "no fabric has internal damping"};
}

/// The models of stretch and bending carry it: without it their damping times are zero.
void prepare_damping(cloth::ClothMesh& mesh, const Garment&, bool is_on) {
  if (is_on)
    return;
  for (cloth::EdgeSpring& s : mesh.springs)
    s.damping_s = 0;
  for (cloth::Fabric& f : mesh.fabrics)
    f.damping_s = 0;
}

} // namespace

EffectSpec damping_effect() {
  return {.name = "damping",
          .stage = EffectStage::NONE,
          .choose = choose_damping,
          .prepare = prepare_damping};
}

} // namespace sloper::garment

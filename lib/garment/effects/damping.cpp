#include <garment/scene/effect_spec.hpp>

namespace sloper::garment {

namespace {

EffectChoice choose_damping(const EffectFacts& facts) {
  if (facts.has_damping) return {true, "a fabric has internal damping"};
  return {false, "no fabric has internal damping"};
}

} // namespace

EffectSpec damping_effect() { return {.name = "damping", .stage = EffectStage::NONE, .choose = choose_damping}; }

} // namespace sloper::garment

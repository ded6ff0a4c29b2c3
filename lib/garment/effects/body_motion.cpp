#include <sloper/garment/scene/effect_spec.hpp>

namespace sloper::garment {

namespace {

EffectChoice choose_body_motion(const EffectFacts& facts) {
  return {false, facts.touches_body ? "the body stands still" : "there is no body"};
}

} // namespace

EffectSpec body_motion_effect() {
  return {.name = "body_motion", .stage = EffectStage::NONE, .choose = choose_body_motion};
}

} // namespace sloper::garment

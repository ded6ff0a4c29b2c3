#include <sloper/garment/materials.hpp>
#include <sloper/garment/scene/effect_spec.hpp>

namespace sloper::garment {

namespace {

EffectChoice choose_friction(const EffectFacts& facts) {
  if (!facts.touches_body)
    return {false, "there is no body to rest on"};
  if (!facts.has_friction)
    return {false, "no fabric has friction"};
  return {true, "cloth rests on the body by it"};
}

void add_friction(EffectBuild& build) {
  const Material& material = material_of(build.garment, "");
  if (build.handles.body_contact)
    build.handles.body_contact->set_friction(material.friction_body);
  if (build.handles.self_contact)
    build.handles.self_contact->set_friction(material.friction_self);
}

} // namespace

EffectSpec friction_effect() {
  return {.name = "friction",
          .stage = EffectStage::LOAD,
          .choose = choose_friction,
          .add = add_friction};
}

} // namespace sloper::garment

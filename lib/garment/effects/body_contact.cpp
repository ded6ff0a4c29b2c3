#include <sloper/garment/scene/effect_spec.hpp>

namespace sloper::garment {

namespace {

EffectChoice choose_body_contact(const EffectFacts& facts) {
  if (facts.touches_body)
    return {true, "there is a body"};
  return {false, "there is no body"};
}

void add_body_contact(EffectBuild& build) {
  if (!build.collider)
    return;
  cloth::BodyContactOptions options;
  options.gap_m = build.settings.contact_gap_m;
  options.level = static_cast<cloth::ContactLevel>(build.settings.contact_level);
  build.handles.body_contact =
      &build.solver.emplace<cloth::BodyContactEffect>(build.mesh, *build.collider, options);
}

} // namespace

EffectSpec body_contact_effect() {
  return {.name = "body_contact",
          .stage = EffectStage::CONTACT,
          .choose = choose_body_contact,
          .add = add_body_contact};
}

} // namespace sloper::garment

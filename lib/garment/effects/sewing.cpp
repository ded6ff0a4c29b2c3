#include <sloper/garment/scene/effect_spec.hpp>
#include <sloper/garment/sewing.hpp>

namespace sloper::garment {

namespace {

EffectChoice choose_sewing(const EffectFacts& facts) {
  if (facts.has_open_seams && !facts.garment.panels.seams.empty())
    return {true, "seams are open"};
  return {false, "no seam is open"};
}

void add_sewing(EffectBuild& build) {
  if (!build.open_seams)
    return;
  build.handles.sewing = &build.solver.emplace<cloth::SewingSpringEffect>(
      open_stitches(build.garment), 1.0, SEW_REACH);
}

} // namespace

EffectSpec sewing_effect() {
  return {
      .name = "sewing", .stage = EffectStage::CONTACT, .choose = choose_sewing, .add = add_sewing};
}

} // namespace sloper::garment

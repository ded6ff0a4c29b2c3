#include <sloper/garment/scene/effect_spec.hpp>
#include <sloper/garment/sewing.hpp>

namespace sloper::garment {

namespace {

constexpr double SEW_SEARCH =
    0.75; // of the mesh edge: cloth nearer than this is watched while sewing

EffectChoice choose_self_contact(const EffectFacts& facts) {
  if (facts.garment.panels.panels.size() > 1 || facts.has_bending)
    return {true, "panels can touch each other"};
  return {false, "one panel without bending"};
}

void add_self_contact(EffectBuild& build) {
  cloth::SelfContactOptions options;
  options.thickness_m = build.settings.self_thickness_m;
  if (build.open_seams)
    options.search_m = SEW_SEARCH * build.mesh.mean_edge();
  std::vector<int> classes;
  if (build.open_seams)
    classes = seam_classes(build.garment);
  build.handles.self_contact =
      &build.solver.emplace<cloth::SelfContactEffect>(build.mesh, options, std::move(classes));
}

} // namespace

EffectSpec self_contact_effect() {
  return {.name = "self_contact",
          .stage = EffectStage::CONTACT,
          .choose = choose_self_contact,
          .add = add_self_contact};
}

} // namespace sloper::garment

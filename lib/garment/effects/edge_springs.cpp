#include <sloper/cloth/forces/edge_spring.hpp>
#include <sloper/garment/scene/effect_spec.hpp>

namespace sloper::garment {

namespace {

EffectChoice choose_edge_springs(const EffectFacts& facts) {
  if (facts.is_fem || facts.is_triangles)
    return {false, "another model carries the stretch"};
  return {true, "cloth resists stretch"};
}

void add_edge_springs(EffectBuild& build) {
  build.solver.emplace<cloth::EdgeSpringEffect>(build.mesh);
}

} // namespace

EffectSpec edge_springs_effect() {
  return {.name = "edge_springs",
          .stage = EffectStage::FABRIC,
          .model = EffectModel::STRETCH,
          .choose = choose_edge_springs,
          .add = add_edge_springs};
}

} // namespace sloper::garment

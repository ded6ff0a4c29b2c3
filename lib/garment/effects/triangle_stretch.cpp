#include <garment/scene/panel_runs.hpp>
#include <sloper/cloth/forces/triangle_stretch.hpp>
#include <sloper/garment/scene/effect_spec.hpp>

namespace sloper::garment {

namespace {

std::vector<cloth::Shrink> shrink_of(const Garment& garment) {
  std::vector<cloth::Shrink> shrink(garment.panels.triangles.size());
  for (const SceneShrink& s : garment.scene.shrink) {
    if (!s.panel.empty())
      panel_named(garment, s.panel);
    for (const pattern::PanelInfo& panel : garment.panels.panels) {
      if (!s.panel.empty() && panel.name != s.panel)
        continue;
      for (int f = panel.first_triangle; f < panel.first_triangle + panel.n_triangles; ++f) {
        Vec2 middle = Vec2::Zero();
        for (int v : garment.panels.triangles[f])
          middle += Vec2(garment.panels.ids[v].s, garment.panels.ids[v].t) / 3;
        if ((middle.array() >= s.low.array()).all() && (middle.array() <= s.high.array()).all())
          shrink[f] = {s.weft, s.warp};
      }
    }
  }
  return shrink;
}

EffectChoice choose_triangle_stretch(const EffectFacts& facts) {
  if (!facts.is_triangles)
    return {false, "edge springs or finite elements do it"};
  return {true,
          facts.scene.shrink.empty() ? "the scene chose triangles" : "the scene shrinks a region"};
}

void add_triangle_stretch(EffectBuild& build) {
  build.solver.emplace<cloth::TriangleStretchEffect>(build.mesh, shrink_of(build.garment));
}

} // namespace

EffectSpec triangle_stretch_effect() {
  return {.name = "triangle_stretch",
          .stage = EffectStage::MODEL,
          .model = EffectModel::STRETCH,
          .choose = choose_triangle_stretch,
          .add = add_triangle_stretch};
}

} // namespace sloper::garment

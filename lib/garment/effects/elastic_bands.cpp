#include <garment/scene/panel_runs.hpp>
#include <sloper/cloth/forces/elastic_band.hpp>
#include <sloper/garment/scene/effect_spec.hpp>

namespace sloper::garment {

namespace {

std::vector<cloth::BandLink> bands_of(const Garment& garment) {
  std::vector<cloth::BandLink> links;
  for (const SceneBand& band : garment.scene.bands) {
    const std::vector<int> run = run_vertices(garment, band.run);
    for (std::size_t k = 0; k + 1 < run.size(); ++k) {
      const int i = particle_at(garment, run[k]), j = particle_at(garment, run[k + 1]);
      const double length =
          (garment.panels.pattern[run[k + 1]] - garment.panels.pattern[run[k]]).norm();
      if (i != j && length > 0)
        links.push_back({i, j, band.ratio * length, band.strength_n});
    }
  }
  return links;
}

EffectChoice choose_elastic_bands(const EffectFacts& facts) {
  if (!facts.scene.bands.empty())
    return {true, "the scene has elastic bands"};
  return {false, "the scene has no elastic bands"};
}

void add_elastic_bands(EffectBuild& build) {
  if (build.open_seams)
    return;
  build.solver.emplace<cloth::ElasticBandEffect>(bands_of(build.garment));
}

} // namespace

EffectSpec elastic_bands_effect() {
  return {.name = "elastic_bands",
          .stage = EffectStage::SCENE,
          .choose = choose_elastic_bands,
          .add = add_elastic_bands};
}

} // namespace sloper::garment

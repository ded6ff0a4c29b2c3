#include <garment/scene/panel_runs.hpp>
#include <sloper/garment/scene/effect_spec.hpp>

namespace sloper::garment {

namespace {

EffectChoice choose_weights(const EffectFacts& facts) {
  if (!facts.scene.weights.empty())
    return {true, "the scene has weights"};
  return {false, "the scene has no weights"};
}

/// Shares a mass among the particles of a run, each by the length of the run beside it; a run of
/// one particle gets all.
void add_mass(cloth::ClothMesh& mesh, const Garment& garment, const SceneWeight& weight) {
  const std::vector<int> run = run_vertices(garment, weight.run);
  std::vector<double> length(run.size(), 0);
  double sum = 0;
  for (std::size_t k = 0; k + 1 < run.size(); ++k) {
    const double l = (garment.panels.pattern[run[k + 1]] - garment.panels.pattern[run[k]]).norm();
    length[k] += 0.5 * l;
    length[k + 1] += 0.5 * l;
    sum += l;
  }
  for (std::size_t k = 0; k < run.size(); ++k) {
    const double share = sum > 0 ? length[k] / sum : 1.0 / static_cast<double>(run.size());
    mesh.mass[particle_at(garment, run[k])] += share * weight.mass_kg;
  }
}

/// What is sewn on is mass of the cloth: gravity and inertia act on it as on cloth.
void prepare_weights(cloth::ClothMesh& mesh, const Garment& garment, bool is_on) {
  if (!is_on)
    return;
  for (const SceneWeight& weight : garment.scene.weights)
    add_mass(mesh, garment, weight);
}

} // namespace

EffectSpec weights_effect() {
  return {.name = "weights",
          .stage = EffectStage::NONE,
          .choose = choose_weights,
          .prepare = prepare_weights};
}

} // namespace sloper::garment

#include <garment/scene/panel_runs.hpp>
#include <sloper/base/error.hpp>
#include <sloper/cloth/forces/closures.hpp>
#include <sloper/garment/scene/effect_spec.hpp>

#include <algorithm>

namespace sloper::garment {

namespace {

/// Distances from the first vertex along a run in the pattern, over its whole length.
std::vector<double> shares_along(const Garment& garment, const std::vector<int>& run) {
  std::vector<double> at{0};
  for (std::size_t k = 0; k + 1 < run.size(); ++k)
    at.push_back(at.back() +
                 (garment.panels.pattern[run[k + 1]] - garment.panels.pattern[run[k]]).norm());
  for (double& a : at)
    a /= std::max(at.back(), 1e-12);
  return at;
}

int nearest(const std::vector<double>& shares, double share) {
  int best = 0;
  for (std::size_t k = 0; k < shares.size(); ++k)
    if (std::abs(shares[k] - share) < std::abs(shares[best] - share))
      best = static_cast<int>(k);
  return best;
}

std::vector<cloth::Closure> closures_of(const Garment& garment, double apart) {
  std::vector<cloth::Closure> closures;
  for (const SceneClosure& c : garment.scene.closures) {
    const std::vector<int> a = run_vertices(garment, c.run), b = run_vertices(garment, c.with);
    const std::vector<double> along_a = shares_along(garment, a),
                              along_b = shares_along(garment, b);
    const int n = c.count > 0 ? c.count : static_cast<int>(a.size()); // a zip has no number
    for (int k = 0; k < n; ++k) {
      const double evenly = n > 1 ? static_cast<double>(k) / (n - 1) : 0.5;
      const double share = c.count > 0 ? evenly : along_a[k];
      const int i = particle_at(garment, a[nearest(along_a, share)]),
                j = particle_at(garment, b[nearest(along_b, share)]);
      if (i != j)
        closures.push_back({i, j, apart, c.stiffness_n_m});
    }
  }
  return closures;
}

EffectChoice choose_closures(const EffectFacts& facts) {
  if (!facts.scene.closures.empty())
    return {true, "the scene has buttons or a zip"};
  return {false, "the scene has no closures"};
}

void add_closures(EffectBuild& build) {
  if (build.open_seams)
    return; // what is sewn is closed afterwards
  build.solver.emplace<cloth::ClosuresEffect>(
      closures_of(build.garment, 2 * build.settings.self_thickness_m));
}

} // namespace

EffectSpec closures_effect() {
  return {.name = "closures",
          .stage = EffectStage::SCENE,
          .choose = choose_closures,
          .add = add_closures};
}

} // namespace sloper::garment

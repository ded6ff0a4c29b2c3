#include <cloth/forces/dihedral_bending.hpp>
#include <garment/scene/effect_spec.hpp>
#include <garment/scene/panel_runs.hpp>

namespace sloper::garment {

namespace {

/// Rest angle of each hinge, in the sign of its own order of particles.
std::vector<double> rest_angles_of(const cloth::ClothMesh& mesh, const Garment& garment) {
  std::vector<double> rest(mesh.hinges.size(), 0);
  for (const SceneCrease& crease : garment.scene.creases) {
    const std::vector<int> run = run_particles(garment, crease.run);
    for (std::size_t h = 0; h < mesh.hinges.size(); ++h) {
      const cloth::Hinge& hinge = mesh.hinges[h];
      for (std::size_t k = 0; k + 1 < run.size(); ++k) {
        if (!((hinge.particle[0] == run[k] && hinge.particle[1] == run[k + 1]) ||
              (hinge.particle[1] == run[k] && hinge.particle[0] == run[k + 1])))
          continue;
        // Particle 2 lies left of 0 -> 1, seen from outside, when a triangle runs 0, 1, 2; there
        // outward folds are negative angles.
        bool left = false;
        for (const cloth::RestTriangle& t : mesh.triangles)
          for (int c = 0; c < 3; ++c)
            left |= t.particle[c] == hinge.particle[0] &&
                    t.particle[(c + 1) % 3] == hinge.particle[1] &&
                    t.particle[(c + 2) % 3] == hinge.particle[2];
        rest[h] = left ? crease.angle_rad : -crease.angle_rad;
      }
    }
  }
  return rest;
}

EffectChoice choose_dihedral_bending(const EffectFacts& facts) {
  if (facts.is_dihedral)
    return {true, facts.scene.creases.empty() ? "the scene chose it" : "the scene has creases"};
  return {false, facts.has_bending ? "there is no crease" : "no fabric has bending rigidity"};
}

void add_dihedral_bending(EffectBuild& build) {
  build.solver.emplace<cloth::DihedralBendingEffect>(build.mesh,
                                                     rest_angles_of(build.mesh, build.garment));
}

} // namespace

EffectSpec dihedral_bending_effect() {
  return {.name = "dihedral_bending",
          .stage = EffectStage::MODEL,
          .model = EffectModel::BENDING,
          .choose = choose_dihedral_bending,
          .add = add_dihedral_bending};
}

} // namespace sloper::garment

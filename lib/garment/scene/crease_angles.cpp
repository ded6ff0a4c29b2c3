#include <garment/scene/crease_angles.hpp>
#include <garment/scene/panel_runs.hpp>
#include <sloper/base/error.hpp>

namespace sloper::garment {

static bool runs_along(const cloth::Hinge& hinge, const std::vector<int>& run) {
  for (std::size_t k = 0; k + 1 < run.size(); ++k)
    if ((hinge.particle[0] == run[k] && hinge.particle[1] == run[k + 1]) ||
        (hinge.particle[1] == run[k] && hinge.particle[0] == run[k + 1]))
      return true;
  return false;
}

void firm_creases(cloth::ClothMesh& mesh, const Garment& garment) {
  for (const SceneCrease& crease : garment.scene.creases) {
    if (!(crease.firmness > 1))
      continue;
    const std::vector<int> run = fold_particles(garment, crease.run);
    for (cloth::Hinge& hinge : mesh.hinges)
      if (runs_along(hinge, run))
        hinge.firmness = (crease.firmness - 1) * hinge.stiffness;
  }
}

std::vector<double> crease_angles(const cloth::ClothMesh& mesh, const Garment& garment,
                                  bool open_seams) {
  std::vector<double> rest(mesh.hinges.size(), 0);
  for (const SceneCrease& crease : garment.scene.creases) {
    if (open_seams && crease.firmness > 1)
      continue;
    const std::vector<int> run = fold_particles(garment, crease.run);
    bool folds = false;
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
        folds = true;
      }
    }
    if (!folds && !open_seams)
      throw input_error("scene.bad-effect"_id, "",
                        "crease or roll line of panel " + crease.run.panel,
                        "runs along a free edge, where there is nothing to fold",
                        "give ends within the cloth, or draw it in the pattern as a line of kind "
                        "roll");
  }
  return rest;
}

} // namespace sloper::garment

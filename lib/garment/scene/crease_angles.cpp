#include <garment/scene/crease_angles.hpp>
#include <garment/scene/fold_edges.hpp>
#include <sloper/base/error.hpp>

#include <algorithm>

namespace sloper::garment {

static bool is_along(const cloth::Hinge& hinge, const std::vector<std::array<int, 2>>& edges) {
  const auto [low, high] = std::minmax(hinge.particle[0], hinge.particle[1]);
  return std::binary_search(edges.begin(), edges.end(), std::array<int, 2>{low, high});
}

void firm_creases(cloth::ClothMesh& mesh, const Garment& garment) {
  for (const SceneCrease& crease : garment.scene.creases) {
    if (!(crease.firmness > 1))
      continue;
    const std::vector<std::array<int, 2>> edges = fold_edges(garment, crease);
    for (cloth::Hinge& hinge : mesh.hinges)
      if (is_along(hinge, edges))
        hinge.firmness = (crease.firmness - 1) * hinge.stiffness;
  }
}

std::vector<double> crease_angles(const cloth::ClothMesh& mesh, const Garment& garment,
                                  bool open_seams) {
  std::vector<double> rest(mesh.hinges.size(), 0);
  for (const SceneCrease& crease : garment.scene.creases) {
    if (open_seams && crease.firmness > 1)
      continue;
    const std::vector<std::array<int, 2>> edges = fold_edges(garment, crease);
    bool folds = false;
    for (std::size_t h = 0; h < mesh.hinges.size(); ++h) {
      const cloth::Hinge& hinge = mesh.hinges[h];
      if (!is_along(hinge, edges))
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

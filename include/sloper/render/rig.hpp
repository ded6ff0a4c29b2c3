#pragma once
/// Joints and weights with which a viewer of the exported scene can pose the body and its
/// clothes.
#include <sloper/render/scene.hpp>

#include <optional>
namespace sloper::render {

/// Joints at the heads of the body's bones, and the share of each joint in the motion of
/// each vertex.
struct Rig {
  /// Weights of one mesh.
  struct Skin {
    std::vector<std::array<int, 4>> joint;     ///< per vertex: the four that count most
    std::vector<std::array<double, 4>> weight; ///< sum to 1
  };
  std::vector<std::string> names; ///< joint 0 is "root"
  std::vector<int> parent;        ///< an earlier joint; -1 for the root
  std::vector<Vec3> head;         ///< m
  std::vector<Skin> skins;        ///< by mesh; empty for what does not move with the body
};

/// The body by its bones and body::skin_weights(). Garments move as if they stuck to the
/// skin about them: a vertex at the gap d has the mean weights of the skin less than 1.5
/// d + 4 cm away, the nearest counting most, so that a skirt between two legs follows
/// each by half. Empty without a body, or where the scan's bones were not found.
/// @param meshes  to be exported: the scene's, the cloth's perhaps finer
std::optional<Rig> make_rig(const Scene& scene, const std::vector<DrawMesh>& meshes);

} // namespace sloper::render

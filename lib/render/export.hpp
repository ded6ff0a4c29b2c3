#pragma once
/// The scene for other programs: GLB (glTF 2.0, opens in browsers), OBJ with MTL, PLY with the map's values per vertex.
#include <render/maps.hpp>
#include <render/scene.hpp>

#include <optional>
namespace sloper::render {

/// What a viewer needs to pose a body: joints at the heads of its bones, and how far each vertex goes with which.
struct Rig {
  int mesh = -1;                             ///< of the scene
  std::vector<std::string> names;            ///< joint 0 is "root"
  std::vector<int> parent;                   ///< an earlier joint; -1 for the root
  std::vector<Vec3> head;                    ///< m
  std::vector<std::array<int, 4>> joint;     ///< per vertex: the four that count most
  std::vector<std::array<double, 4>> weight; ///< sum to 1
};

/// The rig of the scene's body by its bones and body::skin_weights(); nothing without a body, or where the scan's bones were not found.
std::optional<Rig> make_rig(const Scene& scene);

/// One node per mesh with normals, pattern coordinates (of cloth) and vertex colours, in metres, y up. A map's colours are the
/// vertex colours. With a rig its mesh has a skin: a glTF viewer can pose the body. Deterministic.
std::string glb_bytes(const std::vector<DrawMesh>& meshes, const Legend& legend, const Rig* rig = nullptr);

/// Writes by the extension: .glb; .obj and a .mtl beside it, one material per mesh; .ply with position, normal, colour and
/// `value` (NaN where the map has none). Sequences stay OBJ files by number: Debian has no library that writes Alembic or USD.
/// @throws Error OUTPUT, USAGE for another extension
void export_scene(const std::string& path, const std::vector<DrawMesh>& meshes, const Legend& legend, const Rig* rig = nullptr);

/// The numbers behind a map on the cloth as it was draped, not smoothed for drawing: binary PLY with x, y, z (m), normal, colour
/// and `value` (NaN where the map has none), one vertex per panel vertex in the order of values_csv().
std::string values_ply(const Scene& scene, const Legend& legend);

/// True for the extensions that export_scene() knows.
bool is_export(const std::string& path);

} // namespace sloper::render

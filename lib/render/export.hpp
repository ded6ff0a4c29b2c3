#pragma once
/// The scene for other programs: GLB (glTF 2.0, opens in browsers), OBJ with MTL, PLY with the map's values per vertex.
#include <render/maps.hpp>
#include <render/scene.hpp>
namespace sloper::render {

/// One node per mesh with normals, pattern coordinates (of cloth) and vertex colours, in metres, y up. A map's colours are the
/// vertex colours. Deterministic.
std::string glb_bytes(const std::vector<DrawMesh>& meshes, const Legend& legend);

/// Writes by the extension: .glb; .obj and a .mtl beside it, one material per mesh; .ply with position, normal, colour and
/// `value` (NaN where the map has none).
/// @throws Error OUTPUT, USAGE for another extension
void export_scene(const std::string& path, const std::vector<DrawMesh>& meshes, const Legend& legend);

/// The numbers behind a map on the cloth as it was draped, not smoothed for drawing: binary PLY with x, y, z (m), normal, colour
/// and `value` (NaN where the map has none), one vertex per panel vertex in the order of values_csv().
std::string values_ply(const Scene& scene, const Legend& legend);

/// True for the extensions that export_scene() knows.
bool is_export(const std::string& path);

} // namespace sloper::render

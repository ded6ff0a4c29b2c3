#pragma once
/// The scene for other programs: GLB (glTF 2.0, opens in browsers), OBJ with MTL, PLY with the
/// map's values per vertex.
/// Test: tests/render/test_maps.cpp
#include <sloper/io/png.hpp>
#include <sloper/render/maps.hpp>
#include <sloper/render/rig.hpp>
#include <sloper/render/scene.hpp>
namespace sloper::render {

/// A picture printed on the cloth, `size` metres wide and high, repeated.
struct Print {
  io::Image image;   ///< one repeat
  double size = 0.1; ///< m
};

/// One node per mesh with normals, pattern coordinates (of cloth) and vertex colours, in metres, y
/// up. A map's colours are the vertex colours; without one a print is the cloth's texture. With a
/// rig the meshes that move have a skin: a glTF viewer can pose the body, and what it wears goes
/// along. Deterministic. @param rig  made of `meshes`
/// @param legend  of apply_map(); without steps: no map
std::string glb_bytes(const std::vector<DrawMesh>& meshes, const Legend& legend,
                      const Rig* rig = nullptr, const Print* print = nullptr);

/// Writes a scene by the extension: .glb; .obj and a .mtl beside it, one material per
/// mesh; .ply with position, normal, colour and `value` (NaN where the map has none).
/// Only a GLB keeps rig and print.
/// @param legend  of apply_map()
/// @throws Error OUTPUT, USAGE for another extension
void export_scene(const std::string& path, const std::vector<DrawMesh>& meshes,
                  const Legend& legend, const Rig* rig = nullptr, const Print* print = nullptr);

/// The values of a map on the cloth as it was draped, not smoothed for drawing: binary
/// PLY with x, y, z (m), normal, colour and `value` (NaN where the map has none), one
/// vertex per panel vertex in the order of values_csv().
std::string values_ply(const Scene& scene, const Legend& legend);

/// True for the extensions that export_scene() knows.
bool is_export(const std::string& path);

} // namespace sloper::render

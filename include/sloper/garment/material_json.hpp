#pragma once
/// Materials as people and programs write them: in a scene, or as a document of their own.
/// Test: tests/garment/test_materials.cpp
#include <sloper/garment/composite.hpp>
#include <sloper/io/json_fwd.hpp>

namespace sloper::garment {

/// Version of the material document.
inline constexpr int MATERIAL_VERSION = 1;

/// A preset's name, the path of a .csv of measurements or of a .json material, or an object with
/// "preset", what differs from it, and "layers" on it (composite.hpp). Paths are beside the node's
/// document.
/// @throws Error INPUT at its place
Material read_material(const io::Node& node);
/// A document {"format": "material", ...}: the object of read_material(), with "name". What
/// material-fit says of its uncertainty is passed over. @throws Error INPUT
Material read_material_file(const std::string& path);
/// A material by a preset's name, or by a path that ends in .csv (or .csv#NAME) or, for a
/// material document, .json.
/// @throws Error INPUT
Material material_from(const std::string& name_or_path);
/// A layer of cloth: "material", "bond" 0..1, "side" inside or outside. The caller checks the keys.
ClothLayer read_cloth_layer(const io::Node& node);
/// The numbers of a material, as read_material() takes them.
io::Json material_json(const Material& material);

} // namespace sloper::garment

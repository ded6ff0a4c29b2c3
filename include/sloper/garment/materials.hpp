#pragma once
/// Fabric presets with measured values and their source, and which one a panel gets.
/// Test: tests/garment/test_materials.cpp
#include <sloper/garment/garment.hpp>

namespace sloper::garment {

/// All presets, by name. "table1" is Table 1 of Sul et al. 2010 as printed (5-10 times too heavy
/// and far too stiff for cotton). "NAME-orthotropic" is NAME with its mean rigidity by direction.
const std::vector<Material>& material_presets();
/// The preset of that name.
/// @throws Error INPUT naming the presets
const Material& material_preset(const std::string& name);
/// The material of a panel: garment.materials[name], else the preset `name`, else
/// garment.materials[""], else the default preset.
const Material& material_of(const Garment& garment, const std::string& name);
/// The name of the material that most triangles are of; empty where there are none.
std::string main_material(const Garment& garment);

} // namespace sloper::garment

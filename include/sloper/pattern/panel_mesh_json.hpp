#pragma once
/// panels.json and its OBJ, read and written; every key is in panels.json(5).
/// Test: tests/pattern/mesh/test_mesh.cpp
#include <sloper/pattern/panel_mesh.hpp>
namespace sloper::pattern {
/// Version of the format that is written; older ones are read, newer ones refused.
inline constexpr int PANELS_VERSION = 1;
/// Reads panels.json and the OBJ that it names.
/// @throws Error INPUT with file and place
PanelMesh read_panel_mesh(const std::string& path);
/// Writes the OBJ beside the document (`.json` -> `.obj`), then the document.
/// @throws Error OUTPUT
void write_panel_mesh(const std::string& path, const PanelMesh& mesh, const std::string& tool);
} // namespace sloper::pattern

#pragma once
/// panels.json + panels.obj, read and written.
#include <sloper/pattern/panel_mesh.hpp>
namespace sloper::pattern {
inline constexpr int PANELS_VERSION = 1;
PanelMesh read_panel_mesh(const std::string& path); ///< @throws Error INPUT
void write_panel_mesh(const std::string& path, const PanelMesh& mesh,
                      const std::string& tool); ///< @throws Error OUTPUT
} // namespace sloper::pattern

#pragma once
/// From a pattern to a panel mesh: boundary sampled over all seams, panels triangulated, start
/// positions from the pattern's own placement (place_panels() brings them to a body).
#include <sloper/pattern/panel_mesh.hpp>
#include <sloper/pattern/pattern.hpp>

#include <memory>

namespace sloper::pattern {

/// Panels of the last mesh, for a pattern that is meshed repeatedly while an edit changes
/// a panel or two. A panel whose boundary and inner lines are the same to the last bit
/// keeps its triangles, so a mesh made with a memory is the same as one without.
class MeshMemory {
public:
  /// An empty memory.
  MeshMemory();
  ~MeshMemory();
  MeshMemory(MeshMemory&&) noexcept;
  /// Private contents.
  struct Panels;

private:
  friend PanelMesh mesh_pattern(const Pattern&, double, const std::string&, double, MeshMemory*);
  std::unique_ptr<Panels> m_panels;
};

/// Meshes a pattern; the result does not depend on the number of threads or on the
/// memory.
/// @param edge_length  aimed at, m
/// @param file  for messages
/// @param seam_length  aimed at along seams and darts, m, growing to edge_length away
/// from them; 0 for edge_length everywhere
/// @param memory  may be null; holds the panels of this mesh afterwards
/// @throws Error INPUT where a panel cannot be meshed
PanelMesh mesh_pattern(const Pattern& pattern, double edge_length, const std::string& file,
                       double seam_length = 0, MeshMemory* memory = nullptr);

} // namespace sloper::pattern

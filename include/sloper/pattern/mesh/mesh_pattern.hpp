#pragma once
/// From a pattern to a panel mesh: boundary sampled over all seams, panels triangulated, start
/// positions from the pattern's own placement (place_panels() brings them to a body).
#include <sloper/pattern/panel_mesh.hpp>
#include <sloper/pattern/pattern.hpp>

#include <memory>

namespace sloper::pattern {

/// Edge lengths that a mesh aims at, m.
struct MeshLengths {
  double usual = 0; ///< of panels that `of_panel` does not know
  double seam = 0;  ///< along seams and darts, growing away from them; 0: as elsewhere
  /// #panels, or empty; of single panels, at most `usual`. Panels sewn to finer ones are as fine
  /// there, and coarser away from them.
  std::vector<double> of_panel = {};
};

/// Lengths at which each roll line of a pattern has its edges, of edge_length_for_rolls(): those of
/// a panel turned over a line near its outline, as of a narrow collar, are shorter.
/// @param usual, seam  m, as in MeshLengths
MeshLengths lengths_for_rolls(const Pattern& pattern, double usual, double seam = 0);

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
  friend PanelMesh mesh_pattern(const Pattern&, const MeshLengths&, const std::string&,
                                MeshMemory*);
  std::unique_ptr<Panels> m_panels;
};

/// Meshes a pattern; the result does not depend on the number of threads or on the
/// memory.
/// @param file  for messages
/// @param memory  may be null; holds the panels of this mesh afterwards
/// @throws Error INPUT where a panel cannot be meshed
PanelMesh mesh_pattern(const Pattern& pattern, const MeshLengths& lengths, const std::string& file,
                       MeshMemory* memory = nullptr);

/// The same, with all panels alike.
/// @param edge_length  aimed at, m
/// @param file  for messages
/// @param seam_length  aimed at along seams and darts, m, growing to edge_length away
/// from them; 0 for edge_length everywhere
/// @param memory  may be null; holds the panels of this mesh afterwards
/// @throws Error INPUT where a panel cannot be meshed
PanelMesh mesh_pattern(const Pattern& pattern, double edge_length, const std::string& file,
                       double seam_length = 0, MeshMemory* memory = nullptr);

} // namespace sloper::pattern

#pragma once
/// Which panels of a mesh are sewn to each other, and along which stitches.
#include <sloper/pattern/panel_mesh.hpp>

#include <array>
#include <cstddef>
#include <vector>

namespace sloper::pattern {

/// Panel-level view of a mesh's seams.
class SeamGraph {
public:
  explicit SeamGraph(const PanelMesh& mesh);
  int panel_of(int vertex) const { return m_panel_of[vertex]; }
  /// Stitches between panels p and q: pairs (vertex of p, vertex of q), by seam. For p = q each
  /// stitch once.
  std::vector<std::vector<std::array<int, 2>>> between(int p, int q) const;
  const std::vector<int>& neighbours(int p) const {
    return m_neighbours[p];
  } ///< ascending, without p

private:
  const PanelMesh* m_mesh;
  std::vector<int> m_panel_of;
  std::vector<std::vector<int>> m_neighbours;
};

} // namespace sloper::pattern

#pragma once
/// Panels as one surface, welded along their seams, on which a tailor's tape is laid: levels,
/// girths and paths along the cloth. Every triangle keeps the shape that it is drawn with, so that
/// nothing of it depends on where panels lie on the table.
#include <pattern/roles/panel_role.hpp>
#include <pattern/seam_graph.hpp>
#include <sloper/pattern/panel_mesh.hpp>

#include <functional>

namespace sloper::pattern {

/// One value for each vertex of the mesh, the same for those that are sewn together; NaN away from
/// the cloth.
using Field = std::vector<double>;

/// The surface that panels sewn together make.
class SewnCloth {
public:
  /// @param panels  which of the mesh's panels the cloth is made of, #panels
  SewnCloth(const PanelMesh& mesh, std::vector<bool> panels);

  int welded(int vertex) const {
    return m_weld[vertex];
  } ///< the same for vertices that are sewn together

  /// Height whose slope is as close as can be to that of each panel's v axis: level lines run on
  /// from panel to panel, with darts closed.
  /// @param wanted  what else tells how high pieces lie that are not joined: v of each vertex
  /// @param weight  how much a panel's v axis counts; empty: all count the same
  Field height(const std::vector<PanelRole>& roles, const Field& wanted,
               const std::function<double(int)>& weight) const;
  /// Shortest path along the cloth from what has a value in `start`, in addition to that value, m.
  /// NaN in `start`: to be found.
  Field distance_from(const Field& start) const;

  struct Ring {
    double length = 0;  ///< m, of all cloth on the level
    bool whole = false; ///< it goes around: it ends nowhere, or at upright edges only, such as
                        ///< those of an open front
  };
  /// @param panel  of these only; empty for all
  Ring around(const Field& field, double level, const std::function<bool(int)>& panel = {}) const;

private:
  template<class F> void each_triangle(const F& visit) const;
  const PanelMesh& m_mesh;
  std::vector<bool> m_panels;
  std::vector<int> m_weld;
};

/// Of the trunk's panels those of the layer with the most cloth that are sewn together: no lining
/// under them, no pocket on them, no second garment. #panels
std::vector<bool> trunk_cloth(const PanelMesh& mesh, const SeamGraph& graph,
                              const std::vector<PanelRole>& roles);

} // namespace sloper::pattern

#include <pattern/seam_graph.hpp>

#include <set>

namespace sloper::pattern {

SeamGraph::SeamGraph(const PanelMesh& mesh)
    : m_mesh(&mesh), m_panel_of(mesh.pattern.size()), m_neighbours(mesh.panels.size()) {
  for (std::size_t p = 0; p < mesh.panels.size(); ++p)
    for (int v = mesh.panels[p].first_vertex;
         v < mesh.panels[p].first_vertex + mesh.panels[p].n_vertices; ++v)
      m_panel_of[v] = static_cast<int>(p);
  std::vector<std::set<int>> sets(mesh.panels.size());
  for (const MeshSeam& s : mesh.seams)
    for (std::size_t k = 0; k < s.a.size(); ++k) {
      const int p = panel_of(s.a[k]), q = panel_of(s.b[k]);
      if (p != q) {
        sets[p].insert(q);
        sets[q].insert(p);
      }
    }
  for (std::size_t p = 0; p < sets.size(); ++p)
    m_neighbours[p].assign(sets[p].begin(), sets[p].end());
}

std::vector<std::vector<std::array<int, 2>>> SeamGraph::between(int p, int q) const {
  std::vector<std::vector<std::array<int, 2>>> out;
  for (const MeshSeam& s : m_mesh->seams) {
    std::vector<std::array<int, 2>> stitches;
    for (std::size_t k = 0; k < s.a.size(); ++k) {
      const int a = panel_of(s.a[k]), b = panel_of(s.b[k]);
      if (a == p && b == q)
        stitches.push_back({s.a[k], s.b[k]});
      else if (a == q && b == p)
        stitches.push_back({s.b[k], s.a[k]});
    }
    if (stitches.size() >= 2)
      out.push_back(std::move(stitches));
  }
  return out;
}

} // namespace sloper::pattern

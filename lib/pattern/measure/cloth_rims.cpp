#include <pattern/measure/cloth_rims.hpp>
#include <sloper/geometry/disjoint_sets.hpp>

#include <cmath>
#include <map>

namespace sloper::pattern {
namespace {

constexpr int FREE = -1, LAYERED = -2; // what lies across a side of a triangle

/// Sides of triangles, numbered 3 t + k, with all seams closed.
class WeldedSides {
public:
  explicit WeldedSides(const PanelMesh& mesh) : m_mesh(mesh), m_weld(mesh.pattern.size()) {
    for (const MeshSeam& s : mesh.seams)
      for (std::size_t k = 0; k < s.a.size(); ++k)
        m_weld.unite_into(s.a[k], s.b[k]);
    for (int side = 0; side < count(); ++side)
      m_sides[{m_weld.find(from(side)), m_weld.find(to(side))}].push_back(side);
  }

  int count() const { return 3 * static_cast<int>(m_mesh.triangles.size()); }
  int from(int side) const { return m_mesh.triangles[side / 3][side % 3]; }
  int to(int side) const { return from(after(side)); }
  /// The next one of its triangle.
  static int after(int side) { return side - side % 3 + (side % 3 + 1) % 3; }
  double length(int side) const {
    return (m_mesh.pattern[to(side)] - m_mesh.pattern[from(side)]).norm();
  }
  /// Of the triangle, where a side begins, rad.
  double angle(int side) const {
    const Vec2 corner = m_mesh.pattern[from(side)], a = m_mesh.pattern[to(side)] - corner,
               b = m_mesh.pattern[from(after(after(side)))] - corner;
    return std::abs(std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b)));
  }
  int across(int side) const {
    const int a = m_weld.find(from(side)), b = m_weld.find(to(side));
    const auto other = m_sides.find({b, a});
    if (other == m_sides.end())
      return m_sides.at({a, b}).size() == 1 ? FREE : LAYERED;
    const bool two = other->second.size() == 1 && m_sides.at({a, b}).size() == 1;
    return two ? other->second[0] : LAYERED;
  }

private:
  const PanelMesh& m_mesh;
  DisjointSets m_weld;
  std::map<std::pair<int, int>, std::vector<int>> m_sides; ///< by their welded ends
};

/// Around the end of a free side through the cloth to the free side that follows it; LAYERED where
/// three layers meet.
int turn_around(const WeldedSides& sides, int arriving, RimVertex& vertex) {
  constexpr int MOST_TRIANGLES = 10000; // around one vertex
  std::vector<double> pieces(1, 0.0);
  int side = WeldedSides::after(arriving);
  for (int n = 0; n < MOST_TRIANGLES; ++n) {
    pieces.back() += sides.angle(side);
    const int across = sides.across(side);
    if (across == LAYERED)
      return LAYERED;
    if (across == FREE) {
      for (double angle : pieces)
        vertex.cloth += angle;
      vertex.cloth_arriving = pieces.front();
      vertex.cloth_leaving = pieces.back();
      vertex.pieces = static_cast<int>(pieces.size());
      vertex.arriving = sides.to(arriving);
      vertex.leaving = sides.from(side);
      vertex.to_next = sides.length(side);
      return side;
    }
    const int next = WeldedSides::after(across);
    if (sides.from(next) != sides.from(side))
      pieces.push_back(0);
    side = next;
  }
  return LAYERED;
}

} // namespace

std::vector<ClothRim> cloth_rims(const PanelMesh& mesh) {
  const WeldedSides sides(mesh);
  std::vector<char> met(static_cast<std::size_t>(sides.count()), 0);
  std::vector<ClothRim> out;
  for (int first = 0; first < sides.count(); ++first) {
    if (met[first] || sides.across(first) != FREE)
      continue;
    ClothRim rim;
    int side = first;
    do {
      met[side] = 1;
      rim.length += sides.length(side);
      side = turn_around(sides, side, rim.vertices.emplace_back());
    } while (side >= 0 && !met[side]);
    if (side == first)
      out.push_back(std::move(rim));
  }
  return out;
}

int panel_of_vertex(const PanelMesh& mesh, int vertex) {
  int panel = 0;
  while (vertex >= mesh.panels[panel].first_vertex + mesh.panels[panel].n_vertices)
    ++panel;
  return panel;
}

std::string edge_nearest_to(const Panel& panel, const Vec2& p) {
  double least = 1e300;
  std::string name;
  for (int e = 0; e < panel.n_edges(); ++e) {
    const ArcLength arc(panel.edge(e).path);
    for (int k = 0; k <= 64; ++k)
      if (const double d = (arc.at(arc.length() * k / 64) - p).norm(); d < least - 1e-9) {
        least = d;
        name = panel.edge(e).name;
      }
  }
  return name;
}

} // namespace sloper::pattern

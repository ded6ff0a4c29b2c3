#pragma once
/// Small patterns for the tests, and questions that several tests ask of a mesh.
#include <sloper/io/json.hpp>
#include <sloper/pattern/mesh/mesh_pattern.hpp>
#include <sloper/pattern/read/read_pattern.hpp>

#include <algorithm>
#include <fstream>
#include <map>
#include <numeric>
#include <string>

namespace sloper::pattern::test {

inline Pattern own(const std::string& text) {
  Pattern p = read_pattern_json(io::parse_json(text, "test.json"), "test.json");
  finish_pattern(p, "test.json");
  return p;
}

/// A front and a back of 40 x 60 cm, sewn at both sides.
inline std::string tube_text(const std::string& extra_seams = "") {
  const std::string panel =
      R"("outline": [{"edge": "hem", "path": [["M", -20, 0], ["L", 20, 0]]}, {"edge": "side_l", "path": [["L", 20, 60]]},
      {"edge": "top", "path": [["L", -20, 60]]}, {"edge": "side_r", "path": [["L", -20, 0]]}])";
  return R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "tube", "panels": [{"name": "front", )" +
         panel + R"(}, {"name": "back", )" + panel +
         R"(}], "seams": [{"name": "left", "a": [{"panel": "front", "edge": "side_l"}], "b": [{"panel": "back", "edge": "side_r"}]},
      {"name": "right", "a": [{"panel": "back", "edge": "side_l"}], "b": [{"panel": "front", "edge": "side_r"}]})" +
         extra_seams + "]}";
}

/// What welding the seams makes of a mesh.
struct Sewn {
  std::vector<int> weld;   ///< class of each vertex
  int degenerate = 0;      ///< triangles with two corners in one class
  int duplicate_faces = 0; ///< triangles with the same three classes
  int wrong_direction =
      0;                ///< directed edges used twice: neighbours that do not agree on the outside
  int non_manifold = 0; ///< edges of more than two triangles
  int boundary_loops = 0;
};

inline Sewn sew(const PanelMesh& mesh) {
  Sewn out;
  out.weld.resize(mesh.pattern.size());
  std::iota(out.weld.begin(), out.weld.end(), 0);
  const auto find = [&](int v) {
    while (out.weld[v] != v)
      v = out.weld[v];
    return v;
  };
  for (const MeshSeam& s : mesh.seams)
    for (std::size_t k = 0; k < s.a.size(); ++k) {
      const int a = find(s.a[k]), b = find(s.b[k]);
      out.weld[std::max(a, b)] = std::min(a, b);
    }
  for (std::size_t v = 0; v < out.weld.size(); ++v)
    out.weld[v] = find(static_cast<int>(v));
  std::map<std::pair<int, int>, int> directed, undirected;
  std::map<Triangle, int> faces;
  for (const Triangle& t : mesh.triangles) {
    Triangle w{out.weld[t[0]], out.weld[t[1]], out.weld[t[2]]};
    if (w[0] == w[1] || w[1] == w[2] || w[2] == w[0])
      ++out.degenerate;
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = w[k], b = w[(k + 1) % 3];
      if (++directed[{a, b}] > 1)
        ++out.wrong_direction;
      if (++undirected[{std::min(a, b), std::max(a, b)}] > 2)
        ++out.non_manifold;
    }
    std::sort(w.begin(), w.end());
    if (++faces[w] > 1)
      ++out.duplicate_faces;
  }
  std::map<int, std::vector<int>> open;
  for (const auto& [edge, n] : undirected)
    if (n == 1) {
      open[edge.first].push_back(edge.second);
      open[edge.second].push_back(edge.first);
    }
  std::map<int, bool> seen;
  for (const auto& [start, ends] : open) {
    if (seen[start])
      continue;
    ++out.boundary_loops;
    std::vector<int> stack = {start};
    while (!stack.empty()) {
      const int v = stack.back();
      stack.pop_back();
      if (seen[v])
        continue;
      seen[v] = true;
      for (int w : open[v])
        stack.push_back(w);
    }
  }
  return out;
}

inline double mesh_area(const PanelMesh& mesh, const PanelInfo& panel) {
  double sum = 0;
  for (int t = panel.first_triangle; t < panel.first_triangle + panel.n_triangles; ++t) {
    const Triangle& tri = mesh.triangles[t];
    const Vec2 &a = mesh.pattern[tri[0]], &b = mesh.pattern[tri[1]], &c = mesh.pattern[tri[2]];
    sum += 0.5 * ((b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x()));
  }
  return sum;
}

inline double outline_area(const Panel& panel) {
  double sum = 0;
  for (const auto& loop : panel.loops) {
    std::vector<Path> paths;
    for (const PanelEdge& e : loop)
      paths.push_back(e.path);
    sum += signed_area(paths);
  }
  return sum;
}

} // namespace sloper::pattern::test

#pragma once
/// Small patterns and a body that tests of placing share, and where panels went.
#include <support/pattern_texts.hpp>
#include <support/stick_body.hpp>

#include <cmath>
#include <sloper/pattern/panel_mesh.hpp>

namespace sloper::pattern::test {

/// A panel of the own format, cm: edges hem, l, top, r.
inline std::string rectangle(const std::string& name, double w, double h) {
  return R"({"name": ")" + name + R"(", "outline": [{"edge": "hem", "path": [["M", 0, 0], ["L", )" +
         std::to_string(w) + R"(, 0]]}, {"edge": "l", "path": [["L", )" + std::to_string(w) + ", " +
         std::to_string(h) + R"(]]}, {"edge": "top", "path": [["L", 0, )" + std::to_string(h) +
         R"(]]}, {"edge": "r", "path": [["L", 0, 0]]}]})";
}

/// A skirt of two rectangles, each this wide, cm.
inline Pattern box_skirt(double width) {
  return own(
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "skirt", "panels": [)" +
      rectangle("skirt_front", width, 12) + "," + rectangle("skirt_back", width, 12) +
      R"(], "seams": [{"name": "a", "a": [{"panel": "skirt_front", "edge": "l"}], "b": [{"panel": "skirt_back", "edge": "r"}]},
                             {"name": "b", "a": [{"panel": "skirt_back", "edge": "l"}], "b": [{"panel": "skirt_front", "edge": "r"}]}]})");
}

/// The stick body with a waist: a fifth narrower at 1.05 m.
inline body::Body waisted_body() {
  body::Body body = stick_body(45);
  std::vector<char> torso(body.skin.positions.size(), 0);
  for (std::size_t t = 0; t < body.skin.triangles.size(); ++t)
    if (body.face_part[t] == body::Part::TORSO)
      for (int v : body.skin.triangles[t])
        torso[v] = 1;
  for (std::size_t k = 0; k < torso.size(); ++k)
    if (torso[k]) {
      Vec3& p = body.skin.positions[k];
      const double narrow = 1 - 0.2 * std::exp(-std::pow((p.y() - 1.05) / 0.1, 2));
      p.x() *= narrow;
      p.z() *= narrow;
    }
  return body;
}

/// Mean of a panel's placed vertices, m.
inline Vec3 middle(const PanelMesh& mesh, int panel) {
  Vec3 sum = Vec3::Zero();
  const PanelInfo& p = mesh.panels[panel];
  for (int v = p.first_vertex; v < p.first_vertex + p.n_vertices; ++v)
    sum += mesh.placed[v];
  return sum / p.n_vertices;
}

inline double top_of(const PanelMesh& mesh) {
  double top = -1e300;
  for (const Vec3& p : mesh.placed)
    top = std::max(top, p.y());
  return top;
}

} // namespace sloper::pattern::test

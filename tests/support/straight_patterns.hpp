#pragma once
/// Patterns of straight edges, drawn by the tests that work out by hand what comes of them.
#include <support/pattern_texts.hpp>

namespace sloper::pattern::test {

struct DrawnEdge {
  const char* name;
  double x, y; ///< cm, where it ends
};

/// A panel whose outline starts where its last edge ends.
inline std::string panel_text(const std::string& name, const std::vector<DrawnEdge>& edges) {
  std::string text = R"({"name": ")" + name + R"(", "outline": [)";
  const auto point = [](double x, double y) {
    return std::to_string(x) + ", " + std::to_string(y) + "]";
  };
  for (std::size_t k = 0; k < edges.size(); ++k)
    text += std::string(k ? ", " : "") + R"({"edge": ")" + edges[k].name + R"(", "path": [)" +
            (k ? std::string() : R"(["M", )" + point(edges.back().x, edges.back().y) + ", ") +
            R"(["L", )" + point(edges[k].x, edges[k].y) + "]}";
  return text + "]}";
}

/// The same seen in a mirror: edges run the other way round.
inline std::vector<DrawnEdge> seen_in_mirror(const std::vector<DrawnEdge>& edges) {
  std::vector<DrawnEdge> out;
  for (std::size_t k = edges.size(); k-- > 0;) {
    const DrawnEdge& end = edges[(k + edges.size() - 1) % edges.size()];
    out.push_back({edges[k].name, -end.x, end.y});
  }
  return out;
}

class DrawnPattern {
public:
  void panel(const std::string& name, const std::vector<DrawnEdge>& edges) {
    m_panels += (m_panels.empty() ? "" : ",\n") + panel_text(name, edges);
  }
  void seam(const std::string& p, const std::string& e, const std::string& q,
            const std::string& f) {
    m_seams += (m_seams.empty() ? "" : ",\n") + (R"({"name": ")" + p + e) +
               R"(", "a": [{"panel": ")" + p + R"(", "edge": ")" + e + R"("}], "b": [{"panel": ")" +
               q + R"(", "edge": ")" + f + R"("}]})";
  }
  /// Four quarters: a left front and a right back as drawn, the others in the mirror.
  void quarters(const std::vector<DrawnEdge>& edges, const std::vector<const char*>& sides,
                const std::vector<const char*>& middles) {
    for (const char* name : {"front_l", "back_r"})
      panel(name, edges);
    for (const char* name : {"front_r", "back_l"})
      panel(name, seen_in_mirror(edges));
    for (const char* edge : sides) {
      seam("front_l", edge, "back_l", edge);
      seam("front_r", edge, "back_r", edge);
    }
    for (const char* edge : middles) {
      seam("front_l", edge, "front_r", edge);
      seam("back_l", edge, "back_r", edge);
    }
  }
  Pattern pattern() const {
    return own(
        R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "t", "panels": [)" +
        m_panels + R"(], "seams": [)" + m_seams + "]}");
  }

private:
  std::string m_panels, m_seams;
};

} // namespace sloper::pattern::test

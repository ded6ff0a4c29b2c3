#include <sloper/base/units.hpp>
#include <sloper/collision/triangle_tree.hpp>
#include <sloper/garment/simulate/roll_line_states.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/mesh/folds.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::garment {

namespace {

constexpr double REACH = 0.02;           // m before the line, in the pattern
constexpr double TURNED = units::PI / 3; // a collar that lies out on the shoulders is turned over
// Shares of the leaf that is turned. Chosen on twelve shirt collars of 3 to 7 cm and one jacket,
// with none kept back: what was left standing had 0 to 0.13; a lapel of the jacket, which stands at
// its narrow end and rolls softly near its line, 0.64.
constexpr double STANDING = 0.25; // below: the line did not turn
constexpr double MOSTLY = 0.5;    // below: it turned in part, which is a warning
constexpr int SAMPLES = 200;      // of a line, for its direction
constexpr double BESIDE = 0.035;  // m from a leaf within which cloth that it lies on is looked for
// Cosine between the nearest cloth's normal and the direction from it: beside a free edge less,
// and there the angle alone says to which side cloth is turned.
constexpr double ABOVE = 0.7;

/// Least and greatest coordinates of points in the plane.
struct Extent {
  Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
  void add(const Vec2& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  Vec2 size() const { return high - low; }
};

Extent extent_of(const pattern::Panel& panel) {
  constexpr int SAMPLES_OF_EDGE = 32;
  Extent out;
  for (const pattern::PanelEdge& edge : panel.loops.front()) {
    const pattern::ArcLength arc(edge.path);
    for (int k = 0; k <= SAMPLES_OF_EDGE; ++k)
      out.add(arc.at(arc.length() * k / SAMPLES_OF_EDGE));
  }
  return out;
}

/// Where the vertices lie in the pattern that the mesh knows. keep-fit changes the mesh and not
/// that pattern: where a panel is of another size than drawn, its vertices go back by their stable
/// ids, or the lines would run beside their edges.
std::vector<Vec2> places_as_drawn(const pattern::PanelMesh& mesh) {
  std::vector<Vec2> places = mesh.pattern;
  for (std::size_t p = 0; p < mesh.panels.size(); ++p) {
    const pattern::PanelInfo& panel = mesh.panels[p];
    const Extent drawn = extent_of(mesh.source->panels[p]);
    Extent meshed;
    for (int v = panel.first_vertex; v < panel.first_vertex + panel.n_vertices; ++v)
      meshed.add(mesh.pattern[v]);
    if ((meshed.low - drawn.low).norm() < pattern::LINE_ON_EDGE &&
        (meshed.high - drawn.high).norm() < pattern::LINE_ON_EDGE)
      continue;
    for (int v = panel.first_vertex; v < panel.first_vertex + panel.n_vertices; ++v)
      places[v] = drawn.low + Vec2(mesh.ids[v].s, mesh.ids[v].t).cwiseProduct(drawn.size());
  }
  return places;
}

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// The turn of one triangle beyond the line.
struct Turn {
  double angle, weight; ///< rad, below 0 inwards; and area times distance from the line, m3
};

/// Cloth that a leaf may lie on: all that is not beyond one of the panel's lines.
class OtherCloth {
public:
  OtherCloth(const Garment& garment, std::vector<Triangle> triangles)
      : m_triangles(std::move(triangles)), m_tree(garment.position, m_triangles),
        m_normals(vertex_normals({garment.position, m_triangles})) {}

  /// @return 1 where a place lies outside of the nearest cloth, -1 inside, 0 where that is not said
  int side_of(const Vec3& at) const {
    const collision::ClosestPoint near = m_tree.closest_point(at, BESIDE);
    if (near.triangle < 0)
      return 0;
    const Triangle& t = m_triangles[near.triangle];
    Vec3 normal = Vec3::Zero();
    for (std::size_t k = 0; k < t.size(); ++k)
      normal += near.barycentric[static_cast<int>(k)] * m_normals[t[k]];
    const Vec3 off = at - near.point;
    const double above = off.dot(normal.normalized());
    if (std::abs(above) < ABOVE * off.norm())
      return 0;
    return above < 0 ? -1 : 1;
  }

private:
  std::vector<Triangle> m_triangles;
  collision::TriangleTree m_tree;
  std::vector<Vec3> m_normals;
};

/// An edge of the mesh along the line, and how the cloth goes that comes to it.
struct LineEdge {
  Vec2 middle, left; ///< in the pattern, m: its middle, and the unit normal to the turned side
  Vec3 along, to, outside; ///< on the body, unit: of the edge, across it, and out of the cloth
};

/// One roll line on the cloth.
class RolledLine {
public:
  RolledLine(const Garment& garment, const std::vector<Triangle>& triangles,
             const pattern::PanelInfo& panel, const pattern::Path& path)
      : m_garment(garment), m_triangles(triangles), m_panel(panel) {
    const pattern::ArcLength arc(path);
    for (int k = 0; k <= SAMPLES; ++k) {
      m_points.push_back(arc.at(arc.length() * k / SAMPLES));
      m_tangents.push_back(arc.tangent(arc.length() * k / SAMPLES));
    }
    for (const std::array<int, 2>& edge : pattern::edges_along(garment.panels, panel, path))
      add(edge);
    find_leaf();
  }
  const std::vector<int>& leaf() const { return m_leaf; } ///< triangles beyond the line

  /// How each triangle of the leaf is turned.
  std::vector<Turn> turns(const OtherCloth& other) const {
    std::vector<Turn> out;
    for (const int f : m_leaf) {
      const LineEdge& edge = nearest_edge(middle(f));
      const Vec3 on = carried(f, edge.left);
      const double out_of = on.dot(edge.outside);
      const double angle = std::atan2(std::abs(out_of), on.dot(edge.to));
      int side = out_of < 0 ? -1 : 1;
      if (angle > TURNED) // nearly back on itself a direction says little
        if (const int lies = other.side_of(hung_middle(f)); lies != 0)
          side = lies;
      out.push_back({side * angle, (middle(f) - edge.middle).dot(edge.left) * area(f)});
    }
    return out;
  }

private:
  const Vec2& flat(int v) const { return m_garment.panels.pattern[v]; }
  const Vec3& hung(std::size_t f, std::size_t k) const {
    return m_garment.position[m_triangles[f][k]];
  }
  Vec3 normal(std::size_t f) const {
    return (hung(f, 1) - hung(f, 0)).cross(hung(f, 2) - hung(f, 0));
  }
  Vec2 middle(int f) const {
    const Triangle& t = m_garment.panels.triangles[f];
    return (flat(t[0]) + flat(t[1]) + flat(t[2])) / 3;
  }
  Vec3 hung_middle(int f) const { return (hung(f, 0) + hung(f, 1) + hung(f, 2)) / 3; }
  double area(int f) const {
    const Triangle& t = m_garment.panels.triangles[f];
    return 0.5 * cross(flat(t[1]) - flat(t[0]), flat(t[2]) - flat(t[0]));
  }

  /// Where a direction of the pattern goes on the body, in a triangle of the panel.
  Vec3 carried(int f, const Vec2& direction) const {
    const Triangle& t = m_garment.panels.triangles[f];
    const Vec2 a = flat(t[1]) - flat(t[0]), b = flat(t[2]) - flat(t[0]);
    return (cross(direction, b) * (hung(f, 1) - hung(f, 0)) +
            cross(a, direction) * (hung(f, 2) - hung(f, 0))) /
           cross(a, b);
  }

  Vec2 tangent_near(const Vec2& p) const {
    std::size_t nearest = 0;
    for (std::size_t k = 1; k < m_points.size(); ++k)
      if ((m_points[k] - p).squaredNorm() < (m_points[nearest] - p).squaredNorm())
        nearest = k;
    return m_tangents[nearest];
  }

  void add(const std::array<int, 2>& edge) {
    const auto& x = m_garment.position;
    const Vec3 &a = x[m_garment.particle_of[edge[0]]], &b = x[m_garment.particle_of[edge[1]]];
    LineEdge out;
    out.middle = 0.5 * (flat(edge[0]) + flat(edge[1]));
    const Vec2 tangent = tangent_near(out.middle);
    out.left = Vec2(-tangent.y(), tangent.x());
    out.along = (b - a).normalized();
    Vec3 to = Vec3::Zero(), outside = Vec3::Zero();
    for (int f = m_panel.first_triangle; f < m_panel.first_triangle + m_panel.n_triangles; ++f) {
      const Vec2 at = middle(f) - out.middle;
      const Triangle& t = m_garment.panels.triangles[f];
      const bool has_edge = std::count(t.begin(), t.end(), edge[0]) > 0 &&
                            std::count(t.begin(), t.end(), edge[1]) > 0;
      if (at.dot(out.left) > 0 || (!has_edge && at.norm() > REACH))
        continue;
      to += area(f) * carried(f, out.left);
      outside += normal(f);
    }
    if (to.isZero())
      add_sewn(edge, 0.5 * (a + b), to, outside);
    if (to.isZero())
      return;
    to -= to.dot(out.along) * out.along;
    out.to = to.normalized();
    outside -= outside.dot(out.along) * out.along + outside.dot(out.to) * out.to;
    out.outside = outside.normalized();
    m_edges.push_back(out);
  }

  /// Adds cloth of other panels at an edge whose middle is there.
  void add_sewn(const std::array<int, 2>& edge, const Vec3& there, Vec3& to, Vec3& outside) const {
    for (std::size_t f = 0; f < m_triangles.size(); ++f) {
      const int own = static_cast<int>(f) - m_panel.first_triangle;
      const Triangle& t = m_triangles[f];
      const bool meets = std::any_of(edge.begin(), edge.end(), [&](int v) {
        return std::count(t.begin(), t.end(), m_garment.particle_of[v]) > 0;
      });
      const bool is_own = own >= 0 && own < m_panel.n_triangles;
      if (!meets || is_own)
        continue;
      to += there - (hung(f, 0) + hung(f, 1) + hung(f, 2)) / 3;
      outside += normal(f);
    }
  }

  const LineEdge& nearest_edge(const Vec2& at) const {
    return *std::min_element(m_edges.begin(), m_edges.end(),
                             [&](const LineEdge& a, const LineEdge& b) {
                               return (a.middle - at).squaredNorm() < (b.middle - at).squaredNorm();
                             });
  }

  void find_leaf() {
    for (int f = m_panel.first_triangle;
         !m_edges.empty() && f < m_panel.first_triangle + m_panel.n_triangles; ++f) {
      const LineEdge& edge = nearest_edge(middle(f));
      if ((middle(f) - edge.middle).dot(edge.left) > 0)
        m_leaf.push_back(f);
    }
  }

  const Garment& m_garment;
  const std::vector<Triangle>& m_triangles;
  const pattern::PanelInfo& m_panel;
  std::vector<Vec2> m_points, m_tangents;
  std::vector<LineEdge> m_edges;
  std::vector<int> m_leaf;
};

void measure(std::vector<Turn> turns, RollLineState& out) {
  std::sort(turns.begin(), turns.end(),
            [](const Turn& a, const Turn& b) { return a.angle < b.angle; });
  double all = 0, turned = 0, inwards = 0;
  for (const Turn& t : turns) {
    all += t.weight;
    turned += t.angle > TURNED ? t.weight : 0;
    inwards += t.angle < -TURNED ? t.weight : 0;
  }
  out.turned_share = turned / all;
  out.inwards_share = inwards / all;
  out.turn = turns[turns.size() / 2].angle;
}

} // namespace

bool RollLineState::is_turned() const {
  return turned_share >= MOSTLY;
}
bool RollLineState::stands() const {
  return turned_share < STANDING;
}

static bool has_roll_lines(const pattern::Pattern& pattern) {
  for (const pattern::Panel& panel : pattern.panels)
    for (const pattern::InnerLine& line : panel.lines)
      if (line.kind == "roll")
        return true;
  return false;
}

std::vector<RollLineState> roll_line_states(const Garment& worn) {
  std::vector<RollLineState> out;
  const bool knows = worn.panels.source &&
                     worn.panels.source->panels.size() == worn.panels.panels.size() &&
                     worn.particle_of.size() == worn.panels.pattern.size();
  if (!knows || !has_roll_lines(*worn.panels.source))
    return out;
  Garment garment = worn;
  garment.panels.pattern = places_as_drawn(worn.panels);
  const pattern::PanelMesh& panels = garment.panels;
  const std::vector<Triangle> triangles = garment.particle_triangles();
  std::vector<RolledLine> lines;
  std::vector<char> is_leaf(triangles.size(), 0);
  for (std::size_t p = 0; p < panels.panels.size(); ++p)
    for (const pattern::InnerLine& line : panels.source->panels[p].lines) {
      if (line.kind != "roll")
        continue;
      RolledLine rolled(garment, triangles, panels.panels[p], line.path);
      if (rolled.leaf().empty())
        continue;
      for (const int f : rolled.leaf())
        is_leaf[f] = 1;
      lines.push_back(std::move(rolled));
      out.emplace_back();
      out.back().panel = panels.panels[p].name;
      out.back().line = line.name;
    }
  if (lines.empty())
    return out;
  std::vector<Triangle> others;
  for (std::size_t f = 0; f < triangles.size(); ++f)
    if (!is_leaf[f])
      others.push_back(triangles[f]);
  const OtherCloth other(garment, std::move(others));
  for (std::size_t k = 0; k < lines.size(); ++k)
    measure(lines[k].turns(other), out[k]);
  return out;
}

io::Json roll_lines_json(const std::vector<RollLineState>& states) {
  io::Json out = io::Json::array();
  for (const RollLineState& state : states)
    out.push_back({{"panel", state.panel},
                   {"line", state.line},
                   {"turned", state.is_turned()},
                   {"turned_share", state.turned_share},
                   {"inwards_share", state.inwards_share},
                   {"turn_deg", units::degrees(state.turn)}});
  return out;
}

std::string turned_text(const RollLineState& state) {
  return "roll line " + state.line + " of panel " + state.panel + " turned over " +
         std::to_string(std::lround(100 * state.turned_share)) + " % of what lies beyond it" +
         (state.inwards_share >= STANDING
              ? ", and " + std::to_string(std::lround(100 * state.inwards_share)) + " % inwards"
              : "");
}

std::string standing_text(const std::vector<RollLineState>& states) {
  for (const RollLineState& state : states)
    if (state.stands())
      return turned_text(state);
  return "";
}

} // namespace sloper::garment

/// Chest, waist, hip and lengths of the finished garment, from its panels laid beside each other as for placement.
#include <pattern/finished_measures.hpp>
#include <pattern/panel_layout.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::pattern {
namespace {

constexpr double BELOW = 0.025; // m below armhole, crotch or sleeve seam

class Measurer {
public:
  Measurer(const Pattern& pattern, const PanelMesh& mesh, const std::vector<Opening>& openings)
      : m_pattern(pattern), m_mesh(mesh), m_openings(openings), m_graph(mesh), m_roles(panel_roles(pattern, mesh, m_graph)),
        m_spots(lay_out(pattern, mesh, m_graph, m_roles)) {}

  std::vector<NamedMeasure> run() {
    for (std::size_t k = 0; k < m_roles.size(); ++k)
      if (m_roles[k].region == Region::TRUNK) {
        const auto b = laid_bounds(m_mesh, m_roles[k], m_spots[k], static_cast<int>(k));
        m_top = std::max(m_top, b[1].y()), m_bottom = std::min(m_bottom, b[0].y());
      }
    if (m_top <= m_bottom || m_mesh.seams.empty()) return {}; // pieces of cloth
    const double shoulder = shoulders();
    if (shoulder > 0) upper(shoulder);
    else lower();
    add("length", height(), "from the highest point straight down to the hem");
    sides();
    if (shoulder > 0) opening("neck", true);
    opening("hem", false);
    sleeve();
    return std::move(m_out);
  }

private:
  void add(const std::string& name, double value, const std::string& how) {
    if (value > 0.01) m_out.push_back({name, value, how});
  }
  Vec2 at(std::size_t k, int v) const { return laid(m_mesh, m_roles[k], m_spots[k], v); }
  bool arm(std::size_t k) const { return m_roles[k].region == Region::ARM_L || m_roles[k].region == Region::ARM_R; }

  double around(double v, Region region = Region::TRUNK, const std::string& part = "") const {
    double widest = 0; // rows of panels are laid a little apart: look around the gap
    for (double off : {-0.012, -0.006, 0.0, 0.006, 0.012}) {
      double sum = 0;
      for (std::size_t k = 0; k < m_roles.size(); ++k)
        if (m_roles[k].region == region && (part.empty() || m_roles[k].part == part))
          sum += pattern::covered(m_mesh, m_roles[k], m_spots[k], static_cast<int>(k), v + (around_gap(v, region) ? off : 0));
      widest = std::max(widest, sum);
    }
    return widest;
  }
  /// Of the cloth between top and bottom: panels are laid a little apart.
  double height() const {
    constexpr double STEP = 0.001;
    double sum = 0;
    for (double v = m_top - 0.5 * STEP; v > m_bottom; v -= STEP) {
      bool cloth = false;
      for (std::size_t k = 0; k < m_roles.size() && !cloth; ++k)
        cloth = m_roles[k].region == Region::TRUNK && pattern::covered(m_mesh, m_roles[k], m_spots[k], static_cast<int>(k), v) > 0;
      sum += cloth ? STEP : 0;
    }
    return sum;
  }
  /// Whether a panel begins or ends near a level.
  bool around_gap(double v, Region region) const {
    for (std::size_t k = 0; k < m_roles.size(); ++k) {
      if (m_roles[k].region != region) continue;
      const auto b = laid_bounds(m_mesh, m_roles[k], m_spots[k], static_cast<int>(k));
      if (std::abs(b[0].y() - v) < 0.013 || std::abs(b[1].y() - v) < 0.013) return true;
    }
    return false;
  }

  /// (level, girth) of the narrowest or widest level between two heights; girth 0 where the garment does not reach.
  std::pair<double, double> extreme(double high, double low, bool widest) const {
    std::pair<double, double> best{0, 0};
    for (double v = high; v >= std::max(low, m_bottom + 0.005); v -= 0.01) {
      const double girth = around(v);
      if (girth > 0 && (best.second == 0 || (widest ? girth > best.second : girth < best.second))) best = {v, girth};
    }
    return best;
  }

  /// Length of a shoulder seam, 0 where the garment has none: a level seam of front and back near the top. Sleeves and collars hang on
  /// shoulders too.
  double shoulders() const {
    double length = 0;
    bool hung = false;
    for (std::size_t k = 0; k < m_roles.size(); ++k) {
      hung = hung || m_roles[k].region != Region::TRUNK;
      if (m_roles[k].region != Region::TRUNK || m_roles[k].side != Side::FRONT) continue;
      for (int q : m_graph.neighbours(static_cast<int>(k))) {
        const PanelRole& other = m_roles[static_cast<std::size_t>(q)];
        if (other.region != Region::TRUNK || other.side != Side::BACK) continue;
        for (const auto& seam : m_graph.between(static_cast<int>(k), q)) {
          const Vec2 a = at(k, seam.front()[0]), b = at(k, seam.back()[0]);
          if (std::abs(a.x() - b.x()) > 1.2 * std::abs(a.y() - b.y()) && std::min(a.y(), b.y()) > m_top - 0.15) length = std::max(length, (a - b).norm());
        }
      }
    }
    return length > 0 ? length : hung ? 1e-6 : 0;
  }

  /// Upper end of the longest upright seam between front and back; the top where there is none.
  double armhole() const {
    double level = -1e300, longest = 0;
    for (std::size_t k = 0; k < m_roles.size(); ++k) {
      if (m_roles[k].region != Region::TRUNK) continue;
      for (int q : m_graph.neighbours(static_cast<int>(k))) {
        const PanelRole& other = m_roles[static_cast<std::size_t>(q)];
        if (other.region != Region::TRUNK || other.side == m_roles[k].side) continue;
        for (const auto& seam : m_graph.between(static_cast<int>(k), q)) {
          const Vec2 a = at(k, seam.front()[0]), b = at(k, seam.back()[0]);
          if (std::abs(a.y() - b.y()) <= std::abs(a.x() - b.x())) continue;
          level = std::max(level, std::max(a.y(), b.y())), longest = std::max(longest, (a - b).norm());
        }
      }
    }
    return longest > 0 ? level : m_top;
  }

  void upper(double shoulder) {
    add("shoulder", shoulder, "along the shoulder seam, straight");
    const double chest = armhole() - BELOW;
    add("chest", around(chest), "around, 2.5 cm below the armholes");
    const auto [waist, girth] = extreme(chest - 0.10, chest - 0.25, false);
    if (girth <= 0) return;
    add("waist", girth, "around, narrowest from 10 to 25 cm below the chest");
    add("hip", extreme(waist - 0.15, waist - 0.25, true).second, "around, widest from 15 to 25 cm below the waist");
  }

  void lower() {
    double waist = 0;
    for (double below : {0.003, 0.006, 0.01}) waist = std::max(waist, around(m_top - below)); // the top may be an arc
    const double open = opening_length(true);
    add("waist", open > 0.3 ? open : waist, "around the top");
    add("hip", extreme(m_top - 0.15, m_top - 0.25, true).second, "around, widest from 15 to 25 cm below the top");
    double crotch = -1e300, inseam = 0, rise = 0;
    for (std::size_t k = 0; k < m_roles.size(); ++k)
      for (int q : m_graph.neighbours(static_cast<int>(k))) {
        if (m_roles[k].part.rfind("leg_", 0) != 0 || m_roles[static_cast<std::size_t>(q)].part.rfind("leg_", 0) != 0) continue;
        if (m_roles[static_cast<std::size_t>(q)].part == m_roles[k].part) continue;
        for (const auto& seam : m_graph.between(static_cast<int>(k), q))
          for (const auto& s : seam) crotch = std::max(crotch, -at(k, s[0]).y());
      }
    crotch = -crotch;
    if (crotch > 1e299) return;
    for (std::size_t k = 0; k < m_roles.size(); ++k) {
      if (m_roles[k].part.rfind("leg_", 0) != 0) continue;
      for (std::size_t q = 0; q < m_roles.size(); ++q) {
        for (const auto& seam : m_graph.between(static_cast<int>(k), static_cast<int>(q))) {
          double length = 0, top = -1e300, low = 1e300;
          for (std::size_t s = 0; s < seam.size(); ++s) {
            if (s > 0) length += (at(k, seam[s][0]) - at(k, seam[s - 1][0])).norm();
            top = std::max(top, at(k, seam[s][0]).y()), low = std::min(low, at(k, seam[s][0]).y());
          }
          if (m_roles[q].part == m_roles[k].part && top < crotch + 0.05 && top - low > 0.05) inseam = std::max(inseam, length);
          if (m_roles[q].part != m_roles[k].part && m_roles[k].side != Side::BACK && top - low > 0.05) rise = std::max(rise, length);
        }
      }
    }
    add("rise", rise, "along the front's middle seam");
    add("inseam", inseam, "along the inner leg's seam");
    add("thigh", around(crotch - BELOW, Region::TRUNK, "leg_l"), "around the left leg, 2.5 cm below the crotch");
    add("leg_hem", around(m_bottom + 0.015, Region::TRUNK, "leg_l"), "around the left leg's hem");
  }

  void sides() {
    double longest = 0;
    for (std::size_t k = 0; k < m_roles.size(); ++k)
      for (int q : m_graph.neighbours(static_cast<int>(k))) {
        if (m_roles[k].region != Region::TRUNK || m_roles[static_cast<std::size_t>(q)].region != Region::TRUNK) continue;
        if (m_roles[k].side == m_roles[static_cast<std::size_t>(q)].side && m_roles[k].side != Side::RING) continue;
        for (const auto& seam : m_graph.between(static_cast<int>(k), q)) {
          const Vec2 a = at(k, seam.front()[0]), b = at(k, seam.back()[0]);
          if (std::abs(a.y() - b.y()) <= std::abs(a.x() - b.x())) continue;
          double length = 0;
          for (std::size_t s = 1; s < seam.size(); ++s) length += (at(k, seam[s][0]) - at(k, seam[s - 1][0])).norm();
          longest = std::max(longest, length);
        }
      }
    add("side_seam", longest, "along the longest upright seam of the trunk");
  }

  /// The opening of the trunk whose edges lie highest or lowest.
  const Opening* trunk_opening(bool highest) const {
    const Opening* best = nullptr;
    double level = 0;
    for (const Opening& o : m_openings) {
      double sum = 0;
      int n = 0;
      for (const std::string& edge : o.edges) {
        for (std::size_t k = 0; k < m_roles.size(); ++k) {
          const Panel& panel = m_pattern.panels[k];
          if (edge.rfind(panel.name + ": ", 0) != 0 || arm(k)) continue;
          const int e = panel.find_edge(edge.substr(panel.name.size() + 2));
          if (e < 0) continue;
          const ArcLength arc(panel.edge(e).path);
          sum += (m_roles[k].turn * arc.at(0.5 * arc.length()) + m_spots[k].offset).y() + (m_roles[k].region == Region::NECK ? 10 : 0), ++n;
        }
      }
      if (n == 0) continue;
      if (!best || (highest ? sum / n > level : sum / n < level)) best = &o, level = sum / n;
    }
    return best;
  }
  double opening_length(bool highest) const {
    const Opening* o = trunk_opening(highest);
    return o ? o->length : 0;
  }
  void opening(const std::string& name, bool highest) {
    const Opening* o = trunk_opening(highest);
    if (o && m_openings.size() > 1) add(name, o->length, "around the " + std::string(highest ? "highest" : "lowest") + " opening");
  }

  void sleeve() {
    double high = -1e300, low = 1e300, seam_low = 1e300;
    for (std::size_t k = 0; k < m_roles.size(); ++k) {
      if (m_roles[k].region != Region::ARM_L) continue;
      const auto b = laid_bounds(m_mesh, m_roles[k], m_spots[k], static_cast<int>(k));
      high = std::max(high, b[1].y()), low = std::min(low, b[0].y());
      for (int q : m_graph.neighbours(static_cast<int>(k)))
        if (m_roles[static_cast<std::size_t>(q)].region == Region::TRUNK)
          for (const auto& seam : m_graph.between(static_cast<int>(k), q))
            for (const auto& s : seam) seam_low = std::min(seam_low, at(k, s[0]).y());
    }
    if (high <= low) return;
    add("sleeve", high - low, "from the sleeve's highest point to its hem");
    if (seam_low - BELOW > low) add("upper_arm", around(seam_low - BELOW, Region::ARM_L), "around, 2.5 cm below the sleeve's seam");
    add("cuff", around(low + 0.005, Region::ARM_L), "around the sleeve's hem");
  }

  const Pattern& m_pattern;
  const PanelMesh& m_mesh;
  const std::vector<Opening>& m_openings;
  SeamGraph m_graph;
  std::vector<PanelRole> m_roles;
  std::vector<PanelSpot> m_spots;
  double m_top = -1e300, m_bottom = 1e300;
  std::vector<NamedMeasure> m_out;
};

} // namespace

std::vector<NamedMeasure> named_measures(const Pattern& pattern, const PanelMesh& mesh, const std::vector<Opening>& openings) {
  return Measurer(pattern, mesh, openings).run();
}

} // namespace sloper::pattern

#include <pattern/measure/arm_rims.hpp>
#include <pattern/roles/panel_roles.hpp>
#include <sloper/base/units.hpp>
#include <sloper/geometry/disjoint_sets.hpp>

#include <algorithm>
#include <map>
#include <set>

namespace sloper::pattern {
namespace {

constexpr double LEAST_OPEN = 0.03; // m of the trunk and of the arm: less is an end of a seam

/// How much of a rim lies on each panel, m, and its longest edge on one.
struct RimShares {
  std::map<int, double> by_panel;
  std::map<std::pair<int, std::string>, double> by_edge;
};

bool is_arm(const PanelRole& role) {
  return role.region == Region::ARM_L || role.region == Region::ARM_R;
}

class ArmRims {
public:
  ArmRims(const Pattern& pattern, const PanelMesh& mesh)
      : m_pattern(pattern), m_mesh(mesh), m_graph(mesh),
        m_roles(panel_roles(pattern, mesh, m_graph)), m_arms(pattern.panels.size()) {
    for (int p = 0; p < count(); ++p)
      for (const int q : m_graph.neighbours(p))
        if (is_arm(m_roles[p]) && is_arm(m_roles[q]))
          m_arms.unite(p, q);
    for (int p = 0; p < count(); ++p)
      for (const int q : m_graph.neighbours(p))
        if (is_arm(m_roles[p]) && m_roles[q].region == Region::TRUNK)
          m_hanging.insert(m_arms.find(p));
  }

  std::vector<PatternFinding> run(const std::vector<ClothRim>& rims) const {
    std::vector<PatternFinding> out;
    std::map<int, std::vector<const ClothRim*>> own; // rims of one arm alone
    for (const ClothRim& rim : rims) {
      const RimShares shares = shares_of(rim);
      std::map<int, double> arms;
      double trunk = 0;
      bool collar = false;
      for (const auto& [panel, length] : shares.by_panel) {
        if (is_arm(m_roles[panel]))
          arms[m_arms.find(panel)] += length;
        else
          trunk += length;
        collar = collar || m_roles[panel].region == Region::NECK;
      }
      if (collar || arms.size() != 1)
        continue;
      const auto [arm, length] = *arms.begin();
      if (trunk == 0 && shares_loop(rim))
        own[arm].push_back(&rim);
      if (m_hanging.size() < 2 || std::min(length, trunk) < LEAST_OPEN)
        continue;
      out.push_back(finding(shares, "is open on a rim of " + centimetres(rim.length) +
                                        " that goes through the trunk and one sleeve, which no "
                                        "neck and no wrist does: a seam between them is missing"));
    }
    for (auto& [arm, open] : own) {
      if (!m_hanging.count(arm))
        continue; // a part of its own
      std::stable_sort(open.begin(), open.end(),
                       [](const ClothRim* a, const ClothRim* b) { return a->length > b->length; });
      for (std::size_t k = 1; k < open.size(); ++k)
        if (open[k]->length > LEAST_OPEN)
          out.push_back(finding(shares_of(*open[k]),
                                "is open on a rim of " + centimetres(open[k]->length) +
                                    " beside that of the wrist, " + centimetres(open[0]->length) +
                                    ": what is it sewn to?"));
    }
    return out;
  }

private:
  int count() const { return static_cast<int>(m_pattern.panels.size()); }

  RimShares shares_of(const ClothRim& rim) const {
    RimShares out;
    const std::size_t n = rim.vertices.size();
    for (std::size_t k = 0; k < n; ++k) {
      const RimVertex& v = rim.vertices[k];
      const int panel = panel_of_vertex(m_mesh, v.leaving);
      const Vec2 middle =
          0.5 * (m_mesh.pattern[v.leaving] + m_mesh.pattern[rim.vertices[(k + 1) % n].arriving]);
      out.by_panel[panel] += v.to_next;
      out.by_edge[{panel, edge_nearest_to(m_pattern.panels[panel], middle)}] += v.to_next;
    }
    return out;
  }
  /// Whether it is more than a hole in one panel: some piece ends on it.
  static bool shares_loop(const ClothRim& rim) {
    return std::any_of(rim.vertices.begin(), rim.vertices.end(),
                       [](const RimVertex& v) { return v.pieces > 1; });
  }
  PatternFinding finding(const RimShares& shares, const std::string& fact) const {
    const auto longest = std::max_element(
        shares.by_edge.begin(), shares.by_edge.end(), [&](const auto& a, const auto& b) {
          const bool a_arm = is_arm(m_roles[a.first.first]), b_arm = is_arm(m_roles[b.first.first]);
          return a_arm != b_arm ? b_arm : a.second < b.second;
        });
    const auto& [panel, edge] = longest->first;
    return {"error", "half-sewn", m_pattern.panels[panel].name + ": " + edge, fact};
  }

  const Pattern& m_pattern;
  const PanelMesh& m_mesh;
  SeamGraph m_graph;
  std::vector<PanelRole> m_roles;
  DisjointSets m_arms;     ///< panels of arms that seams join
  std::set<int> m_hanging; ///< arms that are sewn to the trunk
};

} // namespace

std::vector<PatternFinding> half_sewn_arms(const Pattern& pattern, const PanelMesh& mesh,
                                           const std::vector<ClothRim>& rims) {
  return ArmRims(pattern, mesh).run(rims);
}

} // namespace sloper::pattern

#include <pattern/roles/leg_roles.hpp>
#include <pattern/roles/ring_roles.hpp>
#include <sloper/base/units.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::pattern {
namespace {

/// Finds tubes, rows of gores and godets, one after the other.
class RingRoles {
public:
  RingRoles(const Pattern& pattern, const PanelMesh& mesh, const SeamGraph& graph,
            const std::vector<Words>& words, std::vector<PanelRole>& roles)
      : m_pattern(pattern), m_mesh(mesh), m_graph(graph), m_words(words), m_roles(roles) {}

  void run() {
    for (std::size_t k = 0; k < m_roles.size(); ++k)
      rings(k);
    ring_of_gores();
    one_ring_all_ring();
  }

private:
  double width(std::size_t k) const { return width_around(m_mesh, m_roles, k); }

  /// A panel sewn to itself across most of its width is a tube.
  void rings(std::size_t k) {
    PanelRole& role = m_roles[k];
    for (const auto& seam : m_graph.between(static_cast<int>(k), static_cast<int>(k))) {
      double apart = 0;
      for (const auto& s : seam)
        apart += (m_mesh.pattern[s[0]] - m_mesh.pattern[s[1]]).norm();
      apart /= static_cast<double>(seam.size());
      if (apart < 0.5 * std::max(width(k), 1e-3))
        continue; // a dart
      role.side = Side::RING;
      if (role.region == Region::ARM_L || role.region == Region::ARM_R)
        role.theta = 0;
    }
    const bool arm = role.region == Region::ARM_L || role.region == Region::ARM_R;
    if (arm && role.side != Side::RING &&
        !m_pattern.panels[k].hint.rigid) { // one piece, unless a partner makes the tube
      bool partner = false;
      for (int q : m_graph.neighbours(static_cast<int>(k)))
        partner = partner || (m_roles[q].region == role.region &&
                              m_graph.between(static_cast<int>(k), q).size() >= 2);
      if (!partner) {
        role.side = Side::RING;
        role.theta = 0;
      }
    }
  }

  /// Where one gore of a skirt looks sideways, all gores of its row stand in a ring: those that
  /// upright seams lead to.
  void one_ring_all_ring() {
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t k = 0; k < m_roles.size(); ++k) {
        if (m_roles[k].region != Region::TRUNK || m_roles[k].side != Side::RING)
          continue;
        if (m_graph.between(static_cast<int>(k), static_cast<int>(k)).size() > 0)
          continue;
        for (int q : m_graph.neighbours(static_cast<int>(k))) {
          PanelRole& other = m_roles[q];
          if (other.region != Region::TRUNK || other.side == Side::RING ||
              other.part != m_roles[k].part)
            continue;
          if (upright_seam(m_mesh, m_graph, m_roles, k, static_cast<std::size_t>(q))) {
            other.side = Side::RING;
            changed = true;
          }
        }
      }
    }
  }

  /// Three panels or more whose names tell no side, each sewn upright to two others, one after the
  /// other all around: gores.
  void ring_of_gores() {
    std::vector<std::vector<std::size_t>> beside(m_roles.size());
    const auto unnamed = [&](std::size_t k) {
      const auto& hint = m_pattern.panels[k].hint;
      return m_roles[k].region == Region::TRUNK && m_roles[k].side != Side::RING && !hint.rigid &&
             hint.part.empty() && !name_suggests_front(m_words[k]) && !says_back(m_words[k]) &&
             !(m_roles[k].by_shape && m_roles[k].part != "lower_body");
    };
    for (std::size_t k = 0; k < m_roles.size(); ++k)
      if (unnamed(k))
        for (int q : m_graph.neighbours(static_cast<int>(k)))
          if (unnamed(static_cast<std::size_t>(q)) &&
              upright_seam(m_mesh, m_graph, m_roles, k, static_cast<std::size_t>(q)))
            beside[k].push_back(static_cast<std::size_t>(q));
    // Godets go between two that are joined above them.
    std::vector<std::size_t> godets;
    std::vector<std::array<std::size_t, 2>> joined;
    const auto joins = [&](std::size_t k, std::size_t q) {
      return std::find(beside[k].begin(), beside[k].end(), q) != beside[k].end();
    };
    for (std::size_t k = 0; k < m_roles.size(); ++k)
      if (beside[k].size() == 2 && joins(beside[k][0], beside[k][1]) &&
          m_mesh.panels[k].n_triangles < std::min(m_mesh.panels[beside[k][0]].n_triangles,
                                                  m_mesh.panels[beside[k][1]].n_triangles) /
                                             2) {
        godets.push_back(k);
        joined.push_back({beside[k][0], beside[k][1]});
      }
    for (std::size_t g = 0; g < godets.size(); ++g) {
      for (std::size_t k : joined[g])
        beside[k].erase(std::find(beside[k].begin(), beside[k].end(), godets[g]));
      beside[godets[g]].clear();
    }
    for (std::size_t first = 0; first < m_roles.size(); ++first) {
      if (beside[first].size() != 2 || m_roles[first].side == Side::RING)
        continue;
      std::vector<std::size_t> row = {first, right_of(first, beside[first])};
      while (row.back() != first && row.size() <= m_roles.size() && beside[row.back()].size() == 2)
        row.push_back(beside[row.back()][0] == row[row.size() - 2] ? beside[row.back()][1]
                                                                   : beside[row.back()][0]);
      if (row.size() < 4 || row.back() != first)
        continue;
      row.pop_back();
      double around = 0, at = 0;
      for (std::size_t k : row)
        around += width(k);
      for (std::size_t k : row) { // u runs to the wearer's left, as theta does
        m_roles[k].side = Side::RING;
        m_roles[k].theta = std::remainder(
            (at + 0.5 * (width(k) - width(first))) / around * 2 * units::PI, 2 * units::PI);
        at += width(k);
      }
    }
    for (std::size_t g = 0; g < godets.size(); ++g) {
      const PanelRole &a = m_roles[joined[g][0]], &b = m_roles[joined[g][1]];
      if (a.side != Side::RING || b.side != Side::RING)
        continue;
      m_roles[godets[g]].side = Side::RING;
      m_roles[godets[g]].theta =
          std::atan2(std::sin(a.theta) + std::sin(b.theta), std::cos(a.theta) + std::cos(b.theta));
    }
  }

  /// Of two neighbours the one that is sewn on at the +u side.
  std::size_t right_of(std::size_t k, const std::vector<std::size_t>& two) const {
    double u[2] = {0, 0};
    for (std::size_t i : {0, 1}) {
      double n = 0;
      for (const auto& seam : m_graph.between(static_cast<int>(k), static_cast<int>(two[i])))
        for (const auto& s : seam) {
          u[i] += (m_roles[k].turn * m_mesh.pattern[s[0]]).x();
          ++n;
        }
      u[i] /= std::max(n, 1.0);
    }
    return two[u[0] >= u[1] ? 0 : 1];
  }

  const Pattern& m_pattern;
  const PanelMesh& m_mesh;
  const SeamGraph& m_graph;
  const std::vector<Words>& m_words;
  std::vector<PanelRole>& m_roles;
};

} // namespace

double width_around(const PanelMesh& mesh, const std::vector<PanelRole>& roles, std::size_t k) {
  double low = 1e300, high = -1e300;
  for (int v : mesh.panels[k].outline) {
    const double u = (roles[k].turn * mesh.pattern[v]).x();
    low = std::min(low, u);
    high = std::max(high, u);
  }
  return high - low;
}

void assign_rings(const Pattern& pattern, const PanelMesh& mesh, const SeamGraph& graph,
                  const std::vector<Words>& words, std::vector<PanelRole>& roles) {
  RingRoles(pattern, mesh, graph, words, roles).run();
}

} // namespace sloper::pattern

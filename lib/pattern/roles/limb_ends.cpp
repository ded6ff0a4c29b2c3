#include <pattern/roles/limb_ends.hpp>
#include <sloper/geometry/polygon.hpp>

#include <cmath>

namespace sloper::pattern {
namespace {

constexpr double LEG_PIECE = 0.4; // of the largest leg's area, where trousers have no band

class Limbs {
public:
  Limbs(const PanelMesh& mesh, const SeamGraph& graph, std::vector<ShapeRole>& roles)
      : m_mesh(mesh), m_graph(graph), m_roles(roles), m_tier(roles.size(), UNKNOWN) {
    for (std::size_t k = 0; k < roles.size(); ++k)
      m_area.push_back(area(k));
  }

  std::vector<bool> run() {
    find_tiers();
    one_hand_a_sleeve();
    std::vector<bool> on_leg(m_roles.size(), false);
    int last = 0;
    for (const int tier : m_tier)
      last = std::max(last, tier);
    for (int tier = 1; tier <= last; ++tier)
      for (std::size_t k = 0; k < m_roles.size(); ++k)
        if (m_tier[k] == tier)
          follow(k, on_leg);
    return on_leg;
  }

private:
  static constexpr int UNKNOWN = -1;
  static bool on_trunk(std::size_t part) {
    return part == TORSO_PART || part == LOWER_BODY_PART || part == NECK_PART;
  }

  double area(std::size_t k) const {
    return polygon_area(m_mesh.pattern, m_mesh.panels[k].outline);
  }
  double sewn_length(std::size_t p, std::size_t q) const {
    double sum = 0;
    for (const auto& seam : m_graph.between(static_cast<int>(p), static_cast<int>(q)))
      for (std::size_t s = 1; s < seam.size(); ++s)
        sum += (m_mesh.pattern[seam[s][0]] - m_mesh.pattern[seam[s - 1][0]]).norm();
    return sum;
  }
  /// The largest panel of those that `wanted` takes; the count of panels where there is none.
  template<class Wanted> std::size_t largest(const Wanted& wanted) const {
    std::size_t best = m_roles.size();
    for (std::size_t k = 0; k < m_roles.size(); ++k)
      if (wanted(m_roles[k].part) && (best == m_roles.size() || m_area[k] > m_area[best]))
        best = k;
    return best;
  }

  /// 0 the trunk, 1 what is sewn to it, and so on.
  void find_tiers() {
    std::vector<std::size_t> reached;
    const std::size_t root =
        largest([](std::size_t part) { return part == TORSO_PART || part == LOWER_BODY_PART; });
    if (root < m_roles.size()) {
      m_tier[root] = 0;
      reached.push_back(root);
      for (std::size_t i = 0; i < reached.size(); ++i)
        for (const int q : m_graph.neighbours(static_cast<int>(reached[i])))
          if (m_tier[q] == UNKNOWN && on_trunk(m_roles[q].part)) {
            m_tier[q] = 0;
            reached.push_back(static_cast<std::size_t>(q));
          }
    } else if (const std::size_t leg = largest([](std::size_t part) { return part == LEG_PART; });
               leg < m_roles.size()) {
      for (std::size_t k = 0; k < m_roles.size(); ++k)
        if (m_roles[k].part == LEG_PART && m_area[k] > LEG_PIECE * m_area[leg]) {
          m_tier[k] = 1;
          reached.push_back(k);
        }
    }
    for (std::size_t i = 0; i < reached.size(); ++i)
      for (const int q : m_graph.neighbours(static_cast<int>(reached[i])))
        if (m_tier[q] == UNKNOWN) {
          m_tier[q] = m_tier[reached[i]] + 1;
          reached.push_back(static_cast<std::size_t>(q));
        }
  }

  /// Pieces of one sleeve that are sewn to the trunk and to each other are on the side of the half
  /// of the torso that they are sewn to.
  void one_hand_a_sleeve() {
    std::vector<char> met(m_roles.size(), 0);
    const auto of_sleeve = [&](std::size_t k) {
      return m_tier[k] == 1 && m_roles[k].part == ARM_PART;
    };
    for (std::size_t k = 0; k < m_roles.size(); ++k) {
      if (met[k] || !of_sleeve(k))
        continue;
      std::vector<std::size_t> pieces = {k};
      met[k] = 1;
      double by_shape = 0, by_halves = 0; // for the left arm
      for (std::size_t i = 0; i < pieces.size(); ++i) {
        by_shape += m_area[pieces[i]] * m_roles[pieces[i]].hand;
        for (const int q : m_graph.neighbours(static_cast<int>(pieces[i]))) {
          const std::size_t o = static_cast<std::size_t>(q);
          if (m_tier[o] == 0 && m_roles[o].part == TORSO_PART)
            by_halves += sewn_length(pieces[i], o) * m_roles[o].hand;
          if (met[o] || !of_sleeve(o))
            continue;
          met[o] = 1;
          pieces.push_back(o);
        }
      }
      const double vote = by_halves != 0 ? by_halves : by_shape;
      for (const std::size_t p : pieces)
        if (vote != 0)
          m_roles[p].hand = vote > 0 ? 1 : -1;
    }
  }

  void follow(std::size_t k, std::vector<bool>& on_leg) {
    double longest = 0;
    std::size_t parent = m_roles.size();
    for (const int q : m_graph.neighbours(static_cast<int>(k))) {
      const std::size_t o = static_cast<std::size_t>(q);
      const double sewn = m_tier[o] == m_tier[k] - 1 ? sewn_length(k, o) : 0;
      if (sewn > longest) {
        longest = sewn;
        parent = o;
      }
    }
    if (parent == m_roles.size())
      return;
    if (m_tier[k] == 1) {
      if (m_roles[k].part == ARM_PART && m_roles[parent].part == TORSO_PART)
        m_roles[k].back = m_roles[parent].back;
      return;
    }
    m_roles[k].part = m_roles[parent].part;
    m_roles[k].hand = m_roles[parent].hand;
    m_roles[k].back = m_roles[parent].back;
    m_roles[k].sure = m_roles[parent].sure;
    on_leg[k] = m_roles[k].part == LEG_PART;
  }

  const PanelMesh& m_mesh;
  const SeamGraph& m_graph;
  std::vector<ShapeRole>& m_roles;
  std::vector<int> m_tier;
  std::vector<double> m_area; ///< m2
};

} // namespace

std::vector<bool> follow_limbs(const PanelMesh& mesh, const SeamGraph& graph,
                               std::vector<ShapeRole>& roles) {
  return Limbs(mesh, graph, roles).run();
}

} // namespace sloper::pattern

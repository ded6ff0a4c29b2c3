#include <base/units.hpp>
#include <pattern/panel_role.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

namespace sloper::pattern {
namespace {

using Words = std::set<std::string>;

/// Lower-case words of a name: "skirtFront_L2" is skirt, front, l.
Words words_of(const std::string& name) {
  Words words;
  std::string word;
  char last = 0;
  for (char c : name + "_") {
    const bool letter = std::isalpha(static_cast<unsigned char>(c)) != 0;
    if (!letter || (std::isupper(static_cast<unsigned char>(c)) && std::islower(static_cast<unsigned char>(last)))) {
      if (!word.empty()) words.insert(word);
      word.clear();
    }
    if (letter) word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    last = c;
  }
  return words;
}

bool any_of(const Words& words, std::initializer_list<const char*> wanted) {
  return std::any_of(wanted.begin(), wanted.end(), [&](const char* w) { return words.count(w) != 0; });
}

/// Whether some word begins with one of these.
bool any_begins(const Words& words, std::initializer_list<const char*> wanted) {
  for (const std::string& w : words)
    for (const char* start : wanted)
      if (w.rfind(start, 0) == 0) return true;
  return false;
}

class Roles {
public:
  Roles(const Pattern& pattern, const PanelMesh& mesh, const SeamGraph& graph)
      : m_pattern(pattern), m_mesh(mesh), m_graph(graph), m_roles(pattern.panels.size()) {}

  std::vector<PanelRole> run() {
    const std::size_t n = m_roles.size();
    m_known.assign(n, false);
    for (std::size_t k = 0; k < n; ++k) m_words.push_back(words_of(m_pattern.panels[k].name));
    for (std::size_t k = 0; k < n; ++k) by_hint(k);
    for (std::size_t k = 0; k < n; ++k)
      if (!m_known[k]) by_name(k);
    for (std::size_t k = 0; k < n; ++k) arm_side(k);
    for (std::size_t k = 0; k < n; ++k) rings(k);
    one_ring_all_ring();
    for (std::size_t k = 0; k < n; ++k)
      if (m_roles[k].region == Region::ARM_L || m_roles[k].region == Region::ARM_R) turn_arm_panel(k);
    legs();
    return std::move(m_roles);
  }

private:
  Vec2 middle(std::size_t k) const {
    const PanelInfo& p = m_mesh.panels[k];
    Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
    for (int v : p.outline) low = low.cwiseMin(m_mesh.pattern[static_cast<std::size_t>(v)]), high = high.cwiseMax(m_mesh.pattern[static_cast<std::size_t>(v)]);
    return 0.5 * (low + high);
  }
  double width(std::size_t k) const {
    const PanelInfo& p = m_mesh.panels[k];
    double low = 1e300, high = -1e300;
    for (int v : p.outline) {
      const double u = (m_roles[k].turn * m_mesh.pattern[static_cast<std::size_t>(v)]).x();
      low = std::min(low, u), high = std::max(high, u);
    }
    return high - low;
  }

  void side_from_theta(PanelRole& role, double theta) {
    theta = std::remainder(theta, 2 * units::PI);
    role.theta = theta;
    role.side = std::abs(theta) <= units::radians(61) ? Side::FRONT : std::abs(theta) >= units::radians(119) ? Side::BACK : Side::RING;
  }

  void by_hint(std::size_t k) {
    const Panel& panel = m_pattern.panels[k];
    PanelRole& role = m_roles[k];
    const PlacementHint& hint = panel.hint;
    if (!hint.part.empty()) {
      m_known[k] = true;
      role.part = hint.part;
      role.region = hint.part == "arm_l"                         ? Region::ARM_L
                    : hint.part == "arm_r"                       ? Region::ARM_R
                    : hint.part == "neck" || hint.part == "head" ? Region::NECK
                                                                 : Region::TRUNK;
      if (role.region == Region::NECK) {
        role.side = Side::RING, role.theta = hint.theta.value_or(units::PI);
        return;
      }
      if (role.region != Region::TRUNK) { // arms: theta 0 is the outer, upper side
        role.side = Side::RING, role.theta = 0;
        return;
      }
      side_from_theta(role, hint.theta.value_or(has_word(k, "back") ? units::PI : 0));
      if (hint.anchor && (hint.radius || std::abs(std::remainder(*hint.theta, units::PI)) < 1e-6) && role.side != Side::RING && hint.part != "leg_l" &&
          hint.part != "leg_r")
        role.du = std::remainder(role.theta - (role.side == Side::BACK ? units::PI : 0), 2 * units::PI) * hint.radius.value_or(0) - hint.anchor->x();
      if (hint.anchor && hint.height && (role.du || role.side == Side::RING)) role.dv = *hint.height - hint.anchor->y();
      return;
    }
    if (!hint.rigid) return;
    m_known[k] = true;
    const Mat3 r = hint.rigid->topLeftCorner<3, 3>();
    const Vec3 normal = r.col(2);
    const Vec2 m = middle(k);
    const Vec3 center = (*hint.rigid * Eigen::Vector4d(m.x(), m.y(), 0, 1)).head<3>();
    const Words& words = m_words[k];
    const bool arm = panel.label == "arm" || any_begins(words, {"sleeve", "cuff", "arm"});
    if (arm && any_begins(words, {"sleeve", "cuff", "arm", "sl"})) role.region = center.x() > 0 ? Region::ARM_L : Region::ARM_R;
    else if (any_begins(words, {"collar", "hood", "neck", "stand"})) role.region = Region::NECK;
    else role.part = panel.label == "leg" ? "lower_body" : "torso";
    if (std::hypot(normal.x(), normal.z()) < 0.3) { // drawn lying: names decide
      role.side = has_word(k, "back") ? Side::BACK : Side::FRONT;
      return;
    }
    side_from_theta(role, std::atan2(normal.x(), normal.z()));
    if (role.region == Region::NECK) {
      if (role.side == Side::FRONT) role.theta = 0;
      role.side = Side::RING;
      return;
    }
    if (role.region != Region::TRUNK) return;
    const Vec3 u_axis = Vec3::UnitY().cross(normal).normalized();
    const double angle = std::atan2(r.col(0).y(), r.col(0).dot(u_axis));
    role.turn = Eigen::Rotation2Dd(angle).toRotationMatrix();
    role.dv = center.y() - (role.turn * m).y();
    if (role.side != Side::RING) role.du = (role.side == Side::BACK ? -center.x() : center.x()) - (role.turn * m).x();
  }

  bool has_word(std::size_t k, const char* word) const { return m_words[k].count(word) != 0; }

  void by_name(std::size_t k) {
    PanelRole& role = m_roles[k];
    const Words& words = m_words[k];
    const bool back = any_begins(words, {"back", "bck", "rear", "bk"}) || any_of(words, {"b", "cb", "yoke"});
    role.side = back && !any_begins(words, {"front"}) ? Side::BACK : Side::FRONT;
    if (any_begins(words, {"sleeve", "slv", "cuff", "manche"})) role.region = left_word(k) ? Region::ARM_L : Region::ARM_R;
    else if (any_begins(words, {"collar", "stand", "neck", "hood", "kragen"})) role.region = Region::NECK, role.side = Side::RING, role.theta = units::PI;
    else if (any_begins(words, {"skirt", "gore", "waist", "wb", "leg", "pant", "trouser", "short"})) role.part = "lower_body";
    else role.part = "torso";
    role.theta = role.region == Region::NECK || role.side == Side::BACK ? units::PI : 0;
  }

  bool left_word(std::size_t k) const { return any_of(m_words[k], {"l", "left", "lft"}); }
  bool right_word(std::size_t k) const { return any_of(m_words[k], {"r", "right", "rgt"}); }

  /// A sleeve without a word for its side hangs on the armhole that it is sewn to: seen from outside, the left armhole of a front
  /// is on its +u side, that of a back on its -u side.
  void arm_side(std::size_t k) {
    PanelRole& role = m_roles[k];
    if (role.region != Region::ARM_L && role.region != Region::ARM_R) return;
    if (!m_pattern.panels[k].hint.part.empty() || m_pattern.panels[k].hint.rigid) {
      role.part = role.region == Region::ARM_L ? "arm_l" : "arm_r";
      return;
    }
    if (!left_word(k) && !right_word(k)) {
      double vote = 0;
      for (int q : m_graph.neighbours(static_cast<int>(k))) {
        const PanelRole& other = m_roles[static_cast<std::size_t>(q)];
        if (other.region != Region::TRUNK) continue;
        for (const auto& seam : m_graph.between(static_cast<int>(k), q))
          for (const auto& s : seam)
            vote += (m_mesh.pattern[static_cast<std::size_t>(s[1])].x() - middle(static_cast<std::size_t>(q)).x()) * (other.side == Side::BACK ? -1 : 1);
      }
      role.region = vote >= 0 ? Region::ARM_L : Region::ARM_R;
    }
    role.part = role.region == Region::ARM_L ? "arm_l" : "arm_r";
  }

  /// A panel sewn to itself across most of its width is a tube.
  void rings(std::size_t k) {
    PanelRole& role = m_roles[k];
    for (const auto& seam : m_graph.between(static_cast<int>(k), static_cast<int>(k))) {
      double apart = 0;
      for (const auto& s : seam) apart += (m_mesh.pattern[static_cast<std::size_t>(s[0])] - m_mesh.pattern[static_cast<std::size_t>(s[1])]).norm();
      apart /= static_cast<double>(seam.size());
      if (apart < 0.5 * std::max(width(k), 1e-3)) continue; // a dart
      role.side = Side::RING;
      if (role.region == Region::ARM_L || role.region == Region::ARM_R) role.theta = 0;
    }
    const bool arm = role.region == Region::ARM_L || role.region == Region::ARM_R;
    if (arm && role.side != Side::RING && !m_pattern.panels[k].hint.rigid) { // one piece, unless a partner makes the tube
      bool partner = false;
      for (int q : m_graph.neighbours(static_cast<int>(k)))
        partner = partner || (m_roles[static_cast<std::size_t>(q)].region == role.region && m_graph.between(static_cast<int>(k), q).size() >= 2);
      if (!partner) role.side = Side::RING, role.theta = 0;
    }
  }

  /// Where one gore of a skirt looks sideways, all gores of its row stand in a ring.
  void one_ring_all_ring() {
    for (std::size_t k = 0; k < m_roles.size(); ++k) {
      if (m_roles[k].region != Region::TRUNK || m_roles[k].side != Side::RING) continue;
      if (m_graph.between(static_cast<int>(k), static_cast<int>(k)).size() > 0) continue;
      for (int q : m_graph.neighbours(static_cast<int>(k))) {
        PanelRole& other = m_roles[static_cast<std::size_t>(q)];
        if (other.region == Region::TRUNK && other.part == m_roles[k].part && m_pattern.panels[static_cast<std::size_t>(q)].label == m_pattern.panels[k].label)
          other.side = Side::RING;
      }
    }
  }

  /// (u, v) of an arm panel: v runs along the seams that close the tube, towards the end that is sewn to the trunk (or to the sleeve).
  void turn_arm_panel(std::size_t k) {
    PanelRole& role = m_roles[k];
    const int p = static_cast<int>(k);
    std::vector<Vec2> directions;
    const auto add = [&](const std::vector<std::array<int, 2>>& seam, std::size_t side) {
      const Vec2 d = m_mesh.pattern[static_cast<std::size_t>(seam.back()[side])] - m_mesh.pattern[static_cast<std::size_t>(seam.front()[side])];
      if (d.norm() > 1e-6) directions.push_back(d);
    };
    for (const auto& seam : m_graph.between(p, p)) add(seam, 0), add(seam, 1);
    for (int q : m_graph.neighbours(p)) {
      const auto seams = m_graph.between(p, q);
      if (m_roles[static_cast<std::size_t>(q)].region == role.region && seams.size() >= 2)
        for (const auto& seam : seams) add(seam, 0);
    }
    Vec2 up(0, 1);
    if (!directions.empty()) {
      Vec2 sum = Vec2::Zero();
      for (const Vec2& d : directions) sum += d.dot(directions[0]) < 0 ? Vec2(-d) : d;
      if (sum.norm() > 1e-6) up = sum.normalized();
    } else if (m_pattern.panels[k].hint.rigid) up = Vec2(1, 0);
    // Towards the body: away from the middle, where the trunk (else another arm panel that leads to it) is sewn on.
    double sense = 0;
    for (bool trunk : {true, false}) {
      for (int q : m_graph.neighbours(p)) {
        const PanelRole& other = m_roles[static_cast<std::size_t>(q)];
        if ((other.region == Region::TRUNK) != trunk) continue;
        const auto seams = m_graph.between(p, q);
        if (!trunk && (seams.size() >= 2 || !touches_trunk(q))) continue;
        for (const auto& seam : seams)
          for (const auto& s : seam) sense += (m_mesh.pattern[static_cast<std::size_t>(s[0])] - middle(k)).dot(up);
      }
      if (sense != 0) break;
    }
    if (sense < 0) up = -up;
    role.turn << up.y(), -up.x(), up.x(), up.y(); // rows: u = up turned clockwise, v = up
  }

  bool touches_trunk(int p) const {
    for (int q : m_graph.neighbours(p))
      if (m_roles[static_cast<std::size_t>(q)].region == Region::TRUNK) return true;
    return false;
  }

  /// A seam between the two panels that rises more than it goes across.
  bool upright_seam(std::size_t k, std::size_t q) const {
    for (const auto& seam : m_graph.between(static_cast<int>(k), static_cast<int>(q))) {
      Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
      for (const auto& s : seam) {
        const Vec2 p = m_roles[k].turn * m_mesh.pattern[static_cast<std::size_t>(s[0])];
        low = low.cwiseMin(p), high = high.cwiseMax(p);
      }
      if (high.y() - low.y() > high.x() - low.x()) return true;
    }
    return false;
  }

  /// Leggings: a leg in one piece, sewn to itself along the inside, to its like above. The back's middle seam is the longer one, for
  /// it goes over the seat; of a left leg, seen from outside, it is on the right.
  bool one_piece_legs() {
    std::vector<std::size_t> tubes;
    for (std::size_t k = 0; k < m_roles.size(); ++k)
      if (m_roles[k].region == Region::TRUNK && m_roles[k].side == Side::RING && upright_seam(k, k)) tubes.push_back(k);
    if (tubes.size() != 2 || !upright_seam(tubes[0], tubes[1])) return false;
    double back[2];
    for (std::size_t i : {0, 1}) {
      const std::size_t k = tubes[i];
      back[i] = 0;
      for (const auto& seam : m_graph.between(static_cast<int>(k), static_cast<int>(tubes[1 - i])))
        for (std::size_t s = 0; s + 1 < seam.size(); ++s) {
          const Vec2 a = m_mesh.pattern[static_cast<std::size_t>(seam[s][0])], b = m_mesh.pattern[static_cast<std::size_t>(seam[s + 1][0])];
          back[i] += (0.5 * (a.x() + b.x()) > middle(k).x() ? 1 : -1) * (a - b).norm();
        }
      back[i] += (left_word(k) ? 1e3 : 0) - (right_word(k) ? 1e3 : 0);
    }
    const bool first_left = back[0] >= back[1];
    m_roles[tubes[0]].part = first_left ? "leg_l" : "leg_r", m_roles[tubes[1]].part = first_left ? "leg_r" : "leg_l";
    return true;
  }

  /// Trouser legs: two front-back tubes that are sewn to each other. Only PanelInfo::part and the layout's order depend on it.
  void legs() {
    if (one_piece_legs()) return;
    std::vector<std::size_t> tubes;
    for (std::size_t k = 0; k < m_roles.size(); ++k) {
      if (m_roles[k].region != Region::TRUNK || m_roles[k].side == Side::RING) continue;
      bool tube = false;
      for (int q : m_graph.neighbours(static_cast<int>(k))) {
        if (m_roles[static_cast<std::size_t>(q)].side == m_roles[k].side) continue;
        int n_long = 0;
        const PanelInfo& info = m_mesh.panels[k];
        double low = 1e300, high = -1e300;
        for (int v : info.outline)
          low = std::min(low, m_mesh.pattern[static_cast<std::size_t>(v)].y()), high = std::max(high, m_mesh.pattern[static_cast<std::size_t>(v)].y());
        for (const auto& seam : m_graph.between(static_cast<int>(k), q)) {
          double a = 1e300, b = -1e300;
          for (const auto& s : seam)
            a = std::min(a, m_mesh.pattern[static_cast<std::size_t>(s[0])].y()), b = std::max(b, m_mesh.pattern[static_cast<std::size_t>(s[0])].y());
          if (b - a > 0.3 * (high - low)) ++n_long;
        }
        tube = tube || n_long >= 2;
      }
      const std::string& name = m_pattern.panels[k].name;
      if (tube || name.find("pant") != std::string::npos || name.find("trouser") != std::string::npos || name.find("leg") != std::string::npos)
        tubes.push_back(k);
    }
    // A waistband over a skirt is two tubes as well, one above the other: legs stand side by side, joined by upright seams.
    std::vector<std::size_t> beside;
    for (std::size_t k : tubes)
      if (std::any_of(tubes.begin(), tubes.end(), [&](std::size_t q) { return q != k && m_roles[q].side == m_roles[k].side && upright_seam(k, q); }))
        beside.push_back(k);
    tubes = std::move(beside);
    if (tubes.size() < 4) return;
    for (std::size_t k : tubes) {
      // The crotch is where the other leg's panel of the same side is sewn on; the left leg has it on its inner side.
      double inner = 0;
      for (int q : m_graph.neighbours(static_cast<int>(k)))
        if (std::find(tubes.begin(), tubes.end(), static_cast<std::size_t>(q)) != tubes.end() && m_roles[static_cast<std::size_t>(q)].side == m_roles[k].side)
          for (const auto& seam : m_graph.between(static_cast<int>(k), q))
            for (const auto& s : seam) inner += m_mesh.pattern[static_cast<std::size_t>(s[0])].x() - middle(k).x();
      const bool front = m_roles[k].side == Side::FRONT;
      m_roles[k].part = (inner < 0) == front ? "leg_l" : "leg_r";
    }
  }

  const Pattern& m_pattern;
  const PanelMesh& m_mesh;
  const SeamGraph& m_graph;
  std::vector<PanelRole> m_roles;
  std::vector<bool> m_known;
  std::vector<Words> m_words;
};

} // namespace

SeamGraph::SeamGraph(const PanelMesh& mesh) : m_mesh(&mesh), m_panel_of(mesh.pattern.size()), m_neighbours(mesh.panels.size()) {
  for (std::size_t p = 0; p < mesh.panels.size(); ++p)
    for (int v = mesh.panels[p].first_vertex; v < mesh.panels[p].first_vertex + mesh.panels[p].n_vertices; ++v)
      m_panel_of[static_cast<std::size_t>(v)] = static_cast<int>(p);
  std::vector<std::set<int>> sets(mesh.panels.size());
  for (const MeshSeam& s : mesh.seams)
    for (std::size_t k = 0; k < s.a.size(); ++k) {
      const int p = panel_of(s.a[k]), q = panel_of(s.b[k]);
      if (p != q) sets[static_cast<std::size_t>(p)].insert(q), sets[static_cast<std::size_t>(q)].insert(p);
    }
  for (std::size_t p = 0; p < sets.size(); ++p) m_neighbours[p].assign(sets[p].begin(), sets[p].end());
}

std::vector<std::vector<std::array<int, 2>>> SeamGraph::between(int p, int q) const {
  std::vector<std::vector<std::array<int, 2>>> out;
  for (const MeshSeam& s : m_mesh->seams) {
    std::vector<std::array<int, 2>> stitches;
    for (std::size_t k = 0; k < s.a.size(); ++k) {
      const int a = panel_of(s.a[k]), b = panel_of(s.b[k]);
      if (a == p && b == q) stitches.push_back({s.a[k], s.b[k]});
      else if (a == q && b == p) stitches.push_back({s.b[k], s.a[k]});
    }
    if (stitches.size() >= 2) out.push_back(std::move(stitches));
  }
  return out;
}

std::vector<PanelRole> panel_roles(const Pattern& pattern, const PanelMesh& mesh, const SeamGraph& graph) { return Roles(pattern, mesh, graph).run(); }

} // namespace sloper::pattern

#include <pattern/panel_words.hpp>
#include <pattern/roles/leg_roles.hpp>
#include <pattern/roles/limb_ends.hpp>
#include <pattern/roles/panel_roles.hpp>
#include <pattern/roles/panel_turn.hpp>
#include <pattern/roles/ring_roles.hpp>
#include <pattern/roles/shape_roles.hpp>
#include <sloper/base/units.hpp>
#include <sloper/geometry/polygon.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::pattern {
namespace {

/// Angle about the body from straight ahead up to which a hinted panel is a front, and from which
/// it is a back; between them it wraps around the side.
constexpr double FRONT_WITHIN_DEG = 61, BACK_BEYOND_DEG = 119;

class Roles {
public:
  Roles(const Pattern& pattern, const PanelMesh& mesh, const SeamGraph& graph)
      : m_pattern(pattern), m_mesh(mesh), m_graph(graph), m_roles(pattern.panels.size()) {}

  std::vector<PanelRole> run() {
    const std::size_t n = m_roles.size();
    m_known.assign(n, false);
    for (std::size_t k = 0; k < n; ++k)
      m_words.push_back(words_of(m_pattern, k));
    for (std::size_t k = 0; k < n; ++k)
      by_hint(k);
    for (std::size_t k = 0; k < n; ++k)
      if (!m_known[k])
        by_name(k);
    by_shape();
    necks_by_height();
    face_each_other();
    turn_trunk_panels(m_pattern, m_mesh, m_graph, m_roles);
    for (std::size_t k = 0; k < n; ++k)
      arm_side(k);
    for (std::size_t k = 0; k < n; ++k)
      follow_sleeve(k);
    assign_rings(m_pattern, m_mesh, m_graph, m_words, m_roles);
    turn_arm_panels(m_pattern, m_mesh, m_graph, m_roles);
    assign_legs(m_pattern, m_mesh, m_graph, m_roles);
    return std::move(m_roles);
  }

private:
  Vec2 middle(std::size_t k) const {
    const PanelInfo& p = m_mesh.panels[k];
    Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
    for (int v : p.outline) {
      low = low.cwiseMin(m_mesh.pattern[v]);
      high = high.cwiseMax(m_mesh.pattern[v]);
    }
    return 0.5 * (low + high);
  }
  double width(std::size_t k) const { return width_around(m_mesh, m_roles, k); }

  void side_from_theta(PanelRole& role, double theta) {
    theta = std::remainder(theta, 2 * units::PI);
    role.theta = theta;
    role.side = Side::RING;
    if (std::abs(theta) <= units::radians(FRONT_WITHIN_DEG))
      role.side = Side::FRONT;
    else if (std::abs(theta) >= units::radians(BACK_BEYOND_DEG))
      role.side = Side::BACK;
  }

  void by_hint(std::size_t k) {
    const Panel& panel = m_pattern.panels[k];
    PanelRole& role = m_roles[k];
    const PlacementHint& hint = panel.hint;
    if (!hint.part.empty()) {
      m_known[k] = true;
      role.part = hint.part;
      role.region = Region::TRUNK;
      if (hint.part == "arm_l")
        role.region = Region::ARM_L;
      else if (hint.part == "arm_r")
        role.region = Region::ARM_R;
      else if (hint.part == "neck" || hint.part == "head")
        role.region = Region::NECK;
      if (role.region == Region::NECK) {
        role.side = Side::RING;
        role.theta = hint.theta.value_or(units::PI);
        return;
      }
      if (role.region != Region::TRUNK) { // arms: theta 0 is the outer, upper side
        role.side = Side::RING;
        role.theta = 0;
        return;
      }
      side_from_theta(role, hint.theta.value_or(says_back(m_words[k]) ? units::PI : 0));
      if (hint.anchor && (hint.radius || std::abs(std::remainder(*hint.theta, units::PI)) < 1e-6) &&
          role.side != Side::RING && hint.part != "leg_l" && hint.part != "leg_r")
        role.du =
            std::remainder(role.theta - (role.side == Side::BACK ? units::PI : 0), 2 * units::PI) *
                hint.radius.value_or(0) -
            hint.anchor->x();
      if (hint.anchor && hint.height && (role.du || role.side == Side::RING))
        role.dv = *hint.height - hint.anchor->y();
      return;
    }
    if (!hint.rigid)
      return;
    m_known[k] = true;
    const Mat3 r = hint.rigid->topLeftCorner<3, 3>();
    const Vec3 normal = r.col(2);
    const Vec2 m = middle(k);
    const Vec3 center = (*hint.rigid * Eigen::Vector4d(m.x(), m.y(), 0, 1)).head<3>();
    const Words& words = m_words[k];
    const bool legs = panel.label == "leg" || says_legs(words) || says_skirt(words);
    const bool arm =
        !legs &&
        (says_sleeve(words) || cuff_of_sleeve(k) ||
         (panel.label == "arm" && !any_begins(words, {"torso", "bodice", "ftorso", "btorso"})));
    if (arm)
      role.region = center.x() > 0 ? Region::ARM_L : Region::ARM_R;
    else if (!legs && says_neck(words))
      role.region = Region::NECK;
    else
      role.part = legs ? "lower_body" : "torso";
    if (std::hypot(normal.x(), normal.z()) < 0.3) { // drawn lying: names decide
      role.side = says_back(words) ? Side::BACK : Side::FRONT;
      return;
    }
    side_from_theta(role, std::atan2(normal.x(), normal.z()));
    if (role.region != Region::TRUNK && role.region != Region::NECK)
      return;
    const Vec3 u_axis = Vec3::UnitY().cross(normal).normalized();
    const double angle = std::atan2(r.col(0).y(), r.col(0).dot(u_axis));
    role.turn = Eigen::Rotation2Dd(angle).toRotationMatrix();
    if (role.region == Region::NECK)
      return around_neck(role);
    role.dv = center.y() - (role.turn * m).y();
    if (role.side != Side::RING)
      role.du = (role.side == Side::BACK ? -center.x() : center.x()) - (role.turn * m).x();
  }

  static void around_neck(PanelRole& role) {
    if (role.side == Side::FRONT)
      role.theta = 0;
    role.side = Side::RING;
    role.du.reset();
    role.dv.reset();
  }

  /// Whether level seams at its top join the panel to one of the other side, over more than a
  /// remnant of a side seam that does not meet.
  bool has_shoulder(std::size_t k) const {
    constexpr double REMNANT =
        0.1; // of the panel's width, both shoulders together; straps have more
    if (m_roles[k].part == "lower_body")
      return false; // the sides of a circle skirt are drawn level
    double level = 0;
    double low = 1e300, high = -1e300;
    for (int v : m_mesh.panels[k].outline) {
      low = std::min(low, turned(k, v).y());
      high = std::max(high, turned(k, v).y());
    }
    for (int q : m_graph.neighbours(static_cast<int>(k))) {
      const PanelRole& other = m_roles[q];
      if (other.region != Region::TRUNK || other.side == m_roles[k].side)
        continue;
      for (const auto& seam : m_graph.between(static_cast<int>(k), q)) {
        const Vec2 a = turned(k, seam.front()[0]), b = turned(k, seam.back()[0]);
        if (std::abs(a.x() - b.x()) > std::abs(a.y() - b.y()) &&
            std::min(a.y(), b.y()) > low + 0.75 * (high - low))
          level += (a - b).norm();
      }
    }
    return level > REMNANT * width(k);
  }
  Vec2 turned(std::size_t k, int vertex) const { return m_roles[k].turn * m_mesh.pattern[vertex]; }

  /// Hinted panels without a word for it that stand above all that they are sewn to, near the
  /// middle: hoods, collars.
  void necks_by_height() {
    const auto range = [&](std::size_t k) { // of the height of its hint
      Vec2 y(1e300, -1e300);
      for (int v : m_mesh.panels[k].outline) {
        const Vec2& p = m_mesh.pattern[v];
        const double h =
            (*m_pattern.panels[k].hint.rigid * Eigen::Vector4d(p.x(), p.y(), 0, 1)).y();
        y = Vec2(std::min(y.x(), h), std::max(y.y(), h));
      }
      return y;
    };
    std::vector<std::size_t> found;
    for (std::size_t k = 0; k < m_roles.size(); ++k) {
      const auto& hint = m_pattern.panels[k].hint;
      if (!hint.rigid || m_roles[k].region != Region::TRUNK || m_roles[k].part != "torso" ||
          m_graph.neighbours(static_cast<int>(k)).empty())
        continue;
      const Vec2 own = range(k), m = middle(k);
      const double x = (*hint.rigid * Eigen::Vector4d(m.x(), m.y(), 0, 1)).x();
      bool above = std::abs(x) < 0.2, trunk = false;
      for (int q : m_graph.neighbours(static_cast<int>(k))) {
        const std::size_t o = static_cast<std::size_t>(q);
        if (m_roles[o].region != Region::TRUNK || !m_pattern.panels[o].hint.rigid)
          continue;
        const Vec2 other = range(o);
        const bool lower = 0.5 * (own.x() + own.y()) > other.y() + 0.01 && has_shoulder(o);
        trunk = trunk || lower;
        above = above && (lower || std::abs(own.x() - other.x()) < 0.05); // or is its like
      }
      if (above && trunk)
        found.push_back(k);
    }
    for (std::size_t k : found) {
      m_roles[k].region = Region::NECK;
      m_roles[k].part.clear();
      around_neck(m_roles[k]);
    }
  }

  void by_name(std::size_t k) {
    PanelRole& role = m_roles[k];
    const Words& words = m_words[k];
    role.side = says_back(words) && !any_begins(words, {"front"}) ? Side::BACK : Side::FRONT;
    const bool legs = says_legs(words) || says_skirt(words);
    if (!legs && (says_sleeve(words) || cuff_of_sleeve(k)))
      role.region = says_left(words) ? Region::ARM_L : Region::ARM_R;
    else if (!legs && says_neck(words)) {
      role.region = Region::NECK;
      role.side = Side::RING;
      role.theta = units::PI;
    } else
      role.part = legs || says_cuff(words) ? "lower_body" : "torso";
    role.theta = role.region == Region::NECK || role.side == Side::BACK ? units::PI : 0;
  }

  /// Panels without a telling name or hint go where their shapes and seams say. Their faces and
  /// hands agree with the panels that are known.
  void by_shape() {
    constexpr double SURE = 0.8; // on 60 fresh specifications 695 of 695 parts were right at that
    constexpr double UNSURE =
        1; // log-odds; of 238 fresh specifications 5 had less, 2 of the 3 turned ones
    std::vector<std::size_t> unnamed;
    for (std::size_t k = 0; k < m_roles.size(); ++k)
      if (!m_known[k] && !says_anything(m_words[k]))
        unnamed.push_back(k);
    if (unnamed.empty() || m_pattern.seams.empty())
      return;
    std::vector<ShapeRole> shapes = shape_roles(m_pattern);
    if (more_rims_than_trousers(m_pattern, m_mesh, shapes))
      shapes = shape_roles(m_pattern, role_model(), false);
    collars_are_no_arms(shapes);
    const std::vector<bool> leg_end = follow_limbs(m_mesh, m_graph, shapes);
    double faces = 0; // for and against the shapes' front and back
    for (std::size_t k = 0; k < m_roles.size(); ++k)
      if (says_back(m_words[k]) || name_suggests_front(m_words[k]))
        faces += (m_roles[k].side == Side::BACK) == shapes[k].back ? 1 : -1;
    for (std::size_t k : unnamed) {
      const ShapeRole& shape = shapes[k];
      if (closed_sleeve(k)) {
        m_roles[k].region = Region::ARM_R; // or the left, by what it is sewn to
        continue;
      }
      if (shape.sure < SURE)
        continue;
      PanelRole& role = m_roles[k];
      const bool back = shape.back != (faces < 0);
      const int hand = shape.hand * (faces < 0 ? -1 : 1);
      const std::string part = SHAPE_PART_NAMES[shape.part];
      if (part == "arm" && hand == 0)
        continue;
      role.by_shape = true;
      role.unsure_front = faces == 0 && shape.face_odds < UNSURE;
      role.part.clear();
      role.side = back ? Side::BACK : Side::FRONT;
      role.theta = back ? units::PI : 0;
      if (part == "arm")
        role.region = hand > 0 ? Region::ARM_L : Region::ARM_R;
      else if (part == "neck") {
        role.region = Region::NECK;
        role.side = Side::RING;
        role.theta = units::PI;
      } else if (part == "leg" && hand != 0)
        role.part = hand > 0 ? "leg_l" : "leg_r";
      else
        role.part = part == "torso" ? "torso" : "lower_body";
    }
  }

  /// What is sewn to both halves of a front or back goes around the neck: no sleeve does.
  void collars_are_no_arms(std::vector<ShapeRole>& shapes) const {
    for (std::size_t first = 0; first < shapes.size(); ++first) {
      if (shapes[first].part != ARM_PART || closed_sleeve(first))
        continue;
      std::vector<std::size_t> ring{first};
      bool left = false, right = false;
      for (std::size_t k = 0; k < ring.size(); ++k)
        for (const int q : m_graph.neighbours(static_cast<int>(ring[k]))) {
          const std::size_t other = static_cast<std::size_t>(q);
          if (shapes[other].part == ARM_PART && !closed_sleeve(other)) {
            if (std::find(ring.begin(), ring.end(), other) == ring.end())
              ring.push_back(other);
          } else if (shapes[other].part == TORSO_PART && !shapes[other].back) {
            left = left || shapes[other].hand > 0;
            right = right || shapes[other].hand < 0;
          }
        }
      if (left && right)
        for (const std::size_t k : ring)
          shapes[k].part = NECK_PART;
    }
  }

  /// A piece that closes on itself and is sewn, at one end, to larger pieces.
  bool closed_sleeve(std::size_t k) const {
    constexpr double ACROSS = 0.3, SMALLER = 0.7; // of its size; of the area of what it hangs on
    const int p = static_cast<int>(k);
    Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
    for (int v : m_mesh.panels[k].outline) {
      low = low.cwiseMin(m_mesh.pattern[v]);
      high = high.cwiseMax(m_mesh.pattern[v]);
    }
    const double size = (high - low).norm();
    bool tube = false;
    for (const auto& seam : m_graph.between(p, p)) {
      double apart = 0;
      for (const auto& s : seam)
        apart += (m_mesh.pattern[s[0]] - m_mesh.pattern[s[1]]).norm();
      tube = tube || apart > ACROSS * size * static_cast<double>(seam.size());
    }
    int hangs_on = 0;
    for (int q : m_graph.neighbours(p)) {
      if (q == p)
        continue;
      if (area(k) > SMALLER * area(static_cast<std::size_t>(q)))
        return false;
      ++hangs_on;
    }
    return tube && hangs_on >= 2;
  }

  /// Two panels of unknown sides, sewn to each other at both of their edges: the
  /// larger one, with the higher neck or the fuller seat, is the back.
  void face_each_other() {
    constexpr double ACROSS = 0.5; // of the width, between seams at both sides
    for (std::size_t p = 0; p < m_roles.size(); ++p)
      for (std::size_t q = p + 1; q < m_roles.size(); ++q) {
        if (!tells_no_side(p) || !tells_no_side(q) || m_roles[p].side != Side::FRONT ||
            m_roles[q].side != Side::FRONT)
          continue;
        double apart = 0;
        const auto seams = m_graph.between(static_cast<int>(p), static_cast<int>(q));
        for (const auto& a : seams)
          for (const auto& b : seams)
            apart = std::max(apart, (middle_of(a) - middle_of(b)).norm());
        if (apart < ACROSS * width(p))
          continue;
        const std::size_t back = area(p) > area(q) ? p : q;
        m_roles[back].side = Side::BACK;
        m_roles[back].theta = units::PI;
      }
  }
  bool tells_no_side(std::size_t k) const {
    const PlacementHint& hint = m_pattern.panels[k].hint;
    return m_roles[k].region == Region::TRUNK && !hint.rigid && hint.part.empty() &&
           !says_anything(m_words[k]) && !m_roles[k].by_shape;
  }
  /// Of a seam, on the panel that comes first in its stitches.
  Vec2 middle_of(const std::vector<std::array<int, 2>>& seam) const {
    Vec2 sum = Vec2::Zero();
    for (const auto& s : seam)
      sum += m_mesh.pattern[s[0]];
    return sum / static_cast<double>(seam.size());
  }
  double area(std::size_t k) const {
    return polygon_area(m_mesh.pattern, m_mesh.panels[k].outline);
  }

  /// Cuffs belong to sleeves, unless they are sewn to other panels only: to trousers.
  bool cuff_of_sleeve(std::size_t k) const {
    if (!says_cuff(m_words[k]))
      return false;
    bool other = false;
    for (int q : m_graph.neighbours(static_cast<int>(k))) {
      const std::size_t o = static_cast<std::size_t>(q);
      if (says_sleeve(m_words[o]) || m_pattern.panels[o].hint.part.rfind("arm", 0) == 0)
        return true;
      other = other || !says_cuff(m_words[o]);
    }
    return !other;
  }

  /// A sleeve without a word for its side hangs on the armhole that it is sewn to: seen from
  /// outside, the left armhole of a front is on its +u side, that of a back on its -u side.
  void arm_side(std::size_t k) {
    PanelRole& role = m_roles[k];
    if (role.region != Region::ARM_L && role.region != Region::ARM_R)
      return;
    if (!m_pattern.panels[k].hint.part.empty() || m_pattern.panels[k].hint.rigid) {
      role.part = role.region == Region::ARM_L ? "arm_l" : "arm_r";
      return;
    }
    if (!says_left(m_words[k]) && !says_right(m_words[k]) && !role.by_shape) {
      double vote = 0;
      for (int q : m_graph.neighbours(static_cast<int>(k))) {
        const PanelRole& other = m_roles[q];
        if (other.region != Region::TRUNK)
          continue;
        for (const auto& seam : m_graph.between(static_cast<int>(k), q))
          for (const auto& s : seam)
            vote +=
                (other.turn * (m_mesh.pattern[s[1]] - middle(static_cast<std::size_t>(q)))).x() *
                (other.side == Side::BACK ? -1 : 1);
      }
      role.region = vote >= 0 ? Region::ARM_L : Region::ARM_R;
    }
    role.part = role.region == Region::ARM_L ? "arm_l" : "arm_r";
  }

  /// What is sewn to a sleeve alone, as a cuff, is on the arm of that sleeve.
  void follow_sleeve(std::size_t k) {
    PanelRole& role = m_roles[k];
    const PlacementHint& hint = m_pattern.panels[k].hint;
    if ((role.region != Region::ARM_L && role.region != Region::ARM_R) || role.by_shape ||
        !hint.part.empty() || hint.rigid || says_left(m_words[k]) || says_right(m_words[k]))
      return;
    const auto hangs_on_trunk = [&](int p) {
      const auto near = m_graph.neighbours(p);
      return std::any_of(near.begin(), near.end(),
                         [&](int q) { return m_roles[q].region == Region::TRUNK; });
    };
    const int own = static_cast<int>(k);
    if (hangs_on_trunk(own))
      return;
    for (int q : m_graph.neighbours(own))
      if (q != own && hangs_on_trunk(q) &&
          (m_roles[q].region == Region::ARM_L || m_roles[q].region == Region::ARM_R)) {
        role.region = m_roles[q].region;
        role.part = m_roles[q].part;
        return;
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

std::vector<PanelRole> panel_roles(const Pattern& pattern, const PanelMesh& mesh,
                                   const SeamGraph& graph) {
  return Roles(pattern, mesh, graph).run();
}

} // namespace sloper::pattern

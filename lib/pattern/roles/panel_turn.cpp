#include <pattern/panel_words.hpp>
#include <pattern/roles/leg_roles.hpp>
#include <pattern/roles/panel_turn.hpp>
#include <sloper/base/units.hpp>
#include <sloper/geometry/polygon.hpp>
#include <sloper/pattern/mesh/folds.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace sloper::pattern {
namespace {

using Turn = Eigen::Matrix2d;

constexpr double SNAP = 3; // degrees: a grain this near to an axis, or to a bias, is drawn along it
constexpr double DRAWN_UPRIGHT = 0.75; // of the grain's direction: pieces drawn so stand as drawn
constexpr double GAIN = 0.2; // of the seams' length, by which another turn has to go better with
                             // them than one with the grain upright

Turn rotation(double degrees) {
  return Eigen::Rotation2Dd(units::radians(degrees)).toRotationMatrix();
}

class Turning {
public:
  Turning(const Pattern& pattern, const PanelMesh& mesh, const SeamGraph& graph,
          std::vector<PanelRole>& roles)
      : m_pattern(pattern), m_mesh(mesh), m_graph(graph), m_roles(roles),
        m_known(roles.size(), false) {}

  void run() {
    const std::size_t n = m_roles.size();
    for (std::size_t k = 0; k < n; ++k)
      m_known[k] =
          m_pattern.panels[k].hint.rigid.has_value() || !m_pattern.panels[k].hint.part.empty();
    for (;;) {
      // The panel with the longest seams to those that stand; else the largest that is left.
      std::size_t best = n;
      double most = 0;
      for (std::size_t k = 0; k < n; ++k)
        if (open(k))
          if (const double length = seam_length(k); length > most) {
            most = length;
            best = k;
          }
      if (best < n) {
        if (!stand_as_leg(best))
          follow(best);
      } else {
        for (std::size_t k = 0; k < n; ++k)
          if (open(k))
            if (const double size = area(k); size > most) {
              most = size;
              best = k;
            }
        if (best == n)
          break;
        if (!stand_as_leg(best))
          stand(best);
      }
      m_known[best] = true;
    }
    for (bool changed = true; changed;) { // stands on neck lines, then collars on stands
      changed = false;
      for (std::size_t k = 0; k < n; ++k)
        if (!m_known[k] && m_roles[k].region == Region::NECK && seam_below(k))
          m_known[k] = changed = true;
    }
  }

private:
  bool open(std::size_t k) const { return !m_known[k] && m_roles[k].region == Region::TRUNK; }
  const Vec2& at(int vertex) const { return m_mesh.pattern[vertex]; }

  double area(std::size_t k) const {
    return polygon_area(m_mesh.pattern, m_mesh.panels[k].outline);
  }

  template<class Visit> void seams_to_known(std::size_t k, Visit visit) const {
    for (int q : m_graph.neighbours(static_cast<int>(k))) {
      const std::size_t o = static_cast<std::size_t>(q);
      if (!m_known[o] || m_roles[o].region != Region::TRUNK)
        continue;
      for (const auto& seam : m_graph.between(static_cast<int>(k), q)) {
        const bool at_sides = at_their_sides(m_mesh, m_roles, k, o, seam);
        for (std::size_t i = 0; i + 1 < seam.size(); ++i)
          visit(o, Vec2(at(seam[i + 1][0]) - at(seam[i][0])),
                Vec2(at(seam[i + 1][1]) - at(seam[i][1])), at_sides);
      }
    }
  }

  double seam_length(std::size_t k) const {
    double sum = 0;
    seams_to_known(k, [&](std::size_t, const Vec2& own, const Vec2&, bool) { sum += own.norm(); });
    return sum;
  }

  /// Quarter turns from the drawing or, where it is drawn askew, from the grain; the first is the
  /// drawing's own or next to it.
  std::vector<Turn> candidates(std::size_t k) const {
    const Vec2& grain = m_pattern.panels[k].grain;
    const double lean =
        units::degrees(std::atan2(grain.x(), grain.y())); // of the grain, clockwise from up
    const double off = std::remainder(lean, 45);
    double first = 0;
    if (std::abs(off) > SNAP)
      first = std::remainder(lean, 90);
    std::vector<Turn> out;
    for (double quarter : {0.0, 90.0, -90.0, 180.0})
      out.push_back(rotation(first + quarter));
    return out;
  }

  bool side_known(std::size_t k) const {
    const Words words = words_of(m_pattern, k);
    return m_pattern.panels[k].hint.rigid || !m_pattern.panels[k].hint.part.empty() ||
           name_suggests_front(words) || says_back(words);
  }

  /// The turn that goes best with the seams to panels that stand.
  void follow(std::size_t k) {
    const std::vector<Turn> turns = candidates(k);
    std::vector<double> score(turns.size(), 0);
    double total = 0;
    const bool known = side_known(k);
    seams_to_known(k, [&](std::size_t o, const Vec2& own, const Vec2& other, bool at_sides) {
      const Vec2 b = m_roles[o].turn * other;
      const double length = std::sqrt(own.norm() * b.norm());
      if (!(length > 0))
        return;
      total += length;
      const bool level = goes_level(b) && !at_sides,
                 ring = m_roles[k].side == Side::RING || m_roles[o].side == Side::RING ||
                        closes_on_itself(k) > 0 || closes_on_itself(o) > 0;
      const bool over =
          level && !ring &&
          m_roles[k].side != m_roles[o].side; // over the shoulders, or between the legs
      for (std::size_t t = 0; t < turns.size(); ++t) {
        const Vec2 a = turns[t] * own;
        double along = a.dot(b) / length;
        if (!level)
          along = std::max(along, a.dot(Vec2(-b.x(), b.y())) /
                                      length); // flared panels lean away from each other
        const bool either_way = level && !ring && !(known && side_known(o));
        if (either_way)
          along = std::abs(along);
        else if (over)
          along = -along;
        score[t] += along;
      }
    });
    const std::size_t best =
        static_cast<std::size_t>(std::max_element(score.begin(), score.end()) - score.begin());
    const bool drawn_upright =
        std::abs((turns[0] * m_pattern.panels[k].grain).y()) >= DRAWN_UPRIGHT;
    m_roles[k].turn = turns[score[best] > score[0] + (drawn_upright ? GAIN * total : 0) ? best : 0];
  }

  /// By quarter turns, with the seams to what stands already at the lower edge, of a leaf that is
  /// turned over at the upper one; false where there are none.
  bool seam_below(std::size_t k) {
    Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300), sum = Vec2::Zero();
    for (int v : m_mesh.panels[k].outline) {
      low = low.cwiseMin(at(v));
      high = high.cwiseMax(at(v));
    }
    double count = 0;
    for (const bool trunk :
         {true, false}) { // its own other half only where it is not sewn to the trunk
      for (int q : m_graph.neighbours(static_cast<int>(k)))
        if (const std::size_t o = static_cast<std::size_t>(q);
            m_known[o] && (m_roles[o].region == Region::TRUNK) == trunk)
          for (const auto& seam : m_graph.between(static_cast<int>(k), q))
            for (const auto& s : seam) {
              sum += at(s[0]);
              ++count;
            }
      if (count > 0)
        break;
    }
    if (count == 0)
      return false;
    Vec2 down = sum / count - 0.5 * (low + high);
    if (turned_whole(m_pattern.panels[k]))
      down = -down;
    const std::vector<Turn> turns = candidates(k);
    m_roles[k].turn =
        *std::min_element(turns.begin(), turns.end(), [&](const Turn& a, const Turn& b) {
          return (a * down).y() < (b * down).y() - 1e-9;
        });
    return true;
  }

  /// How much speaks for a turn that has shoulder seams at the top and the hem below, m: level
  /// seams with another panel in the upper quarter, less those in the lower one; 0 where there are
  /// no such seams, or nothing free and level at the other end that is wider.
  double shoulders_up(std::size_t k, const Turn& turn) const {
    constexpr double ZONE = 0.25; // of the panel's height
    if (m_roles[k].part != "torso")
      return 0;
    const auto& outline = m_mesh.panels[k].outline;
    double low = 1e300, high = -1e300;
    for (int v : outline) {
      low = std::min(low, (turn * at(v)).y());
      high = std::max(high, (turn * at(v)).y());
    }
    std::map<int, bool> sewn;
    double seams = 0, hem = 0;
    for (int q : m_graph.neighbours(static_cast<int>(k)))
      for (const auto& seam : m_graph.between(static_cast<int>(k), q)) {
        for (const auto& s : seam)
          sewn[s[0]] = true;
        if (m_roles[q].region != Region::TRUNK)
          continue;
        const Vec2 a = turn * at(seam.front()[0]), b = turn * at(seam.back()[0]);
        if (goes_level(b - a) && std::min(a.y(), b.y()) > high - ZONE * (high - low))
          seams += std::abs(b.x() - a.x());
      }
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const int v = outline[i], w = outline[(i + 1) % outline.size()];
      const Vec2 a = turn * at(v), b = turn * at(w);
      if (!(sewn.count(v) && sewn.count(w)) && goes_level(b - a) &&
          std::max(a.y(), b.y()) < low + ZONE * (high - low))
        hem += std::abs(b.x() - a.x());
    }
    return seams > 0 && hem > seams ? seams : 0;
  }

  /// How far apart the sides are along which a panel is sewn to itself, m, where that is much of
  /// its size: a band, a tube; else 0.
  double closes_on_itself(std::size_t k) const {
    constexpr double ACROSS = 0.3; // of the panel's size: wider than darts
    Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
    for (int v : m_mesh.panels[k].outline) {
      low = low.cwiseMin(at(v));
      high = high.cwiseMax(at(v));
    }
    for (const auto& seam : m_graph.between(static_cast<int>(k), static_cast<int>(k))) {
      double apart = 0;
      for (const auto& s : seam)
        apart += (at(s[0]) - at(s[1])).norm();
      apart /= static_cast<double>(seam.size());
      if (apart > ACROSS * (high - low).norm())
        return apart;
    }
    return 0;
  }

  /// A leg in one piece, sewn to itself across most of its width: with what else it is sewn to, the
  /// crotch, at its upper end. False for others, and where it is drawn upright.
  bool stand_as_leg(std::size_t k) {
    constexpr double LOWEST_LEG = 0.3; // height over width: shorts have 0.5, waistbands 0.1
    if (m_roles[k].part != "lower_body" && !is_leg(m_roles[k]))
      return false;
    const std::vector<Turn> turns = candidates(k);
    if (std::abs((turns[0] * m_pattern.panels[k].grain).y()) >= DRAWN_UPRIGHT)
      return false;
    Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300), up = Vec2::Zero();
    for (int v : m_mesh.panels[k].outline) {
      low = low.cwiseMin(at(v));
      high = high.cwiseMax(at(v));
    }
    double stitches = 0;
    for (int q : m_graph.neighbours(static_cast<int>(k)))
      if (static_cast<std::size_t>(q) != k)
        for (const auto& seam : m_graph.between(static_cast<int>(k), q))
          for (const auto& s : seam) {
            up += at(s[0]) - 0.5 * (low + high);
            ++stitches;
          }
    const double apart = closes_on_itself(k);
    if (stitches == 0 || !(apart > 0) || area(k) < LOWEST_LEG * apart * apart)
      return false;
    m_roles[k].turn =
        *std::max_element(turns.begin(), turns.end(), [&](const Turn& a, const Turn& b) {
          return (a * up).y() < (b * up).y() - 1e-9;
        });
    return true;
  }

  /// Upright as drawn, else along its grain with what is longest and free below.
  void stand(std::size_t k) {
    const std::vector<Turn> turns = candidates(k);
    const Vec2 grain = turns[0] * m_pattern.panels[k].grain;
    if (std::abs(grain.y()) >= DRAWN_UPRIGHT ||
        std::abs(std::abs(grain.x()) - std::abs(grain.y())) < 0.05) {
      m_roles[k].turn = turns[0];
      return;
    }
    if (const double up = shoulders_up(k, turns[1]) - shoulders_up(k, turns[2]); up != 0) {
      m_roles[k].turn = up > 0 ? turns[1] : turns[2];
      return;
    }
    std::vector<char> sewn(m_mesh.pattern.size(), 0);
    for (const MeshSeam& s : m_mesh.seams)
      for (std::size_t i = 0; i < s.a.size(); ++i)
        sewn[s.a[i]] = sewn[s.b[i]] = 1;
    const auto& outline = m_mesh.panels[k].outline;
    Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300), sum = Vec2::Zero();
    double length = 0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const int a = outline[i], b = outline[(i + 1) % outline.size()];
      low = low.cwiseMin(at(a));
      high = high.cwiseMax(at(a));
      if (sewn[a] && sewn[b])
        continue;
      const double l = (at(b) - at(a)).norm();
      sum += 0.5 * l * (at(a) + at(b));
      length += l;
    }
    const Vec2 down = length > 0 ? Vec2(sum / length - 0.5 * (low + high)) : Vec2(0, 0);
    m_roles[k].turn = (turns[1] * down).y() <= (turns[2] * down).y() ? turns[1] : turns[2];
  }

  const Pattern& m_pattern;
  const PanelMesh& m_mesh;
  const SeamGraph& m_graph;
  std::vector<PanelRole>& m_roles;
  std::vector<bool> m_known;
};

} // namespace

void turn_trunk_panels(const Pattern& pattern, const PanelMesh& mesh, const SeamGraph& graph,
                       std::vector<PanelRole>& roles) {
  Turning(pattern, mesh, graph, roles).run();
}

namespace {

class ArmTurning {
public:
  ArmTurning(const Pattern& pattern, const PanelMesh& mesh, const SeamGraph& graph,
             std::vector<PanelRole>& roles)
      : m_pattern(pattern), m_mesh(mesh), m_graph(graph), m_roles(roles),
        m_steps(roles.size(), FAR) {}

  void run() {
    count_steps();
    for (std::size_t k = 0; k < m_roles.size(); ++k)
      if (is_arm(k))
        turn(k);
  }

private:
  static constexpr int FAR = 1 << 20;

  bool is_arm(std::size_t k) const {
    return m_roles[k].region == Region::ARM_L || m_roles[k].region == Region::ARM_R;
  }
  const Vec2& at(int vertex) const { return m_mesh.pattern[vertex]; }
  Vec2 middle(std::size_t k) const {
    Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
    for (int v : m_mesh.panels[k].outline) {
      low = low.cwiseMin(at(v));
      high = high.cwiseMax(at(v));
    }
    return 0.5 * (low + high);
  }

  /// Of each arm panel, over how many panels it hangs on the trunk.
  void count_steps() {
    std::vector<std::size_t> front;
    for (std::size_t k = 0; k < m_roles.size(); ++k)
      if (m_roles[k].region == Region::TRUNK) {
        m_steps[k] = 0;
        front.push_back(k);
      }
    for (std::size_t i = 0; i < front.size(); ++i) // it grows
      for (int q : m_graph.neighbours(static_cast<int>(front[i]))) {
        const std::size_t o = static_cast<std::size_t>(q);
        if (m_steps[o] < FAR || !is_arm(o))
          continue;
        m_steps[o] = m_steps[front[i]] + 1;
        front.push_back(o);
      }
  }

  /// From the panel's middle to where it hangs, by the stitches there.
  Vec2 way_in(std::size_t k) const {
    Vec2 sum = Vec2::Zero();
    for (int q : m_graph.neighbours(static_cast<int>(k))) {
      if (m_steps[q] >= m_steps[k])
        continue;
      for (const auto& seam : m_graph.between(static_cast<int>(k), q))
        for (const auto& s : seam)
          sum += at(s[0]) - middle(k);
    }
    return sum;
  }

  void turn(std::size_t k) {
    const int p = static_cast<int>(k);
    PanelRole& role = m_roles[k];
    std::vector<Vec2> directions;
    const auto add = [&](const std::vector<std::array<int, 2>>& seam, std::size_t side) {
      const Vec2 d = at(seam.back()[side]) - at(seam.front()[side]);
      if (d.norm() > 1e-6)
        directions.push_back(d);
    };
    for (const auto& seam : m_graph.between(p, p)) {
      add(seam, 0);
      add(seam, 1);
    }
    for (int q : m_graph.neighbours(p)) {
      const auto seams = m_graph.between(p, q);
      if (m_roles[q].region == role.region && seams.size() >= 2)
        for (const auto& seam : seams)
          add(seam, 0);
    }
    const Vec2 in = way_in(k);
    Vec2 up(0, 1);
    if (!directions.empty()) {
      const Vec2 guide = in.norm() > 1e-9 ? in : directions[0]; // sides of a flounce lean far out
      Vec2 sum = Vec2::Zero();
      for (const Vec2& d : directions)
        sum += d.dot(guide) < 0 ? Vec2(-d) : d;
      if (sum.norm() > 1e-6)
        up = sum.normalized();
    } else if (m_pattern.panels[k].hint.rigid)
      up = Vec2(1, 0);
    if (in.dot(up) < 0)
      up = -up;
    role.turn << up.y(), -up.x(), up.x(), up.y(); // rows: u = up turned clockwise, v = up
  }

  const Pattern& m_pattern;
  const PanelMesh& m_mesh;
  const SeamGraph& m_graph;
  std::vector<PanelRole>& m_roles;
  std::vector<int> m_steps;
};

} // namespace

void turn_arm_panels(const Pattern& pattern, const PanelMesh& mesh, const SeamGraph& graph,
                     std::vector<PanelRole>& roles) {
  ArmTurning(pattern, mesh, graph, roles).run();
}

} // namespace sloper::pattern

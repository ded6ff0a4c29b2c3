#include <pattern/measure/cloth_rims.hpp>
#include <pattern/panel_words.hpp>
#include <pattern/roles/leg_roles.hpp>
#include <pattern/seams/missing_seams.hpp>

#include <algorithm>

namespace sloper::pattern {
namespace {

class Legs {
public:
  Legs(const Pattern& pattern, const PanelMesh& mesh, const SeamGraph& graph,
       std::vector<PanelRole>& roles)
      : m_pattern(pattern), m_mesh(mesh), m_graph(graph), m_roles(roles) {}

  void run() {
    if (!one_piece())
      four_pieces();
    ends();
  }

private:
  static constexpr double LONG = 0.3;      // of a panel's height: a seam that goes up its side
  static constexpr double LOWER_END = 0.4; // of a leg's height: cuffs are sewn on below

  std::size_t count() const { return m_roles.size(); }
  Vec2 at(std::size_t k, int vertex) const { return m_roles[k].turn * m_mesh.pattern[vertex]; }
  std::array<Vec2, 2> bounds(std::size_t k) const {
    std::array<Vec2, 2> b = {Vec2::Constant(1e300), Vec2::Constant(-1e300)};
    for (int v : m_mesh.panels[k].outline) {
      b[0] = b[0].cwiseMin(at(k, v));
      b[1] = b[1].cwiseMax(at(k, v));
    }
    return b;
  }
  double middle_u(std::size_t k) const { return 0.5 * (bounds(k)[0].x() + bounds(k)[1].x()); }
  auto between(std::size_t k, std::size_t q) const {
    return m_graph.between(static_cast<int>(k), static_cast<int>(q));
  }
  bool upright(std::size_t k, std::size_t q) const {
    return upright_seam(m_mesh, m_graph, m_roles, k, q);
  }

  /// Leggings: a leg in one piece, sewn to itself along the inside, to its like above. The back's
  /// middle seam is the longer one, for it goes over the seat; of a left leg, seen from outside, it
  /// is on the right.
  bool one_piece() {
    std::vector<std::size_t> tubes;
    for (std::size_t k = 0; k < count(); ++k)
      if (m_roles[k].region == Region::TRUNK && m_roles[k].side == Side::RING && upright(k, k))
        tubes.push_back(k);
    double tallest = 0; // a waistband and cuffs are tubes as well
    const auto height = [&](std::size_t k) { return bounds(k)[1].y() - bounds(k)[0].y(); };
    for (std::size_t k : tubes)
      tallest = std::max(tallest, height(k));
    tubes.erase(std::remove_if(tubes.begin(), tubes.end(),
                               [&](std::size_t k) { return height(k) < 0.5 * tallest; }),
                tubes.end());
    if (tubes.size() != 2 || !upright(tubes[0], tubes[1]))
      return false;
    double back[2];
    for (std::size_t i : {0, 1}) {
      const std::size_t k = tubes[i];
      const Words words = words_of(m_pattern, k);
      back[i] = 0;
      for (const auto& seam : between(k, tubes[1 - i]))
        for (std::size_t s = 0; s + 1 < seam.size(); ++s) {
          const Vec2 a = at(k, seam[s][0]), b = at(k, seam[s + 1][0]);
          back[i] += (0.5 * (a.x() + b.x()) > middle_u(k) ? 1 : -1) * (a - b).norm();
        }
      back[i] += (says_left(words) ? 1e3 : 0) - (says_right(words) ? 1e3 : 0);
    }
    const bool first_left = back[0] >= back[1];
    m_roles[tubes[0]].part = first_left ? "leg_l" : "leg_r";
    m_roles[tubes[1]].part = first_left ? "leg_r" : "leg_l";
    return true;
  }

  /// How many sides of panel k are sewn to panel q most of their height. A side may be drawn as
  /// several edges, one after the other.
  int long_seams(std::size_t k, std::size_t q) const {
    struct SewnSide {
      double low = 1e300, high = -1e300;
      std::vector<int> ends;
    };
    std::vector<SewnSide> sides;
    for (const auto& seam : between(k, q)) {
      SewnSide own;
      for (const auto& s : seam) {
        own.low = std::min(own.low, at(k, s[0]).y());
        own.high = std::max(own.high, at(k, s[0]).y());
      }
      for (const auto& end : {seam.front(), seam.back()})
        own.ends.insert(own.ends.end(), end.begin(), end.end());
      for (std::size_t i = sides.size(); i-- > 0;) {
        const SewnSide& other = sides[i];
        if (std::find_first_of(own.ends.begin(), own.ends.end(), other.ends.begin(),
                               other.ends.end()) == own.ends.end())
          continue;
        own.low = std::min(own.low, other.low);
        own.high = std::max(own.high, other.high);
        own.ends.insert(own.ends.end(), other.ends.begin(), other.ends.end());
        sides.erase(sides.begin() + static_cast<long>(i));
      }
      sides.push_back(std::move(own));
    }
    const double least = LONG * (bounds(k)[1].y() - bounds(k)[0].y());
    return static_cast<int>(std::count_if(sides.begin(), sides.end(), [&](const SewnSide& side) {
      return side.high - side.low > least;
    }));
  }

  /// Two front-back tubes that are sewn to each other.
  void four_pieces() {
    std::vector<std::size_t> tubes;
    for (std::size_t k = 0; k < count(); ++k) {
      if (m_roles[k].region != Region::TRUNK || m_roles[k].side == Side::RING)
        continue;
      bool tube = says_legs(words_of(m_pattern, k));
      for (int q : m_graph.neighbours(static_cast<int>(k))) {
        if (m_roles[q].side == m_roles[k].side)
          continue;
        tube = tube || long_seams(k, static_cast<std::size_t>(q)) >= 2;
      }
      if (tube)
        tubes.push_back(k);
    }
    // A waistband over a skirt is two tubes as well, one above the other: legs stand side by side,
    // joined by upright seams.
    std::vector<std::size_t> beside;
    for (std::size_t k : tubes)
      if (std::any_of(tubes.begin(), tubes.end(), [&](std::size_t q) {
            return q != k && m_roles[q].side == m_roles[k].side && upright(k, q);
          }))
        beside.push_back(k);
    tubes = std::move(beside);
    if (tubes.size() < 4)
      return;
    for (std::size_t k : tubes) {
      // The crotch is where the other leg's panel of the same side is sewn on; the left leg has it
      // on its inner side.
      double inner = 0;
      for (int q : m_graph.neighbours(static_cast<int>(k)))
        if (std::find(tubes.begin(), tubes.end(), static_cast<std::size_t>(q)) != tubes.end() &&
            m_roles[q].side == m_roles[k].side)
          for (const auto& seam : between(k, static_cast<std::size_t>(q)))
            for (const auto& s : seam)
              inner += at(k, s[0]).x() - middle_u(k);
      const bool front = m_roles[k].side == Side::FRONT;
      m_roles[k].part = (inner < 0) == front ? "leg_l" : "leg_r";
    }
  }

  /// What is sewn to the lower end of one leg alone goes around it too.
  void ends() {
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t k = 0; k < count(); ++k) {
        if (m_roles[k].region != Region::TRUNK || is_leg(m_roles[k]))
          continue;
        std::string leg;
        bool end = true;
        for (int q : m_graph.neighbours(static_cast<int>(k))) {
          const std::size_t o = static_cast<std::size_t>(q);
          if (m_roles[o].region != Region::TRUNK)
            end = false;
          if (!is_leg(m_roles[o]))
            continue;
          end = end && (leg.empty() || leg == m_roles[o].part);
          leg = m_roles[o].part;
          if (upright(o, k))
            continue; // the cuff's other half
          const auto b = bounds(o);
          for (const auto& seam : between(o, k))
            for (const auto& s : seam)
              end = end && at(o, s[0]).y() < b[0].y() + LOWER_END * (b[1].y() - b[0].y());
        }
        if (leg.empty() || !end)
          continue;
        m_roles[k].part = leg;
        changed = true;
      }
    }
  }

  const Pattern& m_pattern;
  const PanelMesh& m_mesh;
  const SeamGraph& m_graph;
  std::vector<PanelRole>& m_roles;
};

} // namespace

bool at_their_sides(const PanelMesh& mesh, const std::vector<PanelRole>& roles, std::size_t k,
                    std::size_t q, const std::vector<std::array<int, 2>>& seam) {
  double out[2];
  for (const std::size_t end : {0, 1}) {
    const std::size_t panel = end == 0 ? k : q;
    const auto at = [&](int vertex) { return Vec2(roles[panel].turn * mesh.pattern[vertex]); };
    Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300), sum = Vec2::Zero();
    for (int v : mesh.panels[panel].outline) {
      low = low.cwiseMin(at(v));
      high = high.cwiseMax(at(v));
    }
    for (const auto& stitch : seam)
      sum += at(stitch[end]);
    const Vec2 off =
        (sum / static_cast<double>(seam.size()) - 0.5 * (low + high)).cwiseQuotient(high - low);
    if (!(std::abs(off.x()) > std::abs(off.y())))
      return false;
    out[end] = off.x();
  }
  return out[0] * out[1] < 0 || roles[k].side != roles[q].side; // one's left is the other's right
}

bool upright_seam(const PanelMesh& mesh, const SeamGraph& graph,
                  const std::vector<PanelRole>& roles, std::size_t k, std::size_t q) {
  for (const auto& seam : graph.between(static_cast<int>(k), static_cast<int>(q))) {
    Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
    for (const auto& s : seam) {
      const Vec2 p = roles[k].turn * mesh.pattern[s[0]];
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    if (high.y() > low.y() && (!goes_level(high - low) || at_their_sides(mesh, roles, k, q, seam)))
      return true;
  }
  return false;
}

void assign_legs(const Pattern& pattern, const PanelMesh& mesh, const SeamGraph& graph,
                 std::vector<PanelRole>& roles) {
  Legs(pattern, mesh, graph, roles).run();
}

bool more_rims_than_trousers(const Pattern& pattern, const PanelMesh& mesh,
                             const std::vector<ShapeRole>& shapes) {
  constexpr double SHORTEST = 0.15; // m: slits and holes of darts are shorter, sleeves longer
  constexpr int OF_TROUSERS = 3;
  for (const ShapeRole& shape : shapes)
    if (shape.part == TORSO_PART || shape.part == LOWER_BODY_PART)
      return false;
  for (const std::vector<int>& part : sewn_parts(pattern)) {
    const auto has = [&](int p) { return std::find(part.begin(), part.end(), p) != part.end(); };
    const bool legs =
        std::any_of(part.begin(), part.end(), [&](int p) { return shapes[p].part == LEG_PART; });
    if (!legs)
      continue;
    int rims = 0;
    for (const ClothRim& rim : cloth_rims(mesh))
      rims += rim.length > SHORTEST && has(panel_of_vertex(mesh, rim.vertices[0].leaving));
    if (rims > OF_TROUSERS)
      return true;
  }
  return false;
}

} // namespace sloper::pattern

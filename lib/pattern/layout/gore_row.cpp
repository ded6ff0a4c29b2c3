#include <pattern/layout/gore_row.hpp>
#include <pattern/layout/leg_layout.hpp>
#include <pattern/roles/leg_roles.hpp>
#include <pattern/surfaces/section_ring.hpp>
#include <sloper/base/units.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace sloper::pattern {
namespace {

constexpr double ROW = 0.01; // m between the rows that a gore is known by
constexpr double BELOW =
    0.4; // m that a gore's sides go on below their ends: hems hang lower in the middle
constexpr double STEEPEST = 3; // m that a side may lean out for each metre down
constexpr double FLARE = 0.06; // m by which a seam's sides leave each other in flat panels, from
                               // which they count as flared
constexpr double UPRIGHT =
    0.5; // up per across: a seam between panels of one side that leans more is no upright one
constexpr double SIDE_SEAM = 0.8; // the same between front and back, where shoulders slope
constexpr double FLATTEST = 0.2;  // the same of a seam that lies at the sides of both panels
constexpr double TALLEST = 5;     // m: no person's
constexpr double LONG =
    0.15; // of the lower panel's height: what is shorter is a shoulder or a detail

/// u of a side at height v: straight up above its end, on as it leans below.
double side_at(const std::vector<Vec2>& side, double v) { // descending in v
  if (v >= side.front().y())
    return side.front().x();
  for (std::size_t k = 1; k < side.size(); ++k)
    if (v >= side[k].y()) {
      const double span = side[k - 1].y() - side[k].y();
      return side[k].x() +
             (span > 0 ? (v - side[k].y()) / span : 0.0) * (side[k - 1].x() - side[k].x());
    }
  const Vec2& end = side.back();
  std::size_t from = side.size() - 1;
  while (from > 0 && side[from].y() < end.y() + 0.05)
    --from;
  const double span = side[from].y() - end.y();
  const double lean =
      span > 1e-3 ? std::clamp((end.x() - side[from].x()) / span, -STEEPEST, STEEPEST) : 0.0;
  return end.x() + lean * (end.y() - v);
}

} // namespace

Gore::Gore(std::size_t of, std::vector<Vec2> left, std::vector<Vec2> right)
    : panel(of), m_top(-1e300), m_step(ROW) {
  double low = 1e300;
  for (auto* stitches : {&left, &right}) {
    std::stable_sort(stitches->begin(), stitches->end(),
                     [](const Vec2& a, const Vec2& b) { return a.y() > b.y(); });
    m_top = std::max(m_top, stitches->front().y());
    low = std::min(low, stitches->back().y());
  }
  const std::size_t n = static_cast<std::size_t>((m_top - low + BELOW) / m_step) + 2;
  std::vector<double> half;
  for (std::size_t k = 0; k < n; ++k) {
    const double v = m_top - m_step * static_cast<double>(k), l = side_at(left, v),
                 r = side_at(right, v);
    m_rows.push_back({0.5 * (l + r), std::max(0.5 * (r - l), 0.0), 0});
    half.push_back(m_rows.back().half);
  }
  std::vector<double> flare(n, 0);
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t a = k > 0 ? k - 1 : k, b = k + 1 < n ? k + 1 : k;
    flare[k] =
        std::clamp((half[b] - half[a]) / (m_step * static_cast<double>(b - a)), 0.0, STEEPEST);
  }
  flare = averaged(flare, 4);
  for (std::size_t k = 0; k < n; ++k)
    m_rows[k].flare = flare[k];
}

Gore::Row Gore::row_at(double v) const {
  const double x =
      std::clamp((m_top - v) / m_step, 0.0, static_cast<double>(m_rows.size()) - 1.001);
  const std::size_t k = static_cast<std::size_t>(x);
  const double f = x - static_cast<double>(k);
  const Row &a = m_rows[k], &b = m_rows[k + 1];
  return {(1 - f) * a.middle + f * b.middle, (1 - f) * a.half + f * b.half,
          (1 - f) * a.flare + f * b.flare};
}

double Gore::half_width(double row) const {
  const Row r = row_at(row);
  return r.flare > 1e-3 ? r.half * std::atan(r.flare) / r.flare : r.half;
}

Gore::Place Gore::at(const Vec2& uv) const {
  double row = uv.y(), along = 0;
  for (int round = 0; round < 24; ++round) { // of a straight sector the first is exact
    const Row r = row_at(row);
    if (r.flare < 1e-3 || r.half < 1e-4) {
      along = uv.x() - r.middle;
      row = 0.5 * (row + uv.y());
      continue;
    }
    const double radius = r.half / r.flare;
    const Vec2 d(uv.x() - r.middle, row + radius - uv.y()); // from where the sides meet
    along = std::atan2(d.x(), std::max(d.y(), 1e-6)) * radius;
    row = std::min(0.5 * (row + (row + radius - d.norm())), uv.y() + 0.05);
  }
  return {row, along};
}

namespace {

class Finder {
public:
  Finder(const PanelMesh& mesh, const SeamGraph& graph, const std::vector<PanelRole>& roles,
         const std::vector<PanelSpot>& spots)
      : m_mesh(mesh), m_graph(graph), m_roles(roles),
        m_spots(spots), m_links{std::vector<Links>(roles.size()),
                                std::vector<Links>(roles.size())} {
    for (std::size_t k = 0; k < roles.size(); ++k)
      if (fits(k))
        find_links(k);
  }

  std::vector<GoreRow> run() {
    std::vector<GoreRow> rings;
    std::vector<char> met(m_roles.size(), 0);
    for (std::size_t k = 0; k < m_roles.size(); ++k) {
      if (met[k] || !fits(k))
        continue;
      const std::vector<std::size_t> row = row_of(k);
      if (row.empty())
        continue;
      for (std::size_t p : row)
        met[p] = 1;
      if (auto ring = ring_of(row)) {
        for (const Gore& g : ring->gores)
          met[g.panel] = 1;
        rings.push_back(std::move(*ring));
      }
    }
    return rings;
  }

private:
  enum { LEFT, RIGHT };
  struct Link {
    double top = -1e300, bottom = 1e300;
    std::vector<Vec2> side; ///< (u, v) on the own panel
  };
  using Links = std::map<std::size_t, Link>;

  bool fits(std::size_t k) const {
    return m_roles[k].region == Region::TRUNK && !is_leg(m_roles[k]) && height(k) < TALLEST;
  }
  Vec2 uv(std::size_t k, int vertex) const { return laid(m_mesh, m_roles[k], m_spots[k], vertex); }

  double height(std::size_t k) const {
    const auto b = laid_bounds(m_mesh, m_roles[k], m_spots[k], static_cast<int>(k));
    return b[1].y() - b[0].y();
  }

  /// Whether (u, v) on the outline is nearer to the right end of its level line than to the left
  /// one.
  double rightness(std::size_t k, const Vec2& p) const {
    double low = 1e300, high = -1e300;
    const auto& outline = m_mesh.panels[k].outline;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Vec2 a = uv(k, outline[i]), b = uv(k, outline[(i + 1) % outline.size()]);
      if (std::min(a.y(), b.y()) > p.y() || std::max(a.y(), b.y()) < p.y())
        continue;
      for (double t : {0.0, 1.0}) {
        const double x = std::abs(b.y() - a.y()) > 1e-9
                             ? a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())
                             : (1 - t) * a.x() + t * b.x();
        low = std::min(low, x);
        high = std::max(high, x);
      }
    }
    return high > low + 1e-6 ? (p.x() - 0.5 * (low + high)) / (high - low) : 0;
  }

  void find_links(std::size_t k) {
    for (int neighbour : m_graph.neighbours(static_cast<int>(k))) {
      const std::size_t q = static_cast<std::size_t>(neighbour);
      if (!fits(q) || m_mesh.panels[q].layer != m_mesh.panels[k].layer)
        continue;
      for (const auto& seam : m_graph.between(static_cast<int>(k), neighbour)) {
        Vec2 extent[2];
        for (std::size_t end : {0, 1}) {
          Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
          for (const auto& s : seam) {
            const Vec2 p = uv(end ? q : k, s[end]);
            low = low.cwiseMin(p);
            high = high.cwiseMax(p);
          }
          extent[end] = high - low;
        }
        const double steep = m_roles[k].side == m_roles[q].side ? UPRIGHT : SIDE_SEAM;
        const double least_rise = at_their_sides(m_mesh, m_roles, k, q, seam) ? FLATTEST : steep;
        if (extent[0].y() < least_rise * extent[0].x() ||
            extent[1].y() < least_rise * extent[1].x())
          continue;
        double right = 0;
        for (const auto& s : seam)
          right += rightness(k, uv(k, s[0]));
        Link& link = m_links[right > 0 ? RIGHT : LEFT][k][q];
        for (const auto& s : seam) {
          link.side.push_back(uv(k, s[0]));
          link.top = std::max(link.top, uv(k, s[0]).y());
          link.bottom = std::min(link.bottom, uv(k, s[0]).y());
        }
      }
      const double least = LONG * std::min(height(k), height(q));
      for (auto& links : m_links)
        if (const auto link = links[k].find(q);
            link != links[k].end() && link->second.top - link->second.bottom < least)
          links[k].erase(link);
    }
  }

  /// The panel that is sewn on highest at that side; none where it does not say the same of this
  /// one's other side.
  std::optional<std::size_t> next(std::size_t k, int direction) const {
    const auto highest = [&](std::size_t of, int side) {
      std::optional<std::size_t> best;
      for (const auto& [q, link] : m_links[side][of])
        if (!best || link.top > m_links[side][of].at(*best).top + 1e-9)
          best = q;
      return best;
    };
    const auto q = highest(k, direction);
    return q && highest(*q, 1 - direction) == k ? q : std::nullopt;
  }

  /// All around, or from one end to the other of an open row; nothing for a panel that stands
  /// alone.
  std::vector<std::size_t> row_of(std::size_t first) const {
    std::vector<std::size_t> row = {first};
    for (const int direction : {RIGHT, LEFT}) {
      for (;;) {
        const auto q = next(direction == RIGHT ? row.back() : row.front(), direction);
        if (!q)
          break;
        if (std::find(row.begin(), row.end(), *q) != row.end())
          return row; // closed
        row.insert(direction == RIGHT ? row.end() : row.begin(), *q);
      }
    }
    return row.size() > 1 ? row : std::vector<std::size_t>();
  }

  /// Panels let in between p and q, which are sewn together above them: from the one to the other.
  std::vector<std::size_t> let_in(std::size_t p, std::size_t q) const {
    for (const auto& [first, link] : m_links[RIGHT][p]) {
      std::vector<std::size_t> row;
      for (std::optional<std::size_t> k = first; k && *k != q && row.size() < m_roles.size();) {
        row.push_back(*k);
        if (m_links[RIGHT][*k].count(q))
          return row;
        k = next(*k, RIGHT);
      }
    }
    return {};
  }

  /// m by which the sides of the seam between p and q lean away from each other towards its lower
  /// end.
  double flare(std::size_t p, std::size_t q) const {
    const auto a = m_links[RIGHT][p].find(q), b = m_links[LEFT][q].find(p);
    if (a == m_links[RIGHT][p].end() || b == m_links[LEFT][q].end() ||
        a->second.side.size() != b->second.side.size())
      return 0;
    std::vector<Vec2> across; // (width, height)
    for (std::size_t k = 0; k < a->second.side.size(); ++k)
      across.push_back({a->second.side[k].x() - b->second.side[k].x(), a->second.side[k].y()});
    std::stable_sort(across.begin(), across.end(),
                     [](const Vec2& x, const Vec2& y) { return x.y() > y.y(); });
    double narrowest = 1e300, most = 0;
    for (const Vec2& w : across) {
      narrowest = std::min(narrowest, w.x());
      most = std::max(most, w.x() - narrowest);
    }
    return most;
  }

  std::optional<GoreRow> ring_of(const std::vector<std::size_t>& row) const {
    const std::size_t n = row.size();
    bool flared = false;
    std::vector<std::pair<std::size_t, bool>> order; // and whether it is a godet
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t p = row[i], q = row[(i + 1) % n];
      order.push_back({p, false});
      if (p == q || (n == 2 && i == 1 && !m_links[RIGHT][p].count(q)))
        continue;
      for (std::size_t g : let_in(p, q))
        if (std::find(row.begin(), row.end(), g) == row.end()) {
          order.push_back({g, true});
          flared = true;
        }
      if (m_roles[p].side == m_roles[q].side)
        flared = flared || flare(p, q) > FLARE;
    }
    if (!flared)
      return std::nullopt;
    GoreRow ring;
    ring.top = -1e300;
    ring.bottom = 1e300;
    for (const auto& [k, godet] : order) {
      std::vector<Vec2> sides[2];
      for (const int side : {LEFT, RIGHT})
        for (const auto& [q, link] : m_links[side][k])
          sides[side].insert(sides[side].end(), link.side.begin(), link.side.end());
      const auto bounds = laid_bounds(m_mesh, m_roles[k], m_spots[k], static_cast<int>(k));
      for (const int side : {LEFT, RIGHT}) // the free end of an open row goes straight down
        if (sides[side].empty())
          sides[side] = {Vec2(bounds[side].x(), bounds[1].y()),
                         Vec2(bounds[side].x(), bounds[0].y())};
      ring.gores.emplace_back(k, sides[LEFT], sides[RIGHT]);
      Gore& gore = ring.gores.back();
      gore.godet = godet;
      gore.side = m_roles[k].side;
      gore.theta = m_roles[k].theta;
      const double size = (bounds[1] - bounds[0]).norm();
      for (int v : m_mesh.panels[k].outline) {
        const Gore::Place at = gore.at(uv(k, v));
        if (std::abs(at.along) > size || at.row < bounds[0].y() - 0.5 * size)
          return std::nullopt; // its sides are not where it is drawn
        ring.top = std::max({ring.top, at.row, uv(k, v).y()});
        ring.bottom = std::min(ring.bottom, at.row);
      }
    }
    if (std::all_of(row.begin(), row.end(), [&](std::size_t k) {
          return m_roles[k].side != Side::RING && m_roles[k].side == m_roles[row[0]].side;
        }))
      look_around(ring);
    return ring;
  }

  /// All of them are taken for fronts, or for backs: the first keeps where it looks, and the others
  /// go on from there.
  static void look_around(GoreRow& ring) {
    double around = 0, at = 0;
    for (const Gore& g : ring.gores)
      around += 2 * g.half_width(ring.top);
    const double first = ring.gores[0].half_width(ring.top),
                 looks = ring.gores[0].side == Side::BACK ? units::PI : 0;
    for (Gore& g : ring.gores) {
      g.side = Side::RING;
      g.theta =
          looks + 2 * units::PI * (at + g.half_width(ring.top) - first) / std::max(around, 1e-6);
      at += 2 * g.half_width(ring.top);
    }
  }

  const PanelMesh& m_mesh;
  const SeamGraph& m_graph;
  const std::vector<PanelRole>& m_roles;
  const std::vector<PanelSpot>& m_spots;
  std::vector<Links> m_links[2];
};

} // namespace

std::vector<GoreRow> GoreRow::find(const PanelMesh& mesh, const SeamGraph& graph,
                                   const std::vector<PanelRole>& roles,
                                   const std::vector<PanelSpot>& spots) {
  return Finder(mesh, graph, roles, spots).run();
}

} // namespace sloper::pattern

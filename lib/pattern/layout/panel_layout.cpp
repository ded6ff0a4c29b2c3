#include <pattern/layout/panel_layout.hpp>
#include <pattern/roles/leg_roles.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::pattern {
namespace {

constexpr double ASIDE =
    0.03; // m that a panel is off its seams, from which it was put at another's place

class Layout {
public:
  Layout(const Pattern& pattern, const PanelMesh& mesh, const SeamGraph& graph,
         std::vector<PanelRole>& roles)
      : m_pattern(pattern), m_mesh(mesh), m_graph(graph), m_roles(roles), m_spots(roles.size()),
        m_done(roles.size(), false), m_u_known(roles.size(), false), m_block(roles.size(), -1) {}

  std::vector<PanelSpot> run() {
    for (Region region : {Region::TRUNK, Region::ARM_L, Region::ARM_R, Region::NECK})
      lay_region(region);
    return std::move(m_spots);
  }

private:
  std::size_t count() const { return m_roles.size(); }
  Vec2 at(std::size_t panel, int vertex) const {
    return laid(m_mesh, m_roles[panel], m_spots[panel], vertex);
  }
  std::array<Vec2, 2> bounds(std::size_t panel) const {
    return laid_bounds(m_mesh, m_roles[panel], m_spots[panel], static_cast<int>(panel));
  }

  bool same_layer(std::size_t p, std::size_t q) const {
    return m_mesh.panels[p].layer == m_mesh.panels[q].layer;
  }

  double seam_length(std::size_t p, std::size_t q) const {
    double sum = 0;
    for (const auto& seam : m_graph.between(static_cast<int>(p), static_cast<int>(q)))
      for (std::size_t k = 0; k + 1 < seam.size(); ++k)
        sum += (m_mesh.pattern[seam[k + 1][0]] - m_mesh.pattern[seam[k][0]]).norm();
    return sum;
  }

  void lay_region(Region region) {
    const bool trunk = region == Region::TRUNK;
    for (std::size_t k = 0; k < count(); ++k) {
      if (m_roles[k].region != region || !m_roles[k].dv)
        continue;
      m_spots[k].offset.y() = *m_roles[k].dv;
      m_done[k] = true;
      if (m_roles[k].du) {
        m_spots[k].offset.x() = *m_roles[k].du;
        m_u_known[k] = true;
      }
    }
    for (;;) {
      // The unplaced panel with the longest seam to a placed one; seams within one side count ten
      // times.
      std::size_t best = count(), partner = count();
      double most = 0;
      for (std::size_t k = 0; k < count(); ++k) {
        if (m_roles[k].region != region || m_done[k])
          continue;
        for (int q : m_graph.neighbours(static_cast<int>(k))) {
          const std::size_t o = static_cast<std::size_t>(q);
          if (m_roles[o].region != region || !m_done[o])
            continue;
          const double score = seam_length(k, o) * (m_roles[k].side == m_roles[o].side ? 10 : 1);
          if (score > most) {
            most = score;
            best = k;
            partner = o;
          }
        }
      }
      if (best < count()) {
        attach(best, partner);
        continue;
      }
      // A new piece: the widest that is left, or for arms and necks the one sewn to the trunk.
      for (std::size_t k = 0; k < count(); ++k) {
        if (m_roles[k].region != region || m_done[k])
          continue;
        double score = 1 + (bounds(k)[1] - bounds(k)[0]).prod();
        if (!trunk)
          for (int q : m_graph.neighbours(static_cast<int>(k)))
            score += m_roles[q].region == Region::TRUNK ? 10 : 0;
        if (score > most) {
          most = score;
          best = k;
        }
      }
      if (best == count())
        break;
      m_spots[best].offset = Vec2(0, 0);
      if (!trunk)
        m_spots[best].offset.y() = -bounds(best)[1].y();
      m_block[best] = static_cast<int>(best);
      m_done[best] = true;
    }
    if (trunk)
      align_rows();
    middle_blocks(region);
    if (trunk)
      close_level_seams();
  }

  bool upright(std::size_t p, std::size_t q) const {
    Vec2 along = Vec2::Zero();
    bool sides = true;
    for (const auto& seam : m_graph.between(static_cast<int>(p), static_cast<int>(q))) {
      along += (at(p, seam.back()[0]) - at(p, seam.front()[0])).cwiseAbs();
      sides = sides && at_their_sides(m_mesh, m_roles, p, q, seam);
    }
    return sides || !goes_level(along);
  }

  /// Panels side by side that were attached one to the other, the first of them to a panel whose u
  /// is known, as halves of a skirt to its waistband: all of their seams with such panels together
  /// say where the row goes, or it would be off to the side of the last.
  void align_rows() {
    std::vector<bool> met(count(), false);
    const auto in_row = [&](std::size_t k) {
      return m_roles[k].region == Region::TRUNK && m_roles[k].side != Side::RING &&
             !is_leg(m_roles[k]) && !m_roles[k].du;
    };
    for (std::size_t first = 0; first < count(); ++first) {
      if (met[first] || !in_row(first))
        continue;
      std::vector<std::size_t> row = {first};
      met[first] = true;
      double shift = 0;
      int n = 0;
      for (std::size_t i = 0; i < row.size(); ++i) // it grows
        for (int neighbour : m_graph.neighbours(static_cast<int>(row[i]))) {
          const std::size_t p = row[i], q = static_cast<std::size_t>(neighbour);
          if (m_roles[q].side != m_roles[p].side || !same_layer(p, q))
            continue;
          if (m_roles[q].du) {
            for (const auto& seam : m_graph.between(static_cast<int>(p), neighbour))
              for (const auto& s : seam) {
                shift += at(q, s[1]).x() - at(p, s[0]).x();
                ++n;
              }
          } else if (!met[q] && in_row(q) && upright(p, q)) {
            met[q] = true;
            row.push_back(q);
          }
        }
      if (row.size() < 2 || n == 0)
        continue;
      for (std::size_t k : row)
        m_spots[k].offset.x() += shift / n;
    }
  }

  /// Hints may leave panels above each other far apart, or overlapping: along level seams the lower
  /// one is brought to PANEL_GAP below.
  void close_level_seams() {
    std::vector<std::size_t> order;
    for (std::size_t k = 0; k < count(); ++k)
      if (m_roles[k].region == Region::TRUNK)
        order.push_back(k);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return middle_of(a).y() > middle_of(b).y() + 1e-9;
    });
    for (std::size_t i = 0; i < order.size(); ++i) {
      const std::size_t p = order[i];
      double shift = 1e300;
      for (std::size_t j = 0; j < i; ++j) {
        const std::size_t q = order[j];
        if (m_roles[p].side != m_roles[q].side && m_roles[p].side != Side::RING &&
            m_roles[q].side != Side::RING)
          continue;
        if (!same_layer(p, q))
          continue;
        Vec2 along = Vec2::Zero();
        double open = 1e300; // along the seam itself: gores stand aside of what they hang from, and
                             // columns that both cover may miss it
        for (const auto& seam : m_graph.between(static_cast<int>(p), static_cast<int>(q))) {
          along += (at(p, seam.back()[0]) - at(p, seam.front()[0])).cwiseAbs();
          for (const auto& s : seam)
            open = std::min(open, at(q, s[1]).y() - at(p, s[0]).y());
        }
        if (along.x() < 0.05 || upright(p, q))
          continue; // no seam, an upright or a small one
        const double clearance = m_roles[p].side == m_roles[q].side
                                     ? column_clearance(p, q)
                                     : bounds(q)[0].y() - bounds(p)[1].y();
        shift = std::min(shift, (open < clearance - ASIDE ? open : clearance) - PANEL_GAP);
      }
      if (shift < 1e299)
        m_spots[p].offset.y() += shift;
    }
  }

  /// How far p lies below q, over the columns that both cover, m; negative where they overlap.
  double column_clearance(std::size_t p, std::size_t q) const {
    const auto bp = bounds(p), bq = bounds(q);
    const double from = std::max(bp[0].x(), bq[0].x()), to = std::min(bp[1].x(), bq[1].x());
    if (from >= to)
      return bq[0].y() - bp[1].y();
    double least = 1e300;
    for (int k = 1; k < 100; ++k) {
      const double line = from + (to - from) * k / 100;
      const double top = reach(p, line, 1), bottom = reach(q, line, -1);
      if (top > -1e299 && bottom < 1e299)
        least = std::min(least, bottom - top);
    }
    return least < 1e299 ? least : bq[0].y() - bp[1].y();
  }

  /// Highest (sense 1) or lowest (-1) v of a panel's outline on the column u.
  double reach(std::size_t panel, double u, double sense) const {
    double best = -1e300;
    const auto& outline = m_mesh.panels[panel].outline;
    for (std::size_t k = 0; k < outline.size(); ++k) {
      const Vec2 a = at(panel, outline[k]), b = at(panel, outline[(k + 1) % outline.size()]);
      if ((a.x() <= u) == (b.x() <= u))
        continue;
      best = std::max(best, sense * (a.y() + (u - a.x()) / (b.x() - a.x()) * (b.y() - a.y())));
    }
    return sense * best;
  }

  /// Puts panel p where its seams with q ask for.
  void attach(std::size_t p, std::size_t q) {
    Vec2 own = Vec2::Zero(), other = Vec2::Zero();
    int n = 0;
    for (const auto& seam : m_graph.between(static_cast<int>(p), static_cast<int>(q))) {
      for (const auto& s : seam) {
        own += at(p, s[0]);
        other += at(q, s[1]);
        ++n;
      }
    }
    const bool level = !upright(p, q), same_side = m_roles[p].side == m_roles[q].side;
    m_spots[p].offset += (other - own) / std::max(n, 1);
    if (same_side && level)
      m_spots[p].offset.x() += off_its_row(p);
    m_done[p] = true;
    if (!same_side) {
      m_spots[p].offset.x() = 0;
      m_block[p] = static_cast<int>(p);
      return;
    }
    m_block[p] = m_block[q];
    m_u_known[p] = m_u_known[q];
    if (!same_layer(p, q))
      return;                               // it lies over the other, seam on seam
    const std::size_t axis = level ? 1 : 0; // a level seam parts them in v, an upright one in u
    const Vec2 mine = middle_of(p), theirs = middle_of(q);
    part(p, q, static_cast<long>(axis),
         mine[static_cast<long>(axis)] >= theirs[static_cast<long>(axis)] ? 1 : -1);
  }

  /// How far in u panel p is from all that it stands on, or hangs from, on its side, m: a bodice
  /// over gores is over the middle one, though it was put over the first.
  double off_its_row(std::size_t p) const {
    double sum = 0, count = 0;
    for (int neighbour : m_graph.neighbours(static_cast<int>(p))) {
      const std::size_t o = static_cast<std::size_t>(neighbour);
      if (!m_done[o] || m_roles[o].region != m_roles[p].region ||
          m_roles[o].side != m_roles[p].side || !same_layer(p, o) || upright(p, o))
        continue;
      for (const auto& seam : m_graph.between(static_cast<int>(p), neighbour))
        for (const auto& s : seam) {
          sum += at(o, s[1]).x() - at(p, s[0]).x();
          ++count;
        }
    }
    return std::abs(sum) > ASIDE * count ? sum / count : 0;
  }

  Vec2 middle_of(std::size_t p) const {
    const auto b = bounds(p);
    return 0.5 * (b[0] + b[1]);
  }

  /// Moves p along an axis until it is PANEL_GAP of q on every line across.
  void part(std::size_t p, std::size_t q, long axis, double sense) {
    const long across = 1 - axis;
    double need = 0;
    const auto extent = [&](std::size_t panel, double line, double& low, double& high) {
      low = 1e300;
      high = -1e300;
      const auto& outline = m_mesh.panels[panel].outline;
      for (std::size_t k = 0; k < outline.size(); ++k) {
        const Vec2 a = at(panel, outline[k]), b = at(panel, outline[(k + 1) % outline.size()]);
        if ((a[across] <= line) == (b[across] <= line))
          continue;
        const double x =
            a[axis] + (line - a[across]) / (b[across] - a[across]) * (b[axis] - a[axis]);
        low = std::min(low, x);
        high = std::max(high, x);
      }
    };
    const auto bp = bounds(p), bq = bounds(q);
    const double from = std::max(bp[0][across], bq[0][across]),
                 to = std::min(bp[1][across], bq[1][across]);
    for (int k = 1; k < 200; ++k) {
      const double line = from + (to - from) * k / 200;
      double pl, ph, ql, qh;
      extent(p, line, pl, ph);
      extent(q, line, ql, qh);
      if (pl > ph || ql > qh)
        continue;
      need = std::max(need, sense > 0 ? qh + PANEL_GAP - pl : ph + PANEL_GAP - ql);
    }
    if (need > 0)
      m_spots[p].offset[axis] += sense * need;
  }

  /// Blocks of panels without a known u: their middle goes to u = 0; of two blocks on one side,
  /// left to the left.
  void middle_blocks(Region region) {
    for (Side side : {Side::FRONT, Side::BACK, Side::RING}) {
      std::vector<int> blocks;
      for (std::size_t k = 0; k < count(); ++k)
        if (m_roles[k].region == region && m_roles[k].side == side && !m_u_known[k] &&
            m_block[k] >= 0 && std::find(blocks.begin(), blocks.end(), m_block[k]) == blocks.end())
          blocks.push_back(m_block[k]);
      std::vector<std::array<Vec2, 2>> taken;
      for (int block : blocks) {
        Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
        bool left = true, right = true;
        for (std::size_t k = 0; k < count(); ++k) {
          if (m_block[k] != block)
            continue;
          const auto b = bounds(k);
          low = low.cwiseMin(b[0]);
          high = high.cwiseMax(b[1]);
          const std::string& part = m_roles[k].part;
          const std::string& name = m_pattern.panels[k].name;
          const auto ends_with = [&](const std::string& tail) {
            return name.size() > tail.size() &&
                   name.compare(name.size() - tail.size(), tail.size(), tail) == 0;
          };
          left = left && (part == "leg_l" || ends_with("_l") || ends_with("left"));
          right = right && (part == "leg_r" || ends_with("_r") || ends_with("right"));
        }
        double shift = -0.5 * (low.x() + high.x());
        double hand = 0;
        if (right)
          hand = -1;
        if (left)
          hand = 1;
        const double sense = hand * (side == Side::BACK ? -1.0 : 1.0);
        if (region == Region::TRUNK && side != Side::RING && sense != 0)
          shift = sense > 0 ? 0.5 * PANEL_GAP - low.x() : -0.5 * PANEL_GAP - high.x();
        for (std::size_t k = 0; k < count(); ++k)
          if (m_block[k] == block)
            m_spots[k].offset.x() += shift;
      }
    }
  }

  const Pattern& m_pattern;
  const PanelMesh& m_mesh;
  const SeamGraph& m_graph;
  std::vector<PanelRole>& m_roles;
  std::vector<PanelSpot> m_spots;
  std::vector<bool> m_done, m_u_known;
  std::vector<int> m_block; ///< panels whose relative u is known share one
};

} // namespace

Vec2 laid(const PanelMesh& mesh, const PanelRole& role, const PanelSpot& spot, int vertex) {
  return role.turn * mesh.pattern[vertex] + spot.offset;
}

std::array<Vec2, 2> laid_bounds(const PanelMesh& mesh, const PanelRole& role, const PanelSpot& spot,
                                int panel) {
  std::array<Vec2, 2> b = {Vec2::Constant(1e300), Vec2::Constant(-1e300)};
  for (int v : mesh.panels[panel].outline) {
    const Vec2 p = laid(mesh, role, spot, v);
    b[0] = b[0].cwiseMin(p);
    b[1] = b[1].cwiseMax(p);
  }
  return b;
}

double covered(const PanelMesh& mesh, const PanelRole& role, const PanelSpot& spot, int panel,
               double v) {
  const auto& outline = mesh.panels[panel].outline;
  std::vector<double> at;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2 p = laid(mesh, role, spot, outline[i]),
               q = laid(mesh, role, spot, outline[(i + 1) % outline.size()]);
    if ((p.y() <= v) != (q.y() <= v))
      at.push_back(p.x() + (v - p.y()) / (q.y() - p.y()) * (q.x() - p.x()));
  }
  std::sort(at.begin(), at.end());
  double sum = 0;
  for (std::size_t i = 0; i + 1 < at.size(); i += 2)
    sum += at[i + 1] - at[i];
  return sum;
}

std::vector<PanelSpot> lay_out(const Pattern& pattern, const PanelMesh& mesh,
                               const SeamGraph& graph, std::vector<PanelRole>& roles) {
  return Layout(pattern, mesh, graph, roles).run();
}

} // namespace sloper::pattern

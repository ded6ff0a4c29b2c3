#include <pattern/seams/garment_energy.hpp>
#include <sloper/base/units.hpp>
#include <sloper/geometry/disjoint_sets.hpp>

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace sloper::pattern {
namespace {

using ClassBounds = std::initializer_list<double>;
using G = GarmentClues;
// Where values are cut into classes; the weights (seam_model.json) belong to them.
constexpr ClassBounds ODDS_CLASSES = {-8, -6, -4.5, -3, -2, -1, 0, 1, 2.5, 4.6, 7};
constexpr ClassBounds RATIO_CLASSES = {0.003, 0.01, 0.03, 0.08, 0.15, 0.3, 0.5, 0.8}; // logarithms
constexpr ClassBounds CLOSED_DEGREES = {200, 290, 330, 350,
                                        370, 390, 420}; // of cloth around a point
constexpr ClassBounds OPEN_DEGREES = {100, 140, 165, 180, 195, 220, 290, 340};
constexpr ClassBounds UNEVENNESS = {0.01, 0.04, 0.1, 0.2, 0.4}; // logarithms: a gather that goes on
constexpr ClassBounds RIM_LENGTHS = {0.1, 0.25, 0.5, 0.9};      // m
constexpr double CUSP = 300;                        // degrees of cloth at the end of a slit
constexpr double CUSP_SIDES = 0.01;                 // logarithm of lengths
constexpr double LEAST_FLAT = 150, MOST_FLAT = 210; // degrees: an outline that goes on
constexpr int MOST_MEETING = 4;                     // seams at a point that are distinguished

std::size_t class_of(double x, ClassBounds bounds) {
  std::size_t k = 0;
  for (double b : bounds)
    k += x > b;
  return k;
}

} // namespace

GarmentView::GarmentView(const Pattern& pattern, const std::vector<SeamSide>& sides,
                         const std::vector<double>& base)
    : m_n(sides.size()), m_sides(sides), m_base(base), m_mirrors(panel_mirrors(pattern)),
      m_panels(pattern.panels.size()) {
  std::vector<std::vector<int>> node_of; // by panel and edge
  for (const Panel& panel : pattern.panels)
    node_of.emplace_back(static_cast<std::size_t>(panel.n_edges()), -1);
  for (std::size_t k = 0; k < m_n; ++k) {
    const SeamSide& s = sides[k];
    m_panel.push_back(s.panel);
    m_length.push_back(s.length);
    m_angle.push_back(s.corner_start);
    for (int e = 0; e < s.count; ++e)
      node_of[s.panel][s.loop_begin + (s.first - s.loop_begin + e) % s.loop_size] =
          static_cast<int>(k);
  }
  m_next.assign(m_n, -1);
  m_last.assign(m_n, -1);
  for (int p = 0; p < std::ssize(pattern.panels); ++p) {
    int begin = 0;
    for (const auto& loop : pattern.panels[p].loops) {
      std::vector<int> nodes;
      for (int e = begin; e < begin + std::ssize(loop); ++e) {
        int node = node_of[p][e];
        if (node < 0) {
          const SeamSide s = measure_side(pattern, p, e, 1);
          node = std::ssize(m_next);
          m_next.push_back(-1);
          m_last.push_back(-1);
          m_panel.push_back(p);
          m_length.push_back(s.length);
          m_angle.push_back(s.corner_start);
        }
        if (nodes.empty() || nodes.back() != node)
          nodes.push_back(node);
      }
      if (nodes.size() > 1 && nodes.front() == nodes.back())
        nodes.pop_back();
      for (std::size_t k = 0; k < nodes.size(); ++k) {
        m_next[nodes[k]] = nodes[(k + 1) % nodes.size()];
        m_last[nodes[(k + 1) % nodes.size()]] = nodes[k];
      }
      begin += static_cast<int>(loop.size());
      ++m_loops;
    }
  }
  m_axis.assign(m_next.size(), 0);
  for (std::size_t k = 0; k < m_n; ++k)
    for (const PanelMirror& m : m_mirrors[sides[k].panel])
      if (m.panel == sides[k].panel && sides[k].loop_begin == 0) {
        const int n = sides[k].loop_size, before = (sides[k].first + n - 1) % n;
        m_axis[k] = m_axis[k] || m.image(sides[k].first, n) == before;
      }
}

const GarmentView::Images& GarmentView::images(int i, int j) const {
  const SidePair key = ordered_sides(i, j);
  const auto [found, made] = m_images.try_emplace(key);
  Images& out = found->second;
  if (!made)
    return out;
  const auto image = [&](int k, const PanelMirror& m) {
    const SeamSide& s = m_sides[k];
    if (s.loop_begin > 0)
      return -1;
    const int edge = m.image(s.last(), s.loop_size);
    for (std::size_t q = 0; q < m_n; ++q)
      if (m_sides[q].panel == m.panel && m_sides[q].first == edge && m_sides[q].count == s.count)
        return static_cast<int>(q);
    return -1;
  };
  const int p = m_panel[key[0]], q = m_panel[key[1]];
  const auto symmetric = [&](int panel) {
    return std::any_of(m_mirrors[panel].begin(), m_mirrors[panel].end(),
                       [&](const PanelMirror& m) { return m.panel == panel; });
  };
  for (const PanelMirror& a : m_mirrors[p])
    for (const PanelMirror& b : m_mirrors[q]) {
      if (p == q && (a.panel != b.panel || a.sum != b.sum))
        continue;
      const int k = image(key[0], a), l = image(key[1], b);
      if (k < 0 || l < 0 || k == l)
        continue;
      const bool first = (a.panel == p || !symmetric(p)) && (b.panel == q || !symmetric(q));
      const SidePair pair = ordered_sides(k, l);
      if (pair == key) {
        out.own_any = true;
        out.own_first = out.own_first || first;
        continue;
      }
      out.any.push_back(pair);
      if (first)
        out.first.push_back(pair);
    }
  return out;
}

bool GarmentView::is_middle(int i, int j) const {
  const SeamSide &a = m_sides[i], &b = m_sides[j];
  if (a.panel == b.panel || a.loop_begin > 0 || b.loop_begin > 0)
    return false;
  return std::any_of(m_mirrors[a.panel].begin(), m_mirrors[a.panel].end(),
                     [&](const PanelMirror& m) {
                       return m.panel == b.panel && m.image(a.last(), a.loop_size) == b.first;
                     });
}

void GarmentView::count_pairs(const Matching& partner, GarmentCounts& out) const {
  const auto has = [&](const std::vector<SidePair>& pairs) {
    return std::any_of(pairs.begin(), pairs.end(),
                       [&](const SidePair& s) { return partner[s[0]] == s[1]; });
  };
  for (int i = 0; i < static_cast<int>(m_n); ++i) {
    const int j = partner[i];
    if (j < i)
      continue;
    ++out[G::AT_ODDS + class_of(base(i, j), ODDS_CLASSES)];
    ++out[G::AT_RATIOS + class_of(std::abs(std::log(m_length[i] / m_length[j])), RATIO_CLASSES)];
    const Images& twins = images(i, j);
    if (!twins.own_any && !twins.any.empty() && !has(twins.any))
      ++out[G::AT_TWINS];
    if (!twins.own_first && !twins.first.empty() && !has(twins.first))
      ++out[G::AT_TWINS + 1];
  }
}

void GarmentView::count_closed(const std::vector<int>& corners, const Matching& partner,
                               GarmentCounts& out) const {
  const std::size_t n = corners.size();
  // Between a corner and the next one its seam is crossed.
  const auto ratio = [&](std::size_t k) {
    const int own = corners[k];
    return std::log(m_length[own] / m_length[partner[own]]);
  };
  const auto middle = [&](std::size_t k) { return is_middle(corners[k], partner[corners[k]]); };
  if (n == 4)
    for (std::size_t k = 0; k < 2; ++k) {
      ++out[G::AT_EVENNESS + class_of(std::abs(ratio(k) + ratio(k + 2)), UNEVENNESS)];
      ++out[G::AT_MIDDLES + static_cast<std::size_t>(middle(k)) +
            static_cast<std::size_t>(middle(k + 2))];
    }
  if (n == 3)
    for (std::size_t k = 0; k < 3; ++k) {
      const double angle = units::degrees(m_angle[corners[k]]);
      if (angle < LEAST_FLAT || angle > MOST_FLAT)
        continue;
      // Its panel goes on along both seams; the third one ends there.
      ++out[G::AT_EVENNESS + G::EVENNESS / 2 +
            class_of(std::abs(ratio((k + 2) % 3) + ratio(k)), UNEVENNESS)];
      ++out[G::AT_MIDDLES + 3 + 2 * static_cast<std::size_t>(m_axis[corners[k]] != 0) +
            static_cast<std::size_t>(middle((k + 1) % 3))];
      break;
    }
}

void GarmentView::count_vertex(const std::vector<int>& corners, bool closed,
                               const Matching& partner, GarmentCounts& out) const {
  double angle = 0;
  for (const int c : corners)
    angle += units::degrees(m_angle[c]);
  const std::size_t many =
      static_cast<std::size_t>(std::min<int>(MOST_MEETING, std::ssize(corners)) - 1);
  if (closed) {
    ++out[G::AT_CLOSED + many * (G::CLOSED / MOST_MEETING) + class_of(angle, CLOSED_DEGREES)];
    count_closed(corners, partner, out);
    return;
  }
  ++out[G::AT_OPEN + many * (G::OPEN / MOST_MEETING) + class_of(angle, OPEN_DEGREES)];
  const int before = m_last[corners.front()], after = corners.back();
  if (angle > CUSP && before != after &&
      std::abs(std::log(m_length[before] / m_length[after])) < CUSP_SIDES)
    ++out[G::AT_SLITS + static_cast<std::size_t>(corners.size() > 1)];
}

GarmentCounts GarmentView::counts(const Matching& partner) const {
  GarmentCounts out{};
  count_pairs(partner, out);
  const int nodes = std::ssize(m_next), n = static_cast<int>(m_n);
  const auto sewn = [&](int k) { return k < n && partner[k] >= 0; };
  DisjointSets parts(m_panels);
  std::vector<char> any(m_panels, 0);
  int free_nodes = 0, seams = 0;
  for (int k = 0; k < nodes; ++k) {
    if (!sewn(k)) {
      ++free_nodes;
      continue;
    }
    if (m_panel[k] != m_panel[partner[k]])
      any[m_panel[k]] = 1;
    parts.unite(m_panel[k], m_panel[partner[k]]);
    seams += k < partner[k];
  }
  int vertices = 0;
  std::vector<char> seen(m_next.size(), 0);
  std::vector<int> corners, rim_next(m_next.size(), -1);
  for (const bool closed : {false, true}) // rims first, then what is left
    for (int first = 0; first < nodes; ++first) {
      if (seen[first] || (!closed && sewn(m_last[first])))
        continue;
      corners.clear();
      int k = first;
      while (true) {
        seen[k] = 1;
        corners.push_back(k);
        if (!sewn(k))
          break;
        k = m_next[partner[k]];
        if (seen[k])
          break;
      }
      if (!closed)
        rim_next[m_last[first]] = corners.back();
      count_vertex(corners, closed, partner, out);
      ++vertices;
    }
  int rims = 0;
  std::vector<char> walked(m_next.size(), 0);
  for (int k = 0; k < nodes; ++k) {
    if (sewn(k) || walked[k])
      continue;
    double length = 0;
    int many = 0, last = k;
    for (int at = k; at >= 0 && !walked[at]; at = rim_next[at]) {
      walked[at] = 1;
      length += m_length[at];
      ++many;
      last = at;
    }
    ++rims;
    ++out[G::AT_RIM_SIZES + class_of(length, RIM_LENGTHS)];
    if (many == 2 && m_panel[last] != m_panel[k] &&
        std::abs(std::log(m_length[k] / m_length[last])) < CUSP_SIDES)
      ++out[G::AT_SLITS];
  }
  int components = 0, alone = 0;
  for (std::size_t p = 0; p < m_panels; ++p) {
    components += parts.find(static_cast<int>(p)) == static_cast<int>(p);
    alone += !any[p];
  }
  // Euler's characteristic of all parts: 2 - 2 handles - rims of each.
  const int euler =
      vertices - (seams + free_nodes) + 2 * static_cast<int>(m_panels) - static_cast<int>(m_loops);
  out[G::AT_TOPOLOGY] = 0.5 * (2 * components - rims - euler);
  out[G::AT_TOPOLOGY + 1] = components - 1;
  out[G::AT_TOPOLOGY + 2] = m_panels > 1 ? alone : 0;
  ++out[G::AT_RIMS + static_cast<std::size_t>(std::min<int>(rims, G::RIMS - 1))];
  return out;
}

double garment_score(const GarmentCounts& counts, const std::vector<double>& weights) {
  double sum = 0;
  for (std::size_t k = 0; k < counts.size() && k < weights.size(); ++k)
    sum += counts[k] * weights[k];
  return sum;
}

} // namespace sloper::pattern

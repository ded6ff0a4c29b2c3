#include <pattern/roles/shape_roles.hpp>

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace sloper::pattern {
namespace {

std::uint8_t step(double x, std::initializer_list<double> bounds) {
  int k = 0;
  for (double b : bounds)
    k += x > b;
  return static_cast<std::uint8_t>(k);
}

const std::initializer_list<double> SHARES = {0.001, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4,
                                              0.5,   0.6,  0.7, 0.8,  0.9, 0.99};
constexpr std::size_t OWN_CLUES = 24; // of a panel alone; those with others' parts come after

} // namespace

ShapeWitness::ShapeWitness(const Pattern& pattern) : m_faces(pattern) {
  const std::vector<SeamSide> sides = seam_sides(pattern, all_corners(pattern), 0);
  const SeamWitness pairs(pattern, sides);
  const auto mirrors = panel_mirrors(pattern);
  std::vector<std::vector<int>> side_of;
  for (const Panel& p : pattern.panels)
    side_of.emplace_back(static_cast<std::size_t>(p.n_edges()), -1);
  for (std::size_t k = 0; k < sides.size(); ++k)
    side_of[sides[k].panel][sides[k].first] = static_cast<int>(k);
  const auto at = [&](const Run& run) {
    return static_cast<std::size_t>(side_of[run.panel][run.edge]);
  };
  std::vector<double> partner(sides.size(), 0); // log ratio of what a side is sewn to
  std::vector<char> sewn(sides.size(), 0);
  const std::size_t n = pattern.panels.size();
  std::vector<double> self(n, 0);
  std::vector<std::vector<std::size_t>> neighbours(n);
  for (const Seam& seam : pattern.seams) {
    for (const auto* runs : {&seam.a, &seam.b})
      for (const Run& run : *runs)
        sewn[at(run)] = 1;
    const std::size_t i = at(seam.a[0]), j = at(seam.b[0]);
    const double ratio = std::log(std::max(side_length(pattern, seam.a), 1e-6) /
                                  std::max(side_length(pattern, seam.b), 1e-6));
    for (const Run& run : seam.a)
      partner[at(run)] = ratio;
    for (const Run& run : seam.b)
      partner[at(run)] = -ratio;
    const std::size_t p = static_cast<std::size_t>(seam.a[0].panel),
                      q = static_cast<std::size_t>(seam.b[0].panel);
    if (p == q) {
      self[p] += sides[i].length;
      continue;
    }
    neighbours[p].push_back(q);
    neighbours[q].push_back(p);
    Link link;
    link.a = p;
    link.b = q;
    link.length = side_length(pattern, seam.a);
    link.x_a = sides[i].place.x();
    link.x_b = sides[j].place.x();
    if (!pairs.look(i, j, link.evidence))
      link.evidence = {};
    link.middle = link.evidence[static_cast<std::size_t>(Clue::KINSHIP)] == 5;
    m_links.push_back(link);
  }
  double largest = 0;
  m_panels.resize(n);
  std::vector<Vec2> size(n);
  for (std::size_t p = 0; p < n; ++p) {
    Vec2 low = Vec2::Constant(1e300), high = -low;
    const Panel& panel = pattern.panels[p];
    for (const PanelEdge& e : panel.loops[0]) {
      const ArcLength arc(e.path);
      for (int k = 0; k < 6; ++k) {
        const Vec2 v = arc.at(arc.length() * k / 6),
                   g(panel.grain.y() * v.x() - panel.grain.x() * v.y(), v.dot(panel.grain));
        low = low.cwiseMin(g);
        high = high.cwiseMax(g);
      }
    }
    size[p] = (high - low).cwiseMax(1e-6);
    m_panels[p].area = panel.area();
    m_panels[p].height = size[p].y();
    largest = std::max(largest, m_panels[p].area);
  }
  for (std::size_t p = 0; p < n; ++p) {
    Seen& own = m_panels[p];
    double around = 0, free = 0, hollow = 0, round = 0, bottom = 0, top = 0, top_sewn = 0,
           longer = 0, shorter = 0, darts = 0, upright_free = 0;
    for (std::size_t k = 0; k < sides.size(); ++k) {
      const SeamSide& s = sides[k];
      if (static_cast<std::size_t>(s.panel) != p)
        continue;
      around += s.length;
      if (!sewn[k])
        free += s.length;
      if (s.bulge > 0.03)
        hollow += s.length;
      if (s.bulge < -0.03)
        round += s.length;
      const double across = std::abs(s.chord.x());
      if (across > std::abs(s.chord.y())) {
        if (s.place.y() < 0.25 && !sewn[k])
          bottom += across;
        if (s.place.y() > 0.6)
          (sewn[k] ? top_sewn : top) += across;
      } else if (!sewn[k])
        upright_free += s.length;
      longer = std::max(longer, partner[k]);
      shorter = std::max(shorter, -partner[k]);
      darts += s.corner_end > 4.7;
    }
    own.symmetric = false;
    int others = 0;
    for (const PanelMirror& m : mirrors[p]) {
      own.symmetric = own.symmetric || static_cast<std::size_t>(m.panel) == p;
      others += static_cast<std::size_t>(m.panel) != p;
    }
    double side_area = 0, side_height = 0;
    for (std::size_t q : neighbours[p]) {
      side_area = std::max(side_area, m_panels[q].area);
      side_height = std::max(side_height, m_panels[q].height);
    }
    std::sort(neighbours[p].begin(), neighbours[p].end());
    neighbours[p].erase(std::unique(neighbours[p].begin(), neighbours[p].end()),
                        neighbours[p].end());
    const std::initializer_list<double> ratios = {0.1,  0.2,  0.4,  0.6,  0.75, 0.85,
                                                  0.93, 0.97, 0.99, 1.01, 1.03, 1.07,
                                                  1.15, 1.3,  1.6,  2.5,  4,    8};
    const std::uint8_t clues[OWN_CLUES] = {
        step(around, {0.3, 0.5, 0.7, 0.9, 1.1, 1.4, 1.7, 2, 2.5, 3, 4, 6}),
        step(size[p].y() / size[p].x(),
             {0.08, 0.15, 0.25, 0.4, 0.6, 0.8, 1, 1.2, 1.5, 1.9, 2.5, 3.5, 5, 8}),
        step(own.area / (size[p].x() * size[p].y()), {0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.99}),
        step(static_cast<double>(pattern.panels[p].loops[0].size()),
             {3.5, 4.5, 5.5, 6.5, 7.5, 8.5, 10.5, 13.5, 18.5}),
        step(free / around, SHARES),
        step(self[p] / around, SHARES),
        step(static_cast<double>(neighbours[p].size()), {0.5, 1.5, 2.5, 3.5, 4.5, 5.5, 7.5}),
        static_cast<std::uint8_t>(std::min(others, 9)),
        static_cast<std::uint8_t>(own.symmetric),
        step(hollow / around, SHARES),
        step(round / around, SHARES),
        step(bottom / size[p].x(), SHARES),
        step(top / size[p].x(), SHARES),
        step(top_sewn / size[p].x(), SHARES),
        step(upright_free / size[p].y(), SHARES),
        step(longer, {0.01, 0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 1}),
        step(shorter, {0.01, 0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 1}),
        step(darts, {0.5, 1.5, 2.5, 4.5}),
        step(size[p].y(), {0.04, 0.08, 0.12, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.85, 1, 1.3}),
        step(size[p].x(), {0.04, 0.08, 0.12, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.85, 1, 1.3}),
        step(own.area / largest, {0.03, 0.06, 0.1, 0.2, 0.3, 0.5, 0.7, 0.9, 0.999}),
        step(side_area > 0 ? own.area / side_area : 0, ratios),
        step(side_height > 0 ? own.height / side_height : 0, ratios),
        step(static_cast<double>(n), {1.5, 2.5, 3.5, 4.5, 6.5, 8.5, 11.5, 15.5, 20.5})};
    std::copy(clues, clues + OWN_CLUES, own.evidence.begin());
  }
}

Evidence ShapeWitness::panel(std::size_t k) const {
  return m_panels[k].evidence;
}

Evidence ShapeWitness::panel(std::size_t k,
                             const std::vector<std::array<double, SHAPE_PARTS>>& parts) const {
  Evidence out = m_panels[k].evidence;
  std::array<double, SHAPE_PARTS> most{}, all{};
  double relative[2] = {0, 0}; // area and height of the largest neighbour of its own part
  const std::size_t own = static_cast<std::size_t>(
      std::max_element(parts[k].begin(), parts[k].end()) - parts[k].begin());
  for (const Link& l : m_links) {
    if (l.a != k && l.b != k)
      continue;
    const std::size_t q = l.a == k ? l.b : l.a;
    for (std::size_t c = 0; c < SHAPE_PARTS; ++c)
      most[c] = std::max(most[c], parts[q][c]);
    if (parts[q][own] > 0.5) {
      relative[0] = std::max(relative[0], m_panels[q].area);
      relative[1] = std::max(relative[1], m_panels[q].height);
    }
  }
  for (const auto& p : parts)
    for (std::size_t c = 0; c < SHAPE_PARTS; ++c)
      all[c] = std::max(all[c], p[c]);
  std::size_t at = OWN_CLUES;
  for (std::size_t c = 0; c < SHAPE_PARTS; ++c)
    out[at++] = step(most[c], SHARES);
  for (std::size_t c = 0; c < SHAPE_PARTS && at + 4 < CLUES; ++c)
    if (c == 1 || c == 0)
      out[at++] = step(all[c], SHARES);
  const std::initializer_list<double> ratios = {0.3,   0.6,  0.8,  0.9, 0.95, 0.98, 0.995,
                                                1.005, 1.02, 1.05, 1.1, 1.25, 1.7,  3};
  out[at++] = step(relative[0] > 0 ? m_panels[k].area / relative[0] : 0, ratios);
  out[at++] = step(relative[1] > 0 ? m_panels[k].height / relative[1] : 0, ratios);
  out[at++] = static_cast<std::uint8_t>(own);
  return out;
}

Evidence ShapeWitness::link(const Link& link, const std::vector<std::size_t>& parts) const {
  Evidence out = link.evidence;
  const std::size_t a = std::min(parts[link.a], parts[link.b]),
                    b = std::max(parts[link.a], parts[link.b]);
  out[FIRST_LOOK] = static_cast<std::uint8_t>(b * (b + 1) / 2 + a);
  out[FIRST_LOOK + 1] =
      step(link.length / std::max(std::min(m_panels[link.a].height, m_panels[link.b].height), 1e-6),
           {0.1, 0.2, 0.3, 0.45, 0.6, 0.75, 0.9, 1.1, 1.5});
  const double x[2] = {std::abs(link.x_a - 0.5), std::abs(link.x_b - 0.5)};
  out[FIRST_LOOK + 2] = step(std::min(x[0], x[1]), {0.05, 0.15, 0.25, 0.35, 0.45});
  out[FIRST_LOOK + 3] = step(std::max(x[0], x[1]), {0.05, 0.15, 0.25, 0.35, 0.45});
  return out;
}

} // namespace sloper::pattern

#include <pattern/pattern.hpp>

#include <algorithm>
#include <cstdio>

namespace sloper::pattern {

int Panel::n_edges() const {
  int n = 0;
  for (const auto& loop : loops) n += static_cast<int>(loop.size());
  return n;
}

const PanelEdge& Panel::edge(int index) const {
  std::size_t k = static_cast<std::size_t>(index);
  for (const auto& loop : loops) {
    if (k < loop.size()) return loop[k];
    k -= loop.size();
  }
  throw std::out_of_range("panel edge");
}

PanelEdge& Panel::edge(int index) { return const_cast<PanelEdge&>(static_cast<const Panel&>(*this).edge(index)); }

int Panel::find_edge(const std::string& wanted) const {
  int k = 0;
  for (const auto& loop : loops)
    for (const PanelEdge& e : loop) {
      if (e.name == wanted) return k;
      ++k;
    }
  return -1;
}

int Pattern::find_panel(const std::string& wanted) const {
  for (std::size_t k = 0; k < panels.size(); ++k)
    if (panels[k].name == wanted) return static_cast<int>(k);
  return -1;
}

double run_length(const Pattern& pattern, const Run& run) {
  return std::abs(run.to - run.from) * length(pattern.panels[static_cast<std::size_t>(run.panel)].edge(run.edge).path);
}

double side_length(const Pattern& pattern, const std::vector<Run>& side) {
  double sum = 0;
  for (const Run& run : side) sum += run_length(pattern, run);
  return sum;
}

void turn_over(Pattern& pattern, int index) {
  Panel& panel = pattern.panels[static_cast<std::size_t>(index)];
  std::vector<int> renumber; // new index of each old edge
  int first = 0;
  for (auto& loop : panel.loops) {
    const int n = static_cast<int>(loop.size());
    for (int k = 0; k < n; ++k) renumber.push_back(first + n - 1 - k);
    first += n;
    std::reverse(loop.begin(), loop.end());
    for (PanelEdge& e : loop) {
      e.path = reversed(e.path);
      for (Segment& s : e.path)
        for (Vec2& p : s.p) p.x() = -p.x();
    }
  }
  panel.grain.x() = -panel.grain.x();
  for (Notch& n : panel.notches) n.edge = renumber[static_cast<std::size_t>(n.edge)], n.at = 1 - n.at;
  if (panel.hint.anchor) panel.hint.anchor->x() *= -1;
  if (panel.hint.rigid) {
    Mat4 turn = Mat4::Identity();
    turn(0, 0) = turn(2, 2) = -1; // half a turn about y: the same cloth in the same place, seen from behind
    panel.hint.rigid = *panel.hint.rigid * turn;
  }
  for (Seam& seam : pattern.seams)
    for (auto* side : {&seam.a, &seam.b})
      for (Run& run : *side)
        if (run.panel == index) run.edge = renumber[static_cast<std::size_t>(run.edge)], run.from = 1 - run.from, run.to = 1 - run.to;
}

std::string place_of(const Pattern& pattern, const Run& run) {
  const Panel& panel = pattern.panels[static_cast<std::size_t>(run.panel)];
  return panel.name + ": " + panel.edge(run.edge).name;
}

std::string centimetres(double metres) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f cm", metres * 100);
  return text;
}

} // namespace sloper::pattern

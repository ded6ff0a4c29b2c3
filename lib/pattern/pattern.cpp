#include <sloper/base/text.hpp>
#include <sloper/pattern/pattern.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::pattern {

double Panel::area() const {
  std::vector<Path> outline;
  for (const PanelEdge& e : loops[0])
    outline.push_back(e.path);
  return std::abs(signed_area(outline));
}

int Panel::n_edges() const {
  int n = 0;
  for (const auto& loop : loops)
    n += static_cast<int>(loop.size());
  return n;
}

const PanelEdge& Panel::edge(int index) const {
  std::size_t k = static_cast<std::size_t>(index);
  for (const auto& loop : loops) {
    if (k < loop.size())
      return loop[k];
    k -= loop.size();
  }
  throw std::out_of_range("panel edge");
}

PanelEdge& Panel::edge(int index) {
  return const_cast<PanelEdge&>(static_cast<const Panel&>(*this).edge(index));
}

int Panel::find_edge(const std::string& wanted) const {
  int k = 0;
  for (const auto& loop : loops)
    for (const PanelEdge& e : loop) {
      if (e.name == wanted)
        return k;
      ++k;
    }
  return -1;
}

int Pattern::find_panel(const std::string& wanted) const {
  for (std::size_t k = 0; k < panels.size(); ++k)
    if (panels[k].name == wanted)
      return static_cast<int>(k);
  return -1;
}

double run_length(const Pattern& pattern, const Run& run) {
  return std::abs(run.to - run.from) * length(pattern.panels[run.panel].edge(run.edge).path);
}

double side_length(const Pattern& pattern, const std::vector<Run>& side) {
  double sum = 0;
  for (const Run& run : side)
    sum += run_length(pattern, run);
  return sum;
}

namespace {

Vec2 reflect(const Vec2& p, const Vec2& origin, const Vec2& along) {
  const Vec2 d = p - origin;
  return origin + 2 * d.dot(along) * along - d;
}

std::vector<PanelEdge> reflected(const std::vector<PanelEdge>& edges, const Vec2& origin,
                                 const Vec2& along, const std::string& suffix) {
  std::vector<PanelEdge> out;
  for (auto it = edges.rbegin(); it != edges.rend(); ++it) {
    PanelEdge e{it->name + suffix, reversed(it->path)};
    for (Segment& s : e.path)
      for (Vec2& p : s.p)
        p = reflect(p, origin, along);
    out.push_back(std::move(e));
  }
  return out;
}

} // namespace

bool unfold(Panel& panel, int fold_edge, const std::string& suffix,
            const std::string& mirror_suffix) {
  auto& loop = panel.loops[0];
  if (fold_edge >= std::ssize(loop) || loop.size() < 2)
    return false;
  const Path line = loop[fold_edge].path;
  const Vec2 origin = line.front().p[0], end = line.back().p[3];
  if (!((end - origin).norm() > 1e-6))
    return false;
  const Vec2 along = (end - origin).normalized();
  for (const Segment& s : line)
    for (const Vec2& p : s.p)
      if ((reflect(p, origin, along) - p).norm() > 1e-3)
        return false;
  std::rotate(loop.begin(), loop.begin() + fold_edge, loop.end());
  loop.erase(loop.begin());
  std::vector<PanelEdge> other = reflected(loop, origin, along, mirror_suffix);
  // Both halves meet on the fold line exactly.
  loop.front().path.front().p[0] = other.back().path.back().p[3] = end;
  loop.back().path.back().p[3] = other.front().path.front().p[0] = origin;
  for (PanelEdge& e : loop)
    e.name += suffix;
  loop.insert(loop.end(), other.begin(), other.end());
  for (std::size_t h = 1, n = panel.loops.size(); h < n; ++h) {
    panel.loops.push_back(reflected(panel.loops[h], origin, along, mirror_suffix));
    for (PanelEdge& e : panel.loops[h])
      e.name += suffix;
  }
  for (std::size_t k = 0, n = panel.lines.size(); k < n; ++k) {
    InnerLine image = panel.lines[k];
    for (Segment& s : image.path)
      for (Vec2& p : s.p)
        p = reflect(p, origin, along);
    keep_side(image);
    image.name += mirror_suffix;
    panel.lines[k].name += suffix;
    panel.lines.push_back(std::move(image));
  }
  return true;
}

void keep_side(InnerLine& line) {
  if (line.kind == "roll")
    line.path = reversed(line.path);
}

Panel mirror_image(const Panel& panel) {
  const Vec2 origin(0, 0), along(0, 1);
  Panel out = panel;
  std::vector<int> moved; // index of each edge in the image
  int first = 0;
  for (std::size_t l = 0; l < panel.loops.size(); ++l) {
    out.loops[l] = reflected(panel.loops[l], origin, along, "");
    const int n = std::ssize(panel.loops[l]);
    for (int e = 0; e < n; ++e)
      moved.push_back(first + n - 1 - e);
    first += n;
  }
  for (Notch& notch : out.notches) {
    notch.edge = moved[notch.edge];
    notch.at = 1 - notch.at;
  }
  for (InnerLine& line : out.lines) {
    for (Segment& s : line.path)
      for (Vec2& p : s.p)
        p = reflect(p, origin, along);
    keep_side(line);
  }
  out.grain.x() = -out.grain.x();
  return out;
}

std::string place_of(const Pattern& pattern, const Run& run) {
  const Panel& panel = pattern.panels[run.panel];
  return panel.name + ": " + panel.edge(run.edge).name;
}

std::string centimetres(double metres) {
  return sloper::centimetres(metres, 2);
}

} // namespace sloper::pattern

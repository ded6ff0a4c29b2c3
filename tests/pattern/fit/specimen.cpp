#include "specimen.hpp"

#include <sloper/pattern/read/read_pattern.hpp>
#include <sloper/pattern/write/export_pattern.hpp>

#include <map>

namespace sloper::pattern::fit {
namespace {

constexpr double SHORTEST = 0.004; // m

/// The pattern as a DXF without names, seams and placement gives it, and the seams left out.
std::vector<Seam> through_dxf(Pattern& pattern) {
  std::vector<Seam> seams = std::move(pattern.seams);
  pattern.seams.clear();
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
    Panel& panel = pattern.panels[p];
    panel.name = "P" + std::to_string(1000 + p);
    panel.label.clear();
    panel.hint = {};
    for (int e = 0; e < panel.n_edges(); ++e)
      panel.edge(e).name = std::to_string(e);
  }
  std::vector<std::string> left_out;
  Pattern read = read_dxf(pattern_dxf(pattern, left_out), "p.dxf");
  for (Seam& seam : seams)
    for (auto* side : {&seam.a, &seam.b})
      for (Run& run : *side) {
        const Panel& panel = pattern.panels[run.panel];
        const std::string edge = panel.edge(run.edge).name;
        run.panel = read.find_panel(panel.name);
        run.edge = read.panels.at(static_cast<std::size_t>(run.panel)).find_edge(edge);
      }
  pattern = std::move(read);
  return seams;
}

} // namespace

std::unique_ptr<Garment> prepare(const std::string& path, Pattern pattern) {
  auto g = std::make_unique<Garment>();
  g->path = path;
  g->kept = path.find("keep") != std::string::npos;
  g->pattern = std::move(pattern);
  const std::vector<Seam> seams = through_dxf(g->pattern);
  g->sides = seam_sides(g->pattern, all_corners(g->pattern), SHORTEST);
  std::map<std::array<int, 2>, int> at;
  for (std::size_t k = 0; k < g->sides.size(); ++k) {
    g->sides[k].name.clear();
    g->sides[k].hand = 0;
    at[{g->sides[k].panel, g->sides[k].first}] = static_cast<int>(k);
  }
  for (const Seam& s : seams) {
    if (s.a.size() != 1 || s.b.size() != 1)
      continue;
    const auto a = at.find({s.a[0].panel, s.a[0].edge}), b = at.find({s.b[0].panel, s.b[0].edge});
    if (a != at.end() && b != at.end() && a->second != b->second)
      g->truth.insert({std::min(a->second, b->second), std::max(a->second, b->second)});
  }
  g->witness = std::make_unique<SeamWitness>(g->pattern, g->sides);
  g->assembly = std::make_unique<SeamAssembly>(*g->witness, std::vector<double>{});
  return g;
}

} // namespace sloper::pattern::fit

#include <garment/scene/panel_runs.hpp>
#include <sloper/base/error.hpp>

#include <algorithm>
#include <queue>

namespace sloper::garment {

namespace {

int nearest_vertex(const Garment& garment, const pattern::PanelInfo& panel, const Vec2& at) {
  int best = panel.first_vertex;
  double least = 1e300;
  for (int v = panel.first_vertex; v < panel.first_vertex + panel.n_vertices; ++v) {
    const double d = (Vec2(garment.panels.ids[v].s, garment.panels.ids[v].t) - at).squaredNorm();
    if (d < least) {
      least = d;
      best = v;
    }
  }
  return best;
}

double pattern_length(const Garment& garment, const std::vector<int>& run) {
  double sum = 0;
  for (std::size_t k = 0; k + 1 < run.size(); ++k)
    sum += (garment.panels.pattern[run[k + 1]] - garment.panels.pattern[run[k]]).norm();
  return sum;
}

/// Along the closed outline from position a to position b, forward.
std::vector<int> along(const std::vector<int>& outline, std::size_t a, std::size_t b) {
  std::vector<int> run{outline[a]};
  while (a != b) {
    a = (a + 1) % outline.size();
    run.push_back(outline[a]);
  }
  return run;
}

/// Shortest path over the edges of the panel's triangles.
std::vector<int> through(const Garment& garment, const pattern::PanelInfo& panel, int from,
                         int to) {
  std::vector<std::vector<int>> next(panel.n_vertices);
  for (int f = panel.first_triangle; f < panel.first_triangle + panel.n_triangles; ++f)
    for (int k = 0; k < 3; ++k) {
      const int a = garment.panels.triangles[f][k] - panel.first_vertex,
                b = garment.panels.triangles[f][(k + 1) % 3] - panel.first_vertex;
      next[a].push_back(b);
      next[b].push_back(a);
    }
  std::vector<double> distance(panel.n_vertices, 1e300);
  std::vector<int> before(panel.n_vertices, -1);
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  distance[from - panel.first_vertex] = 0;
  queue.push({0, from - panel.first_vertex});
  while (!queue.empty()) {
    const auto [d, v] = queue.top();
    queue.pop();
    if (d > distance[v])
      continue;
    for (int w : next[v]) {
      const double through_v = d + (garment.panels.pattern[w + panel.first_vertex] -
                                    garment.panels.pattern[v + panel.first_vertex])
                                       .norm();
      if (through_v >= distance[w])
        continue;
      distance[w] = through_v;
      before[w] = v;
      queue.push({through_v, w});
    }
  }
  std::vector<int> run;
  for (int v = to - panel.first_vertex; v >= 0; v = before[v])
    run.push_back(v + panel.first_vertex);
  std::reverse(run.begin(), run.end());
  return run;
}

} // namespace

const pattern::PanelInfo& panel_named(const Garment& garment, const std::string& name,
                                      const std::string& file, const std::string& place) {
  std::string names;
  std::vector<std::string> words;
  for (const pattern::PanelInfo& p : garment.panels.panels) {
    if (p.name == name)
      return p;
    words.push_back(p.name);
    names += (names.empty() ? "" : ", ") + p.name;
  }
  throw input_error("garment.no-panel"_id, file, place,
                    "no panel \"" + name + "\" in the garment" + did_you_mean(name, words),
                    "panels are " + names);
}

int particle_at(const Garment& garment, int vertex) {
  return garment.particle_of.empty() ? vertex : garment.particle_of[vertex];
}

std::vector<int> fold_particles(const Garment& garment, const PanelRun& run) {
  const pattern::PanelInfo& panel = panel_named(garment, run.panel);
  std::vector<int> particles;
  for (int v : through(garment, panel, nearest_vertex(garment, panel, run.from),
                       nearest_vertex(garment, panel, run.to)))
    particles.push_back(particle_at(garment, v));
  return particles;
}

std::vector<int> run_vertices(const Garment& garment, const PanelRun& run) {
  const pattern::PanelInfo& panel = panel_named(garment, run.panel);
  const int from = nearest_vertex(garment, panel, run.from),
            to = nearest_vertex(garment, panel, run.to);
  if (from == to)
    return {from};
  const auto a = std::find(panel.outline.begin(), panel.outline.end(), from),
             b = std::find(panel.outline.begin(), panel.outline.end(), to);
  if (a == panel.outline.end() || b == panel.outline.end())
    return through(garment, panel, from, to);
  const auto ia = static_cast<std::size_t>(a - panel.outline.begin()),
             ib = static_cast<std::size_t>(b - panel.outline.begin());
  std::vector<int> forward = along(panel.outline, ia, ib), backward = along(panel.outline, ib, ia);
  std::reverse(backward.begin(), backward.end());
  return pattern_length(garment, forward) <= pattern_length(garment, backward) ? forward : backward;
}

std::vector<int> run_particles(const Garment& garment, const PanelRun& run) {
  std::vector<int> particles;
  for (int v : run_vertices(garment, run)) {
    const int p = particle_at(garment, v);
    if (particles.empty() || particles.back() != p)
      particles.push_back(p);
  }
  return particles;
}

} // namespace sloper::garment

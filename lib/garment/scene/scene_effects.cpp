#include <base/error.hpp>
#include <cloth/forces/attachments.hpp>
#include <cloth/forces/dihedral_bending.hpp>
#include <cloth/forces/elastic_band.hpp>
#include <cloth/forces/membrane.hpp>
#include <cloth/forces/pins.hpp>
#include <cloth/forces/pressure.hpp>
#include <cloth/forces/triangle_stretch.hpp>
#include <cloth/forces/wind.hpp>
#include <cloth/solver/implicit_step.hpp>
#include <garment/scene/effects.hpp>
#include <garment/scene/scene_effects.hpp>

#include <algorithm>
#include <queue>

namespace sloper::garment {

namespace {

const pattern::PanelInfo& panel_named(const Garment& garment, const std::string& name) {
  std::string names;
  std::vector<std::string> words;
  for (const pattern::PanelInfo& p : garment.panels.panels) {
    if (p.name == name) return p;
    words.push_back(p.name);
    names += (names.empty() ? "" : ", ") + p.name;
  }
  throw input_error("", "panel \"" + name + "\"", "is not in the garment" + did_you_mean(name, words), "panels are " + names);
}

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
  for (std::size_t k = 0; k + 1 < run.size(); ++k) sum += (garment.panels.pattern[run[k + 1]] - garment.panels.pattern[run[k]]).norm();
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
std::vector<int> through(const Garment& garment, const pattern::PanelInfo& panel, int from, int to) {
  std::vector<std::vector<int>> next(panel.n_vertices);
  for (int f = panel.first_triangle; f < panel.first_triangle + panel.n_triangles; ++f)
    for (int k = 0; k < 3; ++k) {
      const int a = garment.panels.triangles[f][k] - panel.first_vertex, b = garment.panels.triangles[f][(k + 1) % 3] - panel.first_vertex;
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
    if (d > distance[v]) continue;
    for (int w : next[v]) {
      const double through_v = d + (garment.panels.pattern[w + panel.first_vertex] - garment.panels.pattern[v + panel.first_vertex]).norm();
      if (through_v >= distance[w]) continue;
      distance[w] = through_v;
      before[w] = v;
      queue.push({through_v, w});
    }
  }
  std::vector<int> run;
  for (int v = to - panel.first_vertex; v >= 0; v = before[v]) run.push_back(v + panel.first_vertex);
  std::reverse(run.begin(), run.end());
  return run;
}

int particle_at(const Garment& garment, int vertex) { return garment.particle_of.empty() ? vertex : garment.particle_of[vertex]; }

/// Particles of a run, neighbours that a seam has welded into one taken once.
std::vector<int> run_particles(const Garment& garment, const PanelRun& run) {
  std::vector<int> particles;
  for (int v : run_vertices(garment, run)) {
    const int p = particle_at(garment, v);
    if (particles.empty() || particles.back() != p) particles.push_back(p);
  }
  return particles;
}

std::vector<cloth::Pin> pins_of(const Garment& garment) {
  std::vector<cloth::Pin> pins;
  for (const ScenePin& pin : garment.scene.pins)
    for (int v : run_vertices(garment, pin.run)) {
      const int p = particle_at(garment, v);
      if (std::any_of(pins.begin(), pins.end(), [&](const cloth::Pin& other) { return other.particle == p; })) continue;
      const Vec3 placed = garment.panels.placed.empty() ? garment.position[p] : garment.panels.placed[v];
      pins.push_back({p, pin.has_target ? pin.target : placed, pin.stiffness_n_m, Vec3::Zero()});
    }
  return pins;
}

std::vector<cloth::BandLink> bands_of(const Garment& garment) {
  std::vector<cloth::BandLink> links;
  for (const SceneBand& band : garment.scene.bands) {
    const std::vector<int> run = run_vertices(garment, band.run);
    for (std::size_t k = 0; k + 1 < run.size(); ++k) {
      const int i = particle_at(garment, run[k]), j = particle_at(garment, run[k + 1]);
      const double length = (garment.panels.pattern[run[k + 1]] - garment.panels.pattern[run[k]]).norm();
      if (i != j && length > 0) links.push_back({i, j, band.ratio * length, band.strength_n});
    }
  }
  return links;
}

std::vector<cloth::Attachment> attachments_of(const Garment& garment, const body::Body* body) {
  std::vector<cloth::Attachment> attachments;
  for (const SceneAttachment& a : garment.scene.attachments) {
    Vec3 anchor = a.anchor;
    if (!a.landmark.empty()) {
      if (!body || !body->landmarks.count(a.landmark))
        throw input_error("", "attachment to landmark \"" + a.landmark + "\"", body ? "the body has no such landmark" : "there is no body");
      anchor = body->landmarks.at(a.landmark).p;
    }
    for (int p : run_particles(garment, a.run)) attachments.push_back({p, anchor, a.rest_length_m, a.stiffness_n_m});
  }
  return attachments;
}

std::vector<cloth::Shrink> shrink_of(const Garment& garment) {
  std::vector<cloth::Shrink> shrink(garment.panels.triangles.size());
  for (const SceneShrink& s : garment.scene.shrink) {
    if (!s.panel.empty()) panel_named(garment, s.panel);
    for (const pattern::PanelInfo& panel : garment.panels.panels) {
      if (!s.panel.empty() && panel.name != s.panel) continue;
      for (int f = panel.first_triangle; f < panel.first_triangle + panel.n_triangles; ++f) {
        Vec2 middle = Vec2::Zero();
        for (int v : garment.panels.triangles[f]) middle += Vec2(garment.panels.ids[v].s, garment.panels.ids[v].t) / 3;
        if ((middle.array() >= s.low.array()).all() && (middle.array() <= s.high.array()).all()) shrink[f] = {s.weft, s.warp};
      }
    }
  }
  return shrink;
}

/// Rest angle of each hinge, in the sign of its own order of particles.
std::vector<double> rest_angles_of(const cloth::ClothMesh& mesh, const Garment& garment) {
  std::vector<double> rest(mesh.hinges.size(), 0);
  for (const SceneCrease& crease : garment.scene.creases) {
    const std::vector<int> run = run_particles(garment, crease.run);
    for (std::size_t h = 0; h < mesh.hinges.size(); ++h) {
      const cloth::Hinge& hinge = mesh.hinges[h];
      for (std::size_t k = 0; k + 1 < run.size(); ++k) {
        if (!((hinge.particle[0] == run[k] && hinge.particle[1] == run[k + 1]) || (hinge.particle[1] == run[k] && hinge.particle[0] == run[k + 1]))) continue;
        // Particle 2 lies left of 0 -> 1, seen from outside, when a triangle runs 0, 1, 2; there outward folds are negative angles.
        bool left = false;
        for (const cloth::RestTriangle& t : mesh.triangles)
          for (int c = 0; c < 3; ++c)
            left |= t.particle[c] == hinge.particle[0] && t.particle[(c + 1) % 3] == hinge.particle[1] && t.particle[(c + 2) % 3] == hinge.particle[2];
        rest[h] = left ? crease.angle_rad : -crease.angle_rad;
      }
    }
  }
  return rest;
}

} // namespace

std::vector<int> run_vertices(const Garment& garment, const PanelRun& run) {
  const pattern::PanelInfo& panel = panel_named(garment, run.panel);
  const int from = nearest_vertex(garment, panel, run.from), to = nearest_vertex(garment, panel, run.to);
  if (from == to) return {from};
  const auto a = std::find(panel.outline.begin(), panel.outline.end(), from), b = std::find(panel.outline.begin(), panel.outline.end(), to);
  if (a == panel.outline.end() || b == panel.outline.end()) return through(garment, panel, from, to);
  const auto ia = static_cast<std::size_t>(a - panel.outline.begin()), ib = static_cast<std::size_t>(b - panel.outline.begin());
  std::vector<int> forward = along(panel.outline, ia, ib), backward = along(panel.outline, ib, ia);
  std::reverse(backward.begin(), backward.end());
  return pattern_length(garment, forward) <= pattern_length(garment, backward) ? forward : backward;
}

void add_scene_effects(cloth::ClothSolver& solver, const cloth::ClothMesh& mesh, const Garment& garment, const body::Body* body,
                       const std::vector<EffectReport>& effects, bool sewing) {
  const SceneEffects& scene = garment.scene;
  if (is_active(effects, "triangle_stretch")) solver.emplace<cloth::TriangleStretchEffect>(mesh, shrink_of(garment));
  if (is_active(effects, "membrane")) solver.emplace<cloth::MembraneEffect>(mesh);
  if (is_active(effects, "dihedral_bending")) solver.emplace<cloth::DihedralBendingEffect>(mesh, rest_angles_of(mesh, garment));
  if (is_active(effects, "pins") && !garment.scene.pins.empty()) solver.emplace<cloth::PinsEffect>(pins_of(garment));
  if (sewing) return;
  if (is_active(effects, "attachments")) solver.emplace<cloth::AttachmentsEffect>(attachments_of(garment, body));
  if (is_active(effects, "elastic_bands")) solver.emplace<cloth::ElasticBandEffect>(bands_of(garment));
  if (is_active(effects, "wind")) {
    cloth::WindOptions options;
    options.velocity = scene.wind_m_s;
    solver.emplace<cloth::WindEffect>(mesh.particle_triangles(), options);
  }
  if (is_active(effects, "pressure") && scene.pressure_pa != 0) solver.emplace<cloth::PressureEffect>(mesh.particle_triangles(), scene.pressure_pa);
}

} // namespace sloper::garment

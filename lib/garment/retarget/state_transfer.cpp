#include <garment/retarget/state_transfer.hpp>
#include <sloper/garment/sewing.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace sloper::garment {
namespace {

constexpr double MEETS = 5e-4; // m: free edges nearer than this lie on each other
constexpr double PARTED =
    1.2e-3; // m, that each goes back: together more than the thickness at which cloth feels cloth

/// A panel of the old mesh, and how its drawing lies in the new panel's.
struct Source {
  const pattern::PanelInfo* panel;
  Eigen::Matrix2d turn = Eigen::Matrix2d::Identity();
  Vec2 shift = Vec2::Zero();
};

const pattern::PanelInfo* panel_named(const pattern::PanelMesh& mesh, const std::string& name) {
  for (const pattern::PanelInfo& p : mesh.panels)
    if (p.name == name)
      return &p;
  return nullptr;
}

bool owns(const pattern::PanelInfo& p, int vertex) {
  return vertex >= p.first_vertex && vertex < p.first_vertex + p.n_vertices;
}

/// The rigid motion that lays panel b beside panel a along a seam between them.
bool beside(const pattern::PanelMesh& mesh, const pattern::PanelInfo& a,
            const pattern::PanelInfo& b, Source& out) {
  std::vector<std::array<int, 2>> pairs;
  for (const pattern::MeshSeam& s : mesh.seams)
    for (std::size_t k = 0; k < s.a.size(); ++k)
      if (owns(a, s.a[k]) && owns(b, s.b[k]))
        pairs.push_back({s.a[k], s.b[k]});
      else if (owns(a, s.b[k]) && owns(b, s.a[k]))
        pairs.push_back({s.b[k], s.a[k]});
  if (pairs.size() < 2)
    return false;
  Vec2 mean_a = Vec2::Zero(), mean_b = Vec2::Zero();
  for (const auto& [v, w] : pairs) {
    mean_a += mesh.pattern[v];
    mean_b += mesh.pattern[w];
  }
  mean_a /= static_cast<double>(pairs.size());
  mean_b /= static_cast<double>(pairs.size());
  double along = 0, across = 0;
  for (const auto& [v, w] : pairs) {
    const Vec2 p = mesh.pattern[w] - mean_b, q = mesh.pattern[v] - mean_a;
    along += p.dot(q);
    across += p.x() * q.y() - p.y() * q.x();
  }
  out.turn = Eigen::Rotation2Dd(std::atan2(across, along)).toRotationMatrix();
  out.shift = mean_a - out.turn * mean_b;
  return true;
}

/// Weights of the point of a triangle nearest to p.
Vec3 nearest_weights(const std::array<Vec2, 3>& t, const Vec2& p, double& squared_distance) {
  const Vec2 e = t[1] - t[0], f = t[2] - t[0], d = p - t[0];
  const double area = e.x() * f.y() - e.y() * f.x();
  if (std::abs(area) > 1e-18) {
    const double v = (d.x() * f.y() - d.y() * f.x()) / area,
                 w = (e.x() * d.y() - e.y() * d.x()) / area;
    if (v >= 0 && w >= 0 && v + w <= 1) {
      squared_distance = 0;
      return {1 - v - w, v, w};
    }
  }
  Vec3 best(1, 0, 0);
  squared_distance = 1e300;
  for (int k = 0; k < 3; ++k) {
    const Vec2 &a = t[k], &b = t[(k + 1) % 3];
    const double length = (b - a).squaredNorm(),
                 s = length > 0 ? std::clamp((p - a).dot(b - a) / length, 0.0, 1.0) : 0.0;
    const double off = (a + s * (b - a) - p).squaredNorm();
    if (off < squared_distance) {
      squared_distance = off;
      best = Vec3::Zero();
      best[k] = 1 - s;
      best[(k + 1) % 3] = s;
    }
  }
  return best;
}

/// The triangles of a panel by square cells of its drawing.
class PanelCells {
public:
  PanelCells(const pattern::PanelMesh& mesh, const pattern::PanelInfo& panel)
      : m_low(Vec2::Constant(1e300)), m_cell(std::max(mesh.edge_length, 1e-4)) {
    Vec2 high = Vec2::Constant(-1e300);
    for (int v = panel.first_vertex; v < panel.first_vertex + panel.n_vertices; ++v) {
      const Vec2& p = mesh.pattern[v];
      m_low = m_low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    m_cell = std::max(m_cell, (high - m_low).maxCoeff() / MOST_CELLS);
    m_nx = cell_at(high.x() - m_low.x()) + 1;
    m_ny = cell_at(high.y() - m_low.y()) + 1;
    m_triangles.resize(static_cast<std::size_t>(m_nx) * static_cast<std::size_t>(m_ny));
    for (int f = panel.first_triangle; f < panel.first_triangle + panel.n_triangles; ++f) {
      Vec2 least = Vec2::Constant(1e300), most = Vec2::Constant(-1e300);
      for (int v : mesh.triangles[f]) {
        const Vec2 p = mesh.pattern[v] - m_low;
        least = least.cwiseMin(p);
        most = most.cwiseMax(p);
      }
      for (int y = cell_at(least.y()); y <= cell_at(most.y()); ++y)
        for (int x = cell_at(least.x()); x <= cell_at(most.x()); ++x)
          m_triangles[index(x, y)].push_back(f);
    }
  }
  /// Those that may hold p, in their order; none outside the panel's box.
  const std::vector<int>& near(const Vec2& p) const {
    static const std::vector<int> none;
    const Vec2 at = (p - m_low) / m_cell;
    if (!(at.x() >= 0 && at.y() >= 0 && at.x() < m_nx && at.y() < m_ny))
      return none;
    return m_triangles[index(static_cast<int>(at.x()), static_cast<int>(at.y()))];
  }

private:
  static constexpr double MOST_CELLS = 2000; // in a row
  int cell_at(double offset) const { return static_cast<int>(offset / m_cell); }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(m_nx) +
           static_cast<std::size_t>(x);
  }
  Vec2 m_low;
  double m_cell;
  int m_nx = 0, m_ny = 0;
  std::vector<std::vector<int>> m_triangles;
};

/// Where an edit opens cloth, both sides of the opening start in one place, and nothing could tell
/// which is which. Each goes back a little into its own cloth. Cost: free edges squared.
void part_free_edges(const std::vector<Triangle>& triangles, std::vector<Vec3>& position) {
  std::vector<Vec3> around(position.size(), Vec3::Zero());
  std::vector<int> count(position.size(), 0);
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      around[a] += position[b];
      ++count[a];
      around[b] += position[a];
      ++count[b];
    }
  const std::vector<std::array<int, 2>> free = free_edges_of(triangles);
  std::set<int> ends;
  for (const auto& edge : free)
    ends.insert(edge.begin(), edge.end());
  std::vector<std::pair<std::size_t, Vec3>> moved;
  for (int p : ends) {
    const auto v = static_cast<std::size_t>(p);
    const Vec3& x = position[v];
    const bool meets = std::any_of(free.begin(), free.end(), [&](const std::array<int, 2>& e) {
      if (e[0] == p || e[1] == p)
        return false;
      const Vec3 &a = position[e[0]], along = position[e[1]] - a;
      const double s = along.squaredNorm() > 0
                           ? std::clamp((x - a).dot(along) / along.squaredNorm(), 0.0, 1.0)
                           : 0.0;
      return (x - a - s * along).squaredNorm() < MEETS * MEETS;
    });
    const Vec3 inwards = around[v] / count[v] - x;
    if (meets && inwards.norm() > 0)
      moved.push_back({v, x + std::min(PARTED / inwards.norm(), 0.25) * inwards});
  }
  for (const auto& [v, x] : moved)
    position[v] = x;
}

} // namespace

void transfer_state(Garment& garment, pattern::PanelMesh mesh) {
  const pattern::PanelMesh& old = garment.panels;
  std::vector<Vec3> position(mesh.pattern.size());
  for (pattern::PanelInfo& panel : mesh.panels) {
    std::vector<Source> sources;
    const pattern::PanelInfo* same = panel_named(old, panel.name);
    if (same)
      sources.push_back({same});
    for (const pattern::PanelInfo& p : old.panels) {
      if (panel_named(mesh, p.name))
        continue;
      Source gone{&p};
      if (!same || beside(old, *same, p, gone))
        sources.push_back(gone);
    }
    if (sources.empty())
      for (const pattern::PanelInfo& p : old.panels)
        sources.push_back({&p});
    std::vector<double> votes(sources.size(), 0);
    std::vector<PanelCells> cells;
    for (const Source& s : sources)
      cells.emplace_back(old, *s.panel);
    for (int v = panel.first_vertex; v < panel.first_vertex + panel.n_vertices; ++v) {
      double least = 1e300;
      std::size_t voted = 0;
      const auto look_at = [&](std::size_t s, const Vec2& p, int f) {
        const Triangle& t = old.triangles[f];
        double off = 0;
        const Vec3 w =
            nearest_weights({old.pattern[t[0]], old.pattern[t[1]], old.pattern[t[2]]}, p, off);
        if (off >= least)
          return;
        least = off;
        voted = s;
        Vec3 at = Vec3::Zero();
        for (int k = 0; k < 3; ++k)
          at += w[k] * garment.position[garment.particle_of[t[k]]];
        position[v] = at;
      };
      const auto place_in = [&](std::size_t s) {
        return Vec2(sources[s].turn.transpose() * (mesh.pattern[v] - sources[s].shift));
      };
      for (std::size_t s = 0; s < sources.size() && least > 0; ++s) {
        const Vec2 p = place_in(s);
        const std::vector<int>& near = cells[s].near(p);
        for (std::size_t k = 0; k < near.size() && least > 0; ++k)
          look_at(s, p, near[k]);
      }
      for (std::size_t s = 0; s < sources.size() && least > 0;
           ++s) { // beside all of them: the nearest
        const Vec2 p = place_in(s);
        for (int f = sources[s].panel->first_triangle;
             f < sources[s].panel->first_triangle + sources[s].panel->n_triangles && least > 0; ++f)
          look_at(s, p, f);
      }
      ++votes[voted];
    }
    panel.part = sources[std::max_element(votes.begin(), votes.end()) - votes.begin()].panel->part;
  }
  mesh.placed = position;
  garment.panels = std::move(mesh);
  garment.rest_scale.clear();
  garment.bind = {};
  weld(garment, position);
  part_free_edges(garment.particle_triangles(), garment.position);
}

} // namespace sloper::garment

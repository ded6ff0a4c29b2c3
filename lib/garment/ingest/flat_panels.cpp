#include <garment/ingest/flat_panels.hpp>
#include <garment/ingest/unroll.hpp>

#include <sloper/collision/topology.hpp>
#include <sloper/geometry/disjoint_sets.hpp>
#include <sloper/geometry/triangle_mesh.hpp>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace sloper::garment {

namespace {

constexpr int SMALL_PANEL = 12;         // triangles: fewer share a panel with others
constexpr double BETWEEN_PIECES = 0.01; // m, of pieces that share a panel
constexpr double TEXTURE_UNITS_M[] = {1, 0.01, 0.001, 0.0254};
constexpr double NEAR_A_UNIT = 0.02; // share: worn cloth is strained by less in the mean

double space_area(const CurvedSurface& s, int f) {
  const Triangle& t = s.triangles[f];
  return 0.5 * area_normal(s.position[t[0]], s.position[t[1]], s.position[t[2]]).norm();
}

/// The longest loop of border edges of a panel's triangles, in their direction.
std::vector<int> outline_of(const std::vector<Triangle>& triangles,
                            const std::vector<Vec2>& pattern) {
  std::map<std::array<int, 2>, int> count;
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k)
      ++count[{t[k], t[(k + 1) % 3]}];
  std::map<int, int> next;
  for (const auto& [edge, n] : count)
    if (!count.count({edge[1], edge[0]}))
      next.emplace(edge[0], edge[1]);
  std::vector<int> longest;
  double longest_length = -1;
  while (!next.empty()) {
    std::vector<int> loop;
    double length = 0;
    for (auto at = next.begin(); at != next.end();) {
      loop.push_back(at->first);
      length += (pattern[at->second] - pattern[at->first]).norm();
      const int to = at->second;
      next.erase(at);
      at = next.find(to);
    }
    if (length > longest_length) {
      longest = std::move(loop);
      longest_length = length;
    }
  }
  return longest;
}

/// Adds a panel of pieces, side by side.
void add_panel(const std::vector<FlatPiece>& pieces, FlatPanels& flat) {
  pattern::PanelMesh& mesh = flat.panels;
  pattern::PanelInfo panel;
  panel.name = "panel" + std::to_string(mesh.panels.size() + 1);
  panel.first_vertex = static_cast<int>(mesh.pattern.size());
  panel.first_triangle = static_cast<int>(mesh.triangles.size());
  double right = 0;
  Vec2 low = Vec2::Constant(1e300), high = -low;
  for (const FlatPiece& piece : pieces) {
    double left = 1e300, most = -1e300;
    for (const Vec2& at : piece.at) {
      left = std::min(left, at.x());
      most = std::max(most, at.x());
    }
    const int first = std::ssize(mesh.pattern);
    for (std::size_t i = 0; i < piece.at.size(); ++i) {
      mesh.pattern.emplace_back(piece.at[i].x() - left + right, piece.at[i].y());
      flat.particle_of.push_back(piece.particle[i]);
      low = low.cwiseMin(mesh.pattern.back());
      high = high.cwiseMax(mesh.pattern.back());
    }
    right += most - left + BETWEEN_PIECES;
    for (std::size_t k = 0; k < piece.triangles.size(); ++k) {
      const Triangle& c = piece.corners[k];
      mesh.triangles.push_back({first + c[0], first + c[1], first + c[2]});
      flat.triangle_of.push_back(piece.triangles[k]);
    }
  }
  panel.n_vertices = static_cast<int>(mesh.pattern.size()) - panel.first_vertex;
  panel.n_triangles = static_cast<int>(mesh.triangles.size()) - panel.first_triangle;
  const Vec2 size = (high - low).cwiseMax(1e-9);
  for (int v = panel.first_vertex; v < panel.first_vertex + panel.n_vertices; ++v) {
    const Vec2 share = (mesh.pattern[v] - low).cwiseQuotient(size);
    mesh.ids.push_back({static_cast<int>(mesh.panels.size()), share.x(), share.y()});
  }
  panel.outline = outline_of({mesh.triangles.begin() + panel.first_triangle, mesh.triangles.end()},
                             mesh.pattern);
  mesh.panels.push_back(std::move(panel));
}

/// One seam for each chain of edges that two panels share.
void add_seams(FlatPanels& flat) {
  pattern::PanelMesh& mesh = flat.panels;
  struct Side {
    int from, to, panel; ///< panel vertices
  };
  std::map<std::array<int, 2>, std::vector<Side>> sides; // by particles, lower first
  for (std::size_t k = 0; k < mesh.panels.size(); ++k) {
    const pattern::PanelInfo& panel = mesh.panels[k];
    for (int f = panel.first_triangle; f < panel.first_triangle + panel.n_triangles; ++f)
      for (int c = 0; c < 3; ++c) {
        int from = mesh.triangles[f][c], to = mesh.triangles[f][(c + 1) % 3];
        if (flat.particle_of[from] > flat.particle_of[to])
          std::swap(from, to);
        sides[{flat.particle_of[from], flat.particle_of[to]}].push_back(
            {from, to, static_cast<int>(k)});
      }
  }
  // Chains: an edge goes on at its end with the one edge there that parts the same vertices.
  using Pair = std::array<int, 2>; // panel vertices that are one particle
  std::map<std::array<int, 2>, std::map<Pair, std::vector<Pair>>> borders; // by panels
  for (const auto& [edge, around] : sides) {
    if (around.size() != 2)
      continue;
    const Side &a = around[0], &b = around[1];
    if (a.from == b.from && a.to == b.to)
      continue; // inside a panel
    auto& border = borders[{a.panel, b.panel}];
    border[{a.from, b.from}].push_back({a.to, b.to});
    border[{a.to, b.to}].push_back({a.from, b.from});
  }
  const auto length_of = [&](const std::vector<int>& run) {
    double sum = 0;
    for (std::size_t i = 1; i < run.size(); ++i)
      sum += (mesh.pattern[run[i]] - mesh.pattern[run[i - 1]]).norm();
    return sum;
  };
  for (auto& entry : borders) {
    auto& border = entry.second;
    const auto take = [&](const Pair& from, const Pair& to) {
      for (const auto& [x, y] : {std::pair{from, to}, std::pair{to, from}}) {
        auto& list = border[x];
        list.erase(std::find(list.begin(), list.end(), y));
      }
    };
    for (const bool ends_first : {true, false})
      for (auto at = border.begin(); at != border.end(); ++at)
        while (!at->second.empty() && (!ends_first || at->second.size() == 1)) {
          pattern::MeshSeam seam;
          Pair now = at->first;
          seam.a.push_back(now[0]);
          seam.b.push_back(now[1]);
          while (!border[now].empty()) {
            const Pair to = border[now].front();
            take(now, to);
            now = to;
            seam.a.push_back(now[0]);
            seam.b.push_back(now[1]);
          }
          seam.name = "seam" + std::to_string(mesh.seams.size() + 1);
          seam.kind = "seam";
          seam.length_a = length_of(seam.a);
          seam.length_b = length_of(seam.b);
          mesh.seams.push_back(std::move(seam));
        }
  }
}

void add_rest_scale(const CurvedSurface& s, FlatPanels& flat) {
  for (std::size_t f = 0; f < flat.panels.triangles.size(); ++f) {
    const Triangle &t = flat.panels.triangles[f], &u = s.triangles[flat.triangle_of[f]];
    std::array<double, 3> scale{};
    for (int k = 0; k < 3; ++k)
      scale[k] = (s.position[u[k]] - s.position[u[(k + 1) % 3]]).norm() /
                 (flat.panels.pattern[t[k]] - flat.panels.pattern[t[(k + 1) % 3]]).norm();
    flat.rest_scale.push_back(scale);
  }
}

void finish(const CurvedSurface& s, FlatPanels& flat) {
  double sum = 0;
  std::size_t n = 0;
  for (const Triangle& t : s.triangles)
    for (int k = 0; k < 3; ++k, ++n)
      sum += (s.position[t[k]] - s.position[t[(k + 1) % 3]]).norm();
  flat.panels.edge_length = n > 0 ? sum / static_cast<double>(n) : 0;
  flat.panels.placement = pattern::Placement::STATED;
  add_seams(flat);
}

} // namespace

FlatPanels unrolled_panels(const CurvedSurface& s) {
  FlatPanels flat;
  const collision::Topology topology = collision::make_topology(s.position.size(), s.triangles);
  std::vector<int> order(s.triangles.size()); // the largest first
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return space_area(s, a) > space_area(s, b); });
  std::vector<char> taken(s.triangles.size(), 0);
  std::vector<FlatPiece> small;
  for (const int seed : order) {
    if (taken[seed])
      continue;
    FlatPiece piece = unroll_piece(s, topology, seed, taken);
    if (static_cast<int>(piece.triangles.size()) < SMALL_PANEL)
      small.push_back(std::move(piece));
    else
      add_panel({std::move(piece)}, flat);
  }
  if (!small.empty())
    add_panel(small, flat);
  add_rest_scale(s, flat);
  finish(s, flat);
  return flat;
}

TextureIsometry texture_isometry(const CurvedSurface& s, const std::vector<Vec2>& texture,
                                 const std::vector<Triangle>& corners) {
  TextureIsometry result;
  if (corners.size() != s.triangles.size() || corners.empty())
    return result;
  std::vector<double> off(corners.size(), 0); // by how much a triangle's edges are off, at most
  double total = 0;
  for (std::size_t f = 0; f < corners.size(); ++f) {
    for (const int c : corners[f])
      if (c < 0)
        return result;
    total += space_area(s, static_cast<int>(f));
  }
  Eigen::Vector2d squares(0, 0);
  for (int round = 0; round < 4; ++round) {
    Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
    Eigen::Vector2d right(0, 0);
    for (std::size_t f = 0; f < corners.size(); ++f) {
      if (round > 0 && off[f] > 2 * TEXTURE_STRETCH)
        continue;
      for (int k = 0; k < 3; ++k) {
        const Vec2 d = texture[corners[f][k]] - texture[corners[f][(k + 1) % 3]];
        const double length =
            (s.position[s.triangles[f][k]] - s.position[s.triangles[f][(k + 1) % 3]]).squaredNorm();
        const Eigen::Vector2d row = d.cwiseProduct(d) / length;
        const double weight = space_area(s, static_cast<int>(f));
        normal += weight * row * row.transpose();
        right += weight * row;
      }
    }
    if (std::abs(normal.determinant()) < 1e-300)
      return result;
    squares = normal.inverse() * right;
    if (!(squares.minCoeff() > 0))
      return result;
    for (std::size_t f = 0; f < corners.size(); ++f) {
      off[f] = 0;
      for (int k = 0; k < 3; ++k) {
        const Vec2 d = texture[corners[f][k]] - texture[corners[f][(k + 1) % 3]];
        const double length =
            (s.position[s.triangles[f][k]] - s.position[s.triangles[f][(k + 1) % 3]]).norm();
        const double flat = std::sqrt(squares.dot(d.cwiseProduct(d)));
        off[f] = std::max(off[f], std::abs(length / std::max(flat, 1e-12) - 1));
      }
    }
  }
  result.u_m = std::sqrt(squares[0]);
  result.v_m = std::sqrt(squares[1]);
  for (const double unit : TEXTURE_UNITS_M)
    if (std::abs(result.u_m / unit - 1) < NEAR_A_UNIT &&
        std::abs(result.v_m / unit - 1) < NEAR_A_UNIT)
      result.u_m = result.v_m = unit;
  double good = 0;
  for (std::size_t f = 0; f < corners.size(); ++f)
    if (off[f] <= TEXTURE_STRETCH)
      good += space_area(s, static_cast<int>(f));
  result.share = total > 0 ? good / total : 0;
  if (result.share < TEXTURE_SHARE)
    return result;
  // Each piece lies one side up, and no triangle is without area.
  DisjointSets joined(texture.size());
  for (const Triangle& c : corners) {
    joined.unite(c[0], c[1]);
    joined.unite(c[1], c[2]);
  }
  std::map<int, int> sign;
  for (const Triangle& c : corners) {
    const Vec2 scale(result.u_m, result.v_m);
    const double area =
        flat_area_of(texture[c[0]].cwiseProduct(scale), texture[c[1]].cwiseProduct(scale),
                     texture[c[2]].cwiseProduct(scale));
    if (std::abs(area) < LEAST_FLAT_AREA)
      return result;
    const int own = area > 0 ? 1 : -1;
    if (sign.try_emplace(joined.find(c[0]), own).first->second != own)
      return result;
  }
  result.is_pattern = true;
  return result;
}

FlatPanels texture_panels(const CurvedSurface& s, const std::vector<Vec2>& texture,
                          const std::vector<Triangle>& corners, const TextureIsometry& isometry) {
  FlatPanels flat;
  const Vec2 scale(isometry.u_m, isometry.v_m);
  // A place that the texture meets twice within one piece is two panel vertices: pieces are joined
  // over (texture coordinate, particle), so a corner's own number tells it.
  std::map<std::array<int, 2>, int> number;
  std::vector<std::array<int, 2>> of_number;
  std::vector<Triangle> own(corners.size());
  for (std::size_t f = 0; f < corners.size(); ++f)
    for (int k = 0; k < 3; ++k) {
      const std::array<int, 2> key{corners[f][k], s.triangles[f][k]};
      const auto [found, is_new] = number.try_emplace(key, static_cast<int>(number.size()));
      if (is_new)
        of_number.push_back(key);
      own[f][k] = found->second;
    }
  DisjointSets joined(number.size());
  for (const Triangle& t : own) {
    joined.unite(t[0], t[1]);
    joined.unite(t[1], t[2]);
  }
  std::map<int, std::vector<int>> pieces; // triangles, by first vertex
  for (std::size_t f = 0; f < own.size(); ++f)
    pieces[joined.find(own[f][0])].push_back(static_cast<int>(f));
  pattern::PanelMesh& mesh = flat.panels;
  for (const auto& [first, triangles] : pieces) {
    const Triangle& c = corners[triangles.front()];
    const bool turned =
        flat_area_of(texture[c[0]].cwiseProduct(scale), texture[c[1]].cwiseProduct(scale),
                     texture[c[2]].cwiseProduct(scale)) < 0;
    pattern::PanelInfo panel;
    panel.name = "panel" + std::to_string(mesh.panels.size() + 1);
    panel.first_vertex = static_cast<int>(mesh.pattern.size());
    panel.first_triangle = static_cast<int>(mesh.triangles.size());
    std::map<int, int> vertex;
    Vec2 low = Vec2::Constant(1e300), high = -low;
    for (const int f : triangles) {
      Triangle t;
      for (int k = 0; k < 3; ++k) {
        const auto [found, is_new] =
            vertex.try_emplace(own[f][k], static_cast<int>(mesh.pattern.size()));
        t[k] = found->second;
        if (!is_new)
          continue;
        Vec2 at = texture[of_number[own[f][k]][0]].cwiseProduct(scale);
        if (turned)
          at.x() = -at.x();
        mesh.pattern.push_back(at);
        flat.particle_of.push_back(of_number[own[f][k]][1]);
        low = low.cwiseMin(at);
        high = high.cwiseMax(at);
      }
      mesh.triangles.push_back(t);
      flat.triangle_of.push_back(f);
    }
    panel.n_vertices = static_cast<int>(mesh.pattern.size()) - panel.first_vertex;
    panel.n_triangles = static_cast<int>(triangles.size());
    const Vec2 size = (high - low).cwiseMax(1e-9);
    for (int v = panel.first_vertex; v < panel.first_vertex + panel.n_vertices; ++v) {
      const Vec2 share = (mesh.pattern[v] - low).cwiseQuotient(size);
      mesh.ids.push_back({static_cast<int>(mesh.panels.size()), share.x(), share.y()});
    }
    panel.outline = outline_of(
        {mesh.triangles.begin() + panel.first_triangle, mesh.triangles.end()}, mesh.pattern);
    mesh.panels.push_back(std::move(panel));
  }
  finish(s, flat);
  return flat;
}

} // namespace sloper::garment

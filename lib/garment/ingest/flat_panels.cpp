#include <garment/ingest/flat_panels.hpp>

#include <sloper/collision/topology.hpp>
#include <sloper/geometry/disjoint_sets.hpp>
#include <sloper/geometry/triangle_mesh.hpp>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <queue>
#include <tuple>

namespace sloper::garment {

namespace {

constexpr int SMALL_PANEL = 12;         // triangles: fewer share a panel with others
constexpr double BETWEEN_PIECES = 0.01; // m, of pieces that share a panel
constexpr double TEXTURE_UNITS_M[] = {1, 0.01, 0.001, 0.0254};
constexpr double NEAR_A_UNIT = 0.02;      // share: worn cloth is strained by less in the mean
constexpr double LEAST_FLAT_AREA = 2e-12; // m2 of a laid out triangle; the solver refuses 1e-12

double space_area(const CurvedSurface& s, int f) {
  const Triangle& t = s.triangles[f];
  return 0.5 * area_normal(s.position[t[0]], s.position[t[1]], s.position[t[2]]).norm();
}

double flat_area_of(const Vec2& a, const Vec2& b, const Vec2& c) {
  return 0.5 * ((b - a).x() * (c - a).y() - (b - a).y() * (c - a).x());
}

/// Where the third corner of a triangle lies beside the side from a to b, of which the triangle
/// knows the true length and its distances to both ends: as high as it is, also where the side is
/// laid out a little shorter or longer.
Vec2 third_corner(const Vec2& a, const Vec2& b, double ab, double to_a, double to_b) {
  const Vec2 along = (b - a) / std::max((b - a).norm(), 1e-12), aside(-along.y(), along.x());
  const double x = (ab * ab + to_a * to_a - to_b * to_b) / (2 * std::max(ab, 1e-12));
  const double y = std::sqrt(std::max(0.0, to_a * to_a - x * x));
  return a + x / std::max(ab, 1e-12) * (b - a) + y * aside;
}

/// One connected piece laid flat. A particle where the piece is cut lies in several places.
struct FlatPiece {
  std::vector<int> triangles;    ///< of the surface
  std::vector<Triangle> corners; ///< by triangle, into the following
  std::vector<int> particle;
  std::vector<Vec2> at;
};

/// Grows one piece from a triangle over those that are not `taken`.
class Unroller {
public:
  Unroller(const CurvedSurface& surface, const collision::Topology& topology,
           std::vector<char>& taken)
      : m_surface(surface), m_topology(topology), m_taken(taken) {}

  FlatPiece grow(int seed) {
    m_piece = {};
    m_places = {};
    m_middle = middle(seed);
    m_taken[seed] = 1;
    lay_first(seed);
    ask_neighbours(0);
    while (!m_queue.empty()) {
      const auto [distance, f, from] = m_queue.top();
      m_queue.pop();
      if (m_taken[f])
        continue;
      m_taken[f] = 1;
      lay(f, from);
      ask_neighbours(static_cast<int>(m_piece.triangles.size()) - 1);
    }
    return std::move(m_piece);
  }

private:
  double length(int i, int j) const {
    return (m_surface.position[i] - m_surface.position[j]).norm();
  }
  Vec3 middle(int f) const {
    const Triangle& t = m_surface.triangles[f];
    return (m_surface.position[t[0]] + m_surface.position[t[1]] + m_surface.position[t[2]]) / 3;
  }
  int add_place(int particle, const Vec2& at) {
    const int own = std::ssize(m_piece.at);
    m_piece.at.push_back(at);
    m_piece.particle.push_back(particle);
    m_places[particle].push_back(own);
    return own;
  }

  /// With the warp of its region upward.
  void lay_first(int f) {
    const Triangle& t = m_surface.triangles[f];
    const std::vector<Vec3>& x = m_surface.position;
    const Vec3 normal = area_normal(x[t[0]], x[t[1]], x[t[2]]).normalized();
    Vec3 warp = m_surface.warp_of_region[m_surface.region[f]];
    warp -= warp.dot(normal) * normal;
    if (warp.norm() < 0.1)
      warp = x[t[1]] - x[t[0]]; // it lies square to the warp
    warp.normalize();
    const Vec3 weft = warp.cross(normal);
    Triangle corners;
    for (int k = 0; k < 3; ++k)
      corners[k] =
          add_place(t[k], Vec2((x[t[k]] - x[t[0]]).dot(weft), (x[t[k]] - x[t[0]]).dot(warp)));
    m_piece.triangles.push_back(f);
    m_piece.corners.push_back(corners);
  }

  bool fits(const Triangle& t, const Vec2& a, const Vec2& b, const Vec2& c) const {
    const Vec2 p[3] = {a, b, c};
    if (flat_area_of(a, b, c) < LEAST_FLAT_AREA)
      return false;
    for (int k = 0; k < 3; ++k) {
      const double rest = length(t[k], t[(k + 1) % 3]), now = (p[k] - p[(k + 1) % 3]).norm();
      if (std::abs(now - rest) > UNROLLED_STRETCH * rest)
        return false;
    }
    return true;
  }

  /// The mean of where all triangles around a particle that is not laid out yet want it.
  Vec2 wanted(int particle, int region, const Vec2& fallback) const {
    Vec2 sum = fallback;
    int n = 1;
    for (const int g : m_topology.triangles_of_vertex(particle)) {
      if (m_surface.region[g] != region)
        continue;
      const Triangle& u = m_surface.triangles[g];
      const auto k = static_cast<int>(std::find(u.begin(), u.end(), particle) - u.begin());
      const int i = u[(k + 1) % 3], j = u[(k + 2) % 3];
      const auto a = m_places.find(i), b = m_places.find(j);
      if (a == m_places.end() || b == m_places.end() || a->second.size() != 1 ||
          b->second.size() != 1)
        continue;
      const Vec2 at = third_corner(m_piece.at[a->second[0]], m_piece.at[b->second[0]], length(i, j),
                                   length(particle, i), length(particle, j));
      if ((at - fallback).norm() > UNROLLED_STRETCH * length(particle, i))
        continue;
      sum += at;
      ++n;
    }
    return sum / n;
  }

  /// Lays a triangle beside one that is laid out. @param from  its number in the piece
  void lay(int f, int from) {
    const Triangle &t = m_surface.triangles[f], &g = m_surface.triangles[m_piece.triangles[from]];
    int apex = 0; // the corner that the other triangle has not
    while (std::find(g.begin(), g.end(), t[apex]) != g.end())
      ++apex;
    const int i = t[(apex + 1) % 3], j = t[(apex + 2) % 3];
    const auto place_in = [&](int particle) {
      return m_piece.corners[from][std::find(g.begin(), g.end(), particle) - g.begin()];
    };
    Triangle corners;
    corners[(apex + 1) % 3] = place_in(i);
    corners[(apex + 2) % 3] = place_in(j);
    const Vec2 a = m_piece.at[place_in(i)], b = m_piece.at[place_in(j)];
    const Triangle turned{t[apex], i, j};
    const Vec2 alone = third_corner(a, b, length(i, j), length(t[apex], i), length(t[apex], j));
    corners[apex] = -1;
    double nearest = 1e300;
    for (const int place : m_places[t[apex]])
      if (const double off = (m_piece.at[place] - alone).norm();
          off < nearest && fits(turned, m_piece.at[place], a, b)) {
        nearest = off;
        corners[apex] = place;
      }
    if (corners[apex] < 0) {
      Vec2 at = m_places[t[apex]].empty() ? wanted(t[apex], m_surface.region[f], alone) : alone;
      if (!fits(turned, at, a, b))
        at = alone;
      corners[apex] = add_place(t[apex], at);
    }
    m_piece.triangles.push_back(f);
    m_piece.corners.push_back(corners);
  }

  void ask_neighbours(int own) {
    const int f = m_piece.triangles[own];
    for (const int e : m_topology.triangle_edges[f]) {
      const auto around = m_topology.triangles_of_edge(e);
      if (around.size() != 2)
        continue;
      const int g = around[0] == f ? around[1] : around[0];
      if (!m_taken[g] && m_surface.region[g] == m_surface.region[f])
        m_queue.push({(middle(g) - m_middle).norm(), g, own});
    }
  }

  using Waiting = std::tuple<double, int, int>; // distance, triangle, beside which of the piece
  const CurvedSurface& m_surface;
  const collision::Topology& m_topology;
  std::vector<char>& m_taken;
  FlatPiece m_piece;
  std::map<int, std::vector<int>> m_places; // of a particle
  Vec3 m_middle = Vec3::Zero();
  std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> m_queue;
};

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
  Unroller unroller(s, topology, taken);
  std::vector<FlatPiece> small;
  for (const int seed : order) {
    if (taken[seed])
      continue;
    FlatPiece piece = unroller.grow(seed);
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

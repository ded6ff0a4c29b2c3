#include <garment/ingest/unroll.hpp>

#include <sloper/geometry/triangle_mesh.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>
#include <tuple>

namespace sloper::garment {

double flat_area_of(const Vec2& a, const Vec2& b, const Vec2& c) {
  return 0.5 * ((b - a).x() * (c - a).y() - (b - a).y() * (c - a).x());
}

namespace {

/// Where the third corner of a triangle lies beside the side from a to b, of which the triangle
/// knows the true length and its distances to both ends: as high as it is, also where the side is
/// laid out a little shorter or longer.
Vec2 third_corner(const Vec2& a, const Vec2& b, double ab, double to_a, double to_b) {
  const Vec2 along = (b - a) / std::max((b - a).norm(), 1e-12), aside(-along.y(), along.x());
  const double x = (ab * ab + to_a * to_a - to_b * to_b) / (2 * std::max(ab, 1e-12));
  const double y = std::sqrt(std::max(0.0, to_a * to_a - x * x));
  return a + x / std::max(ab, 1e-12) * (b - a) + y * aside;
}

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

} // namespace

FlatPiece unroll_piece(const CurvedSurface& surface, const collision::Topology& topology, int seed,
                       std::vector<char>& taken) {
  return Unroller(surface, topology, taken).grow(seed);
}

} // namespace sloper::garment

#include "polygonise.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <sloper/base/error.hpp>
namespace sloper::samples {
namespace {

constexpr int BLOCK = 6; ///< cells along one side of a block that is skipped as a whole when far
                         ///< from the surface
constexpr int PART = 3;  ///< the same for the eight parts of a block that is not
constexpr double FINER_STEP = 0.03; ///< of the spacing: by how much a grid is made finer where none
                                    ///< of that spacing closes the surface (toes, fingers)
constexpr int FINER_STEPS = 8;      ///< at most
constexpr double FAR_OFF = 2.5;     ///< a field value this many times the block's half diagonal is
                                    ///< taken as far from the surface

/// The field on the corners of a grid; corners far from the surface hold only the right sign.
struct Grid {
  Vec3 origin;
  double cell;
  int nx, ny, nz; ///< corners
  std::vector<float> value;
  std::size_t at(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * ny + j) * nx + i;
  }
  Vec3 point(int i, int j, int k) const { return origin + cell * Vec3(i, j, k); }
};

/// Fills `size` corners along each axis, with one value where the middle is far off.
void fill_block(Grid& g, const Field& f, const std::array<int, 3>& from, int size) {
  const double reach = FAR_OFF * 0.5 * size * g.cell * std::sqrt(3.0);
  const Vec3 corner(from[0], from[1], from[2]);
  const double middle = f(g.origin + g.cell * (corner + 0.5 * size * Vec3::Ones()));
  const bool far = std::abs(middle) > reach;
  if (!far && size == BLOCK) {
    for (int part = 0; part < 8; ++part)
      fill_block(g, f,
                 {from[0] + PART * (part & 1), from[1] + PART * (part >> 1 & 1),
                  from[2] + PART * (part >> 2)},
                 PART);
    return;
  }
  for (int k = from[2]; k < from[2] + size; ++k)
    for (int j = from[1]; j < from[1] + size; ++j)
      for (int i = from[0]; i < from[0] + size; ++i)
        g.value[g.at(i, j, k)] = static_cast<float>(far ? middle : f(g.point(i, j, k)));
}

Grid sample(const Field& f, const Box3& box, double cell, const Vec3& shift) {
  Grid g;
  g.cell = cell;
  const auto corners = [&](double size) {
    return (static_cast<int>(std::ceil(size / cell / BLOCK)) + 1) * BLOCK + 1;
  };
  g.nx = corners(box.size().x());
  g.ny = corners(box.size().y());
  g.nz = corners(box.size().z());
  g.origin = box.low - shift * cell;
  g.value.assign(static_cast<std::size_t>(g.nx) * g.ny * g.nz, 1.0f);
  for (int k = 0; k + 1 < g.nz; k += BLOCK)
    for (int j = 0; j + 1 < g.ny; j += BLOCK)
      for (int i = 0; i + 1 < g.nx; i += BLOCK)
        fill_block(g, f, {i, j, k}, BLOCK);
  return g;
}

/// The twelve edges of a cell as pairs of corners (corner bits: x, y, z), in the order axis * 4 +
/// place.
constexpr int EDGE[12][2] = {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3},
                             {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
/// The six faces as corner loops.
constexpr int FACE[6][4] = {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4},
                            {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}};

int edge_between(int a, int b) {
  for (int e = 0; e < 12; ++e)
    if ((EDGE[e][0] == a && EDGE[e][1] == b) || (EDGE[e][0] == b && EDGE[e][1] == a))
      return e;
  return -1;
}

/// The patches of surface in a cell: patch[e] numbers the patch of a crossed edge, -1 where the
/// edge is not crossed. On a face with two inside corners across a diagonal, the inside corners are
/// kept apart.
int cell_patches(const double v[8], int patch[12]) {
  int link[12][2], n_links[12] = {};
  for (const auto& loop : FACE) {
    int crossed[4], n = 0, at[4];
    for (int c = 0; c < 4; ++c)
      if ((v[loop[c]] < 0) != (v[loop[(c + 1) % 4]] < 0)) {
        at[n] = c;
        crossed[n++] = edge_between(loop[c], loop[(c + 1) % 4]);
      }
    const auto join = [&](int a, int b) {
      link[a][n_links[a]++] = b;
      link[b][n_links[b]++] = a;
    };
    if (n == 2)
      join(crossed[0], crossed[1]);
    else if (n == 4) { // edges 0 and 1 of the loop meet in corner 1
      const bool inside_1 = v[loop[(at[0] + 1) % 4]] < 0;
      join(crossed[0], crossed[inside_1 ? 1 : 3]);
      join(crossed[2], crossed[inside_1 ? 3 : 1]);
    }
  }
  int patches = 0;
  std::fill(patch, patch + 12, -1);
  for (int e = 0; e < 12; ++e) {
    if (n_links[e] == 0 || patch[e] >= 0)
      continue;
    for (int at = e; patch[at] < 0;) {
      patch[at] = patches;
      at = patch[link[at][0]] < 0 ? link[at][0] : link[at][1];
    }
    ++patches;
  }
  return patches;
}

/// One vertex for every patch of surface in a cell, one quad around every grid edge that the
/// surface crosses.
TriangleMesh surface_net(const Grid& g) {
  TriangleMesh mesh;
  std::vector<int> cell_of(g.value.size(), -1);
  std::vector<std::array<int, 12>> vertex_of_edge; // by crossed cell
  for (int k = 0; k + 1 < g.nz; ++k)
    for (int j = 0; j + 1 < g.ny; ++j)
      for (int i = 0; i + 1 < g.nx; ++i) {
        double v[8];
        int inside = 0;
        for (int c = 0; c < 8; ++c) {
          v[c] = g.value[g.at(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2))];
          inside += v[c] < 0;
        }
        if (inside == 0 || inside == 8)
          continue;
        int patch[12];
        const int patches = cell_patches(v, patch);
        const int first = std::ssize(mesh.positions);
        for (int q = 0; q < patches; ++q) {
          Vec3 sum = Vec3::Zero();
          int n = 0;
          for (int e = 0; e < 12; ++e)
            if (patch[e] == q) {
              const int a = EDGE[e][0], b = EDGE[e][1];
              const Vec3 pa(a & 1, a >> 1 & 1, a >> 2), pb(b & 1, b >> 1 & 1, b >> 2);
              sum += pa + v[a] / (v[a] - v[b]) * (pb - pa);
              ++n;
            }
          mesh.positions.push_back(g.point(i, j, k) + g.cell * sum / n);
        }
        cell_of[g.at(i, j, k)] = static_cast<int>(vertex_of_edge.size());
        std::array<int, 12> ids;
        for (int e = 0; e < 12; ++e)
          ids[e] = patch[e] < 0 ? -1 : first + patch[e];
        vertex_of_edge.push_back(ids);
      }
  const auto quad = [&](int a, int b, int c, int d, bool flip) {
    if (flip)
      std::swap(b, d);
    const auto& p = mesh.positions;
    if ((p[a] - p[c]).squaredNorm() <= (p[b] - p[d]).squaredNorm()) {
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    } else {
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({b, c, d});
    }
  };
  for (int k = 1; k + 1 < g.nz; ++k)
    for (int j = 1; j + 1 < g.ny; ++j)
      for (int i = 1; i + 1 < g.nx; ++i) {
        const bool in = g.value[g.at(i, j, k)] < 0;
        // The vertex of cell (a, b, c) for its own edge `e`, which is the grid edge at hand.
        const auto id = [&](int a, int b, int c, int e) {
          return vertex_of_edge[cell_of[g.at(a, b, c)]][e];
        };
        if (in != (g.value[g.at(i + 1, j, k)] < 0))
          quad(id(i, j - 1, k - 1, 3), id(i, j, k - 1, 2), id(i, j, k, 0), id(i, j - 1, k, 1), !in);
        if (in != (g.value[g.at(i, j + 1, k)] < 0))
          quad(id(i - 1, j, k - 1, 7), id(i - 1, j, k, 5), id(i, j, k, 4), id(i, j, k - 1, 6), !in);
        if (in != (g.value[g.at(i, j, k + 1)] < 0))
          quad(id(i - 1, j - 1, k, 11), id(i, j - 1, k, 10), id(i, j, k, 8), id(i - 1, j, k, 9),
               !in);
      }
  return mesh;
}

/// Swaps diagonals toward six triangles a vertex where the two triangles are nearly flat: evens out
/// the quads' split.
void even_valence(TriangleMesh& mesh) {
  for (int round = 0; round < 3; ++round) {
    std::map<std::pair<int, int>, std::array<int, 2>> side; // edge -> its two triangles
    std::vector<int> valence(mesh.positions.size(), 0);
    for (int t = 0; t < std::ssize(mesh.triangles); ++t)
      for (int e = 0; e < 3; ++e) {
        const int a = mesh.triangles[t][e], b = mesh.triangles[t][(e + 1) % 3];
        auto [it, fresh] =
            side.try_emplace({std::min(a, b), std::max(a, b)}, std::array<int, 2>{t, -1});
        if (!fresh)
          it->second[1] = t;
        ++valence[a];
      }
    std::vector<char> touched(mesh.triangles.size(), 0);
    for (const auto& [edge, tris] : side) {
      const auto [t0, t1] = tris;
      if (touched[t0] || touched[t1])
        continue;
      const int a = edge.first, b = edge.second;
      const auto opposite = [&](int t) {
        for (int v : mesh.triangles[t])
          if (v != a && v != b)
            return v;
        return -1;
      };
      const int c = opposite(t0), d = opposite(t1);
      if (side.count({std::min(c, d), std::max(c, d)}))
        continue;
      const auto cost = [](int va, int vb, int vc, int vd) {
        const auto square = [](int n) { return (n - 6) * (n - 6); };
        return square(va) + square(vb) + square(vc) + square(vd);
      };
      if (cost(valence[a] - 1, valence[b] - 1, valence[c] + 1, valence[d] + 1) >=
          cost(valence[a], valence[b], valence[c], valence[d]))
        continue;
      const auto& p = mesh.positions;
      const auto& f0 = mesh.triangles[t0];
      const auto& f1 = mesh.triangles[t1];
      const Vec3 n0 = area_normal(p[f0[0]], p[f0[1]], p[f0[2]]).normalized(),
                 n1 = area_normal(p[f1[0]], p[f1[1]], p[f1[2]]).normalized();
      // In t0 the edge runs either a -> b or b -> a; keep the orientation.
      bool forward = false;
      for (int e = 0; e < 3; ++e)
        forward |= f0[e] == a && f0[(e + 1) % 3] == b;
      const Triangle g0 = forward ? Triangle{a, d, c} : Triangle{b, d, c},
                     g1 = forward ? Triangle{d, b, c} : Triangle{d, a, c};
      const Vec3 m0 = area_normal(p[g0[0]], p[g0[1]], p[g0[2]]).normalized(),
                 m1 = area_normal(p[g1[0]], p[g1[1]], p[g1[2]]).normalized();
      if (n0.dot(n1) < 0.9 || m0.dot(m1) < 0.9 || m0.dot(n0) < 0.9)
        continue;
      mesh.triangles[t0] = g0;
      mesh.triangles[t1] = g1;
      touched[t0] = touched[t1] = 1;
      --valence[a];
      --valence[b];
      ++valence[c];
      ++valence[d];
    }
  }
}

/// Laplacian smoothing along the surface, each time followed by a step back onto it.
void relax(TriangleMesh& mesh, const Field& f, int rounds) {
  std::vector<std::array<int, 2>> edges = edges_of(mesh.triangles);
  std::vector<Vec3>& p = mesh.positions;
  for (int round = 0; round < rounds; ++round) {
    std::vector<Vec3> sum(p.size(), Vec3::Zero());
    std::vector<int> n(p.size(), 0);
    for (const auto& [a, b] : edges) {
      sum[a] += p[b];
      sum[b] += p[a];
      ++n[a];
      ++n[b];
    }
    for (std::size_t i = 0; i < p.size(); ++i) {
      const Vec3 normal = field_normal(f, p[i]);
      Vec3 move = 0.5 * (sum[i] / n[i] - p[i]);
      move -= normal * normal.dot(move);
      p[i] += move;
      p[i] -= normal * std::clamp(f(p[i]), -0.002, 0.002); // roughly back; the last step is exact
    }
  }
  for (Vec3& q : p)
    q = onto_surface(f, q, 1);
}

int n_components(const TriangleMesh& mesh) {
  const std::vector<int> c = connected_components(mesh.positions.size(), mesh.triangles);
  return c.empty() ? 0 : *std::max_element(c.begin(), c.end()) + 1;
}

} // namespace

Vec3 field_normal(const Field& f, const Vec3& p) {
  constexpr double E = 5e-4;
  Vec3 g;
  for (int a = 0; a < 3; ++a) {
    const Vec3 e = E * Vec3::Unit(a);
    g[a] = f(p + e) - f(p - e);
  }
  const double length = g.norm();
  return length > 0 ? Vec3(g / length) : Vec3(Vec3::UnitY());
}

Vec3 onto_surface(const Field& f, Vec3 p, int steps) {
  constexpr double E = 5e-4, LONGEST = 0.01;
  for (int s = 0; s < steps; ++s) {
    const Vec3 n = field_normal(f, p);
    const double slope = std::max((f(p + E * n) - f(p - E * n)) / (2 * E), 0.2);
    p -= n * std::clamp(f(p) / slope, -LONGEST, LONGEST);
  }
  return p;
}

bool is_closed_manifold(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> half; // directed edge -> triangle
  std::vector<int> corners(mesh.positions.size(), 0), start(mesh.positions.size(), -1);
  for (int t = 0; t < std::ssize(mesh.triangles); ++t)
    for (int e = 0; e < 3; ++e) {
      const int a = mesh.triangles[t][e], b = mesh.triangles[t][(e + 1) % 3];
      if (a == b || !half.emplace(std::make_pair(a, b), t).second)
        return false;
      ++corners[a];
      start[a] = b;
    }
  for (const auto& [edge, t] : half)
    if (!half.count({edge.second, edge.first}))
      return false;
  for (int v = 0; v < std::ssize(corners); ++v) {
    if (corners[v] == 0)
      return false;
    int b = start[v], n = 0;
    do { // walk around v; a second fan would be missed by one walk
      const Triangle& f = mesh.triangles[half.at({v, b})];
      for (int e = 0; e < 3; ++e)
        if (f[e] == v)
          b = f[(e + 2) % 3];
      ++n;
    } while (b != start[v] && n <= corners[v]);
    if (n != corners[v])
      return false;
  }
  return true;
}

/// The surface on a grid of one spacing, which is moved by a fraction of a cell until it is closed;
/// no triangles where it never is.
static TriangleMesh closed_surface(const Field& f, const Box3& box, double cell) {
  for (int attempt = 0; attempt < 12; ++attempt) {
    const Vec3 shift = Vec3(0.5 + 0.137 * attempt, 0.5 + 0.271 * attempt, 0.5 + 0.419 * attempt);
    TriangleMesh mesh = surface_net(sample(f, box, cell, shift - shift.array().floor().matrix()));
    if (!mesh.triangles.empty() && is_closed_manifold(mesh) && n_components(mesh) == 1)
      return mesh;
  }
  return {};
}

TriangleMesh polygonise(const Field& f, const Box3& box, double cell) {
  for (int step = 0; step <= FINER_STEPS; ++step) {
    TriangleMesh mesh = closed_surface(f, box, cell * (1 - FINER_STEP * step));
    if (mesh.triangles.empty())
      continue;
    relax(mesh, f, 2);
    even_valence(mesh);
    relax(mesh, f, 4);
    return mesh;
  }
  throw Error(ErrorKind::FAILED, "sample.no-closed-surface"_id, "", "mannequin",
              "no grid gives a closed manifold", "change --cell");
}

} // namespace sloper::samples

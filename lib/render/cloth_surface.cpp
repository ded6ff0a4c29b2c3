#include <render/cloth_clearance.hpp>
#include <sloper/render/scene.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace sloper::render {

namespace {

constexpr double FINE = 0.006; // m: edges shorter than this look smooth
constexpr std::size_t MOST_TRIANGLES = 200000;
constexpr double CURVE =
    0.75; // how far patches leave their triangles; 1 reaches the tangent planes
constexpr double MOST_IN = 0.0002, MOST_OUT = 0.003; // m, in each round
constexpr double LEAST_RIM = 0.0012;                 // m: thinner rims cannot be seen

/// @param most_in  m, how far it may lie behind the draped triangles
int mid_vertex(DrawMesh& mesh, int a, int b, double most_in) {
  const int m = std::ssize(mesh.positions);
  const Vec3 p = mesh.positions[a], q = mesh.positions[b], np = mesh.normals[a],
             nq = mesh.normals[b], flat = 0.5 * (p + q);
  const Vec3 on_p = flat - (flat - p).dot(np) * np, on_q = flat - (flat - q).dot(nq) * nq;
  const Vec3 sum = np + nq, n = sum.norm() > 1e-9 ? Vec3(sum.normalized()) : np;
  // Inwards no further than the cloth lies off the skin, outwards no further than folds lie off
  // each other.
  Vec3 curved = CURVE * (0.5 * (on_p + on_q) - flat);
  const double most = curved.dot(n) < 0 ? most_in : MOST_OUT, length = curved.norm();
  if (length > most)
    curved *= most / length;
  mesh.positions.push_back(flat + curved);
  mesh.flat.push_back(0.5 * (mesh.flat[a] + mesh.flat[b]));
  mesh.normals.push_back(n);
  mesh.colors.push_back(Vec3(0.5 * (mesh.colors[a] + mesh.colors[b])));
  mesh.uv.push_back(Vec2(0.5 * (mesh.uv[a] + mesh.uv[b])));
  mesh.panel_of.push_back(mesh.panel_of[a]);
  if (!mesh.values.empty()) {
    const double x = mesh.values[a], y = mesh.values[b];
    double middle = 0.5 * (x + y);
    if (y == NO_VALUE)
      middle = x;
    if (x == NO_VALUE)
      middle = y;
    mesh.values.push_back(middle);
  }
  return m;
}

/// Every triangle into four.
/// @param most_in  as of mid_vertex()
void quarter_triangles(DrawMesh& mesh, double most_in) {
  std::unordered_map<std::uint64_t, int> middle;
  middle.reserve(mesh.triangles.size() * 2);
  auto mid = [&](int a, int b) {
    const auto key = static_cast<std::uint64_t>(std::min(a, b)) << 32 |
                     static_cast<std::uint64_t>(std::max(a, b));
    const auto [found, is_new] = middle.try_emplace(key, 0);
    if (is_new)
      found->second = mid_vertex(mesh, std::min(a, b), std::max(a, b), most_in);
    return found->second;
  };
  std::vector<Triangle> finer;
  finer.reserve(mesh.triangles.size() * 4);
  for (const Triangle& t : mesh.triangles) {
    const int x = mid(t[0], t[1]), y = mid(t[1], t[2]), z = mid(t[2], t[0]);
    finer.push_back({t[0], x, z});
    finer.push_back({x, t[1], y});
    finer.push_back({z, y, t[2]});
    finer.push_back({x, y, z});
  }
  mesh.triangles = std::move(finer);
  mesh.pieces *= 4;
  std::vector<std::array<int, 2>> lines;
  std::vector<char> is_hem;
  for (std::size_t k = 0; k < mesh.lines.size(); ++k) {
    const int m = mid(mesh.lines[k][0], mesh.lines[k][1]);
    lines.push_back({mesh.lines[k][0], m});
    lines.push_back({m, mesh.lines[k][1]});
    is_hem.insert(is_hem.end(), 2, mesh.is_hem[k]);
  }
  mesh.lines = std::move(lines);
  mesh.is_hem = std::move(is_hem);
}

double distance_to_segment(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 d = b - a;
  const double length2 = d.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(d) / length2, 0.0, 1.0) : 0;
  return (p - a - t * d).norm();
}

/// Distances to the panel's own borders, by a grid of cells of BORDER_REACH.
void measure_borders(DrawMesh& mesh) {
  mesh.seam.assign(mesh.positions.size(), BORDER_REACH);
  mesh.hem.assign(mesh.positions.size(), BORDER_REACH);
  struct Cell {
    std::vector<int> lines;
  };
  std::unordered_map<std::uint64_t, Cell> grid;
  constexpr int CELL_BITS = 24; // a panel's number and two cells in 64 bits
  constexpr std::int64_t MIDDLE = 1 << (CELL_BITS - 2);
  static constexpr double MOST_CELLS = 4e6; // to either side; less than MIDDLE
  auto key = [](int panel, std::int64_t x, std::int64_t y) {
    return static_cast<std::uint64_t>(panel) << 2 * CELL_BITS ^
           static_cast<std::uint64_t>(x + MIDDLE) << CELL_BITS ^
           static_cast<std::uint64_t>(y + MIDDLE);
  };
  auto cell = [](double x) {
    const double number = std::clamp(x / BORDER_REACH, -MOST_CELLS, MOST_CELLS);
    return static_cast<std::int64_t>(std::floor(number));
  };
  for (std::size_t k = 0; k < mesh.lines.size(); ++k) {
    const Vec2 a = mesh.uv[mesh.lines[k][0]], b = mesh.uv[mesh.lines[k][1]], low = a.cwiseMin(b),
               high = a.cwiseMax(b);
    if ((high - low).maxCoeff() > 1)
      continue; // no fabric has such an edge
    for (std::int64_t y = cell(low.y()) - 1; y <= cell(high.y()) + 1; ++y)
      for (std::int64_t x = cell(low.x()) - 1; x <= cell(high.x()) + 1; ++x)
        grid[key(mesh.panel_of[mesh.lines[k][0]], x, y)].lines.push_back(static_cast<int>(k));
  }
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const auto found = grid.find(key(mesh.panel_of[v], cell(mesh.uv[v].x()), cell(mesh.uv[v].y())));
    if (found == grid.end())
      continue;
    for (int k : found->second.lines) {
      double& nearest = mesh.is_hem[k] ? mesh.hem[v] : mesh.seam[v];
      nearest = std::min(nearest, distance_to_segment(mesh.uv[v], mesh.uv[mesh.lines[k][0]],
                                                      mesh.uv[mesh.lines[k][1]]));
    }
  }
}

/// The two triangles of the strip along a border: from a to b, turned inwards by `thickness` (m).
std::array<std::array<Vec3, 3>, 2> rim_corners(const DrawMesh& mesh, int a, int b,
                                               double thickness) {
  const Vec3 &p = mesh.positions[a], &q = mesh.positions[b];
  const Vec3 below_p = p - thickness * mesh.normals[a], below_q = q - thickness * mesh.normals[b];
  return {{{p, q, below_q}, {p, below_q, below_p}}};
}

double rim_thickness(const DrawMesh& mesh) {
  return std::max(mesh.thickness, LEAST_RIM);
}

/// A strip along each free border: the edge of the fabric.
/// @param left_out  by line: there is no room for one
void add_rim(DrawMesh& mesh, const std::vector<char>& left_out) {
  const double thickness = rim_thickness(mesh);
  std::unordered_map<int, int> inner;
  auto copy = [&](int v) {
    const auto [found, is_new] = inner.try_emplace(v, static_cast<int>(mesh.positions.size()));
    if (is_new) {
      const Vec3 p = mesh.positions[v] - thickness * mesh.normals[v], n = mesh.normals[v],
                 c = mesh.colors[v];
      const Vec2 uv = mesh.uv[v];
      mesh.positions.push_back(p);
      mesh.normals.push_back(n);
      mesh.colors.push_back(c);
      mesh.uv.push_back(uv);
      mesh.panel_of.push_back(mesh.panel_of[v]);
      mesh.seam.push_back(BORDER_REACH);
      mesh.hem.push_back(0);
      if (!mesh.values.empty())
        mesh.values.push_back(mesh.values[v]);
    }
    return found->second;
  };
  for (std::size_t k = 0; k < mesh.lines.size(); ++k) {
    if (!mesh.is_hem[k] || left_out[k])
      continue;
    const int a = mesh.lines[k][0], b = mesh.lines[k][1], c = copy(a), d = copy(b);
    mesh.triangles.push_back({a, b, d});
    mesh.triangles.push_back({a, d, c});
  }
}

/// By mesh and line: a rim there would cross cloth, skin or another rim.
std::vector<std::vector<char>> rims_without_room(const std::vector<DrawMesh>& meshes,
                                                 const ClothClearance& clearance) {
  std::vector<std::vector<char>> left_out(meshes.size());
  std::vector<RimTriangle> rims;
  std::vector<std::array<int, 2>> from; // mesh and line
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const DrawMesh& mesh = meshes[m];
    left_out[m].resize(mesh.lines.size());
    if (mesh.flat.empty())
      continue;
    for (std::size_t k = 0; k < mesh.lines.size(); ++k) {
      if (!mesh.is_hem[k])
        continue;
      const auto [a, b] = mesh.lines[k];
      const auto corners = rim_corners(mesh, a, b, rim_thickness(mesh));
      rims.push_back({static_cast<int>(m), {a, b}, {a, b}, corners[0]});
      rims.push_back({static_cast<int>(m), {a, b}, {a, a}, corners[1]});
      from.insert(from.end(), 2, {static_cast<int>(m), static_cast<int>(k)});
    }
  }
  const std::vector<char> crosses = clearance.crossing_rims(rims);
  for (std::size_t i = 0; i < crosses.size(); ++i)
    if (crosses[i])
      left_out[from[i][0]][from[i][1]] = 1;
  return left_out;
}

} // namespace

void smooth_cloth(std::vector<DrawMesh>& meshes, bool as_model) {
  const bool keeps_outside =
      as_model && std::none_of(meshes.begin(), meshes.end(), [](const DrawMesh& mesh) {
        return !mesh.is_cloth && !mesh.is_flat;
      });
  for (DrawMesh& mesh : meshes) {
    if (!mesh.is_cloth || mesh.triangles.empty() || mesh.uv.empty())
      continue;
    mesh.flat = mesh.positions;
    double sum = 0;
    for (const Triangle& t : mesh.triangles)
      sum += (mesh.positions[t[1]] - mesh.positions[t[0]]).norm();
    double edge = sum / static_cast<double>(mesh.triangles.size());
    for (int round = 0; round < 3 && edge > FINE && mesh.triangles.size() * 4 <= MOST_TRIANGLES;
         ++round, edge *= 0.5)
      quarter_triangles(mesh, keeps_outside ? 0 : MOST_IN);
    measure_borders(mesh);
  }
  ClothClearance clearance(meshes);
  clearance.keep_clear(meshes);
  if (keeps_outside)
    return;
  const std::vector<std::vector<char>> left_out = rims_without_room(meshes, clearance);
  for (std::size_t m = 0; m < meshes.size(); ++m)
    if (!meshes[m].flat.empty())
      add_rim(meshes[m], left_out[m]);
}

} // namespace sloper::render

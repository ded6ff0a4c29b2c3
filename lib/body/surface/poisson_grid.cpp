#include <body/surface/poisson_grid.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::body {

namespace {

/// One level of the multigrid: laplacian(u) = f with u = 0 on the border nodes.
struct GridLevel {
  std::array<int, 3> n;
  double h;
  std::vector<float> u, f;
  GridLevel(const std::array<int, 3>& size, double spacing)
      : n(size), h(spacing), u(count(), 0.0f), f(count(), 0.0f) {}
  std::size_t count() const { return static_cast<std::size_t>(n[0]) * n[1] * n[2]; }
  std::size_t at(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * n[1] + y) * n[0] + x;
  }
};

/// Red-black Gauss-Seidel.
void relax(GridLevel& g, int sweeps) {
  const std::size_t sx = 1, sy = static_cast<std::size_t>(g.n[0]), sz = sy * g.n[1];
  const float h2 = static_cast<float>(g.h * g.h);
  for (int sweep = 0; sweep < 2 * sweeps; ++sweep)
    for (int z = 1; z < g.n[2] - 1; ++z)
      for (int y = 1; y < g.n[1] - 1; ++y)
        for (int x = 1 + ((y + z + sweep) & 1); x < g.n[0] - 1; x += 2) {
          const std::size_t i = g.at(x, y, z);
          g.u[i] = (g.u[i - sx] + g.u[i + sx] + g.u[i - sy] + g.u[i + sy] + g.u[i - sz] +
                    g.u[i + sz] - h2 * g.f[i]) *
                   (1.0f / 6.0f);
        }
}

/// Residual of the fine level, summed to the coarse one with weights 1/8 .. 1 (full weighting).
void restrict_residual(const GridLevel& fine, GridLevel& coarse) {
  const std::size_t sx = 1, sy = static_cast<std::size_t>(fine.n[0]), sz = sy * fine.n[1];
  const float inverse = static_cast<float>(1 / (fine.h * fine.h));
  std::vector<float> residual(fine.count(), 0.0f);
  for (int z = 1; z < fine.n[2] - 1; ++z)
    for (int y = 1; y < fine.n[1] - 1; ++y)
      for (int x = 1; x < fine.n[0] - 1; ++x) {
        const std::size_t i = fine.at(x, y, z);
        residual[i] =
            fine.f[i] - (fine.u[i - sx] + fine.u[i + sx] + fine.u[i - sy] + fine.u[i + sy] +
                         fine.u[i - sz] + fine.u[i + sz] - 6 * fine.u[i]) *
                            inverse;
      }
  std::fill(coarse.u.begin(), coarse.u.end(), 0.0f);
  for (int z = 1; z < coarse.n[2] - 1; ++z)
    for (int y = 1; y < coarse.n[1] - 1; ++y)
      for (int x = 1; x < coarse.n[0] - 1; ++x) {
        float sum = 0;
        for (int dz = -1; dz <= 1; ++dz)
          for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx) {
              const int fx = 2 * x + dx, fy = 2 * y + dy, fz = 2 * z + dz;
              if (fx >= fine.n[0] || fy >= fine.n[1] || fz >= fine.n[2])
                continue;
              const float w = (dx ? 0.5f : 1.0f) * (dy ? 0.5f : 1.0f) * (dz ? 0.5f : 1.0f);
              sum += w * residual[fine.at(fx, fy, fz)];
            }
        coarse.f[coarse.at(x, y, z)] = sum * 0.125f;
      }
}

void prolong(const GridLevel& coarse, GridLevel& fine) {
  for (int z = 1; z < fine.n[2] - 1; ++z)
    for (int y = 1; y < fine.n[1] - 1; ++y)
      for (int x = 1; x < fine.n[0] - 1; ++x) {
        float sum = 0;
        const int x0 = x / 2, x1 = (x + 1) / 2, y0 = y / 2, y1 = (y + 1) / 2, z0 = z / 2,
                  z1 = (z + 1) / 2;
        for (const int cz : {z0, z1})
          for (const int cy : {y0, y1})
            for (const int cx : {x0, x1})
              if (cx < coarse.n[0] && cy < coarse.n[1] && cz < coarse.n[2])
                sum += coarse.u[coarse.at(cx, cy, cz)];
        fine.u[fine.at(x, y, z)] += sum * 0.125f;
      }
}

void v_cycle(std::vector<GridLevel>& levels, std::size_t k) {
  if (k + 1 == levels.size()) {
    relax(levels[k], 40);
    return;
  }
  relax(levels[k], 2);
  restrict_residual(levels[k], levels[k + 1]);
  v_cycle(levels, k + 1);
  prolong(levels[k + 1], levels[k]);
  relax(levels[k], 2);
}

/// Quadratic B-spline weights of the three nodes around the nearest one; t in [-0.5, 0.5].
std::array<double, 3> spline(double t) {
  return {0.5 * (0.5 - t) * (0.5 - t), 0.75 - t * t, 0.5 * (0.5 + t) * (0.5 + t)};
}

} // namespace

double NodeGrid::sample(const Vec3& p) const {
  const Vec3 q = (p - origin) / h;
  const int x = std::clamp(static_cast<int>(q.x()), 0, n[0] - 2),
            y = std::clamp(static_cast<int>(q.y()), 0, n[1] - 2),
            z = std::clamp(static_cast<int>(q.z()), 0, n[2] - 2);
  const double a = q.x() - x, b = q.y() - y, c = q.z() - z;
  double sum = 0;
  for (int dz = 0; dz < 2; ++dz)
    for (int dy = 0; dy < 2; ++dy)
      for (int dx = 0; dx < 2; ++dx)
        sum += (dx ? a : 1 - a) * (dy ? b : 1 - b) * (dz ? c : 1 - c) *
               value[at(x + dx, y + dy, z + dz)];
  return sum;
}

NodeGrid indicator(const OrientedPoints& samples, double h) {
  NodeGrid grid;
  grid.h = h;
  const Box3 box = bounding_box(samples.position);
  constexpr int PAD = 8;
  for (int a = 0; a < 3; ++a) {
    const int nodes = static_cast<int>(std::ceil(box.size()[a] / h)) + 2 * PAD + 1;
    grid.n[a] = (nodes + 15) / 16 * 16 + 1; // halves four times
  }
  for (int a = 0; a < 3; ++a)
    grid.origin[a] = box.center()[a] - 0.5 * (grid.n[a] - 1) * h;
  std::vector<GridLevel> levels;
  levels.emplace_back(grid.n, h);
  for (int k = 0; k < 4; ++k) {
    const std::array<int, 3> half = {(levels.back().n[0] + 1) / 2, (levels.back().n[1] + 1) / 2,
                                     (levels.back().n[2] + 1) / 2};
    levels.emplace_back(half, levels.back().h * 2);
  }
  // V at the nodes, then its divergence by central differences
  GridLevel& fine = levels.front();
  std::array<std::vector<float>, 3> field;
  for (auto& component : field)
    component.assign(fine.count(), 0.0f);
  const double density = 1 / (h * h * h);
  for (std::size_t i = 0; i < samples.position.size(); ++i) {
    const Vec3 q = (samples.position[i] - grid.origin) / h;
    const int x = static_cast<int>(std::lround(q.x())), y = static_cast<int>(std::lround(q.y())),
              z = static_cast<int>(std::lround(q.z()));
    const auto wx = spline(q.x() - x), wy = spline(q.y() - y), wz = spline(q.z() - z);
    for (int dz = 0; dz < 3; ++dz)
      for (int dy = 0; dy < 3; ++dy)
        for (int dx = 0; dx < 3; ++dx) {
          const double w = -wx[dx] * wy[dy] * wz[dz] * samples.area[i] * density;
          const std::size_t at = fine.at(x + dx - 1, y + dy - 1, z + dz - 1);
          for (int a = 0; a < 3; ++a)
            field[a][at] += static_cast<float>(w * samples.normal[i][a]);
        }
  }
  const std::size_t step[3] = {1, static_cast<std::size_t>(fine.n[0]),
                               static_cast<std::size_t>(fine.n[0]) * fine.n[1]};
  for (int z = 1; z < fine.n[2] - 1; ++z)
    for (int y = 1; y < fine.n[1] - 1; ++y)
      for (int x = 1; x < fine.n[0] - 1; ++x) {
        const std::size_t i = fine.at(x, y, z);
        double div = 0;
        for (int a = 0; a < 3; ++a)
          div += field[a][i + step[a]] - field[a][i - step[a]];
        fine.f[i] = static_cast<float>(div / (2 * h));
      }
  for (int cycle = 0; cycle < 7; ++cycle)
    v_cycle(levels, 0);
  grid.value = std::move(fine.u);
  double sum = 0, weight = 0;
  for (std::size_t i = 0; i < samples.position.size(); ++i) {
    sum += samples.area[i] * grid.sample(samples.position[i]);
    weight += samples.area[i];
  }
  const float iso = static_cast<float>(sum / std::max(weight, 1e-30));
  for (float& v : grid.value)
    v -= iso;
  return grid;
}

} // namespace sloper::body

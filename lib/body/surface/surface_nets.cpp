#include <body/surface/surface_nets.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::body {

namespace {

/// Numbers the regions of nodes with inside[i] == wanted (face neighbours); returns sizes.
std::vector<std::size_t> label_regions(const NodeGrid& grid, const std::vector<char>& inside,
                                       char wanted, std::vector<int>& label) {
  std::vector<std::size_t> sizes;
  label.assign(inside.size(), -1);
  std::vector<std::size_t> stack;
  const int nx = grid.n[0], ny = grid.n[1], nz = grid.n[2];
  const std::size_t sy = static_cast<std::size_t>(nx), sz = sy * ny;
  for (std::size_t seed = 0; seed < inside.size(); ++seed) {
    if (inside[seed] != wanted || label[seed] >= 0)
      continue;
    const int region = std::ssize(sizes);
    sizes.push_back(0);
    stack.assign(1, seed);
    label[seed] = region;
    while (!stack.empty()) {
      const std::size_t i = stack.back();
      stack.pop_back();
      ++sizes[region];
      const int x = static_cast<int>(i % sy), y = static_cast<int>(i / sy % ny),
                z = static_cast<int>(i / sz);
      auto visit = [&](bool valid, std::size_t j) {
        if (!valid || inside[j] != wanted || label[j] >= 0)
          return;
        label[j] = region;
        stack.push_back(j);
      };
      visit(x > 0, i - 1);
      visit(x + 1 < nx, i + 1);
      visit(y > 0, i - sy);
      visit(y + 1 < ny, i + sy);
      visit(z > 0, i - sz);
      visit(z + 1 < nz, i + sz);
    }
  }
  return sizes;
}

/// One inside region, one outside region. @return nodes whose side changed
void keep_one_body(const NodeGrid& grid, std::vector<char>& inside) {
  std::vector<int> label;
  const std::vector<std::size_t> in_sizes = label_regions(grid, inside, 1, label);
  if (!in_sizes.empty()) {
    const int body =
        static_cast<int>(std::max_element(in_sizes.begin(), in_sizes.end()) - in_sizes.begin());
    for (std::size_t i = 0; i < inside.size(); ++i)
      inside[i] = label[i] == body;
  }
  label_regions(grid, inside, 0, label);
  for (std::size_t i = 0; i < inside.size(); ++i)
    if (label[i] != label[0])
      inside[i] = 1; // node 0 lies on the border, outside
}

/// Fills nodes until no cell has a diagonal contact: across a face, or across the cell's body
/// diagonal.
void remove_pinches(const NodeGrid& grid, std::vector<char>& inside) {
  bool changed = true;
  while (changed) {
    changed = false;
    for (int z = 0; z + 1 < grid.n[2]; ++z)
      for (int y = 0; y + 1 < grid.n[1]; ++y)
        for (int x = 0; x + 1 < grid.n[0]; ++x) {
          std::size_t corner[8];
          int count = 0;
          for (int k = 0; k < 8; ++k) {
            corner[k] = grid.at(x + (k & 1), y + (k >> 1 & 1), z + (k >> 2));
            count += inside[corner[k]];
          }
          if (count < 2 || count > 6)
            continue;
          auto fill = [&](std::size_t a, std::size_t b) {
            const std::size_t pick = grid.value[a] >= grid.value[b] ? a : b;
            inside[pick] = 1;
            changed = true;
          };
          static constexpr int faces[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                              {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
          for (const auto& face : faces) {
            const bool a = inside[corner[face[0]]], b = inside[corner[face[1]]],
                       c = inside[corner[face[2]]], d = inside[corner[face[3]]];
            if (a == c && b == d && a != b)
              a ? fill(corner[face[1]], corner[face[3]]) : fill(corner[face[0]], corner[face[2]]);
          }
          count = 0;
          for (int k = 0; k < 8; ++k)
            count += inside[corner[k]];
          for (int k = 0; k < 4; ++k) {
            const bool a = inside[corner[k]], b = inside[corner[7 - k]];
            if (count == 2 && a && b)
              fill(corner[k ^ 1], corner[k ^ 2]);
            if (count == 6 && !a && !b)
              fill(corner[k], corner[7 - k]);
          }
        }
  }
}

} // namespace

TriangleMesh zero_surface(NodeGrid grid) {
  std::vector<char> inside(grid.value.size());
  for (std::size_t i = 0; i < inside.size(); ++i)
    inside[i] = grid.value[i] > 0;
  keep_one_body(grid, inside);
  remove_pinches(grid, inside);
  keep_one_body(grid, inside);
  // values that follow the corrected sides
  const float tiny = 1e-3f;
  for (std::size_t i = 0; i < inside.size(); ++i) {
    if (inside[i] && grid.value[i] <= 0)
      grid.value[i] = tiny;
    if (!inside[i] && grid.value[i] > 0)
      grid.value[i] = -tiny;
  }
  TriangleMesh mesh;
  std::vector<int> vertex(inside.size(), -1); // of the cell whose lowest corner this is
  static constexpr int edges[12][2] = {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3},
                                       {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
  for (int z = 0; z + 1 < grid.n[2]; ++z)
    for (int y = 0; y + 1 < grid.n[1]; ++y)
      for (int x = 0; x + 1 < grid.n[0]; ++x) {
        std::size_t corner[8];
        Vec3 at[8];
        int count = 0;
        for (int k = 0; k < 8; ++k) {
          corner[k] = grid.at(x + (k & 1), y + (k >> 1 & 1), z + (k >> 2));
          count += inside[corner[k]];
        }
        if (count == 0 || count == 8)
          continue;
        for (int k = 0; k < 8; ++k)
          at[k] = grid.node(x + (k & 1), y + (k >> 1 & 1), z + (k >> 2));
        Vec3 sum = Vec3::Zero();
        int n = 0;
        for (const auto& e : edges) {
          const std::size_t a = corner[e[0]], b = corner[e[1]];
          if (inside[a] == inside[b])
            continue;
          const double w = grid.value[a] / (static_cast<double>(grid.value[a]) - grid.value[b]);
          sum += at[e[0]] + w * (at[e[1]] - at[e[0]]);
          ++n;
        }
        vertex[corner[0]] = static_cast<int>(mesh.positions.size());
        mesh.positions.push_back(sum / n);
      }
  // one quad around every crossed edge
  for (int z = 1; z + 1 < grid.n[2]; ++z)
    for (int y = 1; y + 1 < grid.n[1]; ++y)
      for (int x = 1; x + 1 < grid.n[0]; ++x) {
        const std::size_t i = grid.at(x, y, z);
        for (int axis = 0; axis < 3; ++axis) {
          int next[3] = {x, y, z};
          ++next[axis];
          const std::size_t j = grid.at(next[0], next[1], next[2]);
          if (inside[i] == inside[j])
            continue;
          const int u = (axis + 1) % 3, v = (axis + 2) % 3;
          auto cell = [&](int du, int dv) {
            int c[3] = {x, y, z};
            c[u] += du;
            c[v] += dv;
            return vertex[grid.at(c[0], c[1], c[2])];
          };
          int q[4] = {cell(-1, -1), cell(0, -1), cell(0, 0),
                      cell(-1, 0)}; // counter-clockwise about +axis
          if (!inside[i])
            std::swap(q[1], q[3]);
          const auto& p = mesh.positions;
          if ((p[q[0]] - p[q[2]]).squaredNorm() <= (p[q[1]] - p[q[3]]).squaredNorm()) {
            mesh.triangles.push_back({q[0], q[1], q[2]});
            mesh.triangles.push_back({q[0], q[2], q[3]});
          } else {
            mesh.triangles.push_back({q[0], q[1], q[3]});
            mesh.triangles.push_back({q[1], q[2], q[3]});
          }
        }
      }
  return mesh;
}

} // namespace sloper::body

#include <render/cloth_clearance.hpp>
#include <sloper/collision/chunks.hpp>
#include <sloper/collision/intersections.hpp>
#include <sloper/collision/predicates.hpp>

#include <algorithm>
#include <unordered_map>

namespace sloper::render {

namespace {

constexpr int MAX_ROUNDS = 12; // two take a vertex to its draped triangle; what it uncovers follows
constexpr double STEP = 0.5;   // of the distance to the draped triangles, in one round
constexpr double NEIGHBOURS = 0.2; // shares of the vertices of a triangle differ by at most this

struct PlaceHash {
  std::size_t operator()(const std::array<double, 3>& p) const {
    std::size_t h = 14695981039346656037ULL;
    for (double x : p)
      h = (h ^ std::hash<double>()(x)) * 1099511628211ULL;
    return h;
  }
};

bool share_vertex(const Triangle& a, const Triangle& b) {
  for (int u : a)
    for (int v : b)
      if (u == v)
        return true;
  return false;
}

Box3 box_of(const std::array<Vec3, 3>& corners) {
  Box3 box;
  for (const Vec3& p : corners)
    box.add(p);
  return box;
}

/// Whether a triangle meets one of the tree's that `skips` does not leave out.
template<class Skips>
bool meets(const std::array<Vec3, 3>& corners, const collision::TriangleTree& tree,
           const Skips& skips) {
  bool hit = false; // the traversal cannot be cut short, but the costly test can
  tree.visit_slots(tree.dop_of(box_of(corners)), 0, [&](int slot) {
    hit = hit || (!skips(tree.triangle_of_slot(slot)) &&
                  collision::triangles_intersect(corners, tree.corners(slot)));
  });
  return hit;
}

constexpr auto SKIPS_NONE = [](int) { return false; };

/// Lowers shares so that those of one triangle differ by at most NEIGHBOURS.
void follow_neighbours(const std::vector<Triangle>& triangles, std::vector<double>& share) {
  for (bool lowered = true; lowered;) {
    lowered = false;
    for (const Triangle& t : triangles) {
      const double least = std::min({share[t[0]], share[t[1]], share[t[2]]});
      if (least == 1)
        continue;
      for (int v : t)
        if (share[v] > least + NEIGHBOURS + 1e-12) {
          share[v] = least + NEIGHBOURS;
          lowered = true;
        }
    }
  }
}

} // namespace

ClothClearance::ClothClearance(const std::vector<DrawMesh>& meshes) : m_vertex_of(meshes.size()) {
  weld(meshes);
  build_tree(meshes);
  for (const DrawMesh& mesh : meshes) {
    if (mesh.is_cloth || mesh.is_flat)
      continue;
    const int first = std::ssize(m_obstacle_mesh.positions);
    m_obstacle_mesh.positions.insert(m_obstacle_mesh.positions.end(), mesh.positions.begin(),
                                     mesh.positions.end());
    for (const Triangle& t : mesh.triangles)
      m_obstacle_mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  if (!m_triangles.empty() && !m_obstacle_mesh.triangles.empty())
    m_obstacles = {m_obstacle_mesh.positions, m_obstacle_mesh.triangles};
}

void ClothClearance::weld(const std::vector<DrawMesh>& meshes) {
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const DrawMesh& mesh = meshes[m];
    if (mesh.flat.empty())
      continue;
    std::vector<char> on_border(mesh.flat.size());
    for (const auto& line : mesh.lines)
      for (int v : line)
        on_border[v] = 1;
    std::unordered_map<std::array<double, 3>, int, PlaceHash> at; // borders alone are sewn
    for (std::size_t v = 0; v < mesh.flat.size(); ++v) {
      const Vec3& p = mesh.flat[v];
      int vertex = std::ssize(m_flat);
      if (on_border[v])
        vertex = at.try_emplace({p.x(), p.y(), p.z()}, vertex).first->second;
      if (vertex == std::ssize(m_flat)) {
        m_positions.push_back(mesh.positions[v]);
        m_flat.push_back(p);
      }
      m_vertex_of[m].push_back(vertex);
    }
    for (const Triangle& t : mesh.triangles)
      m_triangles.push_back({m_vertex_of[m][t[0]], m_vertex_of[m][t[1]], m_vertex_of[m][t[2]]});
  }
}

/// The order of the draped triangles, each followed by its pieces: to sort the pieces costs more.
void ClothClearance::build_tree(const std::vector<DrawMesh>& meshes) {
  if (m_triangles.empty())
    return;
  std::vector<Vec3> corners;
  std::vector<Triangle> draped;
  std::vector<std::array<int, 2>> pieces; // first and count, by draped triangle
  int first = 0;
  for (const DrawMesh& mesh : meshes) {
    if (mesh.flat.empty())
      continue;
    for (std::size_t f = 0; f < mesh.triangles.size(); f += mesh.pieces, first += mesh.pieces) {
      Vec3 middle = Vec3::Zero();
      for (int v : mesh.triangles[f])
        middle += mesh.flat[v] / 3;
      const int corner = std::ssize(corners);
      corners.push_back(middle);
      draped.push_back({corner, corner, corner});
      pieces.push_back({first, mesh.pieces});
    }
  }
  std::vector<int> order;
  order.reserve(m_triangles.size());
  const collision::TriangleTree by_place(corners, draped);
  for (int f : by_place.triangle_order())
    for (int k = 0; k < pieces[f][1]; ++k)
      order.push_back(pieces[f][0] + k);
  m_tree = {m_positions, m_triangles, 6, std::move(order)};
}

std::vector<int> ClothClearance::crossing(const std::vector<int>& asked) const {
  return collision::gather<int>(asked.size(), [&](std::size_t begin, std::size_t end,
                                                  std::vector<int>& out) {
    for (std::size_t i = begin; i < end; ++i) {
      const Triangle& t = m_triangles[asked[i]];
      const auto& corners = m_tree.corners(m_tree.slot_of_triangle(asked[i]));
      if (meets(corners, m_tree, [&](int other) { return share_vertex(t, m_triangles[other]); }) ||
          meets(corners, m_obstacles, SKIPS_NONE))
        out.push_back(asked[i]);
    }
  });
}

std::vector<int> ClothClearance::all_crossing() const {
  std::vector<int> found = collision::triangles_through(m_positions, m_triangles, m_obstacles);
  for (const auto& pair : collision::self_intersections(m_positions, m_triangles, m_tree))
    found.insert(found.end(), pair.begin(), pair.end());
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

int ClothClearance::keep_clear(std::vector<DrawMesh>& meshes) {
  const std::vector<Vec3> smooth = m_positions;
  std::vector<double> share(smooth.size(), 1);
  std::vector<int> asked, found = all_crossing();
  for (int round = 0; round < MAX_ROUNDS && !found.empty(); ++round) {
    std::vector<double> next = share;
    for (int f : found)
      for (int v : m_triangles[f])
        next[v] = std::max(0.0, share[v] - STEP);
    follow_neighbours(m_triangles, next);
    if (next == share)
      break;
    std::vector<char> moved(share.size());
    for (std::size_t v = 0; v < share.size(); ++v) {
      if (next[v] == share[v])
        continue;
      moved[v] = 1;
      m_positions[v] = m_flat[v] + next[v] * (smooth[v] - m_flat[v]);
    }
    share = std::move(next);
    m_tree.refit(m_positions, false);
    // A pair crosses anew only where one of the two moved; what crossed and stayed is kept.
    asked.clear();
    std::vector<char> is_asked(m_triangles.size());
    for (int f : found)
      is_asked[f] = 1;
    for (std::size_t f = 0; f < m_triangles.size(); ++f) {
      const Triangle& t = m_triangles[f];
      if (is_asked[f] || moved[t[0]] || moved[t[1]] || moved[t[2]])
        asked.push_back(static_cast<int>(f));
    }
    found = crossing(asked);
  }
  for (std::size_t m = 0; m < meshes.size(); ++m)
    for (std::size_t v = 0; v < m_vertex_of[m].size(); ++v)
      meshes[m].positions[v] = m_positions[m_vertex_of[m][v]];
  return static_cast<int>(found.size());
}

std::vector<char> ClothClearance::crossing_rims(const std::vector<RimTriangle>& rims) const {
  std::vector<Vec3> corners;
  std::vector<Triangle> triangles;
  std::vector<std::array<int, 2>> border, own; // welded
  for (const RimTriangle& rim : rims) {
    const std::vector<int>& vertex_of = m_vertex_of[rim.mesh];
    const int first = std::ssize(corners);
    corners.insert(corners.end(), rim.corners.begin(), rim.corners.end());
    triangles.push_back({first, first + 1, first + 2});
    border.push_back({vertex_of[rim.border[0]], vertex_of[rim.border[1]]});
    own.push_back({vertex_of[rim.own[0]], vertex_of[rim.own[1]]});
  }
  if (rims.empty())
    return {};
  const collision::TriangleTree tree(corners, triangles);
  std::vector<char> crosses(rims.size());
  parallel_for(rims.size(), collision::SEARCH_GRAIN, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto shares_corner = [&](int other) {
        const Triangle& t = m_triangles[other];
        return std::find_first_of(t.begin(), t.end(), own[i].begin(), own[i].end()) != t.end();
      };
      const auto is_next_to = [&](int other) {
        return std::find_first_of(border[other].begin(), border[other].end(), border[i].begin(),
                                  border[i].end()) != border[other].end();
      };
      crosses[i] = meets(rims[i].corners, m_tree, shares_corner) ||
                   meets(rims[i].corners, m_obstacles, SKIPS_NONE) ||
                   meets(rims[i].corners, tree, is_next_to);
    }
  });
  return crosses;
}

} // namespace sloper::render

#include <sloper/garment/ingest/cloth_roles.hpp>

#include <sloper/base/parallel.hpp>
#include <sloper/base/statistics.hpp>
#include <sloper/collision/topology.hpp>
#include <sloper/collision/triangle_tree.hpp>
#include <sloper/geometry/disjoint_sets.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace sloper::garment {

namespace {

constexpr double SHELL_SHARE = 0.6; // of a piece's area that has another side behind it
constexpr double OPPOSITE = -0.8;   // cosine between the sides of a shell
constexpr double ONE_SIDE = 0;      // cosine between neighbours: a sharper edge parts two sides
constexpr double MIXED_SHARE = 0.2; // of a side's area that faces itself: the sides hang together
constexpr double RIM_WIDTH =
    1.5; // times SHELL_DEPTH_M: a wider piece without another side is cloth
constexpr double PATCH_SHARE = 0.95; // of the vertices of a patch that lie on other cloth
constexpr double SHELL_SPREAD = 3;   // times the median thickness: farther is another fold

double area_of(const MeshSurface& s, int f) {
  const Triangle& t = s.triangles[f];
  return 0.5 * area_normal(s.position[t[0]], s.position[t[1]], s.position[t[2]]).norm();
}

Vec3 middle_of(const MeshSurface& s, int f) {
  const Triangle& t = s.triangles[f];
  return (s.position[t[0]] + s.position[t[1]] + s.position[t[2]]) / 3;
}

Vec3 normal_of(const MeshSurface& s, int f) {
  const Triangle& t = s.triangles[f];
  return area_normal(s.position[t[0]], s.position[t[1]], s.position[t[2]]).normalized();
}

/// Fraction of the segment from a to b at which a triangle is met, or 2.
double met_at(const MeshSurface& s, int f, const Vec3& a, const Vec3& b) {
  const Triangle& t = s.triangles[f];
  const Vec3 &p = s.position[t[0]], e1 = s.position[t[1]] - p, e2 = s.position[t[2]] - p, d = b - a;
  const Vec3 h = d.cross(e2);
  const double det = e1.dot(h);
  if (std::abs(det) < 1e-18)
    return 2;
  const Vec3 r = a - p, q = r.cross(e1);
  const double u = r.dot(h) / det, v = d.dot(q) / det, w = e2.dot(q) / det;
  return u >= -1e-9 && v >= -1e-9 && u + v <= 1 + 1e-9 && w > 0 ? w : 2;
}

/// The other side of a shell, by triangle: the nearest of the same piece that faces the other way,
/// along the normal times `sign`.
struct OtherSide {
  std::vector<int> partner; ///< -1: none
  std::vector<double> depth;
};

OtherSide other_side(const MeshSurface& s, const collision::TriangleTree& tree, double sign) {
  OtherSide other;
  other.partner.assign(s.triangles.size(), -1);
  other.depth.assign(s.triangles.size(), SHELL_DEPTH_M);
  parallel_for(s.triangles.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const int f = static_cast<int>(i);
      const Vec3 n = normal_of(s, f), a = middle_of(s, f), b = a + sign * SHELL_DEPTH_M * n;
      Box3 box;
      box.add(a);
      box.add(b);
      tree.visit_overlaps(box, [&](int g) {
        if (s.component[g] != s.component[f] || g == f || normal_of(s, g).dot(n) > OPPOSITE)
          return;
        for (const int v : s.triangles[g])
          for (const int w : s.triangles[f])
            if (v == w)
              return;
        const double depth = met_at(s, g, a, b) * SHELL_DEPTH_M;
        if (depth < other.depth[i] || (depth == other.depth[i] && g < other.partner[i])) {
          other.depth[i] = depth;
          other.partner[i] = g;
        }
      });
    }
  });
  return other;
}

/// Connected parts of triangles that `joins` says belong together.
template<class Joins>
std::vector<int> parts_of(const MeshSurface& s, const collision::Topology& topology,
                          Joins&& joins) {
  DisjointSets sets(s.triangles.size());
  for (std::size_t e = 0; e < topology.edges.size(); ++e) {
    const auto around = topology.triangles_of_edge(static_cast<int>(e));
    if (around.size() == 2 && joins(around[0], around[1]))
      sets.unite(around[0], around[1]);
  }
  std::vector<int> part(s.triangles.size());
  for (std::size_t f = 0; f < part.size(); ++f)
    part[f] = sets.find(static_cast<int>(f));
  return part;
}

/// Marks the outer side and the rim of one shell.
void part_shell(const MeshSurface& s, const collision::Topology& topology, const OtherSide& other,
                const std::vector<double>& skin_distance, int component,
                std::vector<ClothRole>& role) {
  const auto distance = [&](int f) {
    const Triangle& t = s.triangles[f];
    return skin_distance[t[0]] + skin_distance[t[1]] + skin_distance[t[2]];
  };
  const auto own = [&](int f) { return s.component[f] == component; };
  const std::vector<int> side = parts_of(s, topology, [&](int f, int g) {
    return own(f) && (other.partner[f] >= 0) == (other.partner[g] >= 0) &&
           (other.partner[f] < 0 || normal_of(s, f).dot(normal_of(s, g)) > ONE_SIDE);
  });
  struct Side {
    double area = 0, outer = 0, mixed = 0, border = 0;
  };
  std::map<int, Side> sides;
  for (std::size_t i = 0; i < s.triangles.size(); ++i) {
    const int f = static_cast<int>(i);
    if (!own(f))
      continue;
    const double area = area_of(s, f);
    Side& of = sides[side[f]];
    of.area += area;
    if (const int g = other.partner[f]; g >= 0) {
      of.outer += distance(f) > distance(g) ? area : -area;
      of.mixed += side[g] == side[f] ? area : 0;
    }
  }
  for (std::size_t e = 0; e < topology.edges.size(); ++e) {
    const auto around = topology.triangles_of_edge(static_cast<int>(e));
    for (const int f : around)
      if (own(f) && (around.size() != 2 || side[around[0]] != side[around[1]]))
        sides[side[f]].border +=
            (s.position[topology.edges[e][0]] - s.position[topology.edges[e][1]]).norm();
  }
  for (std::size_t i = 0; i < s.triangles.size(); ++i) {
    const int f = static_cast<int>(i);
    if (!own(f))
      continue;
    const Side& of = sides.at(side[f]);
    bool outer = of.outer > 0;
    if (other.partner[f] < 0) // the rim is a narrow strip
      outer = of.border > 0 && 2 * of.area / of.border < RIM_WIDTH * SHELL_DEPTH_M;
    else if (of.mixed > MIXED_SHARE * of.area)
      outer = distance(f) > distance(other.partner[f]);
    if (outer)
      role[i] = ClothRole::LAYER;
  }
}

struct Piece {
  std::vector<int> triangles, places;
  double area = 0, distance = 0; ///< m2; to the skin, the mean of its places
  Box3 box;
};

std::vector<Piece> pieces_of(const MeshSurface& s, const std::vector<double>& skin_distance) {
  std::vector<Piece> pieces(static_cast<std::size_t>(s.n_components));
  for (std::size_t f = 0; f < s.triangles.size(); ++f) {
    Piece& p = pieces[s.component[f]];
    p.triangles.push_back(static_cast<int>(f));
    p.area += area_of(s, static_cast<int>(f));
    for (const int v : s.triangles[f]) {
      p.places.push_back(v);
      p.box.add(s.position[v]);
    }
  }
  for (Piece& p : pieces) {
    std::sort(p.places.begin(), p.places.end());
    p.places.erase(std::unique(p.places.begin(), p.places.end()), p.places.end());
    for (const int v : p.places)
      p.distance += skin_distance[v] / static_cast<double>(p.places.size());
  }
  return pieces;
}

bool lies_on(const MeshSurface& s, const Piece& piece, const std::vector<const Piece*>& others) {
  std::vector<Triangle> under;
  for (const Piece* other : others)
    for (const int f : other->triangles)
      under.push_back(s.triangles[f]);
  if (under.empty())
    return false;
  const collision::TriangleTree tree(s.position, under);
  std::size_t near = 0;
  for (const int v : piece.places)
    near += tree.closest_point(s.position[v], PATCH_REACH_M).triangle >= 0;
  return static_cast<double>(near) >= PATCH_SHARE * static_cast<double>(piece.places.size());
}

} // namespace

ClothRoles cloth_roles(const MeshSurface& s, const collision::BodyCollider& skin) {
  ClothRoles roles;
  roles.of_triangle.assign(s.triangles.size(), ClothRole::CLOTH);
  std::vector<double> skin_distance(s.position.size());
  parallel_for(s.position.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      skin_distance[i] =
          skin.signed_distance(s.position[i], std::numeric_limits<double>::infinity()).distance;
  });
  const std::vector<Piece> pieces = pieces_of(s, skin_distance);
  const auto set_role = [&](const Piece& piece, ClothRole role) {
    for (const int f : piece.triangles)
      roles.of_triangle[f] = role;
  };

  std::vector<int> order(pieces.size()); // the largest first
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return pieces[a].area > pieces[b].area; });
  std::vector<const Piece*> cloth;
  for (const int k : order) {
    const Piece& piece = pieces[k];
    if (!cloth.empty() && piece.box.size().norm() < RIGID_SIZE_M) {
      set_role(piece, ClothRole::RIGID);
      ++roles.rigid_parts;
      continue;
    }
    if (lies_on(s, piece, cloth)) {
      // A lining lies within its garment: the nearer to the skin of two that lie on one another is
      // cloth. What is nearer, and too small to carry the other, is cloth of its own.
      const auto over = std::find_if(cloth.begin(), cloth.end(), [&](const Piece* other) {
        return other->distance > piece.distance && lies_on(s, *other, {&piece});
      });
      if (over != cloth.end()) {
        set_role(**over, ClothRole::PATCH);
        *over = &piece;
        ++roles.patches;
        continue;
      }
      set_role(piece, ClothRole::PATCH);
      ++roles.patches;
      continue;
    }
    cloth.push_back(&piece);
  }

  const collision::Topology topology = collision::make_topology(s.position.size(), s.triangles);
  const collision::TriangleTree tree(s.position, s.triangles);
  OtherSide behind[2] = {other_side(s, tree, -1), other_side(s, tree, 1)};
  std::vector<double> depths;
  for (const Piece* piece : cloth) {
    double area[2] = {0, 0};
    for (const int f : piece->triangles)
      for (int k = 0; k < 2; ++k)
        if (behind[k].partner[f] >= 0)
          area[k] += area_of(s, f);
    OtherSide& other = behind[area[1] > area[0]];
    if (std::max(area[0], area[1]) < SHELL_SHARE * piece->area)
      continue;
    std::vector<double> own;
    for (const int f : piece->triangles)
      if (other.partner[f] >= 0)
        own.push_back(other.depth[f]);
    const double thickness = upper_median(own);
    for (const int f : piece->triangles)
      if (other.depth[f] > SHELL_SPREAD * thickness)
        other.partner[f] = -1;
    part_shell(s, topology, other, skin_distance, s.component[piece->triangles.front()],
               roles.of_triangle);
    depths.push_back(thickness);
    ++roles.shells;
  }
  if (!depths.empty())
    roles.thickness_m = upper_median(depths);
  return roles;
}

} // namespace sloper::garment

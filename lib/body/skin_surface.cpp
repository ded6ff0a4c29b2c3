#include <body/point_grid.hpp>
#include <body/skin_surface.hpp>
#include <body/surface_nets.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>

namespace sloper::body {

namespace {

constexpr double CELL = 1.0 / 180;        ///< of stature: grid spacing of a rebuilt skin
constexpr double SAMPLE = 1.0 / 260;      ///< of stature: spacing of the samples
constexpr double MAX_BORDER_SHARE = 1e-3; ///< of all edges: more open edges and the skin is rebuilt
constexpr double SMALL_HOLE = 0.035;      ///< of stature: a hole that a fan closes well enough
constexpr double MAX_NOISE = 0.45e-3;     ///< m

/// The scan's faces whose corners are all body; degenerate and duplicate ones and unused vertices are left out.
TriangleMesh own_faces(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles, const std::vector<char>& is_body, std::vector<int>& number) {
  TriangleMesh skin;
  number.assign(positions.size(), -1);
  std::vector<std::pair<std::array<int, 3>, int>> seen;
  for (const Triangle& t : triangles) {
    if (!is_body[t[0]] || !is_body[t[1]] || !is_body[t[2]] || t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    if (area_normal(positions[t[0]], positions[t[1]], positions[t[2]]).squaredNorm() < 1e-24) continue;
    std::array<int, 3> key = {t[0], t[1], t[2]};
    std::sort(key.begin(), key.end());
    seen.emplace_back(key, static_cast<int>(skin.triangles.size()));
    skin.triangles.push_back(t);
  }
  std::sort(seen.begin(), seen.end());
  std::vector<char> keep(skin.triangles.size(), 1);
  for (std::size_t i = 1; i < seen.size(); ++i)
    if (seen[i].first == seen[i - 1].first) keep[seen[i].second] = 0;
  std::vector<Triangle> kept;
  for (std::size_t i = 0; i < skin.triangles.size(); ++i) {
    if (!keep[i]) continue;
    Triangle t = skin.triangles[i];
    for (int& v : t) {
      int& n = number[v];
      if (n < 0) {
        n = static_cast<int>(skin.positions.size());
        skin.positions.push_back(positions[v]);
      }
      v = n;
    }
    kept.push_back(t);
  }
  skin.triangles = std::move(kept);
  return skin;
}

/// STL and some exporters give every face its own corners: joins vertices at the same place.
bool weld(TriangleMesh& mesh, std::vector<int>& of_scan) {
  std::vector<int> order(mesh.positions.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  auto less = [&](int a, int b) {
    const Vec3 &p = mesh.positions[a], &q = mesh.positions[b];
    return std::tie(p.x(), p.y(), p.z(), a) < std::tie(q.x(), q.y(), q.z(), b);
  };
  std::sort(order.begin(), order.end(), less);
  std::vector<int> target(order.size());
  bool any = false;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && mesh.positions[order[i]] == mesh.positions[order[i - 1]];
    target[order[i]] = same ? target[order[i - 1]] : order[i];
    any |= same;
  }
  if (!any) return false;
  std::vector<int> number(order.size(), -1);
  std::vector<Vec3> positions;
  for (std::size_t v = 0; v < order.size(); ++v)
    if (target[v] == static_cast<int>(v)) {
      number[v] = static_cast<int>(positions.size());
      positions.push_back(mesh.positions[v]);
    }
  std::vector<Triangle> triangles;
  for (const Triangle& t : mesh.triangles) {
    const Triangle w = {number[target[t[0]]], number[target[t[1]]], number[target[t[2]]]};
    if (w[0] != w[1] && w[1] != w[2] && w[2] != w[0]) triangles.push_back(w);
  }
  mesh.positions = std::move(positions);
  mesh.triangles = std::move(triangles);
  for (int& v : of_scan)
    if (v >= 0) v = number[target[v]];
  return true;
}

/// Leaves out pieces of less than a hundredth of all faces: eyes, inner shells, crumbs. @return how many pieces
int drop_small_pieces(TriangleMesh& mesh, std::vector<int>& of_scan) {
  const std::vector<int> piece = connected_components(mesh.positions.size(), mesh.triangles);
  std::vector<std::size_t> faces(mesh.positions.size(), 0);
  for (const Triangle& t : mesh.triangles) ++faces[piece[t[0]]];
  int dropped = 0;
  for (std::size_t n : faces) dropped += n > 0 && n * 100 < mesh.triangles.size();
  if (dropped == 0) return 0;
  auto keep = [&](int v) { return faces[piece[v]] * 100 >= mesh.triangles.size(); };
  std::vector<int> number(mesh.positions.size(), -1);
  TriangleMesh kept;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    if (keep(static_cast<int>(v))) {
      number[v] = static_cast<int>(kept.positions.size());
      kept.positions.push_back(mesh.positions[v]);
    }
  for (const Triangle& t : mesh.triangles)
    if (keep(t[0])) kept.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
  for (int& v : of_scan)
    if (v >= 0) v = number[v];
  mesh = std::move(kept);
  return dropped;
}

struct HalfEdge {
  std::uint64_t key;
  int face;
  bool forward; ///< from the lower to the higher vertex
};

std::vector<HalfEdge> half_edges(const TriangleMesh& mesh) {
  std::vector<HalfEdge> list;
  list.reserve(mesh.triangles.size() * 3);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    for (int k = 0; k < 3; ++k) {
      const auto a = static_cast<std::uint64_t>(mesh.triangles[f][k]), b = static_cast<std::uint64_t>(mesh.triangles[f][(k + 1) % 3]);
      list.push_back({std::min(a, b) << 32 | std::max(a, b), static_cast<int>(f), a < b});
    }
  std::sort(list.begin(), list.end(), [](const HalfEdge& a, const HalfEdge& b) { return a.key != b.key ? a.key < b.key : a.face < b.face; });
  return list;
}

void count_edges(const std::vector<HalfEdge>& list, SkinSurface& skin) {
  skin.border_edges = skin.crowded_edges = skin.flipped_edges = 0;
  for (std::size_t i = 0; i < list.size();) {
    std::size_t j = i;
    while (j < list.size() && list[j].key == list[i].key) ++j;
    if (j - i == 1) ++skin.border_edges;
    else if (j - i > 2) ++skin.crowded_edges;
    else if (list[i].forward == list[i + 1].forward) ++skin.flipped_edges;
    i = j;
  }
}

/// Turns faces so that neighbours agree, piece by piece, and each piece so that its volume is positive.
void orient_faces(TriangleMesh& mesh, const std::vector<HalfEdge>& list) {
  const std::size_t n = mesh.triangles.size();
  std::vector<std::array<int, 3>> neighbour(n, {-1, -1, -1});
  std::vector<std::array<char, 3>> agrees(n, {1, 1, 1});
  std::vector<int> degree(n, 0);
  for (std::size_t i = 0; i + 1 < list.size(); ++i) {
    if (list[i].key != list[i + 1].key) continue;
    if ((i > 0 && list[i - 1].key == list[i].key) || (i + 2 < list.size() && list[i + 2].key == list[i].key)) continue; // crowded
    const int a = list[i].face, b = list[i + 1].face;
    const char agree = list[i].forward != list[i + 1].forward;
    agrees[a][degree[a]] = agree, neighbour[a][degree[a]++] = b;
    agrees[b][degree[b]] = agree, neighbour[b][degree[b]++] = a;
  }
  std::vector<int> turned(n, -1), piece;
  for (std::size_t seed = 0; seed < n; ++seed) {
    if (turned[seed] >= 0) continue;
    piece.assign(1, static_cast<int>(seed));
    turned[seed] = 0;
    for (std::size_t head = 0; head < piece.size(); ++head) {
      const int f = piece[head];
      for (int k = 0; k < degree[f]; ++k) {
        const int g = neighbour[f][k];
        if (turned[g] >= 0) continue;
        turned[g] = agrees[f][k] ? turned[f] : 1 - turned[f];
        piece.push_back(g);
      }
    }
    Vec3 middle = Vec3::Zero();
    for (const int f : piece) middle += mesh.positions[mesh.triangles[f][0]];
    middle /= static_cast<double>(piece.size());
    double volume = 0;
    for (const int f : piece) {
      Triangle& t = mesh.triangles[f];
      if (turned[f]) std::swap(t[1], t[2]);
      volume += (mesh.positions[t[0]] - middle).dot((mesh.positions[t[1]] - middle).cross(mesh.positions[t[2]] - middle));
    }
    if (volume < 0)
      for (const int f : piece) std::swap(mesh.triangles[f][1], mesh.triangles[f][2]);
  }
}

/// Border edges against their face's direction, so that a new face agrees with the old one. Sorted.
std::vector<std::array<int, 2>> border_of(const TriangleMesh& mesh, const std::vector<HalfEdge>& list) {
  std::vector<std::array<int, 2>> border;
  for (std::size_t i = 0; i < list.size();) {
    std::size_t j = i;
    while (j < list.size() && list[j].key == list[i].key) ++j;
    if (j - i == 1) {
      const int low = static_cast<int>(list[i].key >> 32), high = static_cast<int>(list[i].key & 0xffffffffu);
      const Triangle& t = mesh.triangles[list[i].face];
      bool forward = false; // the face may have been turned since: look again
      for (int k = 0; k < 3; ++k) forward |= t[k] == low && t[(k + 1) % 3] == high;
      border.push_back(forward ? std::array<int, 2>{high, low} : std::array<int, 2>{low, high});
    }
    i = j;
  }
  std::sort(border.begin(), border.end());
  return border;
}

/// The border as simple loops. Where holes meet in a vertex a walk comes back to it: what it went around is a loop of its own.
/// @return empty where the border does not close
std::vector<std::vector<int>> border_loops(const std::vector<std::array<int, 2>>& border) {
  std::vector<char> used(border.size(), 0);
  auto next_of = [&](int v) {
    for (auto it = std::lower_bound(border.begin(), border.end(), std::array<int, 2>{v, -1}); it != border.end() && (*it)[0] == v; ++it)
      if (!used[static_cast<std::size_t>(it - border.begin())]) return static_cast<int>(it - border.begin());
    return -1;
  };
  std::vector<std::vector<int>> loops;
  for (std::size_t start = 0; start < border.size(); ++start) {
    if (used[start]) continue;
    std::vector<int> walk = {border[start][0]};
    int e = static_cast<int>(start);
    while (true) {
      used[e] = 1;
      const int v = border[e][1];
      const auto before = std::find(walk.begin(), walk.end(), v);
      if (before != walk.end()) {
        loops.emplace_back(before, walk.end());
        walk.erase(before + 1, walk.end());
        if (loops.back().size() < 3) return {};
        if (walk.size() == 1 && v == border[start][0]) break;
      } else walk.push_back(v);
      e = next_of(v);
      if (e < 0) return {};
    }
  }
  return loops;
}

/// Closes every hole with a fan around its middle, unless one is wider than `widest`, m, or the border is no set of loops.
bool fill_holes(TriangleMesh& mesh, const std::vector<HalfEdge>& list, double widest) {
  const std::vector<std::vector<int>> loops = border_loops(border_of(mesh, list));
  if (loops.empty()) return false;
  for (const std::vector<int>& loop : loops) {
    Box3 box;
    for (const int v : loop) box.add(mesh.positions[v]);
    if (box.size().norm() > widest && loop.size() > 10) return false; // few edges: a face or two of a coarse mesh
  }
  for (const std::vector<int>& loop : loops) {
    if (loop.size() == 3) {
      mesh.triangles.push_back({loop[0], loop[1], loop[2]});
      continue;
    }
    Vec3 middle = Vec3::Zero();
    for (const int v : loop) middle += mesh.positions[v] / static_cast<double>(loop.size());
    const int hub = static_cast<int>(mesh.positions.size());
    mesh.positions.push_back(middle);
    for (std::size_t k = 0; k < loop.size(); ++k) mesh.triangles.push_back({loop[k], loop[(k + 1) % loop.size()], hub});
  }
  return true;
}

/// Roughness at the scale of the mesh: the part of the umbrella vector along the normal that neighbours do not share.
double roughness(const TriangleMesh& mesh) {
  const std::vector<Vec3> normals = vertex_normals(mesh);
  const std::size_t n = mesh.positions.size();
  std::vector<Vec3> sum(n, Vec3::Zero());
  std::vector<int> degree(n, 0);
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      sum[t[k]] += mesh.positions[t[(k + 1) % 3]];
      ++degree[t[k]];
    }
  std::vector<double> bump(n, 0), shared(n, 0);
  for (std::size_t v = 0; v < n; ++v)
    if (degree[v]) bump[v] = (sum[v] / degree[v] - mesh.positions[v]).dot(normals[v]);
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) shared[t[k]] += bump[t[(k + 1) % 3]];
  std::vector<double> rest;
  for (std::size_t v = 0; v < n; ++v)
    if (degree[v] > 3) rest.push_back(std::abs(bump[v] - shared[v] / degree[v]));
  if (rest.empty()) return 0;
  std::nth_element(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(rest.size() / 2), rest.end());
  return rest[rest.size() / 2] / (0.6745 * 1.55); // of white noise with six neighbours
}

/// Moves the vertices of a rebuilt surface onto the weighted plane of the scan's points near them.
void settle_on_points(TriangleMesh& mesh, const std::vector<Vec3>& points, const OrientedPoints& samples, double radius) {
  const PointGrid grid(points, radius), coarse(samples.position, 2.5 * samples.spacing);
  for (int round = 0; round < 2; ++round) {
    const std::vector<Vec3> normals = vertex_normals(mesh);
    std::vector<double> shift(mesh.positions.size(), 0);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      // only points of the side that faces the same way: across a thin gap or a finger lies another side
      const Vec3& p = mesh.positions[v];
      double sum = 0, weight = 0;
      auto add = [&](const Vec3& q, double d2, double w) {
        const double k = 1 - d2 / (radius * radius);
        sum += w * k * k * (q - p).dot(normals[v]);
        weight += w * k * k;
      };
      grid.within(p, radius, [&](int i, double d2) { add(points[i], d2, 1); });
      bool mixed = false;
      coarse.within(p, radius, [&](int i, double) { mixed |= samples.normal[i].dot(normals[v]) < 0; });
      if (weight <= 0) continue;
      const double most = 0.4 * radius;
      shift[v] = std::clamp(sum / weight, -most, most) * std::min(1.0, weight / 1.5);
      if (mixed) {
        sum = weight = 0;
        coarse.within(p, radius, [&](int i, double d2) {
          const double agree = samples.normal[i].dot(normals[v]);
          if (agree > 0.2) add(samples.position[i], d2, agree);
        });
        shift[v] = weight > 0 ? std::clamp(sum / weight, -most, most) * std::min(1.0, weight) : 0;
      }
    }
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) mesh.positions[v] += shift[v] * normals[v];
  }
}

/// Evens out the spacing of a rebuilt surface and what noise is left: Taubin 1995.
void fair(TriangleMesh& mesh, int rounds) {
  const std::size_t n = mesh.positions.size();
  std::vector<Vec3> sum(n);
  std::vector<int> degree(n, 0);
  for (const Triangle& t : mesh.triangles)
    for (const int v : t) ++degree[v];
  for (int round = 0; round < 2 * rounds; ++round) {
    std::fill(sum.begin(), sum.end(), Vec3::Zero());
    for (const Triangle& t : mesh.triangles)
      for (int k = 0; k < 3; ++k) sum[t[k]] += mesh.positions[t[(k + 1) % 3]];
    const double factor = round % 2 == 0 ? 0.5 : -0.52;
    for (std::size_t v = 0; v < n; ++v)
      if (degree[v]) mesh.positions[v] += factor * (sum[v] / degree[v] - mesh.positions[v]);
  }
}

std::string text_of(const char* format, double x) {
  char text[120];
  std::snprintf(text, sizeof text, format, x);
  return text;
}

} // namespace

TriangleMesh rebuild_surface(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles, const std::vector<char>& is_body, double stature,
                             double& noise_m) {
  // a thin cloud needs wider samples
  constexpr double MAX_LONELY = 0.03;
  double spacing = SAMPLE * stature;
  OrientedPoints samples = sample_surface(positions, triangles, is_body, spacing, MAX_LONELY);
  while (samples.lonely_share > MAX_LONELY) {
    spacing *= 1.35;
    samples = sample_surface(positions, triangles, is_body, spacing, spacing < 0.02 * stature ? MAX_LONELY : 1.0);
    if (spacing >= 0.02 * stature) break;
  }
  noise_m = samples.noise_m;
  const double cell = std::max(CELL * stature, 1.2 * spacing);
  TriangleMesh mesh = zero_surface(indicator(samples, cell));
  fair(mesh, 2);
  std::vector<Vec3> points;
  for (std::size_t v = 0; v < positions.size(); ++v)
    if (is_body[v]) points.push_back(positions[v]);
  settle_on_points(mesh, points, samples, 1.3 * cell);
  fair(mesh, 1);
  return mesh;
}

SkinSurface make_skin(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles, const std::vector<char>& is_body, double stature) {
  SkinSurface skin;
  skin.mesh = own_faces(positions, triangles, is_body, skin.of_scan);
  std::string why;
  if (skin.mesh.triangles.size() < 1000) why = triangles.empty() ? "the scan has points and no faces" : "the scan has hardly any faces";
  else {
    if (skin.mesh.positions.size() > 0.9 * static_cast<double>(skin.mesh.triangles.size())) weld(skin.mesh, skin.of_scan); // STL: three vertices a face
    if (const int dropped = drop_small_pieces(skin.mesh, skin.of_scan))
      skin.findings.push_back({"info", std::to_string(dropped) + " small loose pieces are left out of the skin", "faces"});
    std::vector<HalfEdge> list = half_edges(skin.mesh);
    count_edges(list, skin);
    const double edges = 1.5 * static_cast<double>(skin.mesh.triangles.size());
    if (skin.border_edges > MAX_BORDER_SHARE * edges && weld(skin.mesh, skin.of_scan)) { // texture seams
      list = half_edges(skin.mesh);
      count_edges(list, skin);
    }
    orient_faces(skin.mesh, list);
    if (skin.flipped_edges)
      skin.findings.push_back({"warning", std::to_string(skin.flipped_edges) + " edges whose faces disagree about outside; turned", "faces"});
    skin.noise_m = roughness(skin.mesh);
    if (skin.border_edges > 0 && skin.noise_m <= MAX_NOISE) {
      // many small holes, or few of any size: the scan's own faces stay
      const double widest = skin.border_edges <= MAX_BORDER_SHARE * edges ? 1e300 : SMALL_HOLE * stature;
      const int open = skin.border_edges;
      if (skin.border_edges < 0.4 * edges && fill_holes(skin.mesh, list, widest)) {
        count_edges(half_edges(skin.mesh), skin);
        skin.findings.push_back({"info", "holes with " + std::to_string(open) + " open edges were closed", "body.obj"});
      }
    }
    if (skin.border_edges > 0) why = "the scan has holes (" + std::to_string(skin.border_edges) + " open edges)";
    else if (skin.crowded_edges > MAX_BORDER_SHARE * edges) why = "the scan has " + std::to_string(skin.crowded_edges) + " edges with more than two faces";
    else if (skin.noise_m > MAX_NOISE) why = text_of("the scan is rough (%.1f mm)", 1000 * skin.noise_m);
  }
  if (why.empty()) return skin;
  double noise = 0;
  skin.mesh = rebuild_surface(positions, triangles, is_body, stature, noise);
  skin.noise_m = std::max(skin.noise_m, noise);
  skin.rebuilt = true;
  skin.of_scan.clear();
  skin.findings.push_back(
      {"warning", "the skin was rebuilt as a closed surface of " + std::to_string(skin.mesh.triangles.size()) + " triangles: " + why, "body.obj"});
  return skin;
}

} // namespace sloper::body

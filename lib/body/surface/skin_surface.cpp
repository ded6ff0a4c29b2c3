#include <body/surface/mesh_repair.hpp>
#include <body/surface/point_grid.hpp>
#include <body/surface/skin_surface.hpp>
#include <body/surface/sparse_cloud.hpp>
#include <body/surface/surface_nets.hpp>
#include <sloper/base/statistics.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>

namespace sloper::body {

namespace {

constexpr double CELL = 1.0 / 180;   ///< of stature: grid spacing of a rebuilt skin
constexpr double SAMPLE = 1.0 / 260; ///< of stature: spacing of the samples
constexpr double LEAST_HOLE = 0.006; ///< of stature: narrower holes are reported as a number only
constexpr std::size_t MOST_HOLES = 12;
constexpr double MAX_BORDER_SHARE = 1e-3; ///< of all edges: more open edges and the skin is rebuilt
constexpr double SOLES = 0.025, CROWN = 0.9; ///< of stature: holes lower or higher are cuts
constexpr double SMALL_HOLE = 0.035;         ///< of stature: a hole that a fan closes well enough
constexpr double MAX_NOISE = 0.45e-3;        ///< m
/// ... or this share of the edges: between vertices that far apart a smooth body bends by as much,
/// which is no noise.
constexpr double MAX_NOISE_TO_EDGE = 0.055;

/// Edge length of so many equal triangles of the same area, m.
double usual_edge(const TriangleMesh& mesh) {
  double twice = 0;
  for (const Triangle& t : mesh.triangles)
    twice += area_normal(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]).norm();
  return std::sqrt(2 / std::sqrt(3.0) * twice /
                   static_cast<double>(std::max<std::size_t>(1, mesh.triangles.size())));
}

/// Roughness at the scale of the mesh: the part of the umbrella vector along the normal that
/// neighbours do not share.
double roughness(const TriangleMesh& mesh) {
  const std::size_t n = mesh.positions.size();
  std::vector<Vec3> sum(n, Vec3::Zero()),
      normal(n, Vec3::Zero()); // normals by area: good enough for a median
  std::vector<int> degree(n, 0);
  for (const Triangle& t : mesh.triangles) {
    const Vec3 facing =
        area_normal(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]);
    for (int k = 0; k < 3; ++k) {
      sum[t[k]] += mesh.positions[t[(k + 1) % 3]];
      normal[t[k]] += facing;
      ++degree[t[k]];
    }
  }
  std::vector<double> bump(n, 0), shared(n, 0);
  for (std::size_t v = 0; v < n; ++v)
    if (const double length = normal[v].norm(); degree[v] && length > 0)
      bump[v] = (sum[v] / degree[v] - mesh.positions[v]).dot(normal[v]) / length;
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k)
      shared[t[k]] += bump[t[(k + 1) % 3]];
  std::vector<double> rest;
  for (std::size_t v = 0; v < n; ++v)
    if (degree[v] > 3)
      rest.push_back(std::abs(bump[v] - shared[v] / degree[v]));
  if (rest.empty())
    return 0;
  return upper_median(rest) / (0.6745 * 1.55); // of white noise with six neighbours
}

/// Moves the vertices of a rebuilt surface onto the weighted plane of the scan's points near them.
void settle_on_points(TriangleMesh& mesh, const std::vector<Vec3>& points,
                      const OrientedPoints& samples, double radius) {
  const PointGrid grid(points, radius), coarse(samples.position, 2.5 * samples.spacing);
  for (int round = 0; round < 2; ++round) {
    const std::vector<Vec3> normals = vertex_normals(mesh);
    std::vector<double> shift(mesh.positions.size(), 0);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      // only points of the side that faces the same way: across a thin gap or a finger lies another
      // side
      const Vec3& p = mesh.positions[v];
      double sum = 0, weight = 0;
      auto add = [&](const Vec3& q, double d2, double w) {
        const double k = 1 - d2 / (radius * radius);
        sum += w * k * k * (q - p).dot(normals[v]);
        weight += w * k * k;
      };
      grid.within(p, radius, [&](int i, double d2) { add(points[i], d2, 1); });
      bool mixed = false;
      coarse.within(p, radius,
                    [&](int i, double) { mixed |= samples.normal[i].dot(normals[v]) < 0; });
      if (weight <= 0)
        continue;
      const double most = 0.4 * radius;
      shift[v] = std::clamp(sum / weight, -most, most) * std::min(1.0, weight / 1.5);
      if (mixed) {
        sum = weight = 0;
        coarse.within(p, radius, [&](int i, double d2) {
          const double agree = samples.normal[i].dot(normals[v]);
          if (agree > 0.2)
            add(samples.position[i], d2, agree);
        });
        shift[v] = weight > 0 ? std::clamp(sum / weight, -most, most) * std::min(1.0, weight) : 0;
      }
    }
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
      mesh.positions[v] += shift[v] * normals[v];
  }
}

/// Evens out the spacing of a rebuilt surface and what noise is left: Taubin 1995.
void fair(TriangleMesh& mesh, int rounds) {
  const std::size_t n = mesh.positions.size();
  std::vector<Vec3> sum(n);
  std::vector<int> degree(n, 0);
  for (const Triangle& t : mesh.triangles)
    for (const int v : t)
      ++degree[v];
  for (int round = 0; round < 2 * rounds; ++round) {
    std::fill(sum.begin(), sum.end(), Vec3::Zero());
    for (const Triangle& t : mesh.triangles)
      for (int k = 0; k < 3; ++k)
        sum[t[k]] += mesh.positions[t[(k + 1) % 3]];
    const double factor = round % 2 == 0 ? 0.5 : -0.52;
    for (std::size_t v = 0; v < n; ++v)
      if (degree[v])
        mesh.positions[v] += factor * (sum[v] / degree[v] - mesh.positions[v]);
  }
}

/// Pieces of the skin, 2 % of the largest's area and more, that reach out beyond it on a side: arms
/// that are separate pieces within sleeves. No path over the skin reaches them.
int pieces_aside(const TriangleMesh& mesh, double stature) {
  constexpr double LEAST_AREA = 0.02, LEAST_ASIDE = 0.03; // of the largest's, of stature
  const std::vector<int> piece = connected_components(mesh.positions.size(), mesh.triangles);
  if (piece.empty())
    return 0;
  struct Piece {
    double area = 0;
    Box3 box;
  };
  std::vector<Piece> pieces(
      static_cast<std::size_t>(*std::max_element(piece.begin(), piece.end())) + 1);
  for (const Triangle& t : mesh.triangles)
    pieces[piece[t[0]]].area +=
        area_normal(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]).norm();
  for (std::size_t v = 0; v < piece.size(); ++v)
    pieces[piece[v]].box.add(mesh.positions[v]);
  const Piece& largest = *std::max_element(
      pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.area < b.area; });
  const double most = LEAST_ASIDE * stature;
  return static_cast<int>(std::count_if(pieces.begin(), pieces.end(), [&](const Piece& other) {
    return other.area > LEAST_AREA * largest.area &&
           (other.box.high.x() > largest.box.high.x() + most ||
            other.box.low.x() < largest.box.low.x() - most);
  }));
}

std::string text_of(const char* format, double x) {
  char text[120];
  std::snprintf(text, sizeof text, format, x);
  return text;
}

} // namespace

TriangleMesh rebuild_surface(const std::vector<Vec3>& positions,
                             const std::vector<Triangle>& triangles,
                             const std::vector<char>& is_body, double stature, double& noise_m) {
  constexpr double MAX_LONELY = 0.03;
  double spacing = SAMPLE * stature;
  std::vector<Vec3> points;
  for (std::size_t v = 0; v < positions.size(); ++v)
    if (is_body[v])
      points.push_back(positions[v]);
  OrientedPoints samples = sample_surface(positions, triangles, is_body, spacing, MAX_LONELY);
  const bool thin = samples.lonely_share > MAX_LONELY;
  if (thin && triangles.empty()) {
    points = fill_thin_cloud(points, spacing);
    samples = sample_surface(points, {}, std::vector<char>(points.size(), 1), spacing, MAX_LONELY);
  }
  while (samples.lonely_share > MAX_LONELY) { // still thin: wider samples
    spacing *= 1.35;
    const double most = spacing < 0.02 * stature ? MAX_LONELY : 1.0;
    samples = thin && triangles.empty()
                  ? sample_surface(points, {}, std::vector<char>(points.size(), 1), spacing, most)
                  : sample_surface(positions, triangles, is_body, spacing, most);
    if (spacing >= 0.02 * stature)
      break;
  }
  noise_m = samples.noise_m;
  const double cell = std::max(CELL * stature, 1.2 * spacing);
  TriangleMesh mesh = zero_surface(indicator(samples, cell));
  fair(mesh, 2);
  settle_on_points(mesh, points, samples, 1.3 * cell);
  fair(mesh, 1);
  return mesh;
}

SkinSurface make_skin(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                      const std::vector<char>& is_body, double stature,
                      const std::string& rebuild_why) {
  SkinSurface skin;
  skin.mesh = own_faces(positions, triangles, is_body, skin.of_scan);
  auto keep = [&](const EdgeCounts& counts) {
    skin.border_edges = counts.border;
    skin.crowded_edges = counts.crowded;
    skin.flipped_edges = counts.flipped;
  };
  std::string why = rebuild_why;
  bool filled = false;
  if (!why.empty())
    skin.mesh = {};
  else if (skin.mesh.triangles.size() < 1000)
    why = triangles.empty() ? "the scan has points and no faces" : "the scan has hardly any faces";
  else {
    if (skin.mesh.positions.size() > 0.9 * static_cast<double>(skin.mesh.triangles.size()))
      weld(skin.mesh, skin.of_scan); // STL: three vertices a face
    if (const int dropped = drop_small_pieces(skin.mesh, skin.of_scan))
      skin.findings.push_back(
          {"scan.pieces-left-out"_id, "info",
           std::to_string(dropped) + " small loose pieces are left out of the skin", "faces"});
    std::vector<HalfEdge> list = half_edges(skin.mesh);
    keep(count_edges(list));
    const double edges = 1.5 * static_cast<double>(skin.mesh.triangles.size());
    if (skin.border_edges > MAX_BORDER_SHARE * edges &&
        weld(skin.mesh, skin.of_scan)) { // texture seams
      list = half_edges(skin.mesh);
      keep(count_edges(list));
    }
    if (skin.border_edges > 0)
      skin.holes = holes_of(skin.mesh, list, LEAST_HOLE * stature, MOST_HOLES);
    orient_faces(skin.mesh, list);
    if (skin.flipped_edges)
      skin.findings.push_back(
          {"scan.faces-turned"_id, "warning",
           std::to_string(skin.flipped_edges) + " edges whose faces disagree about outside; turned",
           "faces"});
    skin.noise_m = roughness(skin.mesh);
    const double most_noise = std::max(MAX_NOISE, MAX_NOISE_TO_EDGE * usual_edge(skin.mesh));
    if (skin.border_edges > 0 && skin.noise_m <= most_noise) {
      // many small holes, or few of any size: the scan's own faces stay
      const double widest =
          skin.border_edges <= MAX_BORDER_SHARE * edges ? 1e300 : SMALL_HOLE * stature;
      const int open = skin.border_edges;
      if (skin.border_edges < 0.5 * edges &&
          fill_holes(skin.mesh, list, widest, SOLES * stature, CROWN * stature)) {
        filled = true;
        keep(count_edges(half_edges(skin.mesh)));
        skin.findings.push_back({"scan.holes-closed"_id, "info",
                                 "holes with " + std::to_string(open) + " open edges were closed",
                                 "body.obj"});
      }
    }
    if (skin.border_edges > 0)
      why = "the scan has holes (" + std::to_string(skin.border_edges) + " open edges)";
    else if (skin.crowded_edges > MAX_BORDER_SHARE * edges)
      why =
          "the scan has " + std::to_string(skin.crowded_edges) + " edges with more than two faces";
    else if (const int aside = pieces_aside(skin.mesh, stature))
      why = "its limbs are " + std::to_string(aside) + " pieces of their own";
    else if (skin.noise_m > most_noise)
      why = text_of("the scan is rough (%.1f mm)", 1000 * skin.noise_m);
  }
  skin.whole = why.empty() && !filled;
  if (why.empty())
    return skin;
  double noise = 0;
  skin.mesh = rebuild_surface(positions, triangles, is_body, stature, noise);
  skin.noise_m = std::max(skin.noise_m, noise);
  skin.rebuilt = true;
  skin.of_scan.clear();
  skin.findings.push_back({"scan.skin-rebuilt"_id, "warning",
                           "the skin was rebuilt as a closed surface of " +
                               std::to_string(skin.mesh.triangles.size()) + " triangles: " + why,
                           "body.obj"});
  return skin;
}

} // namespace sloper::body

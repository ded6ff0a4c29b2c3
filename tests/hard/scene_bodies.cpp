/// Bodies of the scenes: surfaces of revolution and prisms, and what scanners do to them.
#include "scene_tools.hpp"

#include <support/shapes.hpp>

#include <cmath>
#include <functional>

namespace sloper::hard {

namespace {

using shapes::append;

/// Closed surface about the vertical through `center`: radius(t) at height(t), t in (0, 1); a point
/// at each end.
TriangleMesh revolve(int around, int up, const std::function<double(double)>& radius,
                     const std::function<double(double)>& height, const Vec3& center) {
  std::vector<shapes::Ring> rings;
  for (int r = 0; r <= up; ++r) {
    const double t = (r + 0.5) / (up + 1);
    rings.push_back({height(t), radius(t), radius(t)});
  }
  TriangleMesh mesh = shapes::revolve(around, rings, center);
  shapes::close_ends(mesh, around, center + Vec3(0, height(0), 0), center + Vec3(0, height(1), 0));
  return mesh;
}

TriangleMesh sphere(double radius, int fineness, const Vec3& center) {
  return revolve(
      2 * fineness, fineness, [=](double t) { return radius * std::sin(M_PI * t); },
      [=](double t) { return -radius * std::cos(M_PI * t); }, center);
}

TriangleMesh column(double radius, double low, double high, int fineness, const Vec3& center) {
  return revolve(
      2 * fineness, 2 * fineness, [=](double) { return radius; },
      [=](double t) { return low + t * (high - low); }, center);
}

/// Prism along z with a convex section in x, y, counter-clockwise.
TriangleMesh prism(const std::vector<Vec2>& section, double length, int cells) {
  TriangleMesh m;
  const int n = std::ssize(section);
  for (int k = 0; k <= cells; ++k)
    for (const Vec2& q : section)
      m.positions.emplace_back(q.x(), q.y(), length * (static_cast<double>(k) / cells - 0.5));
  for (int k = 0; k < cells; ++k)
    for (int i = 0; i < n; ++i) {
      const int a = k * n + i, b = k * n + (i + 1) % n, c = a + n, d = b + n;
      m.triangles.push_back({a, b, d});
      m.triangles.push_back({a, d, c});
    }
  for (int i = 1; i + 1 < n; ++i) {
    m.triangles.push_back({0, i + 1, i});
    m.triangles.push_back({cells * n, cells * n + i, cells * n + i + 1});
  }
  return m;
}

} // namespace

TriangleMesh make_body_mesh(const Parameters& p) {
  const std::string shape = p.text("body", "sphere");
  const double radius = p.number("radius_m", 0.1), gap = p.number("gap_m", 0);
  const int fineness = p.whole("fineness", 16);
  if (shape == "sphere")
    return sphere(radius, fineness, Vec3::Zero());
  if (shape == "spheres") {
    TriangleMesh m = sphere(radius, fineness, Vec3(0, 0, radius + 0.5 * gap));
    append(m, sphere(radius, fineness, Vec3(0, 0, -radius - 0.5 * gap)));
    return m;
  }
  if (shape == "pillar" || shape == "arm" || shape == "groove") {
    auto figure = [&](double t) { // waist at y = 1, hips at 0.8
      const double y = 0.2 + t;
      return y > 1 ? 0.12 + 0.3 * (y - 1) * (y - 1)
                   : 0.12 + 0.008 * (1 - std::cos(M_PI * std::min((1 - y) / 0.2, 1.0)));
    };
    if (shape == "groove") {
      TriangleMesh m = column(radius, 0.2, 1.2, fineness, Vec3(radius + 0.5 * gap, 0, 0));
      append(m, column(radius, 0.2, 1.2, fineness, Vec3(-radius - 0.5 * gap, 0, 0)));
      return m;
    }
    TriangleMesh m = revolve(
        2 * fineness, 2 * fineness, figure, [](double t) { return 0.2 + t; }, Vec3::Zero());
    if (shape == "arm")
      append(m, column(0.04, 0.45, 1.1, fineness / 2 + 4, Vec3(0.136 + 0.04 + gap, 0, 0)));
    return m;
  }
  if (shape == "ridge")
    return prism({{-radius, -radius}, {radius, -radius}, {0, 0}}, 4 * radius, fineness);
  if (shape == "spike") {
    return revolve(
        2 * fineness, fineness, [=](double t) { return radius * (1 - t) * (1 - t); },
        [=](double t) { return 4 * radius * (t - 1); }, Vec3::Zero());
  }
  if (shape == "triangle")
    return {{{-radius, 0, radius}, {radius, 0, radius}, {0, 0, -radius}}, {{0, 1, 2}}};
  if (shape == "plate") {
    TriangleMesh m;
    const int n = fineness;
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= n; ++j)
        m.positions.emplace_back(radius * (2.0 * i / n - 1), 0, radius * (2.0 * j / n - 1));
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const int a = i * (n + 1) + j, b = a + n + 1;
        m.triangles.push_back({a, a + 1, b + 1});
        m.triangles.push_back({a, b + 1, b});
      }
    return m;
  }
  if (shape == "none")
    return {};
  throw input_error("hard.bad-scene"_id, "", "body", shape + " is no body of these scenes");
}

body::Body make_body(TriangleMesh mesh) {
  body::Body b;
  double low = 0, high = 0;
  for (const Vec3& q : mesh.positions) {
    low = std::min(low, q.y());
    high = std::max(high, q.y());
  }
  b.landmarks["hip_center"].p = Vec3(0, low, 0);
  b.landmarks["neck_center"].p = Vec3(0, high, 0);
  b.face_part.assign(mesh.triangles.size(), body::Part::TORSO);
  b.skin = std::move(mesh);
  return b;
}

void damage(TriangleMesh& mesh, const std::string& kind, std::uint64_t seed) {
  Random random(seed + 1);
  auto& f = mesh.triangles;
  if (f.empty())
    return; // nothing to damage
  if (kind == "holes") {
    for (int k = 0; k < 12 && !f.empty(); ++k) {
      const Vec3 middle = mesh.positions[f[random.next() % f.size()][0]];
      f.erase(std::remove_if(
                  f.begin(), f.end(),
                  [&](const Triangle& t) { return (mesh.positions[t[0]] - middle).norm() < 0.02; }),
              f.end());
    }
  } else if (kind == "open") { // a scan that is cut at neck and knees: no faces at its ends
    const auto lower = [](const Vec3& a, const Vec3& b) { return a.y() < b.y(); };
    const auto [low, high] =
        std::minmax_element(mesh.positions.begin(), mesh.positions.end(), lower);
    const int ends[] = {static_cast<int>(low - mesh.positions.begin()),
                        static_cast<int>(high - mesh.positions.begin())};
    std::erase_if(f, [&](const Triangle& t) {
      return std::any_of(t.begin(), t.end(), [&](int v) { return v == ends[0] || v == ends[1]; });
    });
  } else if (kind == "noise") {
    jitter(mesh.positions, 0.002, seed + 1);
  } else if (kind == "flipped") {
    for (Triangle& t : f)
      if (random.uniform() < 0.3)
        std::swap(t[1], t[2]);
  } else if (kind == "inside_out") {
    for (Triangle& t : f)
      std::swap(t[1], t[2]);
  } else if (kind == "debris") {
    for (int k = 0; k < 30; ++k) {
      const Vec3 at = random_point(random, {-0.6, 0, 0.4}, {0.6, 1.3, 0.6});
      const int base = std::ssize(mesh.positions);
      for (int c = 0; c < 3; ++c)
        mesh.positions.push_back(at + 0.01 * random_point(random, Vec3::Zero(), Vec3::Ones()));
      f.push_back({base, base + 1, base + 2});
    }
  } else if (kind == "duplicates") {
    for (std::size_t k = 0, n = f.size(); k < n; k += 7)
      f.push_back(f[k]);
  } else if (kind == "fins") { // three triangles on one edge
    for (std::size_t k = 0, n = f.size(); k < n; k += 40) {
      const Vec3 middle = (mesh.positions[f[k][0]] + mesh.positions[f[k][1]]) * 0.5;
      mesh.positions.push_back(0.98 * middle);
      f.push_back({f[k][0], f[k][1], static_cast<int>(mesh.positions.size()) - 1});
    }
  } else if (kind == "cracks") { // every triangle by itself
    TriangleMesh apart;
    for (const Triangle& t : f) {
      const int base = std::ssize(apart.positions);
      for (int k = 0; k < 3; ++k)
        apart.positions.push_back(mesh.positions[t[k]]);
      apart.triangles.push_back({base, base + 1, base + 2});
    }
    mesh = apart;
  } else if (kind == "zero_area") {
    for (std::size_t k = 0, n = f.size(); k < n; k += 11)
      f.push_back({f[k][0], f[k][0], f[k][1]});
  } else if (kind == "nan") {
    mesh.positions[mesh.positions.size() / 2].y() = std::nan("");
  } else if (kind != "none") {
    throw input_error("hard.bad-scene"_id, "", "damage", kind + " is no damage of these scenes");
  }
}

} // namespace sloper::hard

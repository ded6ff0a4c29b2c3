#include <render/occlusion.hpp>
#include <sloper/base/parallel.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <unordered_map>

namespace sloper::render {

namespace {

constexpr int MAP_SIZE = 320;         // pixels of a depth picture; about 6 mm each for a person
constexpr double CELLS = 160;         // of the thinning grid along the scene's height
constexpr float BIAS = 0.006f;        // m: what is nearer than this throws no shadow
constexpr float SOFT = 0.006f;        // m beyond it over which the shadow grows
constexpr float LEAST_FACING = 0.05f; // cosine below which a direction does not count
constexpr int RIM_PIXELS = 2;         // pixels around the scene: no triangle touches the rim
constexpr float NOTHING = -1e9f;      // m: height where no triangle is seen
constexpr float FLATTEST = 1e-6f;     // square pixels: a triangle seen from its edge hides nothing
constexpr float MOST_SLOPE_BIAS = 0.02f; // m: added for surfaces seen askew, at most
constexpr float SLOPE_PIXELS = 0.7f;     // over which such a surface rises: half a pixel's diagonal
constexpr double GOLDEN_ANGLE = 2.399963229728653; // rad: spreads points evenly
constexpr double SKY_DEPTH = 1.6; // of the sphere's height of 2: somewhat below the horizon too
constexpr float NIGHT = 0.15f, DAY = 0.85f; // light where no sky is seen, and what all of it adds
constexpr int KEY_DIRECTIONS = 7;           // across the disc of the key light

Vec3 any_square(const Vec3& a) {
  const Vec3 other = std::abs(a.y()) < 0.9 ? Vec3(0, 1, 0) : Vec3(1, 0, 0);
  return other.cross(a).normalized();
}

} // namespace

/// Heights above a plane square to `direction`, as seen from there.
struct Occlusion::DepthMap {
  Eigen::Vector3f right, up, towards, center;
  float scale;               ///< pixels per m
  std::vector<float> height; ///< MAP_SIZE by MAP_SIZE, m
  void raise_to(const std::array<Eigen::Vector3f, 3>& corner, bool solid);
};

Occlusion::Occlusion(const std::vector<DrawMesh>& meshes) {
  Box3 box;
  for (const DrawMesh& mesh : meshes)
    for (const Vec3& p : mesh.positions)
      box.add(p);
  if (box.empty())
    return;
  m_center = box.center();
  m_radius = std::max(1e-6, 0.5 * box.size().norm());
  const double cell = std::max(box.size().maxCoeff(), 1e-6) / CELLS;
  for (const DrawMesh& mesh : meshes)
    add_thinned(mesh, box.low, cell);
}

/// Points of one cell become one at their mean; each mesh apart, so that cloth stays off the skin.
void Occlusion::add_thinned(const DrawMesh& mesh, const Vec3& low, double cell) {
  std::unordered_map<std::uint64_t, int> cluster_of_cell;
  cluster_of_cell.reserve(mesh.positions.size() / 2);
  std::vector<int> cluster(mesh.positions.size());
  std::vector<Vec3> sum;
  std::vector<int> count;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3 at = (mesh.positions[v] - low) / cell;
    const auto x = static_cast<std::uint64_t>(at.x());
    const auto y = static_cast<std::uint64_t>(at.y());
    const auto z = static_cast<std::uint64_t>(at.z());
    const std::uint64_t key = x << 40 | y << 20 | z; // 20 bits each
    const auto [found, is_new] = cluster_of_cell.try_emplace(key, static_cast<int>(sum.size()));
    if (is_new) {
      sum.emplace_back(Vec3::Zero());
      count.push_back(0);
    }
    const int k = found->second;
    cluster[v] = k;
    sum[k] += mesh.positions[v];
    ++count[k];
  }
  const int base = std::ssize(m_positions);
  for (std::size_t k = 0; k < sum.size(); ++k)
    m_positions.push_back((sum[k] / count[k] - m_center).cast<float>());
  for (const Triangle& t : mesh.triangles) {
    const int a = cluster[t[0]], b = cluster[t[1]], c = cluster[t[2]];
    const bool collapsed = a == b || b == c || c == a;
    if (collapsed)
      continue;
    m_triangles.push_back({base + a, base + b, base + c});
    m_is_solid.push_back(!mesh.is_cloth);
  }
}

Occlusion::DepthMap Occlusion::depth_from(const Vec3& direction) const {
  DepthMap map;
  const Vec3 right = any_square(direction);
  map.right = right.cast<float>();
  map.up = direction.cross(right).cast<float>();
  map.towards = direction.cast<float>();
  map.center = m_center.cast<float>();
  map.scale = static_cast<float>(0.5 * (MAP_SIZE - 2 * RIM_PIXELS) / m_radius);
  map.height.assign(static_cast<std::size_t>(MAP_SIZE) * MAP_SIZE, NOTHING);
  std::vector<Eigen::Vector3f> at(m_positions.size()); // pixels, pixels, m
  for (std::size_t v = 0; v < at.size(); ++v)
    at[v] = {m_positions[v].dot(map.right) * map.scale + 0.5f * MAP_SIZE,
             m_positions[v].dot(map.up) * map.scale + 0.5f * MAP_SIZE,
             m_positions[v].dot(map.towards)};
  for (std::size_t f = 0; f < m_triangles.size(); ++f) {
    const Triangle& t = m_triangles[f];
    map.raise_to({at[t[0]], at[t[1]], at[t[2]]}, m_is_solid[f]);
  }
  return map;
}

/// Draws a triangle: each pixel keeps the greatest height. @param corner  pixels, pixels, m
/// @param solid  of a body, whose far side lies below its near side and is left out
void Occlusion::DepthMap::raise_to(const std::array<Eigen::Vector3f, 3>& corner, bool solid) {
  const auto& [a, b, c] = corner;
  const int x0 = std::max(0, static_cast<int>(std::min({a.x(), b.x(), c.x()})));
  const int x1 = std::min(MAP_SIZE - 1, static_cast<int>(std::max({a.x(), b.x(), c.x()})));
  const int y0 = std::max(0, static_cast<int>(std::min({a.y(), b.y(), c.y()})));
  const int y1 = std::min(MAP_SIZE - 1, static_cast<int>(std::max({a.y(), b.y(), c.y()})));
  const float area = (b.x() - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (b.y() - a.y());
  if (std::abs(area) < FLATTEST)
    return;
  if (area < 0 && solid)
    return;
  const float inverse = 1 / area;
  // u, v: barycentric coordinates of b and c, and how they change from pixel to pixel
  const float ux = (c.y() - a.y()) * inverse, uy = (a.x() - c.x()) * inverse;
  const float vx = (a.y() - b.y()) * inverse, vy = (b.x() - a.x()) * inverse;
  const float b_above = b.z() - a.z(), c_above = c.z() - a.z();
  const float slope_x = ux * b_above + vx * c_above;
  const float dx = static_cast<float>(x0) + 0.5f - a.x();
  for (int y = y0; y <= y1; ++y) {
    const float dy = static_cast<float>(y) + 0.5f - a.y();
    float u = ux * dx + uy * dy;
    float v = vx * dx + vy * dy;
    float z = a.z() + u * b_above + v * c_above;
    float* row = height.data() + static_cast<std::size_t>(y) * MAP_SIZE;
    for (int x = x0; x <= x1; ++x) {
      const bool inside = u >= 0 && v >= 0 && u + v <= 1;
      if (inside && z > row[x])
        row[x] = z;
      u += ux;
      v += vx;
      z += slope_x;
    }
  }
}

void Occlusion::receive(const DepthMap& map, const std::vector<Vec3>& points,
                        const std::vector<Vec3>& normals, Light& light, std::size_t begin,
                        std::size_t end) {
  for (std::size_t i = begin; i < end; ++i) {
    const float facing = normals[i].cast<float>().dot(map.towards);
    if (facing <= LEAST_FACING)
      continue;
    const Eigen::Vector3f p = points[i].cast<float>() - map.center;
    const float x = p.dot(map.right) * map.scale + 0.5f * MAP_SIZE - 0.5f,
                y = p.dot(map.up) * map.scale + 0.5f * MAP_SIZE - 0.5f;
    light.all[i] += facing;
    if (!(x >= 0 && y >= 0 && x < MAP_SIZE - 2 && y < MAP_SIZE - 2)) {
      light.lit[i] += facing;
      continue;
    }
    const int ix = static_cast<int>(x), iy = static_cast<int>(y);
    const float fx = x - static_cast<float>(ix), fy = y - static_cast<float>(iy);
    // A surface seen askew rises within a pixel: the bias grows with its slope.
    const float sine = std::sqrt(1 - std::min(1.f, facing * facing));
    const float rise = SLOPE_PIXELS * sine / facing / map.scale;
    const float limit = p.dot(map.towards) + BIAS + std::min(MOST_SLOPE_BIAS, rise);
    const float* row = map.height.data() + static_cast<std::size_t>(iy) * MAP_SIZE + ix;
    auto open = [&](float height) { return 1 - std::clamp((height - limit) / SOFT, 0.f, 1.f); };
    const float share = (1 - fy) * ((1 - fx) * open(row[0]) + fx * open(row[1])) +
                        fy * ((1 - fx) * open(row[MAP_SIZE]) + fx * open(row[MAP_SIZE + 1]));
    light.lit[i] += facing * share;
  }
}

std::vector<float> Occlusion::gather(const std::vector<Vec3>& directions,
                                     const std::vector<Vec3>& points,
                                     const std::vector<Vec3>& normals, float unlit) const {
  std::vector<DepthMap> maps(directions.size());
  parallel_for(directions.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      maps[k] = depth_from(directions[k]);
  });
  Light light{.all = std::vector<float>(points.size(), 0.f),
              .lit = std::vector<float>(points.size(), 0.f)};
  parallel_for(points.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (const DepthMap& map : maps)
      receive(map, points, normals, light, begin, end);
    for (std::size_t i = begin; i < end; ++i)
      light.lit[i] = light.all[i] > 0 ? light.lit[i] / light.all[i] : unlit;
  });
  return std::move(light.lit);
}

std::vector<float> Occlusion::sky(const std::vector<Vec3>& points, const std::vector<Vec3>& normals,
                                  int directions) const {
  std::vector<Vec3> from;
  // From the zenith to somewhat below the horizon: the ground gives light back.
  for (int k = 0; k < directions; ++k) {
    const double y = 1 - SKY_DEPTH * (k + 0.5) / directions;
    const double around = k * GOLDEN_ANGLE;
    const double r = std::sqrt(std::max(0.0, 1 - y * y));
    from.emplace_back(r * std::cos(around), y, r * std::sin(around));
  }
  std::vector<float> light = gather(from, points, normals, 0.5f);
  for (float& l : light)
    l = NIGHT + DAY * l;
  return light;
}

std::vector<float> Occlusion::key(const std::vector<Vec3>& points, const std::vector<Vec3>& normals,
                                  const Vec3& towards, double spread) const {
  const Vec3 a = any_square(towards), b = towards.cross(a);
  std::vector<Vec3> from;
  for (int k = 0; k < KEY_DIRECTIONS; ++k) {
    const double angle = k * GOLDEN_ANGLE;
    const double r = spread * std::sqrt((k + 0.5) / KEY_DIRECTIONS);
    from.push_back((towards + r * (std::cos(angle) * a + std::sin(angle) * b)).normalized());
  }
  return gather(from, points, normals, 0.f);
}

} // namespace sloper::render

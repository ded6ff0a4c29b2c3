#include <sloper/collision/displacement_bounds.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::collision {

namespace {

constexpr double MOST_CUBES = 1 << 17;

void merge(Box3& box, const Box3& other) {
  box.low = box.low.cwiseMin(other.low);
  box.high = box.high.cwiseMax(other.high);
}

} // namespace

double DisplacementBounds::farthest(const Box3& bounds, const Vec3& own) {
  if (bounds.empty())
    return 0;
  return (own - bounds.low).cwiseAbs().cwiseMax((bounds.high - own).cwiseAbs()).norm();
}

std::array<int, 3> DisplacementBounds::cube_of(const Vec3& place) const {
  std::array<int, 3> cube{};
  for (int a = 0; a < 3; ++a)
    cube[a] =
        static_cast<int>(std::clamp(std::floor((place[a] - m_low[a]) / m_cell), 0.0, m_n[a] - 1.0));
  return cube;
}

void DisplacementBounds::build(const TriangleMesh& skin, const std::vector<Vec3>& displacement,
                               const Box3& region, double radius) {
  m_all = {};
  m_low = region.low;
  m_cell = std::max(CELL, 0.5 * radius);
  const auto across = [&](int a) { return std::max(1.0, std::ceil(region.size()[a] / m_cell)); };
  while (across(0) * across(1) * across(2) > MOST_CUBES)
    m_cell *= 1.25;
  for (int a = 0; a < 3; ++a)
    m_n[a] = static_cast<int>(across(a));
  m_cube.assign(static_cast<std::size_t>(m_n[0]) * static_cast<std::size_t>(m_n[1]) *
                    static_cast<std::size_t>(m_n[2]),
                Box3{});
  for (const Triangle& t : skin.triangles) {
    Box3 place, bounds;
    for (int v : t)
      place.add(skin.positions[v]);
    if (!((place.low.array() <= region.high.array()).all() &&
          (place.high.array() >= region.low.array()).all()))
      continue;
    for (int v : t)
      bounds.add(displacement[v]);
    merge(m_all, bounds);
    const std::array<int, 3> first = cube_of(place.low), last = cube_of(place.high);
    for (int i = first[0]; i <= last[0]; ++i)
      for (int j = first[1]; j <= last[1]; ++j)
        for (int k = first[2]; k <= last[2]; ++k)
          merge(at(i, j, k), bounds);
  }
}

double DisplacementBounds::max_relative_displacement(const Vec3& own, const Vec3& place,
                                                     double radius) const {
  if (m_all.empty())
    return 0;
  const Vec3 around = Vec3::Constant(radius);
  const std::array<int, 3> first = cube_of(place - around), last = cube_of(place + around);
  Box3 bounds;
  for (int i = first[0]; i <= last[0]; ++i)
    for (int j = first[1]; j <= last[1]; ++j)
      for (int k = first[2]; k <= last[2]; ++k)
        merge(bounds, at(i, j, k));
  return farthest(bounds, own);
}

} // namespace sloper::collision

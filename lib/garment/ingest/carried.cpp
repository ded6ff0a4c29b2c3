#include <sloper/garment/ingest/carried.hpp>

#include <sloper/base/parallel.hpp>
#include <sloper/collision/triangle_tree.hpp>
#include <sloper/geometry/rotation.hpp>

#include <algorithm>
#include <limits>
#include <map>

namespace sloper::garment {

namespace {

constexpr double DEEPEST_M = 0.05; // in the body: of deeper points no direction outwards is known

/// The rotation of each particle's surroundings.
std::vector<Mat3> rotations_of(const std::vector<Vec3>& before, const std::vector<Vec3>& after,
                               const std::vector<Triangle>& triangles) {
  std::vector<Mat3> covariance(before.size(), Mat3::Zero());
  for (const Triangle& t : triangles) {
    const Vec3 n = area_normal(before[t[0]], before[t[1]], before[t[2]]),
               m = area_normal(after[t[0]], after[t[1]], after[t[2]]);
    const double length = std::max(n.norm(), 1e-300) * std::max(m.norm(), 1e-300);
    // Sides and normal of the triangle, each as long as the other.
    Mat3 own = n * m.transpose() / std::sqrt(length);
    for (int k = 0; k < 3; ++k)
      own += (before[t[(k + 1) % 3]] - before[t[k]]) *
             (after[t[(k + 1) % 3]] - after[t[k]]).transpose();
    for (const int i : t)
      covariance[i] += own;
  }
  std::vector<Mat3> rotations(before.size(), Mat3::Identity());
  for (std::size_t i = 0; i < before.size(); ++i)
    if (covariance[i].norm() > 0)
      rotations[i] = nearest_rotation(covariance[i]);
  return rotations;
}

/// How far out of the body a place is to be moved, along which normal.
Vec3 way_out(const Vec3& p, const collision::BodyCollider& skin) {
  const collision::SignedDistance d = skin.signed_distance(p, DEEPEST_M);
  if (d.triangle < 0 || d.distance >= LEAST_GAP_M)
    return Vec3::Zero();
  return (LEAST_GAP_M - d.distance) * d.normal;
}

void move_rigidly(const Carried& carried, const collision::BodyCollider* skin, Moved& moved) {
  std::map<int, std::vector<int>> parts;
  for (std::size_t i = 0; i < carried.rigid.size(); ++i)
    if (carried.rigid[i] >= 0)
      parts[carried.rigid[i]].push_back(static_cast<int>(i));
  for (const auto& [part, places] : parts) {
    Vec3 from = Vec3::Zero(), to = Vec3::Zero();
    for (const int i : places) {
      from += carried.place[i] / static_cast<double>(places.size());
      to += moved.place[i] / static_cast<double>(places.size());
    }
    Mat3 covariance = Mat3::Zero();
    for (const int i : places)
      covariance += (carried.place[i] - from) * (moved.place[i] - to).transpose();
    const Mat3 rotation = covariance.norm() > 0 ? nearest_rotation(covariance) : Mat3::Identity();
    Vec3 out = Vec3::Zero();
    for (const int i : places) {
      moved.place[i] = to + rotation * (carried.place[i] - from);
      moved.turned[i] = rotation;
      if (!skin)
        continue;
      if (const Vec3 outwards = way_out(moved.place[i], *skin); outwards.norm() > out.norm())
        out = outwards;
    }
    for (const int i : places)
      moved.place[i] += out;
  }
}

} // namespace

Carried carry_on(std::vector<Vec3> place, std::vector<int> particle, std::vector<int> rigid,
                 const std::vector<Vec3>& cloth, const std::vector<Triangle>& triangles) {
  Carried carried;
  carried.place = std::move(place);
  carried.particle = std::move(particle);
  carried.rigid = std::move(rigid);
  const std::size_t n = carried.place.size();
  carried.triangle.assign(n, -1);
  carried.barycentric.assign(n, Vec3::Zero());
  const collision::TriangleTree tree(cloth, triangles);
  parallel_for(n, 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (carried.particle[i] >= 0)
        continue;
      const collision::ClosestPoint c =
          tree.closest_point(carried.place[i], std::numeric_limits<double>::infinity());
      carried.triangle[i] = c.triangle;
      carried.barycentric[i] = c.barycentric;
    }
  });
  return carried;
}

Moved carry_along(const Carried& carried, const std::vector<Vec3>& before,
                  const std::vector<Vec3>& after, const std::vector<Triangle>& triangles,
                  const collision::BodyCollider* skin) {
  const std::vector<Mat3> rotation = rotations_of(before, after, triangles);
  const std::size_t n = carried.place.size();
  Moved moved;
  moved.place.resize(n);
  moved.turned.assign(n, Mat3::Identity());
  parallel_for(n, 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (const int p = carried.particle[i]; p >= 0) {
        moved.place[i] = after[p];
        moved.turned[i] = rotation[p];
        continue;
      }
      const Triangle& t = triangles[carried.triangle[i]];
      Vec3 x = Vec3::Zero();
      Mat3 covariance = Mat3::Zero();
      for (int k = 0; k < 3; ++k) {
        const double b = carried.barycentric[i][k];
        x += b * (after[t[k]] + rotation[t[k]] * (carried.place[i] - before[t[k]]));
        covariance += b * rotation[t[k]].transpose();
      }
      moved.turned[i] = nearest_rotation(covariance);
      if (skin && carried.rigid[i] < 0)
        x += way_out(x, *skin);
      moved.place[i] = x;
    }
  });
  move_rigidly(carried, skin, moved);
  return moved;
}

} // namespace sloper::garment

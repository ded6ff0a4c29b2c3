#pragma once
/// What goes along with simulated cloth: the other side of a shell, patches, buttons.
#include <sloper/collision/body_collider.hpp>
#include <sloper/geometry/types.hpp>

#include <vector>

namespace sloper::garment {

/// Places of a mesh, each a particle of the cloth, or at a point of it with a distance.
struct Carried {
  std::vector<Vec3> place;       ///< #N by 3, m: where they are on the first body
  std::vector<int> particle;     ///< #N: the particle that is the place, or -1
  std::vector<int> triangle;     ///< #N: else the cloth's triangle beneath
  std::vector<Vec3> barycentric; ///< #N: in it
  std::vector<int> rigid;        ///< #N: the rigid part that the place belongs to, from 0, or -1
};

/// @param place, particle, rigid  as Carried   @param cloth, triangles  #P by 3, m, and the cloth's
/// triangles; not empty
Carried carry_on(std::vector<Vec3> place, std::vector<int> particle, std::vector<int> rigid,
                 const std::vector<Vec3>& cloth, const std::vector<Triangle>& triangles);

/// Places and how the surface turned there.
struct Moved {
  std::vector<Vec3> place;  ///< #N by 3, m
  std::vector<Mat3> turned; ///< #N
};

/// Where the places are once the cloth has moved: a particle's with it; another at
/// sum_k b_k (x'_k + R_k (p - x_k)) over the corners of its triangle, R_k the rotation nearest to
/// how the triangles around particle k moved. A rigid part moves as the best rigid motion of its
/// places (Kabsch 1976). Carried places that come to lie in the body, or nearer than LEAST_GAP_M,
/// are moved out along its normal; rigid parts as a whole.
/// @param skin  of the body that it is on now, or nullptr
Moved carry_along(const Carried& carried, const std::vector<Vec3>& before,
                  const std::vector<Vec3>& after, const std::vector<Triangle>& triangles,
                  const collision::BodyCollider* skin);

/// Distance from the skin that carried places keep, m.
inline constexpr double LEAST_GAP_M = 0.0005;

} // namespace sloper::garment

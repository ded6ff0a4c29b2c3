#pragma once
/// A force on a weighted point of up to four particles, s = sum_k w_k x_k, with its stiffness:
/// contacts, sewing springs, pins.
///
/// Force on particle k is w_k F; the stiffness block (k, l) is w_k w_l [kt I + (kn - kt) n n^T].
/// Elements come and go from step to step, so they are applied without being stored in the block
/// matrix, whose pattern stays fixed.
#include <sloper/geometry/types.hpp>
#include <vector>

namespace sloper::cloth {

/// A force on a weighted point s = sum_k w_k x_k.
struct ContactElement {
  int n = 0;                      ///< particles in use, 1..4
  std::array<int, 4> particle{};  ///< the first n are used
  std::array<double, 4> weight{}; ///< w_k, of any sign
  Vec3 force = Vec3::Zero();      ///< F, N
  Vec3 normal = Vec3::UnitY();    ///< unit
  double normal_stiffness = 0;    ///< kn >= 0, N/m
  double tangent_stiffness = 0;   ///< kt >= 0, N/m
  /// Stiffness times s, N for x in m. The product of the matrix with x is w_k times it on
  /// particle k.
  Vec3 pull(const std::vector<Vec3>& x) const {
    Vec3 s = Vec3::Zero();
    for (int k = 0; k < n; ++k)
      s += weight[k] * x[particle[k]];
    return tangent_stiffness * s + (normal_stiffness - tangent_stiffness) * normal.dot(s) * normal;
  }
  /// 3x3 stiffness of the weighted point, N/m.
  Mat3 stiffness() const {
    return tangent_stiffness * Mat3::Identity() +
           (normal_stiffness - tangent_stiffness) * normal * normal.transpose();
  }
};

/// 1 for edges that cross at an angle, falling to 0 for parallel ones, whose closest points jump
/// from end to end: without it the force of an edge pair would not be continuous (the mollifier of
/// Li et al. 2020). u, v: directions of any length.
double edge_edge_mollifier(const Vec3& u, const Vec3& v);

/// Adds w_k F of all elements.
/// @param force  #P by 3, N
void add_forces(const std::vector<ContactElement>& elements, std::vector<Vec3>& force);

/// Which elements each particle is in, so that threads share the particles.
struct ContactIndex {
  /// One particle of one element.
  struct Entry {
    int element, k; ///< the particle is its k-th
  };
  std::vector<int> start;   ///< #P + 1
  std::vector<Entry> entry; ///< by particle: those from start[i] to start[i + 1] - 1
  /// Indexes the elements; O(elements + n_particles).
  void build(const std::vector<ContactElement>& elements, std::size_t n_particles);
};

} // namespace sloper::cloth

#pragma once
/// What is wrong with a drape, counted exactly: the figures of report.json's `quality`.
#include <sloper/collision/body_collider.hpp>
#include <sloper/garment/garment.hpp>

namespace sloper::garment {

/// The crossings of one state, by triangle and particle.
struct Audit {
  std::vector<int> through;             ///< garment triangles that cross the skin
  std::vector<int> inside;              ///< particles inside the body
  double deepest_m = 0;                 ///< of those
  std::vector<std::array<int, 2>> self; ///< pairs of triangles without a common particle that cross
  double strain_warp[3] = {}, strain_weft[3] = {},
         strain_bias[3] =
             {}; ///< p50, p99, max along the threads and the diagonals (cloth_strain.hpp)
  double strain_p99 = 0, strain_max = 0; ///< of the larger in size of warp and weft
  bool clean() const { return through.empty() && inside.empty() && self.empty(); }
};

/// @param body nullptr for none
Audit audit(const Garment& garment, const collision::BodyCollider* body);

/// The particles at these positions that are inside the body, ascending. On all threads.
std::vector<int> inside_body(const std::vector<Vec3>& positions,
                             const collision::BodyCollider& body);

} // namespace sloper::garment

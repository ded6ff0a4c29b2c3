#include <garment/garment.hpp>

namespace sloper::garment {

std::vector<Triangle> Garment::particle_triangles() const {
  if (particle_of.empty()) return panels.triangles; // unsewn: every vertex is its own particle
  std::vector<Triangle> triangles;
  triangles.reserve(panels.triangles.size());
  for (const Triangle& t : panels.triangles) triangles.push_back({particle_of[t[0]], particle_of[t[1]], particle_of[t[2]]});
  return triangles;
}

} // namespace sloper::garment

#include "targets.hpp"

#include <sloper/collision/body_collider.hpp>
#include <sloper/io/files.hpp>

#include <cmath>
#include <cstdlib>

namespace sloper::fuzz {

namespace {

constexpr std::size_t NUMBERS =
    13 * sizeof(std::uint64_t); ///< of a prepared skin whose lists are empty

/// An octahedron with another inside it.
TriangleMesh two_shells() {
  TriangleMesh mesh;
  for (const double size : {1.0, 0.5})
    for (int axis = 0; axis < 3; ++axis)
      for (const double sign : {1.0, -1.0})
        mesh.positions.push_back(sign * size * Vec3::Unit(axis));
  for (const int first : {0, 6})
    for (const int x : {0, 1})
      for (const int y : {2, 3})
        for (const int z : {4, 5})
          mesh.triangles.push_back(
              {first + x, first + ((x + y + z) % 2 ? z : y), first + ((x + y + z) % 2 ? y : z)});
  return mesh;
}

} // namespace

void read_prepared_skin_bytes(std::string_view bytes) {
  static const TriangleMesh mesh = two_shells();
  const std::string key(64, '0'), empty = collision::to_bytes({}, key);
  std::string sealed = empty.substr(0, empty.size() - NUMBERS - key.size()) + std::string(bytes);
  sealed += io::sha256(sealed); // else the sum alone would refuse all that a fuzzer thinks of
  for (const std::string_view file : {std::string_view(sealed), bytes}) {
    const auto known =
        collision::prepared_from_bytes(file, key, mesh.positions.size(), mesh.triangles.size());
    if (!known)
      continue;
    if (collision::to_bytes(*known, key) != file)
      std::abort();
    const collision::BodyCollider collider(mesh, *known);
    if (!collider.prepared().fits(mesh.positions.size(), mesh.triangles.size()))
      std::abort();
    for (const Vec3& p : {Vec3(0.1, 0.2, 0.3), Vec3(2, 0.1, 0)})
      if (!std::isfinite(collider.signed_distance(p, 1e9).distance) ||
          !std::isfinite(collider.winding_number(p)))
        std::abort();
  }
}

} // namespace sloper::fuzz

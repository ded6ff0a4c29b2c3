#pragma once
/// Curved surfaces laid flat, triangle by triangle.
#include <sloper/collision/topology.hpp>
#include <sloper/geometry/types.hpp>

#include <vector>

namespace sloper::garment {

inline constexpr double UNROLLED_STRETCH =
    0.03; ///< share: edges of a piece keep their lengths within it
inline constexpr double LEAST_FLAT_AREA =
    2e-12; ///< m2 of a laid out triangle; the solver refuses 1e-12

/// A surface in space to be laid flat.
struct CurvedSurface {
  std::vector<Vec3> position;       ///< #P by 3, m
  std::vector<Triangle> triangles;  ///< #F, facing outward
  std::vector<int> region;          ///< #F: panels do not go beyond a region
  std::vector<Vec3> warp_of_region; ///< by region: the direction in space of the warp
};

/// Of a triangle, m2; negative where it is turned over.
double flat_area_of(const Vec2& a, const Vec2& b, const Vec2& c);

/// One connected piece laid flat. A particle where the piece is cut lies in several places.
struct FlatPiece {
  std::vector<int> triangles;    ///< of the surface
  std::vector<Triangle> corners; ///< by triangle, into the following
  std::vector<int> particle;
  std::vector<Vec2> at;
};

/// Grows one piece over triangles of one region, nearest to the first one first, as long as edges
/// keep their lengths within UNROLLED_STRETCH or the piece is cut there.
/// @param seed  the triangle to begin with
/// @param taken  #F: triangles that are in a piece; in and out
FlatPiece unroll_piece(const CurvedSurface& surface, const collision::Topology& topology, int seed,
                       std::vector<char>& taken);

} // namespace sloper::garment

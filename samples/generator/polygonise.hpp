#pragma once
/// From an implicit surface to a closed, even triangle mesh.
#include <functional>
#include <sloper/geometry/triangle_mesh.hpp>
namespace sloper::samples {

using Field = std::function<double(const Vec3&)>;

/// The surface f = 0 inside `box`, as one closed two-manifold: dual vertices of a cubic grid
/// (surface nets, Gibson 1998; one vertex for every patch of surface in a cell, as in Nielson's
/// dual marching cubes, 2004), relaxed along the surface and brought back onto it. Where the grid
/// still gives a non-manifold edge, it is moved by a fraction of a cell and tried again, then made
/// finer by 3 % at a time, to 24 %.
/// @param f     negative inside, Lipschitz constant near 1 close to the surface
/// @param box   the surface lies well inside it, m
/// @param cell  grid spacing, m; about the edge length of the result
/// @throws Error FAILED when no grid gives a manifold
TriangleMesh polygonise(const Field& f, const Box3& box, double cell);

/// True when every edge has two triangles that run opposite ways and the triangles at every vertex
/// form one fan.
bool is_closed_manifold(const TriangleMesh& mesh);

/// Unit gradient of f by central differences.
Vec3 field_normal(const Field& f, const Vec3& p);

/// The point of f = 0 reached from p by Newton steps along the gradient.
Vec3 onto_surface(const Field& f, Vec3 p, int steps = 3);

} // namespace sloper::samples

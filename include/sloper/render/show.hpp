#pragma once
/// What is drawn over a picture: landmarks with names, bones, part frames, slices at levels, seams,
/// names of panels.
#include <sloper/render/draw.hpp>
#include <sloper/render/scene.hpp>
namespace sloper::render {

struct Show {
  bool landmarks = false, bones = false, frames = false, slices = false, seams = false,
       names = false;
  bool any() const { return landmarks || bones || frames || slices || seams || names; }
};
/// From "landmarks,bones". @throws Error USAGE for an unknown word
Show parse_show(const std::string& list);

/// The share of a picture's width, at most a fifth, that the names on each side may take.
double label_share(const Scene& scene, const Show& show, int width, int height);

/// Draws over a picture of the scene. What lies behind a surface is drawn faint.
/// @param renderer drew `image` with `camera` and kept its depth   @param legend_width  pixels on
/// the right that names leave free   @throws Error USAGE when the scene has nothing of what is
/// asked for
void draw_show(io::Image& image, const Scene& scene, const Camera& camera, const Renderer& renderer,
               const Show& show, int legend_width = 0);

/// The colour of a seam, 0xRRGGBB: both its sides have it, in space and in the flat pattern.
int seam_color(int k);

/// Closed or open polylines in which a plane y = `height` cuts the triangles, as pairs of points,
/// m.
std::vector<std::array<Vec3, 2>> cut_level(const TriangleMesh& mesh, double height,
                                           const std::vector<char>& takes_part);

} // namespace sloper::render

#pragma once
/// Overlays of a scene: landmarks with names, bones, part frames, slices at levels,
/// seams, names of panels.
/// Test: tests/render/test_maps.cpp
#include <sloper/render/draw.hpp>
#include <sloper/render/scene.hpp>
namespace sloper::render {

/// Which overlays to draw.
struct Show {
  /// One flag for each overlay.
  bool landmarks = false, bones = false, frames = false, slices = false, seams = false,
       names = false,
       edges = false; ///< names of panel edges, in the flat pattern alone
  /// Whether there is any.
  bool any() const {
    return landmarks || bones || frames || slices || seams || names;
  } // edges: see draw_pattern()
};
/// From "landmarks,bones". @throws Error USAGE for an unknown word
Show parse_show(const std::string& list);

/// The share of a picture's width, at most a fifth, that the names on each side may take.
double label_share(const Scene& scene, const Show& show, int width, int height);

/// Draws over a picture of the scene; marks behind a surface are drawn faint.
/// @param renderer  drew `image` with `camera` and kept its depth
/// @param legend_width  pixels on the right that names leave free
/// @throws Error USAGE when the scene has nothing to show of what is asked for
void draw_show(io::Image& image, const Scene& scene, const Camera& camera, const Renderer& renderer,
               const Show& show, int legend_width = 0);

/// Colour of seam k, 0xRRGGBB: both its sides have it, in space and in the flat pattern.
int seam_color(int k);

/// Segments in which the plane y = `height` (m) cuts the triangles, as pairs of points,
/// m.
/// @param takes_part  #F, 0: left out; empty: all take part
std::vector<std::array<Vec3, 2>> cut_level(const TriangleMesh& mesh, double height,
                                           const std::vector<char>& takes_part);

} // namespace sloper::render

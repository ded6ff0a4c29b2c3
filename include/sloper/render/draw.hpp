#pragma once
/// Drawing a scene into a picture.
/// Test: tests/render/test_render.cpp
#include <memory>
#include <optional>
#include <sloper/io/png.hpp>
#include <sloper/render/camera.hpp>
#include <sloper/render/context.hpp>
namespace sloper::render {

/// Weave or print that is drawn on cloth with pattern coordinates; PRINT shows
/// DrawOptions::print.
enum class Fabric { PLAIN, WOVEN, TWILL, STRIPES, CHECKS, PRINT };

/// How a scene is drawn: everything but the camera.
struct DrawOptions {
  int width = 800, height = 1000; ///< pixels
  int supersample = 2;            ///< 1 to 4: each pixel is the mean of its square
  int occlusion_directions = 32;  ///< of the ambient light; 0 leaves everything unshadowed
  std::optional<int> background = 0xffffff; ///< 0xRRGGBB; none: transparent
  bool ground = true;            ///< a soft shadow on the floor, seen from above the horizon
  bool border_lines = true;      ///< seams and hems
  Fabric fabric = Fabric::WOVEN; ///< drawn on cloth
  io::Image print;               ///< repeats along warp and weft
  double print_size = 0.1;       ///< m, width and height of one repeat
  std::vector<Vec3> map_colors;  ///< eight steps, linear; empty: no map
  /// Map values at the ends of `map_colors`.
  double map_low = 0, map_high = 1;
  ContextKind context = ContextKind::OSMESA; ///< back end
};

/// Draws a scene from any number of cameras. Light is baked and buffers are filled once,
/// by the constructor.
class Renderer {
public:
  /// @param meshes  kept by reference
  /// @param options  copied
  /// @throws Error FAILED or USAGE as make_context(), INTERNAL where a shader fails,
  /// USAGE when the picture is larger than OpenGL can draw
  Renderer(const std::vector<DrawMesh>& meshes, const DrawOptions& options);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;
  /// One view, RGBA. Deterministic for a back end, whatever the number of threads.
  io::Image draw(const Camera& camera);
  /// Whether a point is visible in the last picture: nothing there is nearer than its
  /// depth less `slack`. True outside of the picture and without keep_depth().
  /// @param pixel  of Camera::pixel()
  /// @param slack  depth, 0..1
  bool is_visible(const Vec3& pixel, double slack) const;
  /// Whether depths are read back with each picture, for is_visible(); off at first.
  void keep_depth(bool yes);

private:
  struct Impl;
  std::unique_ptr<Impl> m_impl;
};
} // namespace sloper::render

#pragma once
/// Drawing a scene into a picture.
#include <memory>
#include <optional>
#include <sloper/io/png.hpp>
#include <sloper/render/camera.hpp>
#include <sloper/render/context.hpp>
namespace sloper::render {

/// What cloth looks like that has pattern coordinates; PRINT shows DrawOptions::print.
enum class Fabric { PLAIN, WOVEN, TWILL, STRIPES, CHECKS, PRINT };

struct DrawOptions {
  int width = 800, height = 1000;
  int supersample = 2;           ///< 1 to 4: each pixel is the mean of its square
  int occlusion_directions = 32; ///< of the ambient light; 0 leaves everything unshadowed
  std::optional<int> background = 0xffffff; ///< 0xRRGGBB; none: transparent
  bool ground = true;       ///< a soft shadow on the floor, seen from above the horizon
  bool border_lines = true; ///< seams and hems
  Fabric fabric = Fabric::WOVEN;
  io::Image print;              ///< repeats along warp and weft
  double print_size = 0.1;      ///< m, width and height of one repeat
  std::vector<Vec3> map_colors; ///< eight steps, linear; empty: no map
  double map_low = 0, map_high = 1;
  ContextKind context = ContextKind::OSMESA;
};

/// Light is baked and everything handed to OpenGL once; any number of views are then drawn from it.
class Renderer {
public:
  /// @param meshes kept by reference @throws Error INTERNAL without OpenGL, USAGE when the picture
  /// is larger than it can draw
  Renderer(const std::vector<DrawMesh>& meshes, const DrawOptions& options);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;
  io::Image draw(const Camera& camera);
  /// True where nothing of the picture drawn last is nearer than a point at this pixel and depth,
  /// less `slack` (depth).
  bool is_visible(const Vec3& pixel, double slack) const;
  /// Reads depths back with each picture, for is_visible().
  void keep_depth(bool yes);

private:
  struct Impl;
  std::unique_ptr<Impl> m_impl;
};
} // namespace sloper::render

#pragma once
/// Drawing a scene into a picture.
#include <io/png.hpp>
#include <render/camera.hpp>
namespace sloper::render {
enum class Background { WHITE, GREY, TRANSPARENT };
struct DrawOptions {
  int width = 800, height = 1000;
  int supersample = 2;           ///< each pixel is the mean of its square
  int occlusion_directions = 48; ///< of the ambient light; 0 leaves it unshadowed
  Background background = Background::WHITE;
};
/// Per-vertex ambient occlusion and shading baked once; any number of views drawn from it.
class Renderer {
public:
  Renderer(const std::vector<DrawMesh>& meshes, const DrawOptions& options);
  io::Image draw(const Camera& camera) const;

private:
  const std::vector<DrawMesh>& m_meshes;
  DrawOptions m_options;
  std::vector<std::vector<float>> m_light; ///< by mesh: share of the sky that each vertex sees, 0..1
};
} // namespace sloper::render

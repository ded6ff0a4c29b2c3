#pragma once
/// An off-screen OpenGL context. OSMesa today; another back end only has to provide this class.
#include <cstdint>
#include <memory>
#include <vector>
namespace sloper::render {
class Context {
public:
  /// @param width, height pixels, 1..16384 @throws Error INTERNAL when there is no OpenGL
  Context(int width, int height);
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  int width() const { return m_width; }
  int height() const { return m_height; }
  /// What was drawn, RGBA rows from bottom to top; valid after glFinish.
  const std::vector<std::uint8_t>& pixels() const { return m_pixels; }
  /// Address of an OpenGL function. @throws Error INTERNAL
  static void* function(const char* name);

private:
  int m_width, m_height;
  std::vector<std::uint8_t> m_pixels;
  void* m_context;
};
} // namespace sloper::render

#include <base/error.hpp>
#include <render/context.hpp>

#include <GL/osmesa.h>

#include <string>

namespace sloper::render {

Context::Context(int width, int height) : m_width(width), m_height(height), m_pixels(4 * static_cast<std::size_t>(width) * height) {
  const int attributes[] = {OSMESA_FORMAT, OSMESA_RGBA, OSMESA_DEPTH_BITS, 24, OSMESA_PROFILE, OSMESA_COMPAT_PROFILE, 0};
  OSMesaContext context = OSMesaCreateContextAttribs(attributes, nullptr);
  if (!context || !OSMesaMakeCurrent(context, m_pixels.data(), GL_UNSIGNED_BYTE, width, height))
    throw Error(ErrorKind::INTERNAL, "", "", "OSMesa gives no OpenGL context of " + std::to_string(width) + " x " + std::to_string(height) + " pixels");
  OSMesaPixelStore(OSMESA_Y_UP, 1);
  m_context = context;
}

Context::~Context() { OSMesaDestroyContext(static_cast<OSMesaContext>(m_context)); }

void* Context::function(const char* name) {
  auto address = reinterpret_cast<void*>(OSMesaGetProcAddress(name));
  if (!address) throw Error(ErrorKind::INTERNAL, "", "", std::string("OpenGL lacks ") + name);
  return address;
}

} // namespace sloper::render

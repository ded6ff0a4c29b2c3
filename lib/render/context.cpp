#include <sloper/base/error.hpp>
#include <sloper/base/parallel.hpp>
#include <sloper/render/context.hpp>

#ifdef SLOPER_HAVE_OSMESA
#include <GL/osmesa.h>
#endif
#ifdef SLOPER_HAVE_EGL
#include <EGL/egl.h>
#include <EGL/eglext.h>
#endif

#include <cstdlib>

namespace sloper::render {

namespace {

/// The machine lacks what draws: no picture, and no mistake of ours. The next step names the other
/// back end only where there is one.
[[noreturn]] void no_context(ContextKind kind, const std::string& what) {
  const bool egl = kind == ContextKind::EGL;
  for (const ContextKind other : built_contexts())
    if (other != kind)
      throw Error(ErrorKind::FAILED, "render.no-context"_id, "",
                  egl ? "--context egl" : "--context osmesa", what,
                  egl ? "try --context osmesa" : "try --context egl");
  throw Error(ErrorKind::FAILED, "render.no-context"_id, "",
              egl ? "--context egl" : "--context osmesa", what,
              "install Mesa's drivers (Debian: libgl1-mesa-dri)");
}

#ifdef SLOPER_HAVE_OSMESA
class OsmesaContext : public Context {
public:
  OsmesaContext() : m_pixels(4 * 16 * 16) {
    const int attributes[] = {OSMESA_FORMAT,
                              OSMESA_RGBA,
                              OSMESA_PROFILE,
                              OSMESA_CORE_PROFILE,
                              OSMESA_CONTEXT_MAJOR_VERSION,
                              3,
                              OSMESA_CONTEXT_MINOR_VERSION,
                              3,
                              0};
    m_context = OSMesaCreateContextAttribs(attributes, nullptr);
    if (!m_context)
      no_context(ContextKind::OSMESA, "OSMesa gives no OpenGL 3.3 context");
    make_current();
  }
  ~OsmesaContext() override { OSMesaDestroyContext(m_context); }
  void* function(const char* name) const override {
    return reinterpret_cast<void*>(OSMesaGetProcAddress(name));
  }
  void make_current() override {
    if (!OSMesaMakeCurrent(m_context, m_pixels.data(), GL_UNSIGNED_BYTE, 16, 16))
      no_context(ContextKind::OSMESA, "OSMesa cannot make its context current");
  }

private:
  OSMesaContext m_context = nullptr;
  std::vector<unsigned char> m_pixels; // the window that OSMesa asks for; nothing is drawn into it
};
#endif

#ifdef SLOPER_HAVE_EGL
class EglContext : public Context {
public:
  EglContext() {
    const auto get_display = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
        eglGetProcAddress("eglGetPlatformDisplayEXT"));
    if (get_display)
      m_display = get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (m_display == EGL_NO_DISPLAY || !eglInitialize(m_display, nullptr, nullptr))
      no_context(ContextKind::EGL, "EGL gives no surfaceless display");
    const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, EGL_PBUFFER_BIT,
                             EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION,
                              3,
                              EGL_CONTEXT_MINOR_VERSION,
                              3,
                              EGL_CONTEXT_OPENGL_PROFILE_MASK,
                              EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                              EGL_NONE};
    if (eglBindAPI(EGL_OPENGL_API) && eglChooseConfig(m_display, wanted, &config, 1, &count) &&
        count == 1)
      m_context = eglCreateContext(m_display, config, EGL_NO_CONTEXT, version);
    if (m_context == EGL_NO_CONTEXT) {
      eglTerminate(m_display);
      no_context(ContextKind::EGL, "EGL gives no OpenGL 3.3 context");
    }
    make_current();
  }
  ~EglContext() override {
    eglMakeCurrent(m_display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(m_display, m_context);
    eglTerminate(m_display);
  }
  void* function(const char* name) const override {
    return reinterpret_cast<void*>(eglGetProcAddress(name));
  }
  void make_current() override {
    if (!eglMakeCurrent(m_display, EGL_NO_SURFACE, EGL_NO_SURFACE, m_context))
      no_context(ContextKind::EGL, "EGL cannot make its context current");
  }

private:
  EGLDisplay m_display = EGL_NO_DISPLAY;
  EGLContext m_context = EGL_NO_CONTEXT;
};
#endif

} // namespace

std::vector<ContextKind> built_contexts() {
  std::vector<ContextKind> kinds;
#ifdef SLOPER_HAVE_OSMESA
  kinds.push_back(ContextKind::OSMESA);
#endif
#ifdef SLOPER_HAVE_EGL
  kinds.push_back(ContextKind::EGL);
#endif
  return kinds;
}

std::unique_ptr<Context> make_context(ContextKind kind) {
  // Mesa's processor back end would take every core of the machine; it reads this when a context is
  // made.
  setenv("LP_NUM_THREADS", thread_count() > 1 ? std::to_string(thread_count()).c_str() : "0", 0);
#ifdef SLOPER_HAVE_OSMESA
  if (kind == ContextKind::OSMESA)
    return std::make_unique<OsmesaContext>();
#endif
#ifdef SLOPER_HAVE_EGL
  if (kind == ContextKind::EGL)
    return std::make_unique<EglContext>();
#endif
  throw Error(ErrorKind::USAGE, "render.context-not-built"_id, "",
              kind == ContextKind::EGL ? "--context egl" : "--context osmesa",
              "was not built into this render-png",
              "leave the option out, or build with its library");
}

} // namespace sloper::render

#pragma once
/// An off-screen OpenGL 3.3 core context. Everything else in this module reaches OpenGL through it
/// alone, so that another back end is one more class behind make_context().
#include <memory>
#include <string>
#include <vector>
namespace sloper::render {

/// OSMESA draws on the processor alone. EGL asks for a surfaceless display: a graphics card where
/// there is one, else the processor.
enum class ContextKind { OSMESA, EGL };

/// An OpenGL context of one thread.
class Context {
public:
  virtual ~Context() = default;
  /// Address of an OpenGL function; null when there is none.
  virtual void* function(const char* name) const = 0;
  /// Makes it the calling thread's context.
  /// @throws Error FAILED
  virtual void make_current() = 0;
};

/// A current context. Drawing goes to framebuffer objects. Threads of a processor back end:
/// thread_count(); the picture is the same for any number of them.
/// @throws Error USAGE when the kind was not built in, FAILED where this machine has no OpenGL 3.3
/// for it
std::unique_ptr<Context> make_context(ContextKind kind);

/// The kinds that were built in, OSMESA first.
std::vector<ContextKind> built_contexts();

} // namespace sloper::render

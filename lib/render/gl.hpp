#pragma once
/// The OpenGL functions that drawing uses, looked up in a context; and a program made of two
/// shaders.
#include <sloper/render/context.hpp>

#include <GL/glcorearb.h>
namespace sloper::render {

/// Functions by their OpenGL names without the prefix.
struct Gl {
  /// @throws Error INTERNAL naming the function that is missing
  explicit Gl(const Context& context);
  PFNGLATTACHSHADERPROC AttachShader;
  PFNGLBINDBUFFERPROC BindBuffer;
  PFNGLBINDFRAMEBUFFERPROC BindFramebuffer;
  PFNGLBINDRENDERBUFFERPROC BindRenderbuffer;
  PFNGLBINDTEXTUREPROC BindTexture;
  PFNGLBINDVERTEXARRAYPROC BindVertexArray;
  PFNGLBLENDFUNCSEPARATEPROC BlendFuncSeparate;
  PFNGLBUFFERDATAPROC BufferData;
  PFNGLBUFFERSUBDATAPROC BufferSubData;
  PFNGLCHECKFRAMEBUFFERSTATUSPROC CheckFramebufferStatus;
  PFNGLCLEARPROC Clear;
  PFNGLCLEARCOLORPROC ClearColor;
  PFNGLCOMPILESHADERPROC CompileShader;
  PFNGLCREATEPROGRAMPROC CreateProgram;
  PFNGLCREATESHADERPROC CreateShader;
  PFNGLDEPTHFUNCPROC DepthFunc;
  PFNGLDEPTHMASKPROC DepthMask;
  PFNGLDISABLEPROC Disable;
  PFNGLDRAWARRAYSPROC DrawArrays;
  PFNGLDRAWELEMENTSPROC DrawElements;
  PFNGLENABLEPROC Enable;
  PFNGLENABLEVERTEXATTRIBARRAYPROC EnableVertexAttribArray;
  PFNGLFINISHPROC Finish;
  PFNGLFRAMEBUFFERRENDERBUFFERPROC FramebufferRenderbuffer;
  PFNGLGENBUFFERSPROC GenBuffers;
  PFNGLGENERATEMIPMAPPROC GenerateMipmap;
  PFNGLGENFRAMEBUFFERSPROC GenFramebuffers;
  PFNGLGENRENDERBUFFERSPROC GenRenderbuffers;
  PFNGLGENTEXTURESPROC GenTextures;
  PFNGLGENVERTEXARRAYSPROC GenVertexArrays;
  PFNGLGETINTEGERVPROC GetIntegerv;
  PFNGLGETSHADERINFOLOGPROC GetShaderInfoLog;
  PFNGLGETSHADERIVPROC GetShaderiv;
  PFNGLGETUNIFORMLOCATIONPROC GetUniformLocation;
  PFNGLLINKPROGRAMPROC LinkProgram;
  PFNGLPOLYGONOFFSETPROC PolygonOffset;
  PFNGLREADPIXELSPROC ReadPixels;
  PFNGLRENDERBUFFERSTORAGEPROC RenderbufferStorage;
  PFNGLSHADERSOURCEPROC ShaderSource;
  PFNGLSTENCILFUNCPROC StencilFunc;
  PFNGLSTENCILOPPROC StencilOp;
  PFNGLTEXIMAGE2DPROC TexImage2D;
  PFNGLTEXPARAMETERIPROC TexParameteri;
  PFNGLUNIFORM1FPROC Uniform1f;
  PFNGLUNIFORM1IPROC Uniform1i;
  PFNGLUNIFORM2FPROC Uniform2f;
  PFNGLUNIFORM3FPROC Uniform3f;
  PFNGLUNIFORM3FVPROC Uniform3fv;
  PFNGLUNIFORMMATRIX3FVPROC UniformMatrix3fv;
  PFNGLUNIFORMMATRIX4FVPROC UniformMatrix4fv;
  PFNGLUSEPROGRAMPROC UseProgram;
  PFNGLVERTEXATTRIBPOINTERPROC VertexAttribPointer;
  PFNGLVIEWPORTPROC Viewport;

  /// @throws Error INTERNAL with the compiler's complaint
  GLuint program(const char* vertex_shader, const char* fragment_shader) const;
};

/// GLSL 330. Attributes of the surface: 0 position, 1 normal, 2 colour and light, 3 warp-aligned
/// uv, seam and hem distance, 4 map value, key light.
extern const char* const SURFACE_VERTEX_SHADER;
extern const char* const SURFACE_FRAGMENT_SHADER; ///< without its version and constants: see there
/// Attributes of lines: 0 position, 1 the other end, 2 colour and side.
extern const char* const LINE_VERTEX_SHADER;
extern const char* const LINE_FRAGMENT_SHADER;

} // namespace sloper::render

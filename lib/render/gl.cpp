#include <render/gl.hpp>
#include <sloper/base/error.hpp>

namespace sloper::render {

Gl::Gl(const Context& context) {
  auto find = [&](auto& pointer, const char* name) {
    void* address = context.function(name);
    if (!address)
      throw Error(ErrorKind::INTERNAL, "render.opengl-lacks"_id, "", "",
                  std::string("OpenGL lacks ") + name);
    pointer = reinterpret_cast<std::remove_reference_t<decltype(pointer)>>(address);
  };
  find(AttachShader, "glAttachShader");
  find(BindBuffer, "glBindBuffer");
  find(BindFramebuffer, "glBindFramebuffer");
  find(BindRenderbuffer, "glBindRenderbuffer");
  find(BindTexture, "glBindTexture");
  find(BindVertexArray, "glBindVertexArray");
  find(BlendFuncSeparate, "glBlendFuncSeparate");
  find(BufferData, "glBufferData");
  find(BufferSubData, "glBufferSubData");
  find(CheckFramebufferStatus, "glCheckFramebufferStatus");
  find(Clear, "glClear");
  find(ClearColor, "glClearColor");
  find(CompileShader, "glCompileShader");
  find(CreateProgram, "glCreateProgram");
  find(CreateShader, "glCreateShader");
  find(DepthFunc, "glDepthFunc");
  find(DepthMask, "glDepthMask");
  find(Disable, "glDisable");
  find(DrawArrays, "glDrawArrays");
  find(DrawElements, "glDrawElements");
  find(Enable, "glEnable");
  find(EnableVertexAttribArray, "glEnableVertexAttribArray");
  find(Finish, "glFinish");
  find(FramebufferRenderbuffer, "glFramebufferRenderbuffer");
  find(GenBuffers, "glGenBuffers");
  find(GenerateMipmap, "glGenerateMipmap");
  find(GenFramebuffers, "glGenFramebuffers");
  find(GenRenderbuffers, "glGenRenderbuffers");
  find(GenTextures, "glGenTextures");
  find(GenVertexArrays, "glGenVertexArrays");
  find(GetIntegerv, "glGetIntegerv");
  find(GetShaderInfoLog, "glGetShaderInfoLog");
  find(GetShaderiv, "glGetShaderiv");
  find(GetUniformLocation, "glGetUniformLocation");
  find(LinkProgram, "glLinkProgram");
  find(PolygonOffset, "glPolygonOffset");
  find(ReadPixels, "glReadPixels");
  find(RenderbufferStorage, "glRenderbufferStorage");
  find(ShaderSource, "glShaderSource");
  find(StencilFunc, "glStencilFunc");
  find(StencilOp, "glStencilOp");
  find(TexImage2D, "glTexImage2D");
  find(TexParameteri, "glTexParameteri");
  find(Uniform1f, "glUniform1f");
  find(Uniform1i, "glUniform1i");
  find(Uniform2f, "glUniform2f");
  find(Uniform3f, "glUniform3f");
  find(Uniform3fv, "glUniform3fv");
  find(UniformMatrix3fv, "glUniformMatrix3fv");
  find(UniformMatrix4fv, "glUniformMatrix4fv");
  find(UseProgram, "glUseProgram");
  find(VertexAttribPointer, "glVertexAttribPointer");
  find(Viewport, "glViewport");
}

GLuint Gl::program(const char* vertex_shader, const char* fragment_shader) const {
  const GLuint result = CreateProgram();
  for (const auto& [kind, source] :
       {std::pair<GLenum, const char*>{GL_VERTEX_SHADER, vertex_shader},
        {GL_FRAGMENT_SHADER, fragment_shader}}) {
    const GLuint shader = CreateShader(kind);
    ShaderSource(shader, 1, &source, nullptr);
    CompileShader(shader);
    GLint ok = 0;
    GetShaderiv(shader, GL_COMPILE_STATUS, &ok);
    if (!ok) {
      char log[400] = "";
      GetShaderInfoLog(shader, sizeof log, nullptr, log);
      throw Error(ErrorKind::INTERNAL, "render.opengl-lacks"_id, "", "",
                  std::string("a shader does not compile: ") + log);
    }
    AttachShader(result, shader);
  }
  LinkProgram(result);
  return result;
}

} // namespace sloper::render

#include <base/error.hpp>
#include <base/units.hpp>
#include <render/context.hpp>
#include <render/draw.hpp>

#define GL_GLEXT_PROTOTYPES 0
#include <GL/gl.h>
#include <GL/glext.h>

#include <cmath>

namespace sloper::render {

namespace {

constexpr int OCCLUSION_SIZE = 640;      // pixels of one depth picture
constexpr double OCCLUSION_BIAS = 0.004; // m

/// OpenGL 2 functions, found at run time.
struct Functions {
  PFNGLCREATESHADERPROC create_shader = get<PFNGLCREATESHADERPROC>("glCreateShader");
  PFNGLSHADERSOURCEPROC shader_source = get<PFNGLSHADERSOURCEPROC>("glShaderSource");
  PFNGLCOMPILESHADERPROC compile_shader = get<PFNGLCOMPILESHADERPROC>("glCompileShader");
  PFNGLGETSHADERIVPROC get_shader = get<PFNGLGETSHADERIVPROC>("glGetShaderiv");
  PFNGLCREATEPROGRAMPROC create_program = get<PFNGLCREATEPROGRAMPROC>("glCreateProgram");
  PFNGLATTACHSHADERPROC attach_shader = get<PFNGLATTACHSHADERPROC>("glAttachShader");
  PFNGLLINKPROGRAMPROC link_program = get<PFNGLLINKPROGRAMPROC>("glLinkProgram");
  PFNGLUSEPROGRAMPROC use_program = get<PFNGLUSEPROGRAMPROC>("glUseProgram");
  template<class F> static F get(const char* name) { return reinterpret_cast<F>(Context::function(name)); }
};

const char* VERTEX_SHADER = R"(#version 120
varying vec3 normal, color; varying float light;
void main() {
  gl_Position = gl_ModelViewProjectionMatrix * gl_Vertex;
  normal = gl_NormalMatrix * gl_Normal; color = gl_Color.rgb; light = gl_Color.a;
})";

// Two-sided. Sky from above, warm key from the upper left, cool fill from the right, a rim that parts cloth from ground.
const char* FRAGMENT_SHADER = R"(#version 120
varying vec3 normal, color; varying float light;
void main() {
  vec3 n = normalize(normal);
  bool back = n.z < 0.0;
  if (back) n = -n;
  vec3 base = back ? color * 0.72 : color;
  float sky = 0.5 + 0.5 * n.y;
  vec3 key = vec3(1.0, 0.97, 0.92) * max(dot(n, normalize(vec3(-0.5, 0.55, 0.75))), 0.0);
  vec3 fill = vec3(0.80, 0.90, 1.0) * max(dot(n, normalize(vec3(0.8, 0.1, 0.6))), 0.0);
  float rim = pow(1.0 - n.z, 3.0);
  vec3 lit = base * (light * (0.42 + 0.25 * sky) + (0.25 + 0.75 * light) * (0.52 * key + 0.16 * fill)) + 0.05 * rim * light;
  vec3 srgb = mix(lit * 12.92, 1.055 * pow(max(lit, vec3(0.0)), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, lit));
  gl_FragColor = vec4(clamp(srgb, 0.0, 1.0), 1.0);
})";

void use_shaders() {
  const Functions gl;
  const GLuint program = gl.create_program();
  for (const auto& [kind, source] : {std::pair{GL_VERTEX_SHADER, VERTEX_SHADER}, std::pair{GL_FRAGMENT_SHADER, FRAGMENT_SHADER}}) {
    const GLuint shader = gl.create_shader(kind);
    gl.shader_source(shader, 1, &source, nullptr);
    gl.compile_shader(shader);
    GLint ok = 0;
    gl.get_shader(shader, GL_COMPILE_STATUS, &ok);
    if (!ok) throw Error(ErrorKind::INTERNAL, "", "", "a shader does not compile");
    gl.attach_shader(program, shader);
  }
  gl.link_program(program);
  gl.use_program(program);
}

void load_camera(const Camera& camera) {
  const Mat4 clip = camera.matrix();
  Mat4 turn = Mat4::Identity();
  turn.block<3, 3>(0, 0) = camera.turn;
  glMatrixMode(GL_PROJECTION); // normals are turned by the model view part alone
  glLoadMatrixd(Mat4(clip * turn.transpose()).data());
  glMatrixMode(GL_MODELVIEW);
  glLoadMatrixd(turn.data());
}

void draw_triangles(const DrawMesh& mesh) {
  glEnableClientState(GL_VERTEX_ARRAY);
  glVertexPointer(3, GL_DOUBLE, 0, mesh.positions.data());
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(mesh.triangles.size() * 3), GL_UNSIGNED_INT, mesh.triangles.data());
}

/// Directions spread evenly over the sphere, thinned towards the ground: light comes mostly from above.
Vec3 sky_direction(int k, int n) {
  const double y = 1 - 1.6 * (k + 0.5) / n, around = k * 2.399963229728653; // golden angle
  const double r = std::sqrt(std::max(0.0, 1 - y * y));
  return {r * std::cos(around), y, r * std::sin(around)};
}

} // namespace

Renderer::Renderer(const std::vector<DrawMesh>& meshes, const DrawOptions& options) : m_meshes(meshes), m_options(options) {
  for (const DrawMesh& mesh : meshes) m_light.emplace_back(mesh.positions.size(), options.occlusion_directions > 0 ? 0.f : 1.f);
  if (options.occlusion_directions <= 0) return;
  Context context(OCCLUSION_SIZE, OCCLUSION_SIZE);
  glEnable(GL_DEPTH_TEST);
  glViewport(0, 0, OCCLUSION_SIZE, OCCLUSION_SIZE);
  std::vector<float> depth(OCCLUSION_SIZE * OCCLUSION_SIZE);
  std::vector<std::vector<float>> weight;
  for (const DrawMesh& mesh : meshes) weight.emplace_back(mesh.positions.size(), 0.f);
  for (int k = 0; k < options.occlusion_directions; ++k) {
    const Vec3 from = sky_direction(k, options.occlusion_directions);
    const Camera camera = frame_scene(meshes, std::atan2(from.x(), from.z()), std::asin(std::clamp(from.y(), -1.0, 1.0)), 1);
    load_camera(camera);
    glClear(GL_DEPTH_BUFFER_BIT | GL_COLOR_BUFFER_BIT);
    for (const DrawMesh& mesh : meshes) draw_triangles(mesh);
    glReadPixels(0, 0, OCCLUSION_SIZE, OCCLUSION_SIZE, GL_DEPTH_COMPONENT, GL_FLOAT, depth.data());
    const Mat4 clip = camera.matrix();
    const double bias = 0.5 * OCCLUSION_BIAS / camera.half_depth;
    for (std::size_t m = 0; m < meshes.size(); ++m)
      for (std::size_t v = 0; v < meshes[m].positions.size(); ++v) {
        double facing = meshes[m].normals[v].dot(from);
        if (meshes[m].is_cloth) facing = std::abs(facing); // both sides are seen
        if (facing <= 0.05) continue;
        const Vec3 p = (clip * meshes[m].positions[v].homogeneous()).head<3>();
        const int x = std::clamp(static_cast<int>((0.5 * p.x() + 0.5) * OCCLUSION_SIZE), 0, OCCLUSION_SIZE - 1);
        const int y = std::clamp(static_cast<int>((0.5 * p.y() + 0.5) * OCCLUSION_SIZE), 0, OCCLUSION_SIZE - 1);
        weight[m][v] += static_cast<float>(facing);
        if (0.5 * p.z() + 0.5 <= depth[static_cast<std::size_t>(y) * OCCLUSION_SIZE + x] + bias / facing) m_light[m][v] += static_cast<float>(facing);
      }
  }
  for (std::size_t m = 0; m < meshes.size(); ++m)
    for (std::size_t v = 0; v < m_light[m].size(); ++v) m_light[m][v] = weight[m][v] > 0 ? 0.25f + 0.75f * m_light[m][v] / weight[m][v] : 0.6f;
}

io::Image Renderer::draw(const Camera& camera) const {
  const int s = m_options.supersample;
  Context context(m_options.width * s, m_options.height * s);
  glViewport(0, 0, context.width(), context.height());
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  const float ground = m_options.background == Background::GREY ? 0.86f : 1.f;
  glClearColor(ground, ground, ground, m_options.background == Background::TRANSPARENT ? 0.f : 1.f);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  use_shaders();
  load_camera(camera);
  for (std::size_t m = 0; m < m_meshes.size(); ++m) {
    const DrawMesh& mesh = m_meshes[m];
    std::vector<float> color;
    color.reserve(mesh.colors.size() * 4);
    for (std::size_t v = 0; v < mesh.colors.size(); ++v) {
      for (int k = 0; k < 3; ++k) color.push_back(static_cast<float>(mesh.colors[v][k]));
      color.push_back(m_light[m][v]);
    }
    glEnableClientState(GL_NORMAL_ARRAY);
    glEnableClientState(GL_COLOR_ARRAY);
    glNormalPointer(GL_DOUBLE, 0, mesh.normals.data());
    glColorPointer(4, GL_FLOAT, 0, color.data());
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(1, 1);
    draw_triangles(mesh);
    glDisable(GL_POLYGON_OFFSET_FILL);
    if (mesh.lines.empty()) continue;
    for (std::size_t i = 0; i < color.size(); ++i)
      if (i % 4 != 3) color[i] *= 0.35f;
    glLineWidth(1.4f * static_cast<float>(s));
    glDrawElements(GL_LINES, static_cast<GLsizei>(mesh.lines.size() * 2), GL_UNSIGNED_INT, mesh.lines.data());
  }
  glFinish();
  io::Image image;
  image.width = m_options.width;
  image.height = m_options.height;
  image.rgba.resize(4 * static_cast<std::size_t>(image.width) * image.height);
  const std::size_t row = 4 * static_cast<std::size_t>(context.width());
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      unsigned sum[4] = {};
      for (int dy = 0; dy < s; ++dy)
        for (int dx = 0; dx < s; ++dx) {
          const std::uint8_t* p =
              context.pixels().data() + row * static_cast<std::size_t>((image.height - 1 - y) * s + dy) + 4 * static_cast<std::size_t>(x * s + dx);
          for (int k = 0; k < 3; ++k) sum[k] += p[k] * (p[3] ? 1u : 0u); // uncovered samples carry no colour
          sum[3] += p[3] ? 1 : 0;
        }
      std::uint8_t* out = image.at(x, y);
      const unsigned n = static_cast<unsigned>(s * s);
      for (int k = 0; k < 3; ++k) out[k] = sum[3] ? static_cast<std::uint8_t>((sum[k] + sum[3] / 2) / sum[3]) : 255;
      out[3] = static_cast<std::uint8_t>((255 * sum[3] + n / 2) / n);
    }
  return image;
}

} // namespace sloper::render

#include <render/gl.hpp>
#include <render/occlusion.hpp>
#include <sloper/base/error.hpp>
#include <sloper/base/units.hpp>
#include <sloper/render/draw.hpp>
#include <sloper/render/maps.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <set>

namespace sloper::render {

struct SurfaceVertex {
  float position[3], normal[3], color[4], cloth[4],
      value[3]; // of the map, light of the key, whether the map has a value
};
struct LineVertex {
  float position[3], other[3], color[4];
};

namespace {

constexpr int GROUND_RINGS = 28, GROUND_SPOKES = 56;
constexpr double SMOOTHED_IN = 0.0006; // m, as far as smooth_cloth() moves cloth inwards
constexpr double LINE_LIFT =
    0.0002; // m that lines lie in front of their surface, and stay behind cloth in front of it
constexpr int ALL_BITS = 0xff; // of the stencil
enum Kind { BODY = 0, CLOTH = 1, FLAT = 2, GROUND = 3 };

void put(float* to, const Vec3& v) {
  for (int k = 0; k < 3; ++k)
    to[k] = static_cast<float>(v[k]);
}

/// A disc of floor below everything; its uv run over the unit disc.
DrawMesh make_ground(const std::vector<DrawMesh>& meshes) {
  Box3 box;
  for (const DrawMesh& mesh : meshes)
    for (const Vec3& p : mesh.positions)
      box.add(p);
  DrawMesh ground;
  const double reach = 0.35 * box.size().norm();
  const Vec3 center(box.center().x(), box.low.y() - 0.001, box.center().z());
  for (int r = 0; r <= GROUND_RINGS; ++r)
    for (int s = 0; s < GROUND_SPOKES; ++s) {
      const double a = 2 * units::PI * s / GROUND_SPOKES;
      const Vec2 uv = static_cast<double>(r) / GROUND_RINGS * Vec2(std::cos(a), std::sin(a));
      ground.uv.push_back(uv);
      ground.positions.push_back(center + reach * Vec3(uv.x(), 0, uv.y()));
      ground.normals.push_back(Vec3(0, 1, 0));
      ground.colors.push_back(Vec3::Zero());
      if (r == 0)
        continue;
      const int a0 = (r - 1) * GROUND_SPOKES + s,
                a1 = (r - 1) * GROUND_SPOKES + (s + 1) % GROUND_SPOKES, b0 = a0 + GROUND_SPOKES,
                b1 = a1 + GROUND_SPOKES;
      ground.triangles.push_back({a0, a1, b1});
      ground.triangles.push_back({a0, b1, b0});
    }
  return ground;
}

} // namespace

struct Renderer::Impl {
  const std::vector<DrawMesh>& meshes;
  DrawOptions options;
  std::unique_ptr<Context> context;
  Gl gl;
  std::array<GLuint, 4> surface_programs{}; ///< by kind
  GLuint line_program = 0, surface_array = 0, line_array = 0, surface_buffer = 0, line_buffer = 0,
         framebuffer = 0;
  DrawMesh ground;
  std::unique_ptr<Occlusion> occlusion;
  std::vector<SurfaceVertex> vertices; ///< of all meshes, then the ground
  struct Part {
    int kind, first_index, n_indices, first_vertex, first_line, n_lines;
    bool is_closed;
  };
  std::vector<Part> parts; ///< cloth first: it hides most of the body
  std::vector<Vec3> points, normals;
  double lit_azimuth = 1e9;
  bool wants_depth = false;
  std::vector<float> depth;

  Impl(const std::vector<DrawMesh>& m, const DrawOptions& o)
      : meshes(m), options(o), context(make_context(o.context)), gl(*context) {
    make_framebuffer();
    line_program = gl.program(LINE_VERTEX_SHADER, LINE_FRAGMENT_SHADER);
    if (options.ground)
      ground = make_ground(meshes);
    gather_vertices();
    load_print();
  }

  void make_framebuffer() {
    const int width = options.width * options.supersample,
              height = options.height * options.supersample;
    GLint largest = 0;
    gl.GetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &largest);
    if (width > largest || height > largest)
      throw Error(ErrorKind::USAGE, "render.too-large"_id, "", "--size",
                  "OpenGL draws at most " + std::to_string(largest / options.supersample) +
                      " pixels a side here");
    GLuint buffers[2];
    gl.GenFramebuffers(1, &framebuffer);
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    gl.GenRenderbuffers(2, buffers);
    const GLenum formats[] = {GL_RGBA8, GL_DEPTH24_STENCIL8},
                 slots[] = {GL_COLOR_ATTACHMENT0, GL_DEPTH_STENCIL_ATTACHMENT};
    for (int k = 0; k < 2; ++k) {
      gl.BindRenderbuffer(GL_RENDERBUFFER, buffers[k]);
      gl.RenderbufferStorage(GL_RENDERBUFFER, formats[k], width, height);
      gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, slots[k], GL_RENDERBUFFER, buffers[k]);
    }
    if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
      throw Error(ErrorKind::INTERNAL, "render.opengl-lacks"_id, "", "",
                  "OpenGL gives no picture of " + std::to_string(width) + " x " +
                      std::to_string(height) + " pixels",
                  "ask for a smaller --size");
  }

  /// Vertices without a value take the mean of their neighbours' and stay marked: half-way between
  /// them and the others the map ends, in colours that were there, not in those of a value far
  /// outside.
  void carry_values_over_the_border(const std::vector<Triangle>& triangles, int base) {
    std::vector<std::array<float, 2>> sum(
        vertices.size() - static_cast<std::size_t>(base)); // of values, their number
    for (const Triangle& t : triangles)
      for (int v : t)
        for (int w : t)
          if (const SurfaceVertex& from = vertices[base + w]; from.value[2] > 0) {
            sum[v][0] += from.value[0];
            sum[v][1] += 1;
          }
    for (std::size_t v = 0; v < sum.size(); ++v)
      if (SurfaceVertex& to = vertices[static_cast<std::size_t>(base) + v];
          to.value[2] == 0 && sum[v][1] > 0)
        to.value[0] = sum[v][0] / sum[v][1];
  }

  void append(const DrawMesh& mesh, int kind, std::vector<GLuint>& indices,
              std::vector<LineVertex>& lines, std::vector<GLuint>& line_indices) {
    const int base = std::ssize(vertices);
    const bool mapped = !options.map_colors.empty() && !mesh.values.empty();
    Part part{kind,
              static_cast<int>(indices.size()),
              static_cast<int>(mesh.triangles.size() * 3),
              base,
              static_cast<int>(line_indices.size()),
              0,
              mesh.is_closed};
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      SurfaceVertex out{};
      put(out.position, mesh.positions[v]);
      put(out.normal, mesh.normals[v]);
      put(out.color, mesh.colors[v]);
      out.color[3] = 1;
      out.cloth[2] = out.cloth[3] = static_cast<float>(BORDER_REACH);
      if (!mesh.uv.empty()) {
        out.cloth[0] = static_cast<float>(mesh.uv[v].x());
        out.cloth[1] = static_cast<float>(mesh.uv[v].y());
      }
      if (!mesh.seam.empty()) {
        out.cloth[2] = static_cast<float>(mesh.seam[v]);
        out.cloth[3] = static_cast<float>(mesh.hem[v]);
      }
      out.value[1] = 1;
      if (mapped && mesh.values[v] != NO_VALUE) {
        out.value[0] = static_cast<float>(std::clamp(
            (mesh.values[v] - options.map_low) / (options.map_high - options.map_low), 0.0, 1.0));
        out.value[2] = 1;
      }
      vertices.push_back(out);
      points.push_back(mesh.positions[v]);
      normals.push_back(mesh.normals[v]);
    }
    if (mapped)
      carry_values_over_the_border(mesh.triangles, base);
    for (const Triangle& t : mesh.triangles)
      for (int v : t)
        indices.push_back(static_cast<GLuint>(base + v));
    if (options.border_lines)
      for (const auto& [a, b] : mesh.lines) {
        const auto at = static_cast<GLuint>(lines.size());
        for (int end = 0; end < 2; ++end)
          for (float side : {-1.f, 1.f}) {
            LineVertex out{};
            put(out.position, mesh.positions[end ? b : a]);
            put(out.other, mesh.positions[end ? a : b]);
            put(out.color, mesh.is_flat || mapped
                               ? Vec3(0.12, 0.12, 0.13)
                               : Vec3(0.62 * mesh.colors[a].array().pow(1 / 2.2)));
            out.color[3] = side;
            lines.push_back(out);
          }
        for (GLuint k : {0u, 1u, 2u, 2u, 3u, 0u})
          line_indices.push_back(at + k);
      }
    part.n_lines = static_cast<int>(line_indices.size()) - part.first_line;
    parts.push_back(part);
  }

  void gather_vertices() {
    std::vector<GLuint> indices, line_indices;
    std::vector<LineVertex> lines;
    for (bool cloth : {true, false})
      for (const DrawMesh& mesh : meshes) {
        if (mesh.is_cloth != cloth)
          continue;
        const auto solid = cloth ? CLOTH : BODY;
        append(mesh, mesh.is_flat ? FLAT : solid, indices, lines, line_indices);
      }
    if (!ground.positions.empty())
      append(ground, GROUND, indices, lines, line_indices);
    if (options.occlusion_directions > 0) {
      occlusion = std::make_unique<Occlusion>(meshes);
      const std::vector<float> sky = occlusion->sky(points, normals, options.occlusion_directions);
      for (std::size_t v = 0; v < vertices.size(); ++v)
        vertices[v].color[3] = sky[v];
      if (!ground.positions.empty())
        soften_ground();
    }
    auto upload = [&](GLuint& array, GLuint& buffer, const auto& data,
                      const std::vector<GLuint>& elements, std::initializer_list<int> sizes) {
      GLuint element_buffer = 0;
      gl.GenVertexArrays(1, &array);
      gl.BindVertexArray(array);
      gl.GenBuffers(1, &buffer);
      gl.GenBuffers(1, &element_buffer);
      gl.BindBuffer(GL_ARRAY_BUFFER, buffer);
      gl.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(data.size() * sizeof data[0]),
                    data.data(), GL_STATIC_DRAW);
      gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, element_buffer);
      gl.BufferData(GL_ELEMENT_ARRAY_BUFFER,
                    static_cast<GLsizeiptr>(elements.size() * sizeof(GLuint)), elements.data(),
                    GL_STATIC_DRAW);
      GLuint slot = 0;
      std::size_t offset = 0;
      for (int size : sizes) {
        gl.EnableVertexAttribArray(slot);
        gl.VertexAttribPointer(slot++, size, GL_FLOAT, GL_FALSE, sizeof data[0],
                               reinterpret_cast<const void*>(offset));
        offset += static_cast<std::size_t>(size) * sizeof(float);
      }
    };
    if (!lines.empty())
      upload(line_array, line_buffer, lines, line_indices, {3, 3, 4});
    upload(surface_array, surface_buffer, vertices, indices, {3, 3, 4, 4, 3});
  }

  /// The few directions of the sky would show as rays on the floor.
  void soften_ground() {
    const std::size_t first = vertices.size() - ground.positions.size();
    std::vector<float> light(ground.positions.size());
    for (std::size_t v = 0; v < light.size(); ++v)
      light[v] = vertices[first + v].color[3];
    for (int round = 0; round < 6; ++round) {
      const std::vector<float> before = light;
      for (int r = 0; r <= GROUND_RINGS; ++r)
        for (int s = 0; s < GROUND_SPOKES; ++s) {
          float sum = 0, weight = 0;
          for (int dr = -1; dr <= 1; ++dr)
            for (int ds = -2; ds <= 2; ++ds) {
              const int q = std::clamp(r + dr, 0, GROUND_RINGS);
              sum += before[q * GROUND_SPOKES + (s + ds + GROUND_SPOKES) % GROUND_SPOKES];
              ++weight;
            }
          light[r * GROUND_SPOKES + s] = sum / weight;
        }
    }
    for (std::size_t v = 0; v < light.size(); ++v)
      vertices[first + v].color[3] = light[v];
  }

  void load_print() {
    if (options.print.rgba.empty())
      return;
    GLuint texture = 0;
    gl.GenTextures(1, &texture);
    gl.BindTexture(GL_TEXTURE_2D, texture);
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_SRGB8_ALPHA8, options.print.width, options.print.height, 0,
                  GL_RGBA, GL_UNSIGNED_BYTE, options.print.rgba.data());
    gl.GenerateMipmap(GL_TEXTURE_2D);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  }

  /// The key light goes round with the viewer, so that every view is lit alike.
  void light_from(double azimuth) {
    if (!occlusion || azimuth == lit_azimuth)
      return;
    lit_azimuth = azimuth;
    const Vec3 right(std::cos(azimuth), 0, -std::sin(azimuth)),
        front(std::sin(azimuth), 0, std::cos(azimuth));
    const Vec3 towards = (-0.62 * right + Vec3(0, 0.60, 0) + 0.50 * front).normalized();
    const std::vector<float> key = occlusion->key(points, normals, towards, 0.16);
    for (std::size_t v = 0; v < vertices.size(); ++v)
      vertices[v].value[1] = key[v];
    gl.BindBuffer(GL_ARRAY_BUFFER, surface_buffer);
    gl.BufferSubData(GL_ARRAY_BUFFER, 0,
                     static_cast<GLsizeiptr>(vertices.size() * sizeof vertices[0]),
                     vertices.data());
  }

  /// The program of one kind of surface, made when first asked for; its uniforms are set for this
  /// camera.
  void use_surface(int kind, const Camera& camera) {
    GLuint& program = surface_programs[static_cast<std::size_t>(kind)];
    if (!program) {
      const std::string source = "#version 330\nconst int kind = " + std::to_string(kind) +
                                 ", fabric = " + std::to_string(static_cast<int>(options.fabric)) +
                                 ", steps = " + std::to_string(options.map_colors.size()) + ";\n" +
                                 SURFACE_FRAGMENT_SHADER;
      program = gl.program(SURFACE_VERTEX_SHADER, source.c_str());
    }
    Eigen::Matrix4f clip = camera.matrix().cast<float>();
    // Cloth made smooth for drawing may dip this far below where it lies: the skin must not come
    // through it.
    if (kind == BODY)
      clip.row(2) += static_cast<float>(SMOOTHED_IN / camera.half_depth) * clip.row(3);
    const Eigen::Matrix3f turn = camera.turn.cast<float>();
    auto at = [&](const char* name) { return gl.GetUniformLocation(program, name); };
    gl.UseProgram(program);
    gl.UniformMatrix4fv(at("clip"), 1, GL_FALSE, clip.data());
    gl.UniformMatrix3fv(at("turn"), 1, GL_FALSE, turn.data());
    gl.Uniform3f(at("center"), static_cast<float>(camera.center.x()),
                 static_cast<float>(camera.center.y()), static_cast<float>(camera.center.z()));
    gl.Uniform1f(at("eye"), static_cast<float>(camera.distance));
    gl.Uniform1f(at("print_size"), static_cast<float>(options.print_size));
    gl.Uniform3f(at("accent"), 0.78f, 0.76f, 0.70f);
    if (options.map_colors.size() == 8) {
      float scale[24];
      for (int k = 0; k < 8; ++k)
        put(scale + 3 * k, options.map_colors[k]);
      gl.Uniform3fv(at("scale"), 8, scale);
      const Vec3 none = no_value_color();
      gl.Uniform3f(at("no_value"), static_cast<float>(none.x()), static_cast<float>(none.y()),
                   static_cast<float>(none.z()));
    }
  }

  void draw_parts(const Camera& camera) {
    const Eigen::Matrix4f clip = camera.matrix().cast<float>();
    auto uniform = [&](GLuint program, const char* name) {
      return gl.GetUniformLocation(program, name);
    };
    gl.UseProgram(line_program);
    gl.UniformMatrix4fv(uniform(line_program, "clip"), 1, GL_FALSE, clip.data());
    gl.Uniform2f(uniform(line_program, "half_size"), 0.5f * static_cast<float>(options.width),
                 0.5f * static_cast<float>(options.height));
    gl.Uniform1f(
        uniform(line_program, "width"),
        0.9f * std::max(1.f, static_cast<float>(std::min(options.width, options.height)) / 1200.f));
    gl.Uniform1f(uniform(line_program, "nearer"),
                 static_cast<float>(LINE_LIFT / camera.half_depth));
    gl.Enable(GL_STENCIL_TEST);
    gl.StencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
    for (const Part& part : parts) {
      gl.StencilFunc(GL_ALWAYS, stencil_of(part), ALL_BITS);
      const bool ground_seen = part.kind == GROUND && camera.elevation > units::radians(2);
      if (part.kind == GROUND && !ground_seen)
        continue;
      use_surface(part.kind, camera);
      gl.BindVertexArray(surface_array);
      if (part.kind == GROUND) {
        gl.Enable(GL_BLEND);
        gl.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
      }
      if (part.is_closed)
        gl.Enable(GL_CULL_FACE);
      gl.DrawElements(GL_TRIANGLES, part.n_indices, GL_UNSIGNED_INT,
                      reinterpret_cast<const void*>(static_cast<std::size_t>(part.first_index) *
                                                    sizeof(GLuint)));
      gl.Disable(GL_BLEND);
      gl.Disable(GL_CULL_FACE);
    }
    draw_lines();
    gl.Disable(GL_STENCIL_TEST);
  }

  /// The lines of each part, over itself and over what is no cloth. Where other cloth is seen they
  /// are hidden: they lie in front of their own surface and would show through it.
  void draw_lines() {
    gl.UseProgram(line_program);
    gl.BindVertexArray(line_array);
    gl.StencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
    for (const Part& part : parts) {
      if (part.n_lines == 0)
        continue;
      const void* first =
          reinterpret_cast<const void*>(static_cast<std::size_t>(part.first_line) * sizeof(GLuint));
      for (const GLint seen : std::set<GLint>{0, stencil_of(part)}) {
        gl.StencilFunc(GL_EQUAL, seen, ALL_BITS);
        gl.DrawElements(GL_TRIANGLES, part.n_lines, GL_UNSIGNED_INT, first);
      }
    }
  }

  /// Marks the pixels in which a part is seen: 0 for what is no cloth. Of more than 255 pieces some
  /// share a mark.
  GLint stencil_of(const Part& part) const {
    if (part.kind == BODY || part.kind == GROUND)
      return 0;
    return 1 + static_cast<GLint>((&part - parts.data()) % (ALL_BITS - 1));
  }

  io::Image resolve(const std::vector<std::uint8_t>& pixels) const {
    switch (options.supersample) {
    case 1: return resolve_by<1>(pixels);
    case 2: return resolve_by<2>(pixels);
    case 3: return resolve_by<3>(pixels);
    default: return resolve_by<4>(pixels);
    }
  }

  /// Means of squares of S pixels, laid over the ground colour, rows from the top.
  template<int S> io::Image resolve_by(const std::vector<std::uint8_t>& pixels) const {
    io::Image image;
    image.width = options.width;
    image.height = options.height;
    image.rgba.resize(4 * static_cast<std::size_t>(image.width) * image.height);
    constexpr unsigned n = S * S;
    const std::size_t row = 4 * static_cast<std::size_t>(image.width) * S;
    const unsigned color = static_cast<unsigned>(options.background.value_or(0)),
                   behind[] = {color >> 16 & 255, color >> 8 & 255, color & 255};
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        unsigned sum[4] = {};
        const std::uint8_t* corner = pixels.data() +
                                     row * static_cast<std::size_t>((image.height - 1 - y) * S) +
                                     4 * static_cast<std::size_t>(x * S);
        for (int dy = 0; dy < S; ++dy)
          for (int dx = 0; dx < S; ++dx)
            for (int k = 0; k < 4; ++k)
              sum[k] +=
                  corner[row * static_cast<std::size_t>(dy) + 4 * static_cast<std::size_t>(dx) + k];
        std::uint8_t* out = image.at(x, y);
        if (!options.background) { // colours are multiplied by coverage: undo that
          for (int k = 0; k < 3; ++k)
            out[k] = sum[3] ? static_cast<std::uint8_t>(
                                  std::min(255u, (255 * sum[k] + sum[3] / 2) / sum[3]))
                            : 0;
          out[3] = static_cast<std::uint8_t>((sum[3] + n / 2) / n);
        } else {
          const unsigned rest = 255 * n - sum[3];
          for (int k = 0; k < 3; ++k)
            out[k] = static_cast<std::uint8_t>((255 * sum[k] + rest * behind[k] + 255 * n / 2) /
                                               (255 * n));
          out[3] = 255;
        }
      }
    return image;
  }

  io::Image draw(const Camera& camera) {
    context->make_current();
    light_from(camera.azimuth);
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    const int width = options.width * options.supersample,
              height = options.height * options.supersample;
    gl.Viewport(0, 0, width, height);
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthFunc(GL_LEQUAL);
    gl.ClearColor(0, 0, 0, 0);
    gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    draw_parts(camera);
    std::vector<std::uint8_t> pixels(4 * static_cast<std::size_t>(width) * height);
    gl.ReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    if (wants_depth) {
      depth.resize(static_cast<std::size_t>(width) * height);
      gl.ReadPixels(0, 0, width, height, GL_DEPTH_COMPONENT, GL_FLOAT, depth.data());
    }
    return resolve(pixels);
  }
};

Renderer::Renderer(const std::vector<DrawMesh>& meshes, const DrawOptions& options)
    : m_impl(std::make_unique<Impl>(meshes, options)) {}
Renderer::~Renderer() = default;
io::Image Renderer::draw(const Camera& camera) {
  return m_impl->draw(camera);
}
void Renderer::keep_depth(bool yes) {
  m_impl->wants_depth = yes;
}

bool Renderer::is_visible(const Vec3& pixel, double slack) const {
  const Impl& impl = *m_impl;
  const int s = impl.options.supersample, x = static_cast<int>(pixel.x() * s),
            y = static_cast<int>((impl.options.height - pixel.y()) * s);
  if (impl.depth.empty() || x < 0 || y < 0 || x >= impl.options.width * s ||
      y >= impl.options.height * s)
    return true;
  return pixel.z() - slack <= impl.depth[static_cast<std::size_t>(y) * impl.options.width * s + x];
}

} // namespace sloper::render

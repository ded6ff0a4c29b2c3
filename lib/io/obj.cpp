#include <sloper/base/error.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/obj.hpp>

#include <charconv>
#include <cmath>

namespace sloper::io {

namespace {

/// Walks one OBJ text line by line without copying.
class Parser {
public:
  Parser(std::string_view text, const std::string& name, bool keep_texture)
      : m_text(text), m_name(name), m_keep_texture(keep_texture) {}

  ObjMesh run() {
    // some programs pad a text with zeros
    while (!m_text.empty() && m_text.back() == '\0')
      m_text.remove_suffix(1);
    if (m_text.substr(0, 3) == "\xEF\xBB\xBF")
      m_text.remove_prefix(3); // byte order mark, as some editors write it
    m_zero = m_text.find('\0');
    constexpr std::size_t VERTEX_BYTES = 60, FACE_BYTES = 40; // of a text, for half of each or more
    m_mesh.positions.reserve(m_text.size() / VERTEX_BYTES / 2);
    m_mesh.triangles.reserve(m_text.size() / FACE_BYTES);
    while (m_at < m_text.size()) {
      auto end = m_text.find('\n', m_at);
      if (end == std::string_view::npos)
        end = m_text.size();
      m_line = m_text.substr(m_at, end - m_at);
      m_at = end + 1;
      ++m_number;
      if (!m_line.empty() && m_line.back() == '\r')
        m_line.remove_suffix(1);
      parse_line();
    }
    if (!m_has_texture)
      m_mesh.texture_triangles.clear();
    return std::move(m_mesh);
  }

private:
  void parse_line() {
    if (m_zero < m_at) // its line is the first that ends behind it
      fail("obj.malformed"_id, "is not text", "expected an OBJ file");
    const std::string_view key = word();
    if (key == "v") {
      const double x = number(), y = number(), z = number();
      m_mesh.positions.emplace_back(x, y, z);
    } else if (key == "vt") {
      const double u = number(), v = number();
      m_mesh.texture.emplace_back(u, v);
    } else if (key == "f") {
      parse_face();
    } else if (key == "g" || key == "o") {
      const std::string name(word());
      const int at = std::ssize(m_mesh.triangles);
      if (!m_mesh.groups.empty() && m_mesh.groups.back().first_triangle == at)
        m_mesh.groups.back().name = name;
      else
        m_mesh.groups.push_back({name, at});
    }
  }

  void parse_face() {
    int v0 = -1, t0 = -1, v1 = -1, t1 = -1, count = 0;
    for (std::string_view corner = word(); !corner.empty(); corner = word(), ++count) {
      const auto slash = corner.find('/');
      const int v = index(corner.substr(0, slash), m_mesh.positions.size());
      int t = -1;
      if (slash != std::string_view::npos && m_keep_texture) {
        const std::string_view rest = corner.substr(slash + 1);
        const std::string_view part = rest.substr(0, rest.find('/'));
        if (!part.empty())
          t = index(part, m_mesh.texture.size());
      }
      if (t >= 0)
        m_has_texture = true;
      if (count == 0) {
        v0 = v;
        t0 = t;
      } else {
        if (count > 1) {
          m_mesh.triangles.push_back({v0, v1, v});
          if (m_keep_texture)
            m_mesh.texture_triangles.push_back({t0, t1, t});
        }
        v1 = v;
        t1 = t;
      }
    }
    if (count < 3)
      fail("obj.malformed"_id, "a face has fewer than three corners");
  }

  int index(std::string_view text, std::size_t size) {
    long i = 0;
    const auto result = std::from_chars(text.data(), text.data() + text.size(), i);
    if (result.ec != std::errc() || result.ptr != text.data() + text.size())
      fail("obj.malformed"_id, "\"" + std::string(text) + "\" is not an index");
    if (i < 0)
      i += static_cast<long>(size) + 1;
    if (i < 1 || i > static_cast<long>(size))
      fail("obj.malformed"_id, "the face refers to " + std::string(text) + ", but only " +
                                   std::to_string(size) + " are defined above it");
    return static_cast<int>(i - 1);
  }

  double number() {
    std::string_view text = word();
    if (!text.empty() && text[0] == '+')
      text.remove_prefix(1);
    double x = 0;
    const auto result = std::from_chars(text.data(), text.data() + text.size(), x);
    if (text.empty() || result.ec != std::errc() || result.ptr != text.data() + text.size())
      fail("obj.malformed"_id, text.empty()
                                   ? "a number is missing"
                                   : "\"" + std::string(text.substr(0, 20)) + "\" is not a number");
    if (!std::isfinite(x))
      fail("obj.malformed"_id, "a coordinate is not finite");
    return x;
  }

  std::string_view word() {
    const auto is_space = [](char c) { return c == ' ' || c == '\t'; };
    std::size_t begin = 0;
    while (begin < m_line.size() && is_space(m_line[begin]))
      ++begin;
    std::size_t end = begin;
    while (end < m_line.size() && !is_space(m_line[end]))
      ++end;
    const std::string_view w = m_line.substr(begin, end - begin);
    m_line.remove_prefix(end);
    return w;
  }

  [[noreturn]] void fail(MessageId id, const std::string& fact,
                         const std::string& next_step = {}) const {
    const bool ends_here = m_at > m_text.size(); // no line feed after it
    const std::string usual = ends_here ? "the file ends within this line: copy it again"
                                        : "export the mesh again, or mend that line";
    throw input_error(id, m_name, "line " + std::to_string(m_number), fact,
                      next_step.empty() ? usual : next_step);
  }

  std::string_view m_text, m_line;
  std::string m_name;
  std::size_t m_at = 0, m_number = 0;
  std::size_t m_zero = std::string_view::npos; ///< of the first byte that is no text
  bool m_keep_texture = true, m_has_texture = false;
  ObjMesh m_mesh;
};

void append_number(std::string& out, double x) {
  if (!std::isfinite(x))
    throw Error(ErrorKind::INTERNAL, "general.internal"_id, "", "",
                "a coordinate to be written is not finite");
  char buffer[32];
  out += ' ';
  out.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, x == 0 ? 0.0 : x).ptr);
}

void append_index(std::string& out, char before, int from_zero) {
  char buffer[16];
  out += before;
  out.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, from_zero + 1).ptr);
}

} // namespace

ObjMesh parse_obj(std::string_view text, const std::string& name, bool keep_texture) {
  return Parser(text, name, keep_texture).run();
}

ObjMesh read_obj(const std::string& path) {
  ObjMesh mesh = parse_obj(read_file(path), path);
  if (mesh.positions.empty())
    throw input_error("obj.no-vertices"_id, path, "", "has no vertices",
                      "the file is empty or not an OBJ");
  return mesh;
}

std::string obj_text(const ObjMesh& mesh, const std::string& comment) {
  std::string out = "# " + comment + "\n";
  out.reserve(mesh.positions.size() * 60 + mesh.triangles.size() * 24);
  for (const Vec3& p : mesh.positions) {
    out += 'v';
    for (int k = 0; k < 3; ++k)
      append_number(out, p[k]);
    out += '\n';
  }
  for (const Vec2& t : mesh.texture) {
    out += "vt";
    for (int k = 0; k < 2; ++k)
      append_number(out, t[k]);
    out += '\n';
  }
  std::size_t group = 0;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    while (group < mesh.groups.size() && mesh.groups[group].first_triangle <= static_cast<int>(f))
      out += "g " + mesh.groups[group++].name + "\n";
    out += 'f';
    for (int k = 0; k < 3; ++k) {
      append_index(out, ' ', mesh.triangles[f][k]);
      if (!mesh.texture_triangles.empty() && mesh.texture_triangles[f][k] >= 0)
        append_index(out, '/', mesh.texture_triangles[f][k]);
    }
    out += '\n';
  }
  return out;
}

void write_obj(const std::string& path, const ObjMesh& mesh, const std::string& comment) {
  write_file(path, obj_text(mesh, comment));
}

} // namespace sloper::io

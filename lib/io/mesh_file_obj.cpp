#include <sloper/base/error.hpp>
#include <sloper/io/mesh_file.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

namespace sloper::io {

namespace {

/// A place in the text.
struct Span {
  std::size_t begin = 0, end = 0;
};

/// Indices of one corner of a face, from 0, -1 where absent, and where they stand in the text.
struct ObjCorner {
  int vertex = -1, texture = -1, normal = -1;
  Span normal_at;
};

/// Walks an OBJ line by line, and reports what it meets; a line that ends in a backslash is
/// continued.
class ObjWalk {
public:
  ObjWalk(std::string_view text, const std::string& name) : m_text(text), m_name(name) {
    while (!m_text.empty() && m_text.back() == '\0')
      m_text.remove_suffix(1); // padding
  }

  bool next_line() {
    if (m_next >= m_text.size())
      return false;
    if (m_next == 0 && m_text.substr(0, 3) == "\xEF\xBB\xBF")
      m_next = 3;
    m_at = m_next;
    ++m_number;
    std::size_t end = m_text.find('\n', m_at);
    if (end == std::string_view::npos)
      end = m_text.size();
    m_next = end + 1;
    if (end > m_at && m_text[end - 1] == '\r')
      --end;
    m_end = end;
    if (m_text.substr(m_at, m_end - m_at).find('\0') != std::string_view::npos)
      fail("is not text", "expected an OBJ file");
    return true;
  }

  /// The next word of the line; empty at its end or at a comment.
  Span word() {
    for (;;) {
      while (m_at < m_end && (m_text[m_at] == ' ' || m_text[m_at] == '\t'))
        ++m_at;
      if (m_at + 1 == m_end && m_text[m_at] == '\\' && m_next < m_text.size()) {
        next_line();
        continue;
      }
      break;
    }
    Span span{m_at, m_at};
    if (m_at < m_end && m_text[m_at] == '#')
      m_at = m_end;
    while (m_at < m_end && m_text[m_at] != ' ' && m_text[m_at] != '\t')
      ++m_at;
    if (span.begin < m_end && m_text[span.begin] != '#')
      span.end = m_at;
    return span;
  }
  std::string_view text(Span span) const {
    return m_text.substr(span.begin, span.end - span.begin);
  }
  Span rest() { return {m_at, m_end}; }

  double number(Span span) const {
    std::string_view word = text(span);
    if (!word.empty() && word[0] == '+')
      word.remove_prefix(1);
    double x = 0;
    const auto result = std::from_chars(word.data(), word.data() + word.size(), x);
    if (word.empty())
      fail("a number is missing");
    if (result.ec != std::errc() || result.ptr != word.data() + word.size())
      fail("\"" + std::string(word.substr(0, 20)) + "\" is not a number");
    if (!std::isfinite(x))
      fail("a coordinate is not finite");
    return x;
  }

  /// @param sizes  of vertices, texture coordinates and normals so far
  ObjCorner corner(Span span, const std::array<std::size_t, 3>& sizes) const {
    ObjCorner corner;
    int* of[] = {&corner.vertex, &corner.texture, &corner.normal};
    std::size_t begin = span.begin;
    for (int k = 0; k < 3 && begin <= span.end; ++k) {
      std::size_t end = m_text.find('/', begin);
      if (end == std::string_view::npos || end > span.end)
        end = span.end;
      if (end > begin)
        *of[k] = index(text({begin, end}), sizes[k]);
      else if (k == 0)
        fail("a corner of a face names no vertex");
      if (k == 2 && end > begin)
        corner.normal_at = {begin, end};
      begin = end + 1;
    }
    return corner;
  }

  [[noreturn]] void fail(const std::string& fact, const std::string& next_step = {}) const {
    throw input_error("obj.malformed"_id, m_name, "line " + std::to_string(m_number), fact,
                      next_step);
  }

private:
  int index(std::string_view word, std::size_t size) const {
    long i = 0;
    const auto result = std::from_chars(word.data(), word.data() + word.size(), i);
    if (result.ec != std::errc() || result.ptr != word.data() + word.size())
      fail("\"" + std::string(word.substr(0, 20)) + "\" is not an index");
    if (i < 0)
      i += static_cast<long>(size) + 1;
    if (i < 1 || i > static_cast<long>(size))
      fail("the face refers to " + std::string(word) + ", but only " + std::to_string(size) +
           " are defined above it");
    return static_cast<int>(i - 1);
  }

  std::string_view m_text;
  std::string m_name;
  std::size_t m_at = 0, m_end = 0, m_next = 0, m_number = 0;
};

/// What stands where in an OBJ: for writing it again with other coordinates.
struct ObjPlaces {
  std::vector<std::array<Span, 3>> vertices; ///< #V
  std::vector<Span> normals;                 ///< #VN: the whole line, without its end
  std::vector<Vec3> normal;                  ///< #VN
  std::vector<std::vector<ObjCorner>> faces;
};

ObjPlaces read_places(const std::string& bytes, const std::string& name, MeshFile* file) {
  ObjPlaces places;
  ObjWalk walk(bytes, name);
  std::size_t n_texture = 0;
  while (walk.next_line()) {
    const Span key_at = walk.word();
    const std::string_view key = walk.text(key_at);
    if (key == "v") {
      std::array<Span, 3> at;
      Vec3 p;
      for (int k = 0; k < 3; ++k) {
        at[k] = walk.word();
        p[k] = walk.number(at[k]);
      }
      places.vertices.push_back(at);
      if (file)
        file->positions.push_back(p);
    } else if (key == "vt") {
      const double u = walk.number(walk.word());
      const Span second = walk.word();
      const double v = second.end > second.begin ? walk.number(second) : 0;
      ++n_texture;
      if (file)
        file->texture.emplace_back(u, v);
    } else if (key == "vn") {
      Vec3 n;
      Span last;
      for (int k = 0; k < 3; ++k) {
        last = walk.word();
        n[k] = walk.number(last);
      }
      places.normals.push_back({key_at.begin, last.end});
      places.normal.push_back(n);
    } else if (key == "f") {
      std::vector<ObjCorner> corners;
      const std::array<std::size_t, 3> sizes = {places.vertices.size(), n_texture,
                                                places.normals.size()};
      for (Span at = walk.word(); at.end > at.begin; at = walk.word())
        corners.push_back(walk.corner(at, sizes));
      if (corners.size() < 3)
        walk.fail("a face has fewer than three corners");
      places.faces.push_back(std::move(corners));
    } else if (key == "mtllib" && file) {
      std::string_view rest = walk.text(walk.rest());
      const std::size_t first = rest.find_first_not_of(" \t");
      if (first != std::string_view::npos)
        file->companions.emplace_back(rest.substr(first, rest.find_last_not_of(" \t") + 1 - first));
    }
  }
  return places;
}

/// What is to stand instead of a place in the text.
struct Edit {
  Span at;
  std::string text;
};

void put_number(std::string& out, double x) {
  if (!std::isfinite(x))
    throw Error(ErrorKind::INTERNAL, "general.internal"_id, "", "",
                "a coordinate to be written is not finite");
  char buffer[32];
  out.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, x == 0 ? 0.0 : x).ptr);
}

std::string normal_line(const Vec3& n) {
  std::string line = "vn";
  for (int k = 0; k < 3; ++k) {
    line += ' ';
    put_number(line, n[k]);
  }
  return line;
}

} // namespace

MeshFile parse_obj_mesh(std::string bytes, const std::string& name) {
  MeshFile file;
  file.name = name;
  file.format = "obj";
  const ObjPlaces places = read_places(bytes, name, &file);
  bool has_texture = false;
  for (const std::vector<ObjCorner>& corners : places.faces) {
    file.faces.emplace_back();
    file.face_texture.emplace_back();
    for (const ObjCorner& c : corners) {
      file.faces.back().push_back(c.vertex);
      file.face_texture.back().push_back(c.texture);
      has_texture |= c.texture >= 0;
    }
  }
  if (!has_texture) {
    file.texture.clear();
    file.face_texture.clear();
  }
  file.bytes = std::move(bytes);
  return file;
}

std::string moved_obj_mesh(const MeshFile& file, const std::vector<Vec3>& positions,
                           const std::vector<Mat3>& turned) {
  const std::string& bytes = file.bytes;
  const ObjPlaces places = read_places(bytes, file.name, nullptr);
  std::vector<Edit> edits;
  for (std::size_t v = 0; v < places.vertices.size(); ++v)
    for (int k = 0; k < 3; ++k) {
      std::string number;
      put_number(number, positions[v][k]);
      edits.push_back({places.vertices[v][k], std::move(number)});
    }
  // A normal of one vertex is turned in its place. Where a normal is of several, each vertex has
  // one of its own, and all the file's normals are written anew, at the first.
  std::vector<int> vertex_of(places.normals.size(), -1);
  bool shared = false;
  for (const auto& face : places.faces)
    for (const ObjCorner& c : face) {
      if (c.normal < 0)
        continue;
      shared |= vertex_of[c.normal] >= 0 && vertex_of[c.normal] != c.vertex;
      vertex_of[c.normal] = c.vertex;
    }
  if (!shared) {
    for (std::size_t n = 0; n < places.normals.size(); ++n)
      if (vertex_of[n] >= 0)
        edits.push_back({places.normals[n], normal_line(turned[vertex_of[n]] * places.normal[n])});
  } else {
    std::map<std::pair<int, int>, int> number; // of vertex and normal
    std::string lines;
    for (const auto& face : places.faces)
      for (const ObjCorner& c : face) {
        if (c.normal < 0)
          continue;
        const auto [found, is_new] =
            number.try_emplace({c.vertex, c.normal}, static_cast<int>(number.size()));
        if (is_new)
          lines += normal_line(turned[c.vertex] * places.normal[c.normal]) + "\n";
        edits.push_back({c.normal_at, std::to_string(found->second + 1)});
      }
    // A normal that was left out stays an empty line, so that lines keep their numbers.
    lines.pop_back();
    for (std::size_t n = 0; n < places.normals.size(); ++n)
      edits.push_back({places.normals[n], n == 0 ? lines : std::string()});
  }
  std::sort(edits.begin(), edits.end(),
            [](const Edit& a, const Edit& b) { return a.at.begin < b.at.begin; });
  std::string out;
  out.reserve(bytes.size() + bytes.size() / 8);
  std::size_t at = 0;
  for (const Edit& edit : edits) {
    out.append(bytes, at, edit.at.begin - at);
    out += edit.text;
    at = edit.at.end;
  }
  out.append(bytes, at);
  return out;
}

} // namespace sloper::io

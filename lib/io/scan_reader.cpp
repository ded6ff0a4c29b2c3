#include <io/assimp_reader.hpp>
#include <io/pcd.hpp>
#include <sloper/base/error.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/obj.hpp>
#include <sloper/io/scan_reader.hpp>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>

namespace sloper::io {

namespace {

static_assert(std::endian::native == std::endian::little,
              "binary scans are read on little-endian machines");

constexpr std::size_t MAX_ELEMENTS =
    100'000'000; ///< more than any scan; a header that promises more is a broken file

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == ',' || c == ';';
}

std::string_view next_word(std::string_view& line) {
  std::size_t begin = 0;
  while (begin < line.size() && is_space(line[begin]))
    ++begin;
  std::size_t end = begin;
  while (end < line.size() && !is_space(line[end]))
    ++end;
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

bool parse_number(std::string_view word, double& x) {
  if (!word.empty() && word[0] == '+')
    word.remove_prefix(1);
  const auto result = std::from_chars(word.data(), word.data() + word.size(), x);
  return !word.empty() && result.ec == std::errc() && result.ptr == word.data() + word.size();
}

/// Lines of a text, counted.
class Lines {
public:
  explicit Lines(std::string_view text) : m_text(text) {}
  bool next(std::string_view& line) {
    if (m_at >= m_text.size())
      return false;
    auto end = m_text.find('\n', m_at);
    if (end == std::string_view::npos)
      end = m_text.size();
    line = m_text.substr(m_at, end - m_at);
    m_at = end + 1;
    ++m_number;
    if (!line.empty() && line.back() == '\r')
      line.remove_suffix(1);
    return true;
  }
  std::size_t at() const { return std::min(m_at, m_text.size()); }
  std::string place() const { return "line " + std::to_string(m_number); }

private:
  std::string_view m_text;
  std::size_t m_at = 0, m_number = 0;
};

// ----------------------------------------------------------------------------------------------------------------
// PLY

enum class PlyType { I8, U8, I16, U16, I32, U32, F32, F64 };

int size_of(PlyType type) {
  constexpr int sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<int>(type)];
}

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::F32;
  bool is_list = false;
  PlyType count_type = PlyType::U8;
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;
};

class PlyReader {
public:
  PlyReader(std::string_view bytes, const std::string& name)
      : m_bytes(bytes), m_name(name), m_lines(bytes) {}

  TriangleMesh run() {
    read_header();
    for (const PlyElement& element : m_elements)
      read_element(element);
    for (const Triangle& t : m_mesh.triangles)
      for (int v : t)
        if (v < 0 || v >= std::ssize(m_mesh.positions))
          fail("scan.malformed"_id, "face",
               "refers to vertex " + std::to_string(v) + ", but there are only " +
                   std::to_string(m_mesh.positions.size()));
    return std::move(m_mesh);
  }

private:
  PlyType type_of(std::string_view word) {
    static const std::pair<const char*, PlyType> names[] = {
        {"char", PlyType::I8},    {"int8", PlyType::I8},     {"uchar", PlyType::U8},
        {"uint8", PlyType::U8},   {"short", PlyType::I16},   {"int16", PlyType::I16},
        {"ushort", PlyType::U16}, {"uint16", PlyType::U16},  {"int", PlyType::I32},
        {"int32", PlyType::I32},  {"uint", PlyType::U32},    {"uint32", PlyType::U32},
        {"float", PlyType::F32},  {"float32", PlyType::F32}, {"double", PlyType::F64},
        {"float64", PlyType::F64}};
    for (const auto& [name, type] : names)
      if (word == name)
        return type;
    fail("scan.malformed"_id, m_lines.place(),
         '"' + std::string(word.substr(0, 20)) + "\" is not a PLY type");
  }

  void read_header() {
    std::string_view line;
    if (!m_lines.next(line) || line != "ply")
      fail("scan.malformed"_id, "line 1", "does not begin with \"ply\"");
    while (true) {
      if (!m_lines.next(line))
        fail("scan.malformed"_id, "header", "ends before \"end_header\"");
      const std::string_view key = next_word(line);
      if (key == "end_header")
        break;
      if (key == "format") {
        const std::string_view kind = next_word(line);
        m_ascii = kind == "ascii";
        m_swap = kind == "binary_big_endian";
        if (!m_ascii && !m_swap && kind != "binary_little_endian")
          fail("scan.malformed"_id, m_lines.place(),
               "unknown PLY format \"" + std::string(kind.substr(0, 30)) + "\"");
      } else if (key == "element") {
        PlyElement element{std::string(next_word(line)), 0, {}};
        double count = -1;
        const bool is_count = parse_number(next_word(line), count) && count >= 0 &&
                              count <= static_cast<double>(MAX_ELEMENTS); // false for nan
        if (!is_count)
          fail("scan.malformed"_id, m_lines.place(),
               "the number of elements is not a whole number");
        element.count = static_cast<std::size_t>(count);
        m_elements.push_back(element);
      } else if (key == "property") {
        if (m_elements.empty())
          fail("scan.malformed"_id, m_lines.place(), "a property comes before any element");
        PlyProperty property;
        std::string_view word = next_word(line);
        if (word == "list") {
          property.is_list = true;
          property.count_type = type_of(next_word(line));
          word = next_word(line);
        }
        property.type = type_of(word);
        property.name = std::string(next_word(line));
        m_elements.back().properties.push_back(property);
      }
    }
    m_at = m_lines.at();
  }

  double value(PlyType type, std::string_view& line) {
    if (m_ascii) {
      double x = 0;
      const std::string_view word = next_word(line);
      if (!parse_number(word, x))
        fail("scan.malformed"_id, m_lines.place(),
             word.empty() ? "a number is missing"
                          : '"' + std::string(word.substr(0, 20)) + "\" is not a number");
      return x;
    }
    const int n = size_of(type);
    if (m_at + n > m_bytes.size())
      fail("scan.truncated"_id, "byte " + std::to_string(m_at), "the file ends early",
           "the copy is probably truncated");
    char raw[8];
    std::memcpy(raw, m_bytes.data() + m_at, n);
    if (m_swap)
      std::reverse(raw, raw + n);
    m_at += n;
    auto as = [&](auto x) {
      std::memcpy(&x, raw, sizeof x);
      return static_cast<double>(x);
    };
    switch (type) {
    case PlyType::I8: return as(std::int8_t{});
    case PlyType::U8: return as(std::uint8_t{});
    case PlyType::I16: return as(std::int16_t{});
    case PlyType::U16: return as(std::uint16_t{});
    case PlyType::I32: return as(std::int32_t{});
    case PlyType::U32: return as(std::uint32_t{});
    case PlyType::F32: return as(float{});
    default: return as(double{});
    }
  }

  void read_element(const PlyElement& element) {
    const bool is_vertex = element.name == "vertex", is_face = element.name == "face";
    int axis_of[64];
    if (element.properties.size() > 64)
      fail("scan.malformed"_id, "header", "more than 64 properties in one element");
    int axes = 0;
    for (std::size_t k = 0; k < element.properties.size(); ++k) {
      const std::string& name = element.properties[k].name;
      axis_of[k] =
          is_vertex && !element.properties[k].is_list && (name == "x" || name == "y" || name == "z")
              ? name[0] - 'x'
              : -1;
      axes += axis_of[k] >= 0;
    }
    if (is_vertex && axes != 3)
      fail("scan.malformed"_id, "header", "the vertices have no x, y and z");
    std::vector<int> corners;
    for (std::size_t i = 0; i < element.count; ++i) {
      std::string_view line;
      if (m_ascii && !m_lines.next(line))
        fail("scan.truncated"_id, m_lines.place(), "the file ends early",
             "the copy is probably truncated");
      Vec3 p = Vec3::Zero();
      for (std::size_t k = 0; k < element.properties.size(); ++k) {
        const PlyProperty& property = element.properties[k];
        if (!property.is_list) {
          const double x = value(property.type, line);
          if (axis_of[k] >= 0)
            p[axis_of[k]] = x;
          continue;
        }
        const double count = value(property.count_type, line);
        if (!(count >= 0 && count <= 100000))
          fail("scan.malformed"_id, element.name + " " + std::to_string(i),
               "the number of corners is not a whole number");
        const bool corner_list =
            is_face && (property.name == "vertex_indices" || property.name == "vertex_index");
        corners.clear();
        for (int c = 0; c < static_cast<int>(count); ++c) {
          const double x = value(property.type, line);
          if (corner_list)
            corners.push_back(x >= 0 && x < 2e9 ? static_cast<int>(x) : -1);
        }
        for (std::size_t c = 2; corner_list && c < corners.size(); ++c)
          m_mesh.triangles.push_back({corners[0], corners[c - 1], corners[c]});
      }
      if (!is_vertex)
        continue;
      if (!p.allFinite())
        fail("scan.not-finite"_id, "vertex " + std::to_string(i), "a coordinate is not finite");
      m_mesh.positions.push_back(p);
    }
  }

  [[noreturn]] void fail(MessageId id, const std::string& place, const std::string& fact,
                         const std::string& next_step = {}) const {
    throw input_error(id, m_name, place, fact, next_step);
  }

  std::string_view m_bytes;
  std::string m_name;
  Lines m_lines;
  std::size_t m_at = 0;
  bool m_ascii = true, m_swap = false;
  std::vector<PlyElement> m_elements;
  TriangleMesh m_mesh;
};

void add_facet(TriangleMesh& mesh, const Vec3 (&corner)[3]) {
  const int first = std::ssize(mesh.positions);
  for (const Vec3& p : corner)
    mesh.positions.push_back(p);
  mesh.triangles.push_back({first, first + 1, first + 2});
}

} // namespace

TriangleMesh parse_ply(std::string_view bytes, const std::string& name) {
  return PlyReader(bytes, name).run();
}

// Bytes of a binary STL: a title, with the number of facets behind it; a facet.
static constexpr std::size_t STL_TITLE = 80, STL_HEAD = 84, STL_FACET = 50;

TriangleMesh parse_stl(std::string_view bytes, const std::string& name) {
  TriangleMesh mesh;
  std::uint32_t count = 0;
  if (bytes.size() >= STL_HEAD)
    std::memcpy(&count, bytes.data() + STL_TITLE, sizeof count);
  const bool is_text = bytes.substr(0, 5) == "solid" &&
                       bytes.substr(0, 2000).find("facet") != std::string_view::npos;
  if (!is_text) {
    if (bytes.size() < STL_HEAD)
      throw input_error("scan.truncated"_id, name, "", "is too short for an STL file",
                        "the copy is probably truncated");
    if (STL_HEAD + STL_FACET * static_cast<std::size_t>(count) > bytes.size())
      throw input_error("scan.truncated"_id, name, "header",
                        "promises " + std::to_string(count) + " facets, but the file ends early",
                        "the copy is probably truncated");
    mesh.positions.reserve(3 * static_cast<std::size_t>(count));
    for (std::uint32_t f = 0; f < count; ++f) {
      float raw[12];
      std::memcpy(raw, bytes.data() + STL_HEAD + STL_FACET * static_cast<std::size_t>(f),
                  sizeof raw);
      Vec3 corner[3];
      for (int k = 0; k < 3; ++k) {
        corner[k] = Vec3(raw[3 + 3 * k], raw[4 + 3 * k], raw[5 + 3 * k]);
        if (!corner[k].allFinite())
          throw input_error("scan.not-finite"_id, name, "facet " + std::to_string(f),
                            "a coordinate is not finite");
      }
      add_facet(mesh, corner);
    }
    return mesh;
  }
  Lines lines(bytes);
  std::string_view line;
  Vec3 corner[3];
  int k = 0;
  while (lines.next(line)) {
    if (next_word(line) != "vertex")
      continue;
    for (int axis = 0; axis < 3; ++axis)
      if (!parse_number(next_word(line), corner[k][axis]) || !std::isfinite(corner[k][axis]))
        throw input_error("scan.malformed"_id, name, lines.place(),
                          "a vertex is not three finite numbers");
    if (++k == 3) {
      add_facet(mesh, corner);
      k = 0;
    }
  }
  if (k != 0)
    throw input_error("scan.truncated"_id, name, lines.place(), "the last facet is not complete",
                      "the copy is probably truncated");
  return mesh;
}

TriangleMesh parse_xyz(std::string_view bytes, const std::string& name) {
  TriangleMesh mesh;
  Lines lines(bytes);
  std::string_view line;
  while (lines.next(line)) {
    if (line.find('\0') != std::string_view::npos)
      throw input_error("scan.malformed"_id, name, lines.place(), "is not text",
                        "expected x y z on every line");
    std::string_view word = next_word(line);
    if (word.empty() || word[0] == '#' || word.substr(0, 2) == "//")
      continue;
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis) {
      if (!parse_number(word, p[axis])) {
        if (mesh.positions.empty() && axis == 0)
          break; // a heading line
        throw input_error("scan.malformed"_id, name, lines.place(),
                          word.empty()
                              ? "has fewer than three numbers"
                              : "\"" + std::string(word.substr(0, 20)) + "\" is not a number");
      }
      if (!std::isfinite(p[axis]))
        throw input_error("scan.not-finite"_id, name, lines.place(), "a coordinate is not finite");
      if (axis < 2)
        word = next_word(line);
      else
        mesh.positions.push_back(p);
    }
  }
  return mesh;
}

namespace {

constexpr const char* EXPECTED =
    "expected a scan in OBJ, PLY, STL, 3DS, XYZ, PCD, glTF, FBX, Collada, OFF or X3D";

/// By the extension, or by the first bytes where that says nothing.
std::string format_of(const std::string& path, std::string_view bytes) {
  std::string extension = path.substr(std::min(
      path.size(),
      path.find_last_of("./") == std::string::npos ? path.size() : path.find_last_of("./") + 1));
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const char* points : {"asc", "txt", "pts", "csv"})
    if (extension == points)
      return "xyz";
  for (const char* ours : {"obj", "ply", "stl", "3ds", "xyz", "pcd"})
    if (extension == ours)
      return extension;
  if (is_read_by_assimp(extension))
    return extension;
  const std::string_view head = bytes.substr(0, 4000);
  if (const std::size_t first = head.find_first_not_of(" \t\r\n");
      first != std::string_view::npos && head[first] == '{')
    throw input_error("scan.is-document"_id, path, "", "is a JSON document, not a scan",
                      std::string(EXPECTED) + "; a document's mesh is the .obj beside it");
  if (head.substr(0, 3) == "ply")
    return "ply";
  if (head.substr(0, 6) == "# .PCD")
    return "pcd";
  if (head.find("\nv ") != std::string_view::npos || head.substr(0, 2) == "v ")
    return "obj";
  return head.substr(0, 5) == "solid" ? "stl" : "xyz";
}

/// Files that people take for a scan, by their first bytes.
void refuse_other_kinds(const std::string& path, std::string_view bytes) {
  struct Kind {
    std::string_view begins, what, next_step;
  };
  using namespace std::string_view_literals;
  static constexpr Kind KINDS[] = {
      {"\x89PNG"sv, "is a PNG picture", EXPECTED},
      {"\xFF\xD8\xFF"sv, "is a JPEG picture", EXPECTED},
      {"%PDF"sv, "is a PDF", EXPECTED},
      {"PK\x03\x04"sv, "is a ZIP archive", "unpack it, and give the scan inside"},
      {"\x1F\x8B"sv, "is compressed with gzip", "unpack it, and give the scan inside"}};
  for (const Kind& kind : KINDS)
    if (bytes.substr(0, kind.begins.size()) == kind.begins)
      throw input_error("scan.other-kind"_id, path, "", std::string(kind.what),
                        std::string(kind.next_step));
}

} // namespace

Scan read_scan(const std::string& path, SkinPose pose) {
  const std::string bytes = read_file(path);
  if (bytes.empty())
    throw input_error("file.empty"_id, path, "", "is empty", EXPECTED);
  refuse_other_kinds(path, bytes);
  Scan scan;
  scan.format = format_of(path, bytes);
  scan.sha256 = sha256(bytes);
  if (scan.format == "obj") {
    ObjMesh obj = parse_obj(bytes, path, false);
    scan.mesh.positions = std::move(obj.positions);
    scan.mesh.triangles = std::move(obj.triangles);
  } else if (scan.format == "ply")
    scan.mesh = parse_ply(bytes, path);
  else if (scan.format == "stl")
    scan.mesh = parse_stl(bytes, path);
  else if (scan.format == "3ds")
    scan.mesh = parse_3ds(bytes, path);
  else if (scan.format == "xyz")
    scan.mesh = parse_xyz(bytes, path);
  else if (scan.format == "pcd")
    scan.mesh = parse_pcd(bytes, path);
  else
    scan.mesh = read_with_assimp(path, scan.format, pose);
  if (scan.mesh.positions.empty())
    throw input_error("scan.no-vertices"_id, path, "", "holds no vertices", EXPECTED);
  return scan;
}

} // namespace sloper::io

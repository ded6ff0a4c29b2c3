#include <sloper/base/error.hpp>
#include <sloper/io/mesh_file.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace sloper::io {

namespace {

struct PlyField {
  std::string name;
  char kind = 'f';   ///< i: signed, u: unsigned, f: floating point
  int size = 4;      ///< bytes
  int list_size = 0; ///< bytes of the count of a list, 0: no list
  char list_kind = 'u';
};

struct PlyPart {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyField> fields;
};

/// A number in the file: where it stands and how.
struct PlyPlace {
  std::size_t begin = 0, end = 0;
  char kind = 'f';
};

/// Reads a PLY from front to back, number by number.
class PlyWalk {
public:
  PlyWalk(std::string_view bytes, const std::string& name) : m_bytes(bytes), m_name(name) {
    read_header();
  }

  const std::vector<PlyPart>& parts() const { return m_parts; }
  bool is_text() const { return m_text; }
  bool is_swapped() const { return m_swapped; }

  double number(char kind, int size, PlyPlace& at) {
    at.kind = kind;
    return m_text ? text_number(at) : binary_number(kind, size, at);
  }

  [[noreturn]] void fail(const std::string& place, const std::string& fact,
                         const std::string& next_step = {}) const {
    throw input_error("import.malformed"_id, m_name, place, fact, next_step);
  }

private:
  std::string_view line() {
    const std::size_t end = m_bytes.find('\n', m_at);
    if (end == std::string_view::npos)
      fail("header", "does not end", "the copy is probably truncated");
    std::string_view text = m_bytes.substr(m_at, end - m_at);
    m_at = end + 1;
    if (!text.empty() && text.back() == '\r')
      text.remove_suffix(1);
    return text;
  }

  static std::string_view word(std::string_view& line) {
    const std::size_t begin = line.find_first_not_of(" \t");
    if (begin == std::string_view::npos)
      return line = {};
    const std::size_t end = std::min(line.find_first_of(" \t", begin), line.size());
    const std::string_view found = line.substr(begin, end - begin);
    line.remove_prefix(end);
    return found;
  }

  void type_of(std::string_view name, char& kind, int& size) const {
    static constexpr struct {
      const char *old_name, *name;
      char kind;
      int size;
    } TYPES[] = {{"char", "int8", 'i', 1},     {"uchar", "uint8", 'u', 1},
                 {"short", "int16", 'i', 2},   {"ushort", "uint16", 'u', 2},
                 {"int", "int32", 'i', 4},     {"uint", "uint32", 'u', 4},
                 {"float", "float32", 'f', 4}, {"double", "float64", 'f', 8}};
    for (const auto& type : TYPES)
      if (name == type.old_name || name == type.name) {
        kind = type.kind;
        size = type.size;
        return;
      }
    fail("header", "\"" + std::string(name.substr(0, 20)) + "\" is not a PLY type");
  }

  void read_header() {
    if (m_bytes.substr(0, 3) != "ply")
      fail("line 1", "does not begin with \"ply\"");
    line();
    for (;;) {
      std::string_view text = line();
      const std::string_view key = word(text);
      if (key == "end_header")
        break;
      if (key == "format") {
        const std::string_view form = word(text);
        if (form != "ascii" && form != "binary_little_endian" && form != "binary_big_endian")
          fail("header", "\"" + std::string(form.substr(0, 30)) + "\" is not a PLY format");
        m_text = form == "ascii";
        m_swapped = form == "binary_big_endian";
      } else if (key == "element") {
        PlyPart part;
        part.name = std::string(word(text));
        const std::string_view count = word(text);
        const auto read = std::from_chars(count.data(), count.data() + count.size(), part.count);
        if (read.ec != std::errc() || part.count > m_bytes.size())
          fail("header", "element " + part.name + " has no count that this file can hold");
        m_parts.push_back(std::move(part));
      } else if (key == "property") {
        if (m_parts.empty())
          fail("header", "a property comes before any element");
        PlyField field;
        std::string_view type = word(text);
        if (type == "list") {
          type_of(word(text), field.list_kind, field.list_size);
          type = word(text);
        }
        type_of(type, field.kind, field.size);
        field.name = std::string(word(text));
        m_parts.back().fields.push_back(std::move(field));
      }
    }
  }

  double text_number(PlyPlace& at) {
    at.begin = m_bytes.find_first_not_of(" \t\r\n", m_at);
    if (at.begin == std::string_view::npos)
      fail("body", "the file ends early", "the copy is probably truncated");
    at.end = std::min(m_bytes.find_first_of(" \t\r\n", at.begin), m_bytes.size());
    m_at = at.end;
    double x = 0;
    const char* first = m_bytes.data() + at.begin + (m_bytes[at.begin] == '+' ? 1 : 0);
    const auto read = std::from_chars(first, m_bytes.data() + at.end, x);
    if (read.ec != std::errc() || read.ptr != m_bytes.data() + at.end)
      fail("byte " + std::to_string(at.begin), "is not a number");
    return x;
  }

  double binary_number(char kind, int size, PlyPlace& at) {
    at.begin = m_at;
    at.end = m_at + static_cast<std::size_t>(size);
    if (at.end > m_bytes.size())
      fail("byte " + std::to_string(m_at), "the file ends early", "the copy is probably truncated");
    char raw[8] = {};
    std::memcpy(raw, m_bytes.data() + m_at, static_cast<std::size_t>(size));
    m_at = at.end;
    if (m_swapped)
      std::reverse(raw, raw + size);
    const auto as = [&](auto x) {
      std::memcpy(&x, raw, sizeof x);
      return static_cast<double>(x);
    };
    if (kind == 'f')
      return size == 4 ? as(float{}) : as(double{});
    if (size == 1)
      return kind == 'i' ? as(std::int8_t{}) : as(std::uint8_t{});
    if (size == 2)
      return kind == 'i' ? as(std::int16_t{}) : as(std::uint16_t{});
    return kind == 'i' ? as(std::int32_t{}) : as(std::uint32_t{});
  }

  std::string_view m_bytes;
  std::string m_name;
  std::size_t m_at = 0;
  bool m_text = true, m_swapped = false;
  std::vector<PlyPart> m_parts;
};

constexpr const char* COORDINATES[] = {"x", "y", "z"};
constexpr const char* NORMALS[] = {"nx", "ny", "nz"};
constexpr const char* U_NAMES[] = {"s", "u", "texture_u"};
constexpr const char* V_NAMES[] = {"t", "v", "texture_v"};

template<class Names> int index_in(const Names& names, const std::string& name) {
  int k = 0;
  for (const char* known : names) {
    if (name == known)
      return k;
    ++k;
  }
  return -1;
}

/// Where coordinates and normals stand, by vertex.
struct PlyPlaces {
  std::vector<std::array<PlyPlace, 3>> position, normal_at;
  std::vector<Vec3> normal;
};

/// @param file  gets positions, faces and texture; may be null
PlyPlaces read_ply(PlyWalk& walk, MeshFile* file) {
  PlyPlaces places;
  for (const PlyPart& part : walk.parts()) {
    const bool is_vertex = part.name == "vertex", is_face = part.name == "face";
    int axes = 0;
    std::array<bool, 3> normals = {};
    bool has_u = false, has_v = false;
    for (const PlyField& field : part.fields) {
      if (field.list_size > 0)
        continue;
      axes += index_in(COORDINATES, field.name) >= 0;
      // whole numbers are scaled in ways of their own: such normals stay as they are
      if (const int k = index_in(NORMALS, field.name); k >= 0 && field.kind == 'f')
        normals[k] = true;
      has_u |= index_in(U_NAMES, field.name) >= 0;
      has_v |= index_in(V_NAMES, field.name) >= 0;
    }
    if (is_vertex && axes != 3)
      walk.fail("header", "the vertices have no x, y and z");
    for (std::size_t i = 0; i < part.count; ++i) {
      std::array<PlyPlace, 3> at, normal_at;
      Vec3 p = Vec3::Zero(), n = Vec3::Zero();
      Vec2 uv = Vec2::Zero();
      for (const PlyField& field : part.fields) {
        PlyPlace place;
        if (field.list_size > 0) {
          const double count = walk.number(field.list_kind, field.list_size, place);
          if (!(count >= 0 && count <= 1e6 && count == std::floor(count)))
            walk.fail(part.name + " " + std::to_string(i), "has a list of no sensible length");
          const bool corners =
              is_face && (field.name == "vertex_indices" || field.name == "vertex_index");
          std::vector<int> face;
          for (int c = 0; c < static_cast<int>(count); ++c) {
            const double x = walk.number(field.kind, field.size, place);
            if (corners)
              face.push_back(x >= 0 && x < 2e9 ? static_cast<int>(x) : -1);
          }
          if (corners && file)
            file->faces.push_back(std::move(face));
          continue;
        }
        const double x = walk.number(field.kind, field.size, place);
        if (!is_vertex)
          continue;
        if (const int k = index_in(COORDINATES, field.name); k >= 0) {
          p[k] = x;
          at[k] = place;
        }
        if (const int k = index_in(NORMALS, field.name); k >= 0 && field.kind == 'f') {
          n[k] = x;
          normal_at[k] = place;
        }
        if (index_in(U_NAMES, field.name) >= 0)
          uv.x() = x;
        if (index_in(V_NAMES, field.name) >= 0)
          uv.y() = x;
      }
      if (!is_vertex)
        continue;
      places.position.push_back(at);
      if (normals[0] && normals[1] && normals[2]) {
        places.normal_at.push_back(normal_at);
        places.normal.push_back(n);
      }
      if (!file)
        continue;
      file->positions.push_back(p);
      if (has_u && has_v)
        file->texture.push_back(uv);
    }
  }
  return places;
}

void put_place(std::string& out, const PlyPlace& at, double x, bool swapped) {
  const std::size_t size = at.end - at.begin;
  char raw[8];
  if (size == 8)
    std::memcpy(raw, &x, 8);
  else {
    const auto single = static_cast<float>(x);
    std::memcpy(raw, &single, 4);
  }
  if (swapped)
    std::reverse(raw, raw + size);
  out.replace(at.begin, size, raw, size);
}

std::string text_of(double x) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, x == 0 ? 0.0 : x).ptr};
}

} // namespace

MeshFile parse_ply_mesh(std::string bytes, const std::string& name) {
  MeshFile file;
  file.name = name;
  file.format = "ply";
  PlyWalk walk(bytes, name);
  read_ply(walk, &file);
  for (const PlyPart& part : walk.parts())
    for (const PlyField& field : part.fields)
      if (part.name == "vertex" && index_in(COORDINATES, field.name) >= 0 && field.kind != 'f')
        walk.fail("header", "coordinates are whole numbers, and a garment cannot move by less",
                  "write it with float coordinates");
  if (file.texture.size() != file.positions.size())
    file.texture.clear(); // some vertices have none
  if (!file.texture.empty())
    file.face_texture = file.faces; // texture stands at the vertices
  file.bytes = std::move(bytes);
  return file;
}

std::string moved_ply_mesh(const MeshFile& file, const std::vector<Vec3>& positions,
                           const std::vector<Mat3>& turned) {
  PlyWalk walk(file.bytes, file.name);
  const PlyPlaces places = read_ply(walk, nullptr);
  const auto each = [&](auto&& put) {
    for (std::size_t v = 0; v < places.position.size(); ++v) {
      for (int k = 0; k < 3; ++k)
        put(places.position[v][k], positions[v][k]);
      if (places.normal.size() != places.position.size())
        continue;
      const Vec3 n = turned[v] * places.normal[v];
      for (int k = 0; k < 3; ++k)
        put(places.normal_at[v][k], n[k]);
    }
  };
  if (!walk.is_text()) {
    std::string out = file.bytes;
    each([&](const PlyPlace& at, double x) { put_place(out, at, x, walk.is_swapped()); });
    return out;
  }
  std::vector<std::pair<PlyPlace, double>> edits;
  each([&](const PlyPlace& at, double x) { edits.emplace_back(at, x); });
  std::sort(edits.begin(), edits.end(),
            [](const auto& a, const auto& b) { return a.first.begin < b.first.begin; });
  std::string out;
  out.reserve(file.bytes.size() + file.bytes.size() / 4);
  std::size_t from = 0;
  for (const auto& [at, x] : edits) {
    out.append(file.bytes, from, at.begin - from);
    out += text_of(x);
    from = at.end;
  }
  out.append(file.bytes, from);
  return out;
}

} // namespace sloper::io

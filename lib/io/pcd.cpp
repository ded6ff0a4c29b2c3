#include <io/pcd.hpp>
#include <sloper/base/error.hpp>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

namespace sloper::io {

namespace {

constexpr std::size_t MOST_POINTS = 100'000'000; ///< more than any scan: a broken header
constexpr std::size_t MOST_FIELDS = 256;
constexpr std::size_t MOST_EXPANSION = 100; ///< LZF: 264 bytes from 3
constexpr const char* TRUNCATED = "the copy is probably truncated";

struct Field {
  std::string name;
  std::size_t size = 4, count = 1;
  char type = 'F';
  std::size_t offset = 0; ///< bytes from the start of a point
};

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t at = 0; at < line.size();) {
    const std::size_t begin = line.find_first_not_of(" \t\r", at);
    if (begin == std::string_view::npos)
      break;
    const std::size_t end = std::min(line.size(), line.find_first_of(" \t\r", begin));
    words.push_back(line.substr(begin, end - begin));
    at = end;
  }
  return words;
}

/// Inverse of LZF (M. Lehmann, liblzf). @return whether exactly `output` was filled
bool expand_lzf(std::string_view input, std::string& output) {
  std::size_t in = 0, out = 0;
  auto next = [&] { return static_cast<unsigned char>(input[in++]); };
  while (in < input.size()) {
    const std::size_t control = next();
    if (control < 32) { // so many bytes and one as they are
      const std::size_t n = control + 1;
      if (in + n > input.size() || out + n > output.size())
        return false;
      std::memcpy(output.data() + out, input.data() + in, n);
      in += n;
      out += n;
      continue;
    }
    std::size_t n = control >> 5;
    if (n == 7) {
      if (in >= input.size())
        return false;
      n += next();
    }
    if (in >= input.size())
      return false;
    const std::size_t back = ((control & 31) << 8) + next() + 1;
    n += 2;
    if (back > out || out + n > output.size())
      return false;
    for (std::size_t k = 0; k < n; ++k, ++out)
      output[out] = output[out - back]; // may overlap
  }
  return out == output.size();
}

class PcdReader {
public:
  PcdReader(std::string_view bytes, const std::string& name) : m_bytes(bytes), m_name(name) {}

  TriangleMesh run() {
    read_header();
    if (m_data == "ascii")
      read_text();
    else if (m_data == "binary")
      read_points(m_bytes.substr(m_at), false);
    else
      read_compressed();
    return std::move(m_mesh);
  }

private:
  bool next_line(std::string_view& line) {
    if (m_at >= m_bytes.size())
      return false;
    const std::size_t end = std::min(m_bytes.size(), m_bytes.find('\n', m_at));
    line = m_bytes.substr(m_at, end - m_at);
    m_at = std::min(m_bytes.size(), end + 1);
    ++m_line;
    return true;
  }

  void read_header() {
    std::string_view line;
    while (m_data.empty()) {
      if (!next_line(line))
        fail("scan.malformed"_id, "header", "ends before \"DATA\"");
      const std::vector<std::string_view> words = words_of(line);
      if (words.empty() || words[0][0] == '#')
        continue;
      read_entry(words);
    }
    std::size_t at = 0;
    for (Field& field : m_fields) {
      field.offset = at;
      at += field.size * field.count;
    }
    m_stride = at;
    for (int axis = 0; axis < 3; ++axis) {
      for (std::size_t k = 0; k < m_fields.size(); ++k)
        if (m_fields[k].name == std::string(1, "xyz"[axis]))
          m_axis[axis] = static_cast<int>(k);
      if (m_axis[axis] < 0)
        fail("scan.malformed"_id, "FIELDS", "has no x, y and z");
      const Field& field = m_fields[m_axis[axis]];
      if (field.type != 'F' || (field.size != 4 && field.size != 8) || field.count != 1)
        fail("scan.malformed"_id, "TYPE",
             "x, y and z are not floating-point numbers of 4 or 8 bytes");
    }
    if (m_points == 0)
      m_points = m_width * m_height;
    if (m_points > MOST_POINTS)
      fail("scan.malformed"_id, "POINTS", "is more than any scan has");
  }

  void read_entry(const std::vector<std::string_view>& words) {
    const std::string_view key = words[0];
    const std::size_t n = words.size() - 1;
    if (key == "FIELDS" || key == "COLUMNS") {
      if (n > MOST_FIELDS)
        fail("scan.malformed"_id, place(), "more than 256 fields");
      m_fields.resize(n);
      for (std::size_t k = 0; k < n; ++k)
        m_fields[k].name = std::string(words[k + 1]);
    } else if (key == "SIZE" || key == "COUNT" || key == "TYPE") {
      if (n != m_fields.size())
        fail("scan.malformed"_id, place(), "has not one entry for each field");
      for (std::size_t k = 0; k < n; ++k) {
        if (key == "TYPE")
          m_fields[k].type = words[k + 1][0];
        else
          (key == "SIZE" ? m_fields[k].size : m_fields[k].count) = count_of(words[k + 1], 65536);
      }
    } else if (key == "WIDTH")
      m_width = count_of(word(words, 1), MOST_POINTS);
    else if (key == "HEIGHT")
      m_height = count_of(word(words, 1), MOST_POINTS);
    else if (key == "POINTS")
      m_points = count_of(word(words, 1), MOST_POINTS);
    else if (key == "DATA") {
      m_data = std::string(word(words, 1));
      if (m_data != "ascii" && m_data != "binary" && m_data != "binary_compressed")
        fail("scan.unsupported-data"_id, place(), "the data are \"" + m_data.substr(0, 30) + "\"",
             "ascii, binary or binary_compressed is read");
    } else if (key != "VERSION" && key != "VIEWPOINT")
      fail("scan.malformed"_id, place(),
           "\"" + std::string(key.substr(0, 20)) + "\" is no entry of a PCD header");
  }

  std::string_view word(const std::vector<std::string_view>& words, std::size_t k) const {
    if (k >= words.size())
      fail("scan.malformed"_id, place(), "has no value");
    return words[k];
  }

  std::size_t count_of(std::string_view text, std::size_t most) const {
    std::size_t n = 0;
    const auto result = std::from_chars(text.data(), text.data() + text.size(), n);
    if (result.ec != std::errc() || result.ptr != text.data() + text.size() || n > most)
      fail("scan.malformed"_id, place(),
           '"' + std::string(text.substr(0, 20)) + "\" is not a count");
    return n;
  }

  void add(const Vec3& p) {
    if (p.allFinite())
      m_mesh.positions.push_back(p);
  }

  void read_text() {
    std::size_t column[3] = {0, 0, 0}, columns = 0;
    for (std::size_t k = 0; k < m_fields.size(); ++k) {
      for (int axis = 0; axis < 3; ++axis)
        if (m_axis[axis] == static_cast<int>(k))
          column[axis] = columns;
      columns += m_fields[k].count;
    }
    std::string_view line;
    for (std::size_t i = 0; i < m_points; ++i) {
      if (!next_line(line))
        fail("scan.truncated"_id, place(), "the file ends early", TRUNCATED);
      const std::vector<std::string_view> words = words_of(line);
      if (words.size() < columns)
        fail("scan.malformed"_id, place(), "has fewer numbers than there are fields");
      Vec3 p;
      for (int axis = 0; axis < 3; ++axis) {
        const std::string_view text = words[column[axis]];
        const auto result = std::from_chars(text.data(), text.data() + text.size(), p[axis]);
        if (result.ec != std::errc() || result.ptr != text.data() + text.size())
          fail("scan.malformed"_id, place(),
               '"' + std::string(text.substr(0, 20)) + "\" is not a number");
      }
      add(p);
    }
  }

  /// @param by_field all of a field, then all of the next, as compressed files have it
  void read_points(std::string_view data, bool by_field) {
    if (m_stride == 0 || data.size() / m_stride < m_points)
      fail("scan.truncated"_id, "byte " + std::to_string(m_bytes.size()), "the file ends early",
           TRUNCATED);
    for (std::size_t i = 0; i < m_points; ++i) {
      Vec3 p;
      for (int axis = 0; axis < 3; ++axis) {
        const Field& field = m_fields[m_axis[axis]];
        const char* at = data.data() + (by_field ? field.offset * m_points + i * field.size
                                                 : i * m_stride + field.offset);
        if (field.size == 4) {
          float x;
          std::memcpy(&x, at, sizeof x);
          p[axis] = x;
        } else
          std::memcpy(&p[axis], at, sizeof(double));
      }
      add(p);
    }
  }

  void read_compressed() {
    std::uint32_t sizes[2]; // compressed, expanded
    if (m_bytes.size() - m_at < sizeof sizes)
      fail("scan.truncated"_id, "byte " + std::to_string(m_at), "the file ends early", TRUNCATED);
    std::memcpy(sizes, m_bytes.data() + m_at, sizeof sizes);
    m_at += sizeof sizes;
    if (m_bytes.size() - m_at < sizes[0])
      fail("scan.truncated"_id, "byte " + std::to_string(m_bytes.size()), "the file ends early",
           TRUNCATED);
    if (m_stride == 0 || sizes[1] % m_stride != 0 || sizes[1] / m_stride != m_points)
      fail("scan.malformed"_id, "byte " + std::to_string(m_at),
           "the data are not of the header's size");
    if (sizes[1] / MOST_EXPANSION > sizes[0])
      fail("scan.malformed"_id, "byte " + std::to_string(m_at), "the compressed data are broken",
           TRUNCATED);
    std::string data(sizes[1], '\0');
    if (!expand_lzf(m_bytes.substr(m_at, sizes[0]), data))
      fail("scan.malformed"_id, "byte " + std::to_string(m_at), "the compressed data are broken",
           TRUNCATED);
    read_points(data, true);
  }

  std::string place() const { return "line " + std::to_string(m_line); }
  [[noreturn]] void fail(MessageId id, const std::string& where, const std::string& fact,
                         const std::string& next_step = {}) const {
    throw input_error(id, m_name, where, fact, next_step);
  }

  std::string_view m_bytes;
  std::string m_name, m_data;
  std::vector<Field> m_fields;
  std::array<int, 3> m_axis = {-1, -1, -1}; ///< field of x, y and z
  std::size_t m_at = 0, m_line = 0, m_width = 0, m_height = 1, m_points = 0, m_stride = 0;
  TriangleMesh m_mesh;
};

} // namespace

TriangleMesh parse_pcd(std::string_view bytes, const std::string& name) {
  return PcdReader(bytes, name).run();
}

} // namespace sloper::io

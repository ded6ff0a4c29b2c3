#include <sloper/base/error.hpp>
#include <sloper/io/scan_reader.hpp>

#include <bit>
#include <cstdint>
#include <cstring>

namespace sloper::io {

namespace {

static_assert(std::endian::native == std::endian::little,
              "binary scans are read on little-endian machines");

enum Chunk : std::uint16_t {
  MAIN = 0x4D4D,
  EDITOR = 0x3D3D,
  OBJECT = 0x4000,
  MESH = 0x4100,
  VERTICES = 0x4110,
  FACES = 0x4120
};
constexpr std::size_t POINT_BYTES = 12; // three floats
constexpr std::size_t FACE_BYTES = 8;   // three vertices and flags, two bytes each
constexpr int DEPTH = 8;
constexpr std::size_t HEADER = 6; ///< of a chunk: u16 kind, u32 length with the header

/// Chunks within chunks; of those that hold no mesh only the length is asked.
class ThreeDsReader {
public:
  ThreeDsReader(std::string_view bytes, const std::string& name) : m_bytes(bytes), m_name(name) {}

  TriangleMesh run() {
    if (m_bytes.size() < HEADER || read<std::uint16_t>(0) != MAIN)
      fail("scan.malformed"_id, 0, "does not begin with the main chunk of a 3DS file");
    read_chunks(0, m_bytes.size(), 0);
    return std::move(m_mesh);
  }

private:
  template<class T> T read(std::size_t at) const {
    if (at + sizeof(T) > m_bytes.size())
      fail("scan.truncated"_id, at, "the file ends early", "the copy is probably truncated");
    T value;
    std::memcpy(&value, m_bytes.data() + at, sizeof value);
    return value;
  }

  void read_chunks(std::size_t at, std::size_t end, int depth) {
    if (depth > DEPTH)
      fail("scan.malformed"_id, at, "chunks are nested too deeply for a 3DS file");
    while (at + HEADER <= end) {
      const auto kind = read<std::uint16_t>(at);
      const std::size_t length = read<std::uint32_t>(at + 2);
      if (length < HEADER)
        fail("scan.malformed"_id, at, "a chunk is shorter than its own header");
      if (at + length > end)
        fail("scan.truncated"_id, at, "a chunk extends past the end of its parent",
             "the copy is probably truncated");
      const std::size_t inside = at + HEADER, close = at + length;
      if (kind == MAIN || kind == EDITOR)
        read_chunks(inside, close, depth + 1);
      else if (kind == OBJECT)
        read_object(inside, close, depth);
      else if (kind == MESH) {
        m_first = static_cast<int>(
            m_mesh.positions.size()); // faces count from their own mesh's first vertex
        read_chunks(inside, close, depth + 1);
      } else if (kind == VERTICES)
        read_vertices(inside, close);
      else if (kind == FACES)
        read_faces(inside, close);
      at = close;
    }
  }

  void read_object(std::size_t at, std::size_t end, int depth) {
    while (at < end && m_bytes[at] != '\0')
      ++at; // its name
    read_chunks(at + 1, end, depth + 1);
  }

  void read_vertices(std::size_t at, std::size_t end) {
    const std::size_t n = read<std::uint16_t>(at);
    if (at + 2 + POINT_BYTES * n > end)
      fail("scan.truncated"_id, at,
           "promises " + std::to_string(n) + " vertices, but its chunk ends early");
    for (std::size_t v = 0; v < n; ++v) {
      Vec3 p;
      for (std::size_t axis = 0; axis < 3; ++axis)
        p[static_cast<int>(axis)] = read<float>(at + 2 + POINT_BYTES * v + 4 * axis);
      if (!p.allFinite())
        fail("scan.not-finite"_id, at + 2 + POINT_BYTES * v, "a coordinate is not finite");
      m_mesh.positions.push_back(p);
    }
  }

  void read_faces(std::size_t at, std::size_t end) {
    const std::size_t n = read<std::uint16_t>(at),
                      vertices = m_mesh.positions.size() - static_cast<std::size_t>(m_first);
    if (at + 2 + FACE_BYTES * n > end)
      fail("scan.truncated"_id, at,
           "promises " + std::to_string(n) + " faces, but its chunk ends early");
    for (std::size_t f = 0; f < n; ++f) {
      Triangle t;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t v = read<std::uint16_t>(at + 2 + FACE_BYTES * f + 2 * k);
        if (v >= vertices)
          fail("scan.malformed"_id, at + 2 + FACE_BYTES * f,
               "a face refers to vertex " + std::to_string(v) + ", but there are only " +
                   std::to_string(vertices));
        t[k] = m_first + static_cast<int>(v);
      }
      m_mesh.triangles.push_back(t);
    }
  }

  [[noreturn]] void fail(MessageId id, std::size_t at, const std::string& fact,
                         const std::string& next_step = {}) const {
    throw input_error(id, m_name, "byte " + std::to_string(at), fact, next_step);
  }

  std::string_view m_bytes;
  std::string m_name;
  int m_first = 0;
  TriangleMesh m_mesh;
};

} // namespace

TriangleMesh parse_3ds(std::string_view bytes, const std::string& name) {
  return ThreeDsReader(bytes, name).run();
}

} // namespace sloper::io

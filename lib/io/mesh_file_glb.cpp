#include <sloper/base/error.hpp>
#include <sloper/io/json.hpp>
#include <sloper/io/mesh_file.hpp>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <set>

namespace sloper::io {

namespace {

constexpr std::uint32_t GLB_MAGIC = 0x46546C67, JSON_CHUNK = 0x4E4F534A, BIN_CHUNK = 0x004E4942;
constexpr int BYTE = 5121, SHORT = 5123, INT = 5125, FLOAT = 5126; // component types, unsigned
constexpr int SIGNED_BYTE = 5120, SIGNED_SHORT = 5122; // of normals and textures that are packed
constexpr std::size_t DEEPEST = 1000;                  ///< nodes above a node
constexpr int TRIANGLES = 4, STRIP = 5, FAN = 6;       // modes of a primitive

/// Where the numbers of an accessor stand in the binary chunk.
struct Numbers {
  std::size_t begin = 0, stride = 0, count = 0;
  int component = FLOAT, width = 1;
};

/// A POSITION accessor and what goes with it.
struct GlbVertices {
  int accessor = -1, normal = -1, tangent = -1;
  std::size_t first = 0; ///< of MeshFile::positions
  Mat4 place;            ///< of its node in the scene
};

std::uint32_t u32(const std::string& bytes, std::size_t at) {
  std::uint32_t x;
  std::memcpy(&x, bytes.data() + at, 4);
  return x;
}

class Glb {
public:
  Glb(const std::string& bytes, const std::string& name) : m_name(name) {
    if (bytes.size() < 20 || u32(bytes, 0) != GLB_MAGIC)
      fail("header", "is not a binary glTF");
    if (u32(bytes, 4) != 2)
      fail("header", "is glTF of version " + std::to_string(u32(bytes, 4)), "write it as glTF 2.0");
    std::size_t at = 12;
    const std::size_t json_size = u32(bytes, at);
    if (u32(bytes, at + 4) != JSON_CHUNK || at + 8 + json_size > bytes.size())
      fail("header", "the JSON chunk is not whole", "the copy is probably truncated");
    m_json = parse_json(bytes.substr(at + 8, json_size), name);
    at += 8 + json_size;
    if (at + 8 <= bytes.size() && u32(bytes, at + 4) == BIN_CHUNK) {
      const std::size_t size = u32(bytes, at);
      if (at + 8 + size > bytes.size())
        fail("binary chunk", "is not whole", "the copy is probably truncated");
      m_binary = bytes.substr(at + 8, size);
      m_rest = bytes.substr(at + 8 + size);
    }
    refuse_extensions();
  }

  Json& json() { return m_json; }
  std::string& binary() { return m_binary; }
  Node root() const { return {m_json, m_name}; }

  std::string bytes() const {
    std::string text = m_json.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string out;
    const auto put = [&](std::size_t x) {
      const auto word = static_cast<std::uint32_t>(x);
      out.append(reinterpret_cast<const char*>(&word), 4);
    };
    put(GLB_MAGIC);
    put(2);
    put(12 + 8 + text.size() + (m_binary.empty() ? 0 : 8 + m_binary.size()) + m_rest.size());
    put(text.size());
    put(JSON_CHUNK);
    out += text;
    if (!m_binary.empty()) {
      put(m_binary.size());
      put(BIN_CHUNK);
      out += m_binary;
    }
    return out + m_rest;
  }

  Numbers numbers(int accessor, const char* type, int width) const {
    const Node node = entry("accessors", accessor);
    if (node.has("sparse"))
      node.fail("import.malformed"_id, "is a sparse accessor, which is not read",
                "write the mesh without it");
    Numbers n;
    n.component = node.at("componentType").integer();
    n.width = width;
    if (node.at("type").string() != type)
      node.at("type").fail("import.malformed"_id, std::string("is not ") + type);
    n.count = size_of(node.at("count"));
    const Node view = entry("bufferViews", node.at("bufferView").integer());
    const Node buffer = entry("buffers", view.at("buffer").integer());
    if (buffer.has("uri") || view.at("buffer").integer() != 0)
      buffer.fail("import.malformed"_id, "stands in a file of its own",
                  "write one .glb that holds everything");
    const std::size_t own =
        size_of_component(node.at("componentType")) * static_cast<std::size_t>(width);
    n.begin = size_at(view, "byteOffset") + size_at(node, "byteOffset");
    n.stride = view.has("byteStride") ? size_of(view.at("byteStride")) : own;
    if (n.count == 0 || n.stride < own || n.begin > m_binary.size() || n.count > m_binary.size() ||
        n.begin + (n.count - 1) * n.stride + own > m_binary.size())
      node.fail("import.malformed"_id, "reaches beyond the binary chunk");
    return n;
  }

  /// @param n  unsigned whole numbers or floats
  double read(const Numbers& n, std::size_t i, int k) const {
    const char* at = m_binary.data() + n.begin + i * n.stride;
    const auto as = [&](auto x) {
      std::memcpy(&x, at + static_cast<std::size_t>(k) * sizeof x, sizeof x);
      return x;
    };
    if (n.component == BYTE)
      return as(std::uint8_t{});
    if (n.component == SHORT)
      return as(std::uint16_t{});
    return n.component == INT ? static_cast<double>(as(std::uint32_t{}))
                              : static_cast<double>(as(float{}));
  }

  void write(const Numbers& n, std::size_t i, int k, double x) {
    const auto single = static_cast<float>(x);
    std::memcpy(m_binary.data() + n.begin + i * n.stride + static_cast<std::size_t>(k) * 4, &single,
                4);
  }

  /// Calls visit(mesh, place in the scene, node) for each mesh of the scene.
  void visit_meshes(const std::function<void(int, const Mat4&, const Node&)>& visit) const {
    const Node root = this->root();
    if (!root.has("nodes"))
      fail("", "has no nodes");
    std::vector<int> roots;
    if (root.has("scenes") && root.at("scenes").size() > 0) {
      const Node scene =
          root.at("scenes").at(static_cast<std::size_t>(std::max(0, root.integer("scene", 0))));
      if (scene.has("nodes"))
        for (std::size_t i = 0; i < scene.at("nodes").size(); ++i)
          roots.push_back(scene.at("nodes").at(i).integer());
    } else {
      std::set<int> below;
      for (std::size_t i = 0; i < root.at("nodes").size(); ++i)
        if (root.at("nodes").at(i).has("children"))
          for (std::size_t k = 0; k < root.at("nodes").at(i).at("children").size(); ++k)
            below.insert(root.at("nodes").at(i).at("children").at(k).integer());
      for (std::size_t i = 0; i < root.at("nodes").size(); ++i)
        if (!below.count(static_cast<int>(i)))
          roots.push_back(static_cast<int>(i));
    }
    std::set<int> met;
    for (const int r : roots)
      visit_node(r, Mat4::Identity(), 0, met, visit);
  }

  Node entry(const char* list, int index) const {
    const Node all = root().at(list);
    if (index < 0 || static_cast<std::size_t>(index) >= all.size())
      all.fail("import.malformed"_id, "has no entry " + std::to_string(index));
    return all.at(static_cast<std::size_t>(index));
  }

  [[noreturn]] void fail(const std::string& place, const std::string& fact,
                         const std::string& next_step = {}) const {
    throw input_error("import.malformed"_id, m_name, place, fact, next_step);
  }

private:
  static std::size_t size_of(const Node& node) {
    const int n = node.integer();
    if (n < 0)
      node.fail("import.malformed"_id, "is negative");
    return static_cast<std::size_t>(n);
  }
  static std::size_t size_of_component(const Node& type) {
    switch (type.integer()) {
    case BYTE:
    case SIGNED_BYTE: return sizeof(std::uint8_t);
    case SHORT:
    case SIGNED_SHORT: return sizeof(std::uint16_t);
    case INT:
    case FLOAT: return sizeof(float);
    default: type.fail("import.malformed"_id, "is no component type of glTF");
    }
  }
  static std::size_t size_at(const Node& node, const char* key) {
    return node.has(key) ? size_of(node.at(key)) : 0;
  }

  void refuse_extensions() const {
    const Node root = this->root();
    if (!root.has("extensionsRequired"))
      return;
    for (std::size_t i = 0; i < root.at("extensionsRequired").size(); ++i) {
      const std::string name = root.at("extensionsRequired").at(i).string();
      if (name == "KHR_draco_mesh_compression" || name == "EXT_meshopt_compression" ||
          name == "KHR_mesh_quantization")
        root.at("extensionsRequired")
            .at(i)
            .fail("import.malformed"_id, "the mesh is packed by " + name,
                  "write it without compression");
    }
  }

  void visit_node(int index, const Mat4& above, std::size_t depth, std::set<int>& met,
                  const std::function<void(int, const Mat4&, const Node&)>& visit) const {
    const Node node = entry("nodes", index);
    if (!met.insert(index).second)
      node.fail("import.malformed"_id, "is met twice: the nodes are no tree");
    if (depth > DEEPEST)
      node.fail("import.malformed"_id, "lies below more than 1,000 others");
    const Mat4 place = above * transform_of(node);
    if (node.has("mesh"))
      visit(node.at("mesh").integer(), place, node);
    if (!node.has("children"))
      return;
    for (std::size_t k = 0; k < node.at("children").size(); ++k)
      visit_node(node.at("children").at(k).integer(), place, depth + 1, met, visit);
  }

  static Mat4 transform_of(const Node& node) {
    Mat4 m = Mat4::Identity();
    const auto component = [&](const char* key, std::size_t k, std::size_t n) {
      if (node.at(key).size() != n)
        node.at(key).fail("import.malformed"_id, "needs " + std::to_string(n) + " numbers");
      return node.at(key).at(k).number();
    };
    if (node.has("matrix")) {
      for (std::size_t k = 0; k < 16; ++k)
        m(static_cast<int>(k % 4), static_cast<int>(k / 4)) = component("matrix", k, 16);
      return m;
    }
    Mat3 linear = Mat3::Identity();
    if (node.has("rotation"))
      linear = Eigen::Quaterniond(component("rotation", 3, 4), component("rotation", 0, 4),
                                  component("rotation", 1, 4), component("rotation", 2, 4))
                   .normalized()
                   .toRotationMatrix();
    if (node.has("scale"))
      for (std::size_t k = 0; k < 3; ++k)
        linear.col(static_cast<int>(k)) *= component("scale", k, 3);
    m.topLeftCorner<3, 3>() = linear;
    if (node.has("translation"))
      for (std::size_t k = 0; k < 3; ++k)
        m(static_cast<int>(k), 3) = component("translation", k, 3);
    return m;
  }

  std::string m_name, m_binary, m_rest;
  Json m_json;
};

std::vector<int> corners_of(const Glb& glb, const Node& primitive, std::size_t n_vertices) {
  std::vector<int> corners;
  if (!primitive.has("indices")) {
    for (std::size_t i = 0; i < n_vertices; ++i)
      corners.push_back(static_cast<int>(i));
    return corners;
  }
  const Numbers n = glb.numbers(primitive.at("indices").integer(), "SCALAR", 1);
  if (n.component != BYTE && n.component != SHORT && n.component != INT)
    primitive.at("indices").fail("import.malformed"_id, "are no unsigned whole numbers");
  for (std::size_t i = 0; i < n.count; ++i) {
    const double x = glb.read(n, i, 0);
    if (x >= static_cast<double>(n_vertices))
      primitive.at("indices").fail("import.malformed"_id,
                                   "index " + std::to_string(static_cast<long>(x)) +
                                       " is out of range: there are " + std::to_string(n_vertices) +
                                       " vertices");
    corners.push_back(static_cast<int>(x));
  }
  return corners;
}

/// All POSITION accessors of the scene, with `file` filled where it is given.
std::vector<GlbVertices> read_glb(const Glb& glb, MeshFile* file) {
  std::vector<GlbVertices> all;
  std::map<int, std::size_t> known; // accessor -> index into all
  std::map<int, int> node_of_mesh;
  std::size_t n_positions = 0;
  glb.visit_meshes([&](int mesh_index, const Mat4& place, const Node& node) {
    if (!node_of_mesh.emplace(mesh_index, 0).second)
      node.fail("import.malformed"_id,
                "shows mesh " + std::to_string(mesh_index) + ", as another node does",
                "give each a mesh of its own");
    if (node.has("skin"))
      node.fail("import.malformed"_id, "the mesh has a skeleton, which would move it again",
                "write it without the skeleton, as it is worn");
    if (std::abs(place.topLeftCorner<3, 3>().determinant()) < 1e-18)
      node.fail("import.malformed"_id, "its transform flattens the mesh");
    const Node mesh = glb.entry("meshes", mesh_index);
    for (std::size_t p = 0; p < mesh.at("primitives").size(); ++p) {
      const Node primitive = mesh.at("primitives").at(p);
      const int mode = primitive.integer("mode", TRIANGLES);
      if (mode < TRIANGLES)
        continue; // points and lines
      if (primitive.has("targets") && file)
        file->findings.push_back("mesh " + std::to_string(mesh_index) +
                                 " has morph targets, which are left as they are");
      const Node attributes = primitive.at("attributes");
      GlbVertices vertices;
      vertices.accessor = attributes.at("POSITION").integer();
      const Numbers at = glb.numbers(vertices.accessor, "VEC3", 3);
      if (at.component != FLOAT)
        attributes.at("POSITION").fail("import.malformed"_id, "are no 32 bit floats");
      vertices.normal = attributes.integer("NORMAL", -1);
      vertices.tangent = attributes.integer("TANGENT", -1);
      const auto [found, is_new] = known.emplace(vertices.accessor, all.size());
      if (!is_new && !all[found->second].place.isApprox(place))
        node.fail("import.malformed"_id,
                  "shares its vertices with a mesh that stands elsewhere in the scene",
                  "give each mesh vertices of its own");
      if (is_new) {
        vertices.first = n_positions;
        vertices.place = place;
        n_positions += at.count;
        all.push_back(vertices);
      }
      if (!file)
        continue;
      const std::size_t first = all[found->second].first;
      if (is_new) {
        const bool has_texture = attributes.has("TEXCOORD_0");
        std::optional<Numbers> uv;
        if (has_texture)
          uv = glb.numbers(attributes.at("TEXCOORD_0").integer(), "VEC2", 2);
        for (std::size_t i = 0; i < at.count; ++i) {
          const Vec3 x(glb.read(at, i, 0), glb.read(at, i, 1), glb.read(at, i, 2));
          file->positions.push_back((place * x.homogeneous()).head<3>());
          const bool known_uv = uv && uv->component == FLOAT && i < uv->count;
          file->texture.push_back(known_uv ? Vec2(glb.read(*uv, i, 0), 1 - glb.read(*uv, i, 1))
                                           : Vec2(Vec2::Zero()));
        }
      }
      const std::vector<int> corners = corners_of(glb, primitive, at.count);
      const auto add = [&](int a, int b, int c) {
        const int o = static_cast<int>(first);
        file->faces.push_back({o + a, o + b, o + c});
      };
      if (mode == TRIANGLES)
        for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
          add(corners[i], corners[i + 1], corners[i + 2]);
      for (std::size_t i = 0; mode == STRIP && i + 2 < corners.size(); ++i)
        i % 2 == 0 ? add(corners[i], corners[i + 1], corners[i + 2])
                   : add(corners[i + 1], corners[i], corners[i + 2]);
      for (std::size_t i = 1; mode == FAN && i + 1 < corners.size(); ++i)
        add(corners[0], corners[i], corners[i + 1]);
    }
  });
  return all;
}

} // namespace

MeshFile parse_glb_mesh(std::string bytes, const std::string& name) {
  MeshFile file;
  file.name = name;
  file.format = "glb";
  const Glb glb(bytes, name);
  if (read_glb(glb, &file).empty())
    throw input_error("import.no-faces"_id, name, "", "no node of its scene holds a mesh");
  file.face_texture = file.faces; // texture stands at the vertices
  bool has_texture = false;
  for (const Vec2& uv : file.texture)
    has_texture |= !uv.isZero();
  if (!has_texture) {
    file.texture.clear();
    file.face_texture.clear();
  }
  file.bytes = std::move(bytes);
  return file;
}

std::string moved_glb_mesh(const MeshFile& file, const std::vector<Vec3>& positions,
                           const std::vector<Mat3>& turned) {
  Glb glb(file.bytes, file.name);
  std::set<int> turned_accessors;
  for (const GlbVertices& vertices : read_glb(glb, nullptr)) {
    const Numbers at = glb.numbers(vertices.accessor, "VEC3", 3);
    const Mat4 back = vertices.place.inverse();
    const Mat3 out = vertices.place.topLeftCorner<3, 3>(), in = back.topLeftCorner<3, 3>();
    Vec3 low = Vec3::Constant(1e300), high = -low;
    for (std::size_t i = 0; i < at.count; ++i) {
      const Vec3 x = (back * positions[vertices.first + i].homogeneous()).head<3>();
      for (int k = 0; k < 3; ++k) {
        glb.write(at, i, k, x[k]);
        const double kept = static_cast<float>(x[k]);
        low[k] = std::min(low[k], kept);
        high[k] = std::max(high[k], kept);
      }
    }
    Json& accessor = glb.json()["accessors"][vertices.accessor];
    accessor["min"] = {low[0], low[1], low[2]};
    accessor["max"] = {high[0], high[1], high[2]};
    const auto turn = [&](int index, const char* type, int width) {
      if (index < 0 || !turned_accessors.insert(index).second)
        return;
      const Numbers n = glb.numbers(index, type, width);
      if (n.component != FLOAT)
        return;
      for (std::size_t i = 0; i < n.count && i < at.count; ++i) {
        const Vec3 own(glb.read(n, i, 0), glb.read(n, i, 1), glb.read(n, i, 2));
        // Normals go out by the inverse transpose and come back by the transpose; both are
        // directions here, since a node's scale is rarely uneven: length is restored.
        const Vec3 moved = (in * (turned[vertices.first + i] * (out * own))).normalized();
        for (int k = 0; k < 3 && moved.allFinite(); ++k)
          glb.write(n, i, k, moved[k]);
      }
    };
    turn(vertices.normal, "VEC3", 3);
    turn(vertices.tangent, "VEC4", 4);
  }
  return glb.bytes();
}

} // namespace sloper::io

#include <render/srgb.hpp>
#include <sloper/base/error.hpp>
#include <sloper/base/version.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/json.hpp>
#include <sloper/render/export.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace sloper::render {

namespace {

// Numbers of OpenGL that glTF 2.0 takes over: types of components, and what a view is for.
constexpr int GLTF_UNSIGNED_SHORT = 5123, GLTF_UNSIGNED_INT = 5125, GLTF_FLOAT = 5126;
constexpr int GLTF_ARRAY = 34962, GLTF_ELEMENTS = 34963;
constexpr std::size_t GLB_HEADER = 12, GLB_CHUNK_HEADER = 8; // bytes
constexpr double SKIN_ROUGHNESS = 0.7, CLOTH_ROUGHNESS = 0.9;

std::string extension(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  return dot == std::string::npos || path.find('/', dot) != std::string::npos
             ? ""
             : path.substr(dot + 1);
}

Vec3 shown_color(const DrawMesh& mesh, std::size_t v, const Legend& legend) {
  if (mesh.values.empty() || legend.steps.empty())
    return mesh.colors[v];
  if (mesh.values[v] == NO_VALUE)
    return no_value_color();
  const double t =
      std::clamp((mesh.values[v] - legend.low) / (legend.high - legend.low), 0.0, 0.9999);
  return legend.steps[static_cast<std::size_t>(t * static_cast<double>(legend.steps.size()))];
}

template<class T> void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void append_number(std::string& text, double x) {
  char buffer[32];
  text.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, static_cast<float>(x)).ptr);
}

/// The binary chunk of a GLB and its description, filled array by array.
class GlbBuffer {
public:
  std::string bytes;
  io::Json views = io::Json::array(), accessors = io::Json::array();
  /// @param target  GLTF_ARRAY for vertices, GLTF_ELEMENTS for indices
  int add(const void* data, std::size_t n_bytes, std::size_t count, int component, const char* type,
          int target) {
    views.push_back(
        {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", n_bytes}, {"target", target}});
    bytes.append(static_cast<const char*>(data), n_bytes);
    bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
    accessors.push_back({{"bufferView", views.size() - 1},
                         {"componentType", component},
                         {"count", count},
                         {"type", type}});
    return static_cast<int>(accessors.size()) - 1;
  }
  /// Bytes that are no numbers of the scene. @returns their view
  std::size_t add_bytes(const std::string& data) {
    views.push_back({{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", data.size()}});
    bytes += data;
    bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
    return views.size() - 1;
  }
  int add_floats(const std::vector<float>& data, int width, const char* type) {
    return add(data.data(), data.size() * sizeof(float), data.size() / width, GLTF_FLOAT, type,
               GLTF_ARRAY);
  }
};

/// @param skin   of the rig, or null   @param print_size  of the printed cloth, or 0
io::Json add_mesh(GlbBuffer& buffer, const DrawMesh& mesh, const Legend& legend,
                  const Rig::Skin* skin, double print_size) {
  const bool printed = print_size > 0 && !mesh.uv.empty();
  std::vector<float> positions, normals, colors, uv;
  Eigen::Vector3f low = Eigen::Vector3f::Constant(std::numeric_limits<float>::max()), high = -low;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Eigen::Vector3f p = mesh.positions[v].cast<float>();
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
    const Vec3 c =
        printed ? Vec3::Ones() : shown_color(mesh, v, legend); // a texture is multiplied by it
    const Vec3 n =
        mesh.normals[v].norm() > 0.5 ? mesh.normals[v] : Vec3(0, 1, 0); // glTF wants unit normals
    for (int k = 0; k < 3; ++k) {
      positions.push_back(p[k]);
      normals.push_back(static_cast<float>(n[k]));
      colors.push_back(static_cast<float>(c[k]));
    }
    if (mesh.uv.empty())
      continue;
    uv.push_back(static_cast<float>(mesh.uv[v].x() / (printed ? print_size : 1)));
    uv.push_back(static_cast<float>(-mesh.uv[v].y() / (printed ? print_size : 1)));
  }
  std::vector<std::uint32_t> indices;
  for (const Triangle& t : mesh.triangles)
    indices.insert(indices.end(), t.begin(), t.end());
  io::Json attributes;
  attributes["POSITION"] = buffer.add_floats(positions, 3, "VEC3");
  buffer.accessors.back()["min"] = {low.x(), low.y(), low.z()};
  buffer.accessors.back()["max"] = {high.x(), high.y(), high.z()};
  attributes["NORMAL"] = buffer.add_floats(normals, 3, "VEC3");
  attributes["COLOR_0"] = buffer.add_floats(colors, 3, "VEC3");
  if (!uv.empty())
    attributes["TEXCOORD_0"] = buffer.add_floats(uv, 2, "VEC2");
  if (skin) {
    std::vector<std::uint16_t> joints;
    std::vector<float> weights;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
      for (int k = 0; k < 4; ++k) {
        joints.push_back(static_cast<std::uint16_t>(skin->joint[v][k]));
        weights.push_back(static_cast<float>(skin->weight[v][k]));
      }
    attributes["JOINTS_0"] =
        buffer.add(joints.data(), joints.size() * sizeof(std::uint16_t), mesh.positions.size(),
                   GLTF_UNSIGNED_SHORT, "VEC4", GLTF_ARRAY);
    attributes["WEIGHTS_0"] = buffer.add_floats(weights, 4, "VEC4");
  }
  const int elements = buffer.add(indices.data(), indices.size() * sizeof(std::uint32_t),
                                  indices.size(), GLTF_UNSIGNED_INT, "SCALAR", GLTF_ELEMENTS);
  int material = mesh.is_cloth ? 1 : 0;
  if (printed)
    material = 2;
  return {{"name", mesh.name},
          {"primitives",
           {{{"attributes", attributes}, {"indices", elements}, {"material", material}}}}};
}

/// Joint nodes after `nodes`, each placed from its parent's, and the skin that names them. In the
/// bind pose nothing is turned, so that a joint's inverse matrix only moves its head to the origin.
io::Json add_skin(GlbBuffer& buffer, io::Json& nodes, const Rig& rig) {
  const std::size_t first = nodes.size();
  std::vector<float> inverse;
  io::Json joints = io::Json::array();
  for (std::size_t j = 0; j < rig.names.size(); ++j) {
    const Vec3 from = rig.parent[j] < 0 ? Vec3(0, 0, 0) : rig.head[rig.parent[j]],
               at = rig.head[j] - from;
    io::Json children = io::Json::array();
    for (std::size_t k = j + 1; k < rig.names.size(); ++k)
      if (rig.parent[k] == static_cast<int>(j))
        children.push_back(first + k);
    nodes.push_back({{"name", rig.names[j]}, {"translation", {at.x(), at.y(), at.z()}}});
    if (!children.empty())
      nodes.back()["children"] = children;
    joints.push_back(first + j);
    Mat4 matrix = Mat4::Identity();
    matrix.block<3, 1>(0, 3) = -rig.head[j];
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 4; ++row)
        inverse.push_back(static_cast<float>(matrix(row, column)));
  }
  const int matrices = buffer.add_floats(inverse, 4 * 4, "MAT4");
  buffer.views.back().erase("target"); // no vertex attribute
  return {{"skeleton", first}, {"joints", joints}, {"inverseBindMatrices", matrices}};
}

std::string obj_text(const std::vector<DrawMesh>& meshes, const std::string& material_file) {
  std::string text =
      "# " + generator_stamp("render-png") + ", m, y up\nmtllib " + material_file + "\n";
  auto line = [&](const char* key, std::initializer_list<double> numbers) {
    text += key;
    for (double x : numbers) {
      text += ' ';
      append_number(text, x);
    }
    text += '\n';
  };
  std::size_t v0 = 1, t0 = 1;
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const DrawMesh& mesh = meshes[m];
    text += "o " + mesh.name + "\nusemtl mesh" + std::to_string(m + 1) + "\n";
    for (const Vec3& p : mesh.positions)
      line("v", {p.x(), p.y(), p.z()});
    for (const Vec2& p : mesh.uv)
      line("vt", {p.x(), p.y()});
    for (const Vec3& n : mesh.normals)
      line("vn", {n.x(), n.y(), n.z()});
    for (const Triangle& t : mesh.triangles) {
      text += 'f';
      for (int v : t) {
        const std::string at = std::to_string(v0 + static_cast<std::size_t>(v));
        text += " " + at + "/" +
                (mesh.uv.empty() ? "" : std::to_string(t0 + static_cast<std::size_t>(v))) + "/" +
                at;
      }
      text += '\n';
    }
    v0 += mesh.positions.size();
    t0 += mesh.uv.size();
  }
  return text;
}

std::string mtl_text(const std::vector<DrawMesh>& meshes) {
  std::string text;
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    text += "newmtl mesh" + std::to_string(m + 1) + "\nKd";
    for (int k = 0; k < 3; ++k) {
      text += ' ';
      append_number(text, meshes[m].colors.empty() ? 0.8 : to_srgb(meshes[m].colors[0][k]));
    }
    text += "\nKs 0 0 0\nillum 1\n";
  }
  return text;
}

std::string ply_bytes(const std::vector<DrawMesh>& meshes, const Legend& legend) {
  std::size_t n_vertices = 0, n_faces = 0;
  for (const DrawMesh& mesh : meshes) {
    n_vertices += mesh.positions.size();
    n_faces += mesh.triangles.size();
  }
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\ncomment " + generator_stamp("render-png") +
      ", m, y up" +
      (legend.title.empty() ? "" : "; value is " + legend.title + ", " + legend.unit) +
      "\nelement vertex " + std::to_string(n_vertices) +
      "\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float "
      "ny\nproperty float nz\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty float "
      "value\nelement face " +
      std::to_string(n_faces) + "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const DrawMesh& mesh : meshes)
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      for (const Vec3& p : {mesh.positions[v], mesh.normals[v]})
        for (int k = 0; k < 3; ++k)
          append(bytes, static_cast<float>(p[k]));
      const Vec3 c = shown_color(mesh, v, legend);
      for (int k = 0; k < 3; ++k)
        append(bytes,
               static_cast<std::uint8_t>(std::lround(255 * std::clamp(to_srgb(c[k]), 0.0, 1.0))));
      append(bytes, mesh.values.empty() || mesh.values[v] == NO_VALUE
                        ? std::numeric_limits<float>::quiet_NaN()
                        : static_cast<float>(mesh.values[v]));
    }
  int base = 0;
  for (const DrawMesh& mesh : meshes) {
    for (const Triangle& t : mesh.triangles) {
      append(bytes, static_cast<std::uint8_t>(3));
      for (int v : t)
        append(bytes, static_cast<std::int32_t>(base + v));
    }
    base += static_cast<int>(mesh.positions.size());
  }
  return bytes;
}

} // namespace

std::string values_ply(const Scene& scene, const Legend& legend) {
  std::vector<DrawMesh> cloth;
  for (int mesh : scene.garment_mesh)
    cloth.push_back(scene.meshes[mesh]);
  return ply_bytes(cloth, legend);
}

bool is_export(const std::string& path) {
  const std::string e = extension(path);
  return e == "glb" || e == "obj" || e == "ply";
}

std::string glb_bytes(const std::vector<DrawMesh>& meshes, const Legend& legend, const Rig* rig,
                      const Print* print) {
  if (!legend.steps.empty())
    print = nullptr; // the map's colours are shown
  GlbBuffer buffer;
  io::Json document = {
      {"asset", {{"version", "2.0"}, {"generator", generator_stamp("render-png")}}}, {"scene", 0}};
  io::Json nodes = io::Json::array(), drawn = io::Json::array(), roots = io::Json::array();
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    if (meshes[m].triangles.empty())
      continue;
    nodes.push_back({{"name", meshes[m].name}, {"mesh", drawn.size()}});
    roots.push_back(drawn.size());
    const Rig::Skin* skin = rig && !rig->skins[m].joint.empty() ? &rig->skins[m] : nullptr;
    if (skin)
      nodes.back()["skin"] = 0;
    drawn.push_back(add_mesh(buffer, meshes[m], legend, skin, print ? print->size : 0));
  }
  if (rig) {
    roots.push_back(nodes.size()); // the root joint
    document["skins"] = {add_skin(buffer, nodes, *rig)};
  }
  document["scenes"] = {{{"nodes", roots}}};
  document["nodes"] = nodes;
  document["meshes"] = drawn;
  auto material = [](const char* name, double roughness, bool two_sided) {
    return io::Json{
        {"name", name},
        {"doubleSided", two_sided},
        {"pbrMetallicRoughness", {{"metallicFactor", 0.0}, {"roughnessFactor", roughness}}}};
  };
  document["materials"] = {material("skin", SKIN_ROUGHNESS, false),
                           material("cloth", CLOTH_ROUGHNESS, true)};
  if (print) {
    document["materials"].push_back(material("printed cloth", CLOTH_ROUGHNESS, true));
    document["materials"].back()["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    document["textures"] = {{{"source", 0}}}; // without a sampler it repeats
    document["images"] = {{{"mimeType", "image/png"},
                           {"bufferView", buffer.add_bytes(io::png_bytes(print->image, {}))}}};
  }
  document["accessors"] = buffer.accessors;
  document["bufferViews"] = buffer.views;
  document["buffers"] = {{{"byteLength", buffer.bytes.size()}}};
  std::string text = document.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string bytes = "glTF";
  append(bytes, std::uint32_t{2});
  append(bytes, static_cast<std::uint32_t>(GLB_HEADER + GLB_CHUNK_HEADER + text.size() +
                                           GLB_CHUNK_HEADER + buffer.bytes.size()));
  append(bytes, static_cast<std::uint32_t>(text.size()));
  bytes += "JSON" + text;
  append(bytes, static_cast<std::uint32_t>(buffer.bytes.size()));
  bytes += std::string("BIN\0", 4) + buffer.bytes;
  return bytes;
}

void export_scene(const std::string& path, const std::vector<DrawMesh>& meshes,
                  const Legend& legend, const Rig* rig, const Print* print) {
  const std::string e = extension(path);
  if (e == "glb") {
    io::write_file(path, glb_bytes(meshes, legend, rig, print));
  } else if (e == "ply") {
    io::write_file(path, ply_bytes(meshes, legend));
  } else if (e == "obj") {
    const std::string materials = path.substr(0, path.size() - 3) + "mtl";
    io::write_file(materials, mtl_text(meshes));
    io::write_file(path, obj_text(meshes, io::file_name(materials)));
  } else {
    throw Error(ErrorKind::USAGE, "option.unknown-ending"_id, "", "-o " + path,
                "is no kind of file that can be written", "end it in .png, .glb, .obj or .ply");
  }
}

} // namespace sloper::render

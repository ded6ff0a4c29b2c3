#include <sloper/io/mesh_file.hpp>

#include <sloper/base/error.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/json_fwd.hpp>

#include <algorithm>
#include <filesystem>
#include <optional>

namespace sloper::io {

namespace {

std::string mesh_format_of(const std::string& path) {
  std::string ending = ending_of(path);
  if (!ending.empty())
    ending.erase(0, 1);
  for (const char* known : {"obj", "ply", "glb"})
    if (ending == known)
      return ending;
  return {};
}

/// Names of the textures that a material file uses, each once: the last word of its map lines.
std::vector<std::string> textures_of(const std::string& text) {
  std::vector<std::string> names;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string line = text.substr(at, end - at);
    at = end + 1;
    line.erase(line.find_last_not_of(" \t\r") + 1);
    line.erase(0, std::min(line.find_first_not_of(" \t"), line.size()));
    const bool is_map = line.rfind("map_", 0) == 0 || line.rfind("bump", 0) == 0 ||
                        line.rfind("disp", 0) == 0 || line.rfind("norm", 0) == 0 ||
                        line.rfind("refl", 0) == 0 || line.rfind("decal", 0) == 0;
    const std::size_t space = line.find_last_of(" \t");
    if (!is_map || space == std::string::npos)
      continue;
    const std::string name = line.substr(space + 1);
    if (std::find(names.begin(), names.end(), name) == names.end())
      names.push_back(name);
  }
  return names;
}

} // namespace

std::vector<std::string> copy_companions(const MeshFile& file, const std::string& to) {
  namespace fs = std::filesystem;
  std::vector<std::string> left;
  std::error_code error;
  const fs::path from = fs::absolute(file.name, error).parent_path(),
                 into = fs::absolute(to, error).parent_path();
  if (fs::equivalent(from, into, error))
    return left;
  std::vector<std::string> names = file.companions;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const fs::path name(names[i]);
    const bool leaves =
        name.is_absolute() || std::find(name.begin(), name.end(), "..") != name.end();
    if (leaves) {
      left.push_back(names[i] + " stands elsewhere and is not copied");
      continue;
    }
    const std::optional<std::string> bytes = read_file_if_there((from / name).string());
    if (!bytes) {
      left.push_back(names[i] + " is not there");
      continue;
    }
    if (ending_of(names[i]) == ".mtl")
      for (const std::string& texture : textures_of(*bytes))
        names.push_back(texture);
    if (fs::exists(into / name, error))
      continue;
    fs::create_directories((into / name).parent_path(), error);
    write_file((into / name).string(), *bytes);
  }
  return left;
}

bool is_mesh_file(const std::string& path) {
  return !mesh_format_of(path).empty();
}

MeshFile parse_mesh_file(std::string bytes, const std::string& format, const std::string& name) {
  MeshFile file;
  if (format == "obj")
    file = parse_obj_mesh(std::move(bytes), name);
  else if (format == "ply")
    file = parse_ply_mesh(std::move(bytes), name);
  else if (format == "glb")
    file = parse_glb_mesh(std::move(bytes), name);
  else
    throw Error(ErrorKind::INTERNAL, "general.internal"_id, name, "",
                "no reader for \"" + format + "\"");
  for (std::size_t v = 0; v < file.positions.size(); ++v)
    if (!file.positions[v].allFinite())
      throw input_error("import.malformed"_id, name, "vertex " + std::to_string(v + 1),
                        "a coordinate is not finite");
  for (std::size_t f = 0; f < file.faces.size(); ++f) {
    if (file.faces[f].size() < 3)
      throw input_error("import.malformed"_id, name, "face " + std::to_string(f + 1),
                        "has fewer than three corners");
    for (const int v : file.faces[f])
      if (v < 0 || static_cast<std::size_t>(v) >= file.positions.size())
        throw input_error("import.malformed"_id, name, "face " + std::to_string(f + 1),
                          "refers to a vertex that the file does not have: it has " +
                              std::to_string(file.positions.size()));
  }
  if (file.faces.empty())
    throw input_error("import.no-faces"_id, name, "", "has no faces",
                      "a garment is a surface: export it as a mesh");
  return file;
}

MeshFile read_mesh_file(const std::string& path) {
  const std::string format = mesh_format_of(path);
  if (format.empty())
    throw input_error("import.unknown-format"_id, path, "", "is no mesh of a known format",
                      "give an OBJ, PLY or GLB");
  return parse_mesh_file(read_file(path), format, path);
}

std::string moved_mesh_file(const MeshFile& file, const std::vector<Vec3>& positions,
                            const std::vector<Mat3>& turned) {
  if (positions.size() != file.positions.size() || turned.size() != positions.size())
    throw Error(ErrorKind::INTERNAL, "general.internal"_id, file.name, "",
                "positions of another mesh");
  if (file.format == "obj")
    return moved_obj_mesh(file, positions, turned);
  if (file.format == "ply")
    return moved_ply_mesh(file, positions, turned);
  return moved_glb_mesh(file, positions, turned);
}

} // namespace sloper::io

#include <base/error.hpp>
#include <io/assimp_reader.hpp>

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <map>

namespace sloper::io {

namespace {

constexpr const char* EXTENSIONS[] = {"glb", "gltf", "fbx", "dae", "off", "x3d", "wrl"};
constexpr unsigned LONGEST_S = 60;

/// What the child tells: sizes, then positions and corners, or the length of a complaint and its
/// text.
struct Header {
  std::size_t positions = 0, triangles = 0, complaint = 0;
};

void write_all(int to, const void* data, std::size_t size) {
  for (const char* at = static_cast<const char*>(data); size > 0;) {
    const ssize_t n = ::write(to, at, size);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) ::_exit(1);
    at += n;
    size -= static_cast<std::size_t>(n);
  }
}

bool read_all(int from, void* data, std::size_t size) {
  for (char* at = static_cast<char*>(data); size > 0;) {
    const ssize_t n = ::read(from, at, size);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    at += n;
    size -= static_cast<std::size_t>(n);
  }
  return true;
}

TriangleMesh import(const std::string& path, std::string& complaint) {
  TriangleMesh mesh;
  Assimp::Importer importer;
  const aiScene* scene =
      importer.ReadFile(path, aiProcess_Triangulate | aiProcess_PreTransformVertices);
  if (!scene || scene->mNumMeshes == 0) {
    complaint = importer.GetErrorString();
    if (complaint.empty()) complaint = "it holds no mesh";
    return mesh;
  }
  std::map<std::array<double, 3>, int> known;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& part = *scene->mMeshes[m];
    std::vector<int> index;
    for (unsigned v = 0; v < part.mNumVertices; ++v) {
      const std::array<double, 3> p{part.mVertices[v].x, part.mVertices[v].y, part.mVertices[v].z};
      const auto [at, is_new] = known.emplace(p, static_cast<int>(mesh.positions.size()));
      if (is_new) mesh.positions.emplace_back(p[0], p[1], p[2]);
      index.push_back(at->second);
    }
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      if (face.mNumIndices != 3) continue; // points and lines
      if (*std::max_element(face.mIndices, face.mIndices + 3) >= part.mNumVertices) {
        complaint = "face " + std::to_string(f) + " of mesh " + std::to_string(m) +
                    " refers to a vertex that does not exist";
        return mesh;
      }
      mesh.triangles.push_back(
          {index[face.mIndices[0]], index[face.mIndices[1]], index[face.mIndices[2]]});
    }
  }
  return mesh;
}

[[noreturn]] void import_and_tell(const std::string& path, int to) {
  ::alarm(LONGEST_S);
  std::string complaint;
  TriangleMesh mesh;
  try {
    mesh = import(path, complaint);
  } catch (const std::exception& e) {
    complaint = e.what();
  }
  const Header header{mesh.positions.size(), mesh.triangles.size(), complaint.size()};
  write_all(to, &header, sizeof header);
  write_all(to, complaint.data(), complaint.size());
  write_all(to, mesh.positions.data(), mesh.positions.size() * sizeof(Vec3));
  write_all(to, mesh.triangles.data(), mesh.triangles.size() * sizeof(Triangle));
  ::_exit(0);
}

} // namespace

bool is_read_by_assimp(const std::string& extension) {
  return std::find(std::begin(EXTENSIONS), std::end(EXTENSIONS), extension) != std::end(EXTENSIONS);
}

TriangleMesh read_with_assimp(const std::string& path, const std::string& extension) {
  int pipe[2];
  if (::pipe(pipe) != 0)
    throw Error(ErrorKind::INTERNAL, path, "",
                std::string("no pipe could be made: ") + std::strerror(errno));
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(pipe[0]);
    import_and_tell(path, pipe[1]);
  }
  ::close(pipe[1]);
  TriangleMesh mesh;
  std::string complaint;
  Header header;
  bool whole = child > 0 && read_all(pipe[0], &header, sizeof header);
  if (whole) {
    complaint.resize(header.complaint);
    mesh.positions.resize(header.positions);
    mesh.triangles.resize(header.triangles);
    whole = read_all(pipe[0], complaint.data(), complaint.size()) &&
            read_all(pipe[0], mesh.positions.data(), mesh.positions.size() * sizeof(Vec3)) &&
            read_all(pipe[0], mesh.triangles.data(), mesh.triangles.size() * sizeof(Triangle));
  }
  ::close(pipe[0]);
  int status = 0;
  while (child > 0 && ::waitpid(child, &status, 0) < 0 && errno == EINTR) {}
  const std::string next = "export it as OBJ or PLY";
  if (child < 0)
    throw Error(ErrorKind::INTERNAL, path, "",
                std::string("no process could be started: ") + std::strerror(errno));
  if (!whole && WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM)
    throw input_error(path, "", "was not read within " + std::to_string(LONGEST_S) + " s", next);
  if (!whole)
    throw input_error(path, "", "is damaged: it crashes the reader of " + extension + " (assimp)",
                      next);
  if (!complaint.empty())
    throw input_error(path, "", "cannot be read as " + extension + ": " + complaint, next);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    if (!mesh.positions[v].allFinite())
      throw input_error(path, "vertex " + std::to_string(v), "a coordinate is not finite");
  return mesh;
}

} // namespace sloper::io

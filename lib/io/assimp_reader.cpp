#include <io/assimp_reader.hpp>
#include <sloper/base/error.hpp>

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
    if (n < 0 && errno == EINTR)
      continue;
    if (n <= 0)
      ::_exit(1);
    at += n;
    size -= static_cast<std::size_t>(n);
  }
}

bool read_all(int from, void* data, std::size_t size) {
  for (char* at = static_cast<char*>(data); size > 0;) {
    const ssize_t n = ::read(from, at, size);
    if (n < 0 && errno == EINTR)
      continue;
    if (n <= 0)
      return false;
    at += n;
    size -= static_cast<std::size_t>(n);
  }
  return true;
}

/// Nodes by their names, with what takes each into the scene.
void gather_nodes(const aiNode& node, const aiMatrix4x4& above,
                  std::vector<std::pair<const aiNode*, aiMatrix4x4>>& nodes) {
  nodes.emplace_back(&node, above * node.mTransformation);
  const aiMatrix4x4 own = nodes.back().second;
  for (unsigned k = 0; k < node.mNumChildren; ++k)
    gather_nodes(*node.mChildren[k], own, nodes);
}

/// Where the vertices of a mesh that hangs at a node with the transform `own` are in the scene. A
/// mesh with a skin is where its joints put it, whatever its own node says (glTF 2.0, 3.7.3.2):
/// x = sum_j w_j G_j B_j v, with G_j of the joint's node and B_j its inverse bind matrix.
std::vector<aiVector3D> placed(const aiMesh& mesh, const aiMatrix4x4& own,
                               const std::map<std::string, aiMatrix4x4>& joints) {
  std::vector<aiVector3D> positions(mesh.mNumVertices, aiVector3D(0, 0, 0));
  std::vector<ai_real> weight(mesh.mNumVertices, 0);
  for (unsigned b = 0; b < mesh.mNumBones; ++b) {
    const aiBone& bone = *mesh.mBones[b];
    const auto joint = joints.find(bone.mName.C_Str());
    if (joint == joints.end())
      continue;
    const aiMatrix4x4 moves = joint->second * bone.mOffsetMatrix;
    for (unsigned k = 0; k < bone.mNumWeights; ++k) {
      const aiVertexWeight& of = bone.mWeights[k];
      if (of.mVertexId >= mesh.mNumVertices)
        continue;
      positions[of.mVertexId] += of.mWeight * (moves * mesh.mVertices[of.mVertexId]);
      weight[of.mVertexId] += of.mWeight;
    }
  }
  for (unsigned v = 0; v < mesh.mNumVertices; ++v)
    if (weight[v] > 0)
      positions[v] /= weight[v];
    else
      positions[v] = own * mesh.mVertices[v];
  return positions;
}

/// The vertices as they were bound, which needs no joint.
std::vector<aiVector3D> bound(const aiMesh& mesh, const aiMatrix4x4& own) {
  std::vector<aiVector3D> positions;
  positions.reserve(mesh.mNumVertices);
  for (unsigned v = 0; v < mesh.mNumVertices; ++v)
    positions.push_back(own * mesh.mVertices[v]);
  return positions;
}

/// Adds a mesh at its place; false, with a complaint, where it is broken.
bool add_mesh(const aiMesh& part, const std::vector<aiVector3D>& positions, bool mirrored,
              std::map<std::array<double, 3>, int>& known, TriangleMesh& mesh,
              std::string& complaint) {
  std::vector<int> index;
  for (const aiVector3D& at : positions) {
    const std::array<double, 3> p{at.x, at.y, at.z};
    const auto [place, is_new] = known.emplace(p, static_cast<int>(mesh.positions.size()));
    if (is_new)
      mesh.positions.emplace_back(p[0], p[1], p[2]);
    index.push_back(place->second);
  }
  for (unsigned f = 0; f < part.mNumFaces; ++f) {
    const aiFace& face = part.mFaces[f];
    if (face.mNumIndices != 3)
      continue; // points and lines
    if (*std::max_element(face.mIndices, face.mIndices + 3) >= part.mNumVertices) {
      complaint = "face " + std::to_string(f) + " refers to a vertex that does not exist";
      return false;
    }
    Triangle t = {index[face.mIndices[0]], index[face.mIndices[1]], index[face.mIndices[2]]};
    if (mirrored)
      std::swap(t[1], t[2]);
    mesh.triangles.push_back(t);
  }
  return true;
}

TriangleMesh import(const std::string& path, SkinPose pose, std::string& complaint) {
  TriangleMesh mesh;
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path, aiProcess_Triangulate);
  if (!scene || scene->mNumMeshes == 0 || !scene->mRootNode) {
    complaint = importer.GetErrorString();
    if (complaint.empty())
      complaint = "it holds no mesh";
    return mesh;
  }
  std::vector<std::pair<const aiNode*, aiMatrix4x4>> nodes;
  gather_nodes(*scene->mRootNode, aiMatrix4x4(), nodes);
  std::map<std::string, aiMatrix4x4> joints;
  for (const auto& [node, own] : nodes)
    joints.emplace(node->mName.C_Str(), own);
  std::map<std::array<double, 3>, int> known;
  for (const auto& [node, own] : nodes)
    for (unsigned k = 0; k < node->mNumMeshes; ++k) {
      if (node->mMeshes[k] >= scene->mNumMeshes)
        continue;
      const aiMesh& part = *scene->mMeshes[node->mMeshes[k]];
      const bool mirrored = part.mNumBones == 0 && aiMatrix4x4(own).Determinant() < 0;
      const std::vector<aiVector3D> positions =
          pose == SkinPose::BIND ? bound(part, own) : placed(part, own, joints);
      if (!add_mesh(part, positions, mirrored, known, mesh, complaint))
        return mesh;
    }
  if (mesh.positions.empty())
    complaint = "no node of its scene holds a mesh";
  return mesh;
}

[[noreturn]] void import_and_tell(const std::string& path, SkinPose pose, int to) {
  ::alarm(LONGEST_S);
  std::string complaint;
  TriangleMesh mesh;
  try {
    mesh = import(path, pose, complaint);
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

TriangleMesh read_with_assimp(const std::string& path, const std::string& extension,
                              SkinPose pose) {
  int pipe[2];
  if (::pipe(pipe) != 0)
    throw Error(ErrorKind::INTERNAL, "general.system-refused"_id, path, "",
                std::string("no pipe could be made: ") + std::strerror(errno));
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(pipe[0]);
    import_and_tell(path, pose, pipe[1]);
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
    throw Error(ErrorKind::INTERNAL, "general.system-refused"_id, path, "",
                std::string("no process could be started: ") + std::strerror(errno));
  if (!whole && WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM)
    throw input_error("scan.unreadable"_id, path, "",
                      "was not read within " + std::to_string(LONGEST_S) + " s", next);
  if (!whole)
    throw input_error("scan.unreadable"_id, path, "",
                      "is damaged: it crashes the reader of " + extension + " (assimp)", next);
  if (!complaint.empty())
    throw input_error("scan.unreadable"_id, path, "",
                      "cannot be read as " + extension + ": " + complaint, next);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    if (!mesh.positions[v].allFinite())
      throw input_error("scan.not-finite"_id, path, "vertex " + std::to_string(v),
                        "a coordinate is not finite");
  return mesh;
}

} // namespace sloper::io

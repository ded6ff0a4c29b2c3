#pragma once
/// A garment that has no pattern: a mesh of another program, worn by a body, as a Garment that can
/// be draped, retargeted and judged as any other, and the way back to the file's vertices.
#include <sloper/base/message.hpp>
#include <sloper/base/progress.hpp>
#include <sloper/body/body.hpp>
#include <sloper/collision/body_collider.hpp>
#include <sloper/garment/garment.hpp>
#include <sloper/garment/ingest/carried.hpp>
#include <sloper/garment/ingest/cloth_roles.hpp>
#include <sloper/garment/ingest/mesh_surface.hpp>
#include <sloper/io/json_fwd.hpp>
#include <sloper/io/mesh_file.hpp>

namespace sloper::garment {

/// In which coordinates a mesh is worn.
struct WornFrame {
  bool in_scan = false; ///< those of the body's scan; else those of the body document
  double unit_m = 1;    ///< length of a unit of the file; in the scan's it is in scan_to_body
  double nearness = 0;  ///< at most 1: how near the mesh lies to the skin, outside of it
};

/// The file, the garment that is made of it, and how its vertices follow the garment.
struct MeshGarment {
  io::MeshFile file;                    ///< as read
  WornFrame frame;                      ///< coordinates of the file
  Mat4 file_to_body = Mat4::Identity(); ///< to the body frame, m
  MeshSurface surface;                  ///< in the body frame
  ClothRoles roles;                     ///< of its triangles
  Carried carried;                      ///< by place of the surface
  Garment garment;                      ///< as it hangs on the body that it comes from, bound to it
  bool rest_from_texture = false;       ///< else from the mesh as it is
  double texture_share = 0;             ///< TextureIsometry::share
  int panels = 0;                       ///< pieces of cloth, or of the texture
  int vertices_inside = 0;              ///< of the file, inside the body that it comes from
  int crossings = 0, faces_through = 0; ///< of the file's triangles, on the body it comes from
  std::vector<std::array<int, 2>> crossing_pairs; ///< of the file's triangles that cross as it came
  std::vector<Message> findings; ///< crossings and coarse edges of the file as it came
};

/// @param fabric  material preset   @param skin  of `from`, whose skin's hash is `skin_sha256`
/// @throws Error INPUT naming the file: what read_mesh_file() refuses, a mesh that lies nowhere
/// near the body in any unit, one that has no cloth
MeshGarment read_mesh_garment(const std::string& path, const body::Body& from,
                              const collision::BodyCollider& skin, const std::string& skin_sha256,
                              const std::string& fabric, Reporter& reporter);

/// The file with its vertices where the garment took them.
struct DressedMesh {
  std::string bytes;                    ///< of the whole file
  int crossings = 0, faces_through = 0; ///< as of MeshGarment, on the other body
};
/// @param worn  of MeshGarment::garment, elsewhere   @param to  the body that it hangs on: the file
/// comes out in its scan's coordinates where it came in those of a scan
DressedMesh dressed_mesh(const MeshGarment& mesh, const Garment& worn, const body::Body& to,
                         const collision::BodyCollider& skin);

/// For report.json and fit.json: what the mesh was taken for, and what crosses before and after.
io::Json mesh_json(const MeshGarment& mesh, const DressedMesh* dressed);

} // namespace sloper::garment

#pragma once
/// The meshed pattern: what pattern-mesh writes (panels.json and its OBJ) and drape sews.
///
/// All panels share flat vertex arrays; panel k owns vertices [first_vertex, first_vertex
/// + n_vertices) and triangles [first_triangle, first_triangle + n_triangles). Triangles
/// are counter-clockwise in pattern coordinates and seen from the garment's outside.
#include <memory>
#include <sloper/base/message.hpp>
#include <sloper/geometry/types.hpp>
#include <string>
#include <vector>

namespace sloper::pattern {

struct Pattern;

/// Name of a mesh vertex that survives remeshing and edits: the panel's index and normalised panel
/// coordinates s, t in [0, 1] over the panel's bounding box in pattern coordinates before edits.
struct StableId {
  int panel;   ///< index of the panel
  double s, t; ///< 0..1, across and up its bounding box
};

/// One panel of the mesh: its ranges of the arrays and its properties in the pattern.
struct PanelInfo {
  std::string name; ///< as in the pattern
  /// Its vertices in the arrays of PanelMesh.
  int first_vertex = 0, n_vertices = 0;
  /// Its triangles.
  int first_triangle = 0, n_triangles = 0;
  Vec2 grain = Vec2(0, 1); ///< unit warp direction in pattern coordinates
  std::string material;    ///< name of a material preset, or empty for the scene's
  int layer = 0;           ///< 0 next to the skin
  std::string part;        ///< body part it was placed on: "torso", "arm_l", ..., or empty
  bool in_folds = false;   ///< a wide skirt's panel, placed in folds: its cloth is wider than the
                           ///< surface that it is on
  /// Global vertex indices of the boundary loop, counter-clockwise, closed implicitly.
  std::vector<int> outline;
};

/// One sewn line: run a is sewn to run b, start to start and end to end. Both runs have
/// the same number of vertices.
struct MeshSeam {
  std::string name, kind;            ///< kind: "seam", "dart", "gather", "closure"
  std::vector<int> a, b;             ///< global vertex indices in sewing order, |a| = |b| >= 2
  double length_a = 0, length_b = 0; ///< m, in the pattern
  bool open = false; ///< where the panels are placed together and not sewn: a closure left undone
};

/// How the start positions came about.
enum class Placement {
  UNKNOWN, ///< a document of an older program, or made by hand
  FLAT,    ///< side by side: no body was given
  STATED,  ///< in the pattern itself
  BODY     ///< around a body
};

/// A meshed pattern, flat and around a body. #V vertices, #F triangles. Contents of
/// panels.json(5) and its OBJ.
struct PanelMesh {
  std::string name;              ///< of the pattern
  double edge_length = 0;        ///< m, asked for
  double seam_length = 0;        ///< m, asked for along seams and darts; 0 where the same
  std::vector<PanelInfo> panels; ///< in the order of the pattern
  std::vector<Vec2> pattern;     ///< #V by 2, m: vt
  std::vector<Vec3> placed;      ///< #V by 3, m, start position in the world (body frame)
  Placement placement = Placement::UNKNOWN; ///< of `placed`
  std::string body_sha256;                  ///< of the skin that they were placed around, or empty
  std::vector<StableId> ids;                ///< #V
  std::vector<Triangle> triangles;          ///< #F by 3, global
  std::vector<MeshSeam> seams; ///< stitches are the pairs (a[i], b[i]) of those that are not open
  /// Facts that a user should know: merged edges, small angles, length mismatches.
  std::vector<Message> findings;
  /// Those of the findings for which the mesh is no garment that can be meant, their texts: what a
  /// drape of it makes is no result, unless the user accepts it.
  std::vector<std::string> faults;
  /// Warnings of reading: a mesh that is not the one written. Not part of the document.
  std::vector<Message> file_findings;
  /// The pattern that was meshed, so that edits can be followed; null where unknown.
  std::shared_ptr<const Pattern> source;
};

} // namespace sloper::pattern

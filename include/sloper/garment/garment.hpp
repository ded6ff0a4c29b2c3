#pragma once
/// A garment: the panel mesh, the particles that its vertices are welded to, their
/// positions, and the fabrics and effects that belong to it.
#include <map>
#include <sloper/cloth/fabric.hpp>
#include <sloper/garment/scene/effect_inputs.hpp>
#include <sloper/geometry/triangle_mesh.hpp>
#include <sloper/pattern/panel_mesh.hpp>
#include <string>
#include <vector>

namespace sloper::garment {

/// A fabric by name: its mechanics, friction and thickness. Keys of the document are the
/// members' names; units are in them.
struct Material : cloth::Fabric {
  std::string name = "cotton-poplin"; ///< of the preset or the document
  /// Coulomb coefficients against skin and against cloth.
  double friction_body = 0.4, friction_self = 0.3;
  double thickness_m = 0.0005; ///< of one layer; stacks add it (composite.hpp)
  std::string source;          ///< where the numbers come from
};

/// Coordinates of a particle in one of the frames that it is bound to.
struct BindWeight {
  int frame;            ///< index into Bind::frames
  double weight;        ///< > 0, sum over one particle = 1
  double theta, z, gap; ///< rad, 1, m: gap = r - R(theta, z)
};
/// How a garment hangs on a body in body-relative coordinates (bind/bind.hpp); empty
/// until bound.
struct Bind {
  std::vector<std::string> frames; ///< names as in bind_frames.hpp
  std::vector<double> lengths_m;   ///< by frame: |U - L| on the body it was bound to
  /// By frame: z of named heights ("hip", "waist", ...) on that body; placing on another
  /// body maps them to the same names.
  std::vector<std::map<std::string, double>> marks;
  std::vector<std::vector<BindWeight>> particles; ///< one list per particle
  /// Whether the garment is not bound.
  bool empty() const { return particles.empty(); }
};

/// How differently a garment comes to rest from starts that differ as if placed by hand
/// (redrape/spread.hpp): standard deviations over `count` drapes.
struct Redrapes {
  /// Standard deviations of a girth's figures.
  struct Row {
    double ease_m = 0, strain = 0, gap_m = 0; ///< m; l/l0 - 1; m
  };
  int count = 0;                        ///< 0: it was draped once
  std::vector<double> spread_m;         ///< #P: of the place of each particle
  std::map<std::string, Row> girths;    ///< by row of a fit report
  std::map<std::string, double> hems_m; ///< of the height of each hem
};

/// A garment: cut, sewn or not yet, with its fabrics and its state. Contents of
/// garment.json(5) and its OBJ. #V are panel vertices, #P particles, #F triangles.
struct Garment {
  pattern::PanelMesh panels;    ///< vertices, triangles and seams; `pattern` is vt
  std::vector<int> particle_of; ///< #V: particle of each panel vertex; welded vertices share one
  std::vector<Vec3> position;   ///< #P by 3, m
  std::map<std::string, Material> materials; ///< by panel material name; "" is the default
  /// #F by 3 or empty: rest length factor of edge k -> k+1 of each triangle (edits)
  std::vector<std::array<double, 3>> rest_scale;
  SceneEffects scene;      ///< pins, elastic bands, wind ...: empty for most
  Bind bind;               ///< how it hangs on the body named by body_sha256
  Redrapes redrapes;       ///< of its last re-drapes
  double offset_m = 0.002; ///< contact gap to the skin that the drape kept
  bool converged = false;  ///< the drape that left it here came to rest
  /// Its rest shape is that of a mesh as it was worn: the strain that it had there is unknown.
  bool strain_unknown = false;
  std::string body_sha256; ///< of the body.obj it was draped on, or empty
  /// Warnings of reading: a mesh that is not the one written. Not part of the document.
  std::vector<Message> file_findings;
  /// Girths and level girths of that body, for the fit report.
  std::map<std::string, double> body_girths_m;

  /// Triangles over particles, in panel-mesh order.
  std::vector<Triangle> particle_triangles() const;
};

/// Refuses garments that no document can hold but a caller can pass: numbers that are not
/// finite, indices out of range. O(size).
/// @throws Error INPUT naming the first
void check_garment(const Garment& garment);

} // namespace sloper::garment

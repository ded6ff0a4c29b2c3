#pragma once
/// A sewn garment: the panel mesh, which vertices are one particle, where the particles are, and
/// what holds them.
#include <map>
#include <sloper/cloth/fabric.hpp>
#include <sloper/garment/scene/effect_inputs.hpp>
#include <sloper/geometry/triangle_mesh.hpp>
#include <sloper/pattern/panel_mesh.hpp>
#include <string>
#include <vector>

namespace sloper::garment {

/// A fabric by name: what cloth is made of, how it rubs and how thick it is. Keys of the document
/// are the members' names.
struct Material : cloth::Fabric {
  std::string name = "cotton-poplin";
  double friction_body = 0.4,
         friction_self = 0.3; ///< Coulomb coefficients against skin and against cloth
  double thickness_m = 0.0005;
  std::string source; ///< where the numbers come from
};

/// How a garment hangs on a body in body-relative coordinates; empty until bound.
struct BindWeight {
  int frame;            ///< index into Bind::frames
  double weight;        ///< > 0, sum over one particle = 1
  double theta, z, gap; ///< rad, 1, m: gap = r - R(theta, z)
};
struct Bind {
  std::vector<std::string> frames; ///< names as in bind_frames.hpp
  std::vector<double> lengths_m;   ///< by frame: |U - L| on the body it was bound to
  std::vector<std::map<std::string, double>>
      marks; ///< by frame: z of named heights ("hip", "waist", ...) on that body; they go to their
             ///< like on another
  std::vector<std::vector<BindWeight>> particles; ///< one list per particle
  bool empty() const { return particles.empty(); }
};

/// How differently a garment comes to rest from starts that differ as a person's hands do
/// (redrape/spread.hpp): standard deviations over `count` drapes.
struct Redrapes {
  struct Row {
    double ease_m = 0, strain = 0, gap_m = 0;
  };
  int count = 0;                        ///< 0: it was draped once
  std::vector<double> spread_m;         ///< #P: of the place of each particle
  std::map<std::string, Row> girths;    ///< by row of a fit report
  std::map<std::string, double> hems_m; ///< of the height of each hem
};

struct Garment {
  pattern::PanelMesh panels;    ///< vertices, triangles and seams; `pattern` is vt
  std::vector<int> particle_of; ///< #V: particle of each panel vertex; welded vertices share one
  std::vector<Vec3> position;   ///< #P by 3, m
  std::map<std::string, Material> materials;     ///< by panel material name; "" is the default
  std::vector<std::array<double, 3>> rest_scale; ///< #F by 3 or empty: rest length factor of edge k
                                                 ///< -> k+1 of each triangle (edits)
  SceneEffects scene;                            ///< pins, elastic bands, wind ...: empty for most
  Bind bind;
  Redrapes redrapes;
  double offset_m = 0.002; ///< contact gap to the skin that the drape kept
  bool converged = false;
  std::string body_sha256; ///< of the body.obj it was draped on, or empty
  std::map<std::string, double>
      body_girths_m; ///< girths and level girths of that body, for the fit report

  /// Triangles over particles, in panel-mesh order.
  std::vector<Triangle> particle_triangles() const;
};

/// Refuses what no document can hold but a caller can hand over: numbers that are none, indices
/// that point nowhere.
/// @throws Error INPUT naming the first
void check_garment(const Garment& garment);

} // namespace sloper::garment

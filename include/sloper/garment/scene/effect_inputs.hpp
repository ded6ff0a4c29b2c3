#pragma once
/// Additions of a scene to a garment: the model of stretch and bending, pins, elastic
/// bands and attachments, shrunk regions, creases, wind, pressure. Places are named by
/// panel and (s, t), so they survive remeshing and retargeting.
#include <sloper/geometry/types.hpp>
#include <string>
#include <vector>

namespace sloper::garment {

/// A run on a panel from one place to another (s, t in [0, 1] over its bounding box):
/// along the outline when both lie on it, in the shorter direction, else straight through
/// the mesh. One place when both are the same.
struct PanelRun {
  std::string panel; ///< name
  /// (s, t) of both ends.
  Vec2 from = Vec2::Zero(), to = Vec2::Zero();
};

/// A run whose vertices are held by stiff springs.
struct ScenePin {
  PanelRun run;               ///< vertices that are held
  bool has_target = false;    ///< else every vertex is held where it was placed
  Vec3 target = Vec3::Zero(); ///< m; of all vertices of the run
  double stiffness_n_m = 1e4; ///< of each vertex
};
/// An elastic band sewn to a run: only tension.
struct SceneBand {
  PanelRun run;           ///< where it is sewn
  double ratio = 0.9;     ///< rest length over the length of the run in the pattern
  double strength_n = 30; ///< tension at unit strain
};
/// Springs from the vertices of a run to a point, such as straps; they only pull.
struct SceneAttachment {
  PanelRun run;               ///< vertices that are attached
  Vec3 anchor = Vec3::Zero(); ///< m
  std::string landmark;       ///< when not empty: the anchor is this landmark of the body
  /// Rest length, m, and stiffness, N/m, of each vertex's spring.
  double rest_length_m = 0, stiffness_n_m = 100;
};
/// Cloth that is shorter or longer than its pattern, in a region of a panel.
struct SceneShrink {
  std::string panel;          ///< empty: all
  double warp = 1, weft = 1;  ///< b_v, b_u of Sul et al. 2010 eq. (3)
  Vec2 low{0, 0}, high{1, 1}; ///< region of (s, t)
};
/// A pressed fold along a run.
struct SceneCrease {
  PanelRun run;               ///< the fold line
  double angle_rad = 0;       ///< rest angle; positive folds the panel away from its outside
  double firmness = 1;        ///< times the bending of the cloth beside it: how well it was pressed
  std::vector<Vec2> via = {}; ///< (s, t) of places that a curved line goes through, in order
  bool turns = false;         ///< a roll line: cloth of loose panels starts turned over it
};

/// Buttons, snaps or a zip: points of two runs that are held together once the garment is sewn.
struct SceneClosure {
  PanelRun run, with; ///< point by point, from `from` to `to` of both
  int count = 0;      ///< of buttons, evenly from end to end; 0: a zip, at each vertex of `run`
  double stiffness_n_m = 2000; ///< of each
};

/// Weights sewn to a garment: a chain in a hem, lead in a curtain, beads, buttons.
struct SceneWeight {
  PanelRun run; ///< where they are sewn
  /// Of all of it; shared by the particles of the run, each by the length beside it.
  double mass_kg = 0.01;
};

/// All additions of one scene.
struct SceneEffects {
  std::string membrane;       ///< "springs", "triangles" or "fem"; empty: springs
  std::string bending;        ///< "isometric" or "dihedral"; empty: isometric
  std::vector<ScenePin> pins; ///< in the order of the document
  /// Elastic bands.
  std::vector<SceneBand> bands;
  /// Springs to points or landmarks.
  std::vector<SceneAttachment> attachments;
  /// Factors of rest lengths.
  std::vector<SceneShrink> shrink;
  /// Pressed folds.
  std::vector<SceneCrease> creases;
  /// Added mass.
  std::vector<SceneWeight> weights;
  /// Buttons and zips.
  std::vector<SceneClosure> closures;
  bool air = false;             ///< air takes part, still or moving
  Vec3 wind_m_s = Vec3::Zero(); ///< velocity of the air, body frame
  double pressure_pa = 0;       ///< on the inner side
  /// Whether the scene adds nothing.
  bool empty() const {
    return membrane.empty() && bending.empty() && pins.empty() && bands.empty() &&
           attachments.empty() && shrink.empty() && creases.empty() && weights.empty() &&
           closures.empty() && !air && pressure_pa == 0;
  }
};

} // namespace sloper::garment

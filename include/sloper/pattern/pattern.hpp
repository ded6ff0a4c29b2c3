#pragma once
/// A sewing pattern in memory: panels with outlines of named edges, and the seams between runs of
/// them. Every importer makes one of these; the mesher, the checks, the edits and the exporters
/// take one.
///
/// Panel coordinates are metres, y up, seen from the garment's OUTSIDE: the outer loop is
/// counter-clockwise, holes clockwise.
#include <sloper/pattern/path.hpp>

#include <optional>
#include <sloper/base/message.hpp>
#include <string>
#include <vector>

namespace sloper::pattern {

/// A named stretch of an outline.
struct PanelEdge {
  std::string name; ///< unique within the panel
  Path path;        ///< m, in the direction of its loop
};

/// A mark on an edge, with a counterpart on the edge that is sewn to it.
struct Notch {
  int edge = 0;     ///< index over all loops, as in Run
  double at = 0.5;  ///< fraction of the edge's length
  std::string kind; ///< shape, such as "slit"; DXF keeps it
};

/// A line inside a panel. The mesh has edges along marks, folds and roll lines; an end within 2 mm
/// of the outline lies on it. A tape shortens the cloth along it to `factor` of its length.
struct InnerLine {
  /// "mark", "fold", "tape", or "roll": the cloth at the left of the line, as it is walked, is
  /// turned over to the outside. It may run along an edge: a collar turned over on its seam.
  std::string name, kind = "mark";
  Path path;                       ///< m, panel coordinates
  double factor = 1, width = 0.01; ///< of tapes; width in m
};

/// Cloth folded outwards along one line and brought to another; the cloth between them lies under
/// it, folded back in the middle. Two folds brought to the same line from both sides make a box
/// pleat.
struct Pleat {
  std::string name;         ///< for messages
  int fold = 0, target = 0; ///< indices of Panel::lines; straight, and no line ends between them
  /// Where the three layers are sewn onto each other: both lines end on each of these.
  std::vector<int> edges;
};

/// Where the author of a pattern wants a panel to start. All fields are optional; unset ones are
/// derived from name and seams.
struct PlacementHint {
  std::string part; ///< torso, neck, arm_l, arm_r, leg_l, leg_r, lower_body; empty when unknown
  /// Angle about the part's axis, rad: 0 front (arms: outer, upper side), +pi/2 the
  /// wearer's left.
  std::optional<double> theta;
  std::optional<Vec2> anchor; ///< pattern point, m, that lies at theta and height
  /// Radius of the cylinder that theta was meant on, m: arc length from the front is
  /// theta times this.
  std::optional<double> radius;
  /// World y of the anchor on the body that the pattern was made for, m.
  std::optional<double> height;
  /// Panel (x, y, 0) to the world of the body that the pattern was made for, m.
  std::optional<Mat4> rigid;
};

/// A flat piece of cloth: its outline, marks and material.
struct Panel {
  std::string name; ///< unique within the pattern
  /// [0] outer, counter-clockwise; the rest holes, clockwise.
  std::vector<std::vector<PanelEdge>> loops;
  Vec2 grain = Vec2(0, 1);      ///< unit, warp
  std::string material;         ///< name of a material, or empty for the scene's
  int layer = 0;                ///< 0 next to the skin
  std::string label;            ///< the source's own word for the body part, if any
  std::vector<Notch> notches;   ///< in no order
  std::vector<InnerLine> lines; ///< marks, folds, tapes
  std::vector<Pleat> pleats;    ///< between two of `lines`
  PlacementHint hint;           ///< of the pattern's author

  /// Edges of all loops.
  int n_edges() const;
  /// Area within the outer loop, m2.
  double area() const;
  /// Edge by its index, counted through all loops.
  /// @throws std::out_of_range
  const PanelEdge& edge(int index) const;
  /// The same, to change it.
  PanelEdge& edge(int index);
  /// Index of an edge by name; -1 when there is none.
  int find_edge(const std::string& name) const;
};

/// A stretch of one panel edge by arc length: from fraction `from` to fraction `to` of the edge;
/// from > to walks against the outline.
struct Run {
  /// Indices of the panel in Pattern::panels and of the edge as in Panel::edge().
  int panel = 0, edge = 0;
  /// Fractions of the edge's length.
  double from = 0, to = 1;
};

/// Side a's runs, walked one after the other, are sewn to side b's, start to start and end to end,
/// linear in arc length.
struct Seam {
  std::string name, kind = "seam"; ///< "seam", "dart", "gather", "closure", "pleat"
  std::vector<Run> a, b;           ///< both sides, each in sewing order
  std::string ease;                ///< why the sides differ in length, or empty
  /// Not sewn: a closure left undone. The panels lie as if it were closed, and its sides
  /// have vertices alike.
  bool open = false;
};

/// A whole pattern.
struct Pattern {
  std::string name, source_format; ///< "pattern", "garmentcode", "sewing-spec", "clo", "dxf"
  std::vector<Panel> panels;       ///< in the order of the file; of DXF by name
  std::vector<Seam> seams;         ///< in the order of the file
  std::vector<Message> findings;   ///< doubts of the importer
  /// "panel, edge" of each question of a sidecar that none of its seams answers.
  std::vector<std::string> open_questions;

  /// Index of a panel by name; -1 when there is none.
  int find_panel(const std::string& name) const;
};

/// Length of a run, m.
double run_length(const Pattern& pattern, const Run& run);
/// Length of one side of a seam: the sum of its runs, m.
double side_length(const Pattern& pattern, const std::vector<Run>& side);

/// Opens a half piece cut on the fold: the fold edge (of the outer loop, straight) is
/// replaced by the mirror image of the other edges. Names of the present edges get
/// `suffix`, those of the mirrored half `mirror_suffix`.
/// @return false, with nothing changed, where the edge is no fold
bool unfold(Panel& panel, int fold_edge, const std::string& suffix,
            const std::string& mirror_suffix);

/// What is to be done with a line of a panel that was mirrored, whose points are mirrored already:
/// a roll line is walked the other way, so that the same cloth lies at its left.
void keep_side(InnerLine& line);

/// The other panel of a pair: the panel as seen from its inside. Edges keep their names
/// and come in the opposite order.
Panel mirror_image(const Panel& panel);

/// Panel and edge of a run as "front: hem", for messages.
std::string place_of(const Pattern& pattern, const Run& run);
/// "12.3 cm".
std::string centimetres(double metres);

} // namespace sloper::pattern

#pragma once
/// A sewing pattern in memory: panels with outlines of named edges, and the seams between runs of
/// them. Every importer makes one of these; the mesher, the checks, the edits and the exporters
/// take one.
///
/// Panel coordinates are metres, y up, seen from the garment's OUTSIDE: the outer loop is
/// counter-clockwise, holes clockwise.
#include <sloper/pattern/path.hpp>

#include <optional>
#include <string>
#include <vector>

namespace sloper::pattern {

/// A named stretch of an outline.
struct PanelEdge {
  std::string name;
  Path path;
};

/// A mark on an edge that has its like on the edge sewn to it.
struct Notch {
  int edge = 0;    ///< index over all loops, as in Run
  double at = 0.5; ///< fraction of the edge's length
  std::string kind;
};

/// A line inside a panel. The mesh has edges along marks and folds; an end within 2 mm of the
/// outline lies on it. A tape shortens the cloth along it to `factor` of its length.
struct InnerLine {
  std::string name, kind = "mark"; ///< "mark", "fold", "tape"
  Path path;
  double factor = 1, width = 0.01; ///< of tapes; width in m
};

/// Cloth folded outwards along one line and brought to another; the cloth between them lies under
/// it, folded back in the middle. Two folds brought to the same line from both sides make a box
/// pleat.
struct Pleat {
  std::string name;
  int fold = 0, target = 0; ///< indices of Panel::lines; straight, and no line ends between them
  std::vector<int>
      edges; ///< where the three layers are sewn onto each other: both lines end on each of these
};

/// Where the author of a pattern wants a panel to start. All fields are optional; unset ones are
/// derived from name and seams.
struct PlacementHint {
  std::string part; ///< torso, neck, arm_l, arm_r, leg_l, leg_r, lower_body; empty when unknown
  std::optional<double> theta;  ///< rad about the part's axis: 0 front (arms: outer, upper side),
                                ///< +pi/2 the wearer's left
  std::optional<Vec2> anchor;   ///< pattern point, m, that lies at theta and height
  std::optional<double> radius; ///< m, of the cylinder that theta was meant on: arc length from the
                                ///< front is theta times this
  std::optional<double>
      height; ///< m, world y of the anchor on the body that the pattern was made for
  std::optional<Mat4>
      rigid; ///< panel (x, y, 0) to the world of the body that the pattern was made for, m
};

struct Panel {
  std::string name;
  std::vector<std::vector<PanelEdge>>
      loops;               ///< [0] outer, counter-clockwise; the rest holes, clockwise
  Vec2 grain = Vec2(0, 1); ///< unit, warp
  std::string material;
  int layer = 0;
  std::string label; ///< the source's own word for the body part, if any
  std::vector<Notch> notches;
  std::vector<InnerLine> lines;
  std::vector<Pleat> pleats;
  PlacementHint hint;

  int n_edges() const;
  const PanelEdge& edge(int index) const; ///< counting through all loops
  PanelEdge& edge(int index);
  int find_edge(const std::string& name) const; ///< -1 when there is none
};

/// A stretch of one panel edge by arc length: from fraction `from` to fraction `to` of the edge;
/// from > to walks against the outline.
struct Run {
  int panel = 0, edge = 0;
  double from = 0, to = 1;
};

/// Side a's runs, walked one after the other, are sewn to side b's, start to start and end to end,
/// linear in arc length.
struct Seam {
  std::string name, kind = "seam"; ///< "seam", "dart", "gather", "closure", "pleat"
  std::vector<Run> a, b;
  std::string ease;  ///< why the sides differ in length, or empty
  bool open = false; ///< not sewn: a closure left undone. The panels lie as if it were closed, and
                     ///< its sides have vertices alike
};

struct Pattern {
  std::string name, source_format; ///< "pattern", "garmentcode", "sewing-spec", "dxf"
  std::vector<Panel> panels;
  std::vector<Seam> seams;
  std::vector<std::string> findings; ///< what the importer noticed

  int find_panel(const std::string& name) const; ///< -1 when there is none
};

/// Length of a run, or of one side of a seam, m.
double run_length(const Pattern& pattern, const Run& run);
double side_length(const Pattern& pattern, const std::vector<Run>& side);

/// Opens a half piece cut on the fold: the fold edge (of the outer loop, straight) goes, its mirror
/// image comes. Names of the edges given get `suffix`, those of the mirrored half `mirror_suffix`.
/// @return false, with nothing changed, where the edge is no fold
bool unfold(Panel& panel, int fold_edge, const std::string& suffix,
            const std::string& mirror_suffix);

/// The other one of a pair: the panel as seen from its inside. Edges keep their names and come in
/// the opposite order.
Panel mirror_image(const Panel& panel);

/// "front: hem", for messages.
std::string place_of(const Pattern& pattern, const Run& run);
/// "12.3 cm".
std::string centimetres(double metres);

} // namespace sloper::pattern

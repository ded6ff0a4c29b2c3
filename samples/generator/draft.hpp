#pragma once
/// A sewing pattern while it is drafted: panels of named edges, and seams between edges.
///
/// Pattern coordinates are metres, x to the viewer's right and y up as the finished garment is seen
/// from outside, so a front panel's +x is the wearer's left and a back panel's +x the wearer's
/// right. Outlines run counter-clockwise.
#include <functional>
#include <map>
#include <sloper/geometry/types.hpp>
#include <string>
#include <vector>
namespace sloper::samples {

/// A straight line or cubic Bezier from one outline point to the next.
struct DraftEdge {
  std::string name;
  std::vector<Vec2> control; ///< empty or two inner control points, pattern coordinates
};

/// Where a panel is placed before sewing: wrapped around a body part.
struct DraftPlacement {
  std::string part = "torso"; ///< a part of the body document, or "lower_body"
  double theta_deg = 0; ///< of the panel's anchor: around the trunk and neck 0 is the front, 90 the
                        ///< wearer's left; on arms 0 is the outer side
  double height = 0; ///< m above the floor of the anchor, on the body that the pattern is made for;
                     ///< below 0: not said
  Vec2 anchor = Vec2::Zero(); ///< pattern point that goes there
};

struct DraftPanel {
  std::string name;
  std::vector<Vec2> points;     ///< corners, counter-clockwise
  std::vector<DraftEdge> edges; ///< edge i runs from points[i] to points[i + 1]
  Vec2 grain = Vec2(0, 1);
  DraftPlacement placement;
  std::string roll_edge = {}; ///< on which it is turned over to its outside, or empty
};

struct DraftSeam {
  std::string name;
  std::string panel_a, edge_a, panel_b, edge_b;
  std::string kind = "seam";   ///< or "closure"
  bool same_direction = false; ///< start sews to start; otherwise, as between neighbours seen from
                               ///< outside, start to end
  double ease = 0;             ///< intended (length a / length b) - 1
};

struct Draft {
  std::string name;
  std::vector<DraftPanel> panels;
  std::vector<DraftSeam> seams;

  void add(DraftPanel panel) { panels.push_back(std::move(panel)); }
  void sew(const std::string& panel_a, const std::string& edge_a, const std::string& panel_b,
           const std::string& edge_b, double ease = 0, const std::string& kind = "seam");
  void remove(const std::string& panel);                  ///< with its seams
  const DraftPanel& panel(const std::string& name) const; ///< @throws Error INTERNAL
};

/// Body measures that the drafts need, m. Girths are taut; the waist's is the largest under a
/// waistband.
struct Measures {
  double stature = 1.65, bust = 0.92, waist = 0.74, hip = 0.98, neck = 0.335, upper_arm = 0.285,
         wrist = 0.155, thigh = 0.59, knee = 0.37, ankle = 0.215;
  double back_length = 0.39;  ///< back neck point to waist, vertical
  double waist_to_hip = 0.20; ///< vertical
  double body_rise = 0.28;    ///< waist to crotch, vertical
  double inside_leg = 0.75;   ///< crotch to floor
  double crotch_length = 0;   ///< from the waist in front, through between the legs, to the waist
                              ///< behind; 0: as people of that hip and body rise have it
  double scye_depth = 0.20;   ///< back neck point to arm pit, vertical
  double shoulder = 0.12;     ///< side neck point to shoulder point
  double arm_length = 0.54;   ///< shoulder point to wrist
  double neck_back_height = 1.41; ///< back neck point above the floor
  double shoulder_height = 1.37;  ///< shoulder point above the floor
  double crotch() const { return crotch_length > 0 ? crotch_length : 2 * body_rise + 0.195 * hip; }
  double waist_height() const { return neck_back_height - back_length; }
};

/// Samples of an edge, end points included.
std::vector<Vec2> edge_points(const DraftPanel& panel, int edge, int n = 64);
double edge_length(const DraftPanel& panel, const std::string& edge);
int edge_index(const DraftPanel& panel, const std::string& edge); ///< @throws Error INTERNAL
std::vector<Vec2> outline_points(const DraftPanel& panel, int per_edge = 24);

/// The same panel for the other side of the body: x mirrored, outline turned round, theta mirrored.
DraftPanel mirrored(const DraftPanel& panel, const std::string& name, const std::string& part);

/// Cuts an edge in two at a fraction of its length, measured from its start.
void split_edge(DraftPanel& panel, const std::string& edge, double fraction,
                const std::string& first, const std::string& second);

/// What is wrong with a draft: crossing outline, clockwise outline, seam lengths off by more than 1
/// % of the intended ratio. Empty when sound.
std::vector<std::string> draft_faults(const Draft& draft);

/// x in [low, high] with f(x) = 0, f rising or falling; the nearer end when there is none.
double solve(double low, double high, const std::function<double(double)>& f);

/// The garments. Formulas and their source ideas are at each definition.
Draft draft_shirt(const Measures& m);
Draft draft_tshirt(const Measures& m);
Draft draft_skirt(const Measures& m);
/// @param more_flare  m, 0 or more: by which each side seam leans out more at the hem, on either
/// side of it
/// @throws Error USAGE where the seams would lie nearly level
Draft draft_flared_skirt(const Measures& m, double more_flare);
Draft draft_trousers(const Measures& m);

} // namespace sloper::samples

#pragma once
/// What the edits share: the grid that keeps moves exact, and outlines rebuilt edge by edge with their seams and notches following.
/// Only for the edit sources.
#include <io/json_fwd.hpp>
#include <pattern/pattern.hpp>

#include <functional>

namespace sloper::pattern {

/// To the grid of 2^-30 m, on which sums are exact.
Vec2 snapped(const Vec2& p);

/// Where an edge of a rebuilt outline comes from: a stretch of an edge of the old panel, or nowhere (edge -1).
struct Origin {
  int edge = -1;
  double from = 0, to = 1;
};

/// A panel being rebuilt: `origin` counts through all loops as edge indices do.
struct Rebuilt {
  Panel panel;
  std::vector<Origin> origin;
};

/// Puts one or two rebuilt panels in the place of panel `p` (a second one goes to the end): runs of seams and notches are carried to
/// the new edges; stretches that are gone leave their seams.
/// @throws Error INPUT where nothing is left of a side of a seam
void replace_panel(Pattern& pattern, int p, std::vector<Rebuilt> panels, const io::Node& node);

/// Cuts edges of a panel's outer loop at fractions of their lengths. @return where each edge of the panel comes from
std::vector<Origin> cut_edges(Pattern& pattern, int panel, const std::vector<std::pair<int, double>>& places);

/// Drops lines of a panel that do not pass, and the pleats that need them.
void keep_lines(Panel& panel, const std::function<bool(const InnerLine&)>& pass);

/// `wanted`, or `wanted` with a number where the panel has an edge of this name.
std::string free_edge_name(const Panel& panel, const std::string& wanted);

/// The edits that change what edges and panels there are; `unit` is m per unit of the document.
void split_panel(Pattern& pattern, const io::Node& node, double unit); ///< split, cut
void add_point(Pattern& pattern, const io::Node& node);                ///< add-point
void join_panels(Pattern& pattern, const io::Node& node);              ///< join
void add_dart(Pattern& pattern, const io::Node& node, double unit);    ///< add-dart
void rotate_dart(Pattern& pattern, const io::Node& node);              ///< rotate-dart
void restore(Pattern& pattern, const io::Node& node);                  ///< restore

} // namespace sloper::pattern

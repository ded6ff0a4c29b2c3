#pragma once
/// What the edits share: the grid that keeps moves exact, and outlines rebuilt edge by edge with
/// their seams and notches following. Only for the edit sources.
#include <sloper/io/json_fwd.hpp>
#include <sloper/pattern/pattern.hpp>

#include <array>
#include <functional>

namespace sloper::pattern {

/// To the grid of 2^-30 m, on which sums are exact.
Vec2 snapped(const Vec2& p);

/// Where an edge of a rebuilt outline comes from: a stretch of an edge of the old panel, or nowhere
/// (edge -1).
struct Origin {
  int edge = -1;
  double from = 0, to = 1;
};

/// A panel being rebuilt: `origin` counts through all loops as edge indices do.
struct Rebuilt {
  Panel panel;
  std::vector<Origin> origin;
};

/// Puts one or two rebuilt panels in the place of panel `p` (a second one goes to the end): runs of
/// seams and notches are carried to the new edges; stretches that are gone leave their seams.
/// @throws Error INPUT where nothing is left of a side of a seam
void replace_panel(Pattern& pattern, int p, std::vector<Rebuilt> panels, const io::Node& node);

/// Cuts edges of a panel's outer loop at fractions of their lengths. @return where each edge of the
/// panel comes from
std::vector<Origin> cut_edges(Pattern& pattern, int panel,
                              const std::vector<std::pair<int, double>>& places);

/// Drops lines of a panel that do not pass, and the pleats that need them.
void keep_lines(Panel& panel, const std::function<bool(const InnerLine&)>& pass);

/// `wanted`, or `wanted` with a number where the panel has an edge of this name.
std::string free_edge_name(const Panel& panel, const std::string& wanted);

inline constexpr double AT_CORNER = 2e-4; ///< m: nearer than this to an edge's end is its end

/// An edge of the outer loop while the loop is taken apart.
struct Piece {
  PanelEdge edge;
  Origin origin;
};

/// A panel's outer loop, taken apart.
std::vector<Piece> pieces_of(const Panel& panel);
const Vec2& start_of(const Piece& piece);
const Vec2& end_of(const Piece& piece);
/// A new edge, which comes from nowhere.
Piece straight(const std::string& name, const Vec2& a, const Vec2& b);
/// Cuts a piece at a fraction of its length; the parts are named name_1 and name_2.
std::pair<Piece, Piece> cut_piece(const Piece& piece, double at);
/// Makes sure that a corner lies at a fraction of a piece. @return the index of the piece that
/// starts there
std::size_t corner_at(std::vector<Piece>& pieces, std::size_t k, double at);
/// The pieces from one to before another, around the loop.
std::vector<Piece> walk(const std::vector<Piece>& pieces, std::size_t from, std::size_t to);
/// Indices of the loops that are holes.
std::vector<std::size_t> all_holes(const Panel& panel);
/// A panel `like` another with this outer loop and those of its holes.
Rebuilt rebuilt(const Panel& like, const std::vector<Piece>& outer,
                const std::vector<std::size_t>& holes);

/// Moves all of a panel: outline, holes, lines and what lies on it.
void map_panel(Panel& panel, const std::function<Vec2(const Vec2&)>& map);
/// Low and high corner of a panel's box, m.
std::array<Vec2, 2> extent(const Panel& panel);
Vec2 middle(const Panel& panel);
/// Scales an edge about a point of itself so that its length becomes `length`, m.
void set_length(Panel& panel, int edge, double length, const std::string& fixed);

/// A factor that an edit gives, above 0. @throws Error INPUT
double factor(const io::Node& node, const char* key);
/// The panel and the edge that an edit names. @throws Error INPUT
Panel& edited_panel(Pattern& pattern, const io::Node& node);
int edited_edge(const Panel& panel, const io::Node& node);
/// The edge of the outline that an edit names. @throws Error INPUT
int outer_edge(const Panel& panel, const io::Node& node, const char* key);
/// A number from 0 to 1. @throws Error INPUT
double fraction(const io::Node& node, const char* key);

/// The edits that stand in sources of their own; `unit` is m per unit of the document.
void split_panel(Pattern& pattern, const io::Node& node, double unit); ///< split, cut
void add_point(Pattern& pattern, const io::Node& node);                ///< add-point
void join_panels(Pattern& pattern, const io::Node& node);              ///< join
void add_dart(Pattern& pattern, const io::Node& node, double unit);    ///< add-dart
void rotate_dart(Pattern& pattern, const io::Node& node);              ///< rotate-dart
void restore(Pattern& pattern, const io::Node& node);                  ///< restore
void shrink(Pattern& pattern, const io::Node& node, double unit);      ///< shrink

} // namespace sloper::pattern

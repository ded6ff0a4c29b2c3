#pragma once
/// Edges that were obviously meant to be sewn together and are not. An opening of a garment, be it
/// a neckline, a hem, a slit, an open front or a placket, is none: only what can be nothing else is
/// found.
#include <sloper/pattern/pattern.hpp>

namespace sloper::pattern {

/// Two runs of edges that were meant to be sewn together.
struct MissingSeam {
  Run a, b;        ///< as they would be sewn
  std::string why; ///< "both ends of this hole are sewn together"
};

/// Two kinds of free edges are found:
/// - both sides of a hole as long as each other that comes to a point at both ends, where the cloth
/// would lie flat were it closed: a stretch
///   left out of a seam, a dart, of which the ends meet
/// - edges of a pattern's one half whose like in the other half are sewn: one side seam of two, one
/// sleeve. Halves are panels that mirror each
///   other about the grain, holes and notches too, by the words left and right in their names or by
///   their shape alone, or one panel's own two. Where such a free stretch goes on in a seam of the
///   same two panels it is a slit or a placket, and is left out.
/// In pattern order.
std::vector<MissingSeam> missing_seams(const Pattern& pattern);

/// Panels that seams join, by index: of the largest group first, then of the others.
std::vector<std::vector<int>> sewn_parts(const Pattern& pattern);

} // namespace sloper::pattern

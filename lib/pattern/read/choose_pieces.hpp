#pragma once
/// Which pieces of a file are taken.
#include <sloper/pattern/pattern.hpp>

namespace sloper::pattern {

/// Takes panels out, with the seams that they have part in. @param remove #panels
void remove_panels(Pattern& pattern, const std::vector<bool>& remove);

/// Keeps the panels of these names, if any are given, and of them none of the second list. Letters
/// of either case are alike; a name stands for the piece's mirrored copy too. @throws Error INPUT
/// for a name that there is not
void choose_pieces(Pattern& pattern, const std::vector<std::string>& pieces,
                   const std::vector<std::string>& without, const std::string& file);

inline constexpr const char* MIRRORED = "_mirror"; ///< added to the name of a piece's mirrored copy

/// Whether a panel is meant by a name that a user wrote.
bool is_named(const Panel& panel, const std::string& name);

} // namespace sloper::pattern

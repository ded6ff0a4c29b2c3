#pragma once
/// Patterns of CLO and Marvelous Designer in their own JSON, with the seams that they state.
#include <sloper/io/json_fwd.hpp>
#include <sloper/pattern/pattern.hpp>

namespace sloper::pattern {

/// {"PatternList", "SeamLinePairGroupList"}, millimetres unless "Unit" says otherwise. Lines of an
/// outline come as edges line0, line1, ...; points of lines are corners, points of a smooth curve,
/// or control points of Bezier curves. Lines inside pieces, buttons and notches are left out, which
/// a finding says. @throws Error INPUT with the place in the document
Pattern read_clo_json(const io::Json& json, const std::string& file);

} // namespace sloper::pattern

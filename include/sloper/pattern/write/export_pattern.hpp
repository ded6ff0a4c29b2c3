#pragma once
/// Patterns as documents: our own JSON, DXF with sew line and notches, SVG.
#include <sloper/io/json_fwd.hpp>
#include <sloper/pattern/pattern.hpp>

namespace sloper::pattern {

/// Precision of lengths: ROUNDED for people, centimetres rounded to ten nanometres; EXACT
/// for programs, metres to the last bit, so that meshing and placing the pattern again
/// gives the same bytes.
enum class PatternNumbers { ROUNDED, EXACT };

/// Our own pattern document, curves as cubic Beziers; read_pattern_json() gives the same panels and
/// seams back.
io::Json pattern_json(const Pattern& pattern, const std::string& tool,
                      PatternNumbers numbers = PatternNumbers::ROUNDED);

/// AAMA DXF R12, millimetres: one block per panel, sew line on layer 14 (curves as chords
/// of 2 mm), turn points on 2, curve points on 3, notches on 4 (those read from 80 to 83
/// there), grain on 7, cut-outs on 11. Sewing as layer-15 texts `SEW <seam> <a|b> <order>
/// <+|-> <run> [seam|dart|gather|closure] [open] [ease <why>]`; read_dxf() gives the same
/// seams back.
/// @param left_out  out: contents that the format cannot hold: partial runs, tapes,
/// folds, pleats, layers, placement hints
std::string pattern_dxf(const Pattern& pattern, std::vector<std::string>& left_out);

/// Panels side by side at 1:1 (SVG user unit 1 mm), edges named, both sides of a seam in one
/// colour, grain as an arrow.
std::string pattern_svg(const Pattern& pattern);

} // namespace sloper::pattern

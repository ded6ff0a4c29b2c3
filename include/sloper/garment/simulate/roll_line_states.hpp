#pragma once
/// Whether cloth lies turned over the roll lines that its pattern draws.
/// Test: tests/garment/simulate/test_roll_line_states.cpp
#include <sloper/garment/garment.hpp>
#include <sloper/io/json_fwd.hpp>

#include <string>
#include <vector>

namespace sloper::garment {

/// How one roll line came out.
struct RollLineState {
  std::string panel, line; ///< names in the pattern
  /// Of the area beyond the line, weighted by its distance from it, what is turned outwards by more
  /// than 60 degrees.
  double turned_share = 0;
  /// The same of what is turned inwards, to the body.
  double inwards_share = 0;
  /// By how much cloth beyond the line is turned, rad, the middle value of its triangles: 0 where
  /// it goes straight on and stands, pi where it lies back on itself; below 0 inwards.
  double turn = 0;
  /// Whether at least half of it is turned over.
  bool is_turned() const;
  /// Whether less than a quarter of it is turned over: the line did not fold.
  bool stands() const;
};

/// The state of each roll line of a sewn garment, in the order of the pattern. Each triangle
/// beyond the line is compared with the cloth within 2 cm before the nearest edge along it; of a
/// line on a seam with the cloth sewn to it. Outwards is away from the body side of that cloth;
/// turned by more than 60 degrees, outside of the cloth that the triangle lies on. Lines without
/// such edges are left out. Where keep-fit has changed the mesh and not its pattern, edges are
/// found by the stable ids of its vertices.
/// @return empty where the garment does not know its pattern, or it has no roll lines
std::vector<RollLineState> roll_line_states(const Garment& garment);

/// report.json's `roll_lines`.
io::Json roll_lines_json(const std::vector<RollLineState>& states);

/// "roll line roll of panel collar turned over 12 % of what lies beyond it".
std::string turned_text(const RollLineState& state);
/// The same of the first line that stands. @return empty where none does
std::string standing_text(const std::vector<RollLineState>& states);

} // namespace sloper::garment

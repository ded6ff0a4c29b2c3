#pragma once
/// What the texts of a piece in a garment DXF say about it: how often it is cut, of what, and what
/// it is.
#include <pattern/read/dxf_blocks.hpp>

namespace sloper::pattern {

/// The value of a text "Key: value" (the blank may be missing, letters of either case), or empty.
std::string value_of(const std::string& text, const std::string& key);
/// That of the first text with this key, or empty.
std::string find_value(const std::vector<DxfText>& texts, const std::string& key);

/// What the texts of one piece say.
struct PieceNotes {
  std::string
      category; ///< "SLEEVE SHORT": what the maker calls the piece, where its name is a code
  std::string material; ///< of the texts Material and Fabric
  int copies = 1;       ///< in all, as drawn and mirrored; 0 where the style does without it
  int mirrored = 0;     ///< of these
  std::string inside;   ///< "lining", "interlining" or "facing" where it is not the garment's
                        ///< outside, else empty
};

/// "Quantity: 2" and "Quantity: 1,1" (as drawn, mirrored) are pairs; without a quantity
/// "Annotation: 2XFABRIC" and a text "Cut 2" are too.
PieceNotes piece_notes(const DxfBlock& block);

/// Why a piece is left out unless it is asked for: it is inside of the garment, an alternative, or
/// the frame of a drawing. Empty where it is taken.
/// @param ring        its outline, m
/// @param any_wanted  whether some piece of the style has a quantity: then 0 says that this one is
/// an alternative
std::string reason_to_leave(const DxfBlock& block, const PieceNotes& notes,
                            const std::vector<Vec2>& ring, bool any_wanted);

} // namespace sloper::pattern

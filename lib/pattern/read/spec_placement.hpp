#pragma once
/// Where a specification of the GarmentCode family places its panels. Its writers differ in what
/// three Euler angles mean.
#include <sloper/io/json_fwd.hpp>
#include <sloper/pattern/pattern.hpp>

namespace sloper::pattern {

/// How three angles make a rotation R.
enum class EulerOrder {
  XYZ, ///< R = Rx Ry Rz: GarmentCode (scipy's "XYZ")
  ZYX  ///< R = Rz Ry Rx: Garment-Pattern-Generator, SewFactory, NeuralTailor, as Maya has it
};

/// The order that a specification's angles are meant in. Curves as GarmentCode writes them tell
/// XYZ. Else it is the order in which the seams start nearer to each other; where both are alike,
/// ZYX if there are curves as Garment-Pattern-Generator writes them.
/// @param source  the object "pattern", with "panels" and "stitches"
EulerOrder euler_order(const io::Node& source);

/// Panel (x, y, 0) to the world, m, by "translation" and "rotation" (degrees) of a panel. @param
/// unit m per unit of the file
Mat4 spec_placement(const io::Node& panel, double unit, EulerOrder order);

/// Whether the panels' placements say anything: not where several panels all lie in one plane. Such
/// a file was never placed, and its names and seams tell more. @param panels  the object "panels"
bool tells_placement(const io::Node& panels);

/// Finds the one panel whose translation is wrong: all that it is sewn to lies far from it, and
/// with that panel brought to its seams all panels of the pattern lie near theirs. It is brought
/// there, and a finding says from where. Nothing is done where one panel does not explain it.
void mend_translation(Pattern& pattern);

} // namespace sloper::pattern

#pragma once
/// The ends of sleeves at the wrists. Put on another body, a sleeve may be longer than the arm;
/// while the body is inflated under it, without friction, it would straighten out and push its end
/// over the hand, where a cuff is stretched and stays. So it would where it is placed by its
/// coordinates alone, shorter than its cloth. Who puts on a shirt holds the cuffs.
/// Test: tests/garment/simulate/test_sleeve_ends.cpp
#include <sloper/cloth/forces/pins.hpp>
#include <sloper/garment/garment.hpp>

namespace sloper::garment {

/// Pins that hold the last 3 cm of each sleeve that ends near a wrist where it is: less than 8 cm
/// beyond, since what covers the hand is to slide. None for a garment that is not bound.
std::vector<cloth::Pin> hold_sleeve_ends(const Garment& garment);

/// Those of hold_sleeve_ends() that a hand holds open: their edge went at least a centimetre
/// farther from the elbow than it was placed, to where it is stretched. Such a sleeve is longer
/// than the arm and narrower than the hand: its end belongs where it was placed, and its cloth in
/// folds.
/// @param garment where it went   @param placed #P by 3, m   @param shape #P by 3, m: as it lay on
/// the body that it is bound to
/// @return particles
std::vector<int> ends_pushed_on_hands(const Garment& garment, const std::vector<Vec3>& placed,
                                      const std::vector<Vec3>& shape);

} // namespace sloper::garment

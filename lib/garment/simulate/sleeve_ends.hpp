#pragma once
/// The ends of sleeves at the wrists, and of legs at the ankles. Put on another body, a sleeve may
/// be longer than the arm; while the body is inflated under it, without friction, it would
/// straighten out and push its end over the hand, where a cuff is stretched and stays. So it would
/// where it is placed by its coordinates alone, shorter than its cloth. Who puts on a shirt holds
/// the cuffs. Test: tests/garment/simulate/test_sleeve_ends.cpp
#include <sloper/cloth/forces/pins.hpp>
#include <sloper/garment/garment.hpp>
#include <sloper/garment/simulate/request.hpp>

namespace sloper::garment {

/// What of a garment covers a limb: a sleeve below the elbow, or a leg of trousers.
struct LimbCover {
  std::string frame;     ///< of the bind: forearm_l, leg_r
  std::vector<int> limb; ///< particles
  std::vector<int> end;  ///< of these the last 3 cm
  double lowest_m = 0;   ///< height over wrist or ankle on the body that it is bound to
};

/// Legs that end within 10 cm over and 15 cm under an ankle.
std::vector<LimbCover> legs_of(const Bind& bind);

/// Pins that hold, where they are, the last 3 cm of each sleeve that ends near a wrist, less than 8
/// cm beyond, since what covers the hand is to slide; and where legs are asked for, of each leg
/// that ends within 10 cm over and 15 cm under an ankle. None for a garment that is not bound.
std::vector<cloth::Pin> hold_ends(const Garment& garment, LimbEnds ends);

/// Those of sleeves that a hand holds open: their edge went at least a centimetre farther from the
/// elbow than it was placed, to where it is stretched. Such a sleeve is longer than the arm and
/// narrower than the hand: its end belongs where it was placed, and its cloth in folds.
/// @param garment where it went   @param placed #P by 3, m   @param shape #P by 3, m: as it lay on
/// the body that it is bound to
/// @return particles
std::vector<int> ends_pushed_on_hands(const Garment& garment, const std::vector<Vec3>& placed,
                                      const std::vector<Vec3>& shape);

} // namespace sloper::garment

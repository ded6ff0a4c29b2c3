#pragma once
/// Starts of one drape that differ as if each was placed by hand.
#include <sloper/garment/garment.hpp>

#include <cstdint>

namespace sloper::garment {

/// How far starts differ. Each number is uniform within plus and minus its bound.
struct StartJitter {
  double turn_rad = 0.02;  ///< about the upright through the garment's middle, 0..0.5
  double offset_m = 0.003; ///< along each axis, of the whole, 0..0.05
  /// Amplitude of a smooth displacement of space, which decides what part of the cloth comes down
  /// first, 0..0.02 m: a sum of waves of WAVE_M and longer, so that layers that lie on each other
  /// move together and do not cross.
  double order_m = 0.002;
  static constexpr double WAVE_M = 0.25; ///< m; shortest wave of order_m
};

/// Sets one bound from "turn_deg=2", "offset_mm=3" or "order_mm=2". @throws Error USAGE
void set_jitter(StartJitter& jitter, const std::string& assignment);

/// Moves the positions to start number `index`; number 0 is the start as it is. Depends
/// on its arguments only.
/// @param position  #P by 3, m, in and out
/// @param seed  of all starts
void jitter_start(std::vector<Vec3>& position, const StartJitter& jitter, std::uint64_t seed,
                  int index);

} // namespace sloper::garment

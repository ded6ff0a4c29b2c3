#pragma once
/// The ends of sleeves at the wrists. Put on another body, a sleeve may be longer than the arm; while the body is inflated under it, without
/// friction, it would straighten out and push its end over the hand, where a cuff is stretched and stays. Who puts on a shirt holds the cuffs.
/// Test: tests/garment/test_sleeve_ends.cpp
#include <cloth/pins.hpp>
#include <garment/garment.hpp>

namespace sloper::garment {

/// Pins that hold the last 3 cm of each sleeve that ends near a wrist where it is: less than 8 cm beyond, since what covers the hand is to slide.
/// None for a garment that is not bound.
std::vector<cloth::Pin> hold_sleeve_ends(const Garment& garment);

} // namespace sloper::garment

#pragma once
/// The transfer function of sRGB (IEC 61966-2-1): numbers in pictures to light and back.
#include <cmath>
namespace sloper::render {

/// The curve is linear near black, a power beyond.
inline constexpr double SRGB_LINEAR_TO = 0.0031308, SRGB_LINEAR_TO_NUMBER = 0.04045,
                        SRGB_SLOPE = 12.92, SRGB_SCALE = 1.055, SRGB_OFFSET = 0.055,
                        SRGB_POWER = 2.4;

/// The number in a picture, 0..1, of light, 0..1.
inline double to_srgb(double linear) {
  if (linear <= SRGB_LINEAR_TO)
    return SRGB_SLOPE * linear;
  return SRGB_SCALE * std::pow(linear, 1 / SRGB_POWER) - SRGB_OFFSET;
}
/// The light, 0..1, of a number in a picture, 0..1.
inline double from_srgb(double number) {
  if (number <= SRGB_LINEAR_TO_NUMBER)
    return number / SRGB_SLOPE;
  return std::pow((number + SRGB_OFFSET) / SRGB_SCALE, SRGB_POWER);
}

} // namespace sloper::render

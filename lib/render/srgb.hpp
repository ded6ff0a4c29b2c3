#pragma once
/// The transfer function of sRGB (IEC 61966-2-1): numbers in pictures to light and back.
#include <cmath>
namespace sloper::render {

inline double to_srgb(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
} ///< 0..1
inline double from_srgb(double number) {
  return number <= 0.04045 ? number / 12.92 : std::pow((number + 0.055) / 1.055, 2.4);
} ///< 0..1

} // namespace sloper::render

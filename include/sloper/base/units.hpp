#pragma once
/// Conversions at the edges. Inside, everything is m, kg, s, N, rad.
/// Test: tests/base/test_units.cpp
#include <cmath>
namespace sloper::units {
/// Ratio of a circle's circumference to its diameter.
inline constexpr double PI = 3.14159265358979323846;
inline constexpr double CM = 0.01;            ///< m per cm
inline constexpr double MM = 0.001;           ///< m per mm
inline constexpr double INCH = 0.0254;        ///< m per inch
inline constexpr double GRAVITY = 9.80665;    ///< m/s2
inline constexpr double GF_PER_CM = 0.980665; ///< N/m per gf/cm
/// N m per gf cm2/cm (KES bending rigidity is per unit width).
inline constexpr double GF_CM2_PER_CM = 9.80665e-5;
inline constexpr double G_PER_CM2 = 10.0; ///< kg/m2 per g/cm2
/// Degrees to radians, and back.
inline double radians(double degrees) {
  return degrees * PI / 180.0;
}
/// Radians to degrees.
inline double degrees(double radians) {
  return radians * 180.0 / PI;
}
} // namespace sloper::units

#pragma once
/// Tables of fabric measurements, as kes.hpp describes them: from text to values in SI. A name,
/// unit or number that is not understood is refused with its line; nothing is passed over in
/// silence that may have been meant. Test: tests/garment/test_kes.cpp
#include <cmath>
#include <map>
#include <string>

namespace sloper::garment {

inline constexpr double GF_CM = 0.980665; ///< 1 gf/cm in N/m

/// One measured property, SI; NaN where it was not given. Mean values fill both directions.
struct Value {
  double warp = NAN, weft = NAN;
  double bias = NAN;        ///< at 45 degrees, where it was given as such
  std::string place;        ///< line and column that it stands in first, for messages
  std::string without_unit; ///< the same of the first one whose unit is not said; else empty
  double mean() const {
    if (std::isnan(warp))
      return weft;
    return std::isnan(weft) ? warp : 0.5 * (warp + weft);
  }
  bool given() const { return !std::isnan(mean()); }
};
/// By the property's name, such as "B".
using Values = std::map<std::string, Value>;

/// What a file says of one fabric.
struct Measurements {
  std::string file;  ///< path without #NAME
  std::string name;  ///< of the fabric; empty where the file has a property per row
  std::string place; ///< its lines, for messages
  Values values;
};

/// Reads a table.
/// @param path  the file, with `#NAME` behind it to pick one fabric of several
/// @throws Error INPUT with file and line: a column, property, unit or number that is not known,
/// one
///   that is there twice, no weight, nothing that bending follows from
Measurements read_measurements(const std::string& path);

} // namespace sloper::garment

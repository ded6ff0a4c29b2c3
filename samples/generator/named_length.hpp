#pragma once
/// "waist=0.75" of a command line.
#include <charconv>
#include <cmath>
#include <cstdio>
#include <sloper/base/error.hpp>
#include <string>
#include <utility>
namespace sloper::samples {
inline constexpr double
    LONGEST = 2.5,
    SHORTEST = 0.1; ///< m, of what is measured on a person: more is meant in another unit
/// Metres in a unit; 1 without one, 0 of a unit that is not known.
inline double metres_in(const std::string& unit) {
  if (unit.empty() || unit == "m")
    return 1;
  if (unit == "cm")
    return 0.01;
  if (unit == "mm")
    return 0.001;
  return unit == "in" ? 0.0254 : 0;
}

/// @param option  for messages: "--measure". @throws Error USAGE with the form that is expected
/// and, where a unit can be guessed, with the number in it
inline std::pair<std::string, double> named_length(const std::string& option,
                                                   const std::string& text) {
  const std::size_t equal = text.find('=');
  const std::string name = text.substr(0, equal),
                    length = equal == std::string::npos ? "" : text.substr(equal + 1);
  double value = 0;
  const auto [rest, failure] = std::from_chars(length.data(), length.data() + length.size(), value);
  const std::string unit(rest, length.data() + length.size());
  const double factor = metres_in(unit);
  if (name.empty() || failure != std::errc() || factor == 0 || !std::isfinite(value))
    throw Error(ErrorKind::USAGE, "option.wrong-value"_id, "", option,
                "\"" + text + "\" is not NAME=METRES", "for example " + option + " waist=0.75");
  const auto say = [&](double metres) {
    char number[32];
    std::snprintf(number, sizeof number, "%.4g", metres);
    return option + " " + name + "=" + number;
  };
  if (!unit.empty())
    throw Error(ErrorKind::USAGE, "option.wrong-value"_id, "", option,
                "\"" + text + "\" names a unit: lengths are in metres, without one",
                "say " + say(factor * value));
  if (value > LONGEST) {
    const bool mm = value > 100 * LONGEST;
    const double meant = value / (mm ? 1000 : 100);
    std::string hint = "for example " + say(0.75);
    if (meant >= SHORTEST)
      hint = "where " + length + (mm ? " mm" : " cm") + " are meant, say " + say(meant);
    throw Error(ErrorKind::USAGE, "option.wrong-value"_id, "", option,
                "\"" + text + "\" would be " + length + " m: lengths are in metres", hint);
  }
  return {name, value};
}
} // namespace sloper::samples

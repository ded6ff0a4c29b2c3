#include <sloper/base/number_text.hpp>

#include <charconv>
#include <cmath>

namespace sloper {

std::string number_text(double value) {
  constexpr double LEAST_FIXED = 1e-6, MOST_FIXED = 1e10;
  const double size = std::abs(value);
  const bool is_fixed = size == 0 || (size >= LEAST_FIXED && size < MOST_FIXED);
  char text[32]; // a sign, 17 digits, and at most 5 zeros and a point before them
  const std::to_chars_result end =
      std::to_chars(text, text + sizeof text, value,
                    is_fixed ? std::chars_format::fixed : std::chars_format::scientific);
  return {text, end.ptr};
}

std::string rounded_text(double value) {
  constexpr int DIGITS = 4;
  char text[32];
  const std::to_chars_result end =
      std::to_chars(text, text + sizeof text, value, std::chars_format::scientific, DIGITS - 1);
  double rounded = value;
  std::from_chars(text, end.ptr, rounded);
  return number_text(rounded);
}

std::string range_text(double low, double high) {
  return number_text(low) + " to " + number_text(high);
}

} // namespace sloper

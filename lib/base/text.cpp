#include <sloper/base/text.hpp>

#include <cmath>
#include <cstdio>
#include <sstream>

namespace sloper {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> pieces;
  std::stringstream stream(text);
  for (std::string piece; std::getline(stream, piece, separator);)
    pieces.push_back(piece);
  return pieces;
}

std::string decimals(double value, int digits) {
  const int size = std::snprintf(nullptr, 0, "%.*f", digits, value);
  std::string text(static_cast<std::size_t>(size) + 1, '\0');
  std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  text.pop_back(); // the terminating zero
  return text;
}

std::string centimetres(double metres, int digits) {
  return decimals(metres * 100, digits) + " cm";
}

std::string millimetres(double metres, int digits) {
  return decimals(metres * 1000, digits) + " mm";
}

std::string percent(double share, int digits) {
  return decimals(100 * share, digits) + " %";
}

std::string whole_percent(double share) {
  return std::to_string(std::lround(100 * share)) + " %";
}

std::string place_text(double x, double y, double z) {
  return "(" + decimals(x, 3) + ", " + decimals(y, 3) + ", " + decimals(z, 3) + ")";
}

} // namespace sloper

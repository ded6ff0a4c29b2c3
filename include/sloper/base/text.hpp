#pragma once
/// Texts of messages and reports: words of lists, numbers with their unit.
/// Test: tests/base/test_text.cpp
#include <string>
#include <vector>

namespace sloper {

/// The pieces of `text` between the separators: "a,,b" gives "a", "", "b". An empty text
/// has no pieces, and a separator at the end adds none.
std::vector<std::string> split(const std::string& text, char separator = ',');

/// A number with `digits` (0 or more) decimal places, as printf's %.*f rounds it: the
/// exact value to nearest, ties to even.
std::string decimals(double value, int digits);
/// A length in metres as "12.3 cm".
/// @param digits  decimal places, as below
std::string centimetres(double metres, int digits = 1);
/// A length in metres as "1.2 mm".
std::string millimetres(double metres, int digits = 1);
/// A share of one as "12.3 %".
std::string percent(double share, int digits = 1);
/// A share of one as "12 %"; 100 times the share is rounded half away from zero.
std::string whole_percent(double share);
/// A place as "(0.000, 1.000, 2.000)", m, to a millimetre.
std::string place_text(double x, double y, double z);

} // namespace sloper

#pragma once
/// Numbers and ranges in messages, as a person writes them.
/// Test: tests/base/test_number_text.cpp
#include <string>

namespace sloper {

/// The shortest text that reads back as this number: "0", "0.0001", "1000000"; below a millionth
/// and from ten thousand millions on with a power of ten: "1e-12".
std::string number_text(double value);
/// The same of the number rounded to four digits: "0.0001235", "12350".
std::string rounded_text(double value);
/// A range as "0.0001 to 1000".
std::string range_text(double low, double high);

} // namespace sloper

#pragma once
/// For tests of messages.
#include <string>

namespace sloper::test {

inline bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

} // namespace sloper::test

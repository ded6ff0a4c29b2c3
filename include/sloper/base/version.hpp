#pragma once
#include <string>
namespace sloper {
/// "0.1.0"; the CMake project version.
inline constexpr const char* VERSION = SLOPER_VERSION;
/// The stamp of a document: "drape 0.1.0".
inline std::string generator_stamp(const std::string& tool) {
  return tool + " " + VERSION;
}
} // namespace sloper

#pragma once
/// shirt.json + shirt.obj, read and written.
#include <garment/garment.hpp>
namespace sloper::garment {
inline constexpr int GARMENT_VERSION = 1;
Garment read_garment(const std::string& path);                                             ///< @throws Error INPUT
void write_garment(const std::string& path, const Garment& garment, const std::string& tool); ///< @throws Error OUTPUT
} // namespace sloper::garment

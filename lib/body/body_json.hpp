#pragma once
/// body.json + body.obj, read and written.
#include <body/body.hpp>
namespace sloper::body {
inline constexpr int BODY_VERSION = 1;
/// Reads body.json and the OBJ it names. @throws Error INPUT
Body read_body(const std::string& path);
/// Writes the OBJ beside the document (`.json` -> `.obj`), then the document. @throws Error OUTPUT
void write_body(const std::string& path, const Body& body, const std::string& tool);
} // namespace sloper::body

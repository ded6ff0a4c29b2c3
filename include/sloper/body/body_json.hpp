#pragma once
/// body.json and its OBJ, read and written; every key is in body.json(5).
/// Test: tests/body/test_body_json.cpp
#include <sloper/base/progress.hpp>
#include <sloper/body/pose_file.hpp>
namespace sloper::body {
/// Version of the format that is written; older ones are read, newer ones refused.
inline constexpr int BODY_VERSION = 1;
/// Reads body.json and the OBJ it names. The skin is empty where the document names no
/// OBJ.
/// @throws Error INPUT with file and place
Body read_body(const std::string& path);
/// SHA-256 of the OBJ that body.json names: by it panels and garments know their body.
/// @throws Error INPUT when the body was written without a skin
std::string skin_sha256(const std::string& path);
/// Writes the OBJ beside the document (`.json` -> `.obj`), then the document. @throws Error OUTPUT
void write_body(const std::string& path, const Body& body, const std::string& tool);
/// Writes the skin in every pose as NAME.0001.obj, NAME.0002.obj, ... beside the document
/// NAME.json. Vertices and faces are those of NAME.obj in the same order, so that the
/// sequence is a moving body.
/// @param path  of the document
/// @param weights  of skin_weights()
/// @throws Error OUTPUT
void write_motion(const std::string& path, const Body& body, const SkinWeights& weights,
                  const Motion& motion, const std::string& tool, Reporter& reporter);
} // namespace sloper::body

#pragma once
/// What the fuzzers call: a reader on any bytes must read or refuse (sloper::Error), nothing else.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
namespace sloper::fuzz {
/// The first byte picks the format: o OBJ, p PLY, s STL, x XYZ, 3 3DS, d PCD; the rest is the file.
void read_scan_bytes(std::string_view bytes);
/// A garment mesh of another program. The first byte picks the format: o OBJ, p PLY, g GLB; the
/// rest is the file. What is read comes out again with its vertices elsewhere.
void read_mesh_file_bytes(std::string_view bytes);
/// A JSON document; what we write of it, we read again.
void read_json_bytes(std::string_view bytes);
/// A file as a body document, a pose and landmark rules.
void read_document_file(const std::string& path);
/// A kept prepared skin, whatever its key and sum say, and what a collider makes of it.
void read_prepared_skin_bytes(std::string_view bytes);
/// BVH motion for a body with all bones.
void read_bvh_bytes(std::string_view bytes);
} // namespace sloper::fuzz

#pragma once
/// Whole files in and out; nothing already on disk is lost when a write fails.
/// Test: tests/io/test_files.cpp
#include <optional>
#include <string>
#include <string_view>
namespace sloper::io {
/// Bytes of a file, or of standard input for "-". @throws Error INPUT
std::string read_file(const std::string& path);
/// The same; empty where there is no such file, also when another process removed it at
/// this moment.
/// @throws Error INPUT
std::optional<std::string> read_file_if_there(const std::string& path);
/// Writes a file whole or not at all: beside `path` under a temporary name, synced,
/// renamed; a link stays a link. "-" is standard output. Devices and pipes are written in
/// place, and a pipe that its reader closed is no error.
/// @throws Error OUTPUT, with the old file untouched
void write_file(const std::string& path, std::string_view bytes);
/// The k-th of n files of one name: out.png, 7, 360 -> out-007.png
std::string numbered_path(const std::string& path, std::size_t k, std::size_t n);
/// Lower-case hex SHA-256 of some bytes.
std::string sha256(std::string_view bytes);
} // namespace sloper::io

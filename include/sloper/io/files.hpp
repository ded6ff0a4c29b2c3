#pragma once
/// Whole files in and out; nothing already on disk is lost when a write fails.
#include <optional>
#include <string>
#include <string_view>
namespace sloper::io {
/// Bytes of a file, or of standard input for "-". @throws Error INPUT
std::string read_file(const std::string& path);
/// The same; nothing where there is no such file, also when another process took it away at this
/// moment. @throws Error INPUT
std::optional<std::string> read_file_if_there(const std::string& path);
/// Writes beside `path` under a temporary name, syncs, renames; a link stays a link. "-" is
/// standard output; devices and pipes are written in place, and a pipe that its reader closed is no
/// error. @throws Error OUTPUT, with what was there untouched
void write_file(const std::string& path, std::string_view bytes);
/// The k-th of n files of one name: out.png, 7, 360 -> out-007.png
std::string numbered_path(const std::string& path, std::size_t k, std::size_t n);
/// Lower-case hex SHA-256 of some bytes.
std::string sha256(std::string_view bytes);
} // namespace sloper::io

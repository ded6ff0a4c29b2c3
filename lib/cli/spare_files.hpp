#pragma once
/// Files that a command line must not write over. Test: tests/cli (common-cases).
#include <string>

namespace CLI {
class App;
class Option;
} // namespace CLI

namespace sloper::cli {

/// Whether an option has a check of that name: "input_file" where it is read, "output_file" where
/// it is written.
bool has_validator(CLI::Option* option, const std::string& name);

/// Nothing that is read is written over, and nothing is written twice. What continues a document
/// may take its place.
/// @throws Error USAGE naming both options
void spare_files(CLI::App& app);

} // namespace sloper::cli

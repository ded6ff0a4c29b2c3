#pragma once
/// Files that a command line must not write over. Test: tests/cli (common-cases).
namespace CLI {
class App;
class Option;
} // namespace CLI

namespace sloper::cli {

/// Whether an option names a file that is written, by its check.
bool is_written(CLI::Option* option);

/// Nothing that is read is written over, and nothing is written twice. What continues a document
/// may take its place.
/// @throws Error USAGE naming both options
void spare_files(CLI::App& app);

} // namespace sloper::cli

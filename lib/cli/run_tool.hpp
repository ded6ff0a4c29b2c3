#pragma once
/// What the five programs share: options, exit codes, progress, Ctrl-C. Only tools/ link this.
///
/// A tool declares its options on app(), its examples with example(), and hands its work to run(). Everything that speaks of
/// options (--help, man page, completion, suggestions) is made from that one declaration.
#include <CLI/CLI.hpp>
#include <base/error.hpp>
#include <base/progress.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace sloper::cli {

/// One program. Declares -h, -q, -v, -V/--version, --no-progress, --threads, --generate-man and --generate-completion itself.
class Tool {
public:
  /// @param name     "drape"
  /// @param summary  one sentence for --help, man page and completion
  Tool(const std::string& name, const std::string& summary);
  ~Tool();
  Tool(const Tool&) = delete;
  Tool& operator=(const Tool&) = delete;

  CLI::App& app();                                                        ///< add options here
  void example(const std::string& command_line, const std::string& what); ///< for --help and the man page
  /// Formats read and written, for --version: formats("body.json (version 1)", "shirt.json (version 1), OBJ").
  void formats(const std::string& read, const std::string& written);
  /// Warnings and -v lines to stderr, a progress line with ETA on a terminal only, Ctrl-C as stop_requested().
  Reporter& reporter();
  const std::string& name() const;

  /// Parses, runs `body`, catches everything once. `body` returns the exit code.
  ///
  /// An unknown option, a missing value or a wrong one is exit 2 (never CLI11's 104-109); no arguments at all is a short usage
  /// on stderr and exit 2. Outputs whose folder is missing or not writable are refused before `body` runs (exit 5).
  /// Sets the thread count, ignores SIGPIPE, and turns the first SIGINT or SIGTERM into stop_requested(); the second one kills.
  int run(int argc, char** argv, const std::function<int()>& body);

private:
  struct Impl;
  std::unique_ptr<Impl> m_impl;
};

/// Validators for CLI11, whose own accept NaN, 1e400 and 0x10 and refuse "-".

/// A plain decimal number in [low, high]. @param unit  shown in the help, such as "m"; empty for a pure number
CLI::Validator finite_in(double low, double high, const std::string& unit);
/// An existing file, or "-". A file that is not there is bad input: exit 3.
CLI::Validator input_file();
/// A file to be written, or "-". Tool::run checks its folder before the work starts: exit 5.
CLI::Validator output_file();
/// One of some words; the complaint suggests the nearest. Shown as a|b|c and offered by the completion.
CLI::Validator one_of(const std::vector<std::string>& words);

/// Processors that this process may use: affinity mask and cgroup quota, at least 1.
int available_processors();

} // namespace sloper::cli

#pragma once
/// What the five programs share: options, exit codes, progress, Ctrl-C. Only tools/ link this.
#include <CLI/CLI.hpp>
#include <base/error.hpp>
#include <base/progress.hpp>
#include <functional>
#include <string>

namespace sloper::cli {

/// Reporter of a tool: warnings and -v lines to stderr, a progress line with ETA on a terminal only, Ctrl-C as stop_requested().
class ToolReporter;

/// One program. Declares -q, -v, --version, --no-progress, --generate-man, --generate-completion itself.
class Tool {
public:
  /// @param name     "drape"
  /// @param summary  one sentence for --help, man page and completion
  Tool(const std::string& name, const std::string& summary);
  ~Tool();
  CLI::App& app();                                  ///< add options here
  void example(const std::string& command_line, const std::string& what);  ///< for --help and the man page
  Reporter& reporter();
  const std::string& name() const;
  /// Parses, runs `body`, catches everything once. `body` returns the exit code.
  int run(int argc, char** argv, const std::function<int()>& body);

private:
  struct Impl;
  Impl* m_impl;
};

/// Validators for CLI11 (its own accept NaN, refuse "-"). Lengths in metres.
CLI::Validator finite_in(double low, double high, const std::string& unit);
CLI::Validator input_file(); ///< an existing file, or "-"

} // namespace sloper::cli

#pragma once
/// Common parts of all programs: options, exit codes, progress, Ctrl-C. Only tools/ and
/// the samples' programs link this.
///
/// A tool declares its options with option() and flag(), its examples with example(), and
/// passes its work to run(). Help, man page, completion and suggestions are made from
/// that one declaration.
#include <functional>
#include <memory>
#include <sloper/base/error.hpp>
#include <sloper/base/progress.hpp>
#include <sloper/cli/options.hpp>
#include <string>
#include <vector>

namespace sloper::cli {

/// One program. Declares -h, -q, -v, -V/--version, --messages, --no-progress, --json-usage,
/// --threads, --generate-man and --generate-completion itself.
class Tool {
public:
  /// @param name     "drape"
  /// @param summary  one sentence for --help, man page and completion
  Tool(const std::string& name, const std::string& summary);
  ~Tool();
  Tool(const Tool&) = delete;
  Tool& operator=(const Tool&) = delete;

  /// An option or, where the name has no dash ("SCAN"), an operand.
  /// @param names  "-o,--output"
  /// @param value  where the value goes, which must live until run() returns; a vector takes an
  /// option that may be given again
  /// @param description  one sentence, for help, man page and completion
  Option option(const std::string& names, std::string& value, const std::string& description);
  /// One that may be given several times.
  Option option(const std::string& names, std::vector<std::string>& value,
                const std::string& description);
  /// One with a decimal number.
  Option option(const std::string& names, double& value, const std::string& description);
  /// One with a whole number.
  Option option(const std::string& names, int& value, const std::string& description);
  /// One without a value.
  Option flag(const std::string& names, bool& value, const std::string& description);
  /// For --help and the man page.
  void example(const std::string& command_line, const std::string& what);
  /// Formats read and written, for --version: formats("body.json (version 1)", "shirt.json (version
  /// 1), OBJ").
  void formats(const std::string& read, const std::string& written);
  /// Warnings and -v lines to stderr, a progress line with ETA on a terminal only, Ctrl-C as
  /// stop_requested().
  Reporter& reporter();
  /// A line on stderr that an option asked for, such as --explain: shown even with -q.
  void tell(const std::string& line);
  const std::string& name() const;
  /// For work that gives no result where it was cut short.
  /// @param output  the file that would be written
  /// @throws Error FAILED where Ctrl-C or SIGTERM came
  void require_not_stopped(const std::string& output) const;

  /// Parses the command line, runs `body`, catches everything once. `body` returns the
  /// exit status.
  ///
  /// An unknown option, a missing value or a wrong one is exit 2 (never CLI11's 104-109);
  /// no arguments at all is a short usage on stderr and exit 2. Outputs whose folder is
  /// missing or not writable are refused before `body` runs (exit 5). Sets the thread
  /// count, ignores SIGPIPE, and turns the first SIGINT or SIGTERM into stop_requested();
  /// the second one ends the process at once. After the first one the process ends by that
  /// signal once `body` has returned, whatever its status, so that a shell's loop ends too.
  /// @return the exit status, for main()
  int run(int argc, char** argv, const std::function<int()>& body);

private:
  struct Impl;
  std::unique_ptr<Impl> m_impl;
};

/// Processors that this process may use: affinity mask and cgroup quota, at least 1.
int available_processors();

} // namespace sloper::cli

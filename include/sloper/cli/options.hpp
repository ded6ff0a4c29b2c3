#pragma once
/// One option of a tool and what its value must be. CLI11, which is dear to compile, stays behind
/// this.
#include <functional>
#include <string>
#include <vector>

namespace CLI {
class Option;
}

namespace sloper::cli {

/// A condition on the value of an option: in words for the help, and as a test that
/// returns its complaint.
struct Check {
  std::string name;  ///< "finite_in": by which the option table knows it
  std::string words; ///< "0 to 1 m", "FILE", "a|b|c"
  std::function<std::string(const std::string&)> fault; ///< empty when the value will do
};

// CLI11's own checks accept NaN, 1e400 and 0x10 and refuse "-".

/// A plain decimal number in [low, high]. @param unit  shown in the help, such as "m"; empty for a
/// pure number
Check finite_in(double low, double high, const std::string& unit);
/// An existing file, or "-". A file that is not there is bad input: exit 3.
Check input_file();
/// A file to be written, or "-". Tool::run checks its folder before the work starts: exit 5.
Check output_file();
/// A file to be written in one format, or "-". The ending of its name, where it has one, is that
/// format's. @param ending  ".obj"
Check output_file_of(const std::string& ending);
/// A document with a mesh beside it, which cannot go to standard output.
Check document_file();
/// A document with a mesh beside it, or a mesh alone.
Check document_or_mesh_file();
/// One of some words; the complaint suggests the nearest. Shown as a|b|c and offered by the
/// completion.
Check one_of(const std::vector<std::string>& words);

/// An option and whether it is given.
using Given = std::pair<const char*, bool>;
/// @throws Error USAGE when `one` is given together with any of `others`, naming both
void refuse_together(const Given& one, std::initializer_list<Given> others);

/// A declared option, to say more of it: tool.option(...).required().check(input_file()).
class Option {
public:
  /// Made by Tool::option().
  explicit Option(CLI::Option* option) : m_option(option) {}
  /// Refuses values that fail the check: exit 2, or as the check says. Returns this, as
  /// the others do.
  Option& check(const Check& check);
  /// Exit 2 where it is missing.
  Option& required();
  Option& type_name(const std::string& word); ///< what stands for the value in the help: "LIST"
  /// The help shows the value that the variable has now as the default.
  Option& show_default();
  /// Whether the command line has it; known inside Tool::run's body.
  bool given() const;

private:
  CLI::Option* m_option;
};

} // namespace sloper::cli

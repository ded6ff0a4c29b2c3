#pragma once
/// The one option table: what CLI11 was given, as rows from which help, man page, completion and
/// suggestions are made.
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace sloper::cli {

/// One option, flag or operand, as the user sees it.
struct OptionRow {
  std::vector<std::string> shorts;  ///< "o", without the dash
  std::vector<std::string> longs;   ///< "output", without the dashes
  std::string operand;              ///< "SCAN" for a positional argument, else empty
  std::string value;                ///< "FILE", "M", "a|b|c"; empty for a flag
  std::vector<std::string> choices; ///< the words of one_of()
  std::string range;                ///< "0 to 1 m" of finite_in(), else empty
  std::string description, group;
  bool required = false, repeats = false, is_file = false;
  /// "-o, --output FILE"
  std::string spelling() const;
};

/// A command line of the help, and what it does.
struct Example {
  std::string command_line, what;
};

/// Everything that is known of a tool from outside.
struct ToolDescription {
  std::string name, summary, reads, writes;
  std::vector<OptionRow> rows; ///< in the order of declaration, hidden ones left out
  std::vector<Example> examples;
  /// "drape [OPTION]... -o FILE SCAN"
  std::string usage() const;
};

std::vector<OptionRow> option_rows(const CLI::App& app);

/// The text of the exit codes, the same in every tool: code and meaning.
const std::vector<std::pair<int, std::string>>& exit_codes();

/// Words of a text broken into lines of at most `width`, continuation lines indented by `indent`.
std::string wrap(const std::string& text, std::size_t width, std::size_t indent);

std::string upper(std::string text); ///< its letters a to z as capitals, in any locale

std::string help_text(const ToolDescription& tool);
std::string man_page(const ToolDescription& tool); ///< groff, section 1
/// JSON for programs: name, summary, usage, what is read and written, operands and options with
/// value, choices, range and whether they are required or repeat, exit statuses, examples.
std::string json_usage(const ToolDescription& tool);
std::string completion(const ToolDescription& tool,
                       const std::string& shell); ///< shell: bash, zsh or fish

} // namespace sloper::cli

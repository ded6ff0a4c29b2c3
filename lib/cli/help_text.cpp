#include <cli/option_table.hpp>

namespace sloper::cli {

static constexpr std::size_t WIDTH = 80, COLUMN = 28;

static std::string help_row(const OptionRow& row) {
  std::string head = "  " + row.spelling();
  std::string text = row.description;
  if (!row.range.empty())
    text += " [" + row.range + "]";
  if (row.repeats && row.operand.empty())
    text += " (may be repeated)";
  if (head.size() + 2 > COLUMN)
    head += "\n" + std::string(COLUMN, ' ');
  else
    head += std::string(COLUMN - head.size(), ' ');
  return head + wrap(text, WIDTH, COLUMN) + "\n";
}

std::string help_text(const ToolDescription& tool) {
  std::string out =
      wrap("Usage: " + tool.usage(), WIDTH, 11) + "\n" + wrap(tool.summary, WIDTH, 0) + ".\n";
  if (!tool.examples.empty())
    out += "\nExamples:\n";
  for (const Example& example : tool.examples)
    out += "  " + example.command_line + "\n      " + wrap(example.what, WIDTH, 6) + "\n";
  std::string operands, own, common;
  for (const OptionRow& row : tool.rows) {
    if (!row.operand.empty())
      operands += help_row(row);
    else if (row.group == "Common options")
      common += help_row(row);
    else
      own += help_row(row);
  }
  if (!operands.empty())
    out += "\nOperands:\n" + operands;
  if (!own.empty())
    out += "\nOptions:\n" + own;
  out += "\nCommon options:\n" + common;
  out += "\nExit status: ";
  std::string codes;
  for (const auto& [code, meaning] : exit_codes())
    codes += (codes.empty() ? "" : "; ") + std::to_string(code) + " " +
             meaning.substr(0, meaning.find_first_of(":("));
  while (codes.find(" ;") != std::string::npos)
    codes.erase(codes.find(" ;"), 1);
  out += wrap(codes, WIDTH, 13) + ".\n";
  return out + "More: man " + tool.name + "\n";
}

} // namespace sloper::cli

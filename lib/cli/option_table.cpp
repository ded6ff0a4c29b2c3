#include <cli/option_table.hpp>

#include <sstream>

namespace sloper::cli {

std::string OptionRow::spelling() const {
  if (!operand.empty())
    return operand;
  std::string out;
  for (const std::string& s : shorts)
    out += (out.empty() ? "-" : ", -") + s;
  for (const std::string& l : longs)
    out += (out.empty() ? "--" : ", --") + l;
  if (!value.empty())
    out += " " + value;
  return out;
}

std::string ToolDescription::usage() const {
  std::string out = name + " [OPTION]...";
  for (const OptionRow& row : rows)
    if (row.operand.empty() && row.required)
      out.append(row.shorts.empty() ? " --" : " -")
          .append(row.shorts.empty() ? row.longs.front() : row.shorts.front())
          .append(" ")
          .append(row.value);
  for (const OptionRow& row : rows)
    if (!row.operand.empty())
      out += row.required ? " " + row.operand : " [" + row.operand + "]";
  return out;
}

const std::vector<std::pair<int, std::string>>& exit_codes() {
  static const std::vector<std::pair<int, std::string>> codes = {
      {0, "done"},
      {1, "the answer is no (a check or a policy was not met)"},
      {2, "wrong command line"},
      {3, "bad or unreadable input"},
      {4, "computed, but failed: not found, not converged, or outside the tolerance; the best "
          "result is written and marked"},
      {5, "cannot write"},
      {70, "a mistake in the program itself, or out of memory"}};
  return codes;
}

std::string upper(std::string text) {
  for (char& c : text)
    c = static_cast<char>(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
  return text;
}

std::string wrap(const std::string& text, std::size_t width, std::size_t indent) {
  std::string out;
  std::size_t column = indent;
  std::stringstream stream(text);
  for (std::string word; stream >> word;) {
    if (column > indent && column + 1 + word.size() > width) {
      out.append("\n").append(indent, ' ');
      column = indent;
    } else if (column > indent) {
      out += ' ';
      ++column;
    }
    out += word;
    column += word.size();
  }
  return out;
}

} // namespace sloper::cli

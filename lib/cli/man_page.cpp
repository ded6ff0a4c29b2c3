#include <cli/option_table.hpp>
#include <sloper/base/version.hpp>

namespace sloper::cli {

/// Text safe for groff: backslashes and dashes escaped, no line that begins with a control
/// character.
static std::string roff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n'))
      out += std::string("\\&") + c;
    else
      out += c;
  }
  return out;
}

/// A long list of choices may break behind each.
static std::string breakable(const std::string& choices) {
  std::string out;
  for (const char c : choices)
    out += c == '|' ? std::string("|\\:") : std::string(1, c);
  return out;
}

static std::string man_row(const OptionRow& row) {
  std::string head;
  if (!row.operand.empty())
    head = "\\fI" + roff(row.operand) + "\\fR";
  for (const std::string& s : row.shorts)
    head += (head.empty() ? "" : ", ") + ("\\fB\\-" + roff(s)) + "\\fR";
  for (const std::string& l : row.longs)
    head += (head.empty() ? "" : ", ") + ("\\fB\\-\\-" + roff(l)) + "\\fR";
  if (row.operand.empty() && !row.value.empty())
    head += " \\fI" + breakable(roff(row.value)) + "\\fR";
  std::string text = row.description;
  if (!row.range.empty())
    text += " [" + row.range + "]";
  if (row.required)
    text += " (required)";
  if (row.repeats && row.operand.empty())
    text += " (may be repeated)";
  const std::string entry = ".TP\n" + head + "\n" + roff(text) + "\n";
  constexpr std::size_t LONG_CHOICES = 60; // no blanks to stretch where these break
  return row.value.size() > LONG_CHOICES ? ".na\n" + entry + ".ad\n" : entry;
}

std::string man_page(const ToolDescription& tool) {
  const std::string name = roff(tool.name);
  std::string out = ".TH " + upper(name) + " 1 \"\" \"Sloper " + VERSION + "\" \"Sloper\"\n";
  out += ".SH NAME\n" + name + " \\- " + roff(tool.summary) + "\n";
  out += ".SH SYNOPSIS\n.B " + name + "\n" + roff(tool.usage().substr(tool.name.size() + 1)) + "\n";
  out += ".SH DESCRIPTION\n" + roff(tool.summary) + ".\n";
  if (!tool.reads.empty())
    out += ".PP\nReads " + roff(tool.reads) + ".\n";
  if (!tool.writes.empty())
    out += ".PP\nWrites " + roff(tool.writes) + ".\n";
  out +=
      ".PP\nOperands are inputs, outputs are named. A single JSON document may be read from or "
      "written to a stream, named \\-.\n"
      "Outputs are written to a temporary file and renamed, so that a failed run never touches "
      "a file that is there.\n"
      "Ctrl\\-C stops within a step; the last good state is written, and the program ends by the "
      "signal (status 130 in a shell), so that a loop of a shell ends too. A second one ends it "
      "at once. SIGTERM does the same (143).\n";
  std::string own, common;
  for (const OptionRow& row : tool.rows)
    (row.group == "Common options" ? common : own) += man_row(row);
  out += ".SH OPTIONS\n" + own + ".SS Common options\n" + common;
  out += ".SH EXIT STATUS\n";
  for (const auto& [code, meaning] : exit_codes())
    out += ".TP\n.B " + std::to_string(code) + "\n" + roff(meaning) + "\n";
  out += ".SH UNITS\nMetres, kilograms, seconds, newtons and radians in every document and option, "
         "unless the name of a key or an\n"
         "option says otherwise (_deg, _mm). y is up, a body faces +z, +x is its left; its feet "
         "stand at y = 0.\n";
  out += ".SH ENVIRONMENT\n.TP\n.B NO_COLOR\nno colours when set and not empty\n.TP\n.B TERM\nno "
         "progress line and no colours when \"dumb\"\n";
  if (!tool.examples.empty())
    out += ".SH EXAMPLES\n";
  for (const Example& example : tool.examples)
    out += ".PP\n" + roff(example.what) + ":\n.PP\n.nf\n.RS\n" + roff(example.command_line) +
           "\n.RE\n.fi\n";
  out += ".SH SEE ALSO\n";
  std::string others;
  for (const char* other : {"scan-landmarks", "pattern-mesh", "drape", "retarget-garment",
                            "render-png", "material-fit", "make-pattern", "make-mannequin"})
    if (tool.name != other)
      others += (others.empty() ? "" : ", ") + ("\\fB" + roff(other)) + "\\fR(1)";
  for (const char* document :
       {"body.json", "panels.json", "garment.json", "report.json", "fit.json"})
    others += ", \\fB" + roff(document) + "\\fR(5)";
  return out + others + "\n";
}

} // namespace sloper::cli

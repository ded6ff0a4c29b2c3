#include <cli/option_table.hpp>
#include <sloper/base/error.hpp>

namespace sloper::cli {

static std::string join(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words)
    out += (out.empty() ? "" : " ") + word;
  return out;
}

static std::vector<std::string> spellings(const OptionRow& row) {
  std::vector<std::string> out;
  for (const std::string& s : row.shorts)
    out.push_back("-" + s);
  for (const std::string& l : row.longs)
    out.push_back("--" + l);
  return out;
}

static std::string bash(const ToolDescription& tool) {
  std::string function = "_" + tool.name;
  for (char& c : function)
    if (c == '-')
      c = '_';
  std::string out =
      "# bash completion for " + tool.name + "\n" + function +
      "() {\n  local word=\"${COMP_WORDS[COMP_CWORD]}\" before=\"${COMP_WORDS[COMP_CWORD-1]}\"\n  "
      "COMPREPLY=()\n  case \"$before\" in\n";
  std::string all, files, plain;
  for (const OptionRow& row : tool.rows) {
    const std::vector<std::string> names = spellings(row);
    for (const std::string& name : names) {
      all += (all.empty() ? "" : " ") + name;
      if (row.value.empty())
        continue;
      if (row.choices.empty())
        (row.is_file ? files : plain) += ((row.is_file ? files : plain).empty() ? "" : "|") + name;
      else
        out += "    " + name + ") mapfile -t COMPREPLY < <(compgen -W '" + join(row.choices) +
               "' -- \"$word\"); return ;;\n";
    }
  }
  if (!files.empty())
    out += "    " + files + ") mapfile -t COMPREPLY < <(compgen -f -- \"$word\"); return ;;\n";
  if (!plain.empty())
    out += "    " + plain + ") return ;;\n";
  out += "  esac\n  if [[ $word == -* ]]; then mapfile -t COMPREPLY < <(compgen -W '" + all +
         "' -- \"$word\")\n";
  return out +
         "  else mapfile -t COMPREPLY < <(compgen -f -- \"$word\"); fi\n}\ncomplete -o filenames "
         "-F " +
         function + " " + tool.name + "\n";
}

static std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'')
      out += "'\\''";
    else
      out += c;
  }
  return out + "'";
}

/// A description within a specification of zsh, whose fields brackets and colons delimit.
static std::string zsh_text(const std::string& description) {
  std::string out;
  for (const char c : description) {
    if (c == '[')
      out += "(";
    else if (c == ']')
      out += ")";
    else if (c == ':')
      out += "\\:";
    else
      out += c;
  }
  return out;
}

/// How zsh completes the value of an option.
static std::string zsh_action(const OptionRow& row) {
  if (!row.choices.empty())
    return std::string("(").append(join(row.choices)).append(")");
  const bool file = row.is_file || !row.operand.empty();
  return file ? "_files" : " ";
}

static std::string zsh(const ToolDescription& tool) {
  std::string out = "#compdef " + tool.name + "\n_arguments -s -S";
  const std::string separator = " \\\n  ", all = "*:", open = "[", colon = ":";
  for (const OptionRow& row : tool.rows) {
    if (!row.operand.empty())
      out += separator + quoted(all + row.operand + ":_files");
    const std::string star = row.repeats ? "*" : "";
    const std::string text = zsh_text(row.description);
    std::string value;
    if (!row.value.empty())
      value = colon + (row.choices.empty() ? row.value : "choice") + colon + zsh_action(row);
    for (const std::string& name : spellings(row))
      out += separator + quoted(star + name + open + text + "]" + value);
  }
  return out + "\n";
}

/// A description within the quotes of fish, which has its own escapes.
static std::string fish_text(const std::string& description) {
  std::string out;
  for (const char c : description) {
    if (c == '\'' || c == '\\')
      out += '\\';
    out += c;
  }
  return out;
}

static std::string fish(const ToolDescription& tool) {
  std::string out = "# fish completion for " + tool.name + "\n";
  for (const OptionRow& row : tool.rows) {
    if (!row.operand.empty())
      continue;
    out += "complete -c " + tool.name;
    for (const std::string& s : row.shorts)
      out += " -s " + s;
    for (const std::string& l : row.longs)
      out += " -l " + l;
    if (!row.value.empty())
      out += row.is_file ? " -r -F" : " -x";
    if (!row.choices.empty())
      out += " -a " + quoted(join(row.choices));
    out += " -d '" + fish_text(row.description) + "'\n";
  }
  return out;
}

std::string completion(const ToolDescription& tool, const std::string& shell) {
  if (shell == "bash")
    return bash(tool);
  if (shell == "zsh")
    return zsh(tool);
  if (shell == "fish")
    return fish(tool);
  throw Error(ErrorKind::USAGE, "option.wrong-value"_id, "", "",
              "--generate-completion: '" + shell + "' is not one of bash, zsh, fish");
}

} // namespace sloper::cli

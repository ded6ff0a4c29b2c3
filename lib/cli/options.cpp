#include <sloper/cli/options.hpp>

#include <CLI/CLI.hpp>
#include <cli/option_table.hpp>
#include <sloper/base/text.hpp>

namespace sloper::cli {

Option& Option::check(const Check& check) {
  m_option->check(CLI::Validator([fault = check.fault](std::string& text) { return fault(text); },
                                 check.words, check.name));
  return *this;
}

Option& Option::required() {
  m_option->required();
  return *this;
}

Option& Option::type_name(const std::string& word) {
  m_option->type_name(word);
  return *this;
}

Option& Option::show_default() {
  m_option->capture_default_str();
  return *this;
}

bool Option::given() const {
  return m_option->count() > 0;
}

/// The description of a validator by name, empty when the option has no such validator.
static std::string validator_text(CLI::Option& option, const std::string& name) {
  try {
    return option.get_validator(name)->get_description();
  } catch (const CLI::OptionNotFound&) {
    return {};
  }
}

static OptionRow row_of(CLI::Option& option) {
  OptionRow row;
  row.shorts = option.get_snames();
  row.longs = option.get_lnames();
  row.description = option.get_description();
  row.group = option.get_group();
  row.required = option.get_required();
  row.repeats = option.get_items_expected_max() > 1;
  if (option.get_positional()) {
    row.operand = upper(option.get_name(true));
    if (option.get_items_expected_max() > 1)
      row.operand += "...";
  }
  if (option.get_items_expected_max() > 0) {
    const std::string type = option.get_type_name();
    row.value = type.substr(0, type.find(':'));
    row.choices = split(validator_text(option, "one_of"), '|');
    row.range = validator_text(option, "finite_in");
    row.is_file = row.value == "FILE" || !validator_text(option, "input_file").empty() ||
                  !validator_text(option, "output_file").empty() ||
                  !validator_text(option, "document_file").empty();
    if (row.is_file && row.value == "TEXT")
      row.value = "FILE";
    if (!row.choices.empty() && row.value == "TEXT")
      row.value = validator_text(option, "one_of");
    if (row.value == "FLOAT" || row.value == "INT" || row.value == "UINT")
      row.value = "N";
    if (row.value == "N" && !row.range.empty()) { // the unit says more: --edge-length M
      const std::string unit = row.range.substr(row.range.rfind(' ') + 1);
      if (unit.size() <= 3 && unit.find_first_of("0123456789") == std::string::npos)
        row.value = upper(unit);
    }
    const std::string fallback = option.get_default_str();
    if (!fallback.empty() && row.description.find("default") == std::string::npos)
      row.description += " (default: " + fallback + ")";
  }
  return row;
}

std::vector<OptionRow> option_rows(const CLI::App& app) {
  std::vector<OptionRow> rows;
  for (const CLI::Option* option : app.get_options())
    if (!option->get_group().empty())
      rows.push_back(row_of(const_cast<CLI::Option&>(
          *option))); // CLI11 reads validators through non-const access only
  return rows;
}

} // namespace sloper::cli

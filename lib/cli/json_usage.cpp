#include <cli/option_table.hpp>
#include <nlohmann/json.hpp>

namespace sloper::cli {

using Json = nlohmann::ordered_json;

static Json row_json(const OptionRow& row) {
  Json out;
  if (!row.operand.empty()) {
    out["operand"] = row.operand;
  } else {
    out["names"] = Json::array();
    for (const std::string& name : row.shorts)
      out["names"].push_back("-" + name);
    for (const std::string& name : row.longs)
      out["names"].push_back("--" + name);
    out["value"] = row.value.empty() ? Json(nullptr) : Json(row.value);
  }
  if (!row.choices.empty())
    out["choices"] = row.choices;
  if (!row.range.empty())
    out["range"] = row.range;
  out["description"] = row.description;
  out["required"] = row.required;
  out["repeats"] = row.repeats;
  out["is_file"] = row.is_file;
  if (row.operand.empty())
    out["common"] = row.group == "Common options";
  return out;
}

std::string json_usage(const ToolDescription& tool) {
  Json out = {{"format", "usage"},
              {"version", 1},
              {"name", tool.name},
              {"summary", tool.summary},
              {"usage", tool.usage()}};
  out["reads"] = tool.reads;
  out["writes"] = tool.writes;
  out["operands"] = Json::array();
  out["options"] = Json::array();
  for (const OptionRow& row : tool.rows)
    out[row.operand.empty() ? "options" : "operands"].push_back(row_json(row));
  out["exit_statuses"] = Json::array();
  for (const auto& [code, meaning] : exit_codes())
    out["exit_statuses"].push_back({{"status", code}, {"meaning", meaning}});
  out["examples"] = Json::array();
  for (const Example& example : tool.examples)
    out["examples"].push_back({{"command", example.command_line}, {"what", example.what}});
  return out.dump(1) + "\n";
}

} // namespace sloper::cli

#include <garment/drape/edit_lines.hpp>
#include <sloper/base/error.hpp>
#include <sloper/pattern/edit/edits.hpp>
#include <sloper/pattern/seams/check_pattern.hpp>

namespace sloper::garment {

void EditLines::take_end(const io::Node& node) {
  if (!node.has("finish")) {
    m_ended = true;
    return;
  }
  const std::string finish = node.at("finish").string();
  if (finish != "warm" && finish != "replay" && finish != "cold")
    node.fail("json.unknown-word"_id, "unknown finish '" + finish + "'",
              "known are warm, replay and cold");
  if (finish == "cold" && !m_has_body)
    node.fail("drape.no-body"_id, "without a body the panels cannot be placed for a cold finish",
              "give --body, or finish warm");
  m_ended = true;
  if (finish == "cold")
    m_finish = Finish::COLD;
  else
    m_finish = finish == "replay" ? Finish::REPLAY : Finish::WARM;
}

EditLines::Taken EditLines::take(const std::string& line, const pattern::Pattern& pattern) {
  ++m_line;
  if (line.find_first_not_of(" \t") == std::string::npos)
    return {};
  const std::string place = "line " + std::to_string(m_line);
  if (!line.starts_with('{'))
    throw input_error("edit.bad-line"_id, place, "", "is no JSON object",
                      R"(write an edit such as {"edit": "scale", ...} on one line)");
  io::Json json = io::parse_json(line, place);
  const io::Node node(json, place);
  if (!node.is_object())
    node.fail("edit.bad-line"_id, "each line must be a JSON object: the header or one edit");
  io::Json document = m_head;
  if (node.has("format")) {
    m_head = json;
    m_head["edits"] = io::Json::array();
    document = json;
    if (!node.has("edits"))
      document["edits"] = io::Json::array();
  } else {
    if (node.at("edit").string() == "end") {
      take_end(node);
      return {};
    }
    if (m_head.is_null())
      node.fail("edit.bad-line"_id, "the header line is missing before the first edit",
                R"(begin with {"format": "edits", "version": 1, "length_unit": "cm"})");
    document["edits"].push_back(json);
  }
  const std::size_t count = document["edits"].size();
  pattern::Pattern next = pattern;
  pattern::apply_edits(next, document, place);
  if (count == 0)
    return {};
  pattern::require_sewable(next, place);
  return {count, std::move(next), std::move(document)};
}

void EditLines::log_taken(const Taken& taken) {
  for (const io::Json& edit : taken.document["edits"])
    m_log["edits"].push_back(edit);
  m_log["length_unit"] = taken.document["length_unit"];
}

} // namespace sloper::garment

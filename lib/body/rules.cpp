#include <base/error.hpp>
#include <body/rules.hpp>
#include <io/files.hpp>
#include <io/json.hpp>

#include <vector>

namespace sloper::body {

extern const char* const STANDARD_RULES; ///< generated from rules/standard.json

namespace {

void merge(std::map<std::string, double>& numbers, const std::string& text, const std::string& name, bool may_add) {
  const io::Json document = io::parse_json(text, name);
  const io::Node root(document, name);
  root.allow_only({"format", "version", "numbers"});
  if (root.string("format", "") != "landmark-rules") root.fail("is not a landmark-rules document", "its \"format\" must be \"landmark-rules\"");
  if (root.integer("version", 1) > 1) root.fail("is of a newer version than this program reads (1)");
  const io::Node table = root.at("numbers");
  for (const std::string& key : table.keys()) {
    const io::Node entry = table.at(key);
    if (!may_add && !numbers.count(key)) {
      std::vector<std::string> names;
      for (const auto& [known, value] : numbers) names.push_back(known);
      const std::string near = nearest_word(key, names.data(), names.data() + names.size());
      entry.fail("no rule has a number \"" + key + "\"", near.empty() ? "" : "did you mean \"" + near + "\"?");
    }
    if (entry.is_object()) {
      entry.allow_only({"value", "why"});
      numbers[key] = entry.at("value").number();
    } else numbers[key] = entry.number();
  }
}

} // namespace

Rules Rules::standard() {
  Rules rules;
  merge(rules.m_numbers, STANDARD_RULES, "built-in rules", true);
  return rules;
}

Rules Rules::read(const std::string& path) {
  Rules rules = standard();
  merge(rules.m_numbers, io::read_file(path), path, false);
  return rules;
}

double Rules::number(const std::string& name) const {
  const auto it = m_numbers.find(name);
  if (it == m_numbers.end()) throw Error(ErrorKind::INTERNAL, "", "", "no rule number \"" + name + "\"");
  return it->second;
}

} // namespace sloper::body

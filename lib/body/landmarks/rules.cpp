#include <sloper/base/error.hpp>
#include <sloper/body/landmarks/rules.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/json.hpp>

#include <algorithm>

namespace sloper::body {

extern const char* const STANDARD_RULES; ///< generated from rules/standard.json

namespace {

using Numbers = std::map<std::string, double>;
using Tree = std::map<std::string, std::vector<RuleChoice>>;

[[noreturn]] void unknown(const io::Node& at, const char* what, const std::string& name,
                          const std::vector<std::string>& known) {
  at.fail("rules.unknown-name"_id,
          std::string(what) + " \"" + name + "\"" + did_you_mean(name, known, "\""));
}

void merge_numbers(Numbers& numbers, const io::Node& table, bool may_add) {
  for (const std::string& key : table.keys()) {
    const io::Node entry = table.at(key);
    if (!may_add && !numbers.count(key)) {
      std::vector<std::string> names;
      for (const auto& [known, value] : numbers)
        names.push_back(known);
      unknown(entry, "no rule has a number", key, names);
    }
    if (entry.is_object()) {
      entry.allow_only({"value", "why", "sensitivity"});
      numbers[key] = entry.at("value").number();
    } else
      numbers[key] = entry.number();
  }
}

std::string one_of(const io::Node& when, const char* key,
                   std::initializer_list<const char*> values) {
  const std::string value = when.string(key, "");
  if (value.empty() || std::find(values.begin(), values.end(), value) != values.end())
    return value;
  std::string list;
  for (const char* v : values)
    list += std::string(list.empty() ? "\"" : ", \"") + v + "\"";
  when.at(key).fail("json.unknown-word"_id, "is \"" + value + "\"", "one of " + list);
}

void read_conditions(const io::Node& when, RuleChoice& rule) {
  when.allow_only({"figure", "stance", "skin"});
  rule.figure = one_of(when, "figure", {"female", "male"});
  rule.skin = one_of(when, "skin", {"own", "rebuilt"});
  rule.stance.clear();
  if (!when.has("stance"))
    return;
  const io::Node list = when.at("stance");
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string letter = list.at(i).string();
    if (letter != "T" && letter != "A" && letter != "I")
      list.at(i).fail("json.unknown-word"_id, "is \"" + letter + "\"",
                      "a stance is \"T\", \"A\" or \"I\"");
    rule.stance += letter;
  }
  if (rule.stance.empty())
    list.fail("rules.malformed"_id, "holds for no stance",
              "leave it out for any stance, or leave the rule out");
}

RuleChoice read_choice(const io::Node& entry, const std::string& place,
                       const std::vector<RuleChoice>* known) {
  RuleChoice rule;
  rule.name = entry.is_object() ? entry.at("rule").string() : entry.string();
  if (known) {
    const auto it = std::find_if(known->begin(), known->end(),
                                 [&](const RuleChoice& k) { return k.name == rule.name; });
    if (it == known->end()) {
      std::vector<std::string> names;
      for (const RuleChoice& k : *known)
        names.push_back(k.name);
      unknown(entry, (place + " has no rule").c_str(), rule.name, names);
    }
    rule = *it;
  }
  if (!entry.is_object())
    return rule;
  entry.allow_only({"rule", "why", "when", "confidence", "spread_m", "uses", "measured"});
  rule.why = entry.string("why", rule.why);
  if (entry.has("when"))
    read_conditions(entry.at("when"), rule);
  rule.confidence = entry.number("confidence", rule.confidence);
  rule.spread_m = entry.number("spread_m", rule.spread_m);
  if (rule.confidence < 0 || rule.confidence > 1)
    entry.at("confidence").fail("json.out-of-range"_id, "is outside 0..1");
  if (rule.spread_m < 0)
    entry.at("spread_m").fail("json.out-of-range"_id, "is negative");
  if (!entry.has("uses"))
    return rule;
  const io::Node uses = entry.at("uses");
  if (known)
    uses.fail("rules.malformed"_id,
              "says which numbers a rule of the program uses, which a file cannot change");
  for (std::size_t i = 0; i < uses.size(); ++i)
    rule.uses.push_back(uses.at(i).string());
  return rule;
}

void merge_tree(Tree& tree, const io::Node& table, bool may_add) {
  for (const std::string& place : table.keys()) {
    const io::Node list = table.at(place);
    const auto known = tree.find(place);
    if (!may_add && known == tree.end()) {
      std::vector<std::string> names;
      for (const auto& [name, rules] : tree)
        names.push_back(name);
      unknown(list, "the tree has no place", place, names);
    }
    if (!list.is_array())
      list.fail("json.wrong-type"_id, "is not a list of rules");
    std::vector<RuleChoice> rules;
    for (std::size_t i = 0; i < list.size(); ++i) {
      const RuleChoice rule = read_choice(list.at(i), place, may_add ? nullptr : &known->second);
      if (std::any_of(rules.begin(), rules.end(),
                      [&](const RuleChoice& other) { return other.name == rule.name; }))
        list.at(i).fail("rules.malformed"_id, "names \"" + rule.name + "\" again");
      rules.push_back(rule);
    }
    tree[place] = rules;
  }
}

void merge(Numbers& numbers, Tree& tree, const std::string& text, const std::string& name,
           bool may_add) {
  const io::Json document = io::parse_json(text, name);
  const io::Node root(document, name);
  if (const std::string format = root.string("format", ""); format != "landmark-rules")
    root.fail("json.wrong-format"_id,
              format.empty() ? "is not a landmark-rules document"
                             : "is a \"" + format + "\" document",
              "give rules as lib/body/landmarks/rules/standard.json has them, with \"format\": "
              "\"landmark-rules\"");
  root.allow_only({"format", "version", "numbers", "tree"});
  if (root.integer("version", 1) > 1)
    root.fail("json.newer-version"_id, "is of a newer version than this program reads (1)");
  if (!root.has("numbers") && !root.has("tree"))
    root.fail("rules.malformed"_id, "has neither \"numbers\" nor \"tree\"");
  if (root.has("numbers"))
    merge_numbers(numbers, root.at("numbers"), may_add);
  if (root.has("tree"))
    merge_tree(tree, root.at("tree"), may_add);
}

} // namespace

bool RuleChoice::applies(const Situation& situation) const {
  return (figure.empty() || (figure == "female") == situation.female) &&
         (stance.empty() || stance.find(situation.stance) != std::string::npos) &&
         (skin.empty() || (skin == "rebuilt") == situation.rebuilt);
}

Rules Rules::standard() {
  Rules rules;
  merge(rules.m_numbers, rules.m_tree, STANDARD_RULES, "built-in rules", true);
  return rules;
}

Rules Rules::read(const std::string& path) {
  Rules rules = standard();
  merge(rules.m_numbers, rules.m_tree, io::read_file(path), path, false);
  return rules;
}

double Rules::number(const std::string& name) const {
  const auto it = m_numbers.find(name);
  if (it == m_numbers.end())
    throw Error(ErrorKind::INTERNAL, "general.internal"_id, "", "",
                "no rule number \"" + name + "\"");
  return it->second;
}

const std::vector<RuleChoice>& Rules::order(const std::string& place) const {
  const auto it = m_tree.find(place);
  if (it == m_tree.end())
    throw Error(ErrorKind::INTERNAL, "general.internal"_id, "", "",
                "the tree has no place \"" + place + "\"");
  return it->second;
}

} // namespace sloper::body

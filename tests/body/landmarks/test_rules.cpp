#include <gtest/gtest.h>
#include <sloper/base/error.hpp>
#include <sloper/body/landmarks/rules.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <unistd.h>

using namespace sloper;
using namespace sloper::body;

namespace {

std::string write_temporary(const std::string& text) {
  const auto path = std::filesystem::temp_directory_path() /
                    ("sloper-rules-" + std::to_string(::getpid()) + ".json");
  std::ofstream(path) << text;
  return path.string();
}

} // namespace

TEST(Rules, a_file_replaces_numbers_by_name) {
  const std::string path = write_temporary(
      R"({"format": "landmark-rules", "version": 1, "numbers": {"neck_back.height": {"value": 0.9}}})");
  const Rules rules = Rules::read(path);
  EXPECT_EQ(rules.number("neck_back.height"), 0.9);
  EXPECT_EQ(rules.number("elbow.of_arm"), Rules::standard().number("elbow.of_arm"));
  std::filesystem::remove(path);
}

TEST(Rules, an_unknown_name_is_refused_with_a_suggestion) {
  const std::string path = write_temporary(
      R"({"format": "landmark-rules", "version": 1, "numbers": {"neck_back.heigth": 0.9}})");
  try {
    Rules::read(path);
    FAIL() << "was read";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("neck_back.height"), std::string::npos) << e.what();
  }
  std::filesystem::remove(path);
}

TEST(Rules, an_unknown_place_or_rule_or_condition_is_refused) {
  for (const auto& [tree, part] :
       {std::pair(R"({"wirst": []})", "wrist"),
        std::pair(R"({"wrist": ["arm_ration"]})", "arm_ratio"),
        std::pair(R"({"wrist": [{"rule": "arm_ratio", "when": {"stance": ["X"]}}]})", "stance"),
        std::pair(R"({"wrist": [{"rule": "arm_ratio", "when": {"sex": "f"}}]})", "sex"),
        std::pair(R"({"wrist": [{"rule": "arm_ratio", "uses": []}]})", "uses"),
        std::pair(R"({"wrist": ["arm_ratio", "arm_ratio"]})", "again"),
        std::pair(R"({"wrist": "arm_ratio"})", "list")}) {
    const std::string path = write_temporary(
        std::string(R"({"format": "landmark-rules", "version": 1, "tree": )") + tree + "}");
    try {
      Rules::read(path);
      ADD_FAILURE() << tree << " was read";
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << tree << ": " << e.what();
    }
    std::filesystem::remove(path);
  }
}

TEST(Rules, the_tree_names_its_numbers_and_says_why) {
  const Rules rules = Rules::standard();
  std::set<std::string> used;
  for (const auto& [place, list] : rules.tree()) {
    EXPECT_FALSE(list.empty()) << place;
    for (const RuleChoice& rule : list) {
      EXPECT_FALSE(rule.why.empty()) << place << " " << rule.name;
      for (const std::string& number : rule.uses) {
        EXPECT_TRUE(rules.has(number)) << place << " " << rule.name << " " << number;
        used.insert(number);
      }
    }
  }
  for (const auto& [name, value] :
       rules.numbers()) // the first questions, and the girths' numbers, belong to no place
    EXPECT_TRUE(used.count(name) || name.starts_with("figure.") || name.starts_with("neck.") ||
                name.starts_with("neck_base."))
        << name << " is used by no rule";
}

TEST(Rules, conditions_ask_for_figure_stance_and_skin) {
  RuleChoice rule;
  EXPECT_TRUE(rule.applies({true, 'A', false}));
  rule.figure = "male";
  rule.stance = "AI";
  rule.skin = "own";
  EXPECT_TRUE(rule.applies({false, 'I', false}));
  EXPECT_FALSE(rule.applies({true, 'I', false}));
  EXPECT_FALSE(rule.applies({false, 'T', false}));
  EXPECT_FALSE(rule.applies({false, 'I', true}));
}

TEST(Rules, every_built_in_number_is_finite) {
  const Rules rules = Rules::standard();
  for (const auto& [name, value] : rules.numbers())
    EXPECT_TRUE(std::isfinite(value)) << name;
}

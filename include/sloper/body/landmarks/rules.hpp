#pragma once
/// The decision tree of the landmark rules and its numbers, as data: built in, or from
/// --rules FILE.
///
/// For every place (a landmark without its side, or a level) the tree lists rules in the
/// order in which they are tried. A rule is tried when its conditions hold for the body;
/// the first that finds the place decides. A place that no rule finds is not found.
/// Test: tests/body/landmarks/test_rules.cpp
#include <map>
#include <string>
#include <vector>
namespace sloper::body {

/// Facts about a body that the conditions of a rule refer to.
struct Situation {
  bool female = false;  ///< proportions; "figure": "female" or "male"
  char stance = 'A';    ///< "stance": 'T', 'A' or 'I'
  bool rebuilt = false; ///< "skin": "own" (the scan's faces) or "rebuilt"
};

/// One rule of a place.
struct RuleChoice {
  /// Name of the rule, and the reason for its place in the tree.
  std::string name, why;
  std::string figure, stance, skin; ///< conditions; empty: any. stance: letters of those it is for
  double confidence = 0.5;          ///< 0..1, of its result
  double spread_m = 0.01;           ///< usual spread, where none is measured
  std::vector<std::string> uses;    ///< names of its numbers
  /// Whether all three conditions hold; an empty one always does.
  bool applies(const Situation& situation) const;
};

/// The decision tree with its numbers.
class Rules {
public:
  /// The rules embedded at build time (lib/body/landmarks/rules/standard.json).
  static Rules standard();
  /// The built-in rules with the numbers and the places of a file in place of theirs. A
  /// place's list replaces the built-in one: its order is the new order, and rules that
  /// it leaves out are off; an entry is a rule's name, or an object that changes its
  /// conditions too.
  /// @param path  of the document
  /// @throws Error INPUT; an unknown number, place or rule is an error with a suggestion
  static Rules read(const std::string& path);
  /// Whether there is a number of that name.
  bool has(const std::string& name) const { return m_numbers.count(name) != 0; }
  /// A number of the rules; its name says its unit, without one it is a share of stature.
  /// @throws Error INTERNAL for an unknown name
  double number(const std::string& name) const;
  /// All numbers, by name.
  const std::map<std::string, double>& numbers() const { return m_numbers; }
  /// Rules of a place in the order in which they are tried.
  /// @throws Error INTERNAL when there is no such place
  const std::vector<RuleChoice>& order(const std::string& place) const;
  /// All places with their rules.
  const std::map<std::string, std::vector<RuleChoice>>& tree() const { return m_tree; }

private:
  std::map<std::string, double> m_numbers;
  std::map<std::string, std::vector<RuleChoice>> m_tree;
};

} // namespace sloper::body

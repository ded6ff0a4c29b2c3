#pragma once
/// The decision tree of the landmark rules and its numbers, as data: built in, or from --rules
/// FILE.
///
/// For every place (a landmark without its side, or a level) the tree lists rules in the order in
/// which they are tried. A rule is tried when its conditions hold for the body at hand; the first
/// that finds the place has it. What no rule finds is not found.
#include <map>
#include <string>
#include <vector>
namespace sloper::body {

/// What the tree may ask about a body before it tries a rule.
struct Situation {
  bool female = false;  ///< proportions; "figure": "female" or "male"
  char stance = 'A';    ///< "stance": 'T', 'A' or 'I'
  bool rebuilt = false; ///< "skin": "own" (the scan's faces) or "rebuilt"
};

/// One rule of a place.
struct RuleChoice {
  std::string name, why;
  std::string figure, stance, skin; ///< conditions; empty: any. stance: letters of those it is for
  double confidence = 0.5;          ///< 0..1 of what it finds
  double spread_m = 0.01;           ///< usual spread, where none is measured
  std::vector<std::string> uses;    ///< names of its numbers
  bool applies(const Situation& situation) const;
};

class Rules {
public:
  /// The rules embedded at build time (lib/body/landmarks/rules/standard.json).
  static Rules standard();
  /// The built-in rules with the numbers and the places of `path` in place of theirs. A place's
  /// list replaces the built-in one: its order is the new order, what it leaves out is off; an
  /// entry is a rule's name, or an object that changes its conditions too.
  /// @throws Error INPUT; an unknown number, place or rule is an error with a suggestion.
  static Rules read(const std::string& path);
  bool has(const std::string& name) const { return m_numbers.count(name) != 0; }
  double
  number(const std::string& name) const; ///< @throws Error INTERNAL when there is no such number
  const std::map<std::string, double>& numbers() const { return m_numbers; }
  const std::vector<RuleChoice>&
  order(const std::string& place) const; ///< @throws Error INTERNAL when there is no such place
  const std::map<std::string, std::vector<RuleChoice>>& tree() const { return m_tree; }

private:
  std::map<std::string, double> m_numbers;
  std::map<std::string, std::vector<RuleChoice>> m_tree;
};

} // namespace sloper::body

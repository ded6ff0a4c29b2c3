#pragma once
/// The numbers and choices of the landmark rules, as data: built in, or from --rules FILE.
#include <map>
#include <string>
namespace sloper::body {

class Rules {
public:
  /// The rules embedded at build time (lib/body/rules/standard.json).
  static Rules standard();
  /// The built-in rules with the numbers of `path` in their place. @throws Error INPUT; an unknown name is an error.
  static Rules read(const std::string& path);
  bool has(const std::string& name) const { return m_numbers.count(name) != 0; }
  double number(const std::string& name) const; ///< @throws Error INTERNAL when there is no such number
  const std::map<std::string, double>& numbers() const { return m_numbers; }

private:
  std::map<std::string, double> m_numbers;
};

} // namespace sloper::body

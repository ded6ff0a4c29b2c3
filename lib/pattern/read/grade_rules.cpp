#include <sloper/base/error.hpp>
#include <sloper/base/text.hpp>
#include <sloper/base/units.hpp>
#include <sloper/pattern/read/grade_rules.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

namespace sloper::pattern {
namespace {

constexpr double LARGEST_MOVE = 1e6; // file units

std::string upper_case(std::string s) {
  std::transform(s.begin(), s.end(), s.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return s;
}

/// Words parted by blanks, commas or semicolons.
std::vector<std::string> split_words(const std::string& text) {
  std::vector<std::string> out;
  std::string word;
  for (char c : text + " ") {
    if (c != ' ' && c != '\t' && c != '\r' && c != ',' && c != ';')
      word += c;
    else if (!word.empty()) {
      out.push_back(word);
      word.clear();
    }
  }
  return out;
}

} // namespace

int GradeRules::find_size(const std::string& name) const {
  const auto it = std::find(sizes.begin(), sizes.end(), name);
  return it == sizes.end() ? -1 : static_cast<int>(it - sizes.begin());
}

GradeRules parse_grade_rules(const std::string& text, const std::string& file) {
  GradeRules rules;
  double unit = units::MM;
  std::string sample;
  int number_of_rule = 0, line_number = 0, first_line = 0;
  std::vector<double> numbers;
  const auto fail = [&](int line, const std::string& fact, const std::string& next) {
    throw input_error("grading.malformed"_id, file, "line " + std::to_string(line), fact, next);
  };
  const auto finish = [&] {
    if (number_of_rule == 0)
      return;
    if (numbers.size() != 2 * rules.sizes.size())
      fail(first_line,
           "rule " + std::to_string(number_of_rule) + " has " + std::to_string(numbers.size()) +
               " numbers for " + std::to_string(rules.sizes.size()) + " sizes",
           "give one x,y pair for each size of SIZE LIST");
    std::vector<Vec2> moves;
    for (std::size_t k = 0; k + 1 < numbers.size(); k += 2)
      moves.push_back(Vec2(numbers[k], numbers[k + 1]) * unit);
    if (!rules.moves.emplace(number_of_rule, moves).second)
      fail(first_line, "rule " + std::to_string(number_of_rule) + " is given twice",
           "give each rule once");
    number_of_rule = 0;
    numbers.clear();
  };
  const auto add_number = [&](const std::string& word) {
    double x = 0;
    const char* begin = word.data() + (word[0] == '+');
    const auto [end, error] = std::from_chars(begin, word.data() + word.size(), x);
    if (error != std::errc() || end != word.data() + word.size() || !(std::abs(x) <= LARGEST_MOVE))
      fail(line_number, "'" + word + "' is not a number, or far out of range", "give x,y pairs");
    numbers.push_back(x);
  };
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    ++line_number;
    const std::size_t colon = line.find(':');
    const std::string key = colon == std::string::npos ? "" : upper_case(line.substr(0, colon)),
                      value = colon == std::string::npos ? line : line.substr(colon + 1);
    const std::vector<std::string> words = split_words(value);
    if (key == "UNITS" && !words.empty()) {
      const std::string word = upper_case(words[0]);
      unit = word == "CM" ? units::CM : units::MM;
      for (const char* inches : {"ENGL", "INCH", "IMPERIAL"})
        if (word.rfind(inches, 0) == 0)
          unit = units::INCH;
    } else if (key == "SIZE LIST")
      rules.sizes = words;
    else if (key == "SAMPLE SIZE" && !words.empty())
      sample = words[0];
    else if (key == "GRADE RULE TABLE" && !words.empty())
      rules.table = words[0];
    else if (key == "RULE") {
      finish();
      if (words.size() < 2 || upper_case(words[0]) != "DELTA")
        fail(line_number, "'" + value + "' is not a rule", "write RULE: DELTA <number>");
      const auto [end, error] =
          std::from_chars(words[1].data(), words[1].data() + words[1].size(), number_of_rule);
      if (error != std::errc() || end != words[1].data() + words[1].size() || number_of_rule <= 0)
        fail(line_number, "'" + words[1] + "' is not a rule number",
             "give a positive whole number");
      first_line = line_number;
      for (std::size_t k = 2; k < words.size(); ++k)
        add_number(words[k]); // PolyPattern writes them on the line of their rule
    } else if (key.empty() && number_of_rule > 0) {
      if (words.size() == 1 && upper_case(words[0]) == "END")
        break;
      for (const std::string& word : words)
        add_number(word);
    }
  }
  finish();
  if (rules.sizes.empty())
    throw input_error("grading.malformed"_id, file, "", "there is no SIZE LIST",
                      "give an AAMA / ASTM grade rule table");
  rules.sample = rules.find_size(sample);
  if (rules.sample < 0)
    throw input_error("grading.malformed"_id, file, "SAMPLE SIZE",
                      "'" + sample + "' is not in the size list", "name one of the sizes");
  for (const auto& [number, moves] : rules.moves)
    if (const double off = moves[rules.sample].norm(); off > 1e-6)
      throw input_error("grading.moves-sample"_id, file, "rule " + std::to_string(number),
                        "moves the sample size by " + sloper::centimetres(off, 2),
                        "count the moves from the sample size, which itself stays");
  return rules;
}

void grade_ring(std::vector<Vec2>& ring, const std::vector<int>& rule, const GradeRules& rules,
                int size) {
  const std::size_t n = ring.size();
  std::vector<std::size_t> graded;
  for (std::size_t k = 0; k < n; ++k)
    if (rule[k] > 0 && rules.moves.count(rule[k]))
      graded.push_back(k);
  if (graded.empty())
    return;
  const auto move = [&](std::size_t k) { return rules.moves.at(rule[k])[size]; };
  std::vector<Vec2> out = ring;
  for (std::size_t g = 0; g < graded.size(); ++g) {
    const std::size_t from = graded[g], to = g + 1 < graded.size() ? graded[g + 1] : graded[0] + n;
    double total = 0;
    for (std::size_t k = from; k < to; ++k)
      total += (ring[(k + 1) % n] - ring[k % n]).norm();
    const Vec2 a = move(from), b = move(to % n);
    double along = 0;
    for (std::size_t k = from; k < to; ++k) {
      out[k % n] = ring[k % n] + a + (total > 0 ? along / total : 0.0) * (b - a);
      along += (ring[(k + 1) % n] - ring[k % n]).norm();
    }
  }
  ring = std::move(out);
}

} // namespace sloper::pattern

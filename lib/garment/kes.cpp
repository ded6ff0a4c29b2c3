#include <garment/kes.hpp>
#include <sloper/base/error.hpp>
#include <sloper/base/units.hpp>
#include <sloper/cloth/bending_plates.hpp>
#include <sloper/garment/materials.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/json.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

namespace sloper::garment {

namespace {

constexpr double GF_CM = 0.980665;  // 1 gf/cm in N/m
constexpr double FULL_LOAD = 500;   // gf/cm: end of the KES-F1 tensile test
constexpr double WEARING_LOAD = 50; // N/m
constexpr double FAST_SHEAR = 123;  // N/m times per cent: De Boos and Tester 1994
constexpr double DEGREES = 180 / units::PI;

struct Unit {
  const char* property;
  const char* name; ///< without dots, blanks, stars; the first of a property is its default
  double factor;    ///< to SI
};
constexpr Unit UNITS[] = {
    {"W", "mg/cm2", 1e-2},
    {"W", "g/m2", 1e-3},
    {"W", "kg/m2", 1},
    {"B", "gfcm2/cm", GF_CM * 1e-4},
    {"B", "gfcm", GF_CM * 1e-4},
    {"B", "unm", 1e-6},
    {"B", "nm", 1},
    {"B", "nm2/m", 1},
    {"G", "gf/cmdeg", GF_CM* DEGREES},
    {"G", "gf/cm/deg", GF_CM* DEGREES},
    {"G", "n/m", 1},
    {"G", "n/mrad", 1},
    {"G", "n/mdeg", DEGREES},
    {"EMT", "%", 1e-2},
    {"E5", "%", 1e-2},
    {"E20", "%", 1e-2},
    {"E100", "%", 1e-2},
    {"LT", "", 1},
    {"LT", "-", 1},
    {"C", "mm", 1e-3},
    {"C", "cm", 1e-2},
    {"C", "m", 1},
    {"L", "mm", 1e-3},
    {"L", "cm", 1e-2},
    {"L", "m", 1},
    {"EB5", "%", 1e-2},
    {"MIU", "", 1},
    {"MIU", "-", 1},
    {"T0", "mm", 1e-3},
    {"T0", "m", 1},
    {"T", "mm", 1e-3},
};

/// One measured property, SI; NaN where it was not given. Mean values fill both directions.
struct Value {
  double warp = NAN, weft = NAN;
  double bias = NAN; ///< at 45 degrees, where it was given as such
  double mean() const {
    if (std::isnan(warp))
      return weft;
    return std::isnan(weft) ? warp : 0.5 * (warp + weft);
  }
  bool given() const { return !std::isnan(mean()); }
};
using Values = std::map<std::string, Value>;

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r\""), last = text.find_last_not_of(" \t\r\"");
  return first == std::string::npos ? std::string() : text.substr(first, last - first + 1);
}

std::string lower(std::string text) {
  for (char& c : text)
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// Of a column of a table with one property a row: warp, weft, bias, their mean; a space of others.
char direction_of(const std::string& column) {
  if (column == "warp")
    return '1';
  if (column == "weft")
    return '2';
  if (column == "bias")
    return '3';
  return column == "mean" || column == "value" ? 'm' : ' ';
}

std::vector<std::string> cells(const std::string& line) {
  char separator = ',';
  if (line.find('\t') != std::string::npos)
    separator = '\t';
  if (line.find(';') != std::string::npos)
    separator = ';';
  std::vector<std::string> out;
  std::stringstream stream(line);
  for (std::string cell; std::getline(stream, cell, separator);)
    out.push_back(trimmed(cell));
  return out;
}

bool known(const std::string& property) {
  return std::any_of(std::begin(UNITS), std::end(UNITS),
                     [&](const Unit& u) { return property == u.property; });
}

class Reader {
public:
  explicit Reader(std::string file) : m_file(std::move(file)) {}

  double factor(int line, const std::string& property, const std::string& unit) const {
    std::string plain;
    for (char c : lower(unit))
      if (c != '.' && c != ' ' && c != '*' && c != '^' && c != '(' && c != ')' && c != '[' &&
          c != ']')
        plain += c;
    std::string names;
    for (const Unit& u : UNITS) {
      if (property != u.property)
        continue;
      if (plain.empty() || plain == u.name)
        return u.factor;
      names += (names.empty() ? "" : ", ") + std::string(u.name);
    }
    throw input_error("kes.malformed"_id, m_file, "line " + std::to_string(line),
                      "unit \"" + unit + "\" of " + property + " is not known",
                      "known are " + names);
  }

  double number(int line, const std::string& text) const {
    std::string plain = text;
    std::replace(plain.begin(), plain.end(), ',', '.'); // decimal comma between semicolons
    double value = 0;
    const auto r = std::from_chars(plain.data(), plain.data() + plain.size(), value);
    if (r.ec != std::errc() || r.ptr != plain.data() + plain.size() || !std::isfinite(value) ||
        value < 0)
      throw input_error("kes.malformed"_id, m_file, "line " + std::to_string(line),
                        "\"" + text + "\" is not a number of 0 or more");
    return value;
  }

private:
  std::string m_file;
};

/// "B-1 (gf.cm2/cm)" to property, direction ('1', '2', '3' or 'm') and unit.
struct Heading {
  std::string property, unit;
  char direction = 'm';
};
Heading heading(const std::string& cell) {
  Heading h;
  const auto bracket = cell.find_first_of("([");
  std::string name = trimmed(cell.substr(0, bracket));
  if (bracket != std::string::npos)
    h.unit = cell.substr(bracket);
  for (const auto& [ending, direction] : {std::pair{"-1", '1'},
                                          {"_1", '1'},
                                          {"-2", '2'},
                                          {"_2", '2'},
                                          {" warp", '1'},
                                          {"_warp", '1'},
                                          {"-warp", '1'},
                                          {" weft", '2'},
                                          {"_weft", '2'},
                                          {"-weft", '2'},
                                          {"-3", '3'},
                                          {"_3", '3'},
                                          {" bias", '3'},
                                          {"_bias", '3'},
                                          {"-bias", '3'}}) {
    const std::string end = ending;
    if (name.size() <= end.size() || lower(name.substr(name.size() - end.size())) != end)
      continue;
    h.direction = direction;
    name = trimmed(name.substr(0, name.size() - end.size()));
    break;
  }
  for (char& c : name)
    c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  h.property = name;
  return h;
}

void put(Values& values, const Heading& h, double si) {
  Value& v = values[h.property];
  if (h.direction == '3') {
    v.bias = si;
    return;
  }
  if (h.direction != '2')
    v.warp = si;
  if (h.direction != '1')
    v.weft = si;
}

/// B from bending lengths, where it was not measured itself: W g C^3, with C = L / 2 of an
/// overhang.
void bend_by_lengths(Values& values) {
  const double weight = values["W"].mean() * units::GRAVITY;
  auto fill = [&](double Value::*direction) {
    double length = values["C"].*direction;
    if (std::isnan(length))
      length = 0.5 * (values["L"].*direction);
    if (std::isnan(values["B"].*direction))
      values["B"].*direction = weight * length * length * length;
  };
  const bool bias_was_measured = !std::isnan(values["B"].bias);
  for (double Value::*direction : {&Value::warp, &Value::weft, &Value::bias})
    fill(direction);
  Value& b = values["B"];
  if (!bias_was_measured && b.bias > 0 && b.warp > 0 && b.weft > 0)
    b.bias = std::max(cloth::bias_of_strip(b.warp, b.weft, b.bias),
                      cloth::least_bias_rigidity(b.warp, b.weft));
}

/// Rigidities by direction, where what was measured differs.
void set_bending(const std::string& file, const Value& b, Material& m) {
  m.bend_n_m = b.mean();
  const bool differ = b.warp > 0 && b.weft > 0 && b.warp != b.weft;
  if (!differ && !(b.bias > 0))
    return;
  m.bend_warp_n_m = std::isnan(b.warp) ? b.weft : b.warp;
  m.bend_weft_n_m = std::isnan(b.weft) ? b.warp : b.weft;
  if (!(b.bias > 0))
    return;
  m.bend_bias_n_m = b.bias;
  if (b.bias < cloth::least_bias_rigidity(m.bend_warp_n_m, m.bend_weft_n_m))
    throw input_error("material.bias-too-soft"_id, file, "",
                      "the bias bends more easily than warp and weft allow",
                      "measure the strip at 45 degrees again");
}

/// Tension per width at unit strain, secant at WEARING_LOAD; 0 when nothing was measured.
double stretch(double emt, double lt, const Values& values, double Value::*direction) {
  if (emt > 0) {
    const double p = 2 / (lt > 0 ? lt : 1) - 1;
    return WEARING_LOAD / (emt * std::pow(WEARING_LOAD / (FULL_LOAD * GF_CM), 1 / p));
  }
  double nearest = 1e300, stiffness = 0;
  for (const auto& [name, load] : {std::pair{"E5", 5.0}, {"E20", 20.0}, {"E100", 100.0}}) {
    const auto found = values.find(name);
    if (found == values.end() || !(found->second.*direction > 0))
      continue;
    const double off = std::abs(std::log(load * GF_CM / WEARING_LOAD));
    if (off < nearest) {
      nearest = off;
      stiffness = load * GF_CM / (found->second.*direction);
    }
  }
  return stiffness;
}

} // namespace

Material read_kes(const std::string& path) {
  const auto hash = path.rfind('#');
  const std::string file = path.substr(0, hash),
                    wanted = hash == std::string::npos ? std::string() : path.substr(hash + 1);
  const Reader reader(file);
  std::stringstream text(io::read_file(file));
  Values values;
  std::vector<std::string> header, names;
  std::string chosen;
  bool wide = false;
  int number = 0;
  for (std::string line; std::getline(text, line);) {
    ++number;
    if (trimmed(line).empty() || trimmed(line)[0] == '#')
      continue;
    const std::vector<std::string> row = cells(line);
    if (header.empty()) {
      header = row;
      wide = std::any_of(row.begin() + 1, row.end(),
                         [](const std::string& cell) { return known(heading(cell).property); });
      continue;
    }
    if (const Heading h = heading(row[0]); !wide) { // one property per row
      if (!known(h.property))
        continue; // one that is not used
      std::string unit = h.unit;
      for (std::size_t c = 1; c < row.size() && c < header.size(); ++c)
        if (lower(header[c]) == "unit")
          unit = row[c];
      for (std::size_t c = 1; c < row.size() && c < header.size(); ++c) {
        const char d = direction_of(lower(header[c]));
        if (d == ' ' || row[c].empty() || (d == 'm' && values.count(h.property)))
          continue;
        put(values, {h.property, unit, d},
            reader.number(number, row[c]) * reader.factor(number, h.property, unit));
      }
      continue;
    }
    names.push_back(row[0]); // one fabric per row
    if (!wanted.empty() && row[0] != wanted)
      continue;
    if (!chosen.empty())
      throw input_error("kes.which-fabric"_id, file, "line " + std::to_string(number),
                        "the file has more than one fabric", "pick one with " + file + "#NAME");
    chosen = row[0];
    for (std::size_t c = 1; c < row.size() && c < header.size(); ++c) {
      const Heading h = heading(header[c]);
      if (known(h.property) && !row[c].empty())
        put(values, h, reader.number(number, row[c]) * reader.factor(number, h.property, h.unit));
    }
  }
  if (!wanted.empty() && chosen.empty()) {
    std::string list;
    for (const std::string& n : names)
      list += (list.empty() ? "" : ", ") + n;
    throw input_error("kes.which-fabric"_id, file, "fabric \"" + wanted + "\"",
                      "is not in the file", list.empty() ? "" : "there are " + list);
  }
  bend_by_lengths(values);
  if (!values["B"].given() || !values["W"].given())
    throw input_error("kes.malformed"_id, file, "",
                      values["W"].given() ? "the bending rigidity (B) or length (C, L) is missing"
                                          : "the weight (W) is missing",
                      "see Materials in the manual page drape(1)");
  Material m;
  m.name = chosen.empty() ? io::file_name(file) : chosen;
  m.density_kg_m2 = values["W"].mean();
  set_bending(file, values["B"], m);
  if (values["G"].given())
    m.shear_n_m = values["G"].mean();
  else if (values["EB5"].mean() > 0)
    m.shear_n_m = FAST_SHEAR / (100 * values["EB5"].mean());
  const double warp = stretch(values["EMT"].warp, values["LT"].warp, values, &Value::warp);
  const double weft = stretch(values["EMT"].weft, values["LT"].weft, values, &Value::weft);
  if (warp > 0)
    m.stretch_warp_n_m = warp;
  if (weft > 0)
    m.stretch_weft_n_m = weft;
  if (values["MIU"].given())
    m.friction_self = values["MIU"].mean();
  if (values["T0"].given())
    m.thickness_m = values["T0"].mean();
  else if (values["T"].given())
    m.thickness_m = values["T"].mean();
  m.source = "measured: " + io::file_name(file);
  return m;
}

} // namespace sloper::garment

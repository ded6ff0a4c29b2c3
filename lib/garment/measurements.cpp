#include <garment/measurements.hpp>
#include <sloper/base/error.hpp>
#include <sloper/base/units.hpp>
#include <sloper/io/files.hpp>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <sstream>
#include <vector>

namespace sloper::garment {

namespace {

constexpr double DEGREES = 180 / units::PI;
constexpr double LT_LIMIT = 2; // the curve would rise to its end at once

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

/// Values of the same instruments that a drape has no use for.
constexpr const char* UNUSED[] = {"WT",   "RT",  "2HB",   "2HG", "2HG3", "2HG5", "HB",  "HG",
                                  "HG5",  "LC",  "WC",    "RC",  "TM",   "MMD",  "SMD", "T2",
                                  "T100", "T2R", "T100R", "ST",  "STR",  "RS",   "HE",  "F"};

bool is_unused(const std::string& property) {
  return property.empty() || property[0] == '#' ||
         std::find(std::begin(UNUSED), std::end(UNUSED), property) != std::end(UNUSED);
}

/// Known properties without their direction, in the order of UNITS.
std::vector<std::string> properties() {
  std::vector<std::string> out;
  for (const Unit& u : UNITS)
    if (out.empty() || out.back() != u.property)
      out.emplace_back(u.property);
  return out;
}

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words)
    out += (out.empty() ? "" : ", ") + word;
  return out;
}

bool is_number(const std::string& text) {
  std::string plain = text;
  std::replace(plain.begin(), plain.end(), ',', '.'); // decimal comma between semicolons
  double value = 0;
  const auto r = std::from_chars(plain.data(), plain.data() + plain.size(), value);
  return r.ec == std::errc() && r.ptr == plain.data() + plain.size();
}

bool is_control(char c) {
  return std::iscntrl(static_cast<unsigned char>(c)) != 0;
}

std::string line_text(int line) {
  return "line " + std::to_string(line);
}
std::string column_text(int line, const std::string& column) {
  return line_text(line) + ", column \"" + column + "\"";
}

constexpr const char* LAYOUTS =
    "the first line names the columns: property,unit,warp,weft, or fabric,W,B-1,B-2 and others";

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

struct Row {
  int line = 0;
  std::vector<std::string> cells;
};

/// Rows that are neither empty nor comments; the first is the header.
std::vector<Row> rows_of(const std::string& file) {
  std::string content = io::read_file(file);
  constexpr const char* BYTE_ORDER_MARK = "\xef\xbb\xbf";
  if (content.rfind(BYTE_ORDER_MARK, 0) == 0)
    content.erase(0, std::string(BYTE_ORDER_MARK).size());
  std::stringstream text(content);
  std::vector<Row> rows;
  int number = 0;
  for (std::string line; std::getline(text, line);) {
    ++number;
    if (!trimmed(line).empty() && trimmed(line)[0] != '#')
      rows.push_back({number, cells(line)});
  }
  return rows;
}

/// One file of measurements: its rows, and what they say.
class Reader {
public:
  /// @throws Error INPUT where the first line is no header, or nothing is below it
  explicit Reader(const std::string& file) : m_file(file), m_rows(rows_of(file)) {
    if (m_rows.empty())
      throw malformed(line_text(1), "there are no values in the file", LAYOUTS);
    const Row& header = m_rows.front();
    for (const std::string& cell : header.cells)
      if (std::any_of(cell.begin(), cell.end(), is_control))
        throw malformed(line_text(header.line), "is not text", LAYOUTS);
    for (std::size_t c = 0; c < header.cells.size(); ++c) {
      const std::string name = lower(header.cells[c]);
      m_wide = m_wide || (c > 0 && known(heading(header.cells[c]).property));
      m_long = m_long || (c > 0 && direction_of(name) != ' ');
    }
    m_long = m_long && !m_wide;
    if (known(heading(header.cells[0]).property))
      throw malformed(column_text(header.line, header.cells[0]),
                      "stands where a column of names should", LAYOUTS);
    if (!m_wide && !m_long)
      throw unknown(header.line, "none of its columns is known: " + joined(header.cells), LAYOUTS);
    for (std::size_t c = 1; c < header.cells.size(); ++c)
      for (std::size_t before = 1; before < c; ++before)
        if (is_same_column(header.cells[before], header.cells[c]))
          throw twice(column_text(header.line, header.cells[c]));
    if (m_rows.size() == 1)
      throw malformed(line_text(header.line), "nothing was measured below the header",
                      "add a line for each " + std::string(m_wide ? "fabric" : "property"));
    for (const Row& row : m_rows)
      if (row.cells.size() > header.cells.size())
        throw malformed(line_text(row.line),
                        "has " + std::to_string(row.cells.size()) + " cells, the header " +
                            std::to_string(header.cells.size()),
                        "separate cells by semicolons where numbers have decimal commas");
  }

  /// What was measured of the fabric.
  /// @param wanted  its name; empty: the only one
  /// @param chosen  gets its name, empty where the file has none
  Values values(const std::string& wanted, std::string& chosen) const {
    Values out = m_wide ? of_fabric(wanted, chosen) : of_properties(wanted);
    need(out, {"W"}, "the weight (W)");
    need(out, {"B", "C", "L"}, "the bending rigidity (B) or length (C, L)");
    if (out["LT"].warp >= LT_LIMIT || out["LT"].weft >= LT_LIMIT)
      throw malformed(where(), "the linearity (LT) is 2 or more",
                      "it is the work of stretch over that of a straight line");
    return out;
  }

  /// Its lines, for messages about all of them.
  std::string where() const {
    return "lines " + std::to_string(m_rows.front().line) + " to " +
           std::to_string(m_rows.back().line);
  }

private:
  Error malformed(const std::string& place, const std::string& fact,
                  const std::string& next_step) const {
    return input_error("kes.malformed"_id, m_file, place, fact, next_step);
  }
  Error twice(const std::string& place) const {
    return input_error("kes.given-twice"_id, m_file, place, "is there twice", "keep one of them");
  }
  Error unknown(int line, const std::string& fact, const std::string& next_step) const {
    return input_error("kes.unknown-column"_id, m_file, line_text(line), fact, next_step);
  }
  Error unknown_property(int line, const char* what, const Heading& h,
                         const std::string& text) const {
    return unknown(line,
                   std::string(what) + " \"" + text + "\" is not known" +
                       did_you_mean(h.property, properties()),
                   "known are " + joined(properties()) +
                       (m_wide ? ", with -1 (warp), -2 (weft) or -3 (bias) behind them" : "") +
                       "; a name that begins with # is passed over");
  }

  bool is_same_column(const std::string& one, const std::string& other) const {
    if (m_long)
      return lower(one) == lower(other) &&
             (lower(one) == "unit" || direction_of(lower(one)) != ' ');
    const Heading a = heading(one), b = heading(other);
    return known(a.property) && a.property == b.property && a.direction == b.direction;
  }

  double factor(const std::string& place, const std::string& property,
                const std::string& unit) const {
    std::string plain;
    for (char c : lower(unit))
      if (c != '.' && c != ' ' && c != '*' && c != '^' && c != '(' && c != ')' && c != '[' &&
          c != ']')
        plain += c;
    std::vector<std::string> names;
    for (const Unit& u : UNITS) {
      if (property != u.property)
        continue;
      if (plain.empty() || plain == u.name)
        return u.factor;
      names.emplace_back(*u.name ? u.name : "none");
    }
    throw malformed(place, "unit \"" + unit + "\" of " + property + " is not known",
                    "known are " + joined(names));
  }

  double number(const std::string& place, const std::string& text) const {
    std::string plain = text;
    std::replace(plain.begin(), plain.end(), ',', '.'); // decimal comma between semicolons
    double value = 0;
    const auto r = std::from_chars(plain.data(), plain.data() + plain.size(), value);
    if (r.ec != std::errc() || r.ptr != plain.data() + plain.size() || !std::isfinite(value) ||
        value < 0)
      throw malformed(place, "\"" + text + "\" is not a number of 0 or more",
                      "write it as 0.085, or leave the cell empty");
    return value;
  }

  /// Directions win over the mean of both, in whatever order they stand.
  static void put(Value& v, char direction, double si) {
    if (direction == '3')
      v.bias = si;
    if (direction == '1' || (direction == 'm' && std::isnan(v.warp)))
      v.warp = si;
    if (direction == '2' || (direction == 'm' && std::isnan(v.weft)))
      v.weft = si;
  }

  static void note_place(Value& v, const std::string& place, const std::string& unit) {
    if (v.place.empty())
      v.place = place;
    if (unit.empty() && v.without_unit.empty())
      v.without_unit = place;
  }

  /// One property per row.
  Values of_properties(const std::string& wanted) const {
    if (!wanted.empty())
      throw input_error("kes.which-fabric"_id, m_file, "fabric \"" + wanted + "\"",
                        "is not in the file: it is of one fabric, a property per row",
                        "name the file without #" + wanted);
    const std::vector<std::string>& header = m_rows.front().cells;
    Values out;
    for (std::size_t r = 1; r < m_rows.size(); ++r) {
      const auto& [line, row] = m_rows[r];
      const Heading h = heading(row[0]);
      if (!known(h.property)) {
        if (!is_unused(h.property) && std::any_of(row.begin() + 1, row.end(), is_number))
          throw unknown_property(line, "property", h, row[0]);
        continue;
      }
      if (out.count(h.property))
        throw twice(line_text(line) + ", property \"" + row[0] + "\"");
      Value& value = out[h.property];
      std::string unit = h.unit;
      for (std::size_t c = 1; c < row.size(); ++c)
        if (lower(header[c]) == "unit")
          unit = row[c];
      for (const bool mean : {false, true})
        for (std::size_t c = 1; c < row.size(); ++c)
          if (!row[c].empty() && (direction_of(lower(header[c])) == 'm') == mean)
            put_cell(line, header[c], row[c], h.property, unit, value);
    }
    return out;
  }

  void put_cell(int line, const std::string& column, const std::string& cell,
                const std::string& property, const std::string& unit, Value& value) const {
    const char direction = direction_of(lower(column));
    if (direction != ' ') {
      put(value, direction,
          number(column_text(line, column), cell) * factor(line_text(line), property, unit));
      note_place(value, line_text(line) + ", property \"" + property + "\"", unit);
    } else if (lower(column) != "unit" && !column.empty() && column[0] != '#' && is_number(cell))
      throw unknown(m_rows.front().line, "column \"" + column + "\" is not known",
                    "known are unit, warp, weft, bias, mean, value; a name that begins with # is "
                    "passed over");
  }

  /// One fabric per row.
  Values of_fabric(const std::string& wanted, std::string& chosen) const {
    const Row* found = nullptr;
    std::vector<std::string> names;
    for (std::size_t r = 1; r < m_rows.size(); ++r) {
      names.push_back(m_rows[r].cells[0]);
      if (!wanted.empty() && names.back() != wanted)
        continue;
      if (found)
        throw input_error("kes.which-fabric"_id, m_file, line_text(m_rows[r].line),
                          wanted.empty() ? "the file has more than one fabric"
                                         : "the file has fabric \"" + wanted + "\" twice",
                          wanted.empty() ? "pick one with " + m_file + "#NAME"
                                         : "give each a name of its own");
      found = &m_rows[r];
    }
    if (!found)
      throw input_error("kes.which-fabric"_id, m_file, "fabric \"" + wanted + "\"",
                        "is not in the file", "there are " + joined(names));
    chosen = found->cells[0];
    const std::vector<std::string>& header = m_rows.front().cells;
    Values out;
    for (const bool mean : {false, true})
      for (std::size_t c = 1; c < found->cells.size(); ++c) {
        const std::string& cell = found->cells[c];
        const Heading h = heading(header[c]);
        if (cell.empty() || (h.direction == 'm') != mean)
          continue;
        if (known(h.property)) {
          put(out[h.property], h.direction,
              number(column_text(found->line, header[c]), cell) *
                  factor(column_text(m_rows.front().line, header[c]), h.property, h.unit));
          note_place(out[h.property], column_text(found->line, header[c]), h.unit);
        } else if (!is_unused(h.property) && is_number(cell))
          throw unknown_property(m_rows.front().line, "column", h, header[c]);
      }
    return out;
  }

  /// One of some properties, and more than 0.
  void need(Values& values, std::initializer_list<const char*> any, const std::string& what) const {
    for (const char* property : any) {
      if (!values[property].given())
        continue;
      if (!(values[property].mean() > 0))
        throw malformed(where(), what + " is 0", "cloth has more than none");
      return;
    }
    throw malformed(where(), what + " is missing",
                    std::string("add a ") + (m_wide ? "column" : "row") + " " + *any.begin() +
                        "; drape(1) has the layout under Materials");
  }

  std::string m_file;
  std::vector<Row> m_rows;
  bool m_wide = false; ///< one fabric per row
  bool m_long = false; ///< one property per row
};

} // namespace

Measurements read_measurements(const std::string& path) {
  const auto hash = path.rfind('#');
  Measurements out;
  out.file = path.substr(0, hash);
  const std::string wanted = hash == std::string::npos ? std::string() : path.substr(hash + 1);
  const Reader reader(out.file);
  out.place = reader.where();
  out.values = reader.values(wanted, out.name);
  return out;
}

} // namespace sloper::garment

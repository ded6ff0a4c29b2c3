#include <pattern/read/dxf_blocks.hpp>
#include <sloper/base/error.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

namespace sloper::pattern {
namespace {

std::string_view trimmed(std::string_view s) {
  while (!s.empty() && (s.front() == ' ' || s.front() == '\t'))
    s.remove_prefix(1);
  while (!s.empty() && (s.back() == ' ' || s.back() == '\t' || s.back() == '\r'))
    s.remove_suffix(1);
  return s;
}

/// Bytes of the code point that begins with c in UTF-8; 0 where none does.
std::size_t utf8_length(unsigned char c) {
  if (c < 0x80)
    return 1; // 0.......
  if ((c >> 5) == 6)
    return 2; // 110.....
  if ((c >> 4) == 14)
    return 3;                    // 1110....
  return (c >> 3) == 30 ? 4 : 0; // 11110...
}

bool is_utf8(std::string_view s) {
  for (std::size_t k = 0; k < s.size();) {
    const std::size_t n = utf8_length(static_cast<unsigned char>(s[k]));
    if (n == 0 || k + n > s.size())
      return false;
    for (std::size_t i = 1; i < n; ++i)
      if ((static_cast<unsigned char>(s[k + i]) >> 6) != 2)
        return false;
    k += n;
  }
  return true;
}

/// Text that is not UTF-8 is taken as Latin-1, which every byte is.
std::string utf8(std::string_view s) {
  if (is_utf8(s))
    return std::string(s);
  std::string out;
  for (char raw : s) {
    const unsigned char c = static_cast<unsigned char>(raw);
    if (c < 0x80)
      out += raw;
    else {
      out += static_cast<char>(0xC0 | (c >> 6));
      out += static_cast<char>(0x80 | (c & 0x3F));
    }
  }
  return out;
}

/// Group code and value, two lines each.
class Tags {
public:
  Tags(const std::string& text, const std::string& file) : m_rest(text), m_file(file) {}
  bool next() {
    std::string_view code_line;
    do {
      if (!line(code_line))
        return false;
    } while (trimmed(code_line).empty());
    const std::string_view digits = trimmed(code_line);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), code);
    if (error != std::errc() || end != digits.data() + digits.size())
      fail("'" + utf8(digits.substr(0, 40)) + "' is not a group code");
    std::string_view value_line;
    if (!line(value_line))
      fail("the file ends within a group");
    value = trimmed(value_line);
    return true;
  }
  double number() const {
    double x = 0;
    std::string_view digits = value;
    if (!digits.empty() && digits.front() == '+')
      digits.remove_prefix(1);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), x);
    if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(x))
      fail(std::string("'").append(utf8(value.substr(0, 40))).append("' is not a number"));
    return x;
  }
  /// For flags and counts, which DXF keeps in 16 bits; some programs write them as 70.0.
  int whole() const {
    const double x = number();
    if (!(std::abs(x) <= 1e6))
      fail(std::string("'").append(utf8(value.substr(0, 40))).append("' is not a flag or count"));
    return static_cast<int>(x);
  }
  [[noreturn]] void fail(const std::string& fact) const {
    throw input_error("dxf.malformed"_id, m_file, "line " + std::to_string(m_line), fact,
                      "give a text DXF");
  }

  int code = 0;
  std::string_view value;

private:
  bool line(std::string_view& out) {
    if (m_rest.empty())
      return false;
    ++m_line;
    const std::size_t end = m_rest.find('\n');
    out = m_rest.substr(0, end);
    m_rest = end == std::string_view::npos ? std::string_view() : m_rest.substr(end + 1);
    return true;
  }
  std::string_view m_rest;
  std::string m_file;
  int m_line = 0;
};

/// One entity while its groups come in.
struct Entity {
  std::string kind;
  int layer = 0, flags = 0;
  std::vector<double> x, y;
  double x2 = 0, y2 = 0;
  std::string text;
};

} // namespace

DxfFile parse_dxf(const std::string& text, const std::string& file) {
  DxfFile out;
  Tags tags(text, file);
  std::string section, variable;
  Entity entity;
  DxfBlock* block = nullptr;
  DxfLine polyline;
  bool in_polyline = false;

  constexpr double FARTHEST = 1e9; // file units: a thousand kilometres of millimetres
  const auto finish = [&] {
    DxfBlock& target = block ? *block : out.loose;
    for (const auto& list : {entity.x, entity.y, {entity.x2, entity.y2}})
      for (double x : list)
        if ((block || section == "ENTITIES") && !(std::abs(x) <= FARTHEST))
          tags.fail("a coordinate is far out of range");
    const auto point = [&](std::size_t k) {
      return Vec2(entity.x[k], k < entity.y.size() ? entity.y[k] : 0.0);
    };
    if (entity.kind == "VERTEX" && in_polyline && !entity.x.empty())
      polyline.points.push_back(point(0));
    else if (entity.kind == "POLYLINE") {
      polyline = {entity.layer, (entity.flags & 1) != 0, {}};
      in_polyline = true;
    } else if (entity.kind == "SEQEND" && in_polyline) {
      target.lines.push_back(polyline);
      in_polyline = false;
    } else if (entity.kind == "LWPOLYLINE") {
      DxfLine line{entity.layer, (entity.flags & 1) != 0, {}};
      for (std::size_t k = 0; k < entity.x.size(); ++k)
        line.points.push_back(point(k));
      target.lines.push_back(line);
    } else if (entity.kind == "LINE" && !entity.x.empty())
      target.lines.push_back({entity.layer, false, {point(0), Vec2(entity.x2, entity.y2)}});
    else if (entity.kind == "POINT" && !entity.x.empty())
      target.points.push_back({entity.layer, point(0)});
    else if ((entity.kind == "TEXT" || entity.kind == "MTEXT") && !entity.text.empty())
      (block ? block->texts : out.texts)
          .push_back({entity.layer, entity.x.empty() ? Vec2(0, 0) : point(0), entity.text});
  };

  bool any = false;
  while (tags.next()) {
    any = true;
    if (tags.code == 0) {
      finish();
      entity = {};
      entity.kind = std::string(tags.value);
      if (entity.kind == "BLOCK") {
        out.blocks.push_back({});
        block = &out.blocks.back();
      } else if (entity.kind == "ENDBLK" || entity.kind == "ENDSEC")
        block = nullptr;
      else if (entity.kind == "EOF")
        break;
      continue;
    }
    switch (tags.code) {
    case 1: entity.text = utf8(tags.value); break;
    case 2:
      if (entity.kind == "SECTION")
        section = std::string(tags.value);
      if (entity.kind == "BLOCK" && block)
        block->name = utf8(tags.value);
      break;
    case 8: {
      const std::string_view v = tags.value;
      int layer = 0;
      const auto [end, error] = std::from_chars(v.data(), v.data() + v.size(), layer);
      entity.layer = error == std::errc() && end == v.data() + v.size() ? layer : -1;
      break;
    }
    case 9: variable = std::string(tags.value); break;
    case 10: entity.x.push_back(tags.number()); break;
    case 20: entity.y.push_back(tags.number()); break;
    case 11: entity.x2 = tags.number(); break;
    case 21: entity.y2 = tags.number(); break;
    case 70:
      if (section == "HEADER") {
        if (variable == "$INSUNITS")
          out.insunits = tags.whole();
        if (variable == "$MEASUREMENT")
          out.measurement = tags.whole();
      }
      entity.flags = tags.whole();
      break;
    default: break;
    }
  }
  finish();
  const bool flat = std::none_of(out.blocks.begin(), out.blocks.end(),
                                 [](const DxfBlock& b) { return !b.lines.empty(); });
  if (!any || (flat && out.loose.lines.empty()))
    throw input_error("dxf.no-outline"_id, file, "", "there are no blocks, so there are no pieces",
                      "give an AAMA or ASTM DXF, one block per piece");
  if (flat)
    out.blocks.clear();
  return out;
}

} // namespace sloper::pattern

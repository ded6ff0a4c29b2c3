#include <sloper/base/units.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/write/export_pattern.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace sloper::pattern {
namespace {

constexpr double DXF_CHORD = 0.002; // m

/// Group codes of DXF: what the value after each of them is.
namespace dxf_code {
constexpr int KIND = 0, WORDS = 1, NAME = 2, LAYER = 8, VARIABLE = 9, X = 10, END_X = 11, Y = 20,
              END_Y = 21, TEXT_HEIGHT = 40, VERTICES_FOLLOW = 66, FLAGS = 70;
} // namespace dxf_code

/// Layers of AAMA and ASTM D6673.
namespace dxf_layer {
constexpr int CUT_LINE = 1, TURN_POINT = 2, CURVE_POINT = 3, NOTCH = 4, GRAIN = 7, INNER_LINE = 8,
              CUT_OUT = 11, SEW_LINE = 14, ANNOTATION = 15;
constexpr int SHAPED_NOTCHES[] = {80, 81, 82, 83};
} // namespace dxf_layer

constexpr double DXF_TEXT_HEIGHT = 5.0; // mm

// The drawing, mm.
constexpr double SVG_MARGIN = 20, SVG_HEAD = 40, SVG_GAP = 30;
constexpr int SVG_EXTENT_POINTS = 32; // of an edge, from which the room that a panel takes is found
constexpr std::size_t HUE_STEP = 137, HUES = 360; // degrees: near the golden angle, so that the
                                                  // colours of following seams differ

/// In metres to the last bit; else edits keep coordinates on a grid of a nanometre: ten of them are
/// rounded away, so that 20 cm are written as 20.
double rounded(double x, double unit) {
  return unit == 1 ? x + 0.0 : std::nearbyint(x / unit * 1e6) / 1e6 + 0.0;
}

io::Json path_json(const Path& path, double unit) {
  io::Json out = io::Json::array();
  const auto point = [&](io::Json& item, const Vec2& p) {
    item.push_back(rounded(p.x(), unit));
    item.push_back(rounded(p.y(), unit));
  };
  io::Json start = io::Json::array({"M"});
  point(start, path.front().p[0]);
  out.push_back(start);
  for (const Segment& s : path) {
    io::Json item = io::Json::array({s.line ? "L" : "C"});
    if (!s.line) {
      point(item, s.p[1]);
      point(item, s.p[2]);
    }
    point(item, s.p[3]);
    out.push_back(item);
  }
  return out;
}

/// Degrees that are read back as the same angle, where there are any.
double exact_degrees(double angle) {
  const double d = units::degrees(angle);
  for (double near : {d, std::nextafter(d, 1e9), std::nextafter(d, -1e9)})
    if (units::radians(near) == angle)
      return near;
  return d;
}

io::Json loop_json(const std::vector<PanelEdge>& loop, double unit) {
  io::Json out = io::Json::array();
  for (const PanelEdge& e : loop)
    out.push_back({{"edge", e.name}, {"path", path_json(e.path, unit)}});
  return out;
}

/// Text of group codes and values.
class DxfWriter {
public:
  void tag(int code, const std::string& value) {
    m_text += std::to_string(code) + "\n" + value + "\n";
  }
  void tag(int code, double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.4f", value);
    tag(code, std::string(text));
  }
  void point(const Vec2& p) {
    tag(dxf_code::X, p.x() * 1000);
    tag(dxf_code::Y, p.y() * 1000);
  }
  void entity(const char* kind, int on) {
    tag(dxf_code::KIND, kind);
    tag(dxf_code::LAYER, std::to_string(on));
  }
  void text(int on, const Vec2& at, const std::string& words) {
    entity("TEXT", on);
    point(at);
    tag(dxf_code::TEXT_HEIGHT, DXF_TEXT_HEIGHT);
    tag(dxf_code::WORDS, words);
  }
  void mark(int on, const Vec2& at) {
    entity("POINT", on);
    point(at);
  }
  void ring(int on, const std::vector<Vec2>& points) { polyline(on, points, "1"); }
  void chain(int on, const std::vector<Vec2>& points) { polyline(on, points, "0"); }
  const std::string& str() const { return m_text; }

private:
  void polyline(int on, const std::vector<Vec2>& points, const char* closed) {
    entity("POLYLINE", on);
    tag(dxf_code::VERTICES_FOLLOW, "1");
    tag(dxf_code::FLAGS, closed);
    for (const Vec2& p : points) {
      entity("VERTEX", on);
      point(p);
    }
    entity("SEQEND", on);
  }
  std::string m_text;
};

std::string
word(const std::string& name) { // names of seams and runs are single words in layer-15 texts
  std::string out = name;
  std::replace_if(
      out.begin(), out.end(), [](char c) { return c == ' ' || c == '\n'; }, '_');
  return out;
}

/// What readers cannot see from the sides: kind, whether it is left open, and why the sides differ.
/// Last, for that is free text.
std::string about_seam(const Seam& seam) {
  std::string why = seam.ease;
  std::replace_if(
      why.begin(), why.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return " " + seam.kind + (seam.open ? " open" : "") + (why.empty() ? "" : " ease " + why);
}

/// Notches read from a DXF keep their layer, which tells their shape.
int notch_layer(const Notch& notch) {
  for (const int shape : dxf_layer::SHAPED_NOTCHES)
    if (notch.kind == "layer " + std::to_string(shape))
      return shape;
  return dxf_layer::NOTCH;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", x + 0.0);
  return text;
}

} // namespace

io::Json pattern_json(const Pattern& pattern, const std::string& tool, PatternNumbers numbers) {
  const double unit = numbers == PatternNumbers::EXACT ? 1 : units::CM;
  io::Json doc = io::new_document("pattern", 1, tool);
  doc["length_unit"] = numbers == PatternNumbers::EXACT ? "m" : "cm";
  doc["name"] = pattern.name;
  io::Json panels = io::Json::array(), seams = io::Json::array();
  for (const Panel& p : pattern.panels) {
    io::Json panel = {{"name", p.name},
                      {"outline", loop_json(p.loops[0], unit)},
                      {"grain", io::to_json(p.grain)}};
    if (p.loops.size() > 1) {
      io::Json holes = io::Json::array();
      for (std::size_t k = 1; k < p.loops.size(); ++k)
        holes.push_back(loop_json(p.loops[k], unit));
      panel["holes"] = holes;
    }
    if (!p.material.empty())
      panel["material"] = p.material;
    if (p.layer)
      panel["layer"] = p.layer;
    if (!p.label.empty())
      panel["label"] = p.label;
    if (!p.notches.empty()) {
      io::Json notches = io::Json::array();
      for (const Notch& n : p.notches)
        notches.push_back({{"edge", p.edge(n.edge).name}, {"at", n.at}, {"kind", n.kind}});
      panel["notches"] = notches;
    }
    if (!p.lines.empty()) {
      io::Json lines = io::Json::array();
      for (const InnerLine& line : p.lines) {
        lines.push_back(
            {{"name", line.name}, {"kind", line.kind}, {"path", path_json(line.path, unit)}});
        if (line.kind == "tape") {
          lines.back()["factor"] = line.factor;
          lines.back()["width"] = line.width / unit;
        }
      }
      panel["lines"] = lines;
    }
    if (!p.pleats.empty()) {
      io::Json pleats = io::Json::array();
      for (const Pleat& pleat : p.pleats) {
        io::Json edges = io::Json::array();
        for (int e : pleat.edges)
          edges.push_back(p.edge(e).name);
        pleats.push_back({{"name", pleat.name},
                          {"fold", p.lines[pleat.fold].name},
                          {"target", p.lines[pleat.target].name},
                          {"edges", edges}});
      }
      panel["pleats"] = pleats;
    }
    io::Json place = io::Json::object();
    if (!p.hint.part.empty())
      place["part"] = p.hint.part;
    if (p.hint.theta)
      place["theta_deg"] = exact_degrees(*p.hint.theta);
    if (p.hint.radius)
      place["radius"] = rounded(*p.hint.radius, unit);
    if (p.hint.anchor)
      place["anchor"] = {rounded(p.hint.anchor->x(), unit), rounded(p.hint.anchor->y(), unit)};
    if (p.hint.height)
      place["height"] = rounded(*p.hint.height, unit);
    if (p.hint.rigid) {
      io::Json rigid = io::Json::array();
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 4; ++c)
          rigid.push_back((*p.hint.rigid)(r, c) / (c == 3 ? unit : 1));
      place["rigid"] = rigid;
    }
    if (!place.empty())
      panel["place"] = place;
    panels.push_back(panel);
  }
  for (const Seam& s : pattern.seams) {
    io::Json seam = {{"name", s.name}, {"kind", s.kind}};
    for (const auto* side : {&s.a, &s.b}) {
      io::Json runs = io::Json::array();
      for (const Run& r : *side) {
        const Panel& panel = pattern.panels[r.panel];
        runs.push_back({{"panel", panel.name},
                        {"edge", panel.edge(r.edge).name},
                        {"from", r.from},
                        {"to", r.to}});
      }
      seam[side == &s.a ? "a" : "b"] = runs;
    }
    if (!s.ease.empty())
      seam["ease"] = s.ease;
    if (s.open)
      seam["open"] = true;
    seams.push_back(seam);
  }
  doc["panels"] = panels;
  doc["seams"] = seams;
  return doc;
}

std::string pattern_dxf(const Pattern& pattern, std::vector<std::string>& left_out) {
  DxfWriter out;
  std::vector<std::string> hinted; // panels
  out.tag(dxf_code::KIND, "SECTION");
  out.tag(dxf_code::NAME, "HEADER");
  out.tag(dxf_code::VARIABLE, "$ACADVER");
  out.tag(dxf_code::WORDS, "AC1009");
  out.tag(dxf_code::KIND, "ENDSEC");
  out.tag(dxf_code::KIND, "SECTION");
  out.tag(dxf_code::NAME, "BLOCKS");
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
    const Panel& panel = pattern.panels[p];
    out.entity("BLOCK", dxf_layer::CUT_LINE);
    out.tag(dxf_code::NAME, word(panel.name));
    out.tag(dxf_code::FLAGS, "64");
    out.point(Vec2(0, 0));
    out.text(dxf_layer::CUT_LINE, Vec2(0, 0), "Piece Name: " + panel.name);
    out.text(dxf_layer::CUT_LINE, Vec2(0, 0), "Quantity: 1");
    if (!panel.material.empty())
      out.text(dxf_layer::CUT_LINE, Vec2(0, 0), "Material: " + panel.material);
    int e = 0;
    for (std::size_t l = 0; l < panel.loops.size(); ++l) {
      std::vector<Vec2> ring, turns, curve;
      std::vector<std::pair<Vec2, std::string>> texts;
      for (const PanelEdge& edge : panel.loops[l]) {
        const ArcLength arc(edge.path);
        turns.push_back(arc.at(0));
        for (const Segment& s : edge.path) {
          const int n =
              s.line ? 1 : std::max(1, static_cast<int>(std::ceil(s.length(0, 1) / DXF_CHORD)));
          for (int k = 0; k < n; ++k) {
            ring.push_back(s.at(static_cast<double>(k) / n));
            if (k > 0 || &s != &edge.path.front())
              curve.push_back(ring.back());
          }
        }
        std::string said = "RUN " + word(edge.name);
        for (const Seam& seam : pattern.seams)
          for (const auto* side : {&seam.a, &seam.b})
            for (std::size_t k = 0; k < side->size(); ++k) {
              const Run& run = (*side)[k];
              if (run.panel != static_cast<int>(p) || run.edge != e)
                continue;
              if (std::min(run.from, run.to) > 0 || std::max(run.from, run.to) < 1) {
                left_out.push_back("seam " + seam.name + ": only part of " +
                                   place_of(pattern, run) + " is sewn, which layer 15 cannot say");
                continue;
              }
              said = "SEW " + word(seam.name) + (side == &seam.a ? " a " : " b ") +
                     std::to_string(k) + (run.from < run.to ? " + " : " - ") + word(edge.name) +
                     about_seam(seam);
            }
        texts.push_back({arc.at(0.5 * arc.length()), said});
        ++e;
      }
      if (l == 0)
        out.ring(dxf_layer::CUT_LINE, ring);
      out.ring(l == 0 ? dxf_layer::SEW_LINE : dxf_layer::CUT_OUT, ring);
      for (const Vec2& q : turns)
        out.mark(dxf_layer::TURN_POINT, q);
      for (const Vec2& q : curve)
        out.mark(dxf_layer::CURVE_POINT, q);
      for (const auto& [at, said] : texts)
        out.text(dxf_layer::ANNOTATION, at, said);
    }
    for (const Notch& n : panel.notches) {
      const ArcLength arc(panel.edge(n.edge).path);
      out.mark(notch_layer(n), arc.at(n.at * arc.length()));
    }
    if (panel.layer)
      left_out.push_back(panel.name + ": that it lies in layer " + std::to_string(panel.layer) +
                         " is not written");
    if (!panel.hint.part.empty() || panel.hint.theta || panel.hint.anchor || panel.hint.height ||
        panel.hint.rigid)
      hinted.push_back(panel.name);
    for (const InnerLine& line : panel.lines) {
      const ArcLength arc(line.path);
      const bool bent = line.path.size() > 1 || !line.path[0].line;
      const int n = bent ? std::max(1, static_cast<int>(std::ceil(arc.length() / DXF_CHORD))) : 1;
      std::vector<Vec2> points;
      for (int k = 0; k <= n; ++k)
        points.push_back(arc.at(arc.length() * k / n));
      out.chain(dxf_layer::INNER_LINE, points);
      const auto uses = [&](const Pleat& pleat) {
        return &panel.lines[pleat.fold] == &line;
      }; // pleats are reported below
      if (line.kind == "fold" && std::none_of(panel.pleats.begin(), panel.pleats.end(), uses))
        left_out.push_back(panel.name + ": line " + line.name +
                           " is written without saying that it is a fold");
      if (line.kind == "tape")
        left_out.push_back(panel.name + ": line " + line.name +
                           " is written without saying that it is a tape");
    }
    for (const Pleat& pleat : panel.pleats)
      left_out.push_back(panel.name + ": pleat " + pleat.name + " is written as two lines");
    const Vec2 from = panel.loops[0][0].path.front().p[0], to = from + 0.1 * panel.grain;
    out.entity("LINE", dxf_layer::GRAIN);
    out.point(from);
    out.tag(dxf_code::END_X, to.x() * 1000);
    out.tag(dxf_code::END_Y, to.y() * 1000);
    out.entity("ENDBLK", dxf_layer::CUT_LINE);
  }
  if (!hinted.empty()) // one line: nearly all panels of a garment have a hint, and names and seams
                       // tell most of it again
    left_out.push_back(
        hinted[0] +
        (hinted.size() > 1 ? " and " + std::to_string(hinted.size() - 1) + " more" : "") +
        ": where it is to be placed is not written");
  out.tag(dxf_code::KIND, "ENDSEC");
  out.tag(dxf_code::KIND, "SECTION");
  out.tag(dxf_code::NAME, "ENTITIES");
  for (const Panel& panel : pattern.panels) {
    out.entity("INSERT", dxf_layer::CUT_LINE);
    out.tag(dxf_code::NAME, word(panel.name));
    out.point(Vec2(0, 0));
  }
  out.text(dxf_layer::CUT_LINE, Vec2(0, 0), "Style Name: " + pattern.name);
  out.text(dxf_layer::CUT_LINE, Vec2(0, 0), "Units: METRIC");
  out.text(dxf_layer::CUT_LINE, Vec2(0, 0), "ANSI/AAMA VERSION: 1.0.0");
  out.tag(dxf_code::KIND, "ENDSEC");
  out.tag(dxf_code::KIND, "EOF");
  return out.str();
}

std::string pattern_svg(const Pattern& pattern) {
  std::string body;
  double x = SVG_MARGIN, height = 0;
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
    const Panel& panel = pattern.panels[p];
    Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
    for (const PanelEdge& e : panel.loops[0]) {
      const ArcLength arc(e.path);
      for (int k = 0; k <= SVG_EXTENT_POINTS; ++k) {
        low = low.cwiseMin(arc.at(arc.length() * k / SVG_EXTENT_POINTS));
        high = high.cwiseMax(arc.at(arc.length() * k / SVG_EXTENT_POINTS));
      }
    }
    const auto at = [&](const Vec2& q) {
      return number(x + (q.x() - low.x()) * 1000) + " " +
             number(SVG_HEAD + (high.y() - q.y()) * 1000);
    };
    const auto path = [&](const Path& segments, bool move) {
      std::string d = move ? "M" + at(segments.front().p[0]) : "";
      for (const Segment& s : segments)
        d += s.line ? " L" + at(s.p[3]) : " C" + at(s.p[1]) + " " + at(s.p[2]) + " " + at(s.p[3]);
      return d;
    };
    std::string fill;
    for (const auto& loop : panel.loops) {
      for (std::size_t k = 0; k < loop.size(); ++k)
        fill += path(loop[k].path, k == 0) + " ";
      fill += "Z ";
    }
    body += "<g id=\"" + escaped(panel.name) + "\">\n<path d=\"" + fill +
            "\" fill=\"#f4f1ea\" fill-rule=\"evenodd\"/>\n";
    for (const InnerLine& line : panel.lines) {
      std::string dashes = "1 4";
      if (line.kind == "fold")
        dashes = "8 4";
      if (line.kind == "tape")
        dashes = "2 2";
      body += "<path d=\"" + path(line.path, true) +
              "\" fill=\"none\" stroke=\"#555\" stroke-width=\"0.8\" stroke-dasharray=\"" + dashes +
              "\"/>\n";
    }
    for (int e = 0; e < panel.n_edges(); ++e) {
      std::string color = "#888";
      double width = 1;
      for (std::size_t s = 0; s < pattern.seams.size(); ++s)
        for (const auto* side : {&pattern.seams[s].a, &pattern.seams[s].b})
          for (const Run& run : *side)
            if (run.panel == static_cast<int>(p) && run.edge == e) {
              color = "hsl(" + std::to_string(s * HUE_STEP % HUES) + ",75%,42%)";
              width = 3;
            }
      const ArcLength arc(panel.edge(e).path);
      body += "<path d=\"" + path(panel.edge(e).path, true) + "\" fill=\"none\" stroke=\"" + color +
              "\" stroke-width=\"" + number(width) + "\"/>\n";
      const std::string where = at(arc.at(0.5 * arc.length()));
      const std::size_t gap = where.find(' ');
      body += "<text x=\"" + where.substr(0, gap) + "\" y=\"" + where.substr(gap + 1) +
              "\" font-size=\"9\" text-anchor=\"middle\" fill=\"#333\">" +
              escaped(panel.edge(e).name) + "</text>\n";
    }
    const Vec2 middle = 0.5 * (low + high), tip = middle + 0.05 * panel.grain,
               tail = middle - 0.05 * panel.grain;
    body += "<path d=\"M" + at(tail) + " L" + at(tip) +
            "\" stroke=\"#333\" stroke-width=\"1\" marker-end=\"url(#tip)\"/>\n";
    body += "<text x=\"" + number(x) + "\" y=\"25\" font-size=\"16\">" + escaped(panel.name) +
            "</text>\n</g>\n";
    x += (high.x() - low.x()) * 1000 + SVG_GAP;
    height = std::max(height, (high.y() - low.y()) * 1000);
  }
  const std::string w = number(x), h = number(height + 60);
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + w + "mm\" height=\"" + h +
         "mm\" viewBox=\"0 0 " + w + " " + h +
         "\" font-family=\"sans-serif\">\n<defs><marker id=\"tip\" orient=\"auto\" "
         "markerWidth=\"8\" markerHeight=\"8\" refX=\"6\" refY=\"3\"><path d=\"M0 0 "
         "L6 3 L0 6 Z\"/></marker></defs>\n" +
         "<title>" + escaped(pattern.name) + "</title>\n" + body + "</svg>\n";
}

} // namespace sloper::pattern

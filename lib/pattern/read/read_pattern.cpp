#include <io/files.hpp>
#include <io/json.hpp>
#include <pattern/read/read_pattern.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace sloper::pattern {
namespace {

constexpr double LARGEST_PANEL = 20, SMALLEST_PANEL = 0.05; // m, of the largest panel of a garment
constexpr double FARTHEST_CONTROL = 2 * LARGEST_PANEL;      // m, from where its curve begins
constexpr int HIGHEST_LAYER = 1000;

bool finite_path(const Path& path) {
  return std::all_of(path.begin(), path.end(), [](const Segment& s) {
    return s.p[0].allFinite() && s.p[1].allFinite() && s.p[2].allFinite() && s.p[3].allFinite();
  });
}

} // namespace

std::optional<PanelFault> fault_of(const Panel& panel) {
  Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
  for (std::size_t l = 0; l < panel.loops.size(); ++l)
    for (const PanelEdge& e : panel.loops[l]) {
      if (!finite_path(e.path))
        return PanelFault{e.name, "a coordinate is no finite number", "write it anew"};
      for (const Segment& s : e.path) {
        if (l == 0) low = low.cwiseMin(s.p[0]), high = high.cwiseMax(s.p[0]);
        for (const Vec2& p : {s.p[1], s.p[2]})
          if (const double off = (p - s.p[0]).norm(); !s.line && !(off <= FARTHEST_CONTROL))
            return PanelFault{
                e.name, "a control point of the curve lies " + centimetres(off) + " from its start",
                "check its coordinates and their unit"};
      }
    }
  const double size = (high - low).maxCoeff();
  for (const InnerLine& line : panel.lines) {
    if (!finite_path(line.path))
      return PanelFault{line.name, "a coordinate is no finite number", "write it anew"};
    for (const Segment& s : line.path)
      for (const Vec2& p : s.p)
        if (const double off = std::max((low - p).maxCoeff(), (p - high).maxCoeff());
            !(off <= size))
          return PanelFault{line.name, "the line leaves the panel by " + centimetres(off),
                            "draw it inside"};
  }
  if (std::abs(static_cast<double>(panel.layer)) > HIGHEST_LAYER)
    return PanelFault{"layer", std::to_string(panel.layer) + " is no layer",
                      "number layers from 0, the innermost"};
  if (!(size <= LARGEST_PANEL))
    return PanelFault{"", "the panel measures " + centimetres(size),
                      "check its coordinates and their unit"};
  return std::nullopt;
}

void finish_pattern(Pattern& pattern, const std::string& file) {
  double largest = 0;
  std::string largest_name;
  for (std::size_t k = 0; k < pattern.panels.size(); ++k) {
    Panel& panel = pattern.panels[k];
    if (const auto fault = fault_of(panel);
        fault && !fault->place.empty()) // sizes are told of the largest panel
      throw input_error(file, panel.name + ": " + fault->place, fault->fact, fault->next);
    for (std::size_t l = 0; l < panel.loops.size(); ++l) {
      std::vector<Path> paths;
      Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
      for (const PanelEdge& e : panel.loops[l]) {
        paths.push_back(e.path);
        for (const Segment& s : e.path) low = low.cwiseMin(s.p[0]), high = high.cwiseMax(s.p[0]);
        if (!(length(e.path) > 1e-6))
          throw input_error(file, panel.name + ": " + e.name,
                            "the edge is 0.00 cm long (duplicate points)",
                            "take it out of the outline");
      }
      if (const double size = (high - low).maxCoeff(); !(size <= largest))
        largest = size, largest_name = panel.name;
      const double area = signed_area(paths);
      if (!(std::abs(area) >= 1e-6))
        throw input_error(file, panel.name,
                          "the outline encloses " + std::to_string(std::abs(area) * 1e4) + " cm2",
                          "give the panel an area");
      if ((area > 0) == (l == 0)) continue;
      if (l > 0)
        throw input_error(file, panel.name,
                          "hole " + std::to_string(l) + " is drawn counter-clockwise",
                          "draw holes clockwise");
      pattern.findings.push_back(panel.name +
                                 ": drawn clockwise, so taken as seen from inside and turned over");
      for (std::size_t h = 1; h < panel.loops.size(); ++h) {
        std::vector<Path> hole;
        for (const PanelEdge& e : panel.loops[h]) hole.push_back(e.path);
        if (signed_area(hole) < 0)
          throw input_error(file, panel.name,
                            "hole " + std::to_string(h) + " runs in the sense of the outline");
      }
      // The sense is the message: mirror the drawing, keep the order of edges and the direction of
      // runs.
      for (auto& loop : panel.loops)
        for (PanelEdge& e : loop)
          for (Segment& s : e.path)
            for (Vec2& p : s.p) p.x() = -p.x();
      for (InnerLine& line : panel.lines)
        for (Segment& s : line.path)
          for (Vec2& p : s.p) p.x() = -p.x();
      panel.grain.x() = -panel.grain.x();
      if (panel.hint.anchor) panel.hint.anchor->x() *= -1;
      if (panel.hint.rigid) {
        Mat4 turn = Mat4::Identity();
        turn(0, 0) = turn(2, 2) = -1;
        panel.hint.rigid = *panel.hint.rigid * turn;
      }
      break;
    }
  }
  if (!(largest <= LARGEST_PANEL && largest >= SMALLEST_PANEL))
    throw input_error(file, largest_name,
                      "the largest panel measures " + centimetres(largest) +
                          ", so the unit is wrong",
                      "check the unit that the file states, and the outline of this panel");
}

Pattern read_pattern(const std::string& path, const std::string& sewing, const std::string& size,
                     const std::string& rules_path) {
  const std::string text = io::read_file(path);
  Pattern pattern;
  const std::size_t first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (first == std::string::npos)
    throw input_error(path, "", "the file is empty", "give a pattern");
  const char* readable =
      "give a pattern JSON, a GarmentCode specification, a sewing-spec JSON or a text DXF";
  if (text[first] == '{' || text[first] == '[') {
    const io::Json json = io::parse_json(text, path);
    const std::string format =
        json.is_object() && json.contains("format") && json["format"].is_string()
            ? json["format"].get<std::string>()
            : "";
    if (format == "pattern") pattern = read_pattern_json(json, path);
    else if (format == "sewing-spec") pattern = read_sewing_spec(json, path);
    else if (format == "panels" || format == "garment")
      throw input_error(path, "/format",
                        "is a \"" + format + "\" document, which is meshed already",
                        "give the pattern that it was made from");
    else if (json.is_object() && json.contains("pattern")) pattern = read_garmentcode(json, path);
    else
      throw input_error(path, "/format", "'" + format + "' is no pattern format that is known",
                        readable);
    if (!size.empty() || !rules_path.empty())
      throw input_error(path, "", "this format holds one size",
                        "leave out --size and --grade-rules");
  } else if (text[first] < '0' || text[first] > '9') { // a DXF starts with a group code
    throw input_error(path, "line 1", "is neither JSON nor a text DXF", readable);
  } else if (rules_path.empty()) {
    pattern = read_dxf(text, path, {size, nullptr});
  } else {
    const GradeRules rules = parse_grade_rules(io::read_file(rules_path), rules_path);
    pattern = read_dxf(text, path, {size, &rules});
  }
  if (!sewing.empty()) {
    pattern.seams.clear(); // the sidecar replaces what the file says
    const io::Json sidecar = io::read_json(sewing);
    if (const std::string format = io::Node(sidecar, sewing).string("format", "");
        format == "panels" || format == "garment" || format == "body")
      throw input_error(sewing, "/format",
                        "is a \"" + format + "\" document, not a sidecar with seams",
                        "give what answers the questions of pattern-mesh");
    read_sewing_seams(pattern, sidecar, sewing);
  }
  if (pattern.name.empty())
    pattern.name = path == "-" ? "pattern" : std::filesystem::path(path).stem().string();
  if (pattern.panels.empty()) throw input_error(path, "", "there are no panels");
  finish_pattern(pattern, path);
  return pattern;
}

} // namespace sloper::pattern

#include <pattern/read/choose_pieces.hpp>
#include <pattern/read/clo_json.hpp>
#include <sloper/base/text.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/read/read_pattern.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace sloper::pattern {
namespace {

constexpr double LARGEST_PANEL = 20, SMALLEST_PANEL = 0.05; // m, of the largest panel of a garment
constexpr double FARTHEST_CONTROL = 2 * LARGEST_PANEL;      // m, from where its curve begins
constexpr int HIGHEST_LAYER = 1000;
constexpr const char* READABLE = "give a pattern JSON, a GarmentCode specification, a sewing-spec "
                                 "JSON, a pattern JSON of CLO or "
                                 "a text DXF";

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
        return PanelFault{e.name, "a coordinate is not a finite number", "write the file again"};
      for (const Segment& s : e.path) {
        if (l == 0) {
          low = low.cwiseMin(s.p[0]);
          high = high.cwiseMax(s.p[0]);
        }
        for (const Vec2& p : {s.p[1], s.p[2]})
          if (const double off = (p - s.p[0]).norm(); !s.line && !(off <= FARTHEST_CONTROL))
            return PanelFault{
                e.name, "a control point of the curve is " + centimetres(off) + " from its start",
                "check its coordinates and their unit"};
      }
    }
  const double size = (high - low).maxCoeff();
  for (const InnerLine& line : panel.lines) {
    if (!finite_path(line.path))
      return PanelFault{line.name, "a coordinate is not a finite number", "write the file again"};
    for (const Segment& s : line.path)
      for (const Vec2& p : s.p)
        if (const double off = std::max((low - p).maxCoeff(), (p - high).maxCoeff());
            !(off <= size))
          return PanelFault{line.name, "the line extends beyond the panel by " + centimetres(off),
                            "draw it inside"};
  }
  if (std::abs(static_cast<double>(panel.layer)) > HIGHEST_LAYER)
    return PanelFault{"layer", std::to_string(panel.layer) + " is not a layer",
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
        fault && !fault->place.empty()) // a wrong size is reported of the largest panel, below
      throw input_error("pattern.faulty-outline"_id, file, panel.name + ": " + fault->place,
                        fault->fact, fault->next);
    for (std::size_t l = 0; l < panel.loops.size(); ++l) {
      std::vector<Path> paths;
      Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
      for (const PanelEdge& e : panel.loops[l]) {
        paths.push_back(e.path);
        for (const Segment& s : e.path) {
          low = low.cwiseMin(s.p[0]);
          high = high.cwiseMax(s.p[0]);
        }
        if (!(length(e.path) > 1e-6))
          throw input_error("pattern.too-small"_id, file, panel.name + ": " + e.name,
                            "the edge is 0.00 cm long (duplicate points)",
                            "take it out of the outline");
      }
      if (const double size = (high - low).maxCoeff(); !(size <= largest)) {
        largest = size;
        largest_name = panel.name;
      }
      const double area = signed_area(paths);
      if (!(std::abs(area) >= 1e-6))
        throw input_error("pattern.too-small"_id, file, panel.name,
                          "the outline encloses only " + decimals(std::abs(area) * 1e4, 4) + " cm2",
                          "give the panel an area");
      if ((area > 0) == (l == 0))
        continue;
      if (l > 0)
        throw input_error("pattern.hole-direction"_id, file, panel.name,
                          "hole " + std::to_string(l) + " is drawn counter-clockwise",
                          "draw holes clockwise");
      pattern.findings.push_back(
          {"pattern.turned-over"_id,
           panel.name + ": drawn clockwise, so it is taken as seen from inside and turned over"});
      for (std::size_t h = 1; h < panel.loops.size(); ++h) {
        std::vector<Path> hole;
        for (const PanelEdge& e : panel.loops[h])
          hole.push_back(e.path);
        if (signed_area(hole) < 0)
          throw input_error("pattern.hole-direction"_id, file, panel.name,
                            "hole " + std::to_string(h) +
                                " runs in the same direction as the outline");
      }
      // The sense is the message: mirror the drawing, keep the order of edges and the direction of
      // runs.
      for (auto& loop : panel.loops)
        for (PanelEdge& e : loop)
          for (Segment& s : e.path)
            for (Vec2& p : s.p)
              p.x() = -p.x();
      for (InnerLine& line : panel.lines) {
        for (Segment& s : line.path)
          for (Vec2& p : s.p)
            p.x() = -p.x();
        keep_side(line);
      }
      panel.grain.x() = -panel.grain.x();
      if (panel.hint.anchor)
        panel.hint.anchor->x() *= -1;
      if (panel.hint.rigid) {
        Mat4 turn = Mat4::Identity();
        turn(0, 0) = turn(2, 2) = -1;
        panel.hint.rigid = *panel.hint.rigid * turn;
      }
      break;
    }
  }
  if (!(largest <= LARGEST_PANEL && largest >= SMALLEST_PANEL))
    throw input_error("pattern.wrong-unit"_id, file, largest_name,
                      "the largest panel measures " + centimetres(largest) +
                          ", so the unit is wrong",
                      "check the unit that the file states, and the outline of this panel");
}

namespace {

io::Json read_sidecar(const std::string& path) {
  io::Json sidecar = io::read_json(path);
  if (const std::string format = io::Node(sidecar, path).string("format", "");
      format == "panels" || format == "garment" || format == "body")
    throw input_error("json.wrong-format"_id, path, "/format",
                      "is a \"" + format + "\" document, not a sidecar with seams",
                      "give what answers the questions of pattern-mesh");
  io::Node(sidecar, path)
      .allow_only({"format", "version", "generator", "length_unit", "units", "name", "pattern",
                   "body", "source", "panels", "frames", "place", "seams", "questions", "without"});
  return sidecar;
}

/// Names of the panels that a sidecar sews.
std::set<std::string> sewn_panels(const io::Json& sidecar, const std::string& path) {
  std::set<std::string> names;
  const io::Node root(sidecar, path), seams = root.at("seams");
  for (std::size_t k = 0; k < seams.size(); ++k)
    for (const char* side : {"a", "b"}) {
      const io::Node runs = seams.at(k).at(side);
      for (std::size_t r = 0; r < runs.size(); ++r)
        names.insert(runs.at(r).at("panel").string());
    }
  return names;
}

/// Places that a sidecar asks about and sews nothing to, as "panel, edge".
std::vector<std::string> open_questions(const io::Json& sidecar, const std::string& path,
                                        const Pattern& pattern) {
  std::vector<std::string> open;
  const io::Node root(sidecar, path);
  if (!root.has("questions"))
    return open;
  std::set<std::string> sewn;
  for (const Seam& seam : pattern.seams)
    for (const std::vector<Run>* side : {&seam.a, &seam.b})
      for (const Run& run : *side)
        sewn.insert(pattern.panels[run.panel].name + ", " +
                    pattern.panels[run.panel].edge(run.edge).name);
  const io::Node questions = root.at("questions");
  for (std::size_t k = 0; k < questions.size(); ++k) {
    const io::Node question = questions.at(k);
    if (!question.has("run"))
      continue; // which of several pieces: "without" says it
    const std::string place = question.at("panel").string() + ", " + question.at("run").string();
    if (sewn.count(place) == 0)
      open.push_back(place);
  }
  return open;
}

/// Names of the pieces that a sidecar leaves out.
std::vector<std::string> pieces_left(const io::Json& sidecar, const std::string& path) {
  std::vector<std::string> names;
  const io::Node root(sidecar, path);
  if (!root.has("without"))
    return names;
  const io::Node list = root.at("without");
  for (std::size_t k = 0; k < list.size(); ++k)
    names.push_back(list.at(k).string());
  return names;
}

Pattern read_by_format(const io::Json& json, const std::string& path) {
  const std::string format =
      json.is_object() && json.contains("format") && json["format"].is_string()
          ? json["format"].get<std::string>()
          : "";
  if (format == "pattern")
    return read_pattern_json(json, path);
  if (format == "sewing-spec")
    return read_sewing_spec(json, path);
  if (format == "panels" || format == "garment")
    throw input_error("pattern.already-meshed"_id, path, "/format",
                      "is a \"" + format + "\" document, which is already meshed",
                      "give the pattern that it was made from");
  if (json.is_object() && json.contains("pattern"))
    return read_garmentcode(json, path);
  if (json.is_object() && json.contains("PatternList"))
    return read_clo_json(json, path);
  throw input_error("pattern.unknown-format"_id, path, "/format",
                    "'" + format + "' is not a known pattern format", READABLE);
}

} // namespace

Pattern read_pattern(const std::string& path, const PatternChoice& choice) {
  const std::string text = io::read_file(path);
  Pattern pattern;
  const std::size_t first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (first == std::string::npos)
    throw input_error("file.empty"_id, path, "", "the file is empty", "give a pattern");
  io::Json sidecar;
  if (!choice.sewing.empty())
    sidecar = read_sidecar(choice.sewing);
  if (text[first] == '{' || text[first] == '[') {
    pattern = read_by_format(io::parse_json(text, path), path);
    if (!choice.size.empty() || !choice.rules.empty())
      throw input_error("pattern.option-not-for-format"_id, path, "", "this format holds one size",
                        "leave out --size and --grade-rules");
    if (choice.unit > 0 || choice.allowance > 0)
      throw input_error("pattern.option-not-for-format"_id, path, "",
                        "this format states its unit, and its outlines are sewn along",
                        "leave out --unit and --allowance");
  } else if (text[first] < '0' || text[first] > '9') { // a DXF starts with a group code
    throw input_error("pattern.unknown-format"_id, path, "line 1", "is neither JSON nor a text DXF",
                      READABLE);
  } else {
    DxfChoice dxf{choice.size, nullptr, choice.unit, choice.allowance, choice.pieces, {}};
    if (!choice.sewing.empty())
      dxf.sewn = sewn_panels(sidecar, choice.sewing);
    std::optional<GradeRules> rules;
    if (!choice.rules.empty())
      rules = parse_grade_rules(io::read_file(choice.rules), choice.rules);
    if (rules)
      dxf.rules = &*rules;
    pattern = read_dxf(text, path, dxf);
  }
  if (!choice.sewing.empty()) {
    pattern.seams.clear(); // the sidecar replaces what the file says
    read_sewing_seams(pattern, sidecar, choice.sewing);
    pattern.open_questions = open_questions(sidecar, choice.sewing, pattern);
  }
  std::vector<std::string> without = choice.without;
  if (!choice.sewing.empty())
    for (std::string& name : pieces_left(sidecar, choice.sewing))
      without.push_back(std::move(name));
  choose_pieces(pattern, choice.pieces, without, path);
  if (pattern.name.empty())
    pattern.name = path == "-" ? "pattern" : std::filesystem::path(path).stem().string();
  if (pattern.panels.empty())
    throw input_error("pattern.no-panels"_id, path, "", "there are no panels");
  finish_pattern(pattern, path);
  return pattern;
}

Pattern read_pattern(const std::string& path, const std::string& sewing, const std::string& size,
                     const std::string& rules) {
  return read_pattern(path, PatternChoice{sewing, size, rules, 0, 0, {}, {}});
}

} // namespace sloper::pattern

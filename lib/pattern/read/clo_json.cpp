/// Patterns of CLO and Marvelous Designer in their own JSON (ExportPatternJSON): pieces seen from
/// the outside of the garment, y up, and the seams. A side of a seam is a stretch of a piece's
/// outline, by fractions of the whole outline's length from where its first line starts. The format
/// is not published: known from files of CLO and of programs that write such files.
#include <pattern/read/clo_json.hpp>
#include <pattern/read/outline_json.hpp>
#include <sloper/io/json.hpp>

#include <sloper/base/units.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace sloper::pattern {
namespace {

constexpr double SNAP_TO_LINE = 0.003; // m: writers estimate lengths of curves; ends of a side so
                                       // near to an end of a line are meant to lie there

enum class PointKind { CORNER, SPLINE, BEZIER };

PointKind kind_of(const io::Node& point) {
  if (!point.has("PointType"))
    return PointKind::CORNER;
  const io::Node type = point.at("PointType");
  if (type.is_number()) {
    const int number = type.integer();
    if (number == 0)
      return PointKind::CORNER;
    if (number == 2)
      return PointKind::SPLINE;
    if (number == 3)
      return PointKind::BEZIER;
    type.fail("clo.malformed"_id, "unknown kind of point " + std::to_string(number),
              "known are 0 (straight), 2 (spline) and 3 (Bezier)");
  }
  const std::string word = type.string();
  if (word.rfind("Straight", 0) == 0)
    return PointKind::CORNER;
  if (word.rfind("Bezier", 0) == 0)
    return PointKind::BEZIER;
  if (word.rfind("Spline", 0) == 0 || word.rfind("Curve", 0) == 0)
    return PointKind::SPLINE;
  type.fail("clo.malformed"_id, "unknown kind of point '" + word + "'",
            "known are Straight, Spline and Bezier Curve");
}

/// A smooth curve through points: at each the direction from its neighbour to its neighbour.
void add_spline(const std::vector<Vec2>& through, Path& path) {
  const std::size_t n = through.size();
  const auto tangent = [&](std::size_t k) {
    const std::size_t a = k > 0 ? k - 1 : k, b = k + 1 < n ? k + 1 : k;
    return Vec2((through[b] - through[a]) / static_cast<double>(b - a));
  };
  for (std::size_t k = 0; k + 1 < n; ++k)
    path.push_back(Segment::cubic(through[k], through[k] + tangent(k) / 3,
                                  through[k + 1] - tangent(k + 1) / 3, through[k + 1]));
}

void add_bezier(const std::vector<Vec2>& points, const io::Node& line, Path& path) {
  const std::size_t n = points.size();
  if (n == 3) {
    path.push_back(Segment::quadratic(points[0], points[1], points[2]));
    return;
  }
  if (n % 3 != 1)
    line.fail("clo.malformed"_id,
              "a Bezier curve has " + std::to_string(n - 2) + " points between its ends",
              "two control points belong to each part of it");
  for (std::size_t k = 0; k + 3 < n; k += 3)
    path.push_back(Segment::cubic(points[k], points[k + 1], points[k + 2], points[k + 3]));
}

Path read_line(const io::Node& line, double unit) {
  const io::Node list = line.at("PointList");
  if (list.size() < 2)
    list.fail("clo.malformed"_id, "a line has fewer than two points");
  std::vector<Vec2> points;
  std::vector<PointKind> kinds;
  for (std::size_t k = 0; k < list.size(); ++k) {
    const io::Node position = list.at(k).at("Position");
    points.push_back(Vec2(position.at("x").number(), position.at("y").number()) * unit);
    kinds.push_back(kind_of(list.at(k)));
  }
  kinds.front() = kinds.back() = PointKind::CORNER;
  Path path;
  for (std::size_t from = 0; from + 1 < points.size();) {
    std::size_t to = from + 1;
    while (kinds[to] != PointKind::CORNER)
      ++to;
    const std::vector<Vec2> stretch(points.begin() + static_cast<long>(from),
                                    points.begin() + static_cast<long>(to) + 1);
    if (to == from + 1)
      path.push_back(Segment::straight(points[from], points[to]));
    else if (kinds[from + 1] == PointKind::BEZIER)
      add_bezier(stretch, line, path);
    else
      add_spline(stretch, path);
    from = to;
  }
  return path;
}

/// A piece, and where its lines begin along its outline as it is listed.
struct Piece {
  int panel = 0;
  std::vector<double> starts; ///< m, ascending; the last is the length of the outline
  bool against = false;       ///< listed clockwise
};

std::string id_of(const io::Node& node) {
  for (const char* key : {"ID", "ShapeID"})
    if (node.has(key))
      return node.at(key).string();
  return "";
}

class Reader {
public:
  Reader(const io::Json& json, const std::string& file) : m_root(json, file) {
    m_pattern.source_format = "clo";
  }

  Pattern run() {
    if (m_root.has("Unit"))
      m_unit = unit_of(m_root.at("Unit"));
    const io::Node list = m_root.at("PatternList");
    if (!list.is_array() || list.size() == 0)
      list.fail("clo.malformed"_id, "there are no pieces");
    for (std::size_t k = 0; k < list.size(); ++k)
      read_piece(list.at(k));
    if (m_root.has("SeamLinePairGroupList")) {
      const io::Node groups = m_root.at("SeamLinePairGroupList");
      for (std::size_t g = 0; g < groups.size(); ++g)
        read_group(groups.at(g), g);
    }
    if (m_inner > 0)
      m_pattern.findings.push_back(
          {"clo.left-out"_id,
           std::to_string(m_inner) + " lines inside pieces are left out, and seams along them"});
    return std::move(m_pattern);
  }

private:
  void read_piece(const io::Node& node) {
    Panel panel;
    panel.name = node.string("Name", "piece " + std::to_string(m_pattern.panels.size()));
    for (int k = 2; m_pattern.find_panel(panel.name) >= 0; ++k)
      panel.name = node.at("Name").string() + "_" + std::to_string(k);
    if (node.has("ArrangementPointDataMap"))
      panel.label = node.at("ArrangementPointDataMap").string("PointName", "");
    const double lean = units::radians(node.number("fGrainlineAngle", 0));
    panel.grain = Vec2(-std::sin(lean), std::cos(lean));
    const io::Node shape = node.at("ShapeInfo");
    if (!shape.has("LineList") || shape.at("LineList").size() < 2)
      shape.fail("clo.malformed"_id, "the piece " + panel.name + " has no outline",
                 "export the pattern again, with its shapes, or as DXF (AAMA or ASTM)");
    if (node.has("InternalLineList"))
      m_inner += node.at("InternalLineList").size();
    read_outline(shape.at("LineList"), panel);
    Piece piece;
    piece.panel = static_cast<int>(m_pattern.panels.size());
    piece.starts = {0};
    std::vector<Path> paths;
    for (const PanelEdge& e : panel.loops[0]) {
      paths.push_back(e.path);
      piece.starts.push_back(piece.starts.back() + length(e.path));
    }
    piece.against = signed_area(paths) < 0; // listed so; pieces are always seen from outside
    if (piece.against) {
      std::reverse(panel.loops[0].begin(), panel.loops[0].end());
      for (PanelEdge& e : panel.loops[0])
        e.path = reversed(e.path);
    }
    m_pieces.emplace(id_of(node), piece);
    m_pattern.panels.push_back(std::move(panel));
  }

  void read_outline(const io::Node& lines, Panel& panel) const {
    std::vector<PanelEdge> loop;
    for (std::size_t k = 0; k < lines.size(); ++k)
      loop.push_back({"line" + std::to_string(k), read_line(lines.at(k), m_unit)});
    for (std::size_t k = 0; k < loop.size(); ++k) {
      Vec2& end = loop[k].path.back().p[3];
      const PanelEdge& next = loop[(k + 1) % loop.size()];
      const double gap = (next.path.front().p[0] - end).norm();
      if (!(gap <= 1e-4))
        lines.fail("pattern.outline-open"_id,
                   "the outline of piece " + panel.name + " is open: line " + std::to_string(k) +
                       " ends " + centimetres(gap) + " from where the next one starts",
                   "close the gap");
      end = next.path.front().p[0];
    }
    panel.loops.push_back(std::move(loop));
  }

  void read_group(const io::Node& group, std::size_t number) {
    const io::Node pairs = group.at("PairList");
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      Seam seam;
      seam.name = group.string("Name", "seam " + std::to_string(number));
      if (pairs.size() > 1)
        seam.name += "." + std::to_string(k);
      seam.a = side(pairs.at(k).at("First"));
      seam.b = side(pairs.at(k).at("Second"));
      if (seam.a.empty() || seam.b.empty()) {
        m_pattern.findings.push_back(
            {"clo.left-out"_id,
             "seam " + seam.name + " is left out: one side is on no outline that is listed"});
        continue;
      }
      if (seam.a[0].panel == seam.b[0].panel)
        seam.kind = "dart";
      m_pattern.seams.push_back(std::move(seam));
    }
  }

  /// Runs of one side; none where it is not on an outline.
  std::vector<Run> side(const io::Node& node) const {
    const auto found = m_pieces.find(node.at("ShapeID").string());
    if (found == m_pieces.end())
      return {};
    const Piece& piece = found->second;
    const double whole = piece.starts.back();
    double from = 0, to = whole;
    bool forward = node.boolean("Direction", true);
    if (node.has("LengthParam")) {
      const io::Node stretch = node.at("LengthParam");
      from = fraction(stretch.at("fStart")) * whole;
      to = fraction(stretch.at("fEnd")) * whole;
      if (!node.has("Direction"))
        forward = from < to;
      // Where direction and order contradict each other, it is the shorter stretch.
      const double ahead = std::fmod(to - from + whole, whole);
      if (forward != (from < to) && (forward ? ahead : whole - ahead) > 0.5 * whole)
        std::swap(from, to);
    } else {
      const std::size_t line = line_named(node, piece);
      from = piece.starts[line];
      to = piece.starts[line + 1];
      if (!forward)
        std::swap(from, to);
    }
    if (!forward)
      std::swap(from, to);
    std::vector<Run> runs = stretch(piece, snapped(piece, from), snapped(piece, to));
    if (runs.empty())
      node.fail("clo.malformed"_id, "a side of the seam is empty", "give it a length");
    if (!forward)
      turn(runs);
    return runs;
  }

  static double fraction(const io::Node& node) {
    const double value = node.number();
    if (!(value >= 0 && value <= 1))
      node.fail("clo.malformed"_id, "the place on the outline is no fraction",
                "give a number from 0 to 1");
    return value;
  }

  std::size_t line_named(const io::Node& node, const Piece& piece) const {
    const std::string id = node.at("LineID").string();
    const io::Node pieces = m_root.at("PatternList");
    const io::Node lines =
        pieces.at(static_cast<std::size_t>(piece.panel)).at("ShapeInfo").at("LineList");
    for (std::size_t k = 0; k < lines.size(); ++k)
      if (id_of(lines.at(k)) == id)
        return k;
    node.fail("clo.malformed"_id, "the piece has no line '" + id + "'");
  }

  static double snapped(const Piece& piece, double at) {
    for (double end : piece.starts)
      if (std::abs(end - at) < SNAP_TO_LINE)
        return end;
    return at;
  }

  static void turn(std::vector<Run>& runs) {
    std::reverse(runs.begin(), runs.end());
    for (Run& run : runs)
      std::swap(run.from, run.to);
  }

  /// Along the outline as it is listed, from one place forward to another, over its start where
  /// the second lies before the first.
  static std::vector<Run> stretch(const Piece& piece, double from, double to) {
    const double whole = piece.starts.back();
    std::vector<Run> runs;
    if (to <= from) {
      if (from < whole)
        add_runs(piece, from, whole, runs);
      if (to > 0)
        add_runs(piece, 0, to, runs);
    } else
      add_runs(piece, from, to, runs);
    return runs;
  }
  static void add_runs(const Piece& piece, double from, double to, std::vector<Run>& runs) {
    const int n = static_cast<int>(piece.starts.size()) - 1;
    for (int k = 0; k < n; ++k) {
      const double begin = piece.starts[k], end = piece.starts[static_cast<std::size_t>(k) + 1];
      if (to <= begin || from >= end)
        continue;
      double a = (std::max(from, begin) - begin) / (end - begin),
             b = (std::min(to, end) - begin) / (end - begin);
      int edge = k;
      if (piece.against) {
        edge = n - 1 - k;
        a = 1 - a;
        b = 1 - b;
      }
      runs.push_back({piece.panel, edge, a, b});
    }
  }

  io::Node m_root;
  Pattern m_pattern;
  std::map<std::string, Piece> m_pieces; ///< by what the file calls them
  double m_unit = units::MM;
  std::size_t m_inner = 0;
};

} // namespace

Pattern read_clo_json(const io::Json& json, const std::string& file) {
  return Reader(json, file).run();
}

} // namespace sloper::pattern

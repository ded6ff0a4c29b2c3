/// GarmentCode specifications (Korosteleva and Sorkine-Hornung 2023). A panel's normal, by the
/// sense of its loop, points away from the body, so a panel drawn clockwise is one whose inside we
/// look at: it is turned over, and every loop ends up counter-clockwise seen from outside. Ordinary
/// stitches then join edges that run in opposite directions. GarmentCode sees to that sense itself
/// (Panel.autonorm); specifications written or changed by hand may not.
#include <pattern/read/spec_placement.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/read/read_pattern.hpp>

#include <algorithm>

namespace sloper::pattern {
namespace {

struct EdgeReader {
  double unit = 0.01; ///< m per unit
  bool relative = true;

  Vec2 control(const io::Node& node, const Vec2& a, const Vec2& b) const {
    const Vec2 c = node.vec2();
    if (!relative)
      return c * unit;
    const Vec2 along = b - a;
    return a + c.x() * along + c.y() * Vec2(-along.y(), along.x());
  }

  Path path(const io::Node& edge, const Vec2& a, const Vec2& b) const {
    if (!edge.has("curvature") || edge.at("curvature").is_null())
      return {Segment::straight(a, b)};
    const io::Node curvature = edge.at("curvature");
    if (curvature.is_array())
      return {Segment::quadratic(a, control(curvature, a, b), b)}; // specifications before 2023
    const std::string type = curvature.at("type").string();
    const io::Node params = curvature.at("params");
    if (type == "quadratic")
      return {Segment::quadratic(a, control(params.at(0), a, b), b)};
    if (type == "cubic")
      return {Segment::cubic(a, control(params.at(0), a, b), control(params.at(1), a, b), b)};
    if (type == "circle") {
      const auto flag = [&](std::size_t k) {
        return params.at(k).is_number() ? params.at(k).number() != 0 : params.at(k).boolean();
      };
      const double radius = params.at(0).number() * unit;
      if (!(radius > 0))
        params.fail("json.out-of-range"_id, "the radius is " + std::to_string(radius) + " m",
                    "give a positive radius");
      return circle_arc(a, b, radius, flag(1), flag(2));
    }
    curvature.fail("json.unknown-word"_id, "unknown curve type '" + type + "'",
                   "known are quadratic, cubic and circle");
  }
};

constexpr double FACES_BODY = 0.3; // cosine

/// Whether the panel's outside, by the sense of its loop, is placed towards the axis of the body,
/// and towards the origin too: of a panel that lies on a shoulder one of these says nothing.
bool faces_body(const Panel& panel) {
  std::vector<Path> outline;
  Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
  for (const PanelEdge& e : panel.loops[0]) {
    outline.push_back(e.path);
    for (const Segment& s : e.path) {
      low = low.cwiseMin(s.p[0]);
      high = high.cwiseMax(s.p[0]);
    }
  }
  const Vec2 middle = 0.5 * (low + high);
  const Vec3 center = (*panel.hint.rigid * Eigen::Vector4d(middle.x(), middle.y(), 0, 1)).head<3>(),
             away(center.x(), 0, center.z());
  const Vec3 outwards = (signed_area(outline) < 0 ? -1 : 1) * panel.hint.rigid->col(2).head<3>();
  return outwards.dot(away) < -FACES_BODY * away.norm() && outwards.dot(center) < 0;
}

/// The same loop walked in the opposite direction; edge k of n comes to be edge n - 1 - k.
void reverse_sense(std::vector<PanelEdge>& loop) {
  std::reverse(loop.begin(), loop.end());
  for (PanelEdge& e : loop)
    e.path = reversed(e.path);
}

} // namespace

Pattern read_garmentcode(const io::Json& json, const std::string& file) {
  const io::Node root(json, file);
  const io::Node source = root.at("pattern"), panels = source.at("panels");
  Pattern pattern;
  pattern.source_format = "garmentcode";
  EdgeReader reader;
  if (root.has("properties")) {
    const io::Node properties = root.at("properties");
    const double per_meter = properties.number("units_in_meter", 100);
    if (!(per_meter > 0))
      properties.fail("json.out-of-range"_id, "units_in_meter is not positive",
                      "it is 100 for centimetres");
    reader.unit = 1 / per_meter;
    reader.relative = properties.string("curvature_coords", "relative") == "relative";
  }
  std::vector<char> against; // #panels: listed against their loops' sense
  if (!panels.is_object() || panels.size() == 0)
    panels.fail("pattern.no-panels"_id, "there are no panels");
  const EulerOrder order = euler_order(source);
  if (order == EulerOrder::ZYX)
    pattern.findings.push_back(
        {"pattern.rotation-order"_id,
         "rotations are taken as Rz Ry Rx, as Garment-Pattern-Generator writes them"});
  const bool placed = tells_placement(panels);
  if (!placed)
    pattern.findings.push_back({"pattern.placement-ignored"_id,
                                "all panels are placed in one plane, so the placement is "
                                "ignored: names and seams decide where they go"});
  for (const std::string& name : panels.keys()) {
    const io::Node node = panels.at(name), vertices = node.at("vertices"), edges = node.at("edges");
    Panel panel;
    panel.name = name;
    panel.label = node.string("label", "");
    std::vector<Vec2> points;
    for (std::size_t k = 0; k < vertices.size(); ++k)
      points.push_back(vertices.at(k).vec2() * reader.unit);
    std::vector<PanelEdge> loop;
    if (edges.size() < 2)
      edges.fail("pattern.too-few-edges"_id,
                 "the outline of panel " + name + " has fewer than two edges");
    int last = -1, first = -1;
    for (std::size_t k = 0; k < edges.size(); ++k) {
      const io::Node edge = edges.at(k), ends = edge.at("endpoints");
      const int a = ends.at(0).integer(), b = ends.at(1).integer();
      for (int v : {a, b})
        if (v < 0 || v >= std::ssize(points))
          ends.fail("json.bad-index"_id, "panel " + name + " has no vertex " + std::to_string(v));
      if (k == 0)
        first = a;
      else if (a != last) {
        const double gap = (points[a] - points[last]).norm();
        edge.fail("pattern.outline-open"_id,
                  "the outline of panel " + name + " is open: edge " + std::to_string(k) +
                      " starts " + centimetres(gap) + " from where edge " + std::to_string(k - 1) +
                      " ends",
                  "list the edges in order along the outline");
      }
      last = b;
      loop.push_back({edge.string("label", "") + (edge.has("label") ? "." : "") + std::to_string(k),
                      reader.path(edge, points[a], points[b])});
    }
    if (last != first) {
      const double gap = (points[first] - points[last]).norm();
      edges.fail("pattern.outline-open"_id,
                 "the outline of panel " + name + " is open: its last edge ends " +
                     centimetres(gap) + " from where edge 0 starts",
                 "close the loop");
    }
    panel.loops.push_back(std::move(loop));
    if (placed && node.has("translation") && node.has("rotation"))
      panel.hint.rigid = spec_placement(node, reader.unit, order);
    against.push_back(panel.hint.rigid && faces_body(panel));
    if (against.back()) {
      reverse_sense(panel.loops[0]);
      pattern.findings.push_back(
          {"pattern.turned-over"_id, name + ": placed with its outside towards the body, so its "
                                            "outline is reversed"});
    }
    pattern.panels.push_back(std::move(panel));
  }
  if (source.has("stitches")) {
    const io::Node stitches = source.at("stitches");
    for (std::size_t k = 0; k < stitches.size(); ++k) {
      const io::Node stitch = stitches.at(k);
      Seam seam;
      bool same_direction = false;
      for (std::size_t side = 0; side < stitch.size(); ++side) {
        const io::Node item = stitch.at(side);
        if (item.is_string()) {
          same_direction = same_direction || item.string() == "right_wrong";
          continue;
        }
        const std::string panel_name = item.at("panel").string();
        const int panel = pattern.find_panel(panel_name), edge = item.at("edge").integer();
        if (panel < 0)
          item.fail("pattern.no-panel"_id, "stitch " + std::to_string(k) + " refers to panel '" +
                                               panel_name + "', which does not exist");
        if (edge < 0 || edge >= pattern.panels[panel].n_edges())
          item.fail("pattern.no-edge"_id, "stitch " + std::to_string(k) + " refers to edge " +
                                              std::to_string(edge) + " of panel " + panel_name +
                                              ", which has " +
                                              std::to_string(pattern.panels[panel].n_edges()));
        if (item.has("right_wrong"))
          same_direction = same_direction || item.boolean("right_wrong", false);
        auto& runs = seam.a.empty() ? seam.a : seam.b;
        if (!seam.b.empty())
          item.fail("pattern.stitch-edges"_id,
                    "stitch " + std::to_string(k) + " joins more than two edges");
        const auto p = static_cast<std::size_t>(panel);
        runs.push_back({panel, against[p] ? pattern.panels[p].n_edges() - 1 - edge : edge, 0, 1});
      }
      if (seam.b.empty())
        stitch.fail("pattern.stitch-edges"_id,
                    "stitch " + std::to_string(k) + " joins fewer than two edges");
      const auto& pa = pattern.panels[seam.a[0].panel];
      const auto& pb = pattern.panels[seam.b[0].panel];
      seam.name = pa.name + "." + pa.edge(seam.a[0].edge).name + "-" + pb.name + "." +
                  pb.edge(seam.b[0].edge).name;
      if (!same_direction)
        std::swap(seam.b[0].from, seam.b[0].to);
      if (seam.a[0].panel == seam.b[0].panel)
        seam.kind = "dart";
      pattern.seams.push_back(std::move(seam));
    }
  }
  mend_translation(pattern);
  return pattern;
}

} // namespace sloper::pattern

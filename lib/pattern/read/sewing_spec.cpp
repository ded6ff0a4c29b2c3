/// The neutral sewing JSON: outlines of named runs in millimetres, counter-clockwise seen from
/// outside, and the sidecar with seams only.
#include <pattern/read/outline_json.hpp>
#include <sloper/base/units.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/read/read_pattern.hpp>

#include <set>
#include <string>

namespace sloper::pattern {
namespace {

/// Other words would be sewn like "seam", in silence.
const std::set<std::string> SEAM_KINDS = {"seam", "dart", "gather", "closure"};

std::vector<Run> read_side(const io::Node& node, const Pattern& pattern) {
  std::vector<Run> side;
  for (std::size_t k = 0; k < node.size(); ++k) {
    const io::Node item = node.at(k);
    item.allow_only({"panel", "run", "range", "dir"});
    Run run;
    run.panel = panel_named(pattern, item.at("panel"));
    run.edge = edge_named(pattern.panels[run.panel], item.at("run"));
    if (item.has("range")) {
      run.from = item.at("range").at(0).number();
      run.to = item.at("range").at(1).number();
    }
    const std::string direction = item.string("dir", "+");
    if (direction != "+" && direction != "-")
      item.at("dir").fail("json.unknown-word"_id, "the direction is '" + direction + "'",
                          "give + or -");
    if (direction == "-")
      std::swap(run.from, run.to);
    if (run.from < 0 || run.from > 1 || run.to < 0 || run.to > 1 || run.from == run.to)
      item.fail("json.out-of-range"_id, "the range is empty or outside of the run",
                "give two fractions from 0 to 1");
    side.push_back(run);
  }
  if (side.empty())
    node.fail("pattern.seam-side-empty"_id, "a side of the seam is empty");
  return side;
}

} // namespace

static void read_seams(Pattern& pattern, const io::Node& seams) {
  for (std::size_t k = 0; k < seams.size(); ++k) {
    const io::Node node = seams.at(k);
    node.allow_only({"name", "kind", "ease", "open", "a", "b", "and", "score", "ratio", "length_a",
                     "length_b"});
    Seam seam;
    seam.name = node.string("name", "seam " + std::to_string(k));
    seam.kind = node.string("kind", "seam");
    if (SEAM_KINDS.count(seam.kind) == 0)
      node.at("kind").fail("json.unknown-word"_id, "'" + seam.kind + "' is not a kind of seam",
                           "use seam, dart, gather or closure");
    seam.ease = node.string("ease", "");
    seam.open = node.boolean("open", false);
    seam.a = read_side(node.at("a"), pattern);
    seam.b = read_side(node.at("b"), pattern);
    pattern.seams.push_back(std::move(seam));
    if (node.has("and"))
      read_seams(pattern, node.at("and")); // its mirror image
  }
}

void read_sewing_seams(Pattern& pattern, const io::Json& json, const std::string& file) {
  read_seams(pattern, io::Node(json, file).at("seams"));
}

Pattern read_sewing_spec(const io::Json& json, const std::string& file) {
  const io::Node root(json, file);
  const double unit = root.has("units") ? unit_of(root.at("units")) : units::MM;
  Pattern pattern;
  pattern.source_format = "sewing-spec";
  pattern.name = root.string("name", "");
  const io::Node panels = root.at("panels");
  if (!panels.is_array() || panels.size() == 0)
    panels.fail("pattern.no-panels"_id, "there are no panels");
  for (std::size_t k = 0; k < panels.size(); ++k) {
    const io::Node node = panels.at(k);
    Panel panel;
    panel.name = node.at("name").string();
    if (pattern.find_panel(panel.name) >= 0)
      node.fail("pattern.name-twice"_id, "there are two panels named '" + panel.name + "'");
    panel.loops.push_back(read_loop(node.at("outline"), "run", unit, panel.name));
    if (node.has("holes"))
      for (std::size_t h = 0; h < node.at("holes").size(); ++h)
        panel.loops.push_back(read_loop(node.at("holes").at(h), "run", unit, panel.name));
    if (node.has("grain")) {
      const Vec2 along = node.at("grain").at(1).vec2() - node.at("grain").at(0).vec2();
      if (along.norm() > 0)
        panel.grain = along.normalized();
    }
    if (node.has("place")) {
      const io::Node place = node.at("place");
      const std::string frame = place.string("frame", "");
      if (frame == "world") {
        Mat4 m = Mat4::Identity();
        for (std::size_t r = 0; r < 3; ++r) {
          for (std::size_t c = 0; c < 3; ++c)
            m(static_cast<long>(r), static_cast<long>(c)) =
                place.at("rotation").at(r).at(c).number();
          m(static_cast<long>(r), 3) = place.at("translation").at(r).number() * unit;
        }
        panel.hint.rigid = m;
      } else if (!frame.empty()) {
        panel.hint.part = frame;
        panel.hint.theta = units::radians(place.number("theta_deg", 0));
        if (place.has("radius"))
          panel.hint.radius = place.at("radius").number() * unit;
        panel.hint.anchor = place.at("anchor").vec2() * unit;
        panel.hint.height = place.at("height").number() * unit;
      }
    }
    pattern.panels.push_back(std::move(panel));
  }
  if (root.has("seams"))
    read_sewing_seams(pattern, json, file);
  return pattern;
}

} // namespace sloper::pattern

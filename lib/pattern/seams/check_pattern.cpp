#include <pattern/seams/missing_seams.hpp>
#include <sloper/base/error.hpp>
#include <sloper/base/units.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/mesh/folds.hpp>
#include <sloper/pattern/seams/check_pattern.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

namespace sloper::pattern {
namespace {

constexpr double SAMPLE = 0.004; // m between points on curves
constexpr double SPIKE = 10;     // degrees
constexpr double TINY = 0.002;   // m
constexpr double LEAST = 0.12;   // m: a garment whose largest panel is smaller was drawn in another
                                 // unit than it states, or is a doll's
constexpr double MOST = 12; // m2, a panel's height times its width: a full circle to the floor has
                            // 10, a long flounce less
constexpr double MOST_GATHERED = 20; // to 1: tulle is gathered by 5 to 1 at most
constexpr double UNIT_STEP = 10;     // from mm to cm, the commonest mistake

struct Sampled {
  std::vector<Vec2> points;
  std::vector<int> edge; ///< of the segment that starts at each point
  std::vector<int> loop;
  std::vector<std::size_t> next;
};

Sampled sample(const Panel& panel) {
  Sampled out;
  int e = 0, l = 0;
  for (const auto& loop : panel.loops) {
    const std::size_t first = out.points.size();
    for (const PanelEdge& edge : loop) {
      for (const Segment& s : edge.path) {
        const int n = s.line ? 1
                             : static_cast<int>(std::ceil(
                                   std::max(8.0, std::min(400.0, s.length(0, 1) / SAMPLE))));
        for (int k = 0; k < n; ++k) {
          out.points.push_back(s.at(static_cast<double>(k) / n));
          out.edge.push_back(e);
          out.loop.push_back(l);
        }
      }
      ++e;
    }
    for (std::size_t k = first; k < out.points.size(); ++k)
      out.next.push_back(k + 1 < out.points.size() ? k + 1 : first);
    ++l;
  }
  return out;
}

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Whether the open segments ab and cd cross or touch.
bool meet(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const double o1 = cross(b - a, c - a), o2 = cross(b - a, d - a), o3 = cross(d - c, a - c),
               o4 = cross(d - c, b - c);
  if (((o1 > 0 && o2 < 0) || (o1 < 0 && o2 > 0)) && ((o3 > 0 && o4 < 0) || (o3 < 0 && o4 > 0)))
    return true;
  const auto on = [](const Vec2& p, const Vec2& q, const Vec2& x, double o) {
    return std::abs(o) <= 1e-12 && (x - p).dot(q - p) >= 0 &&
           (x - p).dot(q - p) <= (q - p).squaredNorm();
  };
  return on(a, b, c, o1) || on(a, b, d, o2) || on(c, d, a, o3) || on(c, d, b, o4);
}

std::string at_point(const Vec2& p) {
  char text[64];
  std::snprintf(text, sizeof text, "at (%.2f, %.2f) cm", p.x() * 100, p.y() * 100);
  return text;
}

class Check {
public:
  explicit Check(const Pattern& pattern)
      : m_pattern(with_folds(pattern, "")) {} // lengths are those that are sewn
  /// @param meant  with what can be sewn and seems to be meant otherwise, which a live edit does
  /// not wait for
  std::vector<PatternFinding> run(bool meant = true) {
    for (const Panel& p : m_pattern.panels)
      check_outline(p);
    check_unit();
    check_runs();
    for (const Seam& s : m_pattern.seams)
      if (s.kind != "pleat")
        check_seam(s);
    check_unsewn();
    if (meant)
      check_missing();
    return std::move(m_out);
  }

private:
  void add(const char* severity, const char* rule, const std::string& place,
           const std::string& fact) {
    m_out.push_back({severity, rule, place, fact});
  }

  /// What can be no garment at all is refused when it is read; this is what can be one, of a giant
  /// or a doll.
  void check_unit() {
    Vec2 largest = Vec2::Zero();
    const Panel* which = nullptr;
    for (const Panel& panel : m_pattern.panels) {
      Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
      for (const Vec2& q : sample(panel).points) {
        low = low.cwiseMin(q);
        high = high.cwiseMax(q);
      }
      if (const Vec2 size = high - low;
          size.prod() > largest.prod() || (size.prod() == largest.prod() && !which)) {
        largest = size;
        which = &panel;
      }
    }
    if (!which)
      return;
    const bool small = largest.maxCoeff() < LEAST;
    if (!small && largest.prod() < MOST)
      return;
    const double factor = small ? UNIT_STEP : 1 / UNIT_STEP;
    const auto extent = [&](double by) {
      return centimetres(by * largest.x()) + " by " + centimetres(by * largest.y());
    };
    add("error", "wrong-unit", which->name,
        "the largest panel measures " + extent(1) + ": nobody is that " +
            (small ? "small" : "large") + "; in a unit ten times " +
            (small ? "larger" : "smaller") + " it would be " + extent(factor) + ": check " +
            unit_key());
  }

  /// Where the file states its unit.
  std::string unit_key() const {
    if (m_pattern.source_format == "pattern")
      return "\"length_unit\"";
    if (m_pattern.source_format == "garmentcode")
      return "\"units_in_meter\" in \"properties\"";
    if (m_pattern.source_format == "dxf")
      return "the text \"Units\", or $INSUNITS, or state it with --unit";
    return "that lengths are in millimetres, as the format asks for";
  }

  void check_missing() {
    for (const MissingSeam& s : missing_seams(m_pattern))
      add("error", "open-seam", place_of(m_pattern, s.a),
          "is not sewn to " + place_of(m_pattern, s.b) +
              ", though it seems to belong there: " + s.why + "; add the seam" +
              (m_pattern.source_format == "pattern" ? ", with \"open\": true if it is to stay open"
                                                    : ""));
  }

  void check_outline(const Panel& panel) {
    const Sampled s = sample(panel);
    const std::size_t n = s.points.size();
    std::vector<std::size_t> order(
        n); // by their left end, so that only neighbours in x are compared
    for (std::size_t k = 0; k < n; ++k)
      order[k] = k;
    const auto left = [&](std::size_t k) {
      return std::min(s.points[k].x(), s.points[s.next[k]].x());
    };
    const auto right = [&](std::size_t k) {
      return std::max(s.points[k].x(), s.points[s.next[k]].x());
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return left(a) < left(b); });
    std::map<std::pair<int, int>, bool> reported;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 1; j < n && left(order[j]) <= right(order[i]); ++j) {
        const std::size_t a = std::min(order[i], order[j]), b = std::max(order[i], order[j]);
        if (s.next[a] == b || s.next[b] == a ||
            !meet(s.points[a], s.points[s.next[a]], s.points[b], s.points[s.next[b]]))
          continue;
        const std::pair<int, int> edges{std::min(s.edge[a], s.edge[b]),
                                        std::max(s.edge[a], s.edge[b])};
        if (reported[edges])
          continue;
        reported[edges] = true;
        const std::string first = panel.edge(edges.first).name,
                          second = panel.edge(edges.second).name;
        add("error", "crossing-outline", panel.name + ": " + first,
            (edges.first == edges.second ? "crosses itself "
                                         : "crosses or touches " + second + " ") +
                at_point(s.points[a]));
      }
    check_holes(panel, s);
    for (int e = 0; e < panel.n_edges(); ++e)
      if (const double l = length(panel.edge(e).path); l < TINY)
        add("warning", "tiny-edge", panel.name + ": " + panel.edge(e).name,
            "is " + centimetres(l) + " long");
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t b = s.next[k], c = s.next[b];
      const Vec2 in = s.points[k] - s.points[b], out = s.points[c] - s.points[b];
      if (in.norm() < 1e-9 || out.norm() < 1e-9)
        continue;
      double angle = units::degrees(std::atan2(cross(out, in), out.dot(in)));
      if (angle < 0)
        angle += 360;
      if (angle < SPIKE) {
        char text[80];
        std::snprintf(text, sizeof text, "a spike of %.1f degrees %s", angle,
                      at_point(s.points[b]).c_str());
        add("warning", "sharp-spike", panel.name + ": " + panel.edge(s.edge[b]).name, text);
      }
    }
  }

  /// A hole that crosses nothing lies in the panel with its first point, or not at all.
  void check_holes(const Panel& panel, const Sampled& s) {
    for (std::size_t h = 0; h < s.points.size(); ++h) {
      if (s.loop[h] == 0 || (h > 0 && s.loop[h] == s.loop[h - 1]))
        continue;
      bool inside = false;
      double nearest = 1e300;
      for (std::size_t k = 0; k < s.points.size() && s.loop[k] == 0; ++k) {
        const Vec2 a = s.points[k], b = s.points[s.next[k]], p = s.points[h];
        if ((a.y() > p.y()) != (b.y() > p.y()) &&
            p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
          inside = !inside;
        nearest = std::min(nearest, (a - p).norm());
      }
      if (!inside)
        add("error", "hole-outside", panel.name + ": " + panel.edge(s.edge[h]).name,
            "this hole starts outside of the outline, " + centimetres(nearest) +
                " from its nearest corner");
    }
  }

  /// Notches of two whole edges sewn to each other should meet. A notch of the longer list without
  /// a partner within 1 cm is a finding.
  void check_notches(const Seam& seam) {
    if (seam.a.size() != 1 || seam.b.size() != 1 || seam.kind == "gather" || !seam.ease.empty())
      return;
    std::vector<double> at[2];
    double sewn[2];
    for (std::size_t side = 0; side < 2; ++side) {
      const Run& run = side ? seam.b[0] : seam.a[0];
      sewn[side] = run_length(m_pattern, run);
      for (const Notch& n : m_pattern.panels[run.panel].notches)
        if (n.edge == run.edge && n.at >= std::min(run.from, run.to) &&
            n.at <= std::max(run.from, run.to))
          at[side].push_back((n.at - run.from) / (run.to - run.from) * sewn[side]);
    }
    if (at[0].empty() || at[1].empty())
      return;
    for (std::size_t side = 0; side < 2; ++side)
      for (double x : at[side]) {
        double nearest = 1e300;
        for (double y : at[1 - side])
          nearest = std::min(nearest, std::abs(x - y));
        if (nearest > 0.01)
          add("warning", "notch-mismatch", "seam " + seam.name,
              "the notch of " + place_of(m_pattern, side ? seam.b[0] : seam.a[0]) + " at " +
                  centimetres(x) + " misses its partner by " + centimetres(nearest));
      }
  }

  void check_runs() {
    struct Use {
      double from, to;
      std::string seam;
    };
    std::map<std::pair<int, int>, std::vector<Use>> uses;
    for (const Seam& seam : m_pattern.seams)
      for (const auto* side : {&seam.a, &seam.b})
        for (const Run& run : *side) {
          if (seam.kind == "pleat")
            continue; // three layers in one line
          const Use use{std::min(run.from, run.to), std::max(run.from, run.to), seam.name};
          for (const Use& other : uses[{run.panel, run.edge}]) {
            const double overlap = std::min(use.to, other.to) - std::max(use.from, other.from);
            if (overlap < 1e-6)
              continue;
            const double metres = overlap * length(m_pattern.panels[run.panel].edge(run.edge).path);
            add("error", "sewn-twice", place_of(m_pattern, run),
                centimetres(metres) + " are sewn twice, by " + other.seam + " and by " + use.seam);
          }
          uses[{run.panel, run.edge}].push_back(use);
        }
  }

  void check_seam(const Seam& seam) {
    const double a = side_length(m_pattern, seam.a), b = side_length(m_pattern, seam.b);
    if (std::max(a, b) > MOST_GATHERED * std::min(a, b)) {
      add("error", "impossible-gather", "seam " + seam.name,
          place_of(m_pattern, seam.a[0]) + " is " + centimetres(a) + ", " +
              place_of(m_pattern, seam.b[0]) + " is " + centimetres(b) +
              ": cloth cannot be gathered by more than 20 to 1; sew other edges together, or a "
              "part "
              "of the longer one");
      return;
    }
    const double difference = std::abs(a - b), ratio = difference / std::max(std::min(a, b), 1e-9);
    if (difference > 0.003 && ratio > 0.02 && seam.kind != "gather" && seam.ease.empty()) {
      char text[200];
      std::snprintf(text, sizeof text, "%s is %s, %s is %s: %s (%.1f %%) apart",
                    place_of(m_pattern, seam.a[0]).c_str(), centimetres(a).c_str(),
                    place_of(m_pattern, seam.b[0]).c_str(), centimetres(b).c_str(),
                    centimetres(difference).c_str(), ratio * 100);
      // GarmentCode and DXF cannot say that a difference is meant.
      const bool can_tell =
          m_pattern.source_format == "pattern" || m_pattern.source_format == "sewing-spec";
      add(can_tell ? "error" : "warning", "length-mismatch", "seam " + seam.name, text);
    }
    if (ratio > 3 && (seam.kind == "gather" || !seam.ease.empty()))
      add("warning", "many-gathers", "seam " + seam.name,
          place_of(m_pattern, seam.a[0]) + " is " + centimetres(a) + ", " +
              place_of(m_pattern, seam.b[0]) + " is " + centimetres(b) + ": more than 4 to 1");
    check_notches(seam);
    // Loops are counter-clockwise from outside: a seam that keeps the face outside runs along one
    // and against the other.
    if ((seam.a[0].from < seam.a[0].to) == (seam.b[0].from < seam.b[0].to))
      add("warning", "face-to-back", "seam " + seam.name,
          "joins the outside of one panel to the inside of the other");
  }

  void check_unsewn() {
    if (m_pattern.seams.empty() && m_pattern.panels.size() > 1 &&
        m_pattern.source_format != "dxf") { // a DXF often has none: they are guessed
      add("error", "unsewn-panel", m_pattern.name.empty() ? "pattern" : m_pattern.name,
          "no seam holds its " + std::to_string(m_pattern.panels.size()) + " panels together");
      return;
    }
    std::vector<char> sewn(m_pattern.panels.size(), 0);
    for (const Seam& seam : m_pattern.seams)
      for (const auto* side : {&seam.a, &seam.b})
        for (const Run& run : *side)
          sewn[run.panel] = 1;
    for (std::size_t k = 0; k < sewn.size(); ++k)
      if (!sewn[k])
        add(m_pattern.panels.size() == 1 ? "info" : "warning", "unsewn-panel",
            m_pattern.panels[k].name, "nothing is sewn to this panel");
    check_parts();
  }

  /// Several panels that are sewn to each other and not to the garment, as a waistband may be.
  void check_parts() {
    const std::vector<std::vector<int>> parts = sewn_parts(m_pattern);
    for (std::size_t k = 1; k < parts.size(); ++k) {
      if (parts[k].size() < 2)
        continue;
      std::string others;
      for (std::size_t q = 1; q < parts[k].size(); ++q)
        others += (q > 1 ? ", " : "") + m_pattern.panels[parts[k][q]].name;
      // A pattern of our own may hold two garments; the other formats are of one.
      add(m_pattern.source_format == "pattern" ? "warning" : "error", "loose-part",
          m_pattern.panels[parts[k][0]].name,
          "is sewn to " + others + " and to nothing else of the garment: which edge joins them?");
    }
  }

  const Pattern m_pattern;
  std::vector<PatternFinding> m_out;
};

} // namespace

std::vector<PatternFinding> check_pattern(const Pattern& pattern) {
  return Check(pattern).run();
}

io::Json findings_sarif(const std::vector<PatternFinding>& findings, const std::string& file,
                        const std::string& tool) {
  io::Json rules = io::Json::array(), results = io::Json::array();
  std::vector<std::string> known;
  for (const PatternFinding& f : findings) {
    if (std::find(known.begin(), known.end(), f.rule) == known.end()) {
      known.push_back(f.rule);
      rules.push_back({{"id", f.rule}});
    }
    const io::Json location = {
        {"physicalLocation", {{"artifactLocation", {{"uri", io::file_name(file)}}}}},
        {"logicalLocations", io::Json::array({io::Json{{"fullyQualifiedName", f.place}}})}};
    results.push_back({{"ruleId", f.rule},
                       {"level", f.severity == "info" ? "note" : f.severity},
                       {"message", {{"text", f.place + ": " + f.fact}}},
                       {"locations", io::Json::array({location})}});
  }
  const io::Json driver = {{"name", tool}, {"rules", rules}};
  return {
      {"$schema", "https://json.schemastore.org/sarif-2.1.0.json"},
      {"version", "2.1.0"},
      {"runs", io::Json::array({io::Json{{"tool", {{"driver", driver}}}, {"results", results}}})}};
}

bool forbids_sewing(const PatternFinding& f) {
  return f.severity == "error" && f.rule != "length-mismatch" && f.rule != "wrong-unit" &&
         f.rule != "open-seam" && f.rule != "unsewn-panel" && f.rule != "loose-part";
}

void require_sewable(const Pattern& pattern, const std::string& file) {
  for (const PatternFinding& f : Check(pattern).run(false))
    if (forbids_sewing(f))
      throw input_error("pattern.cannot-be-sewn"_id, file, f.place, f.fact,
                        "pattern-mesh --check lists all findings");
}

} // namespace sloper::pattern

/// Chest, waist, hip and lengths of the finished garment, measured on its panels as one cloth.
#include <pattern/layout/leg_layout.hpp>
#include <pattern/layout/panel_layout.hpp>
#include <pattern/measure/sewn_cloth.hpp>
#include <pattern/roles/panel_roles.hpp>
#include <sloper/pattern/measure/finished_measures.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sloper::pattern {
namespace {

constexpr double BELOW_SEAM = 0.025; // m below armhole, crotch or sleeve seam
constexpr double ABOVE_CROTCH =
    0.075; // m: lower down the cloth between the legs counts to the thigh
constexpr double BAND_HEIGHT =
    0.08;                      // m: what is less high at the top of a side seam is a waistband
constexpr double EYELET = 0.1; // m around: openings so small take nothing from a girth
constexpr double RISES = 0.7;  // rise per length of a seam that goes up
constexpr double SHOULDER_DROP = 0.2; // m that a yoke reaches over the shoulder
constexpr double SKIRT_TELLS = 1e-3;  // of what a bodice does
constexpr double LEVEL_STEP = 0.01;   // m between the levels looked at
constexpr double NEAR_TOP = 0.012;    // m: levels so near to an end are taken there
constexpr double UNKNOWN = std::numeric_limits<double>::quiet_NaN();

/// Seams one after the other, from the top down.
struct SeamLine {
  int top = 0, bottom = 0; ///< welded vertices
  double high = 0, low = 0, length = 0, first = 0;
};

class Measurer {
public:
  Measurer(const Pattern& pattern, const PanelMesh& mesh, const std::vector<Opening>& openings)
      : m_mesh(mesh), m_openings(openings), m_graph(mesh),
        m_roles(panel_roles(pattern, mesh, m_graph)),
        m_trunk(mesh, trunk_cloth(mesh, m_graph, m_roles)),
        m_left_arm(mesh, panels_of(Region::ARM_L)), m_height(heights(pattern)) {
    for (std::size_t v = 0; v < m_height.size(); ++v) {
      if (std::isnan(m_height[v]))
        continue;
      m_bottom = std::min(m_bottom, m_height[v]);
      if (tells_height(static_cast<int>(v)) && m_height[v] > m_top) {
        m_top = m_height[v];
        m_highest = v;
      }
    }
    if (m_top <= m_bottom)
      return;
    m_shoulder = shoulders();
    if (m_shoulder > 0)
      depth_below_chest();
    else
      depth_below_waist();
  }

  std::vector<NamedMeasure> named() {
    if (m_top <= m_bottom || m_mesh.seams.empty())
      return {}; // pieces of cloth
    if (m_shoulder > 0)
      upper();
    else
      lower();
    lengths();
    if (m_shoulder > 0)
      neck();
    add("hem", hem_length(), "around the lowest opening");
    sleeve();
    return std::move(m_out);
  }

  std::vector<std::array<double, 2>> around() const {
    std::vector<std::array<double, 2>> out;
    double deepest = 0;
    for (double d : m_depth)
      deepest = std::max(deepest, std::isnan(d) ? 0 : d);
    for (double depth = 0.05; depth < deepest - 1e-9; depth += 0.05)
      out.push_back({depth, m_trunk.around(m_depth, depth).length});
    return out;
  }

private:
  void add(const std::string& name, double value, const std::string& how) {
    if (value > 0.01)
      m_out.push_back({name, value, how});
  }
  double height(int v) const { return m_height[v]; }
  /// Height below which a seam goes: as far as the cloth hangs, not as it is drawn.
  double level(int v) const { return m_depth.empty() ? height(v) : m_top - m_depth[v]; }
  bool arm(int panel) const {
    return region(panel) == Region::ARM_L || region(panel) == Region::ARM_R;
  }
  Region region(int panel) const { return m_roles[panel].region; }
  const PanelRole& role(int panel) const { return m_roles[panel]; }
  double drawn(int v, int w) const { return (m_mesh.pattern[v] - m_mesh.pattern[w]).norm(); }

  /// Skirts need not be drawn as they hang: where there is a bodice, that tells.
  bool tells_height(int v) const {
    return m_only_skirt || role(m_graph.panel_of(v)).part != "lower_body";
  }

  std::vector<bool> panels_of(Region wanted) const {
    std::vector<bool> out;
    for (const PanelRole& r : m_roles)
      out.push_back(r.region == wanted);
    return out;
  }

  Field heights(const Pattern& pattern) {
    const std::vector<PanelSpot> spots = lay_out(pattern, m_mesh, m_graph, m_roles);
    Field laid_v(m_mesh.pattern.size());
    for (std::size_t v = 0; v < laid_v.size(); ++v) {
      const std::size_t k = static_cast<std::size_t>(m_graph.panel_of(static_cast<int>(v)));
      laid_v[v] = laid(m_mesh, m_roles[k], spots[k], static_cast<int>(v)).y();
    }
    for (const PanelRole& r : m_roles)
      m_only_skirt = m_only_skirt && (r.region != Region::TRUNK || r.part == "lower_body");
    m_arm_height = m_left_arm.height(m_roles, laid_v, {});
    return m_trunk.height(m_roles, laid_v, [&](int panel) {
      return m_only_skirt || role(panel).part != "lower_body" ? 1.0 : SKIRT_TELLS;
    });
  }

  /// Seams between panels of the trunk that `wanted` takes, joined where one ends where the next
  /// begins, on whatever edges they are drawn.
  template<class Wanted> std::vector<SeamLine> upright_lines(const Wanted& wanted) const {
    std::vector<SeamLine> lines;
    const int n = std::ssize(m_roles);
    for (int p = 0; p < n; ++p)
      for (int q = p; q < n; ++q) {
        if (region(p) != Region::TRUNK || region(q) != Region::TRUNK || !wanted(role(p), role(q)))
          continue;
        for (const auto& seam : m_graph.between(p, q)) {
          SeamLine line;
          for (std::size_t s = 1; s < seam.size();
               ++s) // where a dart begins on one side, that side jumps
            line.length +=
                std::min(drawn(seam[s][0], seam[s - 1][0]), drawn(seam[s][1], seam[s - 1][1]));
          const bool down = level(seam.front()[0]) > level(seam.back()[0]);
          const int top = (down ? seam.front() : seam.back())[0],
                    bottom = (down ? seam.back() : seam.front())[0];
          line.high = level(top);
          line.low = level(bottom);
          line.first = line.length;
          line.top = m_trunk.welded(top);
          line.bottom = m_trunk.welded(bottom);
          if (line.high - line.low > RISES * line.length)
            lines.push_back(line);
        }
      }
    for (bool joined = true; joined;) {
      joined = false;
      for (std::size_t i = 0; i < lines.size() && !joined; ++i)
        for (std::size_t j = 0; j < lines.size() && !joined; ++j) {
          if (i == j || lines[i].bottom != lines[j].top)
            continue;
          lines[i].bottom = lines[j].bottom;
          lines[i].low = lines[j].low;
          lines[i].length += lines[j].length;
          lines.erase(lines.begin() + static_cast<long>(j));
          joined = true;
        }
    }
    return lines;
  }

  /// Length of a shoulder seam, 0 where the garment has none: a level seam of front and back near
  /// the top. Sleeves and collars hang on shoulders too.
  double shoulders() const {
    double length = 0;
    bool hung = false;
    for (int k = 0; k < std::ssize(m_roles); ++k) {
      hung = hung || region(k) != Region::TRUNK;
      if (region(k) != Region::TRUNK || role(k).side != Side::FRONT || role(k).part == "lower_body")
        continue; // a circle skirt's sides may be drawn level
      for (int q : m_graph.neighbours(k)) {
        if (region(q) != Region::TRUNK || role(q).side != Side::BACK ||
            role(q).part == "lower_body")
          continue;
        for (const auto& seam : m_graph.between(k, q)) {
          const int a = seam.front()[0], b = seam.back()[0];
          const double rise = std::abs(height(a) - height(b)), straight = drawn(a, b);
          if (straight * straight > (1 + 1.2 * 1.2) * rise * rise &&
              std::min(height(a), height(b)) > m_top - SHOULDER_DROP)
            length = std::max(length, straight);
        }
      }
    }
    if (length > 0)
      return length;
    return hung ? 1e-6 : 0;
  }

  /// The opening of the trunk whose rim lies highest or lowest; of collars, above all.
  const Opening* trunk_opening(bool highest) const {
    const Opening* best = nullptr;
    double level = 0;
    for (const Opening& o : m_openings) {
      double sum = 0;
      int n = 0;
      for (const auto& side : o.rim)
        for (int v : side) {
          const int panel = m_graph.panel_of(v);
          const double h = region(panel) == Region::NECK ? m_top + 10 : height(v);
          if (!arm(panel) && !std::isnan(h)) {
            sum += h;
            ++n;
          }
        }
      if (n > 0 && (!best || (highest ? sum / n > level : sum / n < level))) {
        best = &o;
        level = sum / n;
      }
    }
    return best;
  }
  /// Of a garment that is open at the front, neckline, fronts and hem are one opening.
  bool one_opening() const { return trunk_opening(true) == trunk_opening(false); }

  /// Where the rim of an opening lies, as the start of a path.
  Field from_rim(const Opening& opening) const {
    Field start(m_mesh.pattern.size(), UNKNOWN);
    for (const auto& side : opening.rim)
      for (int v : side)
        if (!std::isnan(height(v)))
          start[v] = 0;
    return start;
  }

  double hem_length() const {
    const Opening* hem = trunk_opening(false);
    if (!hem)
      return 0;
    if (!one_opening())
      return hem->length;
    double sum = 0; // what is level of its lower part
    for (const auto& [a, b] : hem->rim)
      if (height(a) < m_bottom + 0.25 * (m_top - m_bottom) &&
          std::abs(height(a) - height(b)) < RISES * drawn(a, b))
        sum += drawn(a, b);
    return sum;
  }

  /// The level of the armholes' lower end; of what has none, its top.
  double armhole() const {
    double level = 1e300;
    for (int p = 0; p < std::ssize(m_roles); ++p)
      for (int q : m_graph.neighbours(p))
        if (region(p) == Region::TRUNK && arm(q))
          for (const auto& seam : m_graph.between(p, q))
            for (const auto& s : seam)
              level = std::isnan(height(s[0])) ? level : std::min(level, height(s[0]));
    if (level < 1e299)
      return level;
    const Opening *top = trunk_opening(true), *hem = trunk_opening(false);
    for (const Opening& o : m_openings)
      if (&o != top && &o != hem)
        for (const auto& side : o.rim)
          for (int v : side)
            level = std::isnan(height(v)) ? level : std::min(level, height(v));
    if (level < 1e299)
      return level;
    level = m_top; // a front that is open: where the side seams begin
    double longest = 0;
    for (const SeamLine& line : upright_lines(side_seams))
      if (line.length > longest) {
        longest = line.length;
        level = line.high;
      }
    return level;
  }

  static bool side_seams(const PanelRole& a, const PanelRole& b) {
    return a.side != b.side || a.side == Side::RING;
  }

  /// Levels of what hangs on shoulders: straight down to the chest, from there along the cloth, so
  /// that a wide skirt is measured as it hangs.
  void depth_below_chest() {
    m_chest = armhole() - BELOW_SEAM;
    Field start(m_height.size(), UNKNOWN);
    for (std::size_t v = 0; v < start.size(); ++v)
      if (m_height[v] >= m_chest && tells_height(static_cast<int>(v)))
        start[v] = m_top - m_height[v];
    m_depth = m_trunk.distance_from(start);
  }

  /// Levels of what hangs on the waist: along the cloth from its top.
  void depth_below_waist() {
    const Opening* top = trunk_opening(true);
    if (top && !one_opening())
      m_depth = m_trunk.distance_from(from_rim(*top));
    else {
      m_depth = m_height;
      for (double& d : m_depth)
        d = m_top - d;
    }
  }

  /// Where the cloth begins to end: the highest point of a hem that lies deeper than this. Slits
  /// and open fronts are no hems, eyelets neither.
  double hem_depth(double deeper) const {
    double depth = 1e300;
    for (const Opening& o : m_openings) {
      if (o.length < EYELET)
        continue;
      for (const auto& [a, b] : o.rim) {
        const double at_a = m_depth[a], at_b = m_depth[b];
        if (std::min(at_a, at_b) > deeper && std::abs(at_a - at_b) < RISES * drawn(a, b))
          depth = std::min({depth, at_a, at_b});
      }
    }
    return depth;
  }

  /// (depth, girth) of the narrowest or widest level between two depths that goes around; girth 0
  /// where none does.
  std::pair<double, double> extreme(double from, double to, bool widest) const {
    std::pair<double, double> best{0, 0};
    to = std::min(to, hem_depth(m_shoulder > 0 ? m_top - m_chest : NEAR_TOP));
    for (int k = 0; from + LEVEL_STEP * k < to + 1e-9; ++k) {
      const SewnCloth::Ring ring = m_trunk.around(m_depth, from + LEVEL_STEP * k);
      if (ring.whole &&
          (best.second == 0 || (widest ? ring.length > best.second : ring.length < best.second)))
        best = {from + LEVEL_STEP * k, ring.length};
    }
    return best;
  }

  void upper() {
    add("shoulder", m_shoulder, "along the shoulder seam, straight");
    const double chest = m_top - m_chest;
    add("chest", m_trunk.around(m_depth, chest).length, "around, 2.5 cm below the armholes");
    const auto [waist, girth] = extreme(chest + 0.10, chest + 0.25, false);
    if (girth <= 0)
      return;
    add("waist", girth, "around, narrowest from 10 to 25 cm below the chest");
    add("hip", extreme(waist + 0.15, waist + 0.25, true).second,
        "around, widest from 15 to 25 cm below the waist");
  }

  void lower() {
    const Opening* top = trunk_opening(true);
    add("waist", top && !one_opening() ? top->length : m_trunk.around(m_depth, NEAR_TOP).length,
        "around the top");
    int crotch = -1;
    for (int p = 0; p < std::ssize(m_roles); ++p)
      for (int q : m_graph.neighbours(p)) {
        if (!is_leg(role(p)) || !is_leg(role(q)) || role(p).part == role(q).part)
          continue;
        for (const auto& seam : m_graph.between(p, q))
          for (const auto& s : seam)
            if (crotch < 0 || height(s[0]) < height(crotch))
              crotch = s[0];
      }
    if (crotch < 0) {
      add("hip", extreme(0.15, 0.25, true).second, "around, widest from 15 to 25 cm below the top");
      return;
    }
    const double lowest = std::min(0.25, m_depth[crotch] - ABOVE_CROTCH);
    add("hip", extreme(std::min(0.15, lowest), lowest, true).second,
        "around, widest from 15 to 25 cm below the top and 7.5 cm above the crotch");
    legs(crotch);
  }

  void legs(int crotch) {
    double rise = 0, inseam = 0, leg_hem = 0;
    const auto middle = [](const PanelRole& a, const PanelRole& b) {
      return is_leg(a) && is_leg(b) && a.part != b.part && a.side != Side::BACK &&
             b.side != Side::BACK;
    };
    for (const SeamLine& line : upright_lines(middle)) // of legs in one piece the back's middle
                                                       // seam is one of them, and the longer one
      if (line.high - line.low > 0.05)
        rise = rise > 0 ? std::min(rise, line.length) : line.length;
    for (const SeamLine& line : upright_lines([](const PanelRole&a, const PanelRole&b) {
           return a.part == "leg_l" && b.part == "leg_l";
         }))
      if (line.high < level(crotch) + 0.05 && line.high - line.low > 0.05)
        inseam = std::max(inseam, line.length);
    add("rise", rise, "along the front's middle seam");
    add("inseam", inseam, "along the inner leg's seam");
    const auto left = [&](int panel) { return role(panel).part == "leg_l"; };
    add("thigh", m_trunk.around(m_height, height(crotch) - BELOW_SEAM, left).length,
        "around the left leg, 2.5 cm below the crotch");
    for (const Opening& o : m_openings)
      if (std::all_of(o.rim.begin(), o.rim.end(),
                      [&](const auto& side) { return left(m_graph.panel_of(side[0])); }))
        leg_hem = std::max(leg_hem, o.length);
    add("leg_hem", leg_hem, "around the left leg's hem");
  }

  void lengths() {
    const Opening* hem = trunk_opening(false);
    double length = m_top - m_bottom;
    if (hem && !one_opening()) { // the shortest path there
      const Field distance = m_shoulder > 0 ? m_trunk.distance_from(from_rim(*hem)) : m_depth;
      if (m_shoulder > 0)
        length = distance[m_highest];
      else {
        length = 1e300;
        for (const auto& side : hem->rim)
          if (const double d = distance[side[0]]; !std::isnan(d))
            length = std::min(length, d);
      }
    }
    add("length", length,
        m_shoulder > 0 ? "from the highest point down to the hem" : "from the top down to the hem");
    double longest = 0;
    for (const SeamLine& line : upright_lines(side_seams)) {
      const bool band =
          m_shoulder <= 0 && line.first < BAND_HEIGHT && line.length > line.first + BAND_HEIGHT;
      longest = std::max(longest, line.length - (band ? line.first : 0));
    }
    add("side_seam", longest, "along the longest upright seam of the trunk, without the waistband");
  }

  /// Where a collar is sewn on; of what has none, its highest opening.
  void neck() {
    double sum = 0;
    for (int p = 0; p < std::ssize(m_roles); ++p)
      for (int q : m_graph.neighbours(p)) {
        if (region(p) != Region::NECK || region(q) != Region::TRUNK)
          continue;
        for (const auto& seam : m_graph.between(p, q))
          for (std::size_t s = 1; s < seam.size(); ++s)
            sum += 0.5 * (drawn(seam[s][0], seam[s - 1][0]) + drawn(seam[s][1], seam[s - 1][1]));
      }
    if (sum > 0)
      return add("neck", sum, "along the collar's seam");
    const Opening* o = trunk_opening(true);
    if (o && !one_opening())
      add("neck", o->length, "around the highest opening");
  }

  void sleeve() {
    double high = -1e300, seam_low = 1e300;
    std::size_t highest = 0;
    for (std::size_t v = 0; v < m_arm_height.size(); ++v)
      if (m_arm_height[v] > high) {
        high = m_arm_height[v];
        highest = v;
      }
    if (high < -1e299)
      return;
    for (int p = 0; p < std::ssize(m_roles); ++p)
      for (int q : m_graph.neighbours(p))
        if (region(p) == Region::ARM_L && region(q) == Region::TRUNK)
          for (const auto& seam : m_graph.between(p, q))
            for (const auto& s : seam)
              seam_low = std::min(seam_low, m_arm_height[s[0]]);
    const Opening* cuff = nullptr;
    double level = 1e300;
    for (const Opening& o : m_openings) {
      double sum = 0;
      for (const auto& side : o.rim)
        sum += m_arm_height[side[0]]; // NaN where the trunk takes part
      if (const double mean = sum / static_cast<double>(o.rim.size()); mean < level) {
        level = mean;
        cuff = &o;
      }
    }
    if (cuff) {
      Field start(m_arm_height.size(), UNKNOWN);
      for (const auto& side : cuff->rim)
        for (int v : side)
          start[v] = 0;
      if (const double length = m_left_arm.distance_from(start)[highest]; !std::isnan(length))
        add("sleeve", length, "from the sleeve's highest point to its hem");
    }
    if (const SewnCloth::Ring ring = m_left_arm.around(m_arm_height, seam_low - BELOW_SEAM);
        ring.whole)
      add("upper_arm", ring.length, "around, 2.5 cm below the sleeve's seam");
    if (cuff)
      add("cuff", cuff->length, "around the sleeve's hem");
  }

  const PanelMesh& m_mesh;
  const std::vector<Opening>& m_openings;
  SeamGraph m_graph;
  std::vector<PanelRole> m_roles;
  bool m_only_skirt = true;
  SewnCloth m_trunk, m_left_arm;
  Field m_arm_height, m_height, m_depth; ///< m up; m below the top
  double m_top = -1e300, m_bottom = 1e300, m_shoulder = 0, m_chest = 0;
  std::size_t m_highest = 0; ///< vertex
  std::vector<NamedMeasure> m_out;
};

} // namespace

TrunkMeasures measure_trunk(const Pattern& pattern, const PanelMesh& mesh,
                            const std::vector<Opening>& openings) {
  Measurer measurer(pattern, mesh, openings);
  return {measurer.named(), measurer.around()};
}

} // namespace sloper::pattern

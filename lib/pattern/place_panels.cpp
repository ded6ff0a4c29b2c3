#include <base/error.hpp>
#include <collision/body_collider.hpp>
#include <collision/intersections.hpp>
#include <pattern/arm_tube.hpp>
#include <pattern/body_space.hpp>
#include <pattern/folds.hpp>
#include <pattern/leg_layout.hpp>
#include <pattern/leg_roles.hpp>
#include <pattern/panel_layout.hpp>
#include <pattern/place_panels.hpp>
#include <pattern/wrap_curve.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace sloper::pattern {
namespace {

using body::Part;

constexpr double GAP = 0.015;           // m between skin and cloth at the start
constexpr double LAYER = 0.012;         // m between panels that lie over each other
constexpr double FILLET = 0.06;         // m: radius with which the front curve turns into its wings
constexpr double WING = 0.02;           // m between the wings and what they pass: arms, or each other
constexpr double SHOULDER_RAISE = 0.02; // m above the shoulders, so that the shoulder seam closes downwards
constexpr double BEYOND_WRIST = 0.03;   // m: how far over the hand a sleeve longer than the arm starts
constexpr double SLEEVE_KEEPS = 0.4;    // of the arm's length, from the shoulder: where such a sleeve is not shortened
constexpr double BELOW_CROTCH = 0.03;   // m: where trousers' crotch starts below the body's
constexpr double MOST_RISE = 1.25;      // stretch of the way from waist to crotch for that, at most
constexpr double LEG_ROW = 0.01;        // m between the rows of cloth that a leg is laid out by
constexpr int ROUNDS = 60;

/// Panels that share one cylinder.
struct Group {
  Region region;
  Side side;
  std::vector<std::size_t> panels;
  double extra = 0; ///< m added to the gap while panels are pushed free
  double wing = 0;  ///< m added to the distance of the wings, where sleeves of hanging arms are in their way
  std::string leg;  ///< of trousers: leg_l or leg_r, all around
};

class Placer {
public:
  Placer(const Pattern& pattern, const body::Body& body, PanelMesh& mesh, const Folding& folding)
      : m_pattern(pattern), m_mesh(mesh), m_folding(folding), m_space(body), m_graph(mesh), m_roles(panel_roles(pattern, mesh, m_graph)),
        m_spots(lay_out(pattern, mesh, m_graph, m_roles)), m_depth(m_roles.size(), 0), m_collider(body.skin) {
    const auto inner = [](const PanelInfo& a, const PanelInfo& b) { return a.layer < b.layer; };
    m_innermost = mesh.panels.empty() ? 0 : std::min_element(mesh.panels.begin(), mesh.panels.end(), inner)->layer;
    for (std::size_t k = 0; k < m_depth.size(); ++k) m_depth[k] = mesh.panels[k].layer - m_innermost;
    for (const PanelInfo& p : mesh.panels)
      for (int t = 0; t < p.n_triangles; ++t) m_panel_of_triangle.push_back(static_cast<int>(&p - mesh.panels.data()));
  }

  PlacementReport run() {
    make_groups();
    if (std::any_of(m_roles.begin(), m_roles.end(), [](const PanelRole& r) { return is_leg(r); })) level_trunk(m_mesh, m_graph, m_roles, m_spots);
    anchor_trunk();
    anchor_neck();
    place_all();
    PlacementReport report = push_free();
    for (std::size_t k = 0; k < m_roles.size(); ++k) m_mesh.panels[k].part = m_roles[k].part.empty() ? region_name(m_roles[k].region) : m_roles[k].part;
    measure_gaps(report);
    return report;
  }

private:
  static std::string region_name(Region r) { return r == Region::TRUNK ? "torso" : r == Region::ARM_L ? "arm_l" : r == Region::ARM_R ? "arm_r" : "neck"; }
  bool is_arm(std::size_t k) const { return m_roles[k].region == Region::ARM_L || m_roles[k].region == Region::ARM_R; }
  Vec2 uv(std::size_t panel, int vertex) const { return laid(m_mesh, m_roles[panel], m_spots[panel], vertex); }

  void make_groups() {
    for (std::size_t k = 0; k < m_roles.size(); ++k) {
      std::size_t g = 0;
      const std::string leg = is_leg(m_roles[k]) ? m_roles[k].part : "";
      while (g < m_groups.size() && (m_groups[g].region != m_roles[k].region || m_groups[g].leg != leg || (leg.empty() && m_groups[g].side != m_roles[k].side)))
        ++g;
      if (g == m_groups.size()) m_groups.push_back({m_roles[k].region, m_roles[k].side, {}, 0, 0, leg});
      m_groups[g].panels.push_back(k);
      m_group_of.push_back(g);
    }
  }

  std::array<Vec2, 2> bounds(const Group& group) const {
    std::array<Vec2, 2> all = {Vec2::Constant(1e300), Vec2::Constant(-1e300)};
    for (std::size_t k : group.panels) {
      const auto b = laid_bounds(m_mesh, m_roles[k], m_spots[k], static_cast<int>(k));
      all[0] = all[0].cwiseMin(b[0]), all[1] = all[1].cwiseMax(b[1]);
    }
    return all;
  }

  /// Whether the garment hangs on the shoulders: front and back are sewn together near their tops, or there are sleeves or a collar.
  bool hangs_on_shoulders(double top) const {
    for (std::size_t k = 0; k < m_roles.size(); ++k) {
      if (m_roles[k].region != Region::TRUNK) return true;
      if (m_roles[k].side != Side::FRONT) continue;
      for (int q : m_graph.neighbours(static_cast<int>(k))) {
        if (m_roles[static_cast<std::size_t>(q)].side != Side::BACK) continue;
        for (const auto& seam : m_graph.between(static_cast<int>(k), q)) { // a level seam at the top
          const Vec2 a = uv(k, seam.front()[0]), b = uv(k, seam.back()[0]);
          if (std::abs(a.x() - b.x()) > 1.2 * std::abs(a.y() - b.y()) && std::min(a.y(), b.y()) > top - 0.15) return true;
        }
      }
    }
    return false;
  }

  /// Height for the top of what hangs on the chest without straps; 0 for skirts and trousers. Told by the pattern's own heights
  /// (they are those of its body, of about 1.7 m), else by words.
  double strapless_height(double top) const {
    constexpr double USUAL_STATURE = 1.7, ABOVE_WAIST = 1.12; // m
    bool stated = true, named = false;
    for (std::size_t k = 0; k < m_roles.size(); ++k) {
      stated = stated && m_roles[k].dv.has_value();
      for (const char* word : {"bodice", "bust", "corset", "bandeau", "tubetop", "tube_top"})
        named = named || m_pattern.panels[k].name.find(word) != std::string::npos;
    }
    const double chest = std::min(m_space.level("chest_axilla", 0.76), top / USUAL_STATURE * m_space.stature());
    if (stated) return top > ABOVE_WAIST ? chest : 0;
    return named ? m_space.level("chest_axilla", 0.76) : 0;
  }

  void anchor_trunk() {
    double top = -1e300;
    for (const Group& g : m_groups)
      if (g.region == Region::TRUNK) top = std::max(top, bounds(g)[1].y());
    if (top < -1e299) return;
    double shift = 0;
    if (hangs_on_shoulders(top)) {
      // The highest point is the neck end of the shoulder seam: it goes to the skin's height there.
      double x = 0;
      for (const Group& g : m_groups)
        if (g.region == Region::TRUNK)
          for (std::size_t k : g.panels)
            for (int v : m_mesh.panels[k].outline)
              if (const Vec2 p = uv(k, v); p.y() > top - 0.005) x = std::max(x, std::abs(p.x()));
      shift = m_space.shoulder_height(std::clamp(x, 0.05, 0.12)) + SHOULDER_RAISE - top;
    } else if (const double chest = strapless_height(top); chest > 0) {
      shift = chest - top;
    } else {
      const auto [around, edge] = lengths_around(top);
      const double crotch = m_space.body().has_landmark("crotch") ? m_space.body().landmark("crotch").y() : 0.47 * m_space.stature();
      shift = m_space.hang_height(around, crotch + edge - legs_part(m_mesh, m_graph, m_roles, m_spots).value_or(-1e3)) - edge;
    }
    for (std::size_t k = 0; k < m_roles.size(); ++k)
      if (m_roles[k].region == Region::TRUNK) m_spots[k].offset.y() += shift;
  }

  /// Cloth around a skirt's or trousers' uppermost 15 cm, one length for every centimetre, m, and the mean height of its top edge.
  std::pair<std::vector<double>, double> lengths_around(double top) {
    // The top edge: boundary within 6 cm of the top on the way round, as far as it is level and not sewn. It may be an arc.
    double length = 0, height = 0, dip = top;
    for (std::size_t k = 0; k < m_roles.size(); ++k) {
      if (m_roles[k].region != Region::TRUNK || m_mesh.panels[k].layer != m_innermost) continue;
      const auto& outline = m_mesh.panels[k].outline;
      for (std::size_t i = 0; i < outline.size(); ++i) {
        const int a = outline[i], b = outline[(i + 1) % outline.size()];
        const Vec2 p = uv(k, a), q = uv(k, b);
        if (std::min(p.y(), q.y()) > top - 0.06 && std::abs(p.x() - q.x()) > std::abs(p.y() - q.y()) && !(sewn(a) && sewn(b)))
          length += (p - q).norm(), height += 0.5 * (p - q).norm() * (p.y() + q.y()), dip = std::min({dip, p.y(), q.y()});
      }
    }
    if (!(length > 0.1)) return {{}, top};
    const double edge = height / length;
    std::vector<double> around = {length};
    for (int row = 1; row <= 15; ++row) {
      const double line = edge - 0.01 * row;
      double widest = 0; // rows of panels are laid a little apart: look around the gap
      for (double off : {-0.012, -0.006, 0.0, 0.006, 0.012}) widest = std::max(widest, covered(line + off));
      around.push_back(line > dip - 0.002 ? std::max(length, widest) : widest);
    }
    return {around, edge};
  }

  /// How much of the level line v is covered by panels about the trunk, m.
  double covered(double v) const {
    double sum = 0;
    for (std::size_t k = 0; k < m_roles.size(); ++k)
      if (m_roles[k].region == Region::TRUNK && m_mesh.panels[k].layer == m_innermost)
        sum += pattern::covered(m_mesh, m_roles[k], m_spots[k], static_cast<int>(k), v);
    return sum;
  }

  /// Legs start as smooth tubes around the legs. Longer than to the ankles they start shortened: a hem closes around an ankle, not
  /// around a foot.
  void place_leg(const Group& group) {
    const bool left = group.leg == "leg_l";
    const auto b = bounds(group);
    const std::size_t n = static_cast<std::size_t>(std::ceil((b[1].y() - b[0].y()) / LEG_ROW)) + 2;
    const std::string ankle_name = left ? "ankle_l" : "ankle_r";
    const double end = (m_space.body().has_landmark(ankle_name) ? m_space.body().landmark(ankle_name).y() : 0.045 * m_space.stature()) + 0.025;
    std::optional<LegTube>& tube = m_tubes[left];
    if (!tube) tube.emplace(m_space, left);
    // The crotch starts a little below the body's, so that there is way between the legs for it.
    const double top = b[1].y(), from = std::min(legs_part(m_mesh, m_graph, m_roles, m_spots).value_or(top - 0.25), top - 0.05);
    const double crotch = std::min(from, std::max(tube->crotch() - BELOW_CROTCH, top - MOST_RISE * (top - from)));
    const double rise = (top - crotch) / (top - from), leg = std::clamp((crotch - end) / std::max(from - b[0].y(), 1e-6), 0.2, 1.0);
    std::vector<double> heights;
    for (std::size_t k = 0; k < n; ++k) {
      const double v = top - LEG_ROW * static_cast<double>(k);
      heights.push_back(v > from ? top - rise * (top - v) : crotch - leg * (from - v));
    }
    tube->shape(heights, leg_rows(m_mesh, m_roles, m_spots, group.panels, left, b[1].y(), LEG_ROW, n), GAP + group.extra);
    for (std::size_t k : group.panels) {
      const Side side = m_roles[k].side;
      const double sign = (left ? 1 : -1) * (side == Side::BACK ? -1 : 1);
      put(k, [&](const Vec2& p) { return tube->at(side, sign * p.x(), (b[1].y() - p.y()) / LEG_ROW, LAYER * m_depth[k]); });
    }
  }

  bool sewn(int vertex) {
    if (m_sewn.empty()) {
      m_sewn.assign(m_mesh.pattern.size(), 0);
      for (const MeshSeam& s : m_mesh.seams)
        for (std::size_t k = 0; k < s.a.size(); ++k) m_sewn[static_cast<std::size_t>(s.a[k])] = m_sewn[static_cast<std::size_t>(s.b[k])] = 1;
    }
    return m_sewn[static_cast<std::size_t>(vertex)] != 0;
  }

  void anchor_neck() {
    for (const Group& g : m_groups) {
      if (g.region != Region::NECK) continue;
      const auto b = bounds(g);
      const double neck =
          std::max(m_space.shoulder_height(0.06), m_space.body().has_landmark("neck_side_l") ? m_space.body().landmark("neck_side_l").y() : 0.0);
      for (std::size_t k : g.panels) m_spots[k].offset.y() += neck + 0.005 - b[0].y();
    }
  }

  /// z in front of which (or behind which, for backs) the wings must stay: past the arms that hang within the panels' reach.
  double wing_limit(const Group& group, const Axis& axis, const std::array<Vec2, 2>& b, const std::vector<Vec2>& hull) const {
    double low = 1e300, high = -1e300;
    for (const Vec2& p : hull) low = std::min(low, p.y()), high = std::max(high, p.y());
    // Fronts and backs share the middle plane of the hull; plane z of the back axis is turned.
    double limit = 0.5 * (low + high) + 0.5 * WING;
    const double reach = std::max(std::abs(b[0].x()), std::abs(b[1].x())) + 0.03;
    for (const Vec2& p : m_space.points(axis, {Part::ARM_L, Part::ARM_R}, b[0].y() - 0.02, b[1].y() + 0.02))
      if (std::abs(p.x()) < reach) limit = std::max(limit, p.y() + WING);
    return limit + group.wing;
  }

  void place_trunk(const Group& group) {
    const auto b = bounds(group);
    std::vector<Part> parts = {Part::TORSO};
    if (b[0].y() < m_space.level("hip", 0.5)) parts.push_back(Part::LEG_L), parts.push_back(Part::LEG_R);
    const Axis axis = m_space.trunk(group.side == Side::BACK);
    std::vector<Vec2> hull = m_space.points(axis, parts, b[0].y() - 0.02, b[1].y() + 0.02);
    if (hull.size() < 3) hull = m_space.points(axis, {Part::TORSO, Part::LEG_L, Part::LEG_R}, -1, 3);
    std::map<int, WrapCurve> curves;
    if (group.side == Side::RING) {
      double widest = 0; // panels of one height stand side by side: what overlaps in v adds up
      for (std::size_t k : group.panels) widest = std::max(widest, row_width(group, k));
      std::vector<std::size_t> around;
      for (const auto& row : rows_of(group))
        if (!place_on_cone(group, row, hull)) around.insert(around.end(), row.begin(), row.end());
      for (std::size_t k : around) {
        const int depth = m_depth[k];
        if (!curves.count(depth)) curves.emplace(depth, WrapCurve::around(hull, GAP + group.extra + LAYER * depth, widest));
        const WrapCurve& curve = curves.at(depth);
        const auto own = laid_bounds(m_mesh, m_roles[k], m_spots[k], static_cast<int>(k));
        const double center = m_roles[k].theta / (2 * M_PI) * curve.length() - 0.5 * (own[0].x() + own[1].x());
        put(k, [&](const Vec2& p) { return axis.point(curve.at(p.x() + center), p.y()); });
      }
      return;
    }
    const double wing = wing_limit(group, axis, b, hull);
    for (std::size_t k : group.panels) {
      const int depth = m_depth[k];
      if (!curves.count(depth)) {
        const double out = group.extra + LAYER * depth;
        curves.emplace(depth, WrapCurve::front_of(hull, GAP + out, wing + out, FILLET, axis.plane(Vec3(0, 0, 0)).x()));
      }
      const WrapCurve& curve = curves.at(depth);
      put(k, [&](const Vec2& p) { return axis.point(curve.at(p.x()), p.y()); });
    }
  }

  /// Angle between a panel's two sides, rad, and its width near the top, m.
  std::array<double, 2> flare(std::size_t k) const {
    const auto b = laid_bounds(m_mesh, m_roles[k], m_spots[k], static_cast<int>(k));
    double width[2] = {0, 0};
    for (int end = 0; end < 2; ++end) {
      const double line = b[1].y() - (end ? 0.85 : 0.15) * (b[1].y() - b[0].y());
      double low = 1e300, high = -1e300;
      const auto& outline = m_mesh.panels[k].outline;
      for (std::size_t i = 0; i < outline.size(); ++i) {
        const Vec2 p = uv(k, outline[i]), q = uv(k, outline[(i + 1) % outline.size()]);
        if ((p.y() <= line) == (q.y() <= line)) continue;
        const double x = p.x() + (line - p.y()) / (q.y() - p.y()) * (q.x() - p.x());
        low = std::min(low, x), high = std::max(high, x);
      }
      width[end] = high - low;
    }
    return {2 * std::atan2(0.5 * (width[1] - width[0]), 0.7 * (b[1].y() - b[0].y())), width[0]};
  }

  /// Panels of a group that upright seams lead from one to the other.
  std::vector<std::vector<std::size_t>> rows_of(const Group& group) const {
    std::vector<std::vector<std::size_t>> rows;
    std::vector<std::size_t> left = group.panels;
    while (!left.empty()) {
      std::vector<std::size_t> row = {left[0]};
      left.erase(left.begin());
      for (std::size_t i = 0; i < row.size(); ++i)
        for (std::size_t j = 0; j < left.size();)
          if (upright_seam(m_mesh, m_graph, m_roles, row[i], left[j])) row.push_back(left[j]), left.erase(left.begin() + static_cast<long>(j));
          else ++j;
      rows.push_back(std::move(row));
    }
    return rows;
  }

  /// Gores that widen downwards stand on a cone: each is a sector of it, so that neighbours' sides lie along each other. Not where they
  /// differ: in where their tops are, as gores and godets do, or in how far off the tip of their cone would be.
  bool place_on_cone(const Group& group, const std::vector<std::size_t>& row, const std::vector<Vec2>& hull) {
    std::vector<std::pair<double, std::size_t>> by_theta;
    double total = 0, low_top = 1e300, high_top = -1e300, tallest = 0, near_tip = 1e300, far_tip = 0;
    for (std::size_t k : row) {
      const auto [angle, top_width] = flare(k);
      if (angle < 0.03) return false;
      total += angle;
      by_theta.push_back({m_roles[k].theta, k});
      const auto b = laid_bounds(m_mesh, m_roles[k], m_spots[k], static_cast<int>(k));
      const double tip = 0.5 * top_width / std::tan(0.5 * angle);
      low_top = std::min(low_top, b[1].y()), high_top = std::max(high_top, b[1].y()), tallest = std::max(tallest, b[1].y() - b[0].y());
      near_tip = std::min(near_tip, tip), far_tip = std::max(far_tip, tip);
    }
    if (row.size() < 3 || total < 0.3 || total > 5.5 || high_top - low_top > 0.25 * tallest || far_tip > 2 * near_tip) return false;
    std::sort(by_theta.begin(), by_theta.end());
    const double slope = std::asin(total / (2 * M_PI)); // half the cone's opening angle
    const Vec2 center = 0.5 * (Vec2(plane_low(hull), hull_end(hull, -1)) + Vec2(plane_high(hull), hull_end(hull, 1)));
    double theta = by_theta[0].first - 0.5 * flare(by_theta[0].second)[0] / std::sin(slope);
    for (auto& [hint, k] : by_theta) {
      const auto [angle, top_width] = flare(k);
      const auto b = laid_bounds(m_mesh, m_roles[k], m_spots[k], static_cast<int>(k));
      const double middle = theta + 0.5 * angle / std::sin(slope), u0 = 0.5 * (b[0].x() + b[1].x());
      theta += angle / std::sin(slope);
      const double top = b[1].y(), apex = top - 0.15 * (top - b[0].y()) + 0.5 * top_width / std::tan(0.5 * angle);
      const double out = GAP + group.extra + LAYER * m_depth[k];
      const Vec2 push(std::sin(middle) * out, std::cos(middle) * out); // each gore as a whole, so that it keeps its shape
      put(k, [&](const Vec2& p) {
        const Vec2 d(p.x() - u0, apex - p.y());
        const double rho = d.norm(), t = middle + std::atan2(d.x(), d.y()) / std::sin(slope), r = rho * std::sin(slope);
        const double y = top - (rho - (apex - top)) * std::cos(slope);
        return Vec3(center.x() + r * std::sin(t) + push.x(), y, center.y() + r * std::cos(t) + push.y());
      });
    }
    return true;
  }

  static double hull_end(const std::vector<Vec2>& hull, double sense) {
    double z = -1e300;
    for (const Vec2& p : hull) z = std::max(z, sense * p.y());
    return sense * z;
  }

  void place_arm(const Group& group) {
    const bool left = group.region == Region::ARM_L;
    double low = 1e300, high = -1e300;
    for (const Group& g : m_groups) // front, back and ring of one arm share one axis and one hull
      if (g.region == group.region) low = std::min(low, bounds(g)[0].y()), high = std::max(high, bounds(g)[1].y());
    const Axis axis = m_space.arm(left, group.side == Side::FRONT ? 0 : group.side == Side::BACK ? 1 : 2, high - low);
    const double shift = m_arm_shift[left] - high;
    std::vector<Vec2> hull = m_space.points(axis, {left ? Part::ARM_L : Part::ARM_R}, low + shift - 0.02, high + shift + 0.02);
    if (hull.size() < 3) hull = m_space.points(axis, {left ? Part::ARM_L : Part::ARM_R}, -3, 3);
    if (hull.size() < 3)
      throw input_error("", "body", std::string("the ") + (left ? "left" : "right") + " arm has no skin", "scan the arms, or leave the sleeves out");
    const auto b = bounds(group);
    // A sleeve longer than the arm starts shortened: its end closes around the wrist, not around a hand.
    const double end = arm_end(axis, left), from = SLEEVE_KEEPS * end, bottom = low + shift;
    const double share = bottom < end ? (end - from) / (bottom - from) : 1;
    const auto along = [&](double v) { return v + shift < from ? from + share * (v + shift - from) : v + shift; };
    if (group.side == Side::RING) {
      ArmTube tube(m_space, axis, left, along(b[0].y()), along(b[1].y()));
      std::vector<double> widths(tube.n_rows(), 0);
      for (std::size_t row = 0; row < widths.size(); ++row) {
        const double v = tube.height(row) < from ? from + (tube.height(row) - from) / share : tube.height(row);
        for (std::size_t k : group.panels)
          widths[row] = std::max(widths[row], pattern::covered(m_mesh, m_roles[k], m_spots[k], static_cast<int>(k), v - shift));
      }
      tube.shape(widths, GAP + group.extra);
      for (std::size_t k : group.panels) {
        const auto own = laid_bounds(m_mesh, m_roles[k], m_spots[k], static_cast<int>(k));
        const double center = -0.5 * (own[0].x() + own[1].x());
        put(k, [&](const Vec2& p) { return axis.point(tube.at(p.x() + center, along(p.y())), along(p.y())); });
      }
      return;
    }
    double back = 1e300, front = -1e300;
    for (const Vec2& p : hull) back = std::min(back, p.y()), front = std::max(front, p.y());
    const WrapCurve curve =
        WrapCurve::front_of(hull, GAP + group.extra, 0.5 * (back + front) + 0.5 * WING + group.extra, 0.04, 0.5 * (plane_low(hull) + plane_high(hull)));
    for (std::size_t k : group.panels) put(k, [&](const Vec2& p) { return axis.point(curve.at(p.x()), along(p.y())); });
  }

  /// Height along the arm's axis at which a long sleeve may end: a little beyond the wrist.
  double arm_end(const Axis& axis, bool left) const {
    const std::string side = left ? "_l" : "_r";
    if (m_space.body().has_landmark("wrist" + side)) return axis.height(m_space.body().landmark("wrist" + side)) - BEYOND_WRIST;
    if (m_space.body().has_landmark("hand_tip" + side)) return 0.8 * axis.height(m_space.body().landmark("hand_tip" + side));
    return -0.32 * m_space.stature();
  }

  static double plane_low(const std::vector<Vec2>& hull) {
    double x = 1e300;
    for (const Vec2& p : hull) x = std::min(x, p.x());
    return x;
  }
  static double plane_high(const std::vector<Vec2>& hull) {
    double x = -1e300;
    for (const Vec2& p : hull) x = std::max(x, p.x());
    return x;
  }

  /// Sum of the widths of the panels of a group that stand beside panel k, itself among them, with a little room between.
  double row_width(const Group& group, std::size_t k) const {
    const auto own = laid_bounds(m_mesh, m_roles[k], m_spots[k], static_cast<int>(k));
    double sum = 0;
    for (std::size_t o : group.panels) {
      const auto other = laid_bounds(m_mesh, m_roles[o], m_spots[o], static_cast<int>(o));
      if (o == k || std::min(own[1].y(), other[1].y()) - std::max(own[0].y(), other[0].y()) > 0.02) sum += other[1].x() - other[0].x() + 0.01;
    }
    return sum;
  }

  void place_neck(const Group& group) {
    const auto b = bounds(group);
    const Axis axis = m_space.neck();
    const double top = b[1].y() - b[0].y() > 0.15 ? b[1].y() : b[0].y() + 0.04; // a hood has to clear the head, a collar the neck
    std::vector<Vec2> hull = m_space.points(axis, {Part::HEAD, Part::TORSO}, b[0].y(), top);
    if (hull.size() < 3) hull = m_space.points(axis, {Part::HEAD}, -1, 3);
    double widest = 0;
    for (std::size_t k : group.panels) widest = std::max(widest, row_width(group, k));
    for (std::size_t k : group.panels) {
      const auto own = laid_bounds(m_mesh, m_roles[k], m_spots[k], static_cast<int>(k));
      const WrapCurve curve = WrapCurve::around(hull, 0.008 + group.extra + LAYER * m_depth[k], widest + 0.01);
      const double center = m_roles[k].theta / (2 * M_PI) * curve.length() - 0.5 * (own[0].x() + own[1].x());
      put(k, [&](const Vec2& p) { return axis.point(curve.at(p.x() + center), p.y()); });
    }
  }

  template<class Point> void put(std::size_t panel, Point point) {
    const PanelInfo& info = m_mesh.panels[panel];
    for (int v = info.first_vertex; v < info.first_vertex + info.n_vertices; ++v) {
      const Vec2 p = uv(panel, v);
      Vec3& at = m_mesh.placed[static_cast<std::size_t>(v)];
      at = point(p);
      if (m_folding.depth.empty() || m_folding.depth[static_cast<std::size_t>(v)] == 0) continue;
      constexpr double STEP = 1e-4; // m: u is right and v up, seen from outside
      const Vec3 outwards = (point(Vec2(p + Vec2(STEP, 0))) - at).cross(point(Vec2(p + Vec2(0, STEP))) - at);
      if (outwards.norm() > 0) at -= m_folding.depth[static_cast<std::size_t>(v)] * outwards.normalized();
    }
  }

  void place_group(const Group& g) {
    if (!g.leg.empty()) place_leg(g);
    else if (g.region == Region::TRUNK) place_trunk(g);
    else if (g.region == Region::NECK) place_neck(g);
    else place_arm(g);
  }
  void place_all() {
    for (const Group& g : m_groups) place_group(g);
  }

  std::map<std::pair<int, int>, int> crossings() const {
    const collision::TriangleTree tree(m_mesh.placed, m_mesh.triangles);
    std::map<std::pair<int, int>, int> count;
    for (const auto& pair : collision::self_intersections(m_mesh.placed, m_mesh.triangles, tree)) {
      const int p = m_panel_of_triangle[static_cast<std::size_t>(pair[0])], q = m_panel_of_triangle[static_cast<std::size_t>(pair[1])];
      ++count[{std::min(p, q), std::max(p, q)}];
    }
    return count;
  }

  /// Pushes what crosses apart, arms outwards along their axis, collars up, the smaller of two panels of one side outwards, and
  /// grows the gap of groups that meet the body.
  PlacementReport push_free() {
    PlacementReport report;
    for (int round = 0; round < ROUNDS; ++round) {
      bool changed = false;
      report.crossings = report.vertices_inside = report.faces_through = 0;
      std::set<int> moved_arms;
      std::set<std::size_t> grow, widen;
      bool raise_neck = false;
      for (const auto& [pair, n] : crossings()) {
        report.crossings += n;
        const std::size_t p = static_cast<std::size_t>(pair.first), q = static_cast<std::size_t>(pair.second);
        if (m_roles[p].region == Region::NECK || m_roles[q].region == Region::NECK) {
          if (m_roles[p].region == m_roles[q].region) {
            if (p != q) ++m_depth[area(p) > area(q) ? q : p], changed = true;
          } else raise_neck = true;
        } else if (is_arm(p) != is_arm(q)) {
          // Out along the arm first; a hanging arm never leaves the wings of a wide skirt that way, so then they make room.
          const bool left = m_roles[is_arm(p) ? p : q].region == Region::ARM_L;
          Group& trunk = m_groups[m_group_of[is_arm(p) ? q : p]];
          if (m_arm_shift[left] > -0.2 || trunk.side == Side::RING || trunk.wing > 0.2) moved_arms.insert(left);
          else widen.insert(m_group_of[is_arm(p) ? q : p]);
        } else if (is_arm(p)) {
          if (m_group_of[p] != m_group_of[q]) grow.insert(m_group_of[p]), grow.insert(m_group_of[q]);
          else grow.insert(m_group_of[p]);
        } else if (m_group_of[p] == m_group_of[q] && p != q && m_roles[p].side == m_roles[q].side) {
          if (m_depth[p] == m_depth[q]) ++m_depth[area(p) > area(q) ? q : p], changed = true;
          else ++m_depth[m_depth[p] > m_depth[q] ? p : q], changed = true;
        } else grow.insert(m_group_of[p]), grow.insert(m_group_of[q]);
      }
      for (int left : moved_arms)
        if (m_arm_shift[left] > -0.4) m_arm_shift[left] -= 0.01, changed = true;
      for (std::size_t g : widen) m_groups[g].wing += 0.01, changed = true;
      if (raise_neck && m_raised < 0.15) {
        m_raised += 0.01, changed = true;
        for (std::size_t k = 0; k < m_roles.size(); ++k)
          if (m_roles[k].region == Region::NECK) m_spots[k].offset.y() += 0.01;
      }
      for (std::size_t g = 0; g < m_groups.size(); ++g) {
        int inside = 0;
        std::vector<Triangle> triangles;
        for (std::size_t k : m_groups[g].panels) {
          const PanelInfo& info = m_mesh.panels[k];
          for (int v = info.first_vertex; v < info.first_vertex + info.n_vertices; ++v)
            inside += m_collider.is_inside(m_mesh.placed[static_cast<std::size_t>(v)]);
          triangles.insert(triangles.end(), m_mesh.triangles.begin() + info.first_triangle, m_mesh.triangles.begin() + info.first_triangle + info.n_triangles);
        }
        const int through = static_cast<int>(m_collider.faces_through(m_mesh.placed, triangles).size());
        report.vertices_inside += inside, report.faces_through += through;
        if (inside + through > 0) grow.insert(g);
      }
      for (std::size_t g : grow)
        if (m_groups[g].extra < 0.25) m_groups[g].extra += 0.005, changed = true;
      if (!changed) break;
      place_all();
    }
    if (report.crossings)
      for (const auto& [pair, n] : crossings())
        m_mesh.findings.push_back("start: " + m_mesh.panels[static_cast<std::size_t>(pair.first)].name + " and " +
                                  m_mesh.panels[static_cast<std::size_t>(pair.second)].name + " cross in " + std::to_string(n) + " pairs of triangles");
    if (report.vertices_inside + report.faces_through)
      m_mesh.findings.push_back("start: " + std::to_string(report.vertices_inside) + " vertices inside the body, " + std::to_string(report.faces_through) +
                                " faces through its skin");
    return report;
  }

  double area(std::size_t k) const { return static_cast<double>(m_mesh.panels[k].n_triangles); }

  void measure_gaps(PlacementReport& report) const {
    double sum = 0;
    int n = 0;
    for (const MeshSeam& s : m_mesh.seams)
      for (std::size_t k = 0; k < s.a.size(); ++k) {
        const double gap = (m_mesh.placed[static_cast<std::size_t>(s.a[k])] - m_mesh.placed[static_cast<std::size_t>(s.b[k])]).norm();
        sum += gap, ++n;
        report.seam_gap_max = std::max(report.seam_gap_max, gap);
      }
    report.seam_gap_mean = n ? sum / n : 0;
  }

  const Pattern& m_pattern;
  PanelMesh& m_mesh;
  const Folding& m_folding;
  BodySpace m_space;
  SeamGraph m_graph;
  std::vector<PanelRole> m_roles;
  std::vector<PanelSpot> m_spots;
  std::vector<int> m_depth; ///< how many layers lie beneath: of the pattern, and of panels that would cross
  collision::BodyCollider m_collider;
  std::vector<Group> m_groups;
  std::vector<std::size_t> m_group_of;
  std::vector<int> m_panel_of_triangle;
  std::vector<char> m_sewn;
  double m_arm_shift[2] = {0.0, 0.0}; ///< m along the arm; right, left
  double m_raised = 0;
  int m_innermost = 0;               ///< layer
  std::optional<LegTube> m_tubes[2]; ///< right, left
};

} // namespace

PlacementReport place_panels(const Pattern& pattern, const body::Body& body, PanelMesh& mesh) {
  // Pleats are laid before the panels are: their cloth is where it will be sewn.
  const Folding folding = fold_panels(pattern, mesh);
  if (folding.shift.empty()) return Placer(pattern, body, mesh, folding).run();
  const std::vector<Vec2> flat = mesh.pattern;
  for (std::size_t v = 0; v < flat.size(); ++v) mesh.pattern[v] += folding.shift[v];
  const PlacementReport report = Placer(pattern, body, mesh, folding).run();
  mesh.pattern = flat;
  return report;
}

void lay_flat(const Pattern& pattern, PanelMesh& mesh) {
  const bool stated = std::all_of(pattern.panels.begin(), pattern.panels.end(), [](const Panel& p) { return p.hint.rigid.has_value(); });
  if (stated) return;
  double x = 0;
  for (const PanelInfo& info : mesh.panels) {
    Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
    for (int v : info.outline) low = low.cwiseMin(mesh.pattern[static_cast<std::size_t>(v)]), high = high.cwiseMax(mesh.pattern[static_cast<std::size_t>(v)]);
    for (int v = info.first_vertex; v < info.first_vertex + info.n_vertices; ++v) {
      const Vec2 p = mesh.pattern[static_cast<std::size_t>(v)] - low;
      mesh.placed[static_cast<std::size_t>(v)] = Vec3(x + p.x(), p.y(), 0);
    }
    x += high.x() - low.x() + 0.05;
  }
  mesh.findings.push_back("no body is given: the panels lie flat side by side");
}

} // namespace sloper::pattern

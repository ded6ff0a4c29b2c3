#include <pattern/layout/leg_layout.hpp>
#include <pattern/place/placer.hpp>
#include <pattern/surfaces/arm_tube.hpp>
#include <sloper/base/error.hpp>
#include <sloper/base/units.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::pattern {

using body::Part;

constexpr double GAP = 0.015;   // m between skin and cloth at the start
constexpr double LAYER = 0.012; // m between panels that lie over each other
constexpr double FILLET = 0.06; // m: radius with which the front curve turns into its wings
constexpr double WING = 0.02;   // m between the wings and what they pass: arms, or each other
constexpr double BEYOND_WRIST =
    0.03; // m: how far over the hand a sleeve longer than the arm starts
constexpr double SLEEVE_KEEPS =
    0.4; // of the arm's length, from the shoulder: where such a sleeve is not shortened
constexpr double BELOW_CROTCH = 0.03; // m: where trousers' crotch starts below the body's
constexpr double MOST_RISE = 1.25;    // stretch from waist to crotch for that, at most
constexpr double LEG_ROW = 0.01;      // m between the rows of cloth that a leg is laid out by
constexpr double ARM_ROW = 0.02; // m between the rows in which arms are looked at beside a trunk
constexpr double BELOW_PIT =
    0.04; // m below the arm pits until cloth beside arms has come into its folds
constexpr double FOLD_LENGTH = 0.08; // m of such a fold
constexpr double MOST_FOLDED = 2.5;  // length of cloth on a length of the path, at most

static double hull_end(const std::vector<Vec2>& hull, double sense) {
  double z = -1e300;
  for (const Vec2& p : hull)
    z = std::max(z, sense * p.y());
  return sense * z;
}

static double plane_low(const std::vector<Vec2>& hull) {
  double x = 1e300;
  for (const Vec2& p : hull)
    x = std::min(x, p.x());
  return x;
}

static double plane_high(const std::vector<Vec2>& hull) {
  double x = -1e300;
  for (const Vec2& p : hull)
    x = std::max(x, p.x());
  return x;
}

template<class Point> void Placer::put(std::size_t panel, Point point) {
  const PanelInfo& info = m_mesh.panels[panel];
  for (int v = info.first_vertex; v < info.first_vertex + info.n_vertices; ++v) {
    const Vec2 p = uv(panel, v);
    Vec3& at = m_mesh.placed[v];
    at = point(p);
    if (m_folding.depth.empty() || m_folding.depth[v] == 0)
      continue;
    constexpr double STEP = 1e-4; // m: u is right and v up, seen from outside
    const Vec3 outwards =
        (point(Vec2(p + Vec2(STEP, 0))) - at).cross(point(Vec2(p + Vec2(0, STEP))) - at);
    if (outwards.norm() > 0)
      at -= m_folding.depth[v] * outwards.normalized();
  }
}

double Placer::row_width(const PanelGroup& group, std::size_t k) const {
  const auto own = laid_bounds(m_mesh, m_roles[k], m_spots[k], static_cast<int>(k));
  double sum = 0;
  for (std::size_t o : group.panels) {
    const auto other = laid_bounds(m_mesh, m_roles[o], m_spots[o], static_cast<int>(o));
    if (o == k || std::min(own[1].y(), other[1].y()) - std::max(own[0].y(), other[0].y()) > 0.02)
      sum += other[1].x() - other[0].x() + 0.01;
  }
  return sum;
}

double Placer::wing_limit(const PanelGroup& group, const Axis& axis, const std::array<Vec2, 2>& b,
                          const std::vector<Vec2>& hull) const {
  double low = 1e300, high = -1e300;
  for (const Vec2& p : hull) {
    low = std::min(low, p.y());
    high = std::max(high, p.y());
  }
  // Fronts and backs share the middle plane of the hull; plane z of the back axis is turned.
  double limit = 0.5 * (low + high) + 0.5 * WING;
  const double reach = std::max(std::abs(b[0].x()), std::abs(b[1].x())) + 0.03;
  for (const Vec2& p :
       m_space.points(axis, {Part::ARM_L, Part::ARM_R}, b[0].y() - 0.02, b[1].y() + 0.02))
    if (std::abs(p.x()) < reach)
      limit = std::max(limit, p.y() + WING);
  return limit + group.wing;
}

/// m for which a wave of slope m cos t is `ratio` times as long as the line that it is on.
static double wave_slope(double ratio) {
  double low = 0, high = 2 * ratio;
  for (int halving = 0; halving < 30; ++halving) {
    const double m = 0.5 * (low + high);
    double length = 0;
    for (int i = 0; i < 16; ++i)
      length += std::sqrt(1 + std::pow(m * std::cos((i + 0.5) * units::PI / 32), 2)) / 16;
    (length < ratio ? low : high) = m;
  }
  return low;
}

/// A point of cloth that is `ratio` times as long as the curve it lies on, in folds to its outside;
/// u along the cloth.
static Vec2 in_folds(const WrapCurve& curve, double u, double ratio) {
  constexpr double STEP = 1e-3, WAVES = 2 * units::PI / FOLD_LENGTH; // m; rad/m
  const double s = u / ratio;
  const Vec2 along = (curve.at(s + STEP) - curve.at(s - STEP)).normalized();
  return curve.at(s) +
         wave_slope(ratio) / WAVES * (1 - std::cos(WAVES * s)) * Vec2(-along.y(), along.x());
}

void Placer::place_in_folds(const PanelGroup& group, std::size_t k, const Sector& sector,
                            const Axis& axis, const std::vector<Vec2>& hull) {
  constexpr double FOLDS = 12; // around the body
  const Vec2 low(plane_low(hull), hull_end(hull, -1)), high(plane_high(hull), hull_end(hull, 1)),
      center = 0.5 * (low + high);
  const Vec2 half = 0.5 * (high - low) + Vec2::Constant(GAP + group.extra + LAYER * m_depth[k]);
  m_mesh.panels[k].in_folds = false;
  put(k, [&](const Vec2& p) {
    const Vec2 d = p - sector.tip;
    const double rho = d.norm(), phi = std::atan2(d.x(), -d.y()), down = rho - sector.inner,
                 out = Sector::SLOPE * std::max(down, 0.0);
    const double radius = half.mean() + out, ratio = sector.spread * rho / (units::PI * radius);
    const double t = ratio > 1 ? phi * units::PI / sector.spread : phi * rho / radius;
    const double fold =
        ratio > 1 ? wave_slope(ratio) * radius / FOLDS * (1 - std::cos(FOLDS * t)) : 0;
    m_mesh.panels[k].in_folds = m_mesh.panels[k].in_folds || ratio > 1;
    const Vec2 plane =
        center + (half + Vec2::Constant(out + fold)).cwiseProduct(Vec2(std::sin(t), std::cos(t)));
    return axis.point(plane, sector.height(down));
  });
}

double Placer::folded_beside_arm(const PanelGroup& group, const Axis& axis, const WrapCurve& curve,
                                 double sign) const {
  const Part arm = sign * axis.right().x() > 0 ? Part::ARM_L : Part::ARM_R;
  const auto b = bounds(group);
  double most = 1;
  for (double y = m_space.level("chest_axilla", 0.76) - BELOW_PIT; y > b[0].y(); y -= ARM_ROW) {
    double inner = 1e300, outer = -1e300;
    for (const Vec2& p : m_space.points(axis, {arm}, y - 0.5 * ARM_ROW, y + 0.5 * ARM_ROW)) {
      inner = std::min(inner, sign * p.x());
      outer = std::max(outer, sign * p.x());
    }
    if (inner > outer)
      continue;
    double edge = 0; // of the cloth in this row, m from its middle
    for (std::size_t k : group.panels) {
      if (m_roles[k].part == "lower_body")
        continue;
      const std::vector<int>& outline = m_mesh.panels[k].outline;
      for (std::size_t i = 0; i < outline.size(); ++i) {
        const Vec2 p = uv(k, outline[i]), q = uv(k, outline[(i + 1) % outline.size()]);
        if ((p.y() <= y) != (q.y() <= y))
          edge = std::max(edge, sign * (p.x() + (y - p.y()) / (q.y() - p.y()) * (q.x() - p.x())));
      }
    }
    if (edge <= 0 || sign * curve.at(sign * edge).x() < 0.5 * (inner + outer))
      continue;
    double room = edge;
    while (room > edge / MOST_FOLDED && sign * curve.at(sign * room).x() > inner)
      room -= 0.002;
    most = std::max(most, edge / room);
  }
  return most;
}

void Placer::place_trunk(const PanelGroup& all) {
  PanelGroup group = all;
  group.panels.erase(std::remove_if(group.panels.begin(), group.panels.end(),
                                    [&](std::size_t k) { return m_in_ring[k] != 0; }),
                     group.panels.end());
  if (group.panels.empty())
    return;
  const auto b = bounds(group);
  std::vector<Part> parts = {Part::TORSO};
  if (b[0].y() < m_space.level("hip", 0.5)) {
    parts.push_back(Part::LEG_L);
    parts.push_back(Part::LEG_R);
  }
  const Axis axis = m_space.trunk(group.side == Side::BACK);
  std::vector<Vec2> hull = m_space.points(axis, parts, b[0].y() - 0.02, b[1].y() + 0.02);
  if (hull.size() < 3)
    hull = m_space.points(axis, {Part::TORSO, Part::LEG_L, Part::LEG_R}, -1, 3);
  std::map<int, WrapCurve> curves;
  if (group.side == Side::RING) {
    double widest = 0; // panels of one height stand side by side: what overlaps in v adds up
    for (std::size_t k : group.panels)
      widest = std::max(widest, row_width(group, k));
    for (std::size_t k : group.panels) {
      const int depth = m_depth[k];
      if (!curves.count(depth))
        curves.emplace(depth, WrapCurve::around(hull, GAP + group.extra + LAYER * depth, widest));
      const WrapCurve& curve = curves.at(depth);
      const auto own = laid_bounds(m_mesh, m_roles[k], m_spots[k], static_cast<int>(k));
      const double center =
          m_roles[k].theta / (2 * units::PI) * curve.length() - 0.5 * (own[0].x() + own[1].x());
      put(k, [&](const Vec2& p) { return axis.point(curve.at(p.x() + center), p.y()); });
    }
    return;
  }
  const double wing = wing_limit(group, axis, b, hull), pit = m_space.level("chest_axilla", 0.76);
  std::map<int, std::array<double, 2>>
      folded; // by depth: on the sides of negative and of positive x
  for (std::size_t k : group.panels) {
    const int depth = m_depth[k];
    if (!curves.count(depth)) {
      const double out = group.extra + LAYER * depth;
      const WrapCurve& curve =
          curves
              .emplace(depth, WrapCurve::front_of(hull, GAP + out, wing + out, FILLET,
                                                  axis.plane(Vec3(0, 0, 0)).x()))
              .first->second;
      folded[depth] = {folded_beside_arm(group, axis, curve, -1),
                       folded_beside_arm(group, axis, curve, 1)};
    }
    if (const auto sector = sector_of(k)) {
      place_in_folds(group, k, *sector, axis, hull);
      continue;
    }
    const WrapCurve& curve = curves.at(depth);
    const std::vector<SleeveBend> bends = sleeve_bends(group, axis, curve);
    const bool beside_arms = bends.empty() && m_roles[k].part != "lower_body";
    put(k, [&](const Vec2& p) {
      Vec2 q = p;
      for (const SleeveBend& bend : bends)
        q = bend.at(q);
      const double t = std::clamp((pit - q.y()) / BELOW_PIT, 0.0, 1.0),
                   ratio = 1 + t * t * (3 - 2 * t) * (folded[depth][q.x() > 0] - 1);
      return axis.point(beside_arms && ratio > 1 ? in_folds(curve, q.x(), ratio) : curve.at(q.x()),
                        q.y());
    });
  }
}

std::vector<SleeveBend> Placer::sleeve_bends(const PanelGroup& group, const Axis& axis,
                                             const WrapCurve& curve) const {
  std::vector<SleeveBend> out;
  std::vector<std::vector<Vec2>> outlines;
  for (std::size_t k : group.panels) {
    if (m_roles[k].part == "lower_body")
      continue;
    outlines.emplace_back();
    for (int v : m_mesh.panels[k].outline)
      outlines.back().push_back(uv(k, v));
  }
  const double reach = std::max(std::abs(bounds(group)[0].x()), std::abs(bounds(group)[1].x()));
  for (const double sign : {1.0, -1.0}) {
    const bool left = sign * axis.right().x() > 0;
    if (!m_space.has_arm(left))
      continue;
    const Axis arm =
        m_space.arm(left, 0, reach - std::abs(axis.plane(m_space.arm(left, 0, 0).origin).x()));
    const double out_to = sign * axis.plane(arm.origin).x();
    double u = 0; // along the cloth to above the joint
    while (u < reach && sign * curve.at(sign * u).x() < out_to)
      u += 0.002;
    const Vec3 along = -arm.up;
    const auto bend = SleeveBend::find(outlines, sign, Vec2(sign * u, arm.origin.y()),
                                       std::atan2(along.y(), std::abs(along.x())));
    if (bend)
      out.push_back(*bend);
  }
  return out;
}

void Placer::place_gores(std::size_t index) {
  constexpr double INTO_SKIRT = 0.15; // m below the waist over which a dress goes over to the tube
  const GoreRow& ring = m_rings[index];
  GoreTube& tube = m_ring_tubes[index];
  double extra = 0;
  for (const Gore& g : ring.gores)
    extra = std::max(extra, m_groups[m_group_of[g.panel]].extra);
  // What is on the chest has shoulders or armholes: there is no way all around.
  const double waist = m_space.level("waist_semantic", 0.63);
  const bool dress = ring.top > m_space.level("chest_axilla", 0.76) + 0.02;
  tube.shape(GAP + extra, dress ? waist : 1e300);
  for (const Gore& gore : ring.gores)
    m_mesh.panels[gore.panel].in_folds = tube.in_folds();
  for (const Side side : {Side::FRONT, Side::BACK, Side::RING}) {
    std::map<int, WrapCurve> curves;
    const Axis axis = m_space.trunk(side == Side::BACK);
    const bool wings = dress && side != Side::RING;
    double wing = 0;
    std::vector<Vec2> hull;
    if (wings) {
      const double reach = tube.reach(side, waist);
      const std::array<Vec2, 2> b = {Vec2(-reach, waist - INTO_SKIRT), Vec2(reach, ring.top)};
      hull = m_space.points(axis, {Part::TORSO, Part::LEG_L, Part::LEG_R},
                            std::min(b[0].y(), m_space.level("hip", 0.5)) - 0.02, b[1].y() + 0.02);
      if (hull.size() < 3)
        hull = m_space.points(axis, {Part::TORSO, Part::LEG_L, Part::LEG_R}, -1, 3);
      for (const PanelGroup& group : m_groups)
        if (group.region == Region::TRUNK && group.leg.empty() && group.side == side)
          wing = wing_limit(group, axis, b, hull);
    }
    for (std::size_t k = 0; k < ring.gores.size(); ++k) {
      const Gore& gore = ring.gores[k];
      if (gore.side != side)
        continue;
      const double out = LAYER * m_depth[gore.panel];
      if (wings && !curves.count(m_depth[gore.panel]))
        curves.emplace(m_depth[gore.panel],
                       WrapCurve::front_of(hull, GAP + extra + out, wing + extra + out, FILLET,
                                           axis.plane(Vec3(0, 0, 0)).x()));
      put(gore.panel, [&](const Vec2& p) {
        const Gore::Place place = gore.at(p);
        const Vec3 low = tube.at(k, place, out);
        if (!wings)
          return low;
        const double t = std::clamp((waist - place.row) / INTO_SKIRT, 0.0, 1.0),
                     share = t * t * (3 - 2 * t);
        return Vec3(
            share * low +
            (1 - share) *
                axis.point(curves.at(m_depth[gore.panel]).at(tube.across(k, place)), place.row));
      });
    }
  }
}

double Placer::arm_end(const Axis& axis, bool left) const {
  const std::string side = left ? "_l" : "_r";
  if (m_space.body().has_landmark("wrist" + side))
    return axis.height(m_space.body().landmark("wrist" + side)) - BEYOND_WRIST;
  if (m_space.body().has_landmark("hand_tip" + side))
    return 0.8 * axis.height(m_space.body().landmark("hand_tip" + side));
  return -0.32 * m_space.stature();
}

void Placer::place_arm(const PanelGroup& group) {
  const bool left = group.region == Region::ARM_L;
  double low = 1e300, high = -1e300;
  for (const PanelGroup& g :
       m_groups) // front, back and ring of one arm share one axis and one hull
    if (g.region == group.region) {
      low = std::min(low, bounds(g)[0].y());
      high = std::max(high, bounds(g)[1].y());
    }
  int facing = 2; // outwards
  if (group.side == Side::FRONT)
    facing = 0;
  if (group.side == Side::BACK)
    facing = 1;
  const Axis axis = m_space.arm(left, facing, high - low);
  const double shift = m_arm_shift[left] - high;
  std::vector<Vec2> hull = m_space.points(axis, {left ? Part::ARM_L : Part::ARM_R},
                                          low + shift - 0.02, high + shift + 0.02);
  if (hull.size() < 3)
    hull = m_space.points(axis, {left ? Part::ARM_L : Part::ARM_R}, -3, 3);
  if (hull.size() < 3)
    throw input_error("placement.limb-not-scanned"_id, "", "body",
                      std::string("the ") + (left ? "left" : "right") + " arm has no skin",
                      "scan the arms, or leave the sleeves out");
  const auto b = bounds(group);
  // A sleeve longer than the arm starts shortened: its end closes around the wrist, not around a
  // hand.
  const double end = arm_end(axis, left), from = SLEEVE_KEEPS * end, bottom = low + shift;
  const double share = bottom < end ? (end - from) / (bottom - from) : 1;
  const auto along = [&](double v) {
    return v + shift < from ? from + share * (v + shift - from) : v + shift;
  };
  if (group.side == Side::RING) {
    ArmTube tube(m_space, axis, left, along(b[0].y()), along(b[1].y()));
    std::vector<double> widths(tube.n_rows(), 0);
    for (std::size_t row = 0; row < widths.size(); ++row) {
      const double v =
          tube.height(row) < from ? from + (tube.height(row) - from) / share : tube.height(row);
      for (std::size_t k : group.panels)
        widths[row] = std::max(widths[row], pattern::covered(m_mesh, m_roles[k], m_spots[k],
                                                             static_cast<int>(k), v - shift));
    }
    tube.shape(widths, GAP + group.extra);
    for (std::size_t k : group.panels) {
      const auto own = laid_bounds(m_mesh, m_roles[k], m_spots[k], static_cast<int>(k));
      const double center = -0.5 * (own[0].x() + own[1].x());
      put(k, [&](const Vec2& p) {
        return axis.point(tube.at(p.x() + center, along(p.y())), along(p.y()));
      });
    }
    return;
  }
  double back = 1e300, front = -1e300;
  for (const Vec2& p : hull) {
    back = std::min(back, p.y());
    front = std::max(front, p.y());
  }
  const WrapCurve curve =
      WrapCurve::front_of(hull, GAP + group.extra, 0.5 * (back + front) + 0.5 * WING + group.extra,
                          0.04, 0.5 * (plane_low(hull) + plane_high(hull)));
  for (std::size_t k : group.panels)
    put(k, [&](const Vec2& p) { return axis.point(curve.at(p.x()), along(p.y())); });
}

void Placer::place_leg(const PanelGroup& group) {
  const bool left = group.leg == "leg_l";
  const auto b = bounds(group);
  const std::size_t n = static_cast<std::size_t>(std::ceil((b[1].y() - b[0].y()) / LEG_ROW)) + 2;
  const std::string ankle_name = left ? "ankle_l" : "ankle_r";
  const double end =
      (m_space.body().has_landmark(ankle_name) ? m_space.body().landmark(ankle_name).y()
                                               : 0.045 * m_space.stature()) +
      0.025;
  std::optional<LegTube>& tube = m_tubes[left];
  if (!tube)
    tube.emplace(m_space, left);
  // The crotch starts a little below the body's, so that there is way between the legs for it.
  const double top = b[1].y(),
               from = std::min(legs_part(m_mesh, m_graph, m_roles, m_spots).value_or(top - 0.25),
                               top - 0.05);
  const double crotch =
      std::min(from, std::max(tube->crotch() - BELOW_CROTCH, top - MOST_RISE * (top - from)));
  const double rise = (top - crotch) / (top - from),
               leg = std::clamp((crotch - end) / std::max(from - b[0].y(), 1e-6), 0.2, 1.0);
  std::vector<double> heights;
  for (std::size_t k = 0; k < n; ++k) {
    const double v = top - LEG_ROW * static_cast<double>(k);
    heights.push_back(v > from ? top - rise * (top - v) : crotch - leg * (from - v));
  }
  const LegGrid grid{
      .panels = group.panels, .left = left, .top_m = top, .step_m = LEG_ROW, .n_rows = n};
  tube->shape(heights, leg_rows(m_mesh, m_roles, m_spots, grid), GAP + group.extra);
  for (std::size_t k : group.panels) {
    const Side side = m_roles[k].side;
    const double sign = (left ? 1 : -1) * (side == Side::BACK ? -1 : 1);
    put(k, [&](const Vec2& p) {
      return tube->at(side, sign * p.x(), (b[1].y() - p.y()) / LEG_ROW, LAYER * m_depth[k]);
    });
  }
}

void Placer::place_neck(const PanelGroup& group) {
  const auto b = bounds(group);
  const Axis axis = m_space.neck();
  const double top = b[1].y() - b[0].y() > 0.15
                         ? b[1].y()
                         : b[0].y() + 0.04; // a hood has to clear the head, a collar the neck
  std::vector<Vec2> hull = m_space.points(axis, {Part::HEAD, Part::TORSO}, b[0].y(), top);
  if (hull.size() < 3)
    hull = m_space.points(axis, {Part::HEAD}, -1, 3);
  double widest = 0;
  for (std::size_t k : group.panels)
    widest = std::max(widest, row_width(group, k));
  for (std::size_t k : group.panels) {
    const auto own = laid_bounds(m_mesh, m_roles[k], m_spots[k], static_cast<int>(k));
    const WrapCurve curve = WrapCurve::around(hull, 0.008 + group.extra + LAYER * m_depth[k],
                                              widest + 0.01 + 2 * units::PI * LAYER * m_depth[k]);
    const double center =
        m_roles[k].theta / (2 * units::PI) * curve.length() - 0.5 * (own[0].x() + own[1].x());
    put(k, [&](const Vec2& p) { return axis.point(curve.at(p.x() + center), p.y()); });
  }
}

void Placer::place_group(const PanelGroup& g) {
  if (!g.leg.empty())
    place_leg(g);
  else if (g.region == Region::TRUNK)
    place_trunk(g);
  else if (g.region == Region::NECK)
    place_neck(g);
  else
    place_arm(g);
}

} // namespace sloper::pattern

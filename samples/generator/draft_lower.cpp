/// The four-panel skirt (the paper's Figure 4) and trousers, each with a waistband, drafted flat.
///
/// Skirt: a quarter of the waist above, a quarter of the hip 20 cm lower, flared to the hem at the
/// side seams, so that the middle hangs straight (flare in the middle seams sinks in between the
/// thighs and closes in knots), or by as much more as is asked for; the difference of hip and waist
/// is taken half at the side, half at the middle seam, by curves. Trousers: body rise, crotch
/// extensions of a sixteenth and an eighth of the hip (front and back), crease in the middle of the
/// crotch line, as in the classic trouser block (for one, Aldrich, Metric Pattern Cutting);
/// what the waist is narrower than the hip is taken by the middle seams, the sides and, where that
/// is much, a dart in each quarter; coefficients are our own. Metres; y = 0 is the waist.
#include "draft.hpp"
#include <algorithm>
#include <cmath>
#include <sloper/base/error.hpp>
namespace sloper::samples {
namespace {

constexpr double CROTCH_EASE =
    0.015;                          // m. Without the body's own length, drafts of 8 natural bodies
                                    // were 0 to 10 cm short of it, stretched by up to 5.9 % (p99)
constexpr double THIGH_EASE = 0.06; // m
constexpr double MOST_LENGTHENED = 6; // for a seam about 20 cm longer
constexpr double STEEPEST = 0.9;      // of a side seam's length: how far it leans out
// A side seam that comes in faster from hip to waist stands off the hip like an ear: what is more
// is taken by a dart in the middle of the quarter's waist. Chosen on two bodies; of 12 others in
// natural stances all trousers came to rest, stretched by 2.7 % (p99) at most.
constexpr double SIDE_SLOPE = 0.12;  // m aside for each metre up
constexpr double LEAST_DART = 0.008; // m wide
constexpr double MOST_DART = 0.04;   // m wide
constexpr double DART_DEPTH = 0.7;   // of the distance from waist to hip

/// The edges of a quarter that a waistband is sewn to: one, or two beside a dart.
std::vector<std::string> waist_edges(const DraftPanel& quarter) {
  const bool whole = std::any_of(quarter.edges.begin(), quarter.edges.end(),
                                 [](const DraftEdge& e) { return e.name == "waist"; });
  return whole ? std::vector<std::string>{"waist"}
               : std::vector<std::string>{"waist_outer", "waist_inner"};
}

double waist_length(const DraftPanel& quarter) {
  double length = 0;
  for (const std::string& edge : waist_edges(quarter))
    length += edge_length(quarter, edge);
  return length;
}

/// Whether an edge of a band starts at the band's middle.
bool is_from_middle(const DraftPanel& band, const std::string& edge) {
  return band.points[edge_index(band, edge)].x() == 0;
}

/// Cuts a dart into the middle of a straight waist. @param width, depth  m
void add_dart(DraftPanel& quarter, double width, double depth) {
  const int at = edge_index(quarter, "waist");
  const int n = static_cast<int>(quarter.points.size());
  const Vec2 from = quarter.points[at], to = quarter.points[(at + 1) % n];
  const Vec2 along = (to - from).normalized(), middle = 0.5 * (from + to);
  const Vec2 tip = middle + depth * Vec2(-along.y(), along.x()); // inside is to the left
  quarter.points.insert(quarter.points.begin() + at + 1, {Vec2(middle - 0.5 * width * along), tip,
                                                          Vec2(middle + 0.5 * width * along)});
  quarter.edges[at].name = "waist_outer";
  quarter.edges.insert(quarter.edges.begin() + at + 1,
                       {{"dart_outer", {}}, {"dart_inner", {}}, {"waist_inner", {}}});
}

/// A band of two strips, sewn at the sides; `front` and `back` are the finished lengths of its
/// lower edge, each cut in two at the middle.
void add_waistband(Draft& d, const Measures& m, double front, double back, double height) {
  for (const bool is_front : {true, false}) {
    const double half = 0.5 * (is_front ? front : back);
    const std::string right = is_front ? "l" : "r",
                      left = is_front ? "r" : "l"; // wearer's side at +x and -x
    DraftPanel p;
    p.name = is_front ? "band_front" : "band_back";
    p.points = {{-half, 0}, {0, 0}, {half, 0}, {half, height}, {-half, height}};
    p.edges = {{"low_" + left, {}},
               {"low_" + right, {}},
               {"end_" + right, {}},
               {"top", {}},
               {"end_" + left, {}}};
    p.placement = {"torso", is_front ? 0.0 : 180.0, m.waist_height(), Vec2(0, 0.5 * height)};
    d.add(p);
  }
  for (const char* s : {"l", "r"}) {
    const std::string side = s;
    d.sew("band_front", "end_" + side, "band_back", "end_" + side);
    for (const std::string which : {"front", "back"}) {
      if (waist_edges(d.panel(which + "_" + side)).size() == 1) {
        d.sew("band_" + which, "low_" + side, which + "_" + side, "waist");
        continue;
      }
      const DraftPanel& below = d.panel(which + "_" + side);
      const double outer = edge_length(below, "waist_outer"),
                   inner = edge_length(below, "waist_inner");
      const auto band = std::find_if(d.panels.begin(), d.panels.end(), [&](const DraftPanel& p) {
        return p.name == "band_" + which;
      });
      // The left half runs from the middle to the side, the right one from the side to the middle.
      const bool outwards = is_from_middle(*band, "low_" + side);
      const std::string low = "low_" + side;
      split_edge(*band, low, (outwards ? inner : outer) / (inner + outer),
                 low + (outwards ? "_inner" : "_outer"), low + (outwards ? "_outer" : "_inner"));
      for (const std::string part : {"_outer", "_inner"})
        d.sew("band_" + which, low + part, which + "_" + side, "waist" + part);
    }
  }
}

/// The left front and the right back, with their mirror images on the other side.
void add_quarters(Draft& d, const DraftPanel& front, const DraftPanel& back) {
  d.add(front);
  d.add(mirrored(front, "front_r", "torso"));
  d.add(back);
  DraftPanel back_l = mirrored(back, "back_l", "torso");
  back_l.placement.theta_deg = 135;
  d.add(back_l);
}

} // namespace

Draft draft_skirt(const Measures& m) {
  return draft_flared_skirt(m, 0);
}

Draft draft_flared_skirt(const Measures& m, double more_flare) {
  Draft d{"skirt", {}, {}};
  const double waist = (m.waist + 0.005) / 4, hip = (m.hip + 0.05) / 4, length = 0.34 * m.stature,
               band = 0.035;
  const double flare = 0.035 + 0.03 * length;
  // Middle seam at x = 0 from the hip down; above, both long sides lean in. The waist is an arc
  // that meets both squarely.
  const double inset = 0.5 * (hip - waist) * 0.6, y_hip = -(m.waist_to_hip - 0.5 * band);
  const double fall =
      length + y_hip; // a seam that leans out more is no longer for it: its end is higher
  if (more_flare > 0 && flare + more_flare > STEEPEST * fall)
    throw Error(ErrorKind::USAGE, "sample.flare-too-wide"_id, "", "--flare",
                "is too much for a skirt that falls " +
                    std::to_string(static_cast<int>(100 * fall)) + " cm below the hip",
                "take less");
  const auto panel = [&](const char* name, double theta) {
    DraftPanel p;
    p.name = name;
    const Vec2 hip_side(hip, y_hip), hip_middle(0, y_hip);
    const auto drop = [&](double out) { return std::sqrt(fall * fall - out * out); };
    const double higher = more_flare > 0 ? drop(flare) - drop(flare + more_flare) : 0;
    const Vec2 hem_middle(0, -length), hem_side(hip + flare + more_flare, -length + higher);
    const double x0 = inset;
    // The side is longer than the middle by the lean; the waist point at the side is raised so that
    // neighbours meet level.
    const Vec2 waist_side(x0 + waist, 0.010), waist_middle(x0, 0);
    p.points = {hem_middle, hem_side, hip_side, waist_side, waist_middle, hip_middle};
    const Vec2 up(0, -y_hip), side_up = (hip_side - hem_side).normalized(),
                              middle_up = (hip_middle - hem_middle).normalized();
    std::vector<Vec2> hem = {Vec2(hip * 0.3, -length - 0.008), Vec2(hip * 0.7, -length - 0.008)};
    if (more_flare > 0) { // it meets the seams squarely
      const double third = (hem_side - hem_middle).norm() / 3;
      hem = {hem_middle + third * Vec2(middle_up.y(), -middle_up.x()),
             hem_side - third * Vec2(side_up.y(), -side_up.x())};
    }
    p.edges = {
        {"hem", hem},
        {"side", {}},
        {"side_hip",
         {hip_side + 0.35 * up.norm() * side_up, waist_side - 0.35 * up + Vec2(0.012, 0)}},
        {"waist",
         {waist_side - Vec2(0.33 * waist, 0.006), waist_middle + Vec2(0.33 * waist, -0.002)}},
        {"middle_hip",
         {waist_middle - 0.35 * up - Vec2(0.010, 0), hip_middle + 0.35 * up.norm() * middle_up}},
        {"middle", {}}};
    p.placement = {"torso", theta, m.waist_height() - 0.5 * band, Vec2(x0 + 0.5 * waist, 0)};
    return p;
  };
  // Wearer's left front and, the other way round, left back: seen from outside the left back's
  // middle seam is at its +x.
  const DraftPanel front = panel("front_l", 45), back = panel("back_r", 225);
  add_quarters(d, front, back);
  for (const char* edge : {"side", "side_hip"}) {
    d.sew("front_l", edge, "back_l", edge);
    d.sew("front_r", edge, "back_r", edge);
  }
  for (const char* edge : {"middle", "middle_hip"}) {
    d.sew("front_l", edge, "front_r", edge);
    d.sew("back_l", edge, "back_r", edge);
  }
  const double low = edge_length(front, "waist");
  add_waistband(d, m, 2 * low, 2 * low, band);
  return d;
}

Draft draft_trousers(const Measures& m) {
  Draft d{"trousers", {}, {}};
  const double band = 0.035, rise = m.body_rise + 0.015 - 0.5 * band, leg = m.inside_leg - 0.06,
               y_hip = -(m.waist_to_hip - 0.5 * band), y_crotch = -rise;
  const double y_knee = y_crotch - 0.46 * m.inside_leg, y_hem = y_crotch - leg;
  const double waist = (m.waist + 0.02) / 4, hip = (m.hip + 0.07) / 4;
  /// How wide a dart takes up what the side seam of a leg does not.
  const auto dart_of = [&](double at_hip, double lean) {
    const double width = at_hip - lean - waist - SIDE_SLOPE * -y_hip;
    return width < LEAST_DART ? 0 : std::min(width, MOST_DART);
  };
  const double knee = 0.5 * (m.knee + 0.09), hem = 0.5 * (m.ankle + 0.17);
  struct Leg {
    double hip, extension, wide, lean; ///< quarter of the hip, crotch extension, extra width at
                                       ///< knee and hem, how far the middle seam leans in
  };
  // The back is wider, reaches further between the legs and leans more.
  Leg front_leg{hip - 0.008, m.hip / 18, -0.008, 0.012},
      back_leg{hip + 0.008, m.hip / 9, 0.008, 0.030};
  /// Left front seen from outside: the middle seam at x = 0, the side at +x. back_rise raises the
  /// waist at the middle seam.
  const auto panel = [&](const char* name, const Leg& l, double back_rise, double crotch_drop,
                         double hip_drop, double side_rise) {
    DraftPanel p;
    p.name = name;
    const Vec2 crotch(-l.extension, y_crotch - crotch_drop), hip_side(l.hip, y_hip - hip_drop),
        hip_middle(0, y_hip);
    const double crease = 0.5 * (l.hip - l.extension), half_knee = 0.5 * (knee + 2 * l.wide),
                 half_hem = 0.5 * (hem + 2 * l.wide);
    const double dart = dart_of(l.hip, l.lean);
    const Vec2 waist_middle(l.lean, back_rise), waist_side(l.lean + waist + dart, side_rise);
    const Vec2 knee_in(crease - half_knee, y_knee), knee_out(crease + half_knee, y_knee);
    const double above = y_hip - y_knee, step = y_crotch - y_knee;
    p.points = {{crease - half_hem, y_hem},
                {crease + half_hem, y_hem},
                knee_out,
                hip_side,
                waist_side,
                waist_middle,
                hip_middle,
                crotch,
                knee_in};
    p.edges = {{"hem", {}},
               {"side_low", {}},
               {"side_thigh", {knee_out + Vec2(0, 0.35 * above), hip_side - Vec2(0, 0.35 * above)}},
               {"side_hip",
                {hip_side - Vec2(0, 0.45 * y_hip),
                 waist_side + 0.33 * (hip_side - waist_side) + Vec2(0.004, 0)}},
               {"waist", {}},
               {"middle", {}},
               {"crotch",
                {hip_middle + Vec2(-0.05 * l.lean, 0.65 * (y_crotch - y_hip)),
                 crotch + Vec2(0.55 * l.extension, 0)}},
               {"inside_thigh",
                {crotch + Vec2(0.30 * l.extension, -0.30 * step), knee_in + Vec2(0, 0.35 * step)}},
               {"inside_low", {}}};
    if (dart > 0)
      add_dart(p, dart, DART_DEPTH * -y_hip);
    return p;
  };
  // The seam between the legs goes around the body with ease, and the leg around the thigh: by
  // longer extensions, a lower crotch and a higher waist in the middle, behind more than in front.
  struct Rise {
    double front = -0.008, back = 0.03, drop = 0;
  };
  const Leg short_front = front_leg, short_back = back_leg;
  Rise raised;
  const auto lengthen = [&](double by) {
    front_leg.extension = (1 + 0.10 * by) * short_front.extension;
    back_leg.extension = (1 + 0.10 * by) * short_back.extension;
    raised = {-0.008 + 0.004 * by, 0.03 + 0.008 * by, 0.005 * by};
  };
  const auto missing_length = [&](double by) {
    lengthen(by);
    double length = band - m.crotch() - CROTCH_EASE;
    for (const bool is_front : {true, false}) {
      const DraftPanel p = panel("", is_front ? front_leg : back_leg,
                                 is_front ? raised.front : raised.back, raised.drop, 0, 0.008);
      length += edge_length(p, "middle") + edge_length(p, "crotch");
    }
    return length;
  };
  const auto missing_width = [&](double by) {
    lengthen(by);
    return front_leg.hip + front_leg.extension + back_leg.hip + back_leg.extension - m.thigh -
           THIGH_EASE;
  };
  lengthen(std::max(solve(0, MOST_LENGTHENED, missing_length),
                    solve(0, MOST_LENGTHENED, missing_width)));
  DraftPanel front = panel("front_l", front_leg, raised.front, raised.drop, 0, 0.008);
  // The back is drawn so that its long seams match the front's: crotch and hip point are let down,
  // the side is raised.
  const auto off = [&](const char* edge, double crotch_drop, double hip_drop, double side_rise) {
    return edge_length(panel("back", back_leg, raised.back, crotch_drop, hip_drop, side_rise),
                       edge) -
           edge_length(front, edge);
  };
  const double drop =
      solve(-0.02, 0.10, [&](double x) { return off("inside_thigh", x, 0, 0.008); });
  const double lower =
      solve(-0.02, 0.10, [&](double x) { return off("side_thigh", drop, x, 0.008); });
  const double raise =
      solve(-0.05, 0.05, [&](double x) { return off("side_hip", drop, lower, x); });
  DraftPanel back = panel("back_r", back_leg, raised.back, drop, lower, raise);
  const double top = m.waist_height() - 0.5 * band;
  front.placement = {"torso", 45, top, Vec2(front_leg.lean + 0.5 * waist, 0)};
  back.placement = {"torso", 225, top, Vec2(back_leg.lean + 0.5 * waist, 0)};
  add_quarters(d, front, back);
  for (const char* s : {"l", "r"}) {
    const std::string side = s;
    for (const char* edge : {"side_low", "side_thigh", "side_hip", "inside_thigh", "inside_low"})
      d.sew("front_" + side, edge, "back_" + side, edge);
  }
  for (const char* edge : {"middle", "crotch"}) {
    d.sew("front_l", edge, "front_r", edge);
    d.sew("back_l", edge, "back_r", edge);
  }
  for (const std::string quarter : {"front_l", "front_r", "back_l", "back_r"})
    if (waist_edges(d.panel(quarter)).size() > 1)
      d.sew(quarter, "dart_outer", quarter, "dart_inner");
  add_waistband(d, m, 2 * waist_length(front), 2 * waist_length(back), band);
  return d;
}

} // namespace sloper::samples

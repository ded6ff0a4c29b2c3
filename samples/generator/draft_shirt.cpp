/// The shirt of the paper (two fronts, back with yoke, two sleeves, collar with stand, cuffs) and a
/// T-shirt, drafted flat.
///
/// The draft follows the usual order of flat pattern cutting (scye depth and chest width from the
/// bust girth, neck from the neck girth, shoulder line by slope, sleeve cap from the armhole's
/// length, as taught by Aldrich, Metric Pattern Cutting, and the Bunka bodice); the coefficients
/// are our own, chosen for a loose fit. Lengths in metres; the origin of a body panel is the back
/// neck point, x = 0 its centre line.
#include "draft.hpp"
#include <cmath>
#include <sloper/base/units.hpp>
namespace sloper::samples {
namespace {

constexpr double PIT_EASE = 0.07; // m, armhole below the arm pit: with 3 cm a T-shirt of the tall
                                  // is stretched there by 40 to 60 %, with 5 cm by 30, with 7 by 15

/// Lines shared by fronts, back and yoke.
struct Block {
  double neck_half;         ///< half neck width, found so that the neckline has its length
  double neck_rise = 0.022; ///< side neck point above the back neck point
  double neck_drop;         ///< front neck point below the side neck point
  Vec2 side_neck, shoulder; ///< ends of the shoulder line
  double scye;              ///< depth of the underarm line below the back neck point
  double quarter;           ///< a quarter of the finished bust girth
  double hem_half, hem;     ///< a quarter of the hem and its depth
  double waist;             ///< depth of the waist
};

std::vector<Vec2> front_neck_control(const Block& b) {
  // From the side neck point down, into the centre square to it.
  return {b.side_neck + Vec2(-0.012, -0.62 * b.neck_drop),
          Vec2(0.55 * b.neck_half, b.side_neck.y() - b.neck_drop)};
}

Block make_block(const Measures& m, double bust_ease, double length_below_waist, double neckline) {
  Block b;
  b.scye = std::max(m.bust / 8 + 0.125,       // about 24 cm at bust 92: a deep, easy armhole,
                    m.scye_depth + PIT_EASE); // below the arm pit also of the tall
  b.quarter = (m.bust + bust_ease) / 4;
  b.waist = m.back_length;
  b.hem = m.back_length + length_below_waist;
  b.hem_half = std::max((m.hip + 0.07) / 4, b.quarter - 0.005);
  const double slope = units::radians(21);
  const auto shape = [&](double half) {
    b.neck_half = half;
    b.neck_drop = half + 0.008;
    b.side_neck = Vec2(half, b.neck_rise);
    b.shoulder = b.side_neck + (m.shoulder + 0.008) * Vec2(std::cos(slope), -std::sin(slope));
  };
  const auto neck_length = [&](double half) {
    shape(half);
    DraftPanel front{"",
                     {b.side_neck, Vec2(0, b.side_neck.y() - b.neck_drop)},
                     {{"neck", front_neck_control(b)}, {"", {}}},
                     Vec2(0, 1),
                     {}};
    DraftPanel back{
        "",
        {b.side_neck, Vec2(-half, b.neck_rise)},
        {{"neck", {Vec2(0.55 * half, -b.neck_rise / 3), Vec2(-0.55 * half, -b.neck_rise / 3)}},
         {"", {}}},
        Vec2(0, 1),
        {}};
    return 2 * edge_length(front, "neck") + edge_length(back, "neck") - neckline;
  };
  shape(solve(0.04, 0.16, neck_length));
  return b;
}

/// Armhole from the underarm point up to the shoulder, hollowed by `hollow` at the chest line.
std::vector<Vec2> armhole_control(const Block& b, double hollow) {
  const double height = b.shoulder.y() + b.scye, chest = b.shoulder.x() - hollow;
  return {Vec2(chest + 0.15 * (b.quarter - chest), -b.scye),
          Vec2(chest, b.shoulder.y() - 0.55 * height)};
}

/// Side seam from the hem up to the underarm, drawn in at the waist.
std::vector<Vec2> side_control(const Block& b, double waist_in) {
  const Vec2 low(b.hem_half, -b.hem), high(b.quarter, -b.scye);
  return {low + (high - low) / 3 - Vec2(waist_in, 0),
          low + 2 * (high - low) / 3 - Vec2(waist_in, 0)};
}

double height_of(const Measures& m, double below_back_neck) {
  return m.neck_back_height - below_back_neck;
}

DraftPanel make_front(const Block& b, const Measures& m, double waist_in) {
  DraftPanel p;
  p.name = "front_l";
  p.points = {{0, -b.hem}, {b.hem_half, -b.hem}, {b.quarter, -b.scye},
              b.shoulder,  b.side_neck,          {0, b.side_neck.y() - b.neck_drop}};
  p.edges = {
      {"hem", {}},      {"side", side_control(b, waist_in)}, {"armhole", armhole_control(b, 0.026)},
      {"shoulder", {}}, {"neck", front_neck_control(b)},     {"center", {}}};
  p.placement = {"torso", 0, height_of(m, b.scye), Vec2(0, -b.scye)};
  return p;
}

/// Half a back: from the hem to the shoulder, x >= 0 (the wearer's right).
DraftPanel make_half_back(const Block& b, double waist_in) {
  DraftPanel p;
  p.name = "back";
  p.points = {{0, -b.hem}, {b.hem_half, -b.hem}, {b.quarter, -b.scye},
              b.shoulder,  b.side_neck,          {0, 0}};
  p.edges = {{"hem", {}},
             {"side", side_control(b, waist_in)},
             {"armhole", armhole_control(b, 0.012)},
             {"shoulder", {}},
             {"neck", {}},
             {"center", {}}};
  return p;
}

std::vector<Vec2> back_neck_control(const Block& b) {
  return {Vec2(0.55 * b.neck_half, -b.neck_rise / 3), Vec2(-0.55 * b.neck_half, -b.neck_rise / 3)};
}

Vec2 flip(const Vec2& p) {
  return {-p.x(), p.y()};
}
std::vector<Vec2> flip_run(const std::vector<Vec2>& c) {
  return {flip(c[1]), flip(c[0])};
}

/// Half width of a sleeve cap of height `cap` whose curve has the wanted length.
std::vector<Vec2> cap_control(double half, double base, double cap) {
  return {Vec2(0.55 * half, base), Vec2(0.45 * half, base + cap)};
}
double cap_half_width(double wanted, double base, double cap) {
  return solve(0.03, 0.45, [&](double half) {
    const DraftPanel p{"",
                       {Vec2(half, base), Vec2(0, base + cap)},
                       {{"cap", cap_control(half, base, cap)}, {"", {}}},
                       Vec2(0, 1),
                       {}};
    return edge_length(p, "cap") - wanted;
  });
}

/// A sleeve of the left arm seen from outside: the front is at x < 0. Its cap is `ease` longer than
/// the armhole it is set into.
DraftPanel make_sleeve(double front_armhole, double back_armhole, double under_length, double hem,
                       double cap, double ease) {
  const double front = cap_half_width(front_armhole * (1 + ease), under_length, cap),
               back = cap_half_width(back_armhole * (1 + ease), under_length, cap);
  const double shift = 0.5 * (front - back), low_front = 0.5 * hem + shift,
               low_back = 0.5 * hem - shift;
  DraftPanel p;
  p.name = "sleeve_l";
  p.points = {{-low_front, 0},
              {low_back, 0},
              {back, under_length},
              {0, under_length + cap},
              {-front, under_length}};
  std::vector<Vec2> front_cap = cap_control(front, under_length, cap);
  p.edges = {{"hem", {}},
             {"under_back", {}},
             {"cap_back", cap_control(back, under_length, cap)},
             {"cap_front", flip_run(front_cap)},
             {"under_front", {}}};
  p.placement = {"arm_l", 0, -1, Vec2(0, under_length + cap)};
  return p;
}

void sew_sleeve(Draft& d, const char* side, double ease) {
  const std::string s = std::string("sleeve_") + side;
  d.sew(s, "cap_front", std::string("front_") + side, "armhole", ease);
  d.sew(s, "under_front", s, "under_back");
}

} // namespace

Draft draft_shirt(const Measures& m) {
  constexpr double CAP_EASE = 0.012;
  const Block b = make_block(m, 0.10, m.waist_to_hip + 0.03, 1.14 * m.neck + 0.02);
  const double waist_in = 0.012;
  Draft d{"shirt", {}, {}};
  const DraftPanel front = make_front(b, m, waist_in);
  d.add(front);
  d.add(mirrored(front, "front_r", "torso"));

  // The yoke line cuts the back across the blades, 40 % down the armhole; the cut is found on the
  // armhole curve.
  DraftPanel half = make_half_back(b, waist_in);
  const double yoke_y = -0.35 * b.scye;
  const std::vector<Vec2> curve = edge_points(half, edge_index(half, "armhole"), 512);
  double below = 0, all = 0;
  for (std::size_t i = 1; i < curve.size(); ++i) {
    const double step = (curve[i] - curve[i - 1]).norm();
    all += step;
    if (curve[i].y() < yoke_y)
      below += step;
  }
  split_edge(half, "armhole", below / all, "armhole", "armhole_yoke");
  const int low = edge_index(half, "armhole"), high = edge_index(half, "armhole_yoke");
  const Vec2 cut = half.points[high];
  DraftPanel back;
  back.name = "back";
  back.points = {{-b.hem_half, -b.hem}, {b.hem_half, -b.hem}, {b.quarter, -b.scye}, cut, flip(cut),
                 {-b.quarter, -b.scye}};
  const std::vector<Vec2> side = side_control(b, waist_in);
  back.edges = {{"hem", {}},
                {"side_r", side},
                {"armhole_r", half.edges[low].control},
                {"yoke", {}},
                {"armhole_l", flip_run(half.edges[low].control)},
                {"side_l", flip_run(side)}};
  back.placement = {"torso", 180, height_of(m, b.scye), Vec2(0, -b.scye)};
  d.add(back);
  DraftPanel yoke;
  yoke.name = "yoke";
  yoke.points = {flip(cut), cut, b.shoulder, b.side_neck, flip(b.side_neck), flip(b.shoulder)};
  yoke.edges = {{"back", {}},       {"armhole_r", half.edges[high].control},
                {"shoulder_r", {}}, {"neck", back_neck_control(b)},
                {"shoulder_l", {}}, {"armhole_l", flip_run(half.edges[high].control)}};
  yoke.placement = {"torso", 180, height_of(m, -yoke_y), Vec2(0, yoke_y)};
  d.add(yoke);

  const double front_armhole = edge_length(front, "armhole"),
               back_armhole = edge_length(back, "armhole_r"),
               yoke_armhole = edge_length(yoke, "armhole_r");
  const double armhole = front_armhole + back_armhole + yoke_armhole, cap = 0.25 * armhole;
  const double cuff_height = 0.055, cuff = m.wrist + 0.07;
  DraftPanel sleeve = make_sleeve(front_armhole, back_armhole + yoke_armhole,
                                  m.arm_length + 0.01 - cuff_height - cap, cuff, cap, CAP_EASE);
  // The back of the cap is set into the back first, then into the yoke.
  split_edge(sleeve, "cap_back", back_armhole / (back_armhole + yoke_armhole), "cap_back",
             "cap_yoke");
  d.add(sleeve);
  d.add(mirrored(sleeve, "sleeve_r", "arm_r"));
  DraftPanel cuff_panel;
  cuff_panel.name = "cuff_l";
  cuff_panel.points = {
      {-cuff / 2, 0}, {cuff / 2, 0}, {cuff / 2, cuff_height}, {-cuff / 2, cuff_height}};
  cuff_panel.edges = {{"hem", {}}, {"end_back", {}}, {"top", {}}, {"end_front", {}}};
  cuff_panel.placement = {"arm_l", 0, -1, Vec2(0, cuff_height)};
  d.add(cuff_panel);
  d.add(mirrored(cuff_panel, "cuff_r", "arm_r"));

  // Stand: a strip of the neckline's length, a little shorter above; its middle is at the back.
  const double front_neck = edge_length(front, "neck"), back_neck = edge_length(yoke, "neck"),
               half_neck = front_neck + 0.5 * back_neck;
  const double stand_height = 0.028, half_top = half_neck - 0.006;
  DraftPanel stand;
  stand.name = "stand";
  stand.points = {{-half_neck, 0}, {-0.5 * back_neck, 0},    {0.5 * back_neck, 0},
                  {half_neck, 0},  {half_top, stand_height}, {-half_top, stand_height}};
  stand.edges = {{"neck_l", {}}, {"neck_back", {}}, {"neck_r", {}},
                 {"end_r", {}},  {"top", {}},       {"end_l", {}}};
  stand.placement = {"neck", 180, m.neck_back_height, Vec2(0, 0)};
  d.add(stand);
  // Collar: a sector of a ring, so that its free edge is longer than the edge at the stand. Cloth
  // does not turn over by its weight: the collar stands up to the chin unless a roll line is drawn
  // (make-pattern --turned-collar).
  const double spread = 1.25, radius = 2 * half_top / spread, fall = 0.045, point = 0.015;
  const auto arc = [&](double r, double angle) {
    return Vec2(r * std::sin(angle), r * std::cos(angle) - radius);
  };
  const double handle = 4.0 / 3 * std::tan(spread / 4); // cubic that follows the arc
  const Vec2 a = arc(radius, -spread / 2), e = arc(radius, spread / 2);
  const Vec2 free_a = arc(radius + fall + point, -spread / 2),
             free_e = arc(radius + fall + point, spread / 2);
  const auto along = [&](double angle, double r) {
    return Vec2(handle * r * std::cos(angle), -handle * r * std::sin(angle));
  };
  DraftPanel collar;
  collar.name = "collar";
  collar.points = {a, e, free_e, free_a};
  collar.edges = {{"low", {a + along(-spread / 2, radius), e - along(spread / 2, radius)}},
                  {"front_r", {}},
                  {"free",
                   {free_e - along(spread / 2, radius + fall - 2 * point),
                    free_a + along(-spread / 2, radius + fall - 2 * point)}},
                  {"front_l", {}}};
  collar.placement = {"neck", 180, m.neck_back_height + stand_height, Vec2(0, 0)};
  d.add(collar);

  d.sew("front_l", "center", "front_r", "center", 0, "closure");
  d.sew("back", "yoke", "yoke", "back");
  d.sew("front_l", "shoulder", "yoke", "shoulder_l");
  d.sew("front_r", "shoulder", "yoke", "shoulder_r");
  d.sew("front_l", "side", "back", "side_l");
  d.sew("front_r", "side", "back", "side_r");
  for (const char* s : {"l", "r"}) {
    const std::string side_name = s, sl = "sleeve_" + side_name, cu = "cuff_" + side_name;
    sew_sleeve(d, s, CAP_EASE);
    d.sew(sl, "cap_back", "back", "armhole_" + side_name, CAP_EASE);
    d.sew(sl, "cap_yoke", "yoke", "armhole_" + side_name, CAP_EASE);
    d.sew(sl, "hem", cu, "top");
    d.sew(cu, "end_front", cu, "end_back", 0, "closure");
  }
  d.sew("stand", "neck_l", "front_l", "neck");
  d.sew("stand", "neck_back", "yoke", "neck");
  d.sew("stand", "neck_r", "front_r", "neck");
  d.sew("stand", "end_l", "stand", "end_r", 0, "closure");
  d.sew("collar", "low", "stand", "top");
  return d;
}

Draft draft_tshirt(const Measures& m) {
  constexpr double CAP_EASE = 0.008;
  const Block b = make_block(m, 0.08, m.waist_to_hip + 0.02, 1.30 * m.neck + 0.06);
  Draft d{"tshirt", {}, {}};
  const auto whole = [&](const char* name, double theta, double hollow, bool is_front) {
    DraftPanel p;
    p.name = name;
    const std::vector<Vec2> side = side_control(b, 0.008), hole = armhole_control(b, hollow);
    // Seen from outside, the wearer's left is at +x on the front and at -x on the back.
    const std::string right = is_front ? "l" : "r", left = is_front ? "r" : "l";
    p.points = {
        {-b.hem_half, -b.hem}, {b.hem_half, -b.hem}, {b.quarter, -b.scye}, b.shoulder,
        b.side_neck,           flip(b.side_neck),    flip(b.shoulder),     {-b.quarter, -b.scye}};
    std::vector<Vec2> neck = back_neck_control(b);
    if (is_front)
      neck = {Vec2(0.80 * b.neck_half, b.neck_rise - 4.0 / 3 * b.neck_drop),
              Vec2(-0.80 * b.neck_half, b.neck_rise - 4.0 / 3 * b.neck_drop)};
    p.edges = {{"hem", {}},
               {"side_" + right, side},
               {"armhole_" + right, hole},
               {"shoulder_" + right, {}},
               {"neck", neck},
               {"shoulder_" + left, {}},
               {"armhole_" + left, flip_run(hole)},
               {"side_" + left, flip_run(side)}};
    p.placement = {"torso", theta, height_of(m, b.scye), Vec2(0, -b.scye)};
    return p;
  };
  const DraftPanel front = whole("front", 0, 0.026, true), back = whole("back", 180, 0.014, false);
  d.add(front);
  d.add(back);
  const double front_armhole = edge_length(front, "armhole_l"),
               back_armhole = edge_length(back, "armhole_l");
  const double cap = 0.27 * (front_armhole + back_armhole);
  const DraftPanel sleeve =
      make_sleeve(front_armhole, back_armhole, 0.09, m.upper_arm + 0.09, cap, CAP_EASE);
  d.add(sleeve);
  d.add(mirrored(sleeve, "sleeve_r", "arm_r"));
  for (const char* s : {"l", "r"}) {
    const std::string side = s, sl = "sleeve_" + side;
    d.sew("front", "shoulder_" + side, "back", "shoulder_" + side);
    d.sew("front", "side_" + side, "back", "side_" + side);
    d.sew(sl, "cap_front", "front", "armhole_" + side, CAP_EASE);
    d.sew(sl, "cap_back", "back", "armhole_" + side, CAP_EASE);
    d.sew(sl, "under_front", sl, "under_back");
  }
  return d;
}

} // namespace sloper::samples

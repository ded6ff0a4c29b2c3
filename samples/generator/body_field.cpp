#include "body_field.hpp"
#include <algorithm>
#include <cmath>
#include <sloper/base/units.hpp>
namespace sloper::samples {
namespace {
using units::radians;

/// A cross-section in fractions of stature: half breadth, front and back as z of the skin.
struct Section {
  double y, half, front, back, exponent;
};

/// Heights, breadths and depths of the trunk at an index of 23 or so, before the girths are fitted.
const std::vector<Section> FEMALE_TRUNK = {
    {0.464, 0.066, 0.036, -0.046, 2.0},  {0.478, 0.094, 0.048, -0.055, 2.1},
    {0.496, 0.105, 0.056, -0.061, 2.2},  {0.520, 0.108, 0.060, -0.064, 2.2},
    {0.560, 0.103, 0.067, -0.059, 2.15}, {0.600, 0.093, 0.069, -0.051, 2.1},
    {0.635, 0.082, 0.065, -0.048, 2.1},  {0.685, 0.086, 0.060, -0.058, 2.15},
    {0.725, 0.093, 0.057, -0.069, 2.2},  {0.765, 0.093, 0.043, -0.070, 2.25},
    {0.800, 0.088, 0.034, -0.068, 2.2},  {0.825, 0.062, 0.024, -0.060, 2.0},
    {0.846, 0.036, 0.014, -0.046, 2.0}};
const std::vector<Section> MALE_TRUNK = {
    {0.466, 0.064, 0.037, -0.044, 2.0},  {0.480, 0.090, 0.048, -0.051, 2.1},
    {0.498, 0.098, 0.055, -0.057, 2.2},  {0.525, 0.099, 0.058, -0.060, 2.25},
    {0.560, 0.098, 0.066, -0.057, 2.2},  {0.600, 0.095, 0.069, -0.054, 2.2},
    {0.635, 0.091, 0.068, -0.052, 2.2},  {0.685, 0.095, 0.068, -0.061, 2.25},
    {0.725, 0.097, 0.062, -0.066, 2.35}, {0.765, 0.101, 0.050, -0.072, 2.4},
    {0.800, 0.097, 0.038, -0.070, 2.3},  {0.826, 0.072, 0.027, -0.062, 2.0},
    {0.850, 0.041, 0.016, -0.048, 2.0}};

struct LegSection {
  double y, inner, outer, front, back; ///< radii inward and outward, z of the skin
};
const std::vector<LegSection> LEG = {
    {0.036, 0.0205, 0.0215, 0.020, -0.030},   {0.062, 0.0185, 0.0190, 0.0150, -0.0255},
    {0.100, 0.0195, 0.0205, 0.0150, -0.0280}, {0.150, 0.0255, 0.0265, 0.0190, -0.0370},
    {0.200, 0.0310, 0.0325, 0.0240, -0.0430}, {0.235, 0.0312, 0.0325, 0.0275, -0.0390},
    {0.280, 0.0318, 0.0318, 0.0390, -0.0300}, {0.335, 0.0365, 0.0380, 0.0440, -0.0370},
    {0.400, 0.0450, 0.0475, 0.0500, -0.0480}, {0.450, 0.0500, 0.0515, 0.0550, -0.0580},
    {0.478, 0.0480, 0.0480, 0.0510, -0.0540}, {0.503, 0.0440, 0.0420, 0.0420, -0.0440},
    {0.525, 0.0300, 0.0300, 0.0270, -0.0270}};

} // namespace

BodyField::BodyField(const Mannequin& shape, const GirthFactors& g)
    : m_shape(shape), m_female(shape.sex == "f") {
  const double h = stature = shape.stature_m;
  const bool f = m_female;
  y_neck_back = (f ? 0.854 : 0.851) * h;
  y_neck_front = (f ? 0.834 : 0.835) * h;
  y_bust = (f ? 0.716 : 0.725) * h;
  y_chest = 0.762 * h;
  y_underbust = (f ? 0.672 : 0.690) * h;
  y_waist = 0.635 * h;
  y_omphalion = 0.600 * h;
  y_hip = (f ? 0.508 : 0.512) * h;
  y_crotch_knot = 0.46 * h;
  build_trunk(g);
  build_leg(g);
  build_head(g);
  build_arm(g);
}

void BodyField::build_trunk(const GirthFactors& g) {
  const double h = stature;
  const MonotoneCurve scale(
      {0.46 * h, y_hip, y_omphalion - 0.015 * h, y_waist, y_underbust, y_bust, y_chest, 0.82 * h},
      {g.hip, g.hip, g.abdomen, g.waist, g.underbust, g.chest, std::pow(g.chest, 0.85),
       std::pow(g.chest, 0.6)});
  // Fat goes to the front of the belly first: there the front grows more than the back.
  const MonotoneCurve forward({0.50 * h, y_omphalion - 0.015 * h, y_waist, y_chest},
                              {0.0, 0.5, 0.35, 0.0});
  std::vector<TubeKnot> knots;
  for (const Section& s : m_female ? FEMALE_TRUNK : MALE_TRUNK) {
    const double y = s.y * h,
                 k = 0.25 * (scale.at(y - 0.025 * h) + 2 * scale.at(y) + scale.at(y + 0.025 * h)),
                 push = forward.at(y) * std::max(k - 1, 0.0);
    const double middle = 0.5 * (s.front + s.back) * h, half_depth = 0.5 * (s.front - s.back) * h;
    const double front = middle + half_depth * (k + push),
                 back = middle - half_depth * (k - 0.6 * push);
    const double center = 0.45 * front + 0.55 * back;
    knots.push_back(
        {y, 0, center, s.half * h * k, s.half * h * k, front - center, center - back, s.exponent});
  }
  m_trunk = Tube(knots, 0.022 * h, 0.015 * h);
  y_fold = y_underbust;
  m_buttock = Vec3(0.046, m_female ? 0.508 : 0.512, m_female ? -0.026 : -0.024) * h;
  m_buttock_radii =
      (m_female ? Vec3(0.054, 0.056, 0.052) : Vec3(0.050, 0.052, 0.047)) * h * std::sqrt(g.hip);
  m_buttock.z() -= 0.02 * h * (g.hip - 1);
  const TubeKnot bust = m_trunk.section(y_bust);
  const double skin = bust.center_z + bust.front;
  if (m_female) {
    const double r = (0.040 + 0.35 * g.breast_m / h) * h;
    breast_radii = Vec3(r, 1.05 * r, 0.9 * r);
    breast_center = Vec3(0.30 * bust.left + 0.5 * r, y_bust, skin - 0.60 * r + g.breast_m);
    // The fold: where the breast's lower side meets the rib cage, and a little of the blend.
    const double out = std::clamp((skin - breast_center.z()) / breast_radii.z(), -0.9, 0.9);
    y_fold = y_bust - breast_radii.y() * std::sqrt(1 - out * out) - 0.004 * h;
  } else { // the breast muscle: wide and flat
    breast_radii = Vec3(0.046, 0.036, 0.024) * h * std::sqrt(g.chest);
    breast_center = Vec3(0.47 * bust.left, y_bust + 0.006 * h, skin - 0.80 * breast_radii.z());
  }
}

void BodyField::build_head(const GirthFactors& g) {
  const double h = stature, r = (m_female ? 0.0290 : 0.0315) * h * g.neck;
  const auto section = [&](double y, double z, double k) {
    return TubeKnot{y * h, 0, z * h, r * k, r * k, r * k * 1.02, r * k * 1.04, 2};
  };
  m_neck =
      Tube({section(0.800, -0.022, 1.05), section(0.835, -0.014, 1.08),
            section(0.855, -0.006, 1.02), section(0.875, 0.001, 1.0), section(0.920, 0.010, 1.0)},
           0.01 * h, 0.01 * h);
  const double w = m_female ? 1.0 : 1.03;
  const auto face = [&](double y, double half, double front, double back) {
    const double c = 0.5 * (front + back);
    return TubeKnot{y * h,          0,  c * h, w * half * h, w * half * h, (front - c) * h,
                    (c - back) * h, 2.2};
  };
  m_face = Tube({face(0.868, 0.0210, 0.0570, 0.010), face(0.882, 0.0310, 0.0600, -0.012),
                 face(0.900, 0.0370, 0.0590, -0.026), face(0.925, 0.0410, 0.0580, -0.038),
                 face(0.955, 0.0420, 0.0560, -0.040)},
                0.012 * h, 0.02 * h);
}

void BodyField::build_arm(const GirthFactors& g) {
  const double h = stature, angle = radians(m_shape.arm_deg);
  upper_arm_length = 0.170 * h;
  forearm_length = 0.147 * h;
  hand_length = 0.106 * h;
  // The shoulder girdle rises and turns inward as the arm is lifted.
  lift = smooth_step(30, 100, m_shape.arm_deg);
  const double chest = 0.30 * (g.chest - 1);
  shoulder_joint = Vec3((m_female ? 0.0975 : 0.1070) * (1 + chest) - 0.006 * lift,
                        0.796 + 0.016 * lift, -0.009) *
                   h;
  m_arm_x = Vec3(std::cos(angle), std::sin(angle), 0);
  m_arm_y = Vec3(-std::sin(angle), std::cos(angle), 0);
  const double forward = 0.020 * h; // an easy elbow: wrist and hand lie a little forward
  const double le = -upper_arm_length, lw = le - forearm_length, lt = lw - hand_length;
  struct ArmSection {
    double t, z, outer, inner, front, back, factor,
        exponent; ///< t from the shoulder: 1 elbow, 2 wrist, 3 tip
  };
  const double u = (m_female ? 1.0 : 1.12) * h;
  const ArmSection sections[] = {{3.00, 1.15, 0.0055, 0.0055, 0.0115, 0.0115, 0, 2.2},
                                 {2.72, 1.12, 0.0072, 0.0072, 0.0195, 0.0180, 0, 2.4},
                                 {2.40, 1.10, 0.0085, 0.0085, 0.0235, 0.0205, 0, 2.5},
                                 {2.12, 1.03, 0.0110, 0.0110, 0.0190, 0.0170, 0, 2.3},
                                 {2.00, 1.00, 0.0125, 0.0125, 0.0165, 0.0165, 3, 2.1},
                                 {1.75, 0.80, 0.0150, 0.0150, 0.0180, 0.0180, 2.6, 2},
                                 {1.28, 0.28, 0.0235, 0.0225, 0.0235, 0.0225, 2, 2},
                                 {1.00, 0.00, 0.0225, 0.0220, 0.0225, 0.0240, 1.7, 2},
                                 {0.80, 0.00, 0.0235, 0.0235, 0.0250, 0.0245, 1.2, 2},
                                 {0.50, 0.00, 0.0265, 0.0260, 0.0280, 0.0270, 1, 2},
                                 {0.20, 0.00, 0.0305, 0.0290, 0.0320, 0.0310, 0.8, 2},
                                 {-0.06, 0.00, 0.0330, 0.0300, 0.0340, 0.0330, 0.6, 2}};
  const auto height_at = [&](double t) {
    if (t < 1)
      return t * le;
    if (t < 2)
      return le - (t - 1) * forearm_length;
    return lw - (t - 2) * hand_length;
  };
  const auto growth_at = [&](double factor) {
    if (factor == 0)
      return std::sqrt(std::sqrt(g.wrist)); // hands hardly grow
    if (factor <= 1)
      return 1 + (g.upper_arm - 1) * factor;
    if (factor <= 2)
      return g.upper_arm + (g.forearm - g.upper_arm) * (factor - 1);
    return g.forearm + (g.wrist - g.forearm) * (factor - 2);
  };
  std::vector<TubeKnot> knots;
  for (const ArmSection& s : sections) {
    const double y = height_at(s.t);
    const double k = growth_at(s.factor);
    knots.push_back({y, 0, s.z * forward, s.outer * u * k, s.inner * u * k, s.front * u * k,
                     s.back * u * k, s.exponent});
  }
  m_arm = Tube(knots, 0.010 * h, 0.030 * h);
  const auto joint = [&](double y) {
    const TubeKnot s = m_arm.section(y);
    return from_arm(Vec3(0, y, s.center_z));
  };
  elbow = joint(le);
  wrist = joint(lw);
  hand_tip = joint(lt);
}

void BodyField::build_leg(const GirthFactors& g) {
  const double h = stature;
  const double thigh = g.thigh, gap = 0.005 * h;
  leg_slope = std::tan(radians(m_shape.leg_deg));
  const double hip_x = (m_female ? 0.054 : 0.052) * h, top = 0.46 * h;
  hip_joint = Vec3(hip_x, 0.509 * h, -0.018 * h);
  const MonotoneCurve scale({0.065 * h, 0.205 * h, 0.279 * h, 0.42 * h},
                            {g.ankle, g.calf, g.knee, thigh});
  // The leg's middle: by its inner skin at the top, by the line of the bones from the knee down.
  const auto center_x = [&](double y) {
    const double bones =
        hip_x - 0.10 * (hip_joint.y() - std::max(y, 0.279 * h)) * (m_female ? 1 : 0.6);
    const double skin = gap + 0.0500 * h * thigh;
    return bones + (skin - bones) * smooth_step(0.27 * h, top, y) + leg_slope * (hip_joint.y() - y);
  };
  const double sex = m_female ? 1 : 0.97;
  std::vector<TubeKnot> knots;
  for (const LegSection& s : LEG) {
    const double y = s.y * h, k = scale.at(y) * sex * h, middle = 0.5 * (s.front + s.back) * h,
                 depth = 0.5 * (s.front - s.back) * k;
    // Inside the trunk the leg's outer side follows the trunk's, or the hip would have a ledge.
    const double outline = m_trunk.section(std::max(y, 0.508 * h)).left - 0.008 * h - s.outer * k;
    const double x = center_x(y) + (outline - center_x(y)) * smooth_step(0.455 * h, 0.530 * h, y);
    knots.push_back({y, x, middle, s.outer * k, s.inner * k, depth, depth, 2.05});
  }
  m_leg = Tube(knots, 0.012 * h, 0.03 * h);
  const auto joint = [&](double y, double z) { return Vec3(center_x(y), y, z * h); };
  knee = joint(0.279 * h, 0.006);
  ankle = joint(0.042 * h, -0.006);
  // The foot lies along its own z, from the heel to the toe, turned out a little; tube axis = that
  // line.
  m_foot_turn = radians(7 + 0.5 * m_shape.leg_deg);
  struct FootSection {
    double t, inner, outer, height;
  };
  const FootSection feet[] = {{-0.043, 0.0150, 0.0150, 0.028}, {-0.030, 0.0185, 0.0185, 0.040},
                              {0.000, 0.0190, 0.0200, 0.049},  {0.030, 0.0200, 0.0215, 0.041},
                              {0.065, 0.0260, 0.0270, 0.026},  {0.085, 0.0285, 0.0260, 0.019},
                              {0.100, 0.0270, 0.0200, 0.0145}, {0.109, 0.0200, 0.0130, 0.012}};
  knots.clear();
  const double size = h * std::sqrt(std::sqrt(g.ankle));
  for (const FootSection& s : feet)
    knots.push_back({s.t * h, 0, 0.42 * s.height * h, s.outer * size, s.inner * size,
                     0.58 * s.height * h, 0.42 * s.height * h, 2.6});
  m_foot = Tube(knots, 0.014 * h, 0.012 * h);
}

double BodyField::leg(const Vec3& p) const {
  const double h = stature;
  if (p.y() > 0.66 * h)
    return p.y() - 0.53 * h; // far off: only the size matters
  if (p.y() > 0.16 * h)
    return m_leg.distance(p);
  const Vec3 q = p - Vec3(ankle.x(), 0, ankle.z());
  const double c = std::cos(m_foot_turn), s = std::sin(m_foot_turn);
  // Foot frame: its y is forward along the foot, its z is up.
  const Vec3 local(c * q.x() - s * q.z(), s * q.x() + c * q.z(), q.y());
  return smooth_union(m_leg.distance(p), m_foot.distance(local), 0.028 * h);
}

double BodyField::head(const Vec3& p) const {
  const double h = stature;
  if (p.y() < 0.70 * h)
    return 0.80 * h - p.y(); // far off: only the size matters
  const Vec3 q(std::abs(p.x()), p.y(), p.z() - 0.010 * h);
  double d = ellipsoid_distance(q, Vec3(0, 0.9405, 0.001) * h,
                                Vec3(m_female ? 0.0455 : 0.0465, 0.0595, 0.0570) * h);
  d = smooth_union(d, m_face.distance(q), 0.02 * h);
  // Eye hollows, nose, ears: enough for a face to read as one.
  const double eye =
      ellipsoid_distance(q, Vec3(0.0195, 0.9370, 0.0640) * h, Vec3(0.0125, 0.0075, 0.0085) * h);
  d = -smooth_union(-d, eye, 0.012 * h);
  d = smooth_union(d,
                   round_cone_distance(q, Vec3(0, 0.9400, 0.0545) * h, Vec3(0, 0.9200, 0.0630) * h,
                                       0.0045 * h, 0.0080 * h),
                   0.010 * h);
  d = smooth_union(
      d, ellipsoid_distance(q, Vec3(0, 0.8990, 0.0560) * h, Vec3(0.013, 0.0050, 0.0065) * h),
      0.008 * h);
  d = smooth_union(
      d, ellipsoid_distance(q, Vec3(0.0455, 0.9290, -0.006) * h, Vec3(0.0055, 0.0165, 0.0100) * h),
      0.006 * h);
  return smooth_union(d, m_neck.distance(p), 0.022 * h);
}

double BodyField::trunk(const Vec3& p) const {
  const double h = stature;
  if (p.y() < 0.30 * h)
    return 0.44 * h - p.y(); // far off: only the size matters
  const Vec3 q(std::abs(p.x()), p.y(), p.z());
  double d = m_trunk.distance(q);
  // The shoulder girdle, from the root of the neck to the shoulder.
  const Vec3 end = shoulder_joint + Vec3(-0.010, 0.001, -0.004) * h;
  d = smooth_union(
      d, round_cone_distance(q, Vec3(0.020, 0.834, -0.026) * h, end, 0.024 * h, 0.032 * h),
      0.03 * h);
  const auto both = [&](const Vec3& center, const Vec3& radii,
                        double k) { // both sides, so that nothing creases at x = 0
    Vec3 other = center;
    other.x() = -center.x();
    return smooth_union(ellipsoid_distance(p, center, radii), ellipsoid_distance(p, other, radii),
                        k);
  };
  // A breast runs out softly upward and has a fold below.
  const double fold =
      m_female
          ? 0.010 + 0.036 * smooth_step(-0.9, 1.0, (p.y() - breast_center.y()) / breast_radii.y())
          : 0.050;
  d = smooth_union(d, both(breast_center, breast_radii, 0.012 * h),
                   fold * (m_female ? breast_radii.x() / 0.042 : h));
  return smooth_union(d, both(m_buttock, m_buttock_radii, 0.010 * h), 0.030 * h);
}

double BodyField::without_arms(const Vec3& p) const {
  const double h = stature;
  // The blend of leg and trunk is wide outside and narrow between the legs, or the thighs would
  // grow together.
  const double legs = smooth_union(leg(p), leg(Vec3(-p.x(), p.y(), p.z())),
                                   0.006 * h * smooth_step(0.40 * h, 0.47 * h, p.y()));
  double d = smooth_union(
      trunk(p), legs,
      (0.012 + 0.034 * smooth_step(0.02 * h, 0.085 * h, std::hypot(p.x(), 0.5 * p.z())) *
                   smooth_step(0.53 * h, 0.46 * h, p.y())) *
          h);
  d = smooth_union(d, head(p), 0.030 * h);
  return std::max(d, -p.y());
}

Vec3 BodyField::from_arm(const Vec3& q) const {
  return shoulder_joint + q.x() * m_arm_x + q.y() * m_arm_y + q.z() * Vec3::UnitZ();
}

Vec3 BodyField::to_arm(const Vec3& p) const {
  const Vec3 d = p - shoulder_joint;
  return {d.dot(m_arm_x), d.dot(m_arm_y), d.z()};
}

double BodyField::arm(const Vec3& p) const {
  const double h = stature;
  const Vec3 q = to_arm(p);
  if (std::abs(q.x()) > 0.2 * h)
    return std::abs(q.x()) - 0.05 * h; // far off: only the size matters
  double d = m_arm.distance(q);
  // The thumb, beside the palm, pointing forward and down.
  const double w = -(upper_arm_length + forearm_length);
  const Vec3 root(0, w - 0.018 * h, 0.030 * h), tip(-0.002 * h, w - 0.056 * h, 0.052 * h);
  return smooth_union(d, round_cone_distance(q, root, tip, 0.0085 * h, 0.0062 * h), 0.010 * h);
}

double BodyField::all(const Vec3& p) const {
  const Vec3 left(std::abs(p.x()), p.y(), p.z());
  // The arm grows out of the shoulder over a wide blend that ends below the arm pit, or arm and
  // flank would web.
  const double along = to_arm(left).y();
  const double k = (0.006 + 0.040 * smooth_step(-0.14, -0.02, along / stature)) * stature;
  return smooth_union(without_arms(p), arm(left), k);
}

Vec3 BodyField::neck_axis_point(double y) const {
  const TubeKnot s = m_neck.section(y);
  return {0, y, s.center_z};
}

Vec3 BodyField::neck_front_direction() const {
  return {0, -std::sin(radians(22)), std::cos(radians(22))};
}

} // namespace sloper::samples

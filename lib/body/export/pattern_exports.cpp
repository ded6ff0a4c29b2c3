#include <sloper/base/units.hpp>
#include <sloper/body/export/exports.hpp>
#include <sloper/body/measure/section.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace sloper::body {

namespace {

/// Values by name in the order in which they were added; what could not be measured is left out.
class Table {
public:
  void add(const std::string& name, std::optional<double> value) {
    if (value && std::isfinite(*value) && *value > 0)
      m_rows.emplace_back(name, *value);
  }
  const std::vector<std::pair<std::string, double>>& rows() const { return m_rows; }

private:
  std::vector<std::pair<std::string, double>> m_rows;
};

std::optional<double> level_y(const Body& b, const std::string& name) {
  const auto it = b.levels.find(name);
  return it == b.levels.end() ? std::nullopt : std::optional(it->second.y);
}

std::optional<double> level_girth(const Body& b, const std::string& name) {
  const auto it = b.levels.find(name);
  return it == b.levels.end() ? std::nullopt : std::optional(it->second.girth_m);
}

std::optional<double> girth(const Body& b, const std::string& name) {
  double sum = 0;
  int n = 0;
  for (const char* side : {"", "_l", "_r"})
    if (const auto it = b.girths.find(name + side); it != b.girths.end()) {
      sum += it->second.value_m;
      ++n;
    }
  return n ? std::optional(sum / n) : std::nullopt;
}

/// Mean height of a landmark, of both sides where it has two.
std::optional<double> height(const Body& b, const std::string& name) {
  double sum = 0;
  int n = 0;
  for (const char* side : {"", "_l", "_r"})
    if (b.has_landmark(name + side)) {
      sum += b.landmark(name + side).y();
      ++n;
    }
  return n ? std::optional(sum / n) : std::nullopt;
}

std::optional<double> between(const Body& b, const std::string& from, const std::string& to) {
  if (!b.has_landmark(from) || !b.has_landmark(to))
    return std::nullopt;
  return (b.landmark(from) - b.landmark(to)).norm();
}

std::optional<double> minus(std::optional<double> a, std::optional<double> c) {
  return a && c ? std::optional(*a - *c) : std::nullopt;
}

/// Mean over both sides of the polyline through these landmarks.
std::optional<double> along(const Body& b, const std::vector<std::string>& names) {
  double sum = 0;
  int n = 0;
  for (const std::string side : {"_l", "_r"}) {
    double length = 0;
    bool whole = true;
    for (std::size_t k = 0; k + 1 < names.size(); ++k) {
      const auto d = between(b, names[k] + side, names[k + 1] + side);
      whole &= d.has_value();
      length += d.value_or(0);
    }
    if (whole) {
      sum += length;
      ++n;
    }
  }
  return n ? std::optional(sum / n) : std::nullopt;
}

/// Loop of the trunk at a height: the largest one near the middle, its arms cut off at `reach` from
/// the middle.
std::vector<Vec2> trunk_hull(const Body& b, double y, double reach) {
  for (const Loop& loop : cut(b.skin, level_plane(y))) {
    if (loop.area <= 0 || std::abs(loop.centroid.x()) > 0.1)
      continue;
    std::vector<Vec2> points;
    for (const auto& s : loop.segments)
      if (std::abs(s[0].x()) <= reach)
        points.push_back(s[0]);
    return convex_hull(std::move(points));
  }
  return {};
}

/// The share of a taut girth that lies behind the trunk's broadest places, as a length.
std::optional<double> back_width(const Body& b, const std::string& level) {
  const auto it = b.levels.find(level);
  if (it == b.levels.end())
    return std::nullopt;
  const std::vector<Vec2> hull = trunk_hull(b, it->second.y, 0.5 * it->second.width_m + 0.002);
  if (hull.size() < 3)
    return std::nullopt;
  const auto by_x = [](const Vec2& p, const Vec2& q) { return p.x() < q.x(); };
  const Vec2 right = *std::min_element(hull.begin(), hull.end(), by_x),
             left = *std::max_element(hull.begin(), hull.end(), by_x);
  double length = 0;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vec2 &p = hull[i], &q = hull[(i + 1) % hull.size()], middle = 0.5 * (p + q);
    const double w = (middle.x() - right.x()) / std::max(left.x() - right.x(), 1e-9);
    if (middle.y() < right.y() + w * (left.y() - right.y()))
      length += (q - p).norm();
  }
  return length;
}

/// Taut length over the back in the middle plane, from one height down to another.
std::optional<double> over_the_back(const Body& b, std::optional<double> top,
                                    std::optional<double> bottom) {
  if (!top || !bottom || *top <= *bottom || b.skin.triangles.empty())
    return std::nullopt;
  const Plane middle{Vec3::Zero(), Vec3::UnitZ(), Vec3::UnitY()};
  constexpr double STEP = 0.005; // m
  const int n = static_cast<int>((*top - *bottom) / STEP) + 1;
  std::vector<double> rear(static_cast<std::size_t>(n), 1e300);
  for (const Loop& loop : cut(b.skin, middle))
    for (const auto& s : loop.segments) {
      const auto [low, high] = std::minmax(s[0].y(), s[1].y());
      const int first = std::max(0, static_cast<int>(std::ceil((*top - high) / STEP))),
                last = std::min(n - 1, static_cast<int>((*top - low) / STEP));
      for (int k = first; k <= last && high > low; ++k) {
        const double w = (*top - k * STEP - s[0].y()) / (s[1].y() - s[0].y());
        rear[k] = std::min(rear[k], s[0].x() + w * (s[1].x() - s[0].x()));
      }
    }
  // a tape bridges hollows: the lower hull of depth over height
  std::vector<Vec2> taut;
  for (int k = 0; k < n; ++k) {
    if (rear[k] > 1e299)
      continue;
    const Vec2 p(k * STEP, rear[k]);
    while (taut.size() > 1) {
      const Vec2 u = taut.back() - taut[taut.size() - 2], v = p - taut[taut.size() - 2];
      if (u.x() * v.y() - u.y() * v.x() > 0)
        break;
      taut.pop_back();
    }
    taut.push_back(p);
  }
  double length = 0;
  for (std::size_t k = 1; k < taut.size(); ++k)
    length += (taut[k] - taut[k - 1]).norm();
  return length;
}

std::optional<double> both_sides(const Body& b, const std::string& name) {
  if (!b.has_landmark(name + "_l") || !b.has_landmark(name + "_r"))
    return std::nullopt;
  return b.landmark(name + "_l").x() - b.landmark(name + "_r").x();
}

std::string number(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.2f", x);
  return text;
}

} // namespace

std::string valentina_measurements(const Body& b) {
  Table t;
  t.add("height", b.scan.stature_m);
  t.add("height_neck_back", height(b, "neck_back"));
  t.add("height_neck_front", height(b, "neck_front"));
  t.add("height_neck_side", height(b, "neck_side"));
  t.add("height_shoulder_tip", height(b, "acromion"));
  t.add("height_armpit", height(b, "axilla"));
  t.add("height_waist_side", level_y(b, "waist_semantic"));
  t.add("height_hip", level_y(b, "hip"));
  t.add("height_knee", height(b, "knee"));
  t.add("height_ankle", height(b, "ankle"));
  t.add("width_shoulder", both_sides(b, "acromion"));
  for (const auto& [ours, theirs] :
       {std::pair("bust", "width_bust"), std::pair("waist_semantic", "width_waist"),
        std::pair("hip", "width_hip")})
    if (const auto it = b.levels.find(ours); it != b.levels.end())
      t.add(theirs, it->second.width_m);
  t.add("foot_length", along(b, {"heel", "foot_tip"}));
  t.add("neck_mid_circ", girth(b, "neck"));
  t.add("neck_circ", girth(b, "neck_base"));
  t.add("highbust_circ", level_girth(b, "chest_axilla"));
  t.add("bust_circ", level_girth(b, "bust"));
  t.add("lowbust_circ", level_girth(b, "underbust"));
  t.add("waist_circ", level_girth(b, "waist_semantic"));
  t.add("hip_circ", level_girth(b, "hip"));
  t.add("neck_back_to_waist_b",
        over_the_back(b, height(b, "neck_back"), level_y(b, "waist_semantic")));
  t.add("shoulder_length", along(b, {"neck_side", "acromion"}));
  t.add("bustpoint_to_bustpoint", between(b, "bust_point_l", "bust_point_r"));
  t.add("arm_shoulder_tip_to_wrist", along(b, {"acromion", "elbow", "wrist"}));
  t.add("arm_shoulder_tip_to_elbow", along(b, {"acromion", "elbow"}));
  t.add("arm_upper_circ", girth(b, "upper_arm"));
  t.add("arm_wrist_circ", girth(b, "wrist"));
  t.add("leg_crotch_to_floor", height(b, "crotch"));
  t.add("leg_thigh_upper_circ", girth(b, "thigh"));
  t.add("leg_knee_circ", girth(b, "knee"));
  t.add("leg_calf_circ", girth(b, "calf"));
  t.add("leg_ankle_circ", girth(b, "ankle_min"));
  std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<vit>\n    "
                    "<version>0.3.3</version>\n    <read-only>false</read-only>\n    <notes/>\n"
                    "    <unit>cm</unit>\n    <pm_system>998</pm_system>\n    <personal>\n        "
                    "<family-name/>\n        <given-name/>\n"
                    "        <birth-date>1800-01-01</birth-date>\n        "
                    "<gender>unknown</gender>\n        <email/>\n    </personal>\n"
                    "    <body-measurements>\n";
  for (const auto& [name, metres] : t.rows())
    out += "        <m name=\"" + name + "\" value=\"" + number(100 * metres) + "\"/>\n";
  return out + "    </body-measurements>\n</vit>\n";
}

std::string garmentcode_body(const Body& b) {
  Table t; // cm, but for angles: metres until they are written
  const auto neck = height(b, "neck_back"), waist = level_y(b, "waist_semantic"),
             hip = level_y(b, "hip"), bust = level_y(b, "bust");
  t.add("height", b.scan.stature_m);
  t.add("head_l", minus(b.scan.stature_m, neck));
  t.add("neck_w", both_sides(b, "neck_side"));
  t.add("shoulder_w", both_sides(b, "acromion"));
  t.add("armscye_depth", minus(neck, height(b, "axilla")));
  t.add("arm_length", along(b, {"acromion", "elbow", "wrist"}));
  t.add("wrist", girth(b, "wrist"));
  t.add("waist", level_girth(b, "waist_semantic"));
  t.add("waist_line", over_the_back(b, neck, waist));
  // from the neck's side over the bust point down to the waist
  if (const auto over = along(b, {"neck_side", "bust_point"}); over && bust && waist)
    t.add("waist_over_bust_line", *over + (*bust - *waist));
  t.add("waist_back_width", back_width(b, "waist_semantic"));
  t.add("bust_line", over_the_back(b, neck, bust));
  t.add("bust", level_girth(b, "bust"));
  t.add("bust_points", both_sides(b, "bust_point"));
  t.add("underbust", level_girth(b, "underbust"));
  t.add("back_width", back_width(b, "bust"));
  t.add("hips", level_girth(b, "hip"));
  t.add("hip_back_width", back_width(b, "hip"));
  t.add("hips_line", minus(waist, hip));
  if (b.has_landmark("buttock_back"))
    t.add("bum_points", 2 * std::abs(b.landmark("buttock_back").x()));
  t.add("crotch_hip_diff", minus(hip, height(b, "crotch")));
  t.add("leg_circ", girth(b, "thigh"));
  std::string out = "# measures of a scanned body, cm and degrees\nbody:\n";
  for (const auto& [name, metres] : t.rows())
    out += "  " + name + ": " + number(100 * metres) + "\n";
  auto angle = [&](const char* name, double rise, double run) {
    out += std::string("  ") + name + ": " + number(units::degrees(std::atan2(rise, run))) + "\n";
  };
  if (const auto side = height(b, "neck_side"), tip = height(b, "acromion");
      side && tip && both_sides(b, "acromion") && both_sides(b, "neck_side"))
    angle("shoulder_incl", *side - *tip,
          0.5 * (*both_sides(b, "acromion") - *both_sides(b, "neck_side")));
  if (hip && waist && b.levels.count("hip") && b.levels.count("waist_semantic"))
    angle("hip_inclination",
          0.5 * (b.levels.at("hip").width_m - b.levels.at("waist_semantic").width_m),
          *waist - *hip);
  out +=
      "  arm_pose_angle: " + number(90 - 0.5 * (b.arm_l_deg + b.arm_r_deg)) + "\n"; // below level
  return out;
}

} // namespace sloper::body

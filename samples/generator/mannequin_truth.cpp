#include "mannequin_truth.hpp"
#include "section.hpp"
#include <algorithm>
#include <cmath>
#include <sloper/base/units.hpp>
#include <sloper/io/json.hpp>
namespace sloper::samples {
namespace {

constexpr unsigned char HEAD = 0, TORSO = 1, ARM_L = 2, ARM_R = 3, LEG_L = 4, LEG_R = 5;

/// Where a ray from inside leaves the surface.
Vec3 exit_point(const Field& f, const Vec3& from, const Vec3& direction) {
  const Vec3 d = direction.normalized();
  double low = 0, high = 0.004;
  while (high < 0.6 && f(from + high * d) < 0) {
    low = high;
    high += 0.004;
  }
  for (int k = 0; k < 24; ++k) {
    const double mid = 0.5 * (low + high);
    (f(from + mid * d) < 0 ? low : high) = mid;
  }
  return from + low * d;
}

class Truth {
public:
  Truth(const TriangleMesh& mesh, const std::vector<unsigned char>& parts, const BodyField& body,
        const Mannequin& shape)
      : m_mesh(mesh), m_parts(parts), m_body(body), m_female(shape.sex == "f"),
        m_field([&body](const Vec3& p) { return body.all(p); }) {}

  io::Json document(const Mannequin& shape) {
    joints();
    extremes();
    neck_and_shoulder();
    armpits();
    trunk_points();
    levels();
    girths();
    io::Json d;
    d["generator"] = "make-mannequin";
    d["units"] = "m";
    d["up"] = "+y";
    d["front"] = "+z";
    d["mesh"]["vertices"] = m_mesh.positions.size();
    d["mesh"]["triangles"] = m_mesh.triangles.size();
    d["sample"] = {{"sex", shape.sex},
                   {"bmi", shape.bmi},
                   {"arm_deg", shape.arm_deg},
                   {"leg_deg", shape.leg_deg}};
    d["derived"]["stature_m"] = bounding_box(m_mesh.positions).high.y();
    double volume = 0;
    for (const Triangle& t : m_mesh.triangles)
      volume +=
          m_mesh.positions[t[0]].dot(m_mesh.positions[t[1]].cross(m_mesh.positions[t[2]])) / 6;
    d["derived"]["volume_m3"] = volume;
    d["landmarks"] = m_landmarks;
    d["levels"] = m_levels;
    d["girths_m"] = m_girths;
    return d;
  }

private:
  void put(const std::string& name, const Vec3& p, const char* trust, const char* compare = "xyz") {
    m_landmarks[name] = {{"p", io::to_json(p)}, {"trust", trust}};
    if (std::string(compare) != "xyz")
      m_landmarks[name]["compare"] = compare;
  }
  /// Both sides; the figure is symmetric.
  void pair(const std::string& name, const Vec3& left, const char* trust,
            const char* compare = "xyz") {
    put(name + "_l", left, trust, compare);
    put(name + "_r", Vec3(-left.x(), left.y(), left.z()), trust, compare);
  }

  /// The vertex of some parts that goes farthest along d.
  Vec3 farthest(const Vec3& d, const std::function<bool(int)>& keep) const {
    int best = -1;
    for (int i = 0; i < std::ssize(m_mesh.positions); ++i)
      if (keep(i) && (best < 0 || m_mesh.positions[i].dot(d) > m_mesh.positions[best].dot(d)))
        best = i;
    return best < 0 ? Vec3(Vec3::Zero()) : m_mesh.positions[best];
  }

  Section2 trunk_section(double y) const {
    return mesh_section(m_mesh, Vec3(0, y, 0), Vec3::UnitY(), [this](const Triangle& t) {
      const auto arm = [this](int v) { return m_parts[v] == ARM_L || m_parts[v] == ARM_R; };
      return !(arm(t[0]) && arm(t[1]) && arm(t[2]));
    });
  }
  Section2 part_section(const Vec3& point, const Vec3& normal, unsigned char part) const {
    return mesh_section(m_mesh, point, normal, [&](const Triangle& t) {
      return m_parts[t[0]] == part || m_parts[t[1]] == part || m_parts[t[2]] == part;
    });
  }

  void joints() {
    pair("shoulder_joint", m_body.shoulder_joint, "high");
    pair("elbow", m_body.elbow, "high");
    pair("wrist", m_body.wrist, "high");
    pair("hip_joint", m_body.hip_joint, "medium");
    pair("knee", m_body.knee, "high");
    pair("ankle", m_body.ankle, "high");
    put("hip_center", Vec3(0, m_body.hip_joint.y(), m_body.hip_joint.z()), "medium");
  }

  void extremes() {
    const double h = m_body.stature;
    put("head_tip", farthest(Vec3::UnitY(), [](int) { return true; }), "high", "y");
    const Vec3 along = (m_body.hand_tip - m_body.wrist).normalized();
    const Vec3 tip = farthest(along, [this](int i) { return m_parts[i] == ARM_L; });
    pair("hand_tip", tip, "high");
    pair("hand_extreme", tip, "high");
    const auto foot = [&](int i) {
      return m_mesh.positions[i].x() > 0 && m_mesh.positions[i].y() < 0.06 * h;
    };
    pair("foot_tip", farthest(Vec3::UnitZ(), foot), "high",
         "yz"); // toes are of one length: which of them is foremost is no matter
    pair("heel", farthest(-Vec3::UnitZ(), foot), "high", "z");
    // The crotch is the lowest point of the mid-plane section.
    const Section2 middle =
        mesh_section(m_mesh, Vec3::Zero(), Vec3::UnitX(), [](const Triangle&) { return true; });
    m_crotch = middle.low.y();
    Vec3 at(0, m_crotch, 0);
    double best = 1e9;
    for (double z = -0.1 * h; z < 0.08 * h; z += 0.002) // where along z it is lowest
      if (const double d = m_field(Vec3(0, m_crotch + 0.001, z)); d < best) {
        best = d;
        at.z() = z;
      }
    put("crotch", at, "high", "xy");
  }

  void neck_and_shoulder() {
    const double h = m_body.stature, yb = m_body.y_neck_back, yf = m_body.y_neck_front;
    const Vec3 back = exit_point(m_field, m_body.neck_axis_point(yb), -Vec3::UnitZ());
    const Vec3 front = exit_point(m_field, Vec3(0, yf, -0.02 * h), Vec3::UnitZ());
    put("neck_back", back, "medium");
    put("neck_front", front, "medium");
    m_neck_center = Vec3(0, 0.5 * (yb + yf), 0.5 * (back.z() + front.z()));
    put("neck_center", m_neck_center, "medium");
    // On the shoulder line, where the neck has turned into the shoulder.
    const double z = back.z() + 0.32 * (front.z() - back.z());
    const Vec3 side = exit_point(m_field, Vec3(0.046 * h, 0.80 * h, z), Vec3::UnitY());
    pair("neck_side", side, "medium");
    // The acromion is bone: it goes with the shoulder girdle, which turns as the arm rises and
    // takes the joint inwards, and not with the skin. It lies under the skin above.
    const Vec3 bone = m_body.shoulder_joint + Vec3(0.021 + 0.005 * m_body.lift, 0, -0.0036) * h;
    pair("acromion", exit_point(m_field, bone, Vec3::UnitY()), "medium");
    pair("olecranon", exit_point(m_field, m_body.elbow, -Vec3::UnitZ()), "medium");
    // Neck base: the ring on the skin through front, side and back neck point.
    const MonotoneCurve height({0, 0.5 * units::PI, units::PI}, {yf, side.y(), yb});
    double ring = 0;
    Vec3 last = front;
    for (int k = 1; k <= 45; ++k) {
      const double angle = units::PI * k / 45, y = height.at(angle);
      const Vec3 p = exit_point(m_field, Vec3(0, y, m_neck_center.z()),
                                Vec3(std::sin(angle), 0, std::cos(angle)));
      ring += 2 * (p - last).norm();
      last = p;
    }
    m_girths["neck_base"] = ring;
    const auto near_neck = [&](const Triangle& t) {
      return (m_mesh.positions[t[0]] - m_neck_center).norm() < 0.09 * h && m_parts[t[0]] != ARM_L &&
             m_parts[t[0]] != ARM_R;
    };
    m_girths["neck"] = mesh_section(m_mesh, m_body.neck_axis_point(0.863 * h),
                                    m_body.neck_front_direction().cross(Vec3::UnitX()), near_neck)
                           .girth_m;
  }

  void armpits() {
    const Vec3 arm = (m_body.elbow - m_body.shoulder_joint).normalized();
    const double h = m_body.stature;
    // The valley between arm and trunk, seen from the shoulder joint: the nearest skin below it.
    const auto valley = [&](double z_shift) {
      Vec3 best = Vec3::Zero();
      double nearest = 1e9;
      const Vec3 from = m_body.shoulder_joint + Vec3(-0.005 * h, -0.02 * h, z_shift);
      for (double w = 0.0; w <= 1.0; w += 0.02) {
        const Vec3 d = ((1 - w) * Vec3(-0.25, -1, 0) + w * arm).normalized();
        if (m_field(from) >= 0)
          return best;
        const Vec3 p = exit_point(m_field, from, d);
        if ((p - from).norm() < nearest) {
          nearest = (p - from).norm();
          best = p;
        }
      }
      return best;
    };
    const Vec3 roof = valley(0);
    pair("axilla", roof, "medium");
    const Vec3 front = valley(0.026 * h), back = valley(-0.026 * h);
    pair("axilla_front", front.isZero() ? roof : front, "low");
    pair("axilla_back", back.isZero() ? roof : back, "low");
    m_chest_y = 0.5 * ((front.isZero() ? roof : front).y() + (back.isZero() ? roof : back).y());
  }

  void trunk_points() {
    const double h = m_body.stature;
    const auto chest = [&](int i) {
      const Vec3& p = m_mesh.positions[i];
      return p.x() > 0.01 * h && std::abs(p.y() - m_body.y_bust) < 0.05 * h && m_parts[i] == TORSO;
    };
    // A woman's: slide from the foremost vertex to the foremost point of the surface. A man's has
    // no such point: the middle of the breast muscle.
    Vec3 bust =
        m_female ? farthest(Vec3::UnitZ(), chest)
                 : exit_point(m_field, Vec3(m_body.breast_center.x(), m_body.breast_center.y(), 0),
                              Vec3::UnitZ());
    for (int k = 0; m_female && k < 60; ++k) {
      const Vec3 n = field_normal(m_field, bust);
      bust = onto_surface(m_field, bust + 0.03 * (Vec3::UnitZ() - n.z() * n), 1);
    }
    pair("bust_point", bust, m_female ? "high" : "low");
    pair("bust_prominent", bust, m_female ? "high" : "low");
    m_bust_y = bust.y();
    put("omphalion", exit_point(m_field, Vec3(0, m_body.y_omphalion, 0), Vec3::UnitZ()), "low");
    pair("waist_side", exit_point(m_field, Vec3(0, m_body.y_waist, 0.0), Vec3::UnitX()), "medium");
    // Foremost and hindmost point between waist and crotch, on 2 mm sections.
    double front = -1e9, back = 1e9;
    for (double y = m_crotch + 0.004; y < m_body.y_waist; y += 0.002) {
      const Section2 s = trunk_section(y);
      if (s.high.z() > front) {
        front = s.high.z();
        m_abdomen_y = y;
      }
      if (s.low.z() < back) {
        back = s.low.z();
        m_hip_y = y;
      }
    }
    put("abdomen_front", Vec3(0, m_abdomen_y, front), "medium", "yz");
    put("buttock_back", Vec3(0, m_hip_y, back), "high", "yz");
    put("hip_section_center", trunk_section(m_hip_y).center, "medium");
    const Section2 leg = part_section(Vec3(0, m_crotch - 0.010, 0), Vec3::UnitY(), LEG_L);
    pair("leg_top", leg.center, "medium");
    const Section2 knee = part_section(m_body.knee, Vec3::UnitY(), LEG_L);
    pair("patella", Vec3(m_body.knee.x(), m_body.knee.y(), knee.high.z()), "medium");
    const Section2 ankle = part_section(m_body.ankle, Vec3::UnitY(), LEG_L);
    pair("malleolus", Vec3(ankle.high.x(), m_body.ankle.y(), m_body.ankle.z()), "low");
  }

  void level(const std::string& name, double y, const char* trust) {
    const Section2 s = trunk_section(y);
    m_levels[name] = {{"y", y},
                      {"girth_m", s.girth_m},
                      {"width_m", s.high.x() - s.low.x()},
                      {"depth_m", s.high.z() - s.low.z()},
                      {"trust", trust},
                      {"girth_trust", trust}};
  }

  void levels() {
    level("bust", m_bust_y, m_female ? "high" : "low");
    level("chest_axilla", m_chest_y, "low");
    const double fold = m_body.y_fold;
    level("underbust", fold, "medium");
    m_levels["underbust"]["applies"] = m_female;
    m_levels["underbust"]["girth_trust"] =
        "low"; // it changes by a centimetre for two millimetres of height
    level("waist_semantic", m_body.y_waist, "medium");
    level("omphalion", m_body.y_omphalion, "low");
    level("abdomen", m_abdomen_y, "medium");
    level("hip", m_hip_y, "high");
    level("crotch", m_crotch + 0.004, "medium");
    m_levels["crotch"]["y"] = m_crotch;
    struct Sample {
      double y, girth, width;
    };
    std::vector<Sample> samples;
    const double low = 0.5 * (m_body.y_omphalion + m_crotch), high = fold - 0.005;
    for (double y = low; y <= high; y += 0.002) {
      const Section2 s = trunk_section(y);
      samples.push_back({y, s.girth_m, s.high.x() - s.low.x()});
    }
    const auto smallest = [&](const char* name, double Sample::*what, double flat,
                              double prominence) {
      std::size_t best = 0;
      for (std::size_t i = 0; i < samples.size(); ++i)
        if (samples[i].*what < samples[best].*what)
          best = i;
      level(name, samples[best].y, "high");
      double above = 0, range_low = samples[best].y, range_high = range_low;
      for (std::size_t i = best; i < samples.size(); ++i)
        above = std::max(above, samples[i].*what - samples[best].*what);
      for (std::size_t i = best;
           i < samples.size() && samples[i].*what < samples[best].*what + flat; ++i)
        range_high = samples[i].y;
      for (std::size_t i = best + 1; i-- > 0 && samples[i].*what < samples[best].*what + flat;)
        range_low = samples[i].y;
      m_levels[name]["valid"] = above >= prominence;
      m_levels[name]["y_range"] = {range_low, range_high};
    };
    smallest("waist_girth_min", &Sample::girth, 0.002, 0.003);
    smallest("waist_width_min", &Sample::width, 0.001, 0.003);
    double most = 0, at = m_crotch;
    for (double y = m_crotch + 0.004; y < m_body.y_waist; y += 0.002)
      if (const double g = trunk_section(y).girth_m; g > most) {
        most = g;
        at = y;
      }
    level("hip_girth_max", at, "high");
    double range_low = at, range_high = at;
    while (trunk_section(range_low - 0.002).girth_m > most - 0.002)
      range_low -= 0.002;
    while (trunk_section(range_high + 0.002).girth_m > most - 0.002)
      range_high += 0.002;
    m_levels["hip_girth_max"]["y_range"] = {range_low, range_high};
  }

  void girths() {
    const Vec3 up = Vec3::UnitY();
    const auto both = [&](const std::string& name, double value) {
      m_girths[name + "_l"] = value;
      m_girths[name + "_r"] = value;
    };
    both("thigh", part_section(Vec3(0, m_crotch - 0.010, 0), up, LEG_L).girth_m);
    both("knee", part_section(m_body.knee, up, LEG_L).girth_m);
    double calf = 0, calf_y = 0, thin = 1e9;
    for (double y = m_body.ankle.y(); y < m_body.knee.y(); y += 0.004)
      if (const double g = part_section(Vec3(0, y, 0), up, LEG_L).girth_m;
          y > 0.12 * m_body.stature && y < 0.26 * m_body.stature && g > calf) {
        calf = g;
        calf_y = y;
      }
    for (double y = m_body.ankle.y(); y < calf_y; y += 0.004)
      thin = std::min(thin, part_section(Vec3(0, y, 0), up, LEG_L).girth_m);
    both("calf", calf);
    both("ankle_min", thin);
    const Vec3 upper = (m_body.elbow - m_body.shoulder_joint).normalized(),
               lower = (m_body.wrist - m_body.elbow).normalized();
    both("upper_arm",
         part_section(0.5 * (m_body.shoulder_joint + m_body.elbow), upper, ARM_L).girth_m);
    both("wrist", part_section(m_body.wrist, lower, ARM_L).girth_m);
  }

  const TriangleMesh& m_mesh;
  const std::vector<unsigned char>& m_parts;
  const BodyField& m_body;
  bool m_female;
  Field m_field;
  io::Json m_landmarks, m_levels, m_girths;
  double m_crotch = 0, m_chest_y = 0, m_bust_y = 0, m_abdomen_y = 0, m_hip_y = 0;
  Vec3 m_neck_center = Vec3::Zero();
};

} // namespace

std::vector<unsigned char> vertex_parts(const TriangleMesh& mesh, const BodyField& body) {
  const double h = body.stature;
  std::vector<unsigned char> parts;
  for (const Vec3& p : mesh.positions) {
    const Vec3 left(std::abs(p.x()), p.y(), p.z());
    const bool is_left = p.x() > 0;
    // The neck's base runs down from back to front.
    const double base =
        body.y_neck_back + (body.y_neck_front - body.y_neck_back) *
                               std::clamp((p.z() + 0.05 * h) / (0.085 * h), 0.0, 1.2);
    if (p.y() > base && left.x() < 0.06 * h)
      parts.push_back(HEAD);
    else if (body.arm(left) < body.trunk(left) && left.x() > body.shoulder_joint.x() - 0.02 * h &&
             body.arm(left) < body.leg(left))
      parts.push_back(is_left ? ARM_L : ARM_R);
    else if (p.y() < 0.46 * h + 0.45 * left.x())
      parts.push_back(is_left ? LEG_L : LEG_R);
    else
      parts.push_back(TORSO);
  }
  return parts;
}

io::Json mannequin_truth(const TriangleMesh& mesh, const std::vector<unsigned char>& parts,
                         const BodyField& field, const Mannequin& shape) {
  return Truth(mesh, parts, field, shape).document(shape);
}

} // namespace sloper::samples

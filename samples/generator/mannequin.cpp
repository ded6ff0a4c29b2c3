#include "mannequin.hpp"
#include "body_field.hpp"
#include "mannequin_truth.hpp"
#include "polygonise.hpp"
#include "section.hpp"
#include <algorithm>
#include <cmath>
#include <sloper/base/error.hpp>
namespace sloper::samples {
namespace {

const Vec3 X = Vec3::UnitX(), Z = Vec3::UnitZ();

struct Preset {
  const char* name;
  const char* sex;
  double stature_m, bmi, arm_deg, leg_deg;
};
// Sex, stature in cm, and what is particular: a (A stance), t (T stance), plus, stout, slim,
// child-like proportions are not offered.
const Preset PRESETS[] = {
    {"f-160-a", "f", 1.60, 21.5, 40, 5},    {"f-165-a", "f", 1.65, 23, 35, 4},
    {"f-172-t", "f", 1.72, 22, 88, 4},      {"f-165-plus", "f", 1.65, 33, 40, 7},
    {"f-178-slim", "f", 1.78, 18.5, 30, 4}, {"m-178-a", "m", 1.78, 24, 38, 6},
    {"m-185-t", "m", 1.85, 25, 88, 6},      {"m-170-stout", "m", 1.70, 33, 42, 8},
    {"m-168-slim", "m", 1.68, 20, 30, 5}};

/// Measures the girths that the factors control, on the field.
struct Tape {
  const BodyField& body;
  double around(const Field& f, const Vec3& center, const Vec3& u, const Vec3& v,
                double reach) const {
    return field_section(f, center, u, v, reach).girth_m;
  }
  double trunk(double y) const {
    return around([this](const Vec3& p) { return body.without_arms(p); }, Vec3(0, y, 0), X, Z, 0.5);
  }
  double cage(double y) const { // trunk alone, without breasts
    return around([this](const Vec3& p) { return body.trunk_tube(p); }, Vec3(0, y, -0.01), X, Z,
                  0.5);
  }
  double leg(double y) const {
    const double t = (body.hip_joint.y() - y) * body.leg_slope;
    const Vec3 center(std::max(body.hip_joint.x(), 0.03) + t, y, 0);
    return around([this](const Vec3& p) { return body.leg(p); }, center, X, Z, 0.3);
  }
  double arm(double t) const { // t metres below the shoulder joint along the arm
    const Vec3 side = (body.from_arm(Vec3(1, 0, 0)) - body.from_arm(Vec3(0, 0, 0)));
    const double on = t / (body.upper_arm_length + body.forearm_length);
    const Vec3 center =
        body.from_arm(Vec3(0, -t, on > 0.5 ? (on - 0.5) * 2 * body.to_arm(body.wrist).z() : 0));
    return around([this](const Vec3& p) { return body.arm(p); }, center, side, Z, 0.2);
  }
  double neck() const {
    const Vec3 center = body.neck_axis_point(0.863 * body.stature);
    return around([this](const Vec3& p) { return body.without_arms(p); }, center, X,
                  body.neck_front_direction(), 0.2);
  }
};

/// Girths of the figure, m, by the names of Mannequin::girths_m.
std::map<std::string, double> taped(const BodyField& body) {
  const Tape tape{body};
  const double h = body.stature;
  return {{"neck", tape.neck()},
          {"bust", tape.trunk(body.y_bust)},
          {"underbust", tape.cage(body.y_underbust)},
          {"waist", tape.trunk(body.y_waist)},
          {"abdomen", tape.trunk(body.y_omphalion - 0.015 * h)},
          {"hip", tape.trunk(body.y_hip)},
          {"thigh", tape.leg(0.45 * h)},
          {"knee", tape.leg(body.knee.y())},
          {"calf", tape.leg(0.205 * h)},
          {"ankle", tape.leg(0.075 * h)},
          {"upper_arm", tape.arm(0.5 * body.upper_arm_length)},
          {"forearm", tape.arm(body.upper_arm_length + 0.28 * body.forearm_length)},
          {"wrist", tape.arm(body.upper_arm_length + body.forearm_length)}};
}

/// Factors under which the girths come out as asked: each girth is measured and its factor
/// corrected, a few times over.
GirthFactors fit(const Mannequin& shape, const std::map<std::string, double>& want) {
  GirthFactors g;
  const double trunk = std::sqrt(shape.bmi / 23);
  g.chest = g.underbust = g.waist = g.abdomen = g.hip = g.thigh = g.upper_arm = g.forearm = g.calf =
      trunk;
  for (int round = 0; round < 9; ++round) {
    const BodyField body(shape, g);
    const std::map<std::string, double> made = taped(body);
    const auto correct = [&](double& factor, const char* name) {
      factor = std::clamp(factor * std::pow(want.at(name) / made.at(name), 0.9), 0.4, 2.5);
    };
    correct(g.waist, "waist");
    correct(g.abdomen, "abdomen");
    correct(g.hip, "hip");
    correct(g.underbust, "underbust");
    if (shape.sex == "f") {
      // The rib cage behind the breasts is a part of the way from the girth under them to the girth
      // over them.
      const double cage = want.at("underbust") + 0.40 * (want.at("bust") - want.at("underbust"));
      const double behind = Tape{body}.cage(body.y_bust);
      g.chest = std::clamp(g.chest * std::pow(cage / behind, 0.9), 0.4, 2.5);
      g.breast_m = std::clamp(g.breast_m + 0.45 * (want.at("bust") - made.at("bust")), -0.03, 0.12);
    } else
      correct(g.chest, "bust");
    correct(g.neck, "neck");
    correct(g.thigh, "thigh");
    correct(g.knee, "knee");
    correct(g.calf, "calf");
    correct(g.ankle, "ankle");
    correct(g.upper_arm, "upper_arm");
    correct(g.forearm, "forearm");
    correct(g.wrist, "wrist");
  }
  return g;
}

void require(bool ok, const std::string& place, const std::string& fact) {
  if (!ok)
    throw Error(ErrorKind::USAGE, "option.wrong-value"_id, "", place, fact,
                "see make-mannequin --help");
}

} // namespace

std::map<std::string, double> default_girths(const Mannequin& shape) {
  // Fractions of stature at an index of 23; the exponent says how strongly a girth follows the
  // index (0.5 = like the whole).
  struct Row {
    const char* name;
    double f, m, power;
  };
  static const Row ROWS[] = {{"neck", 0.202, 0.217, 0.28},      {"bust", 0.560, 0.548, 0.50},
                             {"underbust", 0.472, 0.530, 0.46}, {"waist", 0.448, 0.472, 0.66},
                             {"abdomen", 0.505, 0.490, 0.68},   {"hip", 0.596, 0.552, 0.45},
                             {"thigh", 0.350, 0.325, 0.45},     {"knee", 0.222, 0.217, 0.35},
                             {"calf", 0.216, 0.214, 0.38},      {"ankle", 0.132, 0.130, 0.25},
                             {"upper_arm", 0.172, 0.177, 0.50}, {"forearm", 0.150, 0.157, 0.33},
                             {"wrist", 0.094, 0.098, 0.22}};
  std::map<std::string, double> girths;
  for (const Row& r : ROWS) {
    double power = r.power;
    if (shape.sex == "m" && (std::string(r.name) == "waist" || std::string(r.name) == "abdomen"))
      power += 0.12; // men gain at the belly
    girths[r.name] =
        (shape.sex == "f" ? r.f : r.m) * shape.stature_m * std::pow(shape.bmi / 23, power);
  }
  return girths;
}

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const Preset& p : PRESETS)
    names.push_back(p.name);
  return names;
}

Mannequin preset(const std::string& name) {
  for (const Preset& p : PRESETS)
    if (name == p.name) {
      Mannequin m;
      m.sex = p.sex;
      m.stature_m = p.stature_m;
      m.bmi = p.bmi;
      m.arm_deg = p.arm_deg;
      m.leg_deg = p.leg_deg;
      return m;
    }
  throw Error(ErrorKind::USAGE, "option.unknown-word"_id, "", "--preset",
              "there is no figure \"" + name + "\"" + did_you_mean(name, preset_names(), "\""),
              "see --list");
}

MadeMannequin make_mannequin(const Mannequin& shape) {
  require(shape.sex == "f" || shape.sex == "m", "--sex", "must be f or m");
  require(shape.stature_m >= 1.2 && shape.stature_m <= 2.1, "--stature",
          "must be from 1.2 to 2.1 m");
  require(shape.bmi >= 15 && shape.bmi <= 45, "--bmi", "must be from 15 to 45");
  require(shape.arm_deg >= 10 && shape.arm_deg <= 90, "--arm-deg", "must be from 10 to 90");
  require(shape.leg_deg >= 0 && shape.leg_deg <= 15, "--leg-deg", "must be from 0 to 15");
  require(shape.cell_m >= 0.006 && shape.cell_m <= 0.025, "--cell",
          "must be from 0.006 to 0.025 m");
  std::map<std::string, double> want = default_girths(shape);
  for (const auto& [name, value] : shape.girths_m) {
    require(want.count(name) == 1, "--girth", "there is no girth \"" + name + "\"");
    require(value > 0.4 * want[name] && value < 2.5 * want[name], "--girth " + name,
            "is not a girth of a person of that stature, in m");
    want[name] = value;
  }
  const BodyField body(shape, fit(shape, want));
  const Field f = [&body](const Vec3& p) { return body.all(p); };
  // The arms hang free: the wrist's inner side stays off the hips.
  for (double t : {0.5, 1.0}) {
    const Vec3 p = body.elbow + t * (body.wrist - body.elbow);
    if (body.without_arms(p) < 0.03 * shape.stature_m)
      throw Error(ErrorKind::FAILED, "sample.arms-in-flanks"_id, "", "--arm-deg",
                  "the arms would lie in the flanks", "give a larger angle or smaller girths");
  }
  const double h = shape.stature_m;
  Box3 box;
  box.add(Vec3(-(body.hand_tip.x() + 0.05 * h), -0.03, -0.14 * h - 0.08));
  box.add(Vec3(body.hand_tip.x() + 0.05 * h, 1.03 * h, 0.16 * h + 0.08));
  box.low.x() = std::min(box.low.x(), -0.25 * h);
  box.high.x() = std::max(box.high.x(), 0.25 * h);
  MadeMannequin made;
  made.mesh = polygonise(f, box, shape.cell_m);
  // Stature and floor to the last bit: polygons cut the top of the head by a fraction of a
  // millimetre.
  const Box3 real = bounding_box(made.mesh.positions);
  const double scale = h / real.size().y();
  for (Vec3& p : made.mesh.positions) {
    p.y() = (p.y() - real.low.y()) * scale;
    for (int a = 0; a < 3; ++a)
      p[a] = std::round(p[a] * 1e6) / 1e6; // micrometres: short files
  }
  made.parts = vertex_parts(made.mesh, body);
  made.truth = mannequin_truth(made.mesh, made.parts, body, shape);
  made.girths_m = taped(body);
  // The origin is below the middle of the hip joints; the figure was modelled around its trunk's
  // axis.
  const double forward = -std::round(body.hip_joint.z() * 1e6) / 1e6;
  for (Vec3& p : made.mesh.positions)
    p.z() = std::round((p.z() + forward) * 1e6) / 1e6;
  for (auto& [name, landmark] : made.truth["landmarks"].items())
    landmark["p"][2] = std::round((landmark["p"][2].get<double>() + forward) * 1e6) / 1e6;
  return made;
}

} // namespace sloper::samples

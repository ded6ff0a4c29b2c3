/// Sheets and a body: deep starts, ridges, pinches, fast bodies, layers.
#include "scene_tools.hpp"

#include <sloper/cloth/contact/self_contact.hpp>
#include <sloper/cloth/forces/gravity.hpp>
#include <sloper/cloth/forces/pins.hpp>
#include <sloper/cloth/motion/body_motion.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::hard {

namespace {

/// Where the body is at time t, for the motion that the parameters name.
struct Motion {
  std::string kind;
  double speed, distance;

  std::vector<Vec3> at(const std::vector<Vec3>& rest, double t) const {
    std::vector<Vec3> x = rest;
    if (kind == "through") { // along +z
      for (Vec3& p : x)
        p.z() += std::min(speed * t, distance);
    } else if (kind == "close") { // two halves towards each other and, after a rest of 2 s, back
      const double arrival = distance / speed, departure = arrival + 2;
      double d = distance;
      if (t < arrival)
        d = speed * t;
      else if (t >= departure)
        d = std::max(distance - speed * (t - arrival - 2), 0.0);
      for (Vec3& p : x)
        p.z() += p.z() > 0 ? -d : d;
    } else if (kind == "shake") {
      for (Vec3& p : x)
        p.x() += distance * std::sin(speed / distance * t);
    }
    return x;
  }
  bool moves() const { return kind != "none"; }
};

struct BodyState {
  double through = 0, inside = 0, deepest = 0;
};

BodyState look(const collision::BodyCollider& body, const std::vector<Vec3>& x,
               const std::vector<Triangle>& triangles) {
  BodyState s;
  s.through = static_cast<double>(body.faces_through(x, triangles).size());
  for (const Vec3& p : x)
    if (body.is_inside(p)) {
      ++s.inside;
      s.deepest = std::max(s.deepest, -body.signed_distance(p, 1).distance);
    }
  return s;
}

/// How far along the unit vector `direction` from `start` a triangle lies; negative when it is not
/// there.
double way_to(const Vec3& start, const Vec3& direction, const Vec3& a, const Vec3& b,
              const Vec3& c) {
  const Vec3 u = b - a, v = c - a, across = direction.cross(v);
  const double det = u.dot(across);
  if (std::abs(det) < 1e-18)
    return -1;
  const Vec3 from = start - a, q = from.cross(u);
  const double s = from.dot(across) / det, t = direction.dot(q) / det;
  return s < 0 || t < 0 || s + t > 1 ? -1 : v.dot(q) / det;
}

/// Particles of a layer that, seen from the body's middle, lie more than a millimetre below a place
/// of a layer that started below theirs. Layers may slide over each other, so it is that place and
/// not the like particle that counts.
double order_violations(const std::vector<Vec3>& x, const std::vector<Triangle>& triangles,
                        std::size_t layers, const Vec3& middle) {
  const std::size_t per_layer = x.size() / layers;
  double violations = 0;
  for (std::size_t i = per_layer; i < x.size(); ++i) {
    const double out = (x[i] - middle).norm();
    const Vec3 direction = (x[i] - middle) / out;
    violations += std::any_of(triangles.begin(), triangles.end(), [&](const Triangle& t) {
      return static_cast<std::size_t>(t[0]) / per_layer < i / per_layer &&
             way_to(middle, direction, x[t[0]], x[t[1]], x[t[2]]) > out + 1e-3;
    });
  }
  return violations;
}

} // namespace

Outcome contact_scene(const Parameters& p, std::uint64_t seed) {
  TriangleMesh skin = make_body_mesh(p);
  damage(skin, p.text("damage", "none"), seed);
  const bool hanging = p.text("plane", "flat") == "hanging";
  const int cells = p.whole("cells", 10), layers = p.whole("layers", 1);
  const double size = p.number("size_m", 0.2), height = p.number("height_m", 0.11),
               spacing = p.number("layer_spacing_m", 0.004);
  std::vector<double> offsets;
  for (int k = 0; k < layers; ++k)
    offsets.push_back(k * spacing);
  const Vec3 corner = hanging ? Vec3(-0.5 * size, 0.5 * size + p.number("lift_m", 0), height)
                              : Vec3(-0.5 * size, height, 0.5 * size);
  Sheet s =
      make_sheet(std::vector<double>(cells, size / cells), std::vector<double>(cells, size / cells),
                 fabric_of(p), hanging, corner, offsets);
  if (const double turn = p.number("turn_deg", 0); turn != 0)
    for (Vec3& q : s.x)
      q = Eigen::AngleAxisd(turn * M_PI / 180, Vec3::UnitY()) * q;
  jitter(s.x, p.number("jitter_m", 1e-4), seed);

  collision::BodyCollider body(skin);
  cloth::ClothSolver solver(s.mesh, s.x);
  add_models(solver, s.mesh, p);
  cloth::BodyContactOptions contact;
  contact.gap_m = p.number("contact_gap_m", 0.003);
  contact.friction = p.number("friction", 0.4);
  auto& touch = solver.emplace<cloth::BodyContactEffect>(s.mesh, body, contact);
  cloth::SelfContactEffect* self = nullptr;
  if (p.flag("self_contact", true)) {
    cloth::SelfContactOptions options;
    options.thickness_m = p.number("thickness_m", 0.002);
    self = &solver.emplace<cloth::SelfContactEffect>(s.mesh, options);
    self->set_friction(p.number("friction_self", 0));
  }
  solver.emplace<cloth::GravityEffect>(s.mesh, Vec3(0, -p.number("gravity_m_s2", 9.80665), 0));
  if (p.text("pins", "none") == "top") {
    std::vector<cloth::Pin> pins;
    for (int c = 0; c < s.columns; ++c)
      pins.push_back({s.at(c, 0), s.x[s.at(c, 0)], 1e4, Vec3::Zero()});
    solver.emplace<cloth::PinsEffect>(pins);
  }

  const Motion motion{p.text("motion", "none"), p.number("body_speed_m_s", 1),
                      p.number("body_way_m", 0.5)};
  const int substeps = p.whole("substeps", 1);
  cloth::StepOptions o;
  o.h = p.number("h", 1.0 / 30) / substeps;
  o.inertia = p.number("inertia", 0);
  o.cg_tolerance = 1e-3;
  o.line_search = p.flag("line_search", !motion.moves());
  o.largest_move_m = p.number("largest_move_m", 0.02);
  const double duration = p.number("duration_s", 2);
  const std::vector<Triangle> triangles = s.mesh.particle_triangles();
  double clean_since = -1, largest_inside = 0, rms_when_pinched = 0, still_speed = 0;
  std::vector<Vec3> before_pinch;
  Watch watch(solver, o.inertia);
  cloth::BodyMotion swept(solver, touch, body, self);
  const double there = motion.kind == "close" ? motion.distance / motion.speed : 0;
  int k = 0;
  for (double t = o.h; t < duration + 0.5 * o.h; t += o.h, ++k) {
    const std::vector<Vec3> before = solver.x();
    const auto watched = [&](const cloth::StepOptions& part) {
      cloth::StepResult r;
      r.finite = watch.step(part);
      return r;
    };
    if (!(motion.moves() ? swept.advance(motion.at(skin.positions, t), o, watched).finite
                         : watch.step(o)))
      break;
    const BodyState now = look(body, solver.x(), triangles);
    largest_inside = std::max(largest_inside, now.inside);
    if (now.through + now.inside > 0)
      clean_since = -1;
    else if (clean_since < 0)
      clean_since = t;
    double sum = 0;
    for (std::size_t i = 0; i < before.size(); ++i)
      sum += (solver.x()[i] - before[i]).squaredNorm() /
             (o.h * o.h * static_cast<double>(before.size()));
    still_speed = std::sqrt(sum);
    if (motion.kind == "close" && t < there + 2)
      rms_when_pinched = still_speed;
  }
  Outcome out;
  watch.fill(out);
  measure_cloth(out, s.mesh, solver.x());
  if (out.value["finite"] == 1) {
    const BodyState now = look(body, solver.x(), triangles);
    out.value["through"] = now.through;
    out.value["inside"] = now.inside;
    out.value["deepest_m"] = now.deepest;
    out.value["clean_since_s"] = clean_since < 0 ? 1e9 : clean_since;
    out.value["rms_speed"] = still_speed;
    out.value["rms_pinched"] = rms_when_pinched;
    // Layers, and which side of a moving or deep body the cloth is on: seen from the body's middle.
    Vec3 middle = Vec3::Zero();
    for (const Vec3& q : body.mesh().positions)
      middle += q / static_cast<double>(body.mesh().positions.size());
    const Vec3 at = solver.x()[s.at(s.columns / 2, s.rows / 2)];
    out.value["middle_ahead_m"] = hanging ? at.z() - middle.z() : at.y() - middle.y();
    out.value["order_violations"] =
        order_violations(solver.x(), triangles, static_cast<std::size_t>(layers), middle);
  }
  fingerprint(out, solver.x());
  return out;
}

} // namespace sloper::hard

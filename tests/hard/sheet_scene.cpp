/// Cloth alone: compressed, crumpled, stiff, badly meshed; pinned, pulled, blown at.
#include "scene_tools.hpp"

#include <sloper/cloth/contact/self_contact.hpp>
#include <sloper/cloth/forces/gravity.hpp>
#include <sloper/cloth/forces/pins.hpp>
#include <sloper/cloth/forces/pressure.hpp>
#include <sloper/cloth/forces/wind.hpp>
#include <sloper/cloth/linear/factorisation.hpp>

#include <Eigen/Dense>
#include <cmath>

namespace sloper::hard {

namespace {

/// A force that is no number, as an effect with a mistake would give.
class BadForce : public cloth::Effect {
public:
  explicit BadForce(int particle) : m_particle(particle) {}
  const char* name() const override { return "bad_force"; }
  void add(cloth::StepContext& c) override { c.force[m_particle].y() = std::nan(""); }

private:
  int m_particle;
};

/// A dead load on one particle: the weight of a mass without the mass.
class LoadEffect : public cloth::Effect {
public:
  LoadEffect(int particle, const Vec3& force) : m_particle(particle), m_force(force) {}
  const char* name() const override { return "load"; }
  double energy(const std::vector<Vec3>& x) const override { return -m_force.dot(x[m_particle]); }
  void add(cloth::StepContext& c) override { c.force[m_particle] += m_force; }

private:
  int m_particle;
  Vec3 m_force;
};

/// Positions of the springs under their masses' weight by the statics of a plane truss, with the
/// first row fixed: what eq. 6 of the paper gives on this mesh, without any of our solvers. Cloth
/// that buckles under the compression across is softer.
std::vector<Vec3> hung_truss(const Sheet& s, const std::vector<Vec3>& flat, double gravity) {
  const auto n = static_cast<Eigen::Index>(flat.size());
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  Eigen::VectorXd force = Eigen::VectorXd::Zero(2 * n);
  for (const cloth::EdgeSpring& e : s.mesh.springs) {
    const Vec2 along = (flat[e.j] - flat[e.i]).head<2>().normalized();
    const Eigen::Matrix2d block = e.stiffness * along * along.transpose();
    stiffness.block<2, 2>(2 * e.i, 2 * e.i) += block;
    stiffness.block<2, 2>(2 * e.j, 2 * e.j) += block;
    stiffness.block<2, 2>(2 * e.i, 2 * e.j) -= block;
    stiffness.block<2, 2>(2 * e.j, 2 * e.i) -= block;
  }
  for (Eigen::Index i = 0; i < n; ++i)
    force[2 * i + 1] = -gravity * s.mesh.mass[static_cast<std::size_t>(i)];
  const Eigen::Index fixed = 2 * s.columns, free = 2 * n - fixed;
  const Eigen::VectorXd moved =
      stiffness.bottomRightCorner(free, free).ldlt().solve(force.tail(free));
  std::vector<Vec3> x = flat;
  for (Eigen::Index k = 0; k < free; ++k)
    x[static_cast<std::size_t>((fixed + k) / 2)][k % 2] += moved[k];
  return x;
}

std::vector<cloth::Pin> make_pins(const Sheet& s, const Parameters& p) {
  const std::string which = p.text("pins", "none");
  const double k = p.number("pin_stiffness_n_m", 1e4), pull = p.number("pin_pull_m", 0);
  std::vector<cloth::Pin> pins;
  auto pin = [&](int i, const Vec3& by) { pins.push_back({i, s.x[i] + by, k, Vec3::Zero()}); };
  if (which == "top")
    for (int c = 0; c < s.columns; ++c)
      pin(s.at(c, 0), Vec3::Zero());
  if (which == "left")
    for (int r = 0; r < s.rows; ++r)
      for (int c = 0; c < 2; ++c)
        pin(s.at(c, r), Vec3::Zero());
  if (which == "corners" || which == "top_corners") {
    pin(s.at(0, 0), Vec3(-pull, 0, 0));
    pin(s.at(s.columns - 1, 0), Vec3(pull, 0, 0));
  }
  if (which == "corners") {
    pin(s.at(0, s.rows - 1), Vec3(-pull, 0, 0));
    pin(s.at(s.columns - 1, s.rows - 1), Vec3(pull, 0, 0));
  }
  if (which == "conflict") { // one particle, two places
    pin(s.at(0, 0), Vec3(-1, 0, 0));
    pin(s.at(0, 0), Vec3(1, 0, 0));
  }
  return pins;
}

/// The start: scaled, random, mirrored, or all in one point.
void spoil(Sheet& s, const Parameters& p, std::uint64_t seed) {
  const double scale = p.number("scale", 1), crumple = p.number("crumple_m", 0);
  const std::string start = p.text("start", "as_is");
  Random random(seed + 77);
  const Vec3 middle = s.x[s.at(s.columns / 2, s.rows / 2)];
  for (Vec3& q : s.x) {
    q = middle + scale * (q - middle);
    if (start == "mirrored")
      q.x() = 2 * middle.x() - q.x();
    if (start == "point")
      q = middle;
    if (crumple > 0)
      q += random_point(random, Vec3::Constant(-crumple), Vec3::Constant(crumple));
  }
  if (start == "far")
    s.x[s.at(s.columns / 2, s.rows / 2)] += Vec3(0, 100, 0);
  if (start == "nan")
    s.x[s.at(s.columns / 2, s.rows / 2)].y() = std::nan("");
}

std::vector<double> cells(int n, double length, double thin) {
  if (thin <= 0)
    return std::vector<double>(n, length / n);
  std::vector<double> out(n, (length - thin) / (n - 1));
  out[n / 2] = thin;
  return out;
}

} // namespace

Outcome sheet_scene(const Parameters& p, std::uint64_t seed) {
  const bool hanging = p.text("plane", "hanging") == "hanging";
  const int nx = p.whole("cells_x", 10), ny = p.whole("cells_y", 10);
  const double thin = p.number("thin_cell_m", 0);
  Sheet s =
      make_sheet(cells(nx, p.number("width_m", 0.3), thin), cells(ny, p.number("height_m", 0.3), 0),
                 fabric_of(p), hanging, Vec3(0, 1, 0));
  const std::vector<Vec3> flat = s.x;
  const std::vector<cloth::Pin> pins = make_pins(s, p);
  const double ratio = p.number("mass_ratio", 1), load = p.number("load_n", 0),
               width = p.number("width_m", 0.3);
  const int heavy = s.at(s.columns / 2, s.rows - 1);
  const double more_kg = (ratio - 1) * s.mesh.mass[heavy];
  // "mass", with its weight; "load", the weight alone; "inertia", the mass alone
  const std::string mass_as = p.text("mass_as", "mass");
  if (mass_as != "load")
    s.mesh.mass[heavy] += more_kg;
  for (int c = 0; c < s.columns; ++c) { // on a bar: the cells next to the edges carry half
    const double share = c == 0 || c == s.columns - 1 ? 0.5 : 1;
    s.mesh.mass[s.at(c, s.rows - 1)] += load / 9.80665 * share / (s.columns - 1);
  }
  spoil(s, p, seed);
  jitter(s.x, p.number("jitter_m", 1e-4), seed);

  cloth::ClothSolver solver(s.mesh, s.x);
  add_models(solver, s.mesh, p);
  const Vec3 gravity(0, -p.number("gravity_m_s2", 9.80665), 0);
  if (gravity.norm() > 0)
    solver.emplace<cloth::GravityEffect>(s.mesh, gravity);
  if (mass_as != "mass")
    solver.emplace<LoadEffect>(heavy, (mass_as == "load" ? more_kg : -more_kg) * gravity);
  cloth::PinsEffect* held = pins.empty() ? nullptr : &solver.emplace<cloth::PinsEffect>(pins);
  if (const double wind = p.number("wind_m_s", 0); wind != 0) {
    cloth::WindOptions options;
    options.velocity = Vec3(0.3 * wind, 0, wind);
    solver.emplace<cloth::WindEffect>(s.mesh.particle_triangles(), options);
  }
  if (const double pressure = p.number("pressure_pa", 0); pressure != 0)
    solver.emplace<cloth::PressureEffect>(s.mesh.particle_triangles(), pressure);
  if (p.flag("self_contact", false)) {
    cloth::SelfContactOptions options;
    options.thickness_m = p.number("thickness_m", 0.002);
    solver.emplace<cloth::SelfContactEffect>(s.mesh, options);
  }

  cloth::StepOptions o;
  o.h = p.number("h", 1.0 / 30);
  o.inertia = p.number("inertia", 0);
  o.cg_tolerance = p.number("cg_tolerance", 1e-3);
  if (p.flag("exact", false)) {
    solver.set_preconditioner(std::make_unique<cloth::Factorisation>());
    o.cg_tolerance = 1e-9;
  }
  o.cg_max_iterations = p.whole("cg_max_iterations", 2000);
  o.newton_iterations = p.whole("newton_iterations", 1);
  o.guard_energy = p.flag("guard_energy", false);
  o.line_search = p.flag("line_search", true);
  o.largest_move_m = p.number("largest_move_m", 0.02);
  const int steps = p.whole("steps", 60);
  const bool adapt = p.flag("adapt_h", false);
  const double swing = p.number("pin_speed_m_s", 0);
  double swung = 0;
  const int bad_step = p.whole("nan_force_step", -1);
  Watch watch(solver, o.inertia);
  for (int k = 0; k < steps; ++k) {
    if (k == bad_step)
      solver.emplace<BadForce>(s.at(s.columns / 2, s.rows / 2));
    if (held && swing != 0) {
      swung += (k / 15 % 2 ? -1 : 1) * swing * o.h;
      for (std::size_t i = 0; i < pins.size(); ++i)
        held->set_target(i, pins[i].target + Vec3(0, 0, swung));
    }
    const std::vector<Vec3> before = solver.x();
    if (!watch.step(o))
      break;
    if (!adapt)
      continue;
    double move = 0;
    for (std::size_t i = 0; i < before.size(); ++i)
      move = std::max(move, (solver.x()[i] - before[i]).norm());
    if (o.h > 0.2 && move / o.h < 1e-5)
      break;
    o.h = move < 0.005 ? std::min(1.3 * o.h, 0.5) : std::max(0.8 * o.h, 0.005);
  }
  Outcome out;
  watch.fill(out);
  measure_cloth(out, s.mesh, solver.x());
  double drop = 0;
  for (int r = 0; r < s.rows; ++r)
    drop += (flat[s.at(s.columns - 1, r)].y() - solver.x()[s.at(s.columns - 1, r)].y()) / s.rows;
  out.value["tip_drop_m"] = drop;
  if (load > 0) {
    out.value["stretch/load"] =
        out.value["stretch_p99"] / (load / (width * p.number("stretch_n_m", 1000)));
    out.value["stretch/statics"] = out.value["stretch/load"];
    if (p.text("membrane", "springs") == "springs") {
      Outcome truss;
      measure_cloth(truss, s.mesh, hung_truss(s, flat, gravity.norm()));
      out.value["stretch/statics"] = out.value["stretch_p99"] / truss.value["stretch_p99"];
    }
  }
  fingerprint(out, solver.x());
  return out;
}

/// The drop of a cantilever's end must fall as the cloth gets stiffer, decade by decade.
Outcome bending_scene(const Parameters& p, std::uint64_t seed) {
  Outcome out;
  double before = 1e300;
  bool falls = true;
  std::vector<Vec3> all;
  for (double bend = 1e-7; bend < 2e-2; bend *= 10) {
    cloth::Fabric f = fabric_of(p);
    f.bend_n_m = bend;
    Sheet s = make_sheet(cells(16, 0.16, 0), cells(3, 0.03, 0), f, false, Vec3(0, 1, 0));
    std::vector<cloth::Pin> pins;
    for (int r = 0; r < s.rows; ++r)
      for (int c = 0; c < 2; ++c)
        pins.push_back({s.at(c, r), s.x[s.at(c, r)], 1e4, Vec3::Zero()});
    jitter(s.x, p.number("jitter_m", 1e-4), seed);
    cloth::ClothSolver solver(s.mesh, s.x);
    add_models(solver, s.mesh, p);
    solver.emplace<cloth::GravityEffect>(s.mesh, Vec3(0, -9.80665, 0));
    solver.emplace<cloth::PinsEffect>(pins);
    cloth::StepOptions o;
    o.cg_tolerance = 1e-4;
    o.largest_move_m = 0.02;
    Watch watch(solver, 0);
    for (int k = 0; k < 250 && watch.step(o); ++k)
      o.h = std::min(1.1 * o.h, 0.3);
    measure_cloth(out, s.mesh, solver.x());
    double drop = 0;
    for (int r = 0; r < s.rows; ++r)
      drop += (1 - solver.x()[s.at(s.columns - 1, r)].y()) / s.rows;
    falls = falls && drop < before && drop > 0;
    if (bend < 2e-7)
      out.value["drop_soft_m"] = drop;
    out.value["drop_stiff_m"] = before = drop;
    all.insert(all.end(), solver.x().begin(), solver.x().end());
  }
  out.value["falls"] = falls;
  fingerprint(out, all);
  return out;
}

} // namespace sloper::hard

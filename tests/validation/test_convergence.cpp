/// Orders of convergence, fitted: error against time step, mesh size and CG tolerance. An order
/// that leaves its range is a mistake in the step, the mesh or the solver that no single comparison
/// shows.
#include "at_rest.hpp"
#include "figures.hpp"

#include <sloper/base/random.hpp>
#include <sloper/cloth/forces/bending.hpp>
#include <sloper/cloth/forces/edge_spring.hpp>
#include <sloper/cloth/forces/gravity.hpp>
#include <sloper/cloth/forces/membrane.hpp>
#include <sloper/cloth/forces/pins.hpp>

#include <ctime>

using namespace sloper;
using namespace sloper::cloth;

namespace {

/// Slope of log(error) over log(size) by least squares.
double order(const std::vector<double>& size, const std::vector<double>& error) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  const auto n = static_cast<double>(size.size());
  for (std::size_t i = 0; i < size.size(); ++i) {
    const double x = std::log(size[i]), y = std::log(error[i]);
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

Fabric soft() {
  Fabric f;
  f.stretch_warp_n_m = f.stretch_weft_n_m = 10;
  f.damping_s = 0;
  f.shear_n_m = 1;
  return f;
}

/// Height of the lower edge of a strip let go at t = 0, hung by its upper edge, after 0.05 s: about
/// half a swing of its own stretch.
template<class Model> double dropped(double h) {
  Sheet s = make_sheet(2, 12, 0.02, 0.025, soft());
  for (Vec3& p : s.x)
    p = Vec3(p.x(), p.z(), 0);
  ClothSolver solver(s.mesh, s.x);
  solver.emplace<Model>(s.mesh);
  solver.emplace<GravityEffect>(s.mesh, Vec3(0, -9.80665, 0));
  std::vector<Pin> pins;
  for (int c = 0; c <= s.nx; ++c)
    pins.push_back({s.at(c, 0), s.x[s.at(c, 0)], 1e4, Vec3::Zero()});
  solver.emplace<PinsEffect>(pins);
  StepOptions o;
  o.h = h;
  o.inertia = 1;
  o.cg_tolerance = 1e-10;
  o.cg_max_iterations = 5000;
  for (int k = 0, n = static_cast<int>(std::lround(0.05 / h)); k < n; ++k)
    solver.step(o);
  return solver.x()[s.at(1, s.ny)].y();
}

/// A cloth let go level, held by one edge, after three quarters of a second: it has swung through
/// and far up again on the other side.
struct Swung {
  double lower_z = 0, lower_y = 0; ///< m, of the middle of the free edge
  double gained = 0; ///< J, the largest growth of energy in a step, over what the fall sets free
  double cpu_ms = 0; ///< a step
  double distance(const Swung& o) const {
    return std::hypot(lower_z - o.lower_z, lower_y - o.lower_y);
  }
};
Swung swung(double h, int newton_iterations) {
  Fabric f;
  f.damping_s = 0;
  Sheet s = make_sheet(8, 12, 0.025, 0.025, f);
  ClothSolver solver(s.mesh, s.x);
  solver.emplace<EdgeSpringEffect>(s.mesh);
  solver.emplace<BendingEffect>(s.mesh);
  solver.emplace<GravityEffect>(s.mesh, Vec3(0, -9.80665, 0));
  std::vector<Pin> pins;
  for (int c = 0; c <= s.nx; ++c)
    pins.push_back({s.at(c, 0), s.x[s.at(c, 0)], 1e4, Vec3::Zero()});
  solver.emplace<PinsEffect>(pins);
  const auto energy = [&] {
    double sum = 0;
    for (const auto& e : solver.effects())
      sum += e->energy(solver.x());
    for (std::size_t i = 0; i < s.x.size(); ++i)
      sum += 0.5 * s.mesh.mass[i] * solver.v()[i].squaredNorm();
    return sum;
  };
  StepOptions o;
  o.h = h;
  o.inertia = 1;
  o.cg_tolerance = 1e-3;
  o.largest_move_m = 1;
  o.newton_iterations = std::max(1, newton_iterations);
  o.guard_energy = newton_iterations == 0;
  Swung result;
  double before = energy(), set_free = 0;
  for (std::size_t i = 0; i < s.x.size(); ++i)
    set_free += 9.80665 * s.mesh.mass[i] * 0.15;
  const int n = static_cast<int>(std::lround(0.75 / h));
  const std::clock_t began = std::clock();
  for (int k = 0; k < n; ++k) {
    solver.step(o);
    const double after = energy();
    result.gained = std::max(result.gained, (after - before) / set_free);
    before = after;
  }
  result.cpu_ms = 1e3 * static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC / n;
  result.lower_z = solver.x()[s.at(4, s.ny)].z();
  result.lower_y = solver.x()[s.at(4, s.ny)].y();
  return result;
}

/// Sag of a strip of n cells that hangs between two points.
double sag(int n) {
  Fabric f;
  f.stretch_warp_n_m = f.stretch_weft_n_m = 1e4;
  const double length = 0.36, span = 0.3;
  Sheet s = make_sheet(n, 1, length / n, 0.02, f);
  for (Vec3& p : s.x) { // near a parabola of that length
    const double t = p.x() / length;
    p = Vec3(span * t, -0.4 * t * (1 - t), p.z());
  }
  ClothSolver solver(s.mesh, s.x);
  solver.emplace<EdgeSpringEffect>(s.mesh);
  solver.emplace<GravityEffect>(s.mesh, Vec3(0, -9.80665, 0));
  std::vector<Pin> pins;
  for (int r = 0; r < 2; ++r)
    for (int c : {0, n})
      pins.push_back({s.at(c, r), s.x[s.at(c, r)], 1e6, Vec3::Zero()});
  solver.emplace<PinsEffect>(pins);
  EXPECT_GE(go_to_rest(solver, 1e-7, 6000), 0) << n << " cells";
  return -solver.x()[s.at(n / 2, 0)].y();
}

} // namespace

TEST(Convergence, in_the_time_step_is_of_first_order) {
  const double exact = dropped<EdgeSpringEffect>(0.05 / 1024),
               exact_fem = dropped<MembraneEffect>(0.05 / 1024);
  std::vector<double> size, error, error_fem;
  for (int n : {16, 32, 64, 128}) {
    size.push_back(0.05 / n);
    error.push_back(std::abs(dropped<EdgeSpringEffect>(size.back()) - exact));
    error_fem.push_back(std::abs(dropped<MembraneEffect>(size.back()) - exact_fem));
  }
  for (std::size_t i = 0; i < size.size(); ++i) {
    plot_point("order-time", "springs", size[i], error[i]);
    plot_point("order-time", "finite elements", size[i], error_fem[i]);
  }
  print_figure("order in the time step, edge springs", order(size, error), 1);
  print_figure("order in the time step, finite elements", order(size, error_fem), 1);
  EXPECT_NEAR(order(size, error), 1, 0.25);
  EXPECT_NEAR(order(size, error_fem), 1, 0.25);
}

/// Steps of several solves gain no energy, at any length; how far they are off is what backward
/// Euler's damping takes, of first order.
TEST(Convergence, of_a_swing_in_the_time_step_and_its_solves) {
  const Swung exact = swung(0.75 / 6000, 4);
  std::vector<double> size, error;
  for (int per_second : {8, 16, 32, 60, 120, 240, 480, 960})
    for (int solves : {1, 0, 2, 8}) { // 0: one, guarded
      const Swung s = swung(1.0 / per_second, solves);
      const std::string what =
          "swing, 1/" + std::to_string(per_second) + " s, solves " + std::to_string(solves);
      print_figure(what + ": off, mm", 1e3 * s.distance(exact), 1);
      print_figure(what + ": energy gained in a step, of the fall's", s.gained, 1);
      print_figure(what + ": CPU ms a step", s.cpu_ms, 1);
      if (solves != 1) {
        EXPECT_LT(s.gained, solves == 0 ? 0.5 : 2e-3) << what; // a single solve gains up to 3900
      }
      if (solves == 8 && per_second >= 120) {
        size.push_back(1.0 / per_second);
        error.push_back(s.distance(exact));
      }
    }
  print_figure("order in the time step, a swing", order(size, error), 1);
  EXPECT_NEAR(order(size, error), 1, 0.35);
}

TEST(Convergence, in_the_mesh_is_of_second_order) {
  const double finest = sag(192);
  std::vector<double> size, error;
  for (int n : {12, 24, 48, 96}) {
    size.push_back(1.0 / n);
    error.push_back(std::abs(sag(n) - finest));
  }
  for (std::size_t i = 0; i < size.size(); ++i)
    plot_point("order-mesh", "springs", size[i], error[i]);
  print_figure("order in the mesh, sag of a hanging strip", order(size, error), 2);
  EXPECT_NEAR(order(size, error), 2, 0.35);
}

TEST(Convergence, in_the_tolerance_of_conjugate_gradients_is_of_first_order) {
  Sheet s = make_sheet(16, 16, 0.02, 0.02, Fabric{});
  Random random(3);
  for (Vec3& p : s.x)
    p +=
        Vec3{random.uniform(-1e-3, 1e-3), random.uniform(-1e-3, 1e-3), random.uniform(-1e-3, 1e-3)};
  const auto stepped = [&](double tolerance) {
    ClothSolver solver(s.mesh, s.x);
    solver.emplace<MembraneEffect>(s.mesh);
    solver.emplace<GravityEffect>(s.mesh, Vec3(0, -9.80665, 0));
    StepOptions o;
    o.cg_tolerance = tolerance;
    o.cg_max_iterations = 5000;
    o.largest_move_m = 10;
    solver.step(o);
    return solver.x();
  };
  const std::vector<Vec3> exact = stepped(1e-13);
  std::vector<double> size, error;
  for (double tolerance = 1e-1; tolerance > 5e-8; tolerance *= 0.1) {
    const std::vector<Vec3> x = stepped(tolerance);
    double sum = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
      sum += (x[i] - exact[i]).squaredNorm();
    size.push_back(tolerance);
    error.push_back(std::sqrt(sum));
  }
  for (std::size_t i = 0; i < size.size(); ++i)
    plot_point("order-cg", "finite elements", size[i], error[i]);
  print_figure("order in the CG tolerance", order(size, error), 1);
  EXPECT_NEAR(order(size, error), 1, 0.3);
}

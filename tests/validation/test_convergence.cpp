/// Orders of convergence, fitted: error against time step, mesh size and CG tolerance. An order that leaves its range is a mistake in
/// the step, the mesh or the solver that no single comparison shows.
#include "at_rest.hpp"
#include "figures.hpp"

#include <base/random.hpp>
#include <cloth/edge_spring.hpp>
#include <cloth/gravity.hpp>
#include <cloth/membrane.hpp>
#include <cloth/pins.hpp>

using namespace sloper;
using namespace sloper::cloth;

namespace {

/// Slope of log(error) over log(size) by least squares.
double order(const std::vector<double>& size, const std::vector<double>& error) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  const auto n = static_cast<double>(size.size());
  for (std::size_t i = 0; i < size.size(); ++i) {
    const double x = std::log(size[i]), y = std::log(error[i]);
    sx += x, sy += y, sxx += x * x, sxy += x * y;
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

/// Height of the lower edge of a strip let go at t = 0, hung by its upper edge, after 0.05 s: about half a swing of its own stretch.
template<class Model> double dropped(double h) {
  Sheet s = make_sheet(2, 12, 0.02, 0.025, soft());
  for (Vec3& p : s.x) p = Vec3(p.x(), p.z(), 0);
  ClothSolver solver(s.mesh, s.x);
  solver.emplace<Model>(s.mesh);
  solver.emplace<GravityEffect>(s.mesh, Vec3(0, -9.80665, 0));
  std::vector<Pin> pins;
  for (int c = 0; c <= s.nx; ++c) pins.push_back({s.at(c, 0), s.x[s.at(c, 0)], 1e4, Vec3::Zero()});
  solver.emplace<PinsEffect>(pins);
  StepOptions o;
  o.h = h;
  o.inertia = 1;
  o.cg_tolerance = 1e-10;
  o.cg_max_iterations = 5000;
  for (int k = 0, n = static_cast<int>(std::lround(0.05 / h)); k < n; ++k) solver.step(o);
  return solver.x()[s.at(1, s.ny)].y();
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
    for (int c : {0, n}) pins.push_back({s.at(c, r), s.x[s.at(c, r)], 1e6, Vec3::Zero()});
  solver.emplace<PinsEffect>(pins);
  EXPECT_GE(go_to_rest(solver, 1e-7, 6000), 0) << n << " cells";
  return -solver.x()[s.at(n / 2, 0)].y();
}

} // namespace

TEST(Convergence, in_the_time_step_is_of_first_order) {
  const double exact = dropped<EdgeSpringEffect>(0.05 / 1024), exact_fem = dropped<MembraneEffect>(0.05 / 1024);
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

TEST(Convergence, in_the_mesh_is_of_second_order) {
  const double finest = sag(192);
  std::vector<double> size, error;
  for (int n : {12, 24, 48, 96}) {
    size.push_back(1.0 / n);
    error.push_back(std::abs(sag(n) - finest));
  }
  for (std::size_t i = 0; i < size.size(); ++i) plot_point("order-mesh", "springs", size[i], error[i]);
  print_figure("order in the mesh, sag of a hanging strip", order(size, error), 2);
  EXPECT_NEAR(order(size, error), 2, 0.35);
}

TEST(Convergence, in_the_tolerance_of_conjugate_gradients_is_of_first_order) {
  Sheet s = make_sheet(16, 16, 0.02, 0.02, Fabric{});
  Random random(3);
  for (Vec3& p : s.x) p += Vec3{random.uniform(-1e-3, 1e-3), random.uniform(-1e-3, 1e-3), random.uniform(-1e-3, 1e-3)};
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
    for (std::size_t i = 0; i < x.size(); ++i) sum += (x[i] - exact[i]).squaredNorm();
    size.push_back(tolerance);
    error.push_back(std::sqrt(sum));
  }
  for (std::size_t i = 0; i < size.size(); ++i) plot_point("order-cg", "finite elements", size[i], error[i]);
  print_figure("order in the CG tolerance", order(size, error), 1);
  EXPECT_NEAR(order(size, error), 1, 0.3);
}

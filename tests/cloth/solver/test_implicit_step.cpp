/// The way to rest: with momentum and without.
#include <support/grid.hpp>

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <sloper/cloth/forces/bending.hpp>
#include <sloper/cloth/forces/edge_spring.hpp>
#include <sloper/cloth/forces/gravity.hpp>
#include <sloper/cloth/forces/pins.hpp>
#include <sloper/cloth/solver/implicit_step.hpp>

using namespace sloper;
using namespace sloper::cloth;

namespace {

struct Rest {
  int steps = 0;
  double energy = 0;
  bool reached = false;
};

/// A square of 40 cm on three pins: its near corners `inset` inwards of where they lie flat, the
/// middle of its far edge where it was. Without an inset it only bends; with one it folds, and
/// folds wander along it.
Rest come_to_rest(double inset, bool momentum, bool whole = false) {
  const int n = 32;
  Grid cloth = make_grid(n, 0.4);
  for (Vec3& p : cloth.x)
    p.y() += 0.004 * std::sin(40 * p.x()) * std::cos(23 * p.z());
  ClothSolver solver(cloth.mesh, cloth.x);
  auto& springs = solver.emplace<EdgeSpringEffect>(cloth.mesh);
  auto& bending = solver.emplace<BendingEffect>(cloth.mesh);
  auto& gravity = solver.emplace<GravityEffect>(cloth.mesh, Vec3(0, -9.81, 0));
  solver.emplace<PinsEffect>(std::vector<Pin>{{0, cloth.x[0] + Vec3(inset, 0, 0)},
                                              {n - 1, cloth.x[n - 1] - Vec3(inset, 0, 0)},
                                              {n * (n - 1) + n / 2, cloth.x[n * (n - 1) + n / 2]}});
  StepOptions options;
  options.cg_tolerance = 0.03;
  options.line_search = true;
  options.momentum = momentum;
  options.full_hessian_near_rest = whole;
  Rest rest;
  while (!rest.reached && ++rest.steps < 2000) {
    const StepResult step = solver.step(options);
    rest.reached = step.residual_force_ratio_max < 0.01;
    options.h =
        step.halvings > 0 ? std::max(0.7 * options.h, 0.01) : std::min(1.3 * options.h, 1e3);
  }
  rest.energy =
      springs.energy(solver.x()) + bending.energy(solver.x()) + gravity.energy(solver.x());
  return rest;
}

struct Rests {
  Rest without, with;
};

Rests compare(double inset) {
  const Rests rests{come_to_rest(inset, false), come_to_rest(inset, true)};
  EXPECT_TRUE(rests.without.reached && rests.with.reached);
  testing::Test::RecordProperty("steps_without", rests.without.steps);
  testing::Test::RecordProperty("steps_with", rests.with.steps);
  return rests;
}

} // namespace

namespace {

/// A spring from every particle to where it shall be, in whose matrix hardly more than half of its
/// stiffness is: whole steps go beyond the rest by nearly as much as they began before it.
class HalfKnownSpring : public Effect {
public:
  explicit HalfKnownSpring(std::vector<Vec3> home) : m_home(std::move(home)) {}
  const char* name() const override { return "half_known_spring"; }
  void add(StepContext& c) override {
    for (std::size_t i = 0; i < m_home.size(); ++i) {
      c.force[i] += m_home[i] - c.x[i];
      c.stiffness.add_isotropic_diagonal(static_cast<int>(i), 0.502);
    }
  }
  double energy(const std::vector<Vec3>& x) const override {
    double sum = 0;
    for (std::size_t i = 0; i < m_home.size(); ++i)
      sum += 0.5 * (x[i] - m_home[i]).squaredNorm();
    return sum;
  }

private:
  std::vector<Vec3> m_home;
};

/// Particle 0 is pressed to y = 0 from both sides by 1 N, or as hard as is said, of which the
/// matrix knows nothing: each whole step goes far beyond.
class Wedge : public Effect {
public:
  explicit Wedge(double press = 1) : m_press(press) {}
  const char* name() const override { return "wedge"; }
  void add(StepContext& c) override {
    c.force[0].y() -= std::copysign(m_press, c.x[0].y());
    c.stiffness.add_isotropic_diagonal(0, 1);
  }
  double energy(const std::vector<Vec3>& x) const override { return m_press * std::abs(x[0].y()); }

private:
  double m_press; // N
};

} // namespace

TEST(LineSearch, does_not_wait_for_a_particle_that_is_wedged) {
  const Grid cloth = make_grid(6, 0.1);
  std::vector<Vec3> start = cloth.x;
  for (Vec3& p : start)
    p.y() += 0.001;
  ClothSolver solver(cloth.mesh, start);
  auto& spring = solver.emplace<HalfKnownSpring>(cloth.x);
  solver.emplace<Wedge>();
  StepOptions options;
  options.h = 100;
  options.line_search = true;
  const double before = spring.energy(start);
  for (int k = 0; k < 20; ++k)
    solver.step(options);
  EXPECT_LT(spring.energy(solver.x()), 1e-2 * before);
}

TEST(LineSearch, solves_for_the_others_as_exactly_as_if_none_were_wedged) {
  const auto steps_to_rest = [](double press) {
    const int n = 32;
    Grid cloth = make_grid(n, 0.4);
    for (Vec3& p : cloth.x)
      p.y() += 0.004 * std::sin(40 * p.x()) * std::cos(23 * p.z());
    ClothSolver solver(cloth.mesh, cloth.x);
    solver.emplace<EdgeSpringEffect>(cloth.mesh);
    solver.emplace<BendingEffect>(cloth.mesh);
    solver.emplace<GravityEffect>(cloth.mesh, Vec3(0, -9.81, 0));
    solver.emplace<PinsEffect>(
        std::vector<Pin>{{0, cloth.x[0]},
                         {n - 1, cloth.x[n - 1]},
                         {n * (n - 1) + n / 2, cloth.x[n * (n - 1) + n / 2]}});
    if (press > 0)
      solver.emplace<Wedge>(press);
    StepOptions options;
    options.h = 0.2;
    options.line_search = true;
    options.cg_tolerance = 0.01;
    options.cg_energy_tolerance = 0.05;
    int calm = 0, steps = 0;
    while (calm < 3 && ++steps < 1000) {
      const StepResult step = solver.step(options);
      calm = step.residual_force_ratio < 0.05 && step.largest_move_m < 1e-4 ? calm + 1 : 0;
    }
    return steps;
  };
  const int alone = steps_to_rest(0);
  const int beside_a_wedge = steps_to_rest(20);
  EXPECT_LT(alone, 1000);
  EXPECT_LT(beside_a_wedge, 2 * alone);
}

TEST(LineSearch, lets_go_of_a_wedged_particle_when_asked) {
  const Grid cloth = make_grid(6, 0.1);
  std::vector<Vec3> start = cloth.x;
  for (Vec3& p : start)
    p.y() += 0.001;
  ClothSolver solver(cloth.mesh, start);
  solver.emplace<HalfKnownSpring>(cloth.x);
  Effect& wedge = solver.emplace<Wedge>();
  EXPECT_FALSE(solver.release_blocked_particles()) << "nothing was kept in place yet";
  StepOptions options;
  options.h = 100;
  options.line_search = true;
  for (int k = 0; k < 20; ++k)
    solver.step(options);
  solver.remove(wedge); // what wedged it is gone, and the search does not know
  solver.emplace<PinsEffect>(std::vector<Pin>{{0, cloth.x[0] + Vec3(0, 0.01, 0)}});
  solver.step(options);
  EXPECT_LT(solver.x()[0].y(), 2e-4);
  EXPECT_TRUE(solver.release_blocked_particles());
  EXPECT_FALSE(solver.release_blocked_particles()) << "all was let go";
  solver.step(options);
  EXPECT_GT(solver.x()[0].y(), 0.005);
}

TEST(LineSearch, ends_the_to_and_fro_of_steps_that_each_take_the_last_one_back) {
  const Grid cloth = make_grid(4, 0.1);
  std::vector<Vec3> start = cloth.x;
  for (Vec3& p : start)
    p.y() += 0.001;
  for (bool momentum : {false, true}) {
    ClothSolver solver(cloth.mesh, start);
    auto& spring = solver.emplace<HalfKnownSpring>(cloth.x);
    StepOptions options;
    options.h = 100;
    options.line_search = true;
    options.momentum = momentum;
    const double before = spring.energy(start);
    for (int k = 0; k < 12; ++k)
      solver.step(options);
    EXPECT_LT(spring.energy(solver.x()), 1e-3 * before); // 0.83 without
  }
}

TEST(WholeStiffness, takes_folds_to_rest_in_fewer_steps_and_no_worse_a_rest) {
  int with_steps = 0, without_steps = 0;
  for (double inset : {0.03, 0.04, 0.05, 0.06, 0.07, 0.08}) {
    const Rest without = come_to_rest(inset, true), with = come_to_rest(inset, true, true);
    EXPECT_TRUE(with.reached);
    EXPECT_LT(with.energy, without.energy + 0.02 * std::abs(without.energy))
        << "folds may come to lie otherwise";
    with_steps += with.steps;
    without_steps += without.steps;
  }
  EXPECT_LT(with_steps, 0.95 * without_steps) << with_steps << " against " << without_steps;
}

TEST(Momentum, takes_cloth_that_folds_to_rest_in_fewer_steps_and_no_worse_a_rest) {
  int with_steps = 0, without_steps = 0; // of single ones, between 0.6 and 1.3 times as many
  for (double inset : {0.03, 0.04, 0.05, 0.06, 0.07, 0.08}) {
    const auto [without, with] = compare(inset);
    with_steps += with.steps;
    without_steps += without.steps;
    EXPECT_LT(with.energy, without.energy + 0.02 * std::abs(without.energy))
        << "folds may come to lie otherwise";
  }
  EXPECT_LT(with_steps, 0.95 * without_steps) << with_steps << " against " << without_steps;
}

TEST(Momentum, is_let_go_where_newton_steps_alone_go_straight_to_rest) {
  const auto [without, with] = compare(0);
  EXPECT_LE(with.steps, 2 * without.steps) << with.steps << " against " << without.steps;
  EXPECT_NEAR(with.energy, without.energy, 2e-3 * std::abs(without.energy))
      << "ripples of the start may lie otherwise: rests 0.15 % apart are known";
}

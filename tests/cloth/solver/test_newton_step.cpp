/// Steps with inertia in several solves: the minimum of the incremental potential, which is
/// backward Euler.
#include <support/grid.hpp>

#include <gtest/gtest.h>
#include <sloper/cloth/contact/body_contact.hpp>
#include <sloper/cloth/contact/self_contact.hpp>
#include <sloper/cloth/forces/bending.hpp>
#include <sloper/cloth/forces/edge_spring.hpp>
#include <sloper/cloth/forces/gravity.hpp>
#include <sloper/cloth/forces/pins.hpp>
#include <sloper/cloth/forces/shear.hpp>
#include <sloper/cloth/solver/implicit_step.hpp>

namespace sloper::cloth {
namespace {

const Vec3 GRAVITY(0, -9.80665, 0);

Fabric fabric_with(double damping_s) {
  Fabric f;
  f.damping_s = damping_s;
  return f;
}

/// A flat cloth, held by two corners, about to fall.
struct Swing {
  Grid grid;
  ClothSolver solver;
  explicit Swing(double damping_s, bool held = true)
      : grid(make_grid(9, 0.3, fabric_with(damping_s))), solver(grid.mesh, grid.x) {
    solver.emplace<EdgeSpringEffect>(grid.mesh);
    solver.emplace<ShearEffect>(grid.mesh);
    solver.emplace<BendingEffect>(grid.mesh);
    if (held) {
      solver.emplace<GravityEffect>(grid.mesh, GRAVITY);
      solver.emplace<PinsEffect>(
          std::vector<Pin>{{0, grid.x[0], 1e4, Vec3::Zero()}, {8, grid.x[8], 1e4, Vec3::Zero()}});
    }
  }
  double energy() const {
    double sum = 0;
    for (const auto& e : solver.effects())
      sum += e->energy(solver.x());
    for (std::size_t i = 0; i < grid.x.size(); ++i)
      sum += 0.5 * grid.mesh.mass[i] * solver.v()[i].squaredNorm();
    return sum;
  }
};

StepOptions options_of(double h, int newton_iterations) {
  StepOptions o;
  o.h = h;
  o.inertia = 1;
  o.cg_tolerance = 1e-6;
  o.largest_move_m = 1;
  o.newton_iterations = newton_iterations;
  return o;
}

} // namespace

TEST(NewtonStep, cloth_that_turns_gains_no_energy_where_one_solve_gives_it_some) {
  for (const double h : {1.0 / 60, 1.0 / 30, 0.2}) {
    for (const double damping : {0.0, 0.02}) {
      Swing swing(damping);
      double energy = swing.energy(), farthest = 0;
      for (int k = 0; k < 60; ++k) {
        const StepResult r = swing.solver.step(options_of(h, 30));
        ASSERT_TRUE(r.finite);
        ASSERT_FALSE(r.cg.indefinite);
        ASSERT_LE(swing.energy(), energy + 1e-6)
            << "h " << h << " damping " << damping << " step " << k; // J; it falls by 0.02
        energy = swing.energy();
        for (const Vec3& p : swing.solver.x())
          farthest = std::max(farthest, -p.y());
      }
      EXPECT_GT(farthest, 0.25) << "and it swings";
    }
  }
  Swing once(0);
  double largest_gain = 0, before = once.energy();
  for (int k = 0; k < 60; ++k) {
    once.solver.step(options_of(1.0 / 30, 1));
    largest_gain = std::max(largest_gain, once.energy() - before);
    before = once.energy();
  }
  EXPECT_GT(largest_gain, 1e-3);
}

TEST(NewtonStep, a_guard_takes_more_solves_only_where_one_would_gain) {
  for (const double h : {1.0 / 240, 1.0 / 30}) {
    Swing once(0.02), guarded(0.02);
    StepOptions o = options_of(h, 1);
    int again = 0;
    double before = guarded.energy(), largest_gain = 0;
    for (int k = 0; k < 60; ++k) {
      once.solver.step(o);
      o.guard_energy = true;
      again += guarded.solver.step(o).newton_iterations > 1;
      o.guard_energy = false;
      largest_gain = std::max(largest_gain, guarded.energy() - before);
      before = guarded.energy();
      if (again == 0) {
        ASSERT_EQ(once.solver.x(), guarded.solver.x()) << "the same bits where nothing is guarded";
      }
    }
    EXPECT_LT(largest_gain, 2e-3) << h;
    EXPECT_EQ(again > 0, h > 0.01) << again;
  }
}

/// (x1 - x0 - h v0) M / h^2 = f(x1).
TEST(NewtonStep, solves_backward_euler) {
  Swing swing(0);
  const StepOptions o = options_of(1.0 / 60, 40);
  for (int k = 0; k < 12; ++k)
    swing.solver.step(o);
  const std::vector<Vec3> x0 = swing.solver.x(), v0 = swing.solver.v();
  const StepResult r = swing.solver.step(o);
  EXPECT_GT(r.newton_iterations, 1);
  EXPECT_LT(r.newton_iterations, 40);
  const std::vector<Vec3>& x = swing.solver.x();
  std::vector<Vec3> force(x.size(), Vec3::Zero());
  std::vector<ContactElement> elements;
  Couplings couplings;
  for (const auto& e : swing.solver.effects())
    e->declare(couplings);
  BlockMatrix matrix(swing.grid.mesh.n_particles, couplings);
  StepContext context{x, o.h, force, matrix, elements};
  for (const auto& e : swing.solver.effects())
    e->add(context);
  add_forces(elements, force);
  double left = 0, at_first = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double m = swing.grid.mesh.mass[i];
    left += (force[i] - m / (o.h * o.h) * (x[i] - x0[i] - o.h * v0[i])).squaredNorm();
    at_first += (m / o.h * v0[i]).squaredNorm();
    EXPECT_LT((swing.solver.v()[i] - (x[i] - x0[i]) / o.h).norm(), 1e-9);
  }
  EXPECT_LT(std::sqrt(left), 0.02 * std::sqrt(at_first));
}

TEST(NewtonStep, a_free_fall_is_one_solve) {
  Grid grid = make_grid(5, 0.1);
  ClothSolver solver(grid.mesh, grid.x);
  solver.emplace<EdgeSpringEffect>(grid.mesh);
  solver.emplace<GravityEffect>(grid.mesh, GRAVITY);
  const StepOptions o = options_of(0.01, 10);
  for (int k = 1; k <= 5; ++k)
    EXPECT_EQ(solver.step(o).newton_iterations, 1);
  for (std::size_t i = 0; i < grid.x.size(); ++i)
    EXPECT_LT((solver.x()[i] - grid.x[i] - 15 * o.h * o.h * GRAVITY).norm(),
              1e-7); // 1 + 2 + .. + 5
}

TEST(NewtonStep, damping_takes_no_momentum) {
  Swing free(0.05, false);
  std::vector<Vec3> x = free.grid.x, push(x.size());
  for (std::size_t i = 0; i < x.size(); ++i)
    push[i] = Vec3(0.3, 0, 0) +
              2 * Vec3(x[i].z(), 0.5 * x[i].x(), -x[i].x()); // goes, turns, and is sheared
  free.solver.shift(std::vector<Vec3>(x.size(), Vec3::Zero()), push);
  const auto momentum = [&] {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < x.size(); ++i)
      sum += free.grid.mesh.mass[i] * free.solver.v()[i];
    return sum;
  };
  const Vec3 before = momentum();
  double energy = free.energy();
  for (int k = 0; k < 20; ++k) {
    StepOptions o = options_of(1.0 / 60, 20);
    o.cg_tolerance = 1e-10;
    free.solver.step(o);
    ASSERT_LT(free.energy(), energy);
    energy = free.energy();
  }
  EXPECT_LT((momentum() - before).norm(), 1e-6 * before.norm());
}

TEST(NewtonStep, cloth_that_is_thrown_down_lies_on_the_table_and_on_itself) {
  TriangleMesh table;
  table.positions = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}, {0, -1, 0}};
  table.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  collision::BodyCollider body(table);
  Grid grid = make_grid(9, 0.2);
  for (Vec3& p : grid.x)
    p = Vec3(p.x() - 0.1, 0.03 + 0.15 * std::abs(p.x() - 0.1) + 0.02 * p.z(),
             p.z() + 0.1); // as a valley
  ClothSolver solver(grid.mesh, grid.x);
  solver.emplace<EdgeSpringEffect>(grid.mesh);
  solver.emplace<BendingEffect>(grid.mesh);
  BodyContactOptions options;
  options.friction = 0.3;
  solver.emplace<BodyContactEffect>(grid.mesh, body, options);
  SelfContactOptions cloth;
  cloth.friction = 0.3;
  solver.emplace<SelfContactEffect>(grid.mesh, cloth);
  solver.emplace<GravityEffect>(grid.mesh, GRAVITY);
  solver.shift(std::vector<Vec3>(grid.x.size(), Vec3::Zero()),
               std::vector<Vec3>(grid.x.size(), Vec3(0, -2, 0)));
  const StepOptions o = options_of(1.0 / 60, 6);
  StepResult r;
  for (int k = 0; k < 60; ++k) {
    r = solver.step(o);
    ASSERT_TRUE(r.finite);
    for (const Vec3& p : solver.x())
      ASSERT_GT(p.y(), 0) << k;
  }
  EXPECT_LT(r.largest_move_m, 2e-4);
}

/// Effects that look back at the last step do so once a step, however often it is solved.
TEST(NewtonStep, a_step_begins_once) {
  class Counts : public Effect {
  public:
    const char* name() const override { return "counts"; }
    void begin_step(const std::vector<Vec3>&, double) override { ++begun; }
    void end_step(const std::vector<Vec3>&) override { ++ended; }
    void add(StepContext&) override { ++added; }
    int begun = 0, ended = 0, added = 0;
  };
  for (const int solves : {1, 20}) {
    Swing swing(0);
    auto& counts = swing.solver.emplace<Counts>();
    StepOptions o = options_of(0.1, solves);
    o.guard_energy = true;
    for (int k = 0; k < 10; ++k)
      swing.solver.step(o);
    EXPECT_EQ(counts.begun, 10);
    EXPECT_EQ(counts.ended, 10);
    EXPECT_GT(counts.added, 20);
  }
}

TEST(NewtonStep, what_is_no_number_moves_nothing) {
  class BadForce : public Effect {
  public:
    const char* name() const override { return "bad_force"; }
    void add(StepContext& c) override { c.force[3].x() = std::nan(""); }
  };
  class BadStiffness : public Effect {
  public:
    const char* name() const override { return "bad_stiffness"; }
    void add(StepContext& c) override { c.stiffness.add_isotropic_diagonal(3, std::nan("")); }
  };
  const auto moves_nothing = [](Swing& swing) {
    const std::vector<Vec3> before = swing.solver.x();
    for (const int solves : {1, 5}) {
      EXPECT_FALSE(swing.solver.step(options_of(1.0 / 60, solves)).finite);
      EXPECT_EQ(swing.solver.x(), before);
    }
  };
  Swing force(0.02), stiffness(0.02);
  force.solver.emplace<BadForce>();
  moves_nothing(force);
  stiffness.solver.emplace<BadStiffness>();
  moves_nothing(stiffness);
}

} // namespace sloper::cloth

#include "grid.hpp"

#include <cloth/body_motion.hpp>
#include <cloth/edge_spring.hpp>
#include <cloth/gravity.hpp>
#include <gtest/gtest.h>

using namespace sloper;
using namespace sloper::cloth;

namespace {

/// A flat slab with its upper side at y = 0, `half` m to each side, of `n` cells.
TriangleMesh slab(double half, int n) {
  TriangleMesh m;
  const int row = n + 1;
  for (int side = 0; side < 2; ++side)
    for (int r = 0; r <= n; ++r)
      for (int c = 0; c <= n; ++c) m.positions.emplace_back(half * (2.0 * c / n - 1), side ? -0.05 : 0.0, half * (2.0 * r / n - 1));
  const int below = row * row;
  for (int r = 0; r < n; ++r)
    for (int c = 0; c < n; ++c) {
      const int a = r * row + c, b = a + 1, d = a + row, e = d + 1;
      m.triangles.push_back({a, d, b}), m.triangles.push_back({b, d, e});
      m.triangles.push_back({below + a, below + b, below + d}), m.triangles.push_back({below + b, below + e, below + d});
    }
  for (int k = 0; k < n; ++k) { // walls
    const auto wall = [&](int p, int q) { m.triangles.push_back({p, q, below + p}), m.triangles.push_back({q, below + q, below + p}); };
    wall(k, k + 1), wall(n * row + k + 1, n * row + k), wall((k + 1) * row, k * row), wall(k * row + n, (k + 1) * row + n);
  }
  return m;
}

Grid lifted(Grid g) {
  for (Vec3& p : g.x) p += Vec3(-0.05, 0.004, 0.05);
  return g;
}

struct Table {
  TriangleMesh skin = slab(0.2, 10);
  collision::BodyCollider body{skin};
  Grid grid = lifted(make_grid(8, 0.1)); // a cloth of 0.1 m, 4 mm above
  ClothSolver solver{grid.mesh, grid.x};
  BodyContactEffect* contact = nullptr;
  explicit Table(double friction) {
    solver.emplace<EdgeSpringEffect>(grid.mesh);
    BodyContactOptions options;
    options.friction = friction;
    contact = &solver.emplace<BodyContactEffect>(grid.mesh, body, options);
    solver.emplace<GravityEffect>(grid.mesh, Vec3(0, -9.80665, 0));
  }
  std::vector<Vec3> moved(const Vec3& by) const {
    std::vector<Vec3> x = skin.positions;
    for (Vec3& p : x) p += by;
    return x;
  }
  Vec3 middle() const {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& p : solver.x()) sum += p / static_cast<double>(solver.x().size());
    return sum;
  }
};

} // namespace

TEST(BodyMotion, a_body_that_stands_still_takes_one_step_and_changes_no_bit) {
  Table a(0.4), b(0.4);
  BodyMotion motion(a.solver, *a.contact, a.body);
  StepOptions o;
  o.inertia = 1;
  for (int k = 0; k < 20; ++k) {
    motion.advance(a.skin.positions, o);
    b.solver.step(o);
  }
  for (std::size_t i = 0; i < a.solver.x().size(); ++i) EXPECT_EQ((a.solver.x()[i] - b.solver.x()[i]).norm(), 0) << i;
  EXPECT_EQ(motion.parts, 20);
}

TEST(BodyMotion, cloth_on_a_table_that_is_carried_slowly_goes_with_it_by_friction) {
  Table t(0.6);
  BodyMotion motion(t.solver, *t.contact, t.body);
  StepOptions o;
  o.inertia = 1;
  o.cg_tolerance = 1e-6;
  for (int k = 0; k < 30; ++k) motion.advance(t.skin.positions, o);
  const Vec3 before = t.middle();
  for (int k = 1; k <= 60; ++k) motion.advance(t.moved(Vec3(0.05 * k / 60, 0.02 * k / 60, 0)), o);
  EXPECT_NEAR(t.middle().x() - before.x(), 0.05, 0.002);
  EXPECT_NEAR(t.middle().y() - before.y(), 0.02, 0.002);
}

TEST(BodyMotion, a_table_that_is_thrown_up_takes_all_cloth_with_it_and_passes_none) {
  for (double inertia : {0.0, 1.0}) {
    const double speed = inertia > 0 ? 2 : 10;
    Table t(0.3);
    BodyMotion motion(t.solver, *t.contact, t.body);
    StepOptions o;
    o.inertia = inertia;
    o.h = 1.0 / 60;
    o.largest_move_m = 1;
    for (int k = 1; k <= 4; ++k) {
      ASSERT_TRUE(motion.advance(t.moved(Vec3(0, speed * o.h * k, 0)), o).finite);
      for (const Vec3& p : t.solver.x()) ASSERT_GT(p.y(), speed * o.h * k) << "inertia " << inertia << " step " << k;
    }
    EXPECT_EQ(motion.forced, 0);
  }
}

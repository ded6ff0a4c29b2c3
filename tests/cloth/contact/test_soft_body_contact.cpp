/// The smooth force that keeps coarse cloth off a body.
#include <gtest/gtest.h>
#include <sloper/cloth/contact/soft_body_contact.hpp>
#include <support/force_checks.hpp>

using namespace sloper;
using namespace sloper::cloth;

namespace {

constexpr double LEVEL = 0.02; // m: the sheet above the middle of the floor's top

/// A closed block with its top at y = 0.
TriangleMesh block() {
  TriangleMesh mesh;
  for (int k = 0; k < 8; ++k)
    mesh.positions.emplace_back(k & 1 ? 1 : -1, k & 2 ? 0 : -0.5, k & 4 ? 1 : -1);
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// A sheet of 3 by 3 particles over a body, with the effect bound.
struct Sheet {
  explicit Sheet(const TriangleMesh& skin, double reach = LEVEL)
      : body(skin), effect(grid.mesh, body, {.reach_m = reach, .stiffness_n_m3 = 1e4}),
        matrix(grid.mesh.n_particles, couplings_of(effect)) {
    effect.bind(matrix);
  }

  static Couplings couplings_of(SoftBodyContactEffect& effect) {
    Couplings couplings;
    effect.declare(couplings);
    return couplings;
  }

  /// The forces on the particles with the sheet level at a height (m).
  std::vector<Vec3> forces_at(double height) {
    std::vector<Vec3> x = grid.x;
    for (Vec3& p : x)
      p.y() = height;
    return force_of(effect, grid.mesh.n_particles, x, matrix);
  }

  Grid grid = make_grid(3, 0.06);
  collision::BodyCollider body;
  SoftBodyContactEffect effect;
  BlockMatrix matrix;
};

double push_at(double height) {
  double sum = 0;
  for (const Vec3& f : Sheet(block()).forces_at(height))
    sum += f.y();
  return sum;
}

} // namespace

TEST(SoftBodyContact, begins_at_its_reach_and_grows_as_its_formula_says) {
  const double area = 0.06 * 0.06, k = 1e4;
  EXPECT_EQ(push_at(1.01 * LEVEL), 0);
  EXPECT_NEAR(push_at(0.5 * LEVEL), k * area * 0.25 * LEVEL * LEVEL / (2 * LEVEL), 1e-9);
  EXPECT_NEAR(push_at(-0.01), k * area * (LEVEL + 0.01 - 0.5 * LEVEL), 1e-9)
      << "below the skin it grows by the depth";
}

TEST(SoftBodyContact, its_matrix_is_the_change_of_its_force) {
  Grid grid = make_grid(4, 0.06);
  const collision::BodyCollider body(block());
  SoftBodyContactEffect effect(grid.mesh, body, {.reach_m = LEVEL, .stiffness_n_m3 = 1e4});
  for (Vec3& p : grid.x)
    p.y() = 0.4 * LEVEL;
  expect_jacobian(effect, grid.mesh, jittered(grid.x, 0.001, 3), 1e-4);
}

TEST(SoftBodyContact, a_skin_that_came_nearer_is_looked_for_again) {
  Sheet sheet(block());
  EXPECT_EQ(sheet.forces_at(2 * LEVEL)[4].y(), 0);
  std::vector<Vec3> skin = sheet.body.mesh().positions;
  for (Vec3& p : skin)
    p.y() += 1.5 * LEVEL;
  sheet.body.set_positions(skin);
  sheet.effect.body_moved(1.5 * LEVEL);
  EXPECT_GT(sheet.forces_at(2 * LEVEL)[4].y(), 0);
}

TEST(SoftBodyContact, cloth_that_went_far_into_the_body_since_it_was_seen_outside_is_pushed_out) {
  Sheet sheet(block());
  for (const double height : {0.3, 0.1, -0.1, -0.15})
    EXPECT_EQ(sheet.forces_at(height)[4].y() > 0, height < 0) << height;
}

TEST(SoftBodyContact, a_thumb_below_the_middle_of_a_face_is_felt_there) {
  const Grid grid = make_grid(3, 0.06);
  const Triangle t = grid.mesh.particle_triangles()[0];
  TriangleMesh thumb = block();
  for (Vec3& p : thumb.positions) {
    p *= 0.004;
    for (int i : t)
      p += Vec3(grid.x[i].x(), 0, grid.x[i].z()) / 3;
  }
  const std::vector<Vec3> force = Sheet(thumb, 0.005).forces_at(0.002);
  for (int i : t)
    EXPECT_GT(force[i].y(), 0);
}

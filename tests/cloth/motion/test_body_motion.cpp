#include <support/grid.hpp>

#include <gtest/gtest.h>
#include <sloper/base/random.hpp>
#include <sloper/cloth/contact/self_contact.hpp>
#include <sloper/cloth/forces/edge_spring.hpp>
#include <sloper/cloth/forces/gravity.hpp>
#include <sloper/cloth/motion/body_motion.hpp>
#include <sloper/collision/intersections.hpp>

using namespace sloper;
using namespace sloper::cloth;

namespace {

/// A flat slab with its upper side at y = 0, `half` m to each side, of `n` cells.
TriangleMesh slab(double half, int n) {
  TriangleMesh m;
  const int row = n + 1;
  for (int side = 0; side < 2; ++side)
    for (int r = 0; r <= n; ++r)
      for (int c = 0; c <= n; ++c)
        m.positions.emplace_back(half * (2.0 * c / n - 1), side ? -0.05 : 0.0,
                                 half * (2.0 * r / n - 1));
  const int below = row * row;
  for (int r = 0; r < n; ++r)
    for (int c = 0; c < n; ++c) {
      const int a = r * row + c, b = a + 1, d = a + row, e = d + 1;
      m.triangles.push_back({a, d, b});
      m.triangles.push_back({b, d, e});
      m.triangles.push_back({below + a, below + b, below + d});
      m.triangles.push_back({below + b, below + e, below + d});
    }
  for (int k = 0; k < n; ++k) { // walls
    const auto wall = [&](int p, int q) {
      m.triangles.push_back({p, q, below + p});
      m.triangles.push_back({q, below + q, below + p});
    };
    wall(k, k + 1);
    wall(n * row + k + 1, n * row + k);
    wall((k + 1) * row, k * row);
    wall(k * row + n, (k + 1) * row + n);
  }
  return m;
}

Grid lifted(Grid g) {
  for (Vec3& p : g.x)
    p += Vec3(-0.05, 0.004, 0.05);
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
    for (Vec3& p : x)
      p += by;
    return x;
  }
  Vec3 middle() const {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& p : solver.x())
      sum += p / static_cast<double>(solver.x().size());
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
  for (std::size_t i = 0; i < a.solver.x().size(); ++i)
    EXPECT_EQ((a.solver.x()[i] - b.solver.x()[i]).norm(), 0) << i;
  EXPECT_EQ(motion.parts, 20);
}

TEST(BodyMotion, cloth_on_a_table_that_is_carried_slowly_goes_with_it_by_friction) {
  Table t(0.6);
  BodyMotion motion(t.solver, *t.contact, t.body);
  StepOptions o;
  o.inertia = 1;
  o.cg_tolerance = 1e-6;
  for (int k = 0; k < 30; ++k)
    motion.advance(t.skin.positions, o);
  const Vec3 before = t.middle();
  for (int k = 1; k <= 60; ++k)
    motion.advance(t.moved(Vec3(0.05 * k / 60, 0.02 * k / 60, 0)), o);
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
      for (const Vec3& p : t.solver.x())
        ASSERT_GT(p.y(), speed * o.h * k) << "inertia " << inertia << " step " << k;
    }
    EXPECT_EQ(motion.forced, 0);
  }
}

namespace {

/// Contact without a solver: bound to a matrix of its own.
struct BareContact {
  BodyContactEffect effect;
  BlockMatrix matrix;
  BareContact(const ClothMesh& mesh, collision::BodyCollider& body)
      : effect(mesh, body, BodyContactOptions{}) {
    Couplings couplings;
    effect.declare(couplings);
    matrix = BlockMatrix(mesh.n_particles, std::move(couplings));
    effect.bind(matrix);
  }
  double energy(const std::vector<Vec3>& x) {
    effect.begin_step(x, 1);
    std::vector<Vec3> force(x.size(), Vec3::Zero());
    std::vector<ContactElement> elements;
    matrix.set_zero();
    StepContext context{x, 1, force, matrix, elements, nullptr};
    effect.add(context);
    return effect.energy(x);
  }
};

/// Of what turns about z, and goes up.
Vec3 turning(const Vec3& p, double angle, double up) {
  return Vec3(-angle * p.y(), angle * p.x() + up, 0);
}

void add_slab(TriangleMesh& skin, const TriangleMesh& slab, const Vec3& at) {
  const int first = std::ssize(skin.positions);
  for (const Triangle& t : slab.triangles)
    skin.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  for (const Vec3& p : slab.positions)
    skin.positions.push_back(p + at);
}

} // namespace

/// What contact has found out about skin and cloth serves many parts of a motion. It must never
/// hold less than a search from anew would find.
TEST(BodyMotion, what_was_found_out_holds_where_cloth_goes_with_the_skin_beside_it) {
  TriangleMesh skin = slab(0.2, 16);
  const std::size_t below = skin.positions.size();
  add_slab(skin, slab(0.15, 9), Vec3(0.02, 0.062, 0)); // its lower side 12 mm above
  double touching = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    Random random(seed);
    const bool from_afar = seed % 4 == 0; // the skin is 3 cm off, and comes
    TriangleMesh start = skin;
    for (std::size_t v = 0; from_afar && v < skin.positions.size(); ++v)
      start.positions[v].y() += v < below ? -0.03 : 0.05;
    collision::BodyCollider body(start);
    Grid grid = make_grid(14, 0.26);
    for (Vec3& p : grid.x)
      p += Vec3(-0.13, 0.0045 + 0.0012 * random.uniform(-1, 1), 0.13);
    BareContact contact(grid.mesh, body);
    contact.energy(grid.x);
    for (int part = 0; part < 40; ++part) {
      std::vector<Vec3> displacement, predictor, positions = body.mesh().positions;
      const double lower = 0.004 * random.uniform(-1, 1), upper = 0.004 * random.uniform(-1, 1),
                   up = 0.002 * random.uniform(-1, 1), lower_up = from_afar ? 0.003 : 0;
      for (std::size_t v = 0; v < positions.size(); ++v)
        displacement.push_back(v < below ? turning(positions[v], lower, lower_up)
                                         : turning(positions[v], upper, up));
      for (const Vec3& p : grid.x) {
        const double to_side = random.uniform(-1, 1), up_or_down = random.uniform(-1, 1);
        predictor.push_back(turning(p, lower, 0) + 3e-4 * Vec3(to_side, up_or_down, 0));
      }
      const double fraction =
          contact.effect.collision_free_step_fraction(grid.x, displacement, predictor);
      ASSERT_GT(fraction, 0);
      for (std::size_t v = 0; v < positions.size(); ++v)
        positions[v] += fraction * displacement[v];
      for (Vec3& p : predictor)
        p *= fraction;
      contact.effect.move_body(positions, grid.x, predictor);
      for (std::size_t i = 0; i < grid.x.size(); ++i)
        grid.x[i] += predictor[i];
      const double kept = contact.energy(grid.x);
      BareContact anew(grid.mesh, body);
      const double found = anew.energy(grid.x);
      ASSERT_NEAR(kept, found, 1e-3 * found)
          << "seed " << seed << " part " << part; // the skin is stretched by less than that
      touching += found > 0;
      ASSERT_TRUE(body.faces_through(grid.x, grid.mesh.particle_triangles()).empty());
    }
    EXPECT_LT(contact.effect.searches, 60) << "it need not search for each part";
  }
  EXPECT_GT(touching, 100);
}

/// Parts are as long as cloth and the skin beside it go the same way, whatever other skin does.
TEST(BodyMotion, cloth_that_turns_with_its_body_goes_in_few_parts) {
  const TriangleMesh skin = slab(0.2, 16);
  collision::BodyCollider body(skin);
  Grid grid = make_grid(14, 0.26);
  for (Vec3& p : grid.x)
    p += Vec3(-0.13, 0.003, 0.13);
  ClothSolver solver(grid.mesh, grid.x);
  solver.emplace<EdgeSpringEffect>(grid.mesh);
  BodyContactOptions options;
  options.friction = 0.6;
  BodyContactEffect& contact = solver.emplace<BodyContactEffect>(grid.mesh, body, options);
  solver.emplace<GravityEffect>(grid.mesh, Vec3(0, -9.80665, 0));
  BodyMotion motion(solver, contact, body);
  StepOptions o;
  o.inertia = 1;
  o.h = 1.0 / 60;
  std::vector<Vec3> target = skin.positions;
  for (int k = 0; k < 20; ++k)
    motion.advance(target, o); // comes to lie
  motion.parts = 0;
  for (int k = 1; k <= 20; ++k) {
    const double angle = 0.002 * k * k; // corners go up to 14 mm in a step
    for (std::size_t v = 0; v < target.size(); ++v) {
      const Vec3& p = skin.positions[v];
      target[v] = Vec3(std::cos(angle) * p.x() + std::sin(angle) * p.z(), p.y(),
                       std::cos(angle) * p.z() - std::sin(angle) * p.x());
    }
    motion.advance(target, o);
  }
  EXPECT_LE(motion.parts, 80); // 167 if each were as long as the farthest skin allows
  EXPECT_EQ(motion.forced, 0);
}

/// Where cloth cannot be carried all the way that was asked for, it is asked for less; what kept
/// layers apart on the long way must do so on the short one too.
TEST(BodyMotion, layers_that_are_carried_less_far_do_not_pass_each_other) {
  constexpr int N = 9, LAYER = N * N;
  const Grid one = make_grid(N, 0.12);
  std::vector<RestTriangle> triangles = one.mesh.triangles;
  for (RestTriangle t : one.mesh.triangles) {
    for (int& v : t.particle)
      v += LAYER;
    triangles.push_back(t);
  }
  const ClothMesh mesh = make_cloth_mesh(2 * LAYER, triangles, {Fabric{}});
  const std::vector<Triangle> faces = mesh.particle_triangles();
  for (std::uint64_t seed = 1; seed <= 180; ++seed) {
    Random random(seed);
    const double low = random.uniform(0.003, 0.009), gap = random.uniform(0.0021, 0.006),
                 high = random.uniform(0.003, 0.009), rise = random.uniform(0.01, 0.06);
    const double bend = random.uniform(0, 0.05), bend_below = random.uniform(0, 0.05);
    if (bend < bend_below)
      continue;
    TriangleMesh skin = slab(0.2, 10);
    const std::size_t coming = skin.positions.size();
    add_slab(skin, slab(0.2, 10), Vec3(0, 0.05 + low + gap + high, 0)); // stays, above the layers
    collision::BodyCollider body(skin);
    std::vector<Vec3> x;
    for (int layer = 0; layer < 2; ++layer)
      for (const Vec3& p : one.x)
        x.push_back(p +
                    Vec3(-0.06,
                         low + layer * gap + (layer ? bend : bend_below) * std::abs(p.x() - 0.06),
                         0.06));
    ClothSolver solver(mesh, x);
    solver.emplace<EdgeSpringEffect>(mesh);
    BodyContactEffect& contact =
        solver.emplace<BodyContactEffect>(mesh, body, BodyContactOptions{});
    contact.set_slack(0.008);
    SelfContactEffect& self_contact = solver.emplace<SelfContactEffect>(mesh, SelfContactOptions{});
    BodyMotion motion(solver, contact, body, &self_contact);
    StepOptions o;
    o.inertia = 1;
    o.h = 1.0 / 60;
    o.largest_move_m = 1e-9;
    std::vector<Vec3> target = skin.positions;
    motion.advance(target, o); // contact knows the cloth from a first step
    for (std::size_t v = 0; v < coming; ++v)
      target[v].y() += rise;
    struct Enough {}; // of one part, before the cloth's own step
    const auto look = [&](const StepOptions&) -> StepResult {
      EXPECT_TRUE(collision::self_intersections(solver.x(), faces,
                                                collision::TriangleTree(solver.x(), faces))
                      .empty())
          << "seed " << seed;
      throw Enough{};
    };
    EXPECT_THROW(motion.advance(target, o, look), Enough);
  }
}

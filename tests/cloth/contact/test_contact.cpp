/// Contact of cloth with a body and with itself: forces against their energies, and what no step
/// may pass.
#include <support/grid.hpp>

#include <gtest/gtest.h>
#include <random>
#include <sloper/base/random.hpp>
#include <sloper/cloth/contact/body_contact.hpp>
#include <sloper/cloth/contact/contact_potential.hpp>
#include <sloper/cloth/contact/self_contact.hpp>
#include <sloper/cloth/forces/edge_spring.hpp>
#include <sloper/cloth/forces/gravity.hpp>
#include <sloper/cloth/solver/implicit_step.hpp>
#include <sloper/collision/intersections.hpp>

using namespace sloper;
using namespace sloper::cloth;

namespace {

/// A box with its top at y = 0, the top of n by n squares.
TriangleMesh table(int n, double size) {
  TriangleMesh m;
  for (int r = 0; r <= n; ++r)
    for (int c = 0; c <= n; ++c)
      m.positions.emplace_back(size * c / n, 0, -size * r / n);
  const int top = std::ssize(m.positions);
  for (const Vec3& p :
       {Vec3(0, -0.2, 0), Vec3(size, -0.2, 0), Vec3(size, -0.2, -size), Vec3(0, -0.2, -size)})
    m.positions.push_back(p);
  for (int r = 0; r < n; ++r)
    for (int c = 0; c < n; ++c) {
      const int a = r * (n + 1) + c, b = a + 1, d = a + n + 1, e = d + 1;
      m.triangles.push_back({a, b, e});
      m.triangles.push_back({a, e, d});
    }
  auto side = [&](int low0, int low1,
                  auto at) { // a fan from the lower edge to the row of upper vertices
    for (int c = 0; c < n; ++c)
      m.triangles.push_back({at(c + 1), at(c), low0});
    m.triangles.push_back({at(n), low0, low1});
  };
  side(top, top + 1, [&](int c) { return c; });
  side(top + 1, top + 2, [&](int c) { return c * (n + 1) + n; });
  side(top + 2, top + 3, [&](int c) { return n * (n + 1) + n - c; });
  side(top + 3, top, [&](int c) { return (n - c) * (n + 1); });
  m.triangles.push_back({top, top + 2, top + 1});
  m.triangles.push_back({top, top + 3, top + 2});
  return m;
}

struct Filled {
  std::vector<Vec3> force;
  std::vector<ContactElement> elements;
  MotionLimits limits;
};

Filled fill(Effect& effect, int n, const std::vector<Vec3>& x, BlockMatrix& matrix) {
  Filled f;
  f.force.assign(n, Vec3::Zero());
  f.limits.reset(n);
  StepContext c{x, 0.1, f.force, matrix, f.elements, &f.limits};
  effect.begin_step(x, 0.1);
  effect.add(c);
  add_forces(f.elements, f.force);
  return f;
}

Filled fill_alone(Effect& effect, const Grid& grid) {
  Couplings couplings;
  effect.declare(couplings);
  BlockMatrix matrix(grid.mesh.n_particles, couplings);
  effect.bind(matrix);
  return fill(effect, grid.mesh.n_particles, grid.x, matrix);
}

double upward(const Filled& filled) {
  double sum = 0;
  for (const Vec3& f : filled.force)
    sum += f.y();
  return sum;
}

/// Edges 2 degrees from parallel share their force with vertices and faces, in a share that no
/// force tells of. @return about y by that
Vec3 turned(const Vec3& p) {
  return Eigen::AngleAxisd(0.035, Vec3::UnitY()) * p;
}

/// Force against central differences of the energy over the pairs of the last search, relative to
/// the largest force.
double gradient_error(Effect& effect, const ClothMesh& mesh, std::vector<Vec3> x) {
  Couplings couplings;
  effect.declare(couplings);
  BlockMatrix matrix(mesh.n_particles, couplings);
  effect.bind(matrix);
  const auto force = fill(effect, mesh.n_particles, x, matrix).force;
  double largest = 0, worst = 0;
  for (const Vec3& f : force)
    largest = std::max(largest, f.norm());
  const double eps = 1e-8;
  for (int i = 0; i < mesh.n_particles; ++i)
    for (int k = 0; k < 3; ++k) {
      const double at = x[i][k];
      x[i][k] = at + eps;
      const double above = effect.energy(x);
      x[i][k] = at - eps;
      const double below = effect.energy(x);
      x[i][k] = at;
      worst = std::max(worst, std::abs(-(above - below) / (2 * eps) - force[i][k]));
    }
  EXPECT_GT(largest, 0);
  return worst / largest;
}

TEST(Contact, PotentialHasTheForceAndStiffnessOfItsEnergy) {
  const double reach = 0.003, k = 40;
  for (double d : {2e-5, 1e-4, 3e-4, 8e-4, 0.0012, 0.0025, 0.0029}) {
    const double eps = 1e-5 * d;
    const ContactResponse above = evaluate_contact_potential(d + eps, reach, k),
                          at = evaluate_contact_potential(d, reach, k),
                          below = evaluate_contact_potential(d - eps, reach, k);
    EXPECT_NEAR(at.force, -(above.energy - below.energy) / (2 * eps), 1e-4 * at.force + 1e-12) << d;
    EXPECT_NEAR(at.stiffness, -(above.force - below.force) / (2 * eps), 1e-2 * at.stiffness + 1e-12)
        << d;
  }
  EXPECT_EQ(evaluate_contact_potential(reach, reach, k).force, 0);
}

TEST(Contact, ForceOfTheBodyIsTheGradientOfItsEnergy) {
  collision::BodyCollider body(table(9, 0.2));
  Grid grid = make_grid(12, 0.15);
  Random random(3);
  for (Vec3& p : grid.x)
    p = Vec3(p.x() + 0.023, 0.0012 + 0.0008 * random.uniform(-1, 1), p.z() - 0.0231);
  BodyContactEffect contact(grid.mesh, body, {});
  EXPECT_LT(gradient_error(contact, grid.mesh, grid.x), 2e-3);
  EXPECT_EQ(contact.n_crossing(), 0u);
}

TEST(Contact, NearlyParallelEdgesHaveTheEnergyOfTheirForceWithinAStep) {
  collision::BodyCollider body(table(7, 0.2));
  Grid grid = make_grid(6, 0.15);
  const Vec3 middle(0.06, 0, -0.045); // of an edge, which comes to lie along the table's edge
  for (Vec3& p : grid.x)
    p = turned(p - middle) + Vec3(0, 0.0004, -0.09);
  BodyContactOptions options;
  options.level = ContactLevel::EDGE;
  BodyContactEffect on_skin(grid.mesh, body, options);
  EXPECT_LT(gradient_error(on_skin, grid.mesh, grid.x), 2e-3);
}

TEST(Contact, EachLevelSeesWhatTheOneBeforeSeesAndMore) {
  Grid grid = make_grid(6, 0.15);
  for (Vec3& p : grid.x)
    p += Vec3(0.023, 0.0004, -0.0231);
  const TriangleMesh fine = table(40, 0.2);
  double last = 0;
  for (const ContactLevel level : {ContactLevel::VERTEX, ContactLevel::FACE,
                                   ContactLevel::CONTINUOUS}) { // flat skin has no edge to see
    collision::BodyCollider body(fine);
    BodyContactOptions options;
    options.level = level;
    BodyContactEffect contact(grid.mesh, body, options);
    const Filled filled = fill_alone(contact, grid);
    const double up = upward(filled);
    if (level == ContactLevel::CONTINUOUS)
      EXPECT_GE(up, last);
    else
      EXPECT_GT(up, 1.01 * last) << static_cast<int>(level);
    EXPECT_EQ(filled.limits.planes.empty(), level != ContactLevel::CONTINUOUS);
    last = up;
  }
}

TEST(Contact, EdgesOfAnEdgedBodyAreSeenAtTheEdgeLevelOnly) {
  Grid grid = make_grid(6, 0.15); // the table's own edge runs under the middle of the cloth's
  for (Vec3& p : grid.x)
    p += Vec3(-0.0647, 0.0004, -0.0231);
  std::vector<double> up;
  for (const ContactLevel level : {ContactLevel::FACE, ContactLevel::EDGE}) {
    collision::BodyCollider body(table(7, 0.2));
    BodyContactOptions options;
    options.level = level;
    BodyContactEffect contact(grid.mesh, body, options);
    up.push_back(upward(fill_alone(contact, grid)));
  }
  EXPECT_GT(up[1], 1.01 * up[0]);
}

TEST(Contact, ForceOfClothOnItselfIsTheGradientOfItsEnergy) {
  Grid a = make_grid(8, 0.1); // folded: the second half turned over onto the first
  Random random(4);
  for (Vec3& p : a.x) {
    if (p.x() > 0.05) {
      p.x() = 0.1 - p.x() + 0.0037;
      p.y() = 0.0016;
    }
    p.z() += p.y() > 0 ? 0.003 : 0;
    p.y() += 0.0003 * random.uniform(-1, 1);
  }
  SelfContactEffect contact(a.mesh, {});
  EXPECT_LT(gradient_error(contact, a.mesh, a.x), 2e-3);
  for (Vec3& p : a.x)
    if (p.y() > 0.001)
      p = turned(p); // over edges that it nearly runs along
  SelfContactEffect along(a.mesh, {});
  EXPECT_LT(gradient_error(along, a.mesh, a.x), 2e-3);
}

TEST(Contact, WhateverTheForceNoStepPassesTheSkin) {
  collision::BodyCollider body(table(7, 0.2));
  Grid grid = make_grid(14, 0.26); // hangs over all four edges of the table
  for (Vec3& p : grid.x)
    p += Vec3(-0.03, 0.004, 0.03);
  ClothSolver solver(grid.mesh, grid.x);
  solver.emplace<EdgeSpringEffect>(grid.mesh);
  solver.emplace<GravityEffect>(grid.mesh, Vec3(0, -2000, 0)); // two hundred times its weight
  auto& contact = solver.emplace<BodyContactEffect>(grid.mesh, body, BodyContactOptions{});
  StepOptions options;
  options.h = 0.2;
  for (int k = 0; k < 150; ++k) {
    const StepResult result = solver.step(options);
    ASSERT_TRUE(result.finite);
    ASSERT_TRUE(body.faces_through(solver.x(), grid.mesh.particle_triangles()).empty())
        << "step " << k;
  }
  EXPECT_GT(contact.searches, 0);
}

/// Pairs that are too far apart to repel are left out of a step, until the cloth comes nearer or is
/// about to.
TEST(Contact, WhatIsNotLookedAtIsNeitherFeltNorPassed) {
  collision::BodyCollider body(table(7, 0.2));
  Grid grid = make_grid(10, 0.15);
  for (Vec3& p : grid.x)
    p += Vec3(0.02, 0.0045, -0.02); // seen, but beyond the reach
  BodyContactEffect contact(grid.mesh, body, {});
  Filled filled = fill_alone(contact, grid); // the search has told how far off all pairs are
  EXPECT_TRUE(filled.limits.planes.empty());

  std::vector<Vec3> low = grid.x;
  for (Vec3& p : low)
    p.y() = 0.0025; // no farther than pairs are seen ahead
  BodyContactEffect there(grid.mesh, body, {});
  Grid lowered = grid;
  lowered.x = low;
  fill_alone(there, lowered);
  EXPECT_GT(there.energy(low), 0);
  EXPECT_NEAR(contact.energy(low), there.energy(low), 1e-12 * there.energy(low));

  std::vector<Vec3> dx(grid.x.size(), Vec3(0, -0.001, 0));
  EXPECT_FALSE(contact.add_separating_planes(grid.x, dx, filled.limits, false))
      << "far too short to reach the skin";
  dx.assign(grid.x.size(), Vec3(0, -0.03, 0));
  EXPECT_TRUE(contact.add_separating_planes(grid.x, dx, filled.limits, false));
  filled.limits.max_displacement.assign(grid.x.size(), 1); // of planes alone
  std::vector<char> held(grid.x.size(), 0);
  filled.limits.apply(grid.x, dx, held);
  for (std::size_t i = 0; i < dx.size(); ++i)
    EXPECT_GT(grid.x[i].y() + dx[i].y(), 0.001);
}

TEST(Contact, ClothThatStartsInTheSkinComesOut) {
  collision::BodyCollider body(table(7, 0.2));
  Grid grid = make_grid(10, 0.15);
  Random random(5);
  for (Vec3& p : grid.x)
    p += Vec3(0.02, 0.002 * random.uniform(-1, 1), -0.02);
  ClothSolver solver(grid.mesh, grid.x);
  solver.emplace<EdgeSpringEffect>(grid.mesh);
  auto& contact = solver.emplace<BodyContactEffect>(grid.mesh, body, BodyContactOptions{});
  StepOptions options;
  solver.step(options);
  EXPECT_GT(contact.n_crossing(), 0u);
  for (int k = 0; k < 40; ++k)
    solver.step(options);
  EXPECT_EQ(contact.n_crossing(), 0u);
  EXPECT_TRUE(body.faces_through(solver.x(), grid.mesh.particle_triangles()).empty());
  for (const Vec3& p : solver.x())
    EXPECT_GT(p.y(), 0);
}

/// A sheet at y = 0 and one above it that comes down at `speed`, m/s.
struct FallingSheet {
  ClothMesh mesh;
  std::vector<Vec3> x;
};

FallingSheet sheet_above_sheet(double height) {
  const Grid one = make_grid(10, 0.1);
  std::vector<RestTriangle> triangles;
  FallingSheet s;
  const auto n = static_cast<int>(one.x.size());
  for (int layer = 0; layer < 2; ++layer)
    for (const Triangle& t : one.mesh.particle_triangles()) {
      RestTriangle rest{{t[0] + layer * n, t[1] + layer * n, t[2] + layer * n}, {}, 0};
      for (int k = 0; k < 3; ++k)
        rest.flat[k] = Vec2(one.x[t[k]].x(), -one.x[t[k]].z());
      triangles.push_back(rest);
    }
  s.mesh = make_cloth_mesh(2 * n, triangles, {Fabric{}});
  for (int layer = 0; layer < 2; ++layer)
    for (const Vec3& p : one.x)
      s.x.push_back(p + layer * Vec3(0.0031, height, 0.0023));
  return s;
}

TEST(Contact, ClothThatFallsTogetherFallsFreely) {
  for (const double apart :
       {0.02, 0.003}) { // out of each other's sight, and near enough for planes between them
    FallingSheet s = sheet_above_sheet(apart);
    ClothSolver solver(s.mesh, s.x);
    solver.emplace<EdgeSpringEffect>(s.mesh);
    solver.emplace<GravityEffect>(s.mesh, Vec3(0, -9.81, 0));
    solver.emplace<SelfContactEffect>(s.mesh, SelfContactOptions{});
    StepOptions options;
    options.inertia = 1;
    options.largest_move_m = 1;
    double fallen = 0;
    for (int k = 1; k <= 8; ++k) {
      solver.step(options);
      fallen += 9.81 * k * options.h * options.h;
    }
    for (std::size_t i = 0; i < s.x.size(); ++i)
      EXPECT_NEAR(s.x[i].y() - solver.x()[i].y(), fallen, 1e-3 * fallen) << apart;
  }
}

TEST(Contact, WhatMayPassPassesUntilItMayNot) {
  FallingSheet s = sheet_above_sheet(0.0012);
  SelfContactEffect contact(s.mesh, {});
  const int n = std::ssize(s.x);
  Couplings couplings;
  contact.declare(couplings);
  BlockMatrix matrix(n, couplings);
  contact.bind(matrix);
  const auto pushes = [&] {
    const Filled f = fill(contact, n, s.x, matrix);
    double most = 0;
    for (const Vec3& force : f.force)
      most = std::max(most, force.norm());
    return most;
  };
  const double most = pushes();
  EXPECT_GT(most, 0);
  std::vector<char> passes(s.x.size(), 1);
  contact.let_pass(passes);
  EXPECT_EQ(pushes(), 0);
  std::fill(passes.begin(), passes.begin() + n / 2, 0); // one sheet alone may not
  contact.let_pass(passes);
  EXPECT_EQ(pushes(), most);
  contact.let_pass({});
  EXPECT_EQ(pushes(), most);
  for (const bool may : {false, true}) { // and in motion
    ClothSolver solver(s.mesh, s.x);
    auto& held = solver.emplace<SelfContactEffect>(s.mesh, SelfContactOptions{});
    if (may)
      held.let_pass(std::vector<char>(s.x.size(), 1));
    solver.emplace<GravityEffect>(s.mesh, Vec3(0, -9.81, 0));
    std::vector<Vec3> velocity(s.x.size(), Vec3::Zero());
    for (int i = n / 2; i < n; ++i)
      velocity[i] = Vec3(0, -1, 0);
    solver.shift(std::vector<Vec3>(s.x.size(), Vec3::Zero()), velocity);
    StepOptions options;
    options.inertia = 1;
    options.largest_move_m = 1;
    for (int k = 0; k < 3; ++k)
      solver.step(options);
    EXPECT_EQ(solver.x().back().y() < solver.x().front().y(), may);
  }
}

TEST(Contact, WhatCrossedIsGuardedAsAllElseOnceItIsParted) {
  const FallingSheet s = sheet_above_sheet(0.0012);
  const int n = std::ssize(s.x);
  std::vector<Vec3> crossing = s.x;
  for (int i = n / 2; i < n; ++i)
    crossing[i].y() += 0.2 * (crossing[i].x() - s.x[n / 2].x()) - 0.005;
  SelfContactEffect contact(s.mesh, {}), fresh(s.mesh, {});
  BlockMatrix matrix(n, {});
  fill(contact, n, crossing, matrix);
  EXPECT_FALSE(contact.crossings().empty());
  contact.refresh();
  const Filled parted = fill(contact, n, s.x, matrix), expected = fill(fresh, n, s.x, matrix);
  EXPECT_TRUE(contact.crossings().empty());
  EXPECT_GT(expected.limits.planes.size(), 0u);
  EXPECT_EQ(parted.limits.planes.size(), expected.limits.planes.size());
  EXPECT_EQ(parted.force, expected.force);
}

TEST(Contact, LookingAheadChangesNoStep) {
  collision::BodyCollider body(table(7, 0.2));
  for (const double height :
       {0.004,
        -0.001}) { // outside, and with faces in the skin, which are pushed harder with every search
    Grid grid = make_grid(14, 0.26);
    for (Vec3& p : grid.x)
      p += Vec3(-0.03, height, 0.03);
    std::vector<Vec3> end[2];
    long ahead = 0;
    for (const bool look : {false, true}) {
      ClothSolver solver(grid.mesh, grid.x);
      solver.emplace<EdgeSpringEffect>(grid.mesh);
      solver.emplace<GravityEffect>(grid.mesh, Vec3(0, -9.81, 0));
      auto& skin = solver.emplace<BodyContactEffect>(grid.mesh, body, BodyContactOptions{});
      solver.emplace<SelfContactEffect>(grid.mesh, SelfContactOptions{});
      for (int k = 0; k < 20; ++k) {
        solver.step({});
        const long searches = skin.searches;
        if (look)
          solver.prefetch_contacts(StepOptions{}.h);
        ahead += skin.searches - searches;
      }
      end[look] = solver.x();
    }
    EXPECT_EQ(end[0], end[1]) << height;
    if (height > 0) {
      EXPECT_GT(ahead, 0);
    }
  }
}

class ContactFrom : public ::testing::TestWithParam<double> {};

TEST_P(ContactFrom, ClothThatMeetsClothInOneStepDoesNotPassIt) {
  FallingSheet s = sheet_above_sheet(GetParam());
  ClothSolver solver(s.mesh, s.x);
  solver.emplace<EdgeSpringEffect>(s.mesh);
  auto& contact = solver.emplace<SelfContactEffect>(s.mesh, SelfContactOptions{});
  struct ContactResponse : Effect { // drives the upper sheet down and the lower one up
    const ClothMesh& mesh;
    explicit ContactResponse(const ClothMesh& m) : mesh(m) {}
    const char* name() const override { return "push"; }
    void add(StepContext& c) override {
      const std::size_t n = c.force.size();
      for (std::size_t i = 0; i < n; ++i)
        c.force[i] += mesh.mass[i] * Vec3(0, i < n / 2 ? 60 : -60, 0);
    }
  };
  solver.emplace<ContactResponse>(s.mesh);
  StepOptions options;
  options.inertia = 1;
  options.largest_move_m = 1;
  const std::vector<Triangle> triangles = s.mesh.particle_triangles();
  for (int k = 0; k < 30; ++k) {
    const std::vector<Vec3> before = solver.x();
    ASSERT_TRUE(solver.step(options).finite);
    for (int part = 1; part <= 40;
         ++part) { // a sheet that passes in one step leaves no crossing behind
      std::vector<Vec3> x = before;
      for (std::size_t i = 0; i < x.size(); ++i)
        x[i] += part / 40.0 * (solver.x()[i] - before[i]);
      const collision::TriangleTree tree(x, triangles);
      ASSERT_TRUE(collision::self_intersections(x, triangles, tree).empty())
          << "step " << k << ", part " << part;
    }
  }
  EXPECT_GT(contact.far_searches, 0);
}
INSTANTIATE_TEST_SUITE_P(beyond_the_search_radius_and_within_it_but_too_far_to_repel, ContactFrom,
                         ::testing::Values(0.03, 0.005));

TEST(Contact, WithLineSearchClothComesToRestOnTheTable) {
  collision::BodyCollider body(table(7, 0.2));
  Grid grid = make_grid(14, 0.22); // its rim hangs over
  for (Vec3& p : grid.x)
    p += Vec3(-0.01, 0.004, 0.01);
  ClothSolver solver(grid.mesh, grid.x);
  auto& springs = solver.emplace<EdgeSpringEffect>(grid.mesh);
  auto& gravity = solver.emplace<GravityEffect>(grid.mesh, Vec3(0, -9.81, 0));
  auto& contact = solver.emplace<BodyContactEffect>(grid.mesh, body, BodyContactOptions{});
  contact.set_friction(0.4); // without it the cloth would slide off
  const auto energy = [&] {
    return springs.energy(solver.x()) + gravity.energy(solver.x()) + contact.energy(solver.x());
  };
  StepOptions options;
  options.line_search = true;
  solver.step(options);
  const double at_start = energy();
  int rises = 0;
  StepResult result;
  for (int k = 0; k < 120; ++k) {
    const double before = energy();
    result = solver.step(options);
    rises += energy() >
             before + 1e-7 * std::abs(before); // friction's anchors are moved between the steps
    options.h = std::clamp(options.h * (result.halvings > 0 ? 0.7 : 1.15), 0.005, 0.2);
  }
  EXPECT_EQ(rises, 0) << "no step may raise the energy, whatever limits do to it";
  EXPECT_LT(energy(), at_start);
  EXPECT_LT(result.residual_force_ratio, 0.2);
}

} // namespace

TEST(BodyContact, skin_that_keeps_to_its_room_never_passes_the_cloth) {
  Grid cloth = make_grid(8, 0.2);
  Random random(11);
  for (Vec3& p : cloth.x)
    p += Vec3(0.1, 0.004 + random.uniform(-0.002, 0.002), -0.1) - Vec3(p.x() * 0.5, 0, p.z() * 0.5);
  const TriangleMesh skin = table(12, 0.3);
  collision::BodyCollider body(skin);
  ClothSolver solver(cloth.mesh, cloth.x);
  solver.emplace<EdgeSpringEffect>(cloth.mesh);
  auto& contact = solver.emplace<BodyContactEffect>(cloth.mesh, body, BodyContactOptions{});
  StepOptions step;
  step.largest_move_m = 1e-9; // the cloth stays: only the skin's own care counts
  solver.step(step);
  std::vector<Vec3> moved = skin.positions;
  const std::vector<Triangle> triangles = cloth.mesh.particle_triangles();
  for (int k = 0; k < 30; ++k) {
    const std::vector<double> room = contact.max_safe_skin_displacement(solver.x());
    for (std::size_t v = 0; v < moved.size(); ++v)
      moved[v].y() += room[v]; // up, into the cloth
    contact.move_body(moved, solver.x());
    EXPECT_TRUE(body.faces_through(solver.x(), triangles).empty());
    for (const Vec3& p : solver.x())
      EXPECT_FALSE(body.is_inside(p));
  }
  double highest = 0;
  for (const Vec3& p : moved)
    highest = std::max(highest, p.y());
  EXPECT_GT(highest, 0.001); // and it does come near
}

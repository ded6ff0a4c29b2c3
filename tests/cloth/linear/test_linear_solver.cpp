#include <support/force_checks.hpp>

#include <cloth/linear/aggregation.hpp>
#include <gtest/gtest.h>
#include <sloper/base/error.hpp>
#include <sloper/cloth/forces/bending.hpp>
#include <sloper/cloth/forces/edge_spring.hpp>
#include <sloper/cloth/forces/shear.hpp>
#include <sloper/cloth/linear/factorisation.hpp>

#include <cstring>

using namespace sloper;
using namespace sloper::cloth;

namespace {

struct System {
  Grid grid;
  BlockMatrix matrix;
  std::vector<Vec3> rhs;
  std::vector<ContactElement> elements;
};

/// @param sheared  with shear: not all blocks are symmetric then
System make_system(int n, double h, bool sheared = false) {
  System s;
  s.grid = make_grid(n, 1.0);
  Random random(3);
  for (Vec3& p : s.grid.x)
    p.y() += random.uniform(-0.002, 0.002);
  EdgeSpringEffect springs(s.grid.mesh);
  BendingEffect bending(s.grid.mesh);
  ShearEffect shear(s.grid.mesh);
  std::vector<Effect*> effects = {&springs, &bending};
  if (sheared)
    effects.push_back(&shear);
  Couplings couplings;
  for (const Effect* e : effects)
    e->declare(couplings);
  s.matrix = BlockMatrix(s.grid.mesh.n_particles, couplings);
  s.rhs.assign(s.grid.x.size(), Vec3::Zero());
  StepContext c{s.grid.x, h, s.rhs, s.matrix, s.elements};
  for (Effect* e : effects) {
    e->bind(s.matrix);
    e->add(c);
  }
  for (int i = 0; i < s.matrix.size(); ++i) {
    s.matrix.add_diagonal(i, s.grid.mesh.mass[i] / (h * h) * Mat3::Identity());
    s.rhs[i].y() -= 9.81 * s.grid.mesh.mass[i];
  }
  for (int i = 0; i < s.matrix.size(); i += 17) {
    ContactElement e;
    e.n = 1;
    e.particle[0] = i;
    e.weight[0] = 1;
    e.normal_stiffness = 300;
    e.tangent_stiffness = 10;
    s.elements.push_back(e);
  }
  return s;
}

} // namespace

TEST(BlockMatrix, multiplies_as_the_dense_matrix_does) {
  BlockMatrix m(3,
                {.full = {{0, 1}, {2, 1}, {1, 0}}, .symmetric = {}, .isotropic = {{2, 0}, {1, 2}}});
  Mat3 a;
  a << 1, 2, 3, 4, 5, 6, 7, 8, 9;
  m.add_diagonal(0, Mat3::Identity());
  m.add_off_diagonal(m.slot(0, 1), a);
  m.add_off_diagonal(m.slot(1, 2), 2 * a);
  m.add_isotropic(m.slot(2, 0), 7);
  std::vector<Vec3> x{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, y(3);
  m.multiply(x, y);
  EXPECT_EQ(y[0], Vec3(1 + 2, 5, 8 + 7));
  EXPECT_EQ(y[1], a.transpose() * x[0] + 2 * a * x[2]);
  EXPECT_EQ(y[2], 2 * a.transpose() * x[1] + 7 * x[0]);
}

TEST(BlockMatrix, keeps_as_one_number_what_is_isotropic_for_all_and_refuses_what_nobody_declared) {
  BlockMatrix m(
      4,
      {.full = {{0, 1}, {3, 3}}, .symmetric = {}, .isotropic = {{1, 0}, {2, 0}, {0, 2}, {2, 1}}});
  EXPECT_EQ(m.value().size(), 1U); // (1, 0) is full for one, and so for all
  EXPECT_EQ(m.isotropic_value().size(), 2U);
  m.add_isotropic(m.slot(0, 1), 3);
  EXPECT_EQ(m.value()[0], 3 * Mat3::Identity());
  EXPECT_THROW(m.slot(1, 3), Error);
  EXPECT_THROW(m.slot(3, 3), Error);
}

TEST(BlockMatrix, tells_whether_every_block_was_declared_symmetric) {
  EXPECT_TRUE(
      BlockMatrix(3, {.full = {}, .symmetric = {{0, 1}}, .isotropic = {{1, 2}}}).all_symmetric());
  BlockMatrix m(3, {.full = {{1, 0}}, .symmetric = {{0, 1}, {1, 2}}, .isotropic = {{1, 2}}});
  EXPECT_FALSE(m.all_symmetric());
  EXPECT_EQ(m.value().size(), 2U);
  EXPECT_TRUE(m.isotropic_value().empty()); // symmetric for one, and so for all
}

/// Column c of the matrix that multiply(x, y) stands for, c over all.
template<class Multiply> Eigen::MatrixXd columns_of(int n, const Multiply& multiply) {
  Eigen::MatrixXd a(3 * n, 3 * n);
  for (int c = 0; c < 3 * n; ++c) {
    std::vector<Vec3> x(n, Vec3::Zero()), y(n);
    x[c / 3][c % 3] = 1;
    multiply(x, y);
    for (int i = 0; i < n; ++i)
      a.block<3, 1>(3 * i, c) = y[i];
  }
  return a;
}

TEST(BlockMatrix, is_the_same_matrix_in_all_its_forms) {
  for (bool sheared : {false, true}) {
    const System s = make_system(7, 0.1, sheared);
    const int n = s.matrix.size();
    EXPECT_NE(s.matrix.all_symmetric(), sheared);
    const Eigen::MatrixXd a = dense(s.matrix);
    EXPECT_FALSE(s.matrix.isotropic_value().empty());
    EXPECT_EQ((columns_of(n, [&](const auto& x, auto& y) { s.matrix.multiply(x, y); }) - a).norm(),
              0);
    BlockRows rows;
    expand(s.matrix, rows);
    Eigen::MatrixXd b = Eigen::MatrixXd::Zero(3 * n, 3 * n);
    for (int i = 0; i < n; ++i)
      for (int k = rows.start[i]; k < rows.start[i + 1]; ++k)
        b.block<3, 3>(3 * i, 3 * rows.column[k]) += rows.value[k];
    EXPECT_EQ((b - a).norm(), 0);
    const FloatRows single = to_float(s.matrix), of_rows = to_float(rows);
    EXPECT_LT(single.blocks(), of_rows.blocks());
    for (const FloatRows* f : {&single, &of_rows}) {
      const Eigen::MatrixXd c = columns_of(n, [&](const auto& x, auto& y) {
        std::vector<Float4> single_x(n);
        for (int i = 0; i < n; ++i)
          single_x[i] = to_float(x[i]);
        f->multiply(single_x, [&](std::size_t i, Float4 row) { y[i] = to_double(row); });
      });
      EXPECT_LT((c - a).norm(), 1e-6 * a.norm());
    }
  }
}

TEST(FloatRows, gives_the_same_bytes_with_wide_registers_and_without) {
  for (bool sheared : {false, true}) {
    const System s = make_system(7, 0.1, sheared);
    const std::size_t n = s.matrix.size();
    ASSERT_NE(n % FloatRows::GROUP, 0U); // the last group is not full
    std::vector<Float4> x(n);
    Random random(5);
    for (Float4& v : x) {
      Vec3 p;
      for (double& c : p)
        c = random.uniform(-1, 1);
      v = to_float(p);
    }
    const FloatRows rows = to_float(s.matrix);
    std::vector<float> result[2];
    for (int wide : {0, 1}) {
      FloatRows::allow_wide(wide != 0);
      result[wide].resize(4 * n);
      rows.multiply(x, [&](std::size_t i, Float4 row) {
        std::memcpy(&result[wide][4 * i], &row, sizeof row);
      });
    }
    EXPECT_EQ(result[0], result[1]);
    EXPECT_EQ(result[0][3], 0);
  }
}

TEST(BlockRows, products_are_those_of_whole_matrices_and_the_same_bytes_on_wide_registers) {
  const System s = make_system(7, 0.1, true);
  BlockRows a;
  expand(s.matrix, a);
  const int n = a.rows;
  const auto whole = [n](const BlockRows& rows) {
    Eigen::MatrixXd m = Eigen::MatrixXd::Zero(3 * n, 3 * n);
    for (int i = 0; i < n; ++i)
      for (int k = rows.start[i]; k < rows.start[i + 1]; ++k)
        m.block<3, 3>(3 * i, 3 * rows.column[k]) += rows.value[k];
    return m;
  };
  BlockRows square[2];
  for (int wide : {0, 1}) {
    FloatRows::allow_wide(wide != 0);
    product(a, a, square[wide]);
  }
  const Eigen::MatrixXd expected = whole(a) * whole(a);
  EXPECT_LT((whole(square[1]) - expected).norm(), 1e-12 * expected.norm());
  EXPECT_EQ(square[0].column, square[1].column);
  EXPECT_EQ(0, std::memcmp(square[0].value.data(), square[1].value.data(),
                           square[0].value.size() * sizeof(Mat3)));
}

/// The system solved with a preconditioner fresh for it.
template<class Preconditioner>
CgResult solve_with(const LinearSystem& system, const std::vector<Vec3>& rhs, double tolerance,
                    std::vector<Vec3>& x) {
  Preconditioner preconditioner;
  preconditioner.update(system);
  CgWork work;
  return conjugate_gradient(system, preconditioner, rhs, {tolerance, 5000}, x, work);
}

TEST(Aggregation, solves_the_same_system_as_block_jacobi_in_far_fewer_iterations) {
  System s = make_system(40, 0.1);
  ContactIndex index;
  index.build(s.elements, s.matrix.size());
  const LinearSystem system{s.matrix, s.elements, index};
  std::vector<Vec3> x_jacobi, x_aggregation;
  const CgResult plain = solve_with<BlockJacobi>(system, s.rhs, 1e-8, x_jacobi);
  const CgResult fast = solve_with<Aggregation>(system, s.rhs, 1e-8, x_aggregation);
  ASSERT_TRUE(plain.converged && fast.converged);
  EXPECT_LT(fast.iterations * 4, plain.iterations)
      << fast.iterations << " against " << plain.iterations;
  double difference = 0, scale = 0;
  for (std::size_t i = 0; i < x_jacobi.size(); ++i) {
    difference = std::max(difference, (x_jacobi[i] - x_aggregation[i]).norm());
    scale = std::max(scale, x_jacobi[i].norm());
  }
  EXPECT_LT(difference, 1e-5 * scale);
}

TEST(ConjugateGradient, what_the_work_vectors_hold_does_not_matter) {
  const System s = make_system(7, 0.1);
  ContactIndex index;
  index.build(s.elements, s.matrix.size());
  const LinearSystem system{s.matrix, s.elements, index};
  BlockJacobi preconditioner;
  preconditioner.update(system);
  CgWork work;
  for (auto* v : {&work.r, &work.z, &work.p, &work.q})
    v->assign(s.rhs.size(), Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
  std::vector<Vec3> x;
  EXPECT_TRUE(conjugate_gradient(system, preconditioner, s.rhs, {1e-6, 5000}, x, work).converged);
}

TEST(Factorisation, solves_the_same_system_contacts_too_at_once) {
  System s = make_system(40, 0.1);
  Random random(3);
  for (int k = 0; k < 200;
       ++k) { // some tie a particle to itself, as sewing springs between merged ones do
    ContactElement e;
    e.n = 3;
    for (int i = 0; i < e.n; ++i)
      e.particle[i] = static_cast<int>(random.uniform(0, 1) * (s.matrix.size() - 1));
    if (k % 10 == 0)
      e.particle[2] = e.particle[0];
    e.weight = {0.5, 0.3, -0.8, 0};
    e.normal = Vec3{random.uniform(-1, 1), random.uniform(-1, 1), 2}.normalized();
    e.normal_stiffness = 300;
    e.tangent_stiffness = 20;
    s.elements.push_back(e);
  }
  ContactIndex index;
  index.build(s.elements, s.matrix.size());
  const LinearSystem system{s.matrix, s.elements, index};
  std::vector<Vec3> x_jacobi, x_exact;
  ASSERT_TRUE(solve_with<BlockJacobi>(system, s.rhs, 1e-10, x_jacobi).converged);
  const CgResult once = solve_with<Factorisation>(system, s.rhs, 1e-10, x_exact);
  EXPECT_TRUE(once.converged);
  EXPECT_LE(once.iterations, 2);
  for (std::size_t i = 0; i < x_jacobi.size(); ++i)
    EXPECT_LT((x_jacobi[i] - x_exact[i]).norm(), 1e-6 * (1e-3 + x_exact[i].norm()));
}

TEST(Aggregation, particles_that_contacts_all_but_pin_do_not_fill_the_coarse_levels) {
  System s = make_system(40, 1.0 / 30);
  Random random(5);
  for (int i = 0; i < s.matrix.size(); ++i)
    if (random.uniform(0, 1) < 0.8)
      s.matrix.add_diagonal(i, 1e5 * Mat3::Identity()); // trousers drawn over far too wide hips
  ContactIndex index;
  index.build(s.elements, s.matrix.size());
  const LinearSystem system{s.matrix, s.elements, index};
  Aggregation aggregation;
  aggregation.update(system);
  EXPECT_LT(aggregation.complexity(), 2); // 3.2 when each of them is an aggregate
  std::vector<Vec3> x;
  CgWork work;
  EXPECT_TRUE(conjugate_gradient(system, aggregation, s.rhs, {1e-6, 300}, x, work).converged);
}

TEST(Aggregation, iterations_hardly_grow_with_the_mesh) {
  int iterations[2];
  int at = 0;
  for (int n : {20, 60}) {
    System s = make_system(n, 0.1);
    ContactIndex index;
    index.build(s.elements, s.matrix.size());
    const LinearSystem system{s.matrix, s.elements, index};
    CgWork work;
    std::vector<Vec3> x;
    Aggregation aggregation;
    aggregation.update(system);
    const CgResult r = conjugate_gradient(system, aggregation, s.rhs, {1e-3, 5000}, x, work);
    ASSERT_TRUE(r.converged);
    iterations[at++] = r.iterations;
  }
  EXPECT_LT(iterations[1], 3 * iterations[0] + 5) << iterations[0] << " and " << iterations[1];
}

TEST(Aggregation, solves_in_double_what_single_precision_takes_for_an_indefinite_matrix) {
  System s =
      make_system(12, 100); // cloth that nothing holds: 1e-7 N/m of inertia next to springs of 1e3
  s.elements.clear();
  ContactIndex index;
  index.build(s.elements, s.matrix.size());
  const LinearSystem system{s.matrix, s.elements, index};
  Aggregation aggregation;
  aggregation.update(system);
  std::vector<Vec3> x(s.rhs.size());
  CgResult single;
  EXPECT_TRUE(aggregation.solve_in_single(system, s.rhs, {1e-3, 1000}, x, single));
  EXPECT_TRUE(single.indefinite);
  CgWork work;
  const CgResult both = conjugate_gradient(system, aggregation, s.rhs, {1e-3, 1000}, x, work);
  EXPECT_TRUE(both.converged);
  EXPECT_FALSE(both.indefinite);
}

TEST(ConjugateGradient, goes_along_negative_curvature_to_the_radius_and_no_farther) {
  const System s = make_system(12, 10);
  ContactIndex index;
  index.build(s.elements, s.matrix.size());
  BlockMatrix whole = s.matrix;
  for (int i = 0; i < whole.size(); ++i)
    whole.add_isotropic_diagonal(i, -20);
  const LinearSystem definite{s.matrix, s.elements, index},
      indefinite{s.matrix, s.elements, index, &whole};
  const double radius = 0.001;
  const auto longest = [](const std::vector<Vec3>& x) {
    double most = 0;
    for (const Vec3& v : x)
      most = std::max(most, v.norm());
    return most;
  };
  BlockJacobi jacobi;
  Aggregation aggregation;
  for (Preconditioner* preconditioner :
       {static_cast<Preconditioner*>(&jacobi), static_cast<Preconditioner*>(&aggregation)})
    for (const LinearSystem* system : {&definite, &indefinite}) {
      preconditioner->update(*system);
      CgWork work;
      std::vector<Vec3> x;
      const CgResult r =
          conjugate_gradient(*system, *preconditioner, s.rhs, {1e-6, 1000, radius}, x, work);
      EXPECT_TRUE(r.bounded);
      EXPECT_FALSE(r.converged);
      EXPECT_LT(longest(x), (1 + 1e-6) * radius);
      EXPECT_GT(longest(x), 0.5 * radius);
      double falls = 0;
      for (std::size_t i = 0; i < x.size(); ++i)
        falls += x[i].dot(s.rhs[i]);
      EXPECT_GT(falls, 0);
      const CgResult free =
          conjugate_gradient(*system, *preconditioner, s.rhs, {1e-6, 1000}, x, work);
      EXPECT_EQ(free.converged, system == &definite);
      EXPECT_EQ(free.indefinite, system == &indefinite);
    }
}

TEST(ConjugateGradient, ends_at_a_share_of_the_error_in_the_energy_norm) {
  const System s = make_system(20, 1);
  ContactIndex index;
  index.build(s.elements, s.matrix.size());
  const LinearSystem system{s.matrix, s.elements, index};
  CgWork work;
  Aggregation aggregation;
  aggregation.update(system);
  std::vector<Vec3> exact, x, product(s.rhs.size());
  std::vector<double> part;
  ASSERT_TRUE(conjugate_gradient(system, aggregation, s.rhs, {1e-9, 5000}, exact, work).converged);
  const auto error = [&](const std::vector<Vec3>& at) { // in the energy norm
    std::vector<Vec3> off(exact);
    for (std::size_t i = 0; i < at.size(); ++i)
      off[i] -= at[i];
    return std::sqrt(system.multiply(off, product, work.pull, part));
  };
  const double all = error(std::vector<Vec3>(exact.size(), Vec3::Zero()));
  const CgResult r = conjugate_gradient(system, aggregation, s.rhs, {{1e-9, 0.1}, 5000}, x, work);
  EXPECT_TRUE(r.near);
  EXPECT_TRUE(r.converged);
  EXPECT_GT(r.residual, 1e-6);
  EXPECT_LT(error(x), 0.3 * all);
  EXPECT_GT(error(x), 0.01 * all);
  const CgResult by_residual = conjugate_gradient(system, aggregation, s.rhs, {{0.5, 1e-9}, 5000},
                                                  x, work); // whichever is reached first
  EXPECT_FALSE(by_residual.near);
  EXPECT_LE(by_residual.residual, 0.5);
  BlockJacobi jacobi; // cannot tell what is soft
  jacobi.update(system);
  const CgResult blind = conjugate_gradient(system, jacobi, s.rhs, {{1e-6, 0.1}, 5000}, x, work);
  EXPECT_FALSE(blind.near);
  EXPECT_LE(blind.residual, 1e-6);
}

TEST(ConjugateGradient, cut_short_keeps_what_it_has_though_the_residual_grew) {
  const System s = make_system(20, 1);
  ContactIndex index;
  index.build(s.elements, s.matrix.size());
  const LinearSystem system{s.matrix, s.elements, index};
  CgWork work;
  std::vector<Vec3> x, product(s.rhs.size());
  std::vector<double> part;
  double least = 0;
  int grew = 0;
  for (int iterations = 1; iterations <= 12; ++iterations) {
    Aggregation aggregation;
    aggregation.update(system);
    grew +=
        conjugate_gradient(system, aggregation, s.rhs, {1e-9, iterations}, x, work).residual > 1;
    double energy = 0.5 * system.multiply(x, product, work.pull, part);
    for (std::size_t i = 0; i < x.size(); ++i)
      energy -= x[i].dot(s.rhs[i]);
    EXPECT_LT(energy, least) << iterations;
    least = energy;
  }
  EXPECT_GT(grew, 0);
}

namespace {

/// A space whose r . z rounding has made negative after the first step.
struct RoundedSpace {
  int asked = 0;
  double precondition() { return asked++ == 0 ? 1 : -1e-9; }
  void turn(double) {}
  double multiply() { return 1; }
  double advance(double) { return 0.5; }
  double longest_x() const { return 0; }
  double longest_p() const { return 1; }
  bool renew(int) { return false; }
};

} // namespace

TEST(ConjugateGradient, does_not_take_what_rounding_leaves_for_near) {
  for (double energy : {0.0, 0.1}) {
    CgResult result;
    const double left2 =
        conjugate_gradient_loop(RoundedSpace{}, 1, 1e-8, {{0, energy}, 100}, result);
    EXPECT_EQ(left2, 0.5);
    EXPECT_EQ(result.iterations, 1);
    EXPECT_FALSE(result.near) << energy;
  }
}

TEST(ConjugateGradient, stops_at_an_indefinite_matrix_and_keeps_what_it_has) {
  BlockMatrix m(1, {});
  m.add_diagonal(0, -Mat3::Identity());
  std::vector<ContactElement> none;
  ContactIndex index;
  index.build(none, m.size());
  const LinearSystem system{m, none, index};
  BlockJacobi jacobi;
  jacobi.update(system);
  CgWork work;
  std::vector<Vec3> x;
  const CgResult r = conjugate_gradient(system, jacobi, {Vec3(1, 0, 0)}, {1e-6, 10}, x, work);
  EXPECT_TRUE(r.indefinite);
  EXPECT_TRUE(x[0].allFinite());
}

/// The ways of the last solves, and the solves that begin with them.
#include <support/grid.hpp>

#include <Eigen/Dense>
#include <cloth/linear/aggregation.hpp>
#include <cstring>
#include <gtest/gtest.h>
#include <sloper/base/random.hpp>
#include <sloper/cloth/forces/bending.hpp>
#include <sloper/cloth/forces/edge_spring.hpp>

using namespace sloper;
using namespace sloper::cloth;

namespace {

constexpr int ROWS = 700; // more than one chunk of parallel_for
constexpr int N = 3 * ROWS;

std::vector<Float4> to_floats(const Eigen::VectorXd& v) {
  std::vector<Float4> out;
  for (int i = 0; i < ROWS; ++i)
    out.push_back(to_float(Vec3(v.segment<3>(3 * i))));
  return out;
}

Eigen::VectorXd to_doubles(const std::vector<Float4>& v) {
  Eigen::VectorXd out(N);
  for (int i = 0; i < ROWS; ++i)
    out.segment<3>(3 * i) = to_double(v[i]);
  return out;
}

Eigen::VectorXd any_vector(std::uint64_t seed) {
  Random random(seed);
  Eigen::VectorXd v(N);
  for (double& c : v)
    c = random.uniform(-1, 1);
  return v;
}

/// A diagonal matrix from 1 to 100.
const Eigen::VectorXd DIAGONAL = Eigen::VectorXd::LinSpaced(N, 1, 100);

void multiply_diagonal(const std::vector<Float4>& x, std::vector<Float4>& y) {
  y = to_floats(DIAGONAL.cwiseProduct(to_doubles(x)));
}

/// Wavy cloth that hangs by a corner and hardly resists: what moves it most is soft.
struct Cloth {
  Grid grid = make_grid(30, 0.5);
  BlockMatrix matrix;
  std::vector<ContactElement> elements;
  ContactIndex index;
  std::vector<Vec3> weight;

  Cloth() {
    for (Vec3& p : grid.x)
      p.y() += 0.01 * std::sin(25 * p.x() + 9 * p.z());
    EdgeSpringEffect springs(grid.mesh);
    BendingEffect bending(grid.mesh);
    Couplings couplings;
    springs.declare(couplings);
    bending.declare(couplings);
    matrix = BlockMatrix(grid.mesh.n_particles, couplings);
    springs.bind(matrix);
    bending.bind(matrix);
    std::vector<Vec3> force(grid.x.size(), Vec3::Zero());
    StepContext c{grid.x, 1e30, force, matrix, elements};
    springs.add(c);
    bending.add(c);
    for (int i = 0; i < matrix.size(); ++i)
      matrix.add_isotropic_diagonal(i, 1e-3 * grid.mesh.mass[i] / grid.mesh.mass[0]);
    matrix.add_isotropic_diagonal(0, 1e3);
    index.build(elements, grid.x.size());
    for (double m : grid.mesh.mass)
      weight.emplace_back(0, -9.81 * m, 0);
  }
  LinearSystem system(bool recurs) const { return {matrix, elements, index, nullptr, recurs}; }
};

/// Iterations of solves for the weight, tilted a little more each time; the last solution.
std::vector<int> solve_in_turn(const Cloth& cloth, bool recurs, std::vector<Vec3>& x) {
  const LinearSystem system = cloth.system(recurs);
  Aggregation aggregation;
  CgWork work;
  std::vector<int> iterations;
  for (int k = 0; k < 6; ++k) {
    std::vector<Vec3> tilted = cloth.weight;
    for (std::size_t i = 0; i < tilted.size(); ++i)
      tilted[i].x() = 0.05 * k * tilted[i].y() * std::cos(10 * cloth.grid.x[i].z());
    aggregation.update(system);
    const CgResult r = conjugate_gradient(system, aggregation, tilted, {1e-3, 2000}, x, work);
    EXPECT_TRUE(r.converged);
    EXPECT_LT(r.residual, 1.01e-3);
    iterations.push_back(r.iterations);
  }
  return iterations;
}

} // namespace

TEST(Deflation, starts_from_the_best_of_the_ways_and_keeps_directions_apart_from_them) {
  Deflation deflation;
  const Eigen::VectorXd a = any_vector(1), b = any_vector(2), right = any_vector(3);
  deflation.keep(to_floats(a));
  deflation.keep(to_floats(2 * a)); // no new way
  deflation.keep(to_floats(b));
  deflation.keep(to_floats(Eigen::VectorXd::Zero(N))); // none at all
  deflation.prepare(ROWS, multiply_diagonal);
  ASSERT_EQ(deflation.size(), 2U);
  std::vector<Float4> x = to_floats(Eigen::VectorXd::Zero(N)), r = to_floats(right),
                      z = to_floats(any_vector(4));
  deflation.start(x, r);
  Eigen::MatrixXd basis(N, 2);
  basis << a, b;
  const Eigen::MatrixXd images = DIAGONAL.asDiagonal() * basis;
  const Eigen::VectorXd best =
      basis * (basis.transpose() * images).ldlt().solve(basis.transpose() * right);
  EXPECT_LT((to_doubles(x) - best).norm(), 1e-5 * best.norm());
  EXPECT_LT((to_doubles(r) - (right - DIAGONAL.cwiseProduct(best))).norm(), 1e-5 * right.norm());
  deflation.project(r, z); // r has nothing of the ways left
  EXPECT_LT((images.transpose() * to_doubles(z)).norm(),
            1e-5 * images.norm() * to_doubles(z).norm());
}

TEST(Deflation, the_newest_ways_stay_and_those_of_other_cloth_go) {
  Deflation deflation;
  for (std::uint64_t k = 0; k < 2 * Deflation::MAX_BASIS; ++k)
    deflation.keep(to_floats(any_vector(k)));
  deflation.prepare(ROWS, multiply_diagonal);
  EXPECT_EQ(deflation.size(), Deflation::MAX_BASIS);
  const Eigen::VectorXd oldest = any_vector(
      Deflation::MAX_BASIS); // of those that stay: it is in W, so that nothing of it is left
  std::vector<Float4> z = to_floats(oldest);
  deflation.project(to_floats(Eigen::VectorXd::Zero(N)), z);
  EXPECT_LT(to_doubles(z).norm(), 1e-4 * oldest.norm());
  deflation.prepare(ROWS - 1, [](const auto&, auto&) { FAIL(); });
  EXPECT_EQ(deflation.size(), 0U);
}

TEST(Deflation, ways_along_which_the_matrix_is_not_definite_are_left_out) {
  Deflation deflation;
  deflation.keep(to_floats(any_vector(1)));
  deflation.prepare(ROWS, [](const std::vector<Float4>& x, std::vector<Float4>& y) {
    y = to_floats(-to_doubles(x));
  });
  EXPECT_EQ(deflation.size(), 0U);
  deflation.keep(to_floats(Eigen::VectorXd::Constant(N, std::numeric_limits<double>::infinity())));
  deflation.prepare(ROWS, multiply_diagonal);
  EXPECT_EQ(deflation.size(), 1U);
}

TEST(Deflation, systems_that_recur_take_far_fewer_iterations_to_the_same_solution) {
  const Cloth cloth;
  std::vector<Vec3> alone, in_turn;
  const std::vector<int> each = solve_in_turn(cloth, false, alone),
                         with = solve_in_turn(cloth, true, in_turn);
  EXPECT_EQ(with[0], each[0]);
  int all = 0, fewer = 0;
  for (std::size_t k = 1; k < each.size(); ++k) {
    all += each[k];
    fewer += with[k];
  }
  EXPECT_LT(2 * fewer, all) << fewer << " against " << all;
  double difference = 0, length = 0;
  for (std::size_t i = 0; i < alone.size(); ++i) {
    difference += (alone[i] - in_turn[i]).squaredNorm();
    length += alone[i].squaredNorm();
  }
  EXPECT_LT(std::sqrt(difference / length), 0.02);
}

TEST(Deflation, a_start_beyond_the_radius_is_not_taken) {
  const Cloth cloth;
  const LinearSystem system = cloth.system(true);
  Aggregation aggregation;
  aggregation.update(system);
  CgWork work;
  std::vector<Vec3> x;
  ASSERT_TRUE(
      conjugate_gradient(system, aggregation, cloth.weight, {1e-4, 2000}, x, work).converged);
  const double radius = 1e-3;
  const CgResult bounded =
      conjugate_gradient(system, aggregation, cloth.weight, {1e-4, 2000, radius}, x, work);
  EXPECT_TRUE(bounded.bounded);
  for (const Vec3& v : x)
    EXPECT_LT(v.norm(), (1 + 1e-6) * radius);
}

TEST(Deflation, gives_the_same_bytes_on_any_number_of_threads) {
  const Cloth cloth;
  std::vector<Vec3> one, many;
  solve_in_turn(cloth, true, one);
  set_thread_count(3);
  solve_in_turn(cloth, true, many);
  set_thread_count(1);
  EXPECT_EQ(std::memcmp(one.data(), many.data(), one.size() * sizeof(Vec3)), 0);
}

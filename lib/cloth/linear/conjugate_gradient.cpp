#include <Eigen/Dense>
#include <sloper/base/parallel.hpp>
#include <sloper/cloth/linear/conjugate_gradient.hpp>

#include <cmath>

namespace sloper::cloth {

double LinearSystem::multiply(const std::vector<Vec3>& x, std::vector<Vec3>& y,
                              std::vector<Vec3>& pull, std::vector<double>& part) const {
  const BlockMatrix& a = whole ? *whole : matrix;
  pull.resize(elements.size());
  parallel_for(elements.size(), ROW_GRAIN, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e)
      pull[e] = elements[e].pull(x);
  });
  return parallel_sum(x.size(), ROW_GRAIN, part, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) {
      Vec3 row = a.row_times(static_cast<int>(i), x);
      for (int k = index.start[i]; k < index.start[i + 1]; ++k)
        row += elements[index.entry[k].element].weight[index.entry[k].k] *
               pull[index.entry[k].element];
      y[i] = row;
      sum += x[i].dot(row);
    }
    return sum;
  });
}

void BlockJacobi::update(const LinearSystem& system) {
  const int n = system.matrix.size();
  m_inverse.resize(n);
  for (int i = 0; i < n; ++i)
    m_inverse[i] = system.matrix.diagonal(i);
  for (const ContactElement& e : system.elements) {
    const Mat3 a = e.stiffness();
    for (int k = 0; k < e.n; ++k)
      m_inverse[e.particle[k]] += e.weight[k] * e.weight[k] * a;
  }
  parallel_for(m_inverse.size(), ROW_GRAIN, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      m_inverse[i] = m_inverse[i].inverse().eval();
  });
}

void BlockJacobi::apply(const std::vector<Vec3>& r, std::vector<Vec3>& z) {
  for (std::size_t i = 0; i < r.size(); ++i)
    z[i].noalias() = m_inverse[i] * r[i];
}

static double dot(const std::vector<Vec3>& a, const std::vector<Vec3>& b,
                  std::vector<double>& part) {
  return parallel_sum(a.size(), ROW_GRAIN, part, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i)
      sum += a[i].dot(b[i]);
    return sum;
  });
}

static double longest(const std::vector<Vec3>& v) {
  double most = 0;
  for (const Vec3& p : v)
    most = std::max(most, p.squaredNorm());
  return std::sqrt(most);
}

namespace {

struct DoubleSpace {
  const LinearSystem& system;
  Preconditioner& preconditioner;
  std::vector<Vec3>& x;
  CgWork& work;

  double precondition() {
    preconditioner.apply(work.r, work.z);
    return dot(work.r, work.z, work.part);
  }
  void turn(double beta) {
    parallel_for(x.size(), ROW_GRAIN, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        work.p[i] = work.z[i] + beta * work.p[i];
    });
  }
  double multiply() { return system.multiply(work.p, work.q, work.pull, work.part); }
  double advance(double alpha) {
    return parallel_sum(x.size(), ROW_GRAIN, work.part, [&](std::size_t begin, std::size_t end) {
      double sum = 0;
      for (std::size_t i = begin; i < end; ++i) {
        x[i] += alpha * work.p[i];
        work.r[i] -= alpha * work.q[i];
        sum += work.r[i].squaredNorm();
      }
      return sum;
    });
  }
  double longest_x() const { return longest(x); }
  double longest_p() const { return longest(work.p); }
  bool renew(int iterations) { return preconditioner.renew(system, iterations); }
};

constexpr double AIM =
    0.95; // of the tolerance, in single precision: the residual in double is to be within it too
constexpr double FINEST_SHARE =
    1e-4; // of the residual, that a round in single precision is asked for

/// Whether the energy of the system, 1/2 x' A x - b' x, is less at x than at 0.
bool falls(const std::vector<Vec3>& x, const std::vector<Vec3>& b,
           const std::vector<Vec3>& residual) {
  double twice = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    twice += x[i].dot(b[i] + residual[i]);
  return twice > 0;
}

} // namespace

CgResult conjugate_gradient(const LinearSystem& system, Preconditioner& preconditioner,
                            const std::vector<Vec3>& b, const CgLimits& limits,
                            std::vector<Vec3>& x, CgWork& work) {
  const std::size_t n = b.size();
  for (auto* v : {&work.r, &work.z, &work.p, &work.q})
    v->resize(n);
  x.assign(n, Vec3::Zero());
  work.r = b;
  CgTolerance tolerance = limits.tolerance;
  if (!preconditioner.estimates_energy_error())
    tolerance.energy = 0;
  CgResult result;
  const double b_norm2 = dot(b, b, work.part);
  if (b_norm2 == 0)
    return {0, 0, 0, true, false, false, false};
  const double target2 = tolerance.residual * tolerance.residual * b_norm2;
  double r_norm2 = b_norm2;
  while (result.iterations < limits.max_iterations && r_norm2 > target2) {
    const double share = std::max(AIM * std::sqrt(target2 / r_norm2), FINEST_SHARE);
    const CgLimits round{.tolerance = {share, tolerance.energy},
                         .max_iterations = limits.max_iterations,
                         .radius = limits.radius - longest(x)};
    if (!preconditioner.solve_in_single(system, work.r, round, work.z, result))
      break;
    for (std::size_t i = 0; i < n; ++i)
      work.p[i] = x[i] + work.z[i];
    system.multiply(work.p, work.q, work.pull, work.part);
    for (std::size_t i = 0; i < n; ++i)
      work.z[i] = b[i] - work.q[i];
    const double after2 = dot(work.z, work.z, work.part);
    const bool ended = result.bounded || result.near ||
                       result.iterations >= limits.max_iterations; // by what lets the residual grow
    if (!(ended ? std::isfinite(after2) && (result.bounded || falls(work.p, b, work.z))
                : after2 < r_norm2)) {
      result.bounded = result.near = false;
      break;
    }
    const bool halved = after2 < 0.25 * r_norm2;
    r_norm2 = after2;
    std::swap(x, work.p);
    std::swap(work.r, work.z);
    if (ended || !halved)
      break;
  }
  if (!result.bounded && !result.near) {
    work.p.assign(n,
                  Vec3::Zero()); // it may hold what is no number, and 0 times that is none either
    const CgLimits rest{tolerance, limits.max_iterations, limits.radius};
    r_norm2 = conjugate_gradient_loop(DoubleSpace{system, preconditioner, x, work}, r_norm2,
                                      target2, rest, result);
  }
  result.residual = std::sqrt(r_norm2 / b_norm2);
  result.converged = result.near || r_norm2 <= target2;
  return result;
}

} // namespace sloper::cloth

#include <Eigen/Dense>
#include <base/parallel.hpp>
#include <cloth/conjugate_gradient.hpp>

#include <cmath>

namespace sloper::cloth {

double LinearSystem::multiply(const std::vector<Vec3>& x, std::vector<Vec3>& y, std::vector<Vec3>& pull, std::vector<double>& part) const {
  pull.resize(elements.size());
  parallel_for(elements.size(), ROW_GRAIN, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) pull[e] = elements[e].pull(x);
  });
  return parallel_sum(x.size(), ROW_GRAIN, part, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) {
      Vec3 row = matrix.row_times(static_cast<int>(i), x);
      for (int k = index.start[i]; k < index.start[i + 1]; ++k) row += elements[index.entry[k].element].weight[index.entry[k].k] * pull[index.entry[k].element];
      y[i] = row;
      sum += x[i].dot(row);
    }
    return sum;
  });
}

void BlockJacobi::update(const LinearSystem& system) {
  const int n = system.matrix.size();
  m_inverse.resize(n);
  for (int i = 0; i < n; ++i) m_inverse[i] = system.matrix.diagonal(i);
  for (const ContactElement& e : system.elements) {
    const Mat3 a = e.stiffness();
    for (int k = 0; k < e.n; ++k) m_inverse[e.particle[k]] += e.weight[k] * e.weight[k] * a;
  }
  parallel_for(m_inverse.size(), ROW_GRAIN, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) m_inverse[i] = m_inverse[i].inverse().eval();
  });
}

void BlockJacobi::apply(const std::vector<Vec3>& r, std::vector<Vec3>& z) {
  for (std::size_t i = 0; i < r.size(); ++i) z[i].noalias() = m_inverse[i] * r[i];
}

static double dot(const std::vector<Vec3>& a, const std::vector<Vec3>& b, std::vector<double>& part) {
  return parallel_sum(a.size(), ROW_GRAIN, part, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += a[i].dot(b[i]);
    return sum;
  });
}

CgResult conjugate_gradient(const LinearSystem& system, Preconditioner& preconditioner, const std::vector<Vec3>& b, double tolerance, int max_iterations,
                            std::vector<Vec3>& x, CgWork& work) {
  const std::size_t n = b.size();
  std::vector<Vec3>&r = work.r, &z = work.z, &p = work.p, &q = work.q, &pull = work.pull;
  std::vector<double>& part = work.part;
  for (auto* v : {&r, &z, &p, &q}) v->resize(n);
  x.assign(n, Vec3::Zero());
  r = b;
  CgResult result;
  const double b_norm2 = dot(b, b, part);
  if (b_norm2 == 0) return {0, 0, true, false};
  preconditioner.apply(r, z);
  p = z;
  double rz = dot(r, z, part);
  const double target2 = tolerance * tolerance * b_norm2;
  double r_norm2 = b_norm2;
  while (result.iterations < max_iterations && r_norm2 > target2) {
    const double curvature = system.multiply(p, q, pull, part);
    if (!(curvature > 0)) {
      result.indefinite = true;
      break;
    }
    const double alpha = rz / curvature;
    r_norm2 = parallel_sum(n, ROW_GRAIN, part, [&](std::size_t begin, std::size_t end) {
      double sum = 0;
      for (std::size_t i = begin; i < end; ++i) {
        x[i] += alpha * p[i];
        r[i] -= alpha * q[i];
        sum += r[i].squaredNorm();
      }
      return sum;
    });
    ++result.iterations, ++result.since_renewal;
    if (r_norm2 <= target2) break;
    const bool renewed = preconditioner.renew(system, result.since_renewal);
    if (renewed) result.since_renewal = 0;
    preconditioner.apply(r, z);
    const double rz_next = dot(r, z, part), beta = renewed ? 0 : rz_next / rz; // with another preconditioner the directions start anew
    rz = rz_next;
    parallel_for(n, ROW_GRAIN, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) p[i] = z[i] + beta * p[i];
    });
  }
  result.residual = std::sqrt(r_norm2 / b_norm2);
  result.converged = r_norm2 <= target2;
  return result;
}

} // namespace sloper::cloth

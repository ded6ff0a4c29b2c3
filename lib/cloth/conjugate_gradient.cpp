#include <Eigen/Dense>
#include <cloth/conjugate_gradient.hpp>

#include <cmath>

namespace sloper::cloth {

void BlockJacobi::update(const LinearSystem& system) {
  const int n = system.matrix.size();
  m_inverse.resize(n);
  for (int i = 0; i < n; ++i) m_inverse[i] = system.matrix.diagonal(i);
  for (const ContactElement& e : system.elements) {
    const Mat3 a = e.stiffness();
    for (int k = 0; k < e.n; ++k) m_inverse[e.particle[k]] += e.weight[k] * e.weight[k] * a;
  }
  for (Mat3& m : m_inverse) m = m.inverse().eval();
}

void BlockJacobi::apply(const std::vector<Vec3>& r, std::vector<Vec3>& z) {
  for (std::size_t i = 0; i < r.size(); ++i) z[i].noalias() = m_inverse[i] * r[i];
}

static double dot(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

CgResult conjugate_gradient(const LinearSystem& system, Preconditioner& preconditioner, const std::vector<Vec3>& b, double tolerance, int max_iterations,
                            std::vector<Vec3>& x, CgWork& work) {
  const std::size_t n = b.size();
  auto& [r, z, p, q] = work;
  for (auto* v : {&r, &z, &p, &q}) v->resize(n);
  x.assign(n, Vec3::Zero());
  r = b;
  CgResult result;
  const double b_norm2 = dot(b, b);
  if (b_norm2 == 0) return {0, 0, true, false};
  preconditioner.apply(r, z);
  p = z;
  double rz = dot(r, z);
  const double target2 = tolerance * tolerance * b_norm2;
  double r_norm2 = b_norm2;
  while (result.iterations < max_iterations && r_norm2 > target2) {
    system.multiply(p, q);
    const double curvature = dot(p, q);
    if (!(curvature > 0)) {
      result.indefinite = true;
      break;
    }
    const double alpha = rz / curvature;
    for (std::size_t i = 0; i < n; ++i) {
      x[i] += alpha * p[i];
      r[i] -= alpha * q[i];
    }
    ++result.iterations;
    r_norm2 = dot(r, r);
    if (r_norm2 <= target2) break;
    preconditioner.apply(r, z);
    const double rz_next = dot(r, z), beta = rz_next / rz;
    rz = rz_next;
    for (std::size_t i = 0; i < n; ++i) p[i] = z[i] + beta * p[i];
  }
  result.residual = std::sqrt(r_norm2 / b_norm2);
  result.converged = r_norm2 <= target2;
  return result;
}

} // namespace sloper::cloth

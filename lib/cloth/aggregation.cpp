#include <cloth/aggregation.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::cloth {

namespace {

constexpr double STRONG = 0.08;      // |A_ij|^2 > STRONG^2 |A_ii| |A_jj|
constexpr int COARSEST = 64;         // block rows that are factorised
constexpr double LAMBDA_LIMIT = 4.0; // an element has at most four particles, which bounds the eigenvalues of D^-1 A

BlockRows expand(const BlockMatrix& m) {
  BlockRows out;
  out.rows = out.columns = m.size();
  out.start.assign(m.size() + 1, 0);
  for (int i = 0; i < m.size(); ++i) {
    ++out.start[i + 1];
    for (int k = m.row_start()[i]; k < m.row_start()[i + 1]; ++k) {
      ++out.start[i + 1];
      ++out.start[m.column()[k] + 1];
    }
  }
  for (int i = 0; i < m.size(); ++i) out.start[i + 1] += out.start[i];
  out.column.resize(out.start.back());
  out.value.resize(out.start.back());
  std::vector<int> at(out.start.begin(), out.start.end() - 1);
  auto put = [&](int i, int j, const Mat3& value) {
    out.column[at[i]] = j;
    out.value[at[i]++] = value;
  };
  for (int i = 0; i < m.size(); ++i) { // rows come out sorted: lower part from earlier rows, diagonal, upper part
    put(i, i, m.diagonal(i));
    for (int k = m.row_start()[i]; k < m.row_start()[i + 1]; ++k) {
      put(i, m.column()[k], m.value()[k]);
      put(m.column()[k], i, m.value()[k].transpose());
    }
  }
  return out;
}

BlockRows transpose(const BlockRows& a) {
  BlockRows t;
  t.rows = a.columns;
  t.columns = a.rows;
  t.start.assign(t.rows + 1, 0);
  for (int c : a.column) ++t.start[c + 1];
  for (int i = 0; i < t.rows; ++i) t.start[i + 1] += t.start[i];
  t.column.resize(a.column.size());
  t.value.resize(a.value.size());
  std::vector<int> at(t.start.begin(), t.start.end() - 1);
  for (int i = 0; i < a.rows; ++i)
    for (int k = a.start[i]; k < a.start[i + 1]; ++k) {
      const int slot = at[a.column[k]]++;
      t.column[slot] = i;
      t.value[slot] = a.value[k].transpose();
    }
  return t;
}

BlockRows product(const BlockRows& a, const BlockRows& b) {
  BlockRows c;
  c.rows = a.rows;
  c.columns = b.columns;
  c.start.assign(1, 0);
  std::vector<int> where(b.columns, -1);
  for (int i = 0; i < a.rows; ++i) {
    const int begin = static_cast<int>(c.column.size());
    for (int k = a.start[i]; k < a.start[i + 1]; ++k)
      for (int l = b.start[a.column[k]]; l < b.start[a.column[k] + 1]; ++l) {
        const int j = b.column[l];
        if (where[j] < begin) {
          where[j] = static_cast<int>(c.column.size());
          c.column.push_back(j);
          c.value.push_back(Mat3::Zero());
        }
        c.value[where[j]].noalias() += a.value[k] * b.value[l];
      }
    c.start.push_back(static_cast<int>(c.column.size()));
  }
  return c;
}

void multiply_rows(const BlockRows& a, const std::vector<Vec3>& x, std::vector<Vec3>& y) {
  for (int i = 0; i < a.rows; ++i) {
    Vec3 sum = Vec3::Zero();
    for (int k = a.start[i]; k < a.start[i + 1]; ++k) sum.noalias() += a.value[k] * x[a.column[k]];
    y[i] = sum;
  }
}

std::vector<Mat3> block_diagonal(const BlockRows& a) {
  std::vector<Mat3> d(a.rows, Mat3::Zero());
  for (int i = 0; i < a.rows; ++i)
    for (int k = a.start[i]; k < a.start[i + 1]; ++k)
      if (a.column[k] == i) d[i] += a.value[k];
  return d;
}

/// Aggregate of every row; greedy: whole free neighbourhoods first, then leftovers join their strongest neighbour.
std::vector<int> aggregates(const BlockRows& a, const std::vector<Mat3>& diagonal, int& count) {
  std::vector<double> size(a.rows);
  for (int i = 0; i < a.rows; ++i) size[i] = diagonal[i].norm();
  auto strong = [&](int i, int k) { return a.column[k] != i && a.value[k].squaredNorm() > STRONG * STRONG * size[i] * size[a.column[k]]; };
  std::vector<int> of(a.rows, -1);
  count = 0;
  for (int i = 0; i < a.rows; ++i) {
    if (of[i] >= 0) continue;
    bool is_free = true, has_any = false;
    for (int k = a.start[i]; k < a.start[i + 1] && is_free; ++k)
      if (strong(i, k)) {
        has_any = true;
        is_free = of[a.column[k]] < 0;
      }
    if (!is_free || !has_any) continue;
    of[i] = count;
    for (int k = a.start[i]; k < a.start[i + 1]; ++k)
      if (strong(i, k)) of[a.column[k]] = count;
    ++count;
  }
  const std::vector<int> roots = of;
  for (int i = 0; i < a.rows; ++i) {
    if (of[i] >= 0) continue;
    double best = 0;
    for (int k = a.start[i]; k < a.start[i + 1]; ++k) {
      const double s = a.value[k].squaredNorm();
      if (a.column[k] != i && roots[a.column[k]] >= 0 && s > best) {
        best = s;
        of[i] = roots[a.column[k]];
      }
    }
    if (of[i] < 0) of[i] = count++;
  }
  return of;
}

} // namespace

void Aggregation::multiply(std::size_t level, const std::vector<Vec3>& x, std::vector<Vec3>& y) const {
  if (level == 0) m_system->multiply(x, y);
  else multiply_rows(m_levels[level].a, x, y);
}

void Aggregation::estimate_lambda(std::size_t l, int iterations) {
  Level& level = m_levels[l];
  auto& e = level.eigenvector;
  if (e.empty()) {
    e.resize(level.d_inverse.size());
    for (std::size_t i = 0; i < e.size(); ++i) e[i] = Vec3((i * 7919) % 13 - 6.0, (i * 104729) % 11 - 5.0, (i * 1299709) % 17 - 8.0);
  }
  double lambda = 1;
  for (int it = 0; it < iterations; ++it) {
    double norm2 = 0;
    for (const Vec3& v : e) norm2 += v.squaredNorm();
    const double scale = 1 / std::sqrt(std::max(norm2, 1e-300));
    for (Vec3& v : e) v *= scale;
    multiply(l, e, level.t);
    double next2 = 0;
    for (std::size_t i = 0; i < e.size(); ++i) {
      e[i] = level.d_inverse[i] * level.t[i];
      next2 += e[i].squaredNorm();
    }
    lambda = std::sqrt(next2);
  }
  level.lambda = std::min(1.15 * lambda, LAMBDA_LIMIT);
}

void Aggregation::build(const LinearSystem& system) {
  ++rebuilds;
  m_levels.clear();
  m_levels.emplace_back();
  BlockRows a = expand(system.matrix);
  for (const ContactElement& e : system.elements) { // contacts enter by their diagonal blocks: the pattern stays
    const Mat3 k = e.stiffness();
    for (int c = 0; c < e.n; ++c)
      for (int s = a.start[e.particle[c]]; s < a.start[e.particle[c] + 1]; ++s)
        if (a.column[s] == e.particle[c]) a.value[s] += e.weight[c] * e.weight[c] * k;
  }
  for (;;) {
    Level& fine = m_levels.back();
    const std::vector<Mat3> diagonal = block_diagonal(a);
    fine.d_inverse.resize(a.rows);
    for (int i = 0; i < a.rows; ++i) fine.d_inverse[i] = diagonal[i].inverse();
    for (auto* v : {&fine.r, &fine.z, &fine.t, &fine.d}) v->assign(a.rows, Vec3::Zero());
    if (m_levels.size() > 1) fine.a = a;
    if (a.rows <= COARSEST || m_levels.size() > 8) break;
    estimate_lambda(m_levels.size() - 1, 8);
    int count = 0;
    const std::vector<int> of = aggregates(a, diagonal, count);
    if (count == 0 || count > a.rows * 3 / 4) break;
    // P = (I - omega D^-1 A) P0 with P0 the indicator of the aggregates.
    const double omega = 4.0 / 3.0 / fine.lambda;
    BlockRows p0;
    p0.rows = a.rows;
    p0.columns = count;
    p0.start.resize(a.rows + 1);
    for (int i = 0; i <= a.rows; ++i) p0.start[i] = i;
    p0.column = of;
    p0.value.assign(a.rows, Mat3::Identity());
    BlockRows smoother = a;
    for (int i = 0; i < a.rows; ++i)
      for (int k = a.start[i]; k < a.start[i + 1]; ++k) {
        smoother.value[k] = -omega * fine.d_inverse[i] * a.value[k];
        if (a.column[k] == i) smoother.value[k] += Mat3::Identity();
      }
    fine.p = product(smoother, p0);
    fine.pt = transpose(fine.p);
    a = product(fine.pt, product(a, fine.p));
    m_levels.emplace_back();
  }
  const int n = a.rows;
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  for (int i = 0; i < n; ++i)
    for (int k = a.start[i]; k < a.start[i + 1]; ++k) dense.block<3, 3>(3 * i, 3 * a.column[k]) += a.value[k];
  if (n > 4 * COARSEST) m_levels.clear(); // no coarsening found: plain block Jacobi
  else m_coarsest.compute(dense);
  if (n <= 4 * COARSEST && m_coarsest.info() != Eigen::Success) m_levels.clear();
  m_coarse_vector.resize(3 * n);
  m_iterations_when_fresh = 0;
  m_age = 0;
}

void Aggregation::update(const LinearSystem& system) {
  m_system = &system;
  m_jacobi.update(system);
  const bool tired = m_iterations_when_fresh > 0 && m_last_iterations > m_iterations_when_fresh + m_iterations_when_fresh / 3 + 3;
  if (m_levels.empty() || static_cast<int>(m_levels[0].d_inverse.size()) != system.matrix.size() || tired) build(system);
  if (m_levels.empty()) return;
  m_levels[0].d_inverse = m_jacobi.inverse();
  if (m_age++ > 0) estimate_lambda(0, 2);
}

void Aggregation::report_iterations(int iterations) {
  m_last_iterations = iterations;
  if (m_iterations_when_fresh == 0) m_iterations_when_fresh = std::max(iterations, 8);
}

void Aggregation::smooth(std::size_t l, const std::vector<Vec3>& r, std::vector<Vec3>& z, bool zero_start) {
  // Chebyshev of degree 2 for D^-1 A on [lambda / 4, lambda].
  Level& level = m_levels[l];
  const std::size_t n = r.size();
  const double high = level.lambda, low = high / 4, center = 0.5 * (high + low), half = 0.5 * (high - low);
  std::vector<Vec3>& t = level.t;
  std::vector<Vec3>& d = level.d;
  if (zero_start) {
    for (std::size_t i = 0; i < n; ++i) d[i].noalias() = level.d_inverse[i] * r[i] / center;
    z = d;
  } else {
    multiply(l, z, t);
    for (std::size_t i = 0; i < n; ++i) {
      d[i].noalias() = level.d_inverse[i] * (r[i] - t[i]) / center;
      z[i] += d[i];
    }
  }
  const double sigma = center / half, rho = 1 / sigma, rho_next = 1 / (2 * sigma - rho);
  multiply(l, z, t);
  for (std::size_t i = 0; i < n; ++i) {
    d[i] = rho_next * rho * d[i] + 2 * rho_next / half * (level.d_inverse[i] * (r[i] - t[i]));
    z[i] += d[i];
  }
}

void Aggregation::cycle(std::size_t l) {
  Level& level = m_levels[l];
  if (l + 1 == m_levels.size()) {
    for (std::size_t i = 0; i < level.r.size(); ++i) m_coarse_vector.segment<3>(3 * static_cast<long>(i)) = level.r[i];
    m_coarsest.solveInPlace(m_coarse_vector);
    for (std::size_t i = 0; i < level.r.size(); ++i) level.z[i] = m_coarse_vector.segment<3>(3 * static_cast<long>(i));
    return;
  }
  smooth(l, level.r, level.z, true);
  multiply(l, level.z, level.t);
  for (std::size_t i = 0; i < level.r.size(); ++i) level.t[i] = level.r[i] - level.t[i];
  Level& coarse = m_levels[l + 1];
  multiply_rows(level.pt, level.t, coarse.r);
  cycle(l + 1);
  for (int i = 0; i < level.p.rows; ++i)
    for (int k = level.p.start[i]; k < level.p.start[i + 1]; ++k) level.z[i].noalias() += level.p.value[k] * coarse.z[level.p.column[k]];
  smooth(l, level.r, level.z, false);
}

void Aggregation::apply(const std::vector<Vec3>& r, std::vector<Vec3>& z) {
  if (m_levels.size() < 2) {
    m_jacobi.apply(r, z);
    return;
  }
  m_levels[0].r = r;
  cycle(0);
  z = m_levels[0].z;
}

} // namespace sloper::cloth

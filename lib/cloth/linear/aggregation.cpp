#include <cloth/linear/aggregation.hpp>
#include <sloper/base/parallel.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::cloth {

namespace {

constexpr double STRENGTH_THRESHOLD = 0.08; // |A_ij|^2 > STRENGTH_THRESHOLD^2 |A_ii| |A_jj|
constexpr int COARSEST_ROWS = 64;           // block rows that are factorised
constexpr double LAMBDA_LIMIT =
    4.0; // an element has at most four particles, which bounds the eigenvalues of D^-1 A
constexpr int STALE_HIERARCHY_EXTRA_ITERATIONS =
    12; // iterations beyond those of a fresh hierarchy that are borne: about what a new one costs
constexpr int SOFT_SOLVE_ITERATIONS = 5; // iterations of a solve that reached into soft modes:
                                         // shorter ones mend what is stiff

/// Aggregate of every row; greedy: whole free neighbourhoods first, then leftovers join their
/// strongest neighbour. Rows without a strong neighbour, such as particles that a contact all but
/// pins, get none (-1): smoothing solves them, and on coarser levels each of them would couple with
/// all around.
std::vector<int> aggregates(const BlockRows& a, const std::vector<Mat3>& diagonal, int& count) {
  std::vector<double> size(a.rows);
  for (int i = 0; i < a.rows; ++i)
    size[i] = diagonal[i].norm();
  auto strong = [&](int i, int k) {
    return a.column[k] != i && a.value[k].squaredNorm() > STRENGTH_THRESHOLD * STRENGTH_THRESHOLD *
                                                              size[i] * size[a.column[k]];
  };
  std::vector<int> of(a.rows, -1);
  std::vector<char> alone(a.rows, 1);
  count = 0;
  for (int i = 0; i < a.rows; ++i) {
    bool is_free = of[i] < 0;
    for (int k = a.start[i]; k < a.start[i + 1]; ++k)
      if (strong(i, k)) {
        alone[i] = 0;
        is_free = is_free && of[a.column[k]] < 0;
      }
    if (!is_free || alone[i])
      continue;
    of[i] = count;
    for (int k = a.start[i]; k < a.start[i + 1]; ++k)
      if (strong(i, k))
        of[a.column[k]] = count;
    ++count;
  }
  const std::vector<int> roots = of;
  for (int i = 0; i < a.rows; ++i) {
    if (of[i] >= 0 || alone[i])
      continue;
    double best = 0;
    for (int k = a.start[i]; k < a.start[i + 1]; ++k) {
      const double s = a.value[k].squaredNorm();
      if (a.column[k] != i && roots[a.column[k]] >= 0 && s > best) {
        best = s;
        of[i] = roots[a.column[k]];
      }
    }
    if (of[i] < 0)
      of[i] = count++;
  }
  return of;
}

/// P = (I - omega D^-1 A) P0 with P0 the indicator of the aggregates: what a row has in one
/// aggregate is summed.
void prolongator(const BlockRows& a, const std::vector<Mat3>& d_inverse, const std::vector<int>& of,
                 int count, double omega, BlockRows& p) {
  p.rows = a.rows;
  p.columns = count;
  p.start.assign(a.rows + 1, 0);
  // For rows begin to end - 1: put(i, k, j) for each block k of row i and its column's aggregate.
  const auto visit = [&](std::size_t begin, std::size_t end, const auto& put) {
    for (int i = static_cast<int>(begin); i < static_cast<int>(end); ++i)
      for (int k = a.start[i]; k < a.start[i + 1]; ++k)
        if (const int j = of[a.column[k]]; j >= 0)
          put(i, k, j);
  };
  const auto rows = static_cast<std::size_t>(a.rows);
  parallel_for(rows, ROW_GRAIN, [&](std::size_t begin, std::size_t end) {
    std::vector<int> met_in(count, -1);
    visit(begin, end, [&](int i, int, int j) {
      p.start[i + 1] += met_in[j] != i;
      met_in[j] = i;
    });
  });
  for (int i = 0; i < a.rows; ++i)
    p.start[i + 1] += p.start[i];
  p.column.resize(p.start.back());
  p.value.assign(p.start.back(), Mat3::Zero());
  parallel_for(rows, ROW_GRAIN, [&](std::size_t begin, std::size_t end) {
    std::vector<int> where(count, -1);
    int row = -1, next = 0;
    Mat3 scaled;
    visit(begin, end, [&](int i, int k, int j) {
      if (i != row) {
        row = i;
        next = p.start[i];
        scaled = -omega * d_inverse[i];
      }
      if (where[j] < p.start[i]) {
        where[j] = next++;
        p.column[where[j]] = j;
      }
      const Mat3& block = a.value[k];
      Mat3 smoother;
      if (is_isotropic(block))
        smoother = block(0, 0) * scaled;
      else
        smoother.noalias() = scaled * block;
      if (a.column[k] == i)
        smoother += Mat3::Identity();
      p.value[where[j]] += smoother;
    });
  });
}

} // namespace

/// What the contacts of the finest level do, by contact; rows gather it.
void Aggregation::pull_contacts(const std::vector<Float4>& x) {
  parallel_for(m_contacts.size(), ROW_GRAIN, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      const FloatContact& c = m_contacts[e];
      Float4 s = Float4::all(0);
      for (int k = 0; k < 4; ++k)
        s = s + Float4::all(c.weight[k]) * x[c.particle[k]];
      const Float4 along = c.normal * s;
      const Float4 dot = lane<0>(along) + lane<1>(along) + lane<2>(along);
      m_contact_pull[e] = Float4::all(c.tangent_stiffness) * s +
                          Float4::all(c.normal_stiffness - c.tangent_stiffness) * dot * c.normal;
    }
  });
}

/// put(i, row i of the level's matrix times x) for all rows, contacts included, on all threads.
template<class Put>
void Aggregation::multiply(std::size_t l, const std::vector<Float4>& x, const Put& put) {
  if (l > 0)
    m_levels[l].a.multiply(x, put);
  else
    multiply_finest(m_levels[0].a, x, put);
}

/// Likewise with `rows` and the contacts.
template<class Put>
void Aggregation::multiply_finest(const FloatRows& rows, const std::vector<Float4>& x,
                                  const Put& put) {
  pull_contacts(x);
  rows.multiply(x, [&](std::size_t i, Float4 row) {
    for (int k = m_index->start[i]; k < m_index->start[i + 1]; ++k) {
      const auto [e, at] = m_index->entry[k];
      row = row + Float4::all(m_contacts[e].weight[at]) * m_contact_pull[e];
    }
    put(i, row);
  });
}

/// y = A x, A what is to be solved.
void Aggregation::multiply_system(const std::vector<Float4>& x, std::vector<Float4>& y) {
  multiply_finest(m_has_whole ? m_whole : m_levels[0].a, x,
                  [&](std::size_t i, Float4 row) { y[i] = row; });
}

/// The finest level's matrix, contacts and smoother as they are now.
void Aggregation::copy_finest(const LinearSystem& system) {
  Level& finest = m_levels[0];
  refill(system.matrix, finest.a);
  m_has_whole = system.whole != nullptr;
  if (m_has_whole) {
    if (m_whole.rows() != system.whole->size())
      m_whole = to_float(*system.whole);
    else
      refill(*system.whole, m_whole);
  }
  m_index = &system.index;
  m_contacts.clear();
  for (const ContactElement& e : system.elements) {
    FloatContact c{{e.particle[0], e.particle[0], e.particle[0], e.particle[0]},
                   {},
                   to_float(e.normal),
                   static_cast<float>(e.normal_stiffness),
                   static_cast<float>(e.tangent_stiffness)};
    for (int k = 0; k < e.n; ++k) {
      c.particle[k] = e.particle[k];
      c.weight[k] = static_cast<float>(e.weight[k]);
    }
    m_contacts.push_back(c);
  }
  m_contact_pull.resize(m_contacts.size());
  parallel_for(finest.d_inverse.size(), ROW_GRAIN, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      finest.d_inverse[i] = to_float(m_jacobi.inverse()[i]);
  });
}

void Aggregation::estimate_lambda(std::size_t l, int iterations) {
  Level& level = m_levels[l];
  auto& e = level.eigenvector;
  if (e.empty()) {
    e.resize(level.d_inverse.size());
    for (std::size_t i = 0; i < e.size(); ++i)
      e[i] =
          to_float(Vec3((i * 7919) % 13 - 6.0, (i * 104729) % 11 - 5.0, (i * 1299709) % 17 - 8.0));
  }
  double lambda = 1;
  for (int it = 0; it < iterations; ++it) {
    const Float4 scale =
        Float4::all(static_cast<float>(1 / std::sqrt(std::max(dot(e, e, m_part), 1e-30))));
    for (Float4& v : e)
      v = scale * v;
    multiply(l, e, [&](std::size_t i, Float4 row) { level.t[i] = level.d_inverse[i] * row; });
    std::swap(e, level.t);
    lambda = std::sqrt(dot(e, e, m_part));
  }
  level.lambda = static_cast<float>(std::min(1.15 * lambda, LAMBDA_LIMIT));
}

void Aggregation::build(const LinearSystem& system) {
  ++rebuilds;
  FloatRows finest = m_levels.empty() ? FloatRows() : std::move(m_levels[0].a);
  if (finest.rows() != system.matrix.size())
    finest = to_float(system.matrix);
  m_levels.clear();
  m_levels.emplace_back();
  m_levels.back().a = std::move(finest);
  auto& [a, p, pt, ap] = m_build;
  expand(system.matrix, a);
  for (const ContactElement& e :
       system.elements) { // contacts enter by their diagonal blocks: the pattern stays
    const Mat3 k = e.stiffness();
    for (int c = 0; c < e.n; ++c)
      for (int s = a.start[e.particle[c]]; s < a.start[e.particle[c] + 1]; ++s)
        if (a.column[s] == e.particle[c])
          a.value[s] += e.weight[c] * e.weight[c] * k;
  }
  for (;;) {
    Level& fine = m_levels.back();
    const std::vector<Mat3> diagonal = block_diagonal(a);
    std::vector<Mat3> d_inverse(a.rows);
    fine.d_inverse.resize(a.rows);
    parallel_for(d_inverse.size(), ROW_GRAIN, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        d_inverse[i] = diagonal[i].inverse();
        fine.d_inverse[i] = to_float(d_inverse[i]);
      }
    });
    for (auto* v : {&fine.r, &fine.z, &fine.t, &fine.d})
      v->assign(a.rows, Float4::all(0));
    if (m_levels.size() == 1)
      copy_finest(system); // which has the contacts apart
    else
      fine.a = to_float(a);
    if (a.rows <= COARSEST_ROWS || m_levels.size() > 8)
      break;
    estimate_lambda(m_levels.size() - 1, 8);
    int count = 0;
    const std::vector<int> of = aggregates(a, diagonal, count);
    if (count == 0 || count > a.rows * 3 / 4)
      break;
    prolongator(a, d_inverse, of, count, 4.0 / 3.0 / fine.lambda, p);
    transpose(p, pt);
    fine.p = to_float(p);
    fine.pt = to_float(pt);
    product(a, p, ap);
    product(pt, ap, a);
    m_levels.emplace_back();
  }
  const int n = a.rows;
  m_coarsened = n <= 4 * COARSEST_ROWS;
  if (m_coarsened) {
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(3 * n, 3 * n);
    for (int i = 0; i < n; ++i)
      for (int k = a.start[i]; k < a.start[i + 1]; ++k)
        dense.block<3, 3>(3 * i, 3 * a.column[k]) += a.value[k];
    m_coarsest.compute(dense);
    m_coarsened = m_coarsest.info() == Eigen::Success;
  }
  if (!m_coarsened)
    m_levels.resize(1); // plain block Jacobi
  m_coarse_vector.resize(3 * n);
  m_age = 0;
}

double Aggregation::complexity() const {
  double blocks = 0;
  for (const Level& level : m_levels)
    blocks += static_cast<double>(level.a.blocks());
  return m_levels.empty() ? 1 : blocks / static_cast<double>(m_levels[0].a.blocks());
}

void Aggregation::update(const LinearSystem& system) {
  m_jacobi.update(system);
  const bool tired = m_last_iterations > m_iterations_when_fresh + STALE_HIERARCHY_EXTRA_ITERATIONS;
  if (m_levels.empty() || !m_coarsened ||
      static_cast<int>(m_levels[0].d_inverse.size()) != system.matrix.size() || tired)
    build(system);
  else
    copy_finest(system);
  if (m_age++ > 0)
    estimate_lambda(0, 2);
}

bool Aggregation::renew(const LinearSystem& system, int iterations) {
  if (m_age == 1 || iterations < m_iterations_when_fresh + STALE_HIERARCHY_EXTRA_ITERATIONS)
    return false;
  build(system);
  m_age = 1;
  return true;
}

void Aggregation::report_iterations(int iterations) {
  m_last_iterations = iterations;
  if (m_age == 1)
    m_iterations_when_fresh = iterations;
}

/// Chebyshev of degree 2 for D^-1 A on [lambda / 4, lambda].
void Aggregation::smooth(std::size_t l, bool zero_start) {
  Level& level = m_levels[l];
  const std::vector<Float4>& r = level.r;
  std::vector<Float4>&z = level.z, &t = level.t, &d = level.d;
  const float high = level.lambda, low = high / 4, center = 0.5F * (high + low),
              half = 0.5F * (high - low);
  const Float4 first = Float4::all(1 / center);
  if (zero_start) {
    parallel_for(r.size(), ROW_GRAIN, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        z[i] = d[i] = first * (level.d_inverse[i] * r[i]);
    });
  } else {
    multiply(l, z, [&](std::size_t i, Float4 row) {
      d[i] = first * (level.d_inverse[i] * (r[i] - row));
      t[i] = z[i] + d[i];
    });
    std::swap(z, t);
  }
  const float sigma = center / half, rho = 1 / sigma, rho_next = 1 / (2 * sigma - rho);
  const Float4 keep = Float4::all(rho_next * rho), add = Float4::all(2 * rho_next / half);
  multiply(l, z, [&](std::size_t i, Float4 row) {
    t[i] = z[i] + keep * d[i] + add * (level.d_inverse[i] * (r[i] - row));
  });
  std::swap(z, t);
}

void Aggregation::cycle(std::size_t l) {
  Level& level = m_levels[l];
  if (l + 1 == m_levels.size()) {
    for (std::size_t i = 0; i < level.r.size(); ++i)
      m_coarse_vector.segment<3>(3 * static_cast<long>(i)) = to_double(level.r[i]);
    m_coarsest.solveInPlace(m_coarse_vector);
    for (std::size_t i = 0; i < level.r.size(); ++i)
      level.z[i] = to_float(Vec3(m_coarse_vector.segment<3>(3 * static_cast<long>(i))));
    return;
  }
  smooth(l, true);
  multiply(l, level.z, [&](std::size_t i, Float4 row) { level.t[i] = level.r[i] - row; });
  Level& coarse = m_levels[l + 1];
  level.pt.multiply(level.t, [&](std::size_t i, Float4 row) { coarse.r[i] = row; });
  cycle(l + 1);
  level.p.multiply(coarse.z, [&](std::size_t i, Float4 row) { level.z[i] = level.z[i] + row; });
  smooth(l, false);
}

/// r, scaled to unit size, as the finest level's: single precision has its range around 1. Returns
/// what that size was.
double Aggregation::take_in(const std::vector<Vec3>& r) {
  double largest = 0;
  for (const Vec3& v : r)
    largest = std::max(largest, v.cwiseAbs().maxCoeff());
  if (largest == 0)
    largest = 1;
  const double shrink = 1 / largest;
  parallel_for(r.size(), ROW_GRAIN, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      m_levels[0].r[i] = to_float(Vec3(shrink * r[i]));
  });
  return largest;
}

static void hand_out(const std::vector<Float4>& from, double scale, std::vector<Vec3>& to) {
  parallel_for(from.size(), ROW_GRAIN, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      to[i] = scale * to_double(from[i]);
  });
}

/// The finest level's z from its r; block Jacobi without a hierarchy.
void Aggregation::precondition_finest() {
  if (m_levels.size() > 1)
    return cycle(0);
  Level& finest = m_levels[0];
  for (std::size_t i = 0; i < finest.r.size(); ++i)
    finest.z[i] = finest.d_inverse[i] * finest.r[i];
}

void Aggregation::apply(const std::vector<Vec3>& r, std::vector<Vec3>& z) {
  const double scale = take_in(r);
  precondition_finest();
  hand_out(m_levels[0].z, scale, z);
}

static double longest(const std::vector<Float4>& v) {
  Float4 most = Float4::all(0);
  for (const Float4& p : v) {
    const Float4 squares = p * p;
    most = max(most, lane<0>(squares) + lane<1>(squares) + lane<2>(squares));
  }
  return std::sqrt(to_double(most).x());
}

struct Aggregation::SingleSpace {
  Aggregation& a;
  const LinearSystem& system;

  double precondition() {
    a.precondition_finest();
    a.m_deflation.project(a.m_levels[0].r, a.m_levels[0].z);
    return dot(a.m_levels[0].r, a.m_levels[0].z, a.m_part);
  }
  void turn(double beta) {
    const Float4 keep = Float4::all(static_cast<float>(beta));
    const std::vector<Float4>& z = a.m_levels[0].z;
    parallel_for(z.size(), ROW_GRAIN, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        a.m_p[i] = z[i] + keep * a.m_p[i];
    });
  }
  double multiply() {
    a.multiply_system(a.m_p, a.m_q);
    return dot(a.m_p, a.m_q, a.m_part);
  }
  double advance(double alpha) {
    const Float4 step = Float4::all(static_cast<float>(alpha));
    std::vector<Float4>& r = a.m_levels[0].r;
    parallel_for(r.size(), ROW_GRAIN, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        a.m_x[i] = a.m_x[i] + step * a.m_p[i];
        r[i] = r[i] - step * a.m_q[i];
      }
    });
    return dot(r, r, a.m_part);
  }
  double longest_x() const { return longest(a.m_x); }
  double longest_p() const { return longest(a.m_p); }
  bool renew(int iterations) {
    std::vector<Float4> r = std::move(a.m_levels[0].r); // a new hierarchy has new vectors
    const bool renewed = a.renew(system, iterations);
    a.m_levels[0].r = std::move(r);
    return renewed;
  }
};

/// Starts the solve for r, which the finest level has as its own, from the basis of the last ones,
/// if the system recurs and they lead no farther than the radius.
void Aggregation::deflate(const LinearSystem& system, const std::vector<Vec3>& r, double radius) {
  m_deflation.leave_out();
  if (!system.recurs)
    return;
  m_deflation.prepare(r.size(), [&](const std::vector<Float4>& x, std::vector<Float4>& y) {
    multiply_system(x, y);
  });
  if (m_deflation.size() == 0)
    return;
  m_deflation.start(m_x, m_levels[0].r);
  if (longest(m_x) < radius)
    return;
  m_deflation.leave_out();
  m_x.assign(r.size(), Float4::all(0));
  take_in(r);
}

bool Aggregation::solve_in_single(const LinearSystem& system, const std::vector<Vec3>& r,
                                  const CgLimits& limits, std::vector<Vec3>& x, CgResult& result) {
  const double scale = take_in(r);
  for (auto* v : {&m_x, &m_p, &m_q})
    v->assign(r.size(), Float4::all(0));
  const std::vector<Float4>& residual = m_levels[0].r;
  const double share = limits.tolerance.residual;
  const double target2 = share * share * dot(residual, residual, m_part);
  CgLimits scaled = limits;
  scaled.radius /= scale;
  deflate(system, r, scaled.radius);
  const int before = result.iterations;
  conjugate_gradient_loop(SingleSpace{*this, system}, dot(residual, residual, m_part), target2,
                          scaled, result);
  if (system.recurs && result.iterations >= before + SOFT_SOLVE_ITERATIONS)
    m_deflation.keep(m_x);
  hand_out(m_x, scale, x);
  return true;
}

} // namespace sloper::cloth

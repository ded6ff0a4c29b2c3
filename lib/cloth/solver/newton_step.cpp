/// A step with inertia in several solves: to the minimum of the incremental potential, where one
/// linearised solve stops short of it or beyond.
#include <sloper/cloth/solver/implicit_step.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sloper::cloth {

namespace {

constexpr double GRADIENT_DONE = 0.01; // weights of a particle, root mean square
constexpr double LEAST_MOVE = 1e-7;    // m of the farthest particle: more solves change nothing
constexpr int HALVINGS = 10;           // halvings of a solve, at most

double dot(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += a[i].dot(b[i]);
  return sum;
}

double farthest_of(const std::vector<Vec3>& displacement) {
  double most2 = 0;
  for (const Vec3& w : displacement)
    most2 = std::max(most2, w.squaredNorm());
  return std::sqrt(most2);
}

} // namespace

/// Damping and drag cost 1/(2h) dx' D dx, with D = -df/dv as it is where the step begins:
/// quadratic, so that no displacement, however far cloth turns on it, gains by them. Effects say no
/// more of D than what they add of it to their stiffness, so it is the difference to a step of
/// endless time.
void ClothSolver::assemble_drag(double h) {
  std::vector<Vec3> unused(m_x.size(), Vec3::Zero());
  std::vector<ContactElement> none;
  const auto fill = [&](BlockMatrix& matrix, double step) {
    matrix = m_matrix;
    matrix.set_zero();
    StepContext context{m_x, step, unused, matrix, none};
    for (const auto& e : m_effects)
      if (!e->is_search())
        e->add(context);
  };
  fill(m_with_drag, h);
  fill(m_without_drag, std::numeric_limits<double>::infinity());
}

/// (D/h) displacement, N.
void ClothSolver::drag_of(const std::vector<Vec3>& displacement, std::vector<Vec3>& drag) {
  m_with_drag.multiply(displacement, drag);
  m_without_drag.multiply(displacement, m_trial_dx);
  for (std::size_t i = 0; i < drag.size(); ++i)
    drag[i] -= m_trial_dx[i];
}

bool ClothSolver::gains(const StepOptions& o) {
  if (std::any_of(m_effects.begin(), m_effects.end(), [](const auto& e) { return e->crosses(); }))
    return false;
  double inertia = 0;
  for (std::size_t i = 0; i < m_x.size(); ++i) {
    const Vec3 flies = o.inertia * o.h * m_v[i];
    inertia +=
        m_mesh.mass[i] / (2 * o.h * o.h) * ((m_dx[i] - flies).squaredNorm() - flies.squaredNorm());
  }
  return energy_after(m_dx) + inertia > energy(m_x);
}

StepResult ClothSolver::newton_step(const StepOptions& o, int most_solves, bool begun) {
  const std::size_t n = m_x.size();
  const std::vector<Vec3> start = m_x;
  std::vector<Vec3> aim = m_x, displacement(n, Vec3::Zero()), drag(n, Vec3::Zero()),
                    trial_drag(n); // aim: where inertia alone would bring it
  for (std::size_t i = 0; i < n; ++i)
    aim[i] += o.inertia * o.h * m_v[i];
  const auto mass_h2 = [&](std::size_t i) { return m_mesh.mass[i] / (o.h * o.h); };
  const auto potential = [&](const std::vector<Vec3>& x, std::vector<Vec3>& drag_there) {
    for (std::size_t i = 0; i < n; ++i)
      displacement[i] = x[i] - start[i];
    drag_of(displacement, drag_there);
    double sum = energy(x) + 0.5 * dot(displacement, drag_there);
    for (std::size_t i = 0; i < n; ++i)
      sum += 0.5 * mass_h2(i) * (x[i] - aim[i]).squaredNorm();
    return sum;
  };
  StepResult result;
  result.newton_iterations = 0;
  m_limits.planes_translate = true;
  m_held.assign(n, 0);
  m_trial.resize(n);
  m_trial_dx.resize(n);
  const double done2 = static_cast<double>(n) * std::pow(GRADIENT_DONE * m_mean_weight, 2);
  for (int k = 0; k < most_solves; ++k) {
    assemble(o.h, begun || k > 0);
    add_forces(m_elements, m_force);
    if (k == 0)
      assemble_drag(o.h);
    for (std::size_t i = 0; i < n; ++i) {
      m_matrix.add_isotropic_diagonal(static_cast<int>(i), mass_h2(i));
      m_rhs[i] = m_force[i] - drag[i] + mass_h2(i) * (aim[i] - m_x[i]);
    }
    bool finite = assembled_finite();
    if (finite) {
      if (k > 0 && dot(m_rhs, m_rhs) <= done2)
        break;
      const CgResult cg = solve(o);
      result.cg.iterations += cg.iterations;
      result.cg.residual = cg.residual;
      result.cg.indefinite |= cg.indefinite;
      finite = std::isfinite(dot(m_dx, m_dx));
    }
    if (!finite) { // as in step(): nothing is moved
      m_x = start;
      result.finite = false;
      return result;
    }
    ++result.newton_iterations;
    m_step = m_dx;
    const double before = potential(m_x, drag);
    double share = std::min(1.0, o.largest_move_m / std::max(farthest_of(m_dx), LEAST_MOVE));
    bool lower = false;
    for (int halvings = 0; !lower && halvings <= HALVINGS; ++halvings, share *= 0.5) {
      for (std::size_t i = 0; i < n; ++i)
        m_dx[i] = share * m_step[i];
      m_held.assign(n, 0);
      limit(m_dx, m_held);
      for (std::size_t i = 0; i < n; ++i)
        m_trial[i] = m_x[i] + m_dx[i];
      lower = potential(m_trial, trial_drag) < before;
      result.halvings += !lower;
    }
    if (!lower)
      break;
    std::swap(m_x, m_trial);
    std::swap(drag, trial_drag);
    if (farthest_of(m_dx) < LEAST_MOVE)
      break;
  }
  for (std::size_t i = 0; i < n; ++i)
    m_dx[i] = m_x[i] - start[i];
  m_x = start;
  conclude(o, result);
  return result;
}

} // namespace sloper::cloth

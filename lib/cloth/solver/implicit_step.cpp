#include <cloth/linear/aggregation.hpp>
#include <sloper/base/error.hpp>
#include <sloper/base/parallel.hpp>
#include <sloper/base/statistics.hpp>
#include <sloper/base/units.hpp>
#include <sloper/cloth/solver/implicit_step.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace sloper::cloth {

namespace {

constexpr int MOST_HALVINGS = 10;
constexpr double MOST_CUT = 0.5;   // of an edge
constexpr int LONGEST_FREEZE = 16; // steps
constexpr double FROZEN = 1e4;     // times a particle's own stiffness
constexpr double NEAR_REST = 1;    // weights, of the 95th percentile of the forces
constexpr double OUTLIER = 10;     // times that percentile
constexpr double TIGHTEST = 0.01;  // of the tolerance
constexpr std::size_t REMEMBERED =
    20; // energies of the steps before: a step may end as high as the highest of them
constexpr double GAIN =
    0.2; // of how far they go up and down: with less, such steps lead round in a circle
constexpr double MOST_CARRIED = 0.9; // share of the last step's way
constexpr double TRUSTED = 0.2;      // of an edge: how far a step with the whole stiffness goes
constexpr double LOOSER = 3; // the tolerance of such a step, whose matrix is all but singular
constexpr double TURNED_BACK = 0.5; // cosine of the angle between a step and the way back

/// Adds the wall seconds of its own life to a counter.
class Stopwatch {
public:
  explicit Stopwatch(double& total) : m_total(total), m_start(std::chrono::steady_clock::now()) {}
  ~Stopwatch() {
    m_total += std::chrono::duration<double>(std::chrono::steady_clock::now() - m_start).count();
  }

private:
  double& m_total;
  std::chrono::steady_clock::time_point m_start;
};

bool all_finite(const std::vector<Vec3>& x) {
  for (const Vec3& p : x)
    if (!p.allFinite())
      return false;
  return true;
}

} // namespace

ClothSolver::ClothSolver(const ClothMesh& mesh, std::vector<Vec3>& x, std::vector<Vec3>& v)
    : m_mesh(mesh), m_x(x), m_v(v), m_preconditioner(std::make_unique<Aggregation>()) {
  begin();
}

ClothSolver::ClothSolver(const ClothMesh& mesh, std::vector<Vec3> x)
    : m_mesh(mesh), m_own_x(std::move(x)), m_x(m_own_x), m_v(m_own_v),
      m_preconditioner(std::make_unique<Aggregation>()) {
  begin();
}

void ClothSolver::begin() {
  const ClothMesh& mesh = m_mesh;
  if (static_cast<int>(m_x.size()) != mesh.n_particles)
    throw Error(ErrorKind::INTERNAL, "general.internal"_id, "", "",
                "positions and particles differ in number");
  if (!all_finite(m_x))
    throw input_error("garment.not-finite"_id, "", "",
                      "a particle's position is not a finite number");
  if (m_v.size() != m_x.size())
    m_v.assign(m_x.size(), Vec3::Zero());
  m_force.assign(m_x.size(), Vec3::Zero());
  m_rhs = m_dx = m_force;
  m_block_for.assign(m_x.size(), 0);
  m_blocked_for = m_block_for;
  for (double e : mesh.shortest_edge)
    m_mean_edge += e / mesh.n_particles;
  for (double m : mesh.mass)
    m_mean_weight += m * units::GRAVITY / mesh.n_particles;
}

Effect& ClothSolver::add(std::unique_ptr<Effect> effect) {
  m_pattern_stale = true;
  forget();
  m_effects.push_back(std::move(effect));
  return *m_effects.back();
}

std::unique_ptr<Effect> ClothSolver::remove(const Effect& effect) {
  const auto found = std::find_if(m_effects.begin(), m_effects.end(),
                                  [&](const auto& e) { return e.get() == &effect; });
  if (found == m_effects.end())
    return nullptr;
  std::unique_ptr<Effect> taken = std::move(*found);
  m_effects.erase(found);
  m_pattern_stale = true;
  forget();
  return taken;
}

void ClothSolver::set_positions(std::vector<Vec3> x) {
  m_x = std::move(x);
  stop();
}

void ClothSolver::rebuild_pattern() {
  Couplings couplings;
  for (const auto& e : m_effects)
    e->declare(couplings);
  m_matrix = BlockMatrix(m_mesh.n_particles, std::move(couplings));
  for (const auto& e : m_effects)
    e->bind(m_matrix);
  m_preconditioner->reset();
  m_pattern_stale = false;
}

double ClothSolver::energy(const std::vector<Vec3>& x) const {
  std::vector<double> part;
  return parallel_sum(m_effects.size(), 1, part,
                      [&](std::size_t k, std::size_t) { return m_effects[k]->energy(x); });
}

double ClothSolver::energy_after(const std::vector<Vec3>& dx) {
  m_trial.resize(m_x.size());
  for (std::size_t i = 0; i < m_x.size(); ++i)
    m_trial[i] = m_x[i] + dx[i];
  return energy(m_trial);
}

/// Projecting onto one plane can push a particle into a pair that had no plane: re-check and add
/// planes, up to MAX_CCD_ROUNDS times.
void ClothSolver::limit(std::vector<Vec3>& dx, std::vector<char>& held) {
  m_limits.apply(m_x, dx, held);
  for (int round = 1; round <= MAX_CCD_ROUNDS; ++round) {
    bool more = false;
    for (const auto& e : m_effects)
      more |= e->add_separating_planes(m_x, dx, m_limits, round == MAX_CCD_ROUNDS);
    if (!more)
      return;
    m_limits.apply(m_x, dx, held);
  }
}

void ClothSolver::forget() {
  m_energies.clear();
  m_falls_for = 0;
  m_last_dx.clear();
  m_carried_for = 0;
}

/// Cloth that hardly stretches comes to rest along narrow, winding valleys, of which a step sees
/// the tangent: a part of the last step's way goes on top, more with each step that goes the same
/// way, none after one that turns back or that the line search shortened (momentum with restarts,
/// O'Donoghue and Candes 2015; turning is judged by ways, since forces are those of the stretch
/// that leaving the valley's ground costs, whichever way).
void ClothSolver::carry_on() {
  double same_way = 0, falls = 0;
  for (std::size_t i = 0; i < m_dx.size(); ++i)
    same_way += m_dx[i].dot(m_last_dx[i]);
  if (same_way < 0)
    m_carried_for = 0;
  if (m_carried_for == 0)
    return;
  const double share = std::min(MOST_CARRIED, m_carried_for / (m_carried_for + 3.0));
  for (std::size_t i = 0; i < m_dx.size(); ++i)
    falls += m_force[i].dot(m_dx[i] + share * m_last_dx[i]);
  if (falls <= 0) {
    m_carried_for = 0;
    return;
  }
  for (std::size_t i = 0; i < m_dx.size(); ++i)
    m_dx[i] += share * m_last_dx[i];
}

/// Whether this step undoes most of the last one.
bool ClothSolver::turns_back() const {
  if (m_last_dx.size() != m_dx.size())
    return false;
  double same_way = 0, now = 0, last = 0;
  for (std::size_t i = 0; i < m_dx.size(); ++i) {
    same_way += m_dx[i].dot(m_last_dx[i]);
    now += m_dx[i].squaredNorm();
    last += m_last_dx[i].squaredNorm();
  }
  return same_way < -TURNED_BACK * std::sqrt(now * last);
}

/// Whether steps that cost energy do not gain any: the lowest of the last half of those remembered
/// is below the lowest of the first half by less than a fifth of how far energies went up and down.
bool ClothSolver::goes_round() const {
  if (m_energies.size() < REMEMBERED)
    return false;
  const auto half = m_energies.begin() + REMEMBERED / 2;
  const auto [low, high] = std::minmax_element(half, m_energies.end());
  return *std::min_element(m_energies.begin(), half) - *low < GAIN * (*high - *low);
}

/// Halves the step until the energy falls, or doubles it while it keeps falling: where cloth
/// buckles the definite part is far stiffer than the cloth, and whole steps are much too short.
/// With momentum one step may cost energy which the next ones regain (Grippo, Lampariello and
/// Lucidi 1986); where they do not, each must fall for a while. A look ahead costs a fraction of a
/// solve. Each length is limited anew: what limits cut from a long step bends it away from where
/// the energy falls, and a short one they leave alone.
int ClothSolver::search_along(const StepOptions& o) {
  const Stopwatch watch(search_s);
  double best = energy(m_x), allowed = best;
  if (o.momentum) {
    m_energies.push_back(best);
    if (m_energies.size() > REMEMBERED)
      m_energies.erase(m_energies.begin());
    if (m_falls_for == 0 && goes_round())
      m_falls_for = REMEMBERED / 2;
    if (m_falls_for == 0)
      allowed = *std::max_element(m_energies.begin(), m_energies.end());
    else if (--m_falls_for == 0)
      m_energies.clear();
  }
  double largest = 0;
  for (const Vec3& d : m_step)
    largest = std::max(largest, d.norm());
  const auto try_length = [&](double share) { // keeps the step when it is better
    m_trial_dx.resize(m_step.size());
    for (std::size_t i = 0; i < m_step.size(); ++i)
      m_trial_dx[i] = share * m_step[i];
    m_trial_held.assign(m_step.size(), 0);
    limit(m_trial_dx, m_trial_held);
    const double after = energy_after(m_trial_dx);
    if (!(after < best))
      return false;
    best = after;
    std::swap(m_dx, m_trial_dx);
    std::swap(m_held, m_trial_held);
    return true;
  };
  const double after = energy_after(m_dx);
  if (after <= allowed && turns_back()) { // whole steps may go to and fro across the rest
    best = after;
    try_length(0.5);
    return 0;
  }
  if (after <= best) {
    best = after;
    for (double share = 2; share * largest <= o.largest_move_m && try_length(share);)
      share *= 2;
  }
  if (after <= allowed)
    return 0;
  best = allowed;
  double share = 0.5;
  for (int halvings = 1; halvings <= MOST_HALVINGS; ++halvings, share *= 0.5)
    if (try_length(share))
      return halvings;
  std::fill(m_dx.begin(), m_dx.end(), Vec3::Zero());
  return MOST_HALVINGS;
}

/// The 95th percentile, which ends up in its place; not of nothing.
static std::vector<double>::iterator percentile_95(std::vector<double>& values) {
  return place_rank(values, quantile_rank(values.size(), 0.95));
}

/// A particle stuck in a pinch bends the step away from where the energy falls, or is pressed there
/// harder than all others. It is kept in place for a while, longer each time, while the rest goes
/// on. With momentum, which lets energy rise, only what limits hold: the rest comes no sooner for
/// others. Where tension draws all cloth, all of it slides, and blocking would only delay it.
void ClothSolver::block_held_particles(bool search_failed, const StepOptions& o) {
  double wedged2 = std::numeric_limits<double>::infinity();
  if (search_failed && !o.momentum) {
    m_residual.clear();
    for (const Vec3& f : m_force)
      m_residual.push_back(f.squaredNorm());
    const double p95 = *percentile_95(m_residual);
    wedged2 = OUTLIER * OUTLIER * std::max(p95, m_mean_weight * m_mean_weight);
    search_failed = std::sqrt(p95) <= o.blocking_force_ratio * m_mean_weight;
  }
  for (std::size_t i = 0; i < m_held.size(); ++i) {
    if (m_blocked_for[i] > 0) {
      --m_blocked_for[i];
      m_held[i] = 1;
    } else if (search_failed && (m_held[i] || m_force[i].squaredNorm() > wedged2)) {
      m_block_for[i] = std::clamp(2 * m_block_for[i], 1, LONGEST_FREEZE);
      m_blocked_for[i] = m_block_for[i];
    } else {
      m_block_for[i] /= 2;
    }
  }
}

std::array<double, 2> ClothSolver::measure_rhs() {
  double all = 0;
  m_residual.clear();
  for (const Vec3& r : m_rhs) {
    m_residual.push_back(r.squaredNorm());
    all += m_residual.back();
  }
  return {*percentile_95(m_residual), all};
}

/// Near rest a few particles in a pinch can have a thousand times the force of all others, and a
/// residual relative to theirs would leave the others in place for hundreds of steps. They count as
/// outliers: the tolerance is relative to the rest, but asks for no more than rest does.
double ClothSolver::near_tolerance(const StepOptions& o,
                                   const std::array<double, 2>& squares) const {
  const auto [p95, all] = squares;
  const double most = OUTLIER * OUTLIER * p95;
  double capped = 0;
  for (double r : m_residual)
    capped += std::min(r, most);
  const double fine_enough =
      o.least_residual_ratio * m_mean_weight * std::sqrt(static_cast<double>(m_rhs.size()) / all);
  return std::max(std::min(fine_enough, o.cg_tolerance),
                  o.cg_tolerance * std::max(TIGHTEST, std::sqrt(capped / all)));
}

void ClothSolver::prefetch_contacts(double h) {
  if (m_pattern_stale)
    return; // pairs hold places in the matrix
  for (const auto& e : m_effects) {
    const Stopwatch watch(e->wall_s);
    e->prefetch_contacts(m_x, h);
  }
}

/// False where a position, a force or a stiffness was no number: conjugate gradients would return
/// no motion and hide it.
bool ClothSolver::assembled_finite() const {
  for (std::size_t i = 0; i < m_rhs.size(); ++i)
    if (!std::isfinite(m_rhs[i].sum() + m_matrix.diagonal(static_cast<int>(i)).sum()))
      return false;
  return true;
}

/// Of what is assembled, for m_dx.
CgResult ClothSolver::solve(const StepOptions& o) {
  CgTolerance tolerance(o.cg_tolerance, o.cg_energy_tolerance);
  double radius = std::numeric_limits<double>::infinity();
  bool whole = false;
  if (o.line_search) {
    const std::array<double, 2> squares = measure_rhs();
    const double near = NEAR_REST * m_mean_weight;
    if (squares[1] > 0 && squares[0] <= near * near) {
      tolerance.residual = near_tolerance(o, squares);
      whole = o.full_hessian_near_rest;
    }
  }
  if (whole) {
    const Stopwatch watch(assembly_s);
    m_whole = m_matrix;
    for (const auto& e : m_effects)
      e->add_indefinite_part(m_x, m_whole);
    radius = TRUSTED * m_mean_edge;
    tolerance.residual *= LOOSER;
  }
  const Stopwatch watch(solve_s);
  m_contacts.build(m_elements, m_x.size());
  const LinearSystem system{m_matrix, m_elements, m_contacts, whole ? &m_whole : nullptr,
                            o.line_search};
  m_preconditioner->update(system);
  const CgResult result = conjugate_gradient(
      system, *m_preconditioner, m_rhs, {tolerance, o.cg_max_iterations, radius}, m_dx, m_work);
  m_preconditioner->report_iterations(result.since_renewal);
  return result;
}

/// Forces, stiffness, elements and limits of all effects, in their order: the same sums for any
/// number of threads. What the first effects add is added while those that search do so.
void ClothSolver::assemble(double h, bool again) {
  m_matrix.set_zero();
  m_elements.clear();
  m_limits.reset(m_x.size());
  std::fill(m_force.begin(), m_force.end(), Vec3::Zero());
  const auto add = [&](Effect& e) {
    const Stopwatch watch(e.wall_s);
    if (!e.is_search() && !again)
      e.begin_step(m_x, h);
    StepContext context{m_x, h, m_force, m_matrix, m_elements, &m_limits};
    e.add(context);
    ++e.calls;
  };
  const auto first_search = std::find_if(m_effects.begin(), m_effects.end(),
                                         [](const auto& e) { return e->is_search(); });
  parallel_for(2, 1, [&](std::size_t task, std::size_t) {
    if (task == 0) {
      std::for_each(m_effects.begin(), first_search, [&](const auto& e) { add(*e); });
      return;
    }
    for (const auto& e : m_effects) {
      if (!e->is_search())
        continue;
      const Stopwatch watch(e->wall_s);
      if (again)
        e->update_contacts(m_x, h);
      else
        e->begin_step(m_x, h);
    }
  });
  std::for_each(first_search, m_effects.end(), [&](const auto& e) { add(*e); });
}

StepResult ClothSolver::step(const StepOptions& o) {
  if (m_pattern_stale)
    rebuild_pattern();
  if (o.newton_iterations > 1 && o.inertia > 0 && !o.line_search)
    return newton_step(o, o.newton_iterations, false);
  const std::size_t n = m_x.size();
  StepResult result;
  m_limits.planes_translate = !o.line_search && o.inertia > 0;
  assemble(o.h);
  {
    const Stopwatch watch(assembly_s);
    add_forces(m_elements, m_force);
    for (std::size_t i = 0; i < n; ++i) {
      double inertia = m_mesh.mass[i] / (o.h * o.h);
      const bool blocked = m_blocked_for[i] > 0;
      if (blocked)
        inertia += FROZEN * m_matrix.diagonal(static_cast<int>(i)).trace();
      m_matrix.add_isotropic_diagonal(static_cast<int>(i), inertia);
      // The pinch takes the force of what is blocked. In the right-hand side it would be all that
      // the solve's tolerances measure, and the rest of the cloth would move by what is left over.
      m_rhs[i] = blocked ? Vec3(Vec3::Zero())
                         : Vec3(m_force[i] + o.inertia * m_mesh.mass[i] / o.h * m_v[i]);
    }
  }
  if (!assembled_finite()) {
    result.finite = false;
    return result;
  }
  result.cg = solve(o);
  if (o.line_search && o.momentum && m_carried_for > 0)
    carry_on();
  double largest2 = 0;
  for (const Vec3& d : m_dx)
    largest2 = std::max(largest2, d.squaredNorm());
  if (largest2 > o.largest_move_m * o.largest_move_m) { // the whole step is shortened: cut one by
                                                        // one, neighbours would crumple
    const double scale = o.largest_move_m / std::sqrt(largest2);
    for (Vec3& d : m_dx)
      d *= scale;
  }
  {
    const Stopwatch watch(contact_s);
    m_held.assign(n, 0);
    m_step = m_dx;
    limit(m_dx, m_held);
    double cut2 = 0;
    for (std::size_t i = 0; i < n; ++i)
      cut2 = std::max(cut2, (m_step[i] - m_dx[i]).squaredNorm());
    const double cut = std::sqrt(cut2), most = MOST_CUT * m_mean_edge;
    if (!o.line_search && cut > most) {
      for (std::size_t i = 0; i < n; ++i)
        m_dx[i] = most / cut * m_step[i];
      m_held.assign(n, 0);
      limit(m_dx, m_held);
    }
  }
  if (!all_finite(m_dx)) {
    result.finite = false;
    return result;
  }
  if (o.guard_energy && o.inertia > 0 && !o.line_search && gains(o))
    return newton_step(o, StepOptions::GUARD_SOLVES, true);
  if (o.line_search) {
    result.halvings = search_along(o);
    block_held_particles(result.halvings > 0, o);
    if (o.momentum)
      m_carried_for = result.halvings > 0 ? 0 : m_carried_for + 1;
    else
      forget();
    m_last_dx = m_dx;
  }
  conclude(o, result);
  return result;
}

void ClothSolver::conclude(const StepOptions& o, StepResult& result) {
  m_residual.clear();
  for (std::size_t i = 0; i < m_x.size(); ++i) {
    if (m_held[i])
      ++result.held;
    else
      m_residual.push_back(m_force[i].norm());
  }
  if (!m_residual.empty()) {
    const auto p95 = percentile_95(m_residual);
    result.residual_force_ratio = *p95 / m_mean_weight;
    result.residual_force_ratio_max = *std::max_element(p95, m_residual.end()) / m_mean_weight;
  }
  for (std::size_t i = 0; i < m_x.size(); ++i) {
    result.largest_move_m = std::max(result.largest_move_m, m_dx[i].norm());
    m_x[i] += m_dx[i];
    m_v[i] = m_dx[i] / o.h;
  }
  for (const auto& e : m_effects)
    e->end_step(m_x);
}

} // namespace sloper::cloth

#pragma once
/// The semi-implicit step of the paper (eq. 1), written for the displacement dx = h (v0 + dv):
///   (M/h^2 + D/h + K) dx = f0 + inertia * M v0 / h,   K = -df/dx (definite part), D = -df/dv.
/// With inertia 1 this is (M - h df/dv - h^2 df/dx) dv = h (f0 + h df/dx v0); with inertia 0 it is
/// the overdamped flow that goes to rest in few large steps.
/// Test: tests/cloth/solver/test_implicit_step.cpp
#include <memory>
#include <sloper/cloth/cloth_mesh.hpp>
#include <sloper/cloth/effect.hpp>
#include <sloper/cloth/linear/conjugate_gradient.hpp>

namespace sloper::cloth {

/// How one step is made.
struct StepOptions {
  double h = 1.0 / 30; ///< s
  /// 0..1: share of the velocity that is kept; 0 is the overdamped flow.
  double inertia = 0;
  /// Relative residual of a solve; near rest, with a line search, relative to the
  /// residual without outliers.
  double cg_tolerance = 1e-2;
  /// A solve also ends where this share of its error is left in the energy norm
  /// (CgTolerance::energy; 0: never): of the energy that the step's model gains, all but the square
  /// of that share.
  double cg_energy_tolerance = 0;
  /// Residual below which a solve near rest need not go: root mean square over the
  /// particles, over the mean weight of a particle; no more than the residual that counts
  /// as rest.
  double least_residual_ratio = 0;
  int cg_max_iterations = 400; ///< of one solve
  /// With inertia and without line_search: the most solves of a step. 1 is the linearised step of
  /// the paper: inaccurate for large rotations, which it turns into stretch and spurious energy.
  /// More are Newton iterations on the incremental potential E(x) + |x - x0 - h v0|^2_M / (2 h^2)
  /// with damping, each with a line search (backward Euler; Kane et al. 2000), until its gradient
  /// is a hundredth of a particle's weight, root mean square.
  int newton_iterations = 1;
  /// With inertia and without line_search: a step of one solve that would raise that potential,
  /// damping aside, is solved again, up to GUARD_SOLVES times, so that cloth that turns fast does
  /// not burst. Other steps cost two evaluations of the energy more. Not where cloth crosses
  /// something: there contact is meant to push it out.
  bool guard_energy = false;
  /// Most solves of a step with guard_energy.
  static constexpr int GUARD_SOLVES = 8;
  /// Halves the step until the energy falls, doubles it while the energy goes on falling, and
  /// halves a step that takes back the last one; where no step lowers the energy, nothing moves.
  /// Where it halves, particles that limits hold, and without momentum those with ten times the
  /// force of nearly all others, are blocked for up to 16 steps. Solves start from the recycling
  /// basis (Deflation). If false: a limit that cuts a displacement by half an edge shortens all of
  /// them. Measured: docs/decisions/rest-by-energy-descent.md
  bool line_search = false;
  /// With line_search: adds a share of the last displacement (O'Donoghue and Candes 2015), and a
  /// step may end as high as the highest of the last 20 energies (Grippo et al. 1986); where these
  /// only oscillate, each step must fall for 10 steps. Halves the number of steps where the energy
  /// alone bounds them, with h far above 0.2 s. Not for garments that friction holds: momentum
  /// carries cloth over it. Measured: docs/decisions/rest-by-energy-descent.md
  bool momentum = false;
  /// With line_search: near equilibrium, at 95 % of the forces below a mean weight, use the full
  /// (indefinite) Hessian with conjugate gradients that end at a trust radius of a fifth of an edge
  /// (Steihaug 1983), instead of the projected one. Where cloth has buckled the negative parts are
  /// about as large as the positive ones, and steps without them are short. Saves time from 10,000
  /// particles on.
  bool full_hessian_near_rest = false;
  /// With line_search, without momentum: nothing is blocked where the 95th percentile of the forces
  /// is above so many mean weights.
  double blocking_force_ratio = std::numeric_limits<double>::infinity();
  double largest_move_m = 0.05; ///< no particle moves farther in one step
};

/// Outcome of a step.
struct StepResult {
  CgResult cg;               ///< iterations: of all solves
  int newton_iterations = 1; ///< solves
  double largest_move_m = 0; ///< after limits
  int halvings = 0;          ///< of the line search
  /// 95th percentile and maximum of |f0| over the particles that nothing holds back, over the mean
  /// weight of a particle. The percentile decides: single particles may flip between two facets of
  /// the skin for ever without moving anything.
  double residual_force_ratio = 0, residual_force_ratio_max = 0;
  /// Particles that a contact limit stopped: contact carries their force.
  std::size_t held = 0;
  bool finite = true; ///< false: nothing was moved
};

/// State and effects of one cloth. Allocates at the first step only, apart from growing contact
/// lists and steps of several solves.
class ClothSolver {
public:
  /// Steps a state that lives elsewhere, in place. @param x  #P by 3, m   @param v  #P by 3, m/s;
  /// of another length: the cloth is at rest. Mesh and state outlive the solver. @throws Error
  /// INPUT for a position that is not finite
  ClothSolver(const ClothMesh& mesh, std::vector<Vec3>& x, std::vector<Vec3>& v);
  /// Owns its state: at rest at x. @param x  #P by 3, m
  ClothSolver(const ClothMesh& mesh, std::vector<Vec3> x);
  ClothSolver(const ClothSolver&) = delete;
  ClothSolver& operator=(const ClothSolver&) = delete;
  /// Adds an effect; effects run in the order in which they are added.
  /// @param effect  not null
  /// @return the effect, owned by the solver
  Effect& add(std::unique_ptr<Effect> effect);
  /// Makes an effect of type T and adds it.
  /// @return the effect, owned by the solver
  template<class T, class... Args> T& emplace(Args&&... args) {
    return static_cast<T&>(add(std::make_unique<T>(std::forward<Args>(args)...)));
  }
  /// Removes an effect, which costs nothing from then on.
  /// @return the effect, so that its counts can be reported; null for one that is not
  /// here
  std::unique_ptr<Effect> remove(const Effect& effect);
  /// Makes one step: contacts, assembly, solve, limits, line search. A step whose result
  /// is not finite moves nothing. Cost: one sparse solve or as many as
  /// StepResult::newton_iterations says.
  StepResult step(const StepOptions& options);
  /// Makes the first search of the next step of h seconds now: for callers that have time
  /// now and none later. The step is the same with and without.
  void prefetch_contacts(double h);
  /// Instead of smoothed aggregation. @param preconditioner  not null
  void set_preconditioner(std::unique_ptr<Preconditioner> preconditioner) {
    m_preconditioner = std::move(preconditioner);
  }

  /// Positions, m, and velocities, m/s; #P by 3.
  const std::vector<Vec3>& x() const { return m_x; }
  const std::vector<Vec3>& v() const { return m_v; }
  /// Replaces the positions, #P by 3, m; velocity is zero from now on.
  void set_positions(std::vector<Vec3> x);
  /// The caller moved x: velocity is zero from now on, and the history of steps is
  /// dropped.
  void positions_changed() { stop(); }
  /// Adds to positions, m, and velocities, m/s, without dropping the history of steps
  /// (BodyMotion). Sizes #P.
  void shift(const std::vector<Vec3>& dx, const std::vector<Vec3>& dv) {
    for (std::size_t i = 0; i < m_x.size(); ++i) {
      m_x[i] += dx[i];
      m_v[i] += dv[i];
    }
  }
  /// Releases the particles that a line search has blocked for a while, because a pinch
  /// there would stop all other cloth.
  /// @return whether there was any
  bool release_blocked_particles() {
    const std::vector<int> none(m_x.size(), 0);
    const bool any = m_blocked_for != none;
    m_block_for = m_blocked_for = none;
    return any;
  }
  /// Sets the velocity to zero and drops the history of steps.
  void stop() {
    m_v.assign(m_v.size(), Vec3::Zero());
    forget();
  }
  /// In the order in which they run, and the rest state.
  const std::vector<std::unique_ptr<Effect>>& effects() const { return m_effects; }
  const ClothMesh& mesh() const { return m_mesh; }
  double assembly_s = 0, solve_s = 0, contact_s = 0, search_s = 0; ///< wall seconds so far

private:
  void begin(); ///< of both constructors
  void rebuild_pattern();
  void assemble(double h, bool again = false); ///< @param again  part of the step is done
  /// @param begun effects have begun this step.
  StepResult newton_step(const StepOptions& options, int most_solves, bool begun);
  bool gains(const StepOptions& options); ///< m_dx, in the incremental potential without damping
  void assemble_drag(double h);
  void drag_of(const std::vector<Vec3>& displacement, std::vector<Vec3>& drag);
  void conclude(const StepOptions& options, StepResult& result); ///< moves by m_dx
  double energy(const std::vector<Vec3>& x) const;
  double energy_after(const std::vector<Vec3>& dx); ///< potential, J
  void limit(std::vector<Vec3>& dx, std::vector<char>& held);
  void carry_on();
  bool turns_back() const;
  bool goes_round() const;
  int search_along(const StepOptions& options);
  void forget(); ///< drops what was learnt from earlier steps
  void block_held_particles(bool search_failed, const StepOptions& o);
  /// Of the squares of m_rhs, by particle, which it leaves in m_residual: 95th percentile and sum,
  /// N2.
  bool assembled_finite() const;
  std::array<double, 2> measure_rhs();
  /// Of the solve for m_rhs, near rest.
  double near_tolerance(const StepOptions& options, const std::array<double, 2>& squares) const;
  CgResult solve(const StepOptions& options);

  const ClothMesh& m_mesh;
  std::vector<Vec3> m_own_x, m_own_v; // empty where the state lives elsewhere
  std::vector<Vec3>&m_x, &m_v;
  std::vector<Vec3> m_force, m_rhs, m_dx, m_step, m_trial,
      m_trial_dx;                 // m_step: as solved, before limits
  std::vector<Vec3> m_last_dx;    // #P: the last displacement
  int m_carried_for = 0;          // steps since the last start of the momentum
  std::vector<double> m_energies; // J, before the last steps
  int m_falls_for = 0;            // steps that may not go up
  std::vector<std::unique_ptr<Effect>> m_effects;
  std::vector<ContactElement> m_elements;
  ContactIndex m_contacts; // of m_elements
  MotionLimits m_limits;
  std::vector<char> m_held, m_trial_held;
  std::vector<int> m_block_for, m_blocked_for; // #P, steps: of the last freeze; still to go
  std::vector<double> m_residual;
  double m_mean_edge = 0, m_mean_weight = 0; // of a particle; m, N
  BlockMatrix m_matrix, m_whole;
  BlockMatrix m_with_drag, m_without_drag; // of newton_step()
  bool m_pattern_stale = true;
  std::unique_ptr<Preconditioner> m_preconditioner;
  CgWork m_work;
};

} // namespace sloper::cloth

#pragma once
/// An effect is one physical influence with one name and one switch. An effect that is off is not
/// in the solver at all: it costs no call, no allocation, no time.
#include <sloper/cloth/contact/contact_element.hpp>
#include <sloper/cloth/contact/motion_limits.hpp>
#include <sloper/cloth/linear/block_matrix.hpp>
#include <sloper/geometry/types.hpp>
#include <vector>

namespace sloper::cloth {

struct ClothMesh;

/// What an effect sees and fills while a step is assembled.
struct StepContext {
  const std::vector<Vec3>& x;            ///< #P by 3, m
  double h;                              ///< time step, s
  std::vector<Vec3>& force;              ///< #P by 3, N: add -dE/dx
  BlockMatrix& stiffness;                ///< add the definite part of d2E/dx2 (and damping/h)
  std::vector<ContactElement>& elements; ///< or add elements
  MotionLimits* limits = nullptr;        ///< where not null: what this step must not pass through
};

/// Interface of an effect. A step calls begin_step(), add() of all effects,
/// add_separating_planes(), end_step().
class Effect {
public:
  virtual ~Effect() = default;
  /// As in reports and the setting `effects`.
  virtual const char* name() const = 0;
  /// Appends the particle pairs whose off-diagonal blocks add() and add_indefinite_part()
  /// fill, to the list of their kind: symmetric or isotropic if these blocks are always
  /// so.
  virtual void declare(Couplings& /*couplings*/) const {}
  /// Looks up the slots of its blocks; after declare(), whenever the pattern of the
  /// matrix has changed.
  virtual void bind(const BlockMatrix&) {}
  /// The same particles and triangles get other rest shapes, which `mesh` already has.
  /// Default: for effects that read them from the mesh, or have none.
  /// @return false where the effect must be made anew
  virtual bool set_rest(const ClothMesh& /*mesh*/) { return true; }
  /// Before assembly: find contacts for the positions x.
  virtual void begin_step(const std::vector<Vec3>& /*x*/, double /*h*/) {}
  /// Finds contacts at x, which a step of several solves has reached so far.
  /// @param h  time step, s
  virtual void update_contacts(const std::vector<Vec3>& /*x*/, double /*h*/) {}
  /// Whether begin_step() is long and independent of all other effects: then it may run
  /// beside their add().
  virtual bool is_search() const { return false; }
  /// Does now what the next begin_step() at x would do first, where doing it twice is
  /// harmless.
  virtual void prefetch_contacts(const std::vector<Vec3>& /*x*/, double /*h*/) {}
  /// Whether the last search found cloth that has passed through something, which the
  /// effect pushes out.
  virtual bool crosses() const { return false; }
  /// Adds force and definite stiffness at context.x.
  virtual void add(StepContext& context) = 0;
  /// Adds the indefinite part of d2E/dx2 that add() drops. Default: nothing, for effects whose
  /// Hessian is complete or whose dropped part is not known.
  virtual void add_indefinite_part(const std::vector<Vec3>& /*x*/,
                                   BlockMatrix& /*stiffness*/) const {}
  /// Potential at x, J; 0 for effects without one (damping, friction).
  virtual double energy(const std::vector<Vec3>& /*x*/) const { return 0; }
  /// Adds separating planes for pairs that a displacement within `limits` would still
  /// bring through each other.
  /// @param last  the last round: limits must now stop all such displacements
  /// @return whether limits were added
  virtual bool add_separating_planes(const std::vector<Vec3>& /*x*/,
                                     const std::vector<Vec3>& /*dx*/, MotionLimits& /*limits*/,
                                     bool /*last*/) {
    return false;
  }
  /// After the step: x has become x + dx.
  virtual void end_step(const std::vector<Vec3>& /*x*/) {}

  long calls = 0;    ///< of add(), counted by the solver
  double wall_s = 0; ///< in add(), measured by the solver
};

} // namespace sloper::cloth

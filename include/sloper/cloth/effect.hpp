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

class Effect {
public:
  virtual ~Effect() = default;
  virtual const char* name() const = 0;
  /// Appends the particle pairs whose off-diagonal blocks add() and add_indefinite_part() fill, by
  /// what they add there: as symmetric or isotropic if that is all that these blocks ever are.
  virtual void declare(Couplings& /*couplings*/) const {}
  virtual void bind(const BlockMatrix&) {}
  /// The same particles and triangles have other rest shapes from now on, which `mesh` has already.
  /// Default: for effects that read them from the mesh, or have none. @return false where the
  /// effect must be made anew
  virtual bool set_rest(const ClothMesh& /*mesh*/) { return true; }
  /// Before assembly: find contacts for the positions x.
  virtual void begin_step(const std::vector<Vec3>& /*x*/, double /*h*/) {}
  /// Within a step of several solves, which has reached x so far: finds contacts there.
  virtual void update_contacts(const std::vector<Vec3>& /*x*/, double /*h*/) {}
  /// Whether begin_step() is long, and touches nothing that another effect has to do with: then it
  /// may run beside their add().
  virtual bool is_search() const { return false; }
  /// Does now what the next begin_step() at x would do first, where that can be done twice.
  virtual void prefetch_contacts(const std::vector<Vec3>& /*x*/, double /*h*/) {}
  /// Whether cloth passed through something at the last search, which the effect pushes it out of.
  virtual bool crosses() const { return false; }
  virtual void add(StepContext& context) = 0;
  /// Adds the indefinite part of d2E/dx2 that add() drops. Default: nothing, for effects whose
  /// Hessian is complete or whose dropped part is not known.
  virtual void add_indefinite_part(const std::vector<Vec3>& /*x*/,
                                   BlockMatrix& /*stiffness*/) const {}
  /// Potential at x, J; 0 for what has none (damping, friction).
  virtual double energy(const std::vector<Vec3>& /*x*/) const { return 0; }
  /// Adds separating planes for pairs that a displacement within `limits` would still bring through
  /// each other.
  /// @param last  nothing comes after: limits now must stop all such displacements   @return
  /// whether limits were added
  virtual bool add_separating_planes(const std::vector<Vec3>& /*x*/,
                                     const std::vector<Vec3>& /*dx*/, MotionLimits& /*limits*/,
                                     bool /*last*/) {
    return false;
  }
  /// After the step: x has become x + dx.
  virtual void end_step(const std::vector<Vec3>& /*x*/) {}

  long calls = 0;
  double wall_s = 0;
};

} // namespace sloper::cloth

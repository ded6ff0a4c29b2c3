#pragma once
/// Body motion: advances a moving body in substeps short enough that the skin never tunnels through
/// cloth that it does not already cross.
///
/// Each substep starts from a predictor c: cloth near the skin moves with the nearest triangle,
/// cloth farther away with its own velocity, blended in between, and no farther than self contact
/// allows. The predictor only chooses where the solve starts; inertia is taken from the true state:
///   (M/h^2 + K) dx = f(x + c) + M (v - c/h) / h, then v = (c + dx)/h.
/// So free motion and sliding are unaffected. A substep ends where a pair of skin and cloth would
/// lose more than a third of its distance (BodyContactEffect::collision_free_step_fraction()). If
/// cloth cannot yield (pinned, or pinched between two limbs) the skin passes through, the crossing
/// is counted, and contact pushes it out as at a deep start. Test:
/// tests/cloth/motion/test_body_motion.cpp
#include <sloper/cloth/contact/body_contact.hpp>
#include <sloper/cloth/contact/self_contact.hpp>
#include <sloper/cloth/solver/implicit_step.hpp>

#include <functional>

namespace sloper::cloth {

/// Moves the skin of one body under one cloth.
class BodyMotion {
public:
  /// All outlive this; `contact` is an effect of `solver`.
  /// @param contact, self_contact  effects of `solver`; the latter null where the cloth has none
  BodyMotion(ClothSolver& solver, BodyContactEffect& contact, collision::BodyCollider& body,
             SelfContactEffect* self_contact = nullptr);

  /// Moves the skin straight to `target` while the cloth steps; both take options.h
  /// seconds.
  /// @param target  #V by 3, m
  /// @param options  of each substep, whose h is its share of options.h (with inertia 0
  /// all of it: that flow has no time)
  /// @param step  makes the cloth's steps in place of the solver's own step()
  /// @return the last step's result; `finite` is false when one was not: the skin then
  /// stays where it was at that moment
  StepResult advance(const std::vector<Vec3>& target, const StepOptions& options,
                     const std::function<StepResult(const StepOptions&)>& step = {});

  long calls = 0;  ///< of advance()
  long parts = 0;  ///< substeps
  long forced = 0; ///< advances in which the skin had to go through cloth
  /// Largest displacement of a skin vertex in one advance, m.
  double largest_way_m = 0;
  /// Wall seconds of moving the skin and computing predictors, without the cloth's steps.
  double wall_s = 0;

private:
  void predict_from_skin(const std::vector<Vec3>& displacement, double time);
  std::vector<Vec3> limit_predictor_by_self_ccd(double share, MotionLimits& limits) const;
  double free_fraction(const std::vector<Vec3>& displacement, double longest, double time);

  ClothSolver& m_solver;
  BodyContactEffect& m_contact;
  collision::BodyCollider& m_body;
  SelfContactEffect* m_self_contact = nullptr;
  double m_last_asked = 1;       // share of the displacement, of the last part
  std::vector<Vec3> m_predictor; // #P, m
  std::vector<int> m_nearest;    // #P, triangle of the skin, or -1
};

} // namespace sloper::cloth

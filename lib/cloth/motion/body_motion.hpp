#pragma once
/// Body motion: a body that moves under cloth, in parts so short that no skin passes cloth that is
/// clear of it.
///
/// Cloth near the skin is first carried along with it, and cloth farther off as it flies, as far as
/// self contact lets it (on less of the way where that is longer), so that a body under taut cloth
/// meets as little of it as one that stands still. A part of the way ends where skin and carried
/// cloth have come nearer by a third of the distance of any pair of them
/// (BodyContactEffect::collision_free_step_fraction()); then the cloth steps in its share of the
/// time, from where it was carried to but with the inertia of where it was: (M/h^2 + K) dx = f(x +
/// c) + M (v - c/h) / h, then v = (c + dx)/h, c being the carry. So the carry is where a step
/// begins to look, and no motion: what swings freely, or slips, does so as without it. Then the
/// next part. Where cloth cannot give way in many parts (it is pinned, or caught between two limbs)
/// the skin goes through what is left and pushes out what it crosses, as at a deep start; such
/// moments are counted. Test: tests/cloth/motion/test_body_motion.cpp
#include <cloth/contact/body_contact.hpp>
#include <cloth/contact/self_contact.hpp>
#include <cloth/solver/implicit_step.hpp>

#include <functional>

namespace sloper::cloth {

class BodyMotion {
public:
  /// All outlive this; `contact` is an effect of `solver`.
  /// @param contact, self_contact  effects of `solver`; the latter null where the cloth has none
  BodyMotion(ClothSolver& solver, BodyContactEffect& contact, collision::BodyCollider& body,
             SelfContactEffect* self_contact = nullptr);

  /// The skin goes straight to `target` (#V by 3, m) and the cloth steps meanwhile; both take
  /// options.h seconds.
  /// @param options  of each part, whose h is its share of options.h (with inertia 0 all of it:
  /// that flow knows no time)
  /// @return the last step's result, `finite` false when one was not: the skin is then where it was
  /// at that moment
  /// @param step  makes the cloth's steps where it is not the solver's own step()
  StepResult advance(const std::vector<Vec3>& target, const StepOptions& options,
                     const std::function<StepResult(const StepOptions&)>& step = {});

  long calls = 0;           ///< of advance()
  long parts = 0;           ///< steps
  long forced = 0;          ///< advances in which the skin had to go through cloth
  double largest_way_m = 0; ///< of a skin vertex in one advance
  double wall_s = 0;        ///< of moving the skin and carrying cloth, without the cloth's steps

private:
  void predict_from_skin(const std::vector<Vec3>& way, double time);
  std::vector<Vec3> limit_predictor_by_self_ccd(double share, MotionLimits& limits) const;
  double free_part(const std::vector<Vec3>& way, double longest, double time);

  ClothSolver& m_solver;
  BodyContactEffect& m_contact;
  collision::BodyCollider& m_body;
  SelfContactEffect* m_self_contact = nullptr;
  double m_last_asked = 1;       // share of the way, of the last part
  std::vector<Vec3> m_predictor; // #P, m
  std::vector<int> m_nearest;    // #P, triangle of the skin, or -1
};

} // namespace sloper::cloth

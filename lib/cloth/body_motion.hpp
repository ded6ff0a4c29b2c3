#pragma once
/// Body motion: a body that moves under cloth, in parts so short that no skin passes cloth that is clear of it.
///
/// A part of the way ends where the skin has come a third of the way to the cloth in front of it (BodyContactEffect::free_share()); then the
/// cloth steps in its share of the time, and makes room by contact; then the next part. So a body of any speed pushes cloth and
/// never jumps over it. Where cloth cannot give way in many parts (it is pinned, or caught between two limbs) the
/// skin goes through what is left and pushes out what it crosses, as at a deep start; such moments are counted.
/// Test: tests/cloth/test_body_motion.cpp
#include <cloth/body_contact.hpp>
#include <cloth/implicit_step.hpp>

#include <functional>

namespace sloper::cloth {

class BodyMotion {
public:
  /// Both outlive this; `contact` is an effect of `solver`.
  BodyMotion(ClothSolver& solver, BodyContactEffect& contact, collision::BodyCollider& body) : m_solver(solver), m_contact(contact), m_body(body) {}

  /// The skin goes straight to `target` (#V by 3, m) and the cloth steps meanwhile; both take options.h seconds.
  /// @param options  of each part, whose h is its share of options.h (with inertia 0 all of it: that flow knows no time)
  /// @return the last step's result, `finite` false when one was not: the skin is then where it was at that moment
  /// @param step  makes the cloth's steps where it is not the solver's own step()
  StepResult advance(const std::vector<Vec3>& target, const StepOptions& options, const std::function<StepResult(const StepOptions&)>& step = {});

  long calls = 0;           ///< of advance()
  long parts = 0;           ///< steps
  long forced = 0;          ///< advances in which the skin had to go through cloth
  double largest_way_m = 0; ///< of a skin vertex in one advance
  double wall_s = 0;        ///< of moving the skin, without the cloth's steps

private:
  ClothSolver& m_solver;
  BodyContactEffect& m_contact;
  collision::BodyCollider& m_body;
};

} // namespace sloper::cloth

#pragma once
/// Elastic attachments: a particle on an elastic cord to a point in space (a shoulder, a
/// suspender's clip). It pulls and never pushes: E = k/2 max(0, |x_i - p| - l0)^2.
/// Test: tests/cloth/forces/test_jacobians.cpp
#include <sloper/cloth/effect.hpp>

namespace sloper::cloth {

/// One cord.
struct Attachment {
  int particle;               ///< at its end
  Vec3 anchor;                ///< m
  double rest_length = 0;     ///< l0, m
  double stiffness_n_m = 100; ///< k, N/m
};

/// The effect of all cords.
class AttachmentsEffect : public Effect {
public:
  /// @param attachments  particles within the cloth, rest lengths and stiffnesses >= 0
  explicit AttachmentsEffect(std::vector<Attachment> attachments)
      : m_attachments(std::move(attachments)) {}
  const char* name() const override { return "attachments"; }
  void add(StepContext& c) override;
  /// Potential at x, J.
  double energy(const std::vector<Vec3>& x) const override;

private:
  std::vector<Attachment> m_attachments;
};

} // namespace sloper::cloth

#pragma once
/// Contact with a body that decides nothing: a force that begins smoothly at a distance and grows
/// with depth, on particles and on the middles of edges. No near pairs that come and go, no planes
/// that turn a motion aside, no friction: the force is continuous where the skin's distance is
/// differentiable, so cloth that is drawn over the body comes to lie the same way from starts that
/// differ a little. Cloth may sink in, and pass what is thin; it is for coarse cloth on its way,
/// which body_contact.hpp takes over afterwards.
///
/// Per area, over the depth s = reach - distance: k s^2 / (2 reach) up to s = reach, k (s - reach /
/// 2) beyond. Test: tests/cloth/contact/test_soft_body_contact.cpp
#include <sloper/cloth/cloth_mesh.hpp>
#include <sloper/cloth/effect.hpp>
#include <sloper/collision/body_collider.hpp>

namespace sloper::cloth {

struct SoftBodyContactOptions {
  double reach_m = 0.012;      ///< distance to the skin at which the force begins
  double stiffness_n_m3 = 5e5; ///< k
  double deepest_m = 0.05;     ///< no larger depth counts
  /// Of the stiffness along the skin, against this step's way alone: cloth that lies on the skin
  /// creeps where it would slide. In place of friction.
  double drag = 0;
  bool on_edges =
      true; ///< also on the middles of edges: for edges longer than about twice the reach
};

class SoftBodyContactEffect : public Effect {
public:
  /// `mesh` and `body` outlive the effect.
  SoftBodyContactEffect(const ClothMesh& mesh, const collision::BodyCollider& body,
                        const SoftBodyContactOptions& options);
  const char* name() const override { return "soft_body_contact"; }
  void declare(Couplings& couplings) const override;
  void bind(const BlockMatrix& matrix) override;
  void add(StepContext& context) override;
  void set_reach(double reach_m) { m_options.reach_m = reach_m; }
  /// The skin has moved since the last step. @param largest_way  of any of its points, m
  void body_moved(double largest_way);

private:
  /// A particle, or the middle of an edge.
  struct Sample {
    std::array<int, 2> particle;
    int n;             // of them
    double area;       // m2
    int triangle = -1; // of the skin, the nearest when it was last looked for
    double clear = -1; // m: it was not nearer than this at `at`; below zero: not known
    Vec3 at = Vec3::Zero();
  };
  void push(const Sample& sample, int slot, const collision::SignedDistance& d,
            StepContext& context) const;
  const collision::BodyCollider& m_body;
  SoftBodyContactOptions m_options;
  std::vector<std::array<int, 2>> m_edges;
  std::vector<Sample> m_samples; // particles, then edges
  std::vector<int> m_slots;      // of edges
};

} // namespace sloper::cloth

#pragma once
/// Soft contact with a body: a force that begins smoothly at a distance and grows with
/// depth, on particles and on the middles of edges. It has no near pairs that come and
/// go, no separating planes and no friction: the force is continuous where the skin's
/// distance is differentiable, so cloth that is drawn over the body comes to the same
/// place from starts that differ a little. Cloth may sink in, and pass thin parts; it is
/// for coarse cloth, before body_contact.hpp takes over.
///
/// Per area, over the depth s = reach - distance: k s^2 / (2 reach) up to s = reach, k (s
/// - reach / 2) beyond. Test: tests/cloth/contact/test_soft_body_contact.cpp
#include <sloper/cloth/cloth_mesh.hpp>
#include <sloper/cloth/effect.hpp>
#include <sloper/collision/body_collider.hpp>

namespace sloper::cloth {

/// Numbers of soft contact.
struct SoftBodyContactOptions {
  double reach_m = 0.012;      ///< distance to the skin at which the force begins
  double stiffness_n_m3 = 5e5; ///< k
  double deepest_m = 0.05;     ///< no larger depth counts
  /// Share of the stiffness that resists this step's displacement along the skin: cloth
  /// on the skin creeps instead of sliding. It takes the place of friction.
  double drag = 0;
  /// Also on the middles of edges and faces: for edges longer than about twice the reach.
  /// Without those of faces a thumb stands through a sleeve of long edges.
  bool on_edges = true;
};

/// The soft contact effect of one cloth and one body.
class SoftBodyContactEffect : public Effect {
public:
  /// `mesh` and `body` outlive the effect.
  SoftBodyContactEffect(const ClothMesh& mesh, const collision::BodyCollider& body,
                        const SoftBodyContactOptions& options);
  const char* name() const override { return "soft_body_contact"; }
  void declare(Couplings& couplings) const override;
  void bind(const BlockMatrix& matrix) override;
  void add(StepContext& context) override;
  /// Activation distance from the next step on, m.
  void set_reach(double reach_m) { m_options.reach_m = reach_m; }
  /// The skin has moved since the last step.
  /// @param largest_displacement  largest displacement of any of its points, m
  void body_moved(double largest_displacement);

private:
  /// A particle, or the middle of an edge or a face.
  struct Sample {
    std::array<int, 3> particle;
    int n;             // of them
    double area;       // m2
    int triangle = -1; // of the skin, the nearest when it was last looked for
    double clear = -1; // m: it was outside and not nearer than this at `at`, where above zero
    Vec3 at = Vec3::Zero();
  };
  void add_edges_and_faces(const ClothMesh& mesh);
  collision::SignedDistance look(Sample& sample, const Vec3& at) const;
  void push(const Sample& sample, const int* slots, const collision::SignedDistance& d,
            StepContext& context) const;
  const collision::BodyCollider& m_body;
  SoftBodyContactOptions m_options;
  std::vector<std::array<int, 2>> m_edges;
  std::vector<std::array<int, 3>> m_face_edges;
  std::vector<Sample> m_samples;                  // particles, then edges, then faces
  std::vector<collision::SignedDistance> m_found; // of each sample, in the present step
  std::vector<std::array<int, 3>> m_slots;        // of edges, then faces
};

} // namespace sloper::cloth

#pragma once
/// Contact of particles with a body: a one-sided spring inside the gap, static and sliding friction.
///
/// Normal: E = k A max(0, gap - d)^3 / (6 gap) with signed distance d and the particle's rest area A. Friction is Coulomb with a
/// memory: each touching particle is tied to an anchor on the skin by a tangent spring; where the spring would pull harder
/// than mu N the anchor is dragged along (sliding). So a garment that hangs by friction really comes to rest.
/// Work goes only where it is needed: a particle is not asked again before it can have come near, since the distance to
/// a still body changes at most by as much as the particle moves.
#include <cloth/cloth_mesh.hpp>
#include <cloth/effect.hpp>
#include <collision/body_collider.hpp>

namespace sloper::cloth {

struct BodyContactOptions {
  double gap_m = 0.003;        ///< distance to the skin at which contact begins
  double stiffness_n_m3 = 2e6; ///< k: pressure per depth
  double friction = 0.0;       ///< mu
  double tangent_ratio = 0.5;  ///< tangent over normal stiffness while sticking
  double slide_ratio = 0.05;   ///< the same while sliding: only steadies the step
  double search_m = 0.04;      ///< farther than this from the skin a particle has no contact data
};

class BodyContactEffect : public Effect {
public:
  BodyContactEffect(const ClothMesh& mesh, collision::BodyCollider& body, const BodyContactOptions& options);
  const char* name() const override { return "body_contact"; }
  void begin_step(const std::vector<Vec3>& x, double h) override;
  void add(StepContext& c) override;
  void limit(const std::vector<Vec3>& x, std::vector<Vec3>& dx, std::vector<char>& held) override;

  /// Moves the body (same topology). What is known of distances shrinks by its largest motion.
  void move_body(const std::vector<Vec3>& positions);
  /// The next level of contact, for a few faces: body vertices and edges against these (particle) triangles and their edges.
  void watch_faces(const std::vector<Triangle>& triangles);
  void set_friction(double mu) { m_options.friction = mu; }
  /// Contact distance of one particle; raised where the audit finds a face through the body.
  double& gap(int particle) { return m_gap[particle]; }
  const BodyContactOptions& options() const { return m_options; }
  /// Signed distances of the particles that are near, 1e30 elsewhere; valid after begin_step.
  double distance(int particle) const { return m_state[particle].near ? m_state[particle].distance : 1e30; }
  double normal_force(int particle) const { return m_state[particle].normal_force; }
  long queries = 0;        ///< distance queries so far
  long friction_calls = 0; ///< steps in which friction was computed

private:
  struct State {
    bool near = false; // distance and normal are of this step
    bool has_anchor = false;
    double distance = 0;     // signed, m
    double clearance = -1;   // no skin within this distance of `asked_at`; negative: ask
    double normal_force = 0; // N
    int triangle = -1;
    Vec3 normal = Vec3::UnitY(), asked_at = Vec3::Zero(), anchor = Vec3::Zero();
  };

  void add_face_contacts(StepContext& c);

  const ClothMesh& m_mesh;
  collision::BodyCollider& m_body;
  BodyContactOptions m_options;
  std::vector<State> m_state;
  std::vector<double> m_gap;
  std::vector<Vec3> m_body_positions;
  std::vector<Triangle> m_watched;
  collision::Topology m_watched_topology;
};

} // namespace sloper::cloth

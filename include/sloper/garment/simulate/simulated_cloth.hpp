#pragma once
/// The cloth that a drape simulates: the mesh, the solver and the effects of one garment as it
/// stands. The garment's `position` is the only copy of the positions: the solver steps it in
/// place. Effects that a drape speaks to are kept as typed handles.
#include <sloper/garment/body_model/collision_body.hpp>
#include <sloper/garment/garment.hpp>
#include <sloper/garment/scene/effect_spec.hpp>
#include <sloper/garment/simulate/telemetry.hpp>

#include <memory>
#include <string>
#include <vector>

namespace sloper::garment {

/// Mesh, solver and effects of one garment; rebuilt when seams are welded.
class SimulatedCloth {
public:
  /// All outlive this. @throws Error INPUT for a garment that cannot be simulated
  SimulatedCloth(Garment& garment, const DrapeSettings& settings, CollisionBody& body,
                 Telemetry& telemetry);

  /// Chooses the effects for the garment as it stands, into the report.
  void choose_effects();
  /// Makes cloth, solver and effects for the garment as it stands, without weight and friction.
  /// @param open_seams  sewing springs take part; panels bend as boards   @param keep_velocity else
  /// the cloth is at rest
  void build(bool open_seams, bool keep_velocity = false);
  /// Adds the counts of its effects to the report and ends the solver.
  void tear_down();
  bool is_built() const { return m_solver != nullptr; }
  /// Weight and friction, once.
  void add_load();
  /// The garment has other rest lengths, under the same particles.
  void replace_rest_shape();
  /// Adds the solver's counts to the report.
  void report_effects();

  /// The garment that is stepped in place.
  Garment& garment() { return m_garment; }
  const Garment& garment() const { return m_garment; }
  const std::vector<Vec3>& x() const { return m_garment.position; } ///< #P by 3, m
  const std::vector<Vec3>& v() const { return m_velocity; }         ///< #P by 3, m/s
  /// Sets v(), #P by 3, m/s; before build() with keep_velocity.
  void set_velocity(std::vector<Vec3> v) { m_velocity = std::move(v); }
  /// The caller moved the garment's positions: contacts are searched anew, velocity is zero.
  void positions_changed();
  /// Searches contacts anew at the present positions.
  void refresh_contacts();

  /// Solver and rest state; only after build().
  cloth::ClothSolver& solver() { return *m_solver; }
  const cloth::ClothMesh& mesh() const { return *m_mesh; }
  /// Whether the effect of that name takes part, as the report says.
  bool is_active(const char* effect) const { return m_telemetry.is_active(effect); }
  cloth::BodyContactEffect* body_contact() { return m_handles.body_contact; } ///< null without
  const cloth::BodyContactEffect* body_contact() const { return m_handles.body_contact; }
  cloth::SelfContactEffect* self_contact() { return m_handles.self_contact; } ///< null without
  cloth::SewingSpringEffect* sewing() { return m_handles.sewing; } ///< null once seams are closed

  /// Mean rest length of the mesh edges, m.
  double mean_edge() const { return m_mesh->mean_edge(); }
  /// Mean force of an edge at a strain of one over the mean weight of a particle.
  double tension_ratio() const;
  /// For the log: how many cloth faces cross the skin, and where; empty: none.
  std::string crossing_text() const;

private:
  void add_stage(EffectStage stage);

  Garment& m_garment;
  const DrapeSettings& m_settings;
  CollisionBody& m_body;
  Telemetry& m_telemetry;
  std::vector<Vec3> m_velocity;
  std::unique_ptr<cloth::ClothMesh> m_mesh;
  std::unique_ptr<cloth::ClothSolver> m_solver;
  EffectHandles m_handles; // of m_solver
  bool m_loaded = false;
  bool m_open_seams = false;
};

} // namespace sloper::garment

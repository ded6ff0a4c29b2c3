#pragma once
/// One drape in progress: the phases of drape(), each a method. Only drape.cpp and its tests include this.
#include <cloth/body_contact.hpp>
#include <cloth/implicit_step.hpp>
#include <cloth/self_contact.hpp>
#include <cloth/sewing_spring.hpp>
#include <garment/audit.hpp>
#include <garment/body_shrink.hpp>
#include <garment/drape.hpp>
#include <garment/mitten.hpp>

#include <chrono>
#include <optional>

namespace sloper::garment {

class FollowRun;

class DrapeRun {
public:
  DrapeRun(Garment& garment, const body::Body* body, const DrapeSettings& settings, Reporter& reporter, const FitBounds& bounds = {});
  DrapeReport run();

private:
  friend class FollowRun; ///< goes on with the same cloth while edits come, see follow.hpp
  /// Times a phase, into the report.
  class Phase;

  void start_outside_body(bool unsewn);          ///< shrink until nothing of the garment is inside
  std::vector<Vec3> skin_at(double scale) const; ///< as the collider has it
  void build_solver(bool open_seams);            ///< cloth, effects and solver for the garment as it stands
  void sew();
  void log_crossings(const char* when) const; ///< to the log, with -v
  std::string crossing_text() const;          ///< for the log: what is through the skin, and where
  std::size_t untangle();                     ///< draws crossing cloth apart; the pairs that remain
  void inflate();
  void settle();
  bool step(double h, double inertia, double largest_move_m = 0.02); ///< one guarded step; false when the run must end
  double elapsed() const;
  void finish();
  void report_effects(); ///< adds the solver's counts to the report
  bool active(const char* effect) const;
  void judge_fit();         ///< stops when the garment is beyond the bounds
  double mean_edge() const; ///< mean rest length of the cloth's edges, m

  Garment& m_garment;
  const body::Body* m_body;
  DrapeSettings m_settings;
  FitBounds m_bounds;
  Reporter& m_reporter;
  DrapeReport m_report;
  std::chrono::steady_clock::time_point m_start;

  std::optional<collision::BodyCollider> m_collider;
  std::optional<MittenSkin> m_mitten; ///< only where cloth is near a hand
  std::optional<BodyShrink> m_shrink;
  bool m_disturbed = false; ///< by sewing, or by a body that was drawn in
  bool m_settling = false;  ///< steps are shortened until the energy falls
  double m_scale = 1;       ///< of the body, see BodyShrink

  std::unique_ptr<cloth::ClothMesh> m_cloth;
  std::unique_ptr<cloth::ClothSolver> m_solver;
  cloth::BodyContactEffect* m_body_contact = nullptr;
  cloth::SelfContactEffect* m_self_contact = nullptr;
  cloth::SewingSpringEffect* m_sewing = nullptr;
  int m_untanglings = 0;
  std::vector<double> m_start_height; // #P, m, where settling began
  double m_least_strain = 1e300;      // 99th percentile, of those that judge_fit() has seen
  int m_strain_fell_at = 0;           // step
  cloth::StepResult m_last;
  double m_last_h = 0; ///< s, of that step
  std::vector<int> m_cg_iterations;
  std::vector<std::string> m_rejected;
  bool m_stopped = false; ///< by time limit, by the user or by the guard
};

} // namespace sloper::garment

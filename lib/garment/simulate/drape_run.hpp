#pragma once
/// One drape in progress: the phases of drape(), each a method. Only drape.cpp and its tests include this.
#include <cloth/contact/body_contact.hpp>
#include <cloth/contact/self_contact.hpp>
#include <cloth/forces/sewing_spring.hpp>
#include <cloth/solver/implicit_step.hpp>
#include <collision/skin_cache.hpp>
#include <garment/body_model/body_shrink.hpp>
#include <garment/body_model/coarse_skin.hpp>
#include <garment/body_model/covered_skin.hpp>
#include <garment/body_model/under_arms.hpp>
#include <garment/simulate/audit.hpp>
#include <garment/simulate/drape_state.hpp>
#include <garment/simulate/motion.hpp>

#include <chrono>
#include <optional>

namespace sloper::garment {

class FollowRun;

inline constexpr double SEW_REACH = 0.05;   ///< m: the pull of a stitch does not grow beyond this gap
inline constexpr int MOST_PUSH_STEPS = 120; ///< for cloth at rest that is still through the skin

std::string place_text(const Vec3& p); ///< for messages
std::string millimetres(double m);     ///< likewise, to a tenth

class DrapeRun {
public:
  DrapeRun(Garment& garment, const body::Body* body, const DrapeSettings& settings, Reporter& reporter, const FitBounds& bounds = {});
  DrapeReport run();
  /// Once the cloth is at rest the body moves, and the cloth comes to rest again at the end. To be called before run().
  void then_move(const BodyMoves& moves, OnMotionFrame on_frame);
  DrapeReport run_untangle_only();
  void set_checkpoints(const Checkpoints& checkpoints) { m_checkpoints = checkpoints; }
  /// Goes on from there with run(): the garment is the checkpoint's, as it was given to the constructor.
  void resume(const DrapeCheckpoint& checkpoint);

private:
  friend class FollowRun; ///< goes on with the same cloth while edits come, see follow.hpp
  /// Times a phase, into the report.
  class Phase {
  public:
    Phase(DrapeRun& run, const char* name) : m_run(run), m_name(name), m_began(run.elapsed()) { run.m_reporter.info(std::string(name) + " ..."); }
    Phase(const Phase&) = delete;
    ~Phase() { m_run.add_phase_time(m_name, m_run.elapsed() - m_began); }

  private:
    DrapeRun& m_run;
    const char* m_name;
    double m_began;
  };
  void add_phase_time(const char* name, double wall_s);

  void collide_with(const TriangleMesh& skin);                   ///< makes m_collider
  void prepare_body(unsigned covered);                           ///< @param covered of CoveredSkin::Ends
  void start_outside_body(bool unsewn);                          ///< shrink until nothing of the garment is inside
  std::vector<Vec3> placed_on(const std::string& part) const;    ///< vertices of the panels of parts that begin so, m
  void take_forearms();                                          ///< makes m_forearms, without what sleeves are sewn around
  std::vector<Vec3> skin_at(double scale) const;                 ///< as the collider has it
  std::vector<Vec3> as_met(const std::vector<Vec3>& skin) const; ///< likewise
  void meet_bare_skin();                                         ///< itself from now on, no mitten and nothing coarse
  void let_arms_hang();                                          ///< outside of what came to hang while they were aside
  void leave_coarse_skin();                                      ///< no coarse one from now on, while the garment settles
  void build_solver(bool open_seams);                            ///< cloth, effects and solver for the garment as it stands
  void sew();
  void log_crossings(const char* when) const; ///< to the log, with -v
  std::string crossing_text() const;          ///< for the log: what is through the skin, and where
  std::size_t untangle();                     ///< draws crossing cloth apart; the pairs that remain
  void untangle_now();                        ///< the same in the middle of settling
  std::size_t part_from_body(const std::vector<Vec3>& x, const std::vector<Triangle>& triangles, std::vector<Vec3>& move) const;
  std::size_t part_all(int most_rounds, int& rounds);
  bool part_few_at_start(std::size_t trouble); ///< by short moves alone; whether that was enough
  bool part_the_few();                         ///< moves the last faces through the skin out of it, while the garment settles; whether there were any
  void inflate();
  void settle();
  void look_for_way(); ///< of cloth that settles: at times lets it go with its inertia
  void end_free_step();
  void follow_motion(); ///< drape_motion.cpp
  bool wakes(const std::vector<Vec3>& from, const std::vector<Vec3>& to) const;
  void audit_frame(MotionFrame& frame);
  void stand_in(const std::vector<Vec3>& skin); ///< the motion is over, with the body so
  io::Json motion_report() const;
  void activate(const char* effect, const char* why);
  void breathe(); ///< a little pressure from within, until stop_breathing()
  void stop_breathing();
  void find_tucks();     ///< that sewing left, for let_tucks_pass()
  void let_tucks_pass(); ///< each through itself, until close_tucks()
  void close_tucks();
  void hold_sleeves(); ///< where m_at says, until let_sleeves_go()
  void let_sleeves_go();
  bool may_pass(const std::string& effect) const;
  void take_back(const cloth::Effect*& effect);                      ///< a passing one of m_solver, if it is there; into the report
  void add_load();                                                   ///< weight and friction
  int glide() const;                                                 ///< step of SETTLE at which they come
  bool checkpoint();                                                 ///< between steps: where one is due, renew(); whether it was
  bool renews() const;                                               ///< at times, as a run with checkpoints does
  void renew();                                                      ///< writes the checkpoint where one is wanted, and rebuilds
  void rebuild();                                                    ///< all that a checkpoint does not hold, from m_at and the garment
  bool step(double h, double inertia, double largest_move_m = 0.02); ///< one guarded step; false when the run must end
  void note_solves();                                                ///< of the last step
  double elapsed() const;
  void finish();
  void report_effects(); ///< adds the solver's counts to the report
  bool active(const char* effect) const;
  void judge_fit();     ///< stops when the garment is beyond the bounds, and will stay there: drape_judge.cpp
  bool thaw();          ///< calm cloth, of what may be all that it hangs by: whether there is more to wait for
  bool is_calm() const; ///< the strain hardly changes from look to look, and forces are nearly balanced
  double tension_ratio() const;
  double mean_edge() const; ///< mean rest length of the cloth's edges, m

  Garment& m_garment;
  const body::Body* m_body;
  DrapeSettings m_settings;
  FitBounds m_bounds;
  Reporter& m_reporter;
  DrapeReport m_report;
  std::chrono::steady_clock::time_point m_start;

  std::optional<collision::BodyCollider> m_collider;
  std::optional<CoveredSkin> m_covered; ///< only where cloth is near a hand or foot
  std::optional<CoarseSkin> m_coarse;   ///< of a dense scan, until the cloth is at rest on it
  std::optional<BodyShrink> m_shrink;
  std::optional<Forearms> m_forearms; ///< while they are aside
  DrapeState m_at;
  Checkpoints m_checkpoints;
  int m_checkpoint_step = 0;   ///< of all steps, where the last one was
  double m_elapsed_before = 0; ///< s, of the runs before this one
  bool m_settling = false;     ///< steps are shortened until the energy falls

  std::unique_ptr<cloth::ClothMesh> m_cloth;
  std::unique_ptr<cloth::ClothSolver> m_solver;
  cloth::BodyContactEffect* m_body_contact = nullptr;
  cloth::SelfContactEffect* m_self_contact = nullptr;
  const cloth::Effect *m_breath = nullptr, *m_hold = nullptr; // of m_solver
  cloth::SewingSpringEffect* m_sewing = nullptr;
  bool m_loaded = false; ///< with weight and friction
  const BodyMoves* m_moves = nullptr;
  OnMotionFrame m_on_frame;
  body::Body m_end_body;         ///< where the motion left it
  std::vector<double> m_strains; ///< 99th percentile at each look of judge_fit()
  double m_least_strain = 1e300; ///< of m_strains
  int m_strain_fell_at = 0;      ///< step
  double m_slip = -1e300;        ///< m, median at the last look
  bool m_stopped = false;        ///< by time limit, by the user or by the guard
};

} // namespace sloper::garment

#pragma once
/// Drape: from placed panels or a kept garment to cloth at rest on a body.
#include <base/progress.hpp>
#include <body/body.hpp>
#include <garment/garment.hpp>
#include <io/json.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace sloper::garment {

/// Everything that decides a drape, resolved. Field names are the names of --set and of report.json's `settings`.
struct DrapeSettings {
  double time_step_s = 1.0 / 30;
  /// Relative residual at which conjugate gradients stop; from 0.01 on, while sewing and settling, also at 0.15 of the error in the
  /// energy norm, 0.025 where all is as slow as at rest.
  double cg_tolerance = 1e-2;
  int cg_max_iterations = 400;
  int newton_iterations = 1;       ///< of a step while the body moves: StepOptions::newton_iterations
  double motion_step_s = 1.0 / 60; ///< while the body moves steps are at most so long; with inertia, longer ones damp the swing of cloth away
  int solver = 0;                  ///< preconditioner of conjugate gradients: 0 smoothed aggregation, 1 block Jacobi, 2 exact factorisation
  int contact_level = 4;           ///< cloth::ContactLevel with the body: 1 vertex, 2 face, 3 edge, 4 continuous
  double contact_gap_m = 0.003;    ///< distance to the skin at which contact begins
  /// By how much the coarser skin may be off that stands for a dense one, of more than 60,000 triangles, until the cloth is at rest on it
  /// (coarse_skin.hpp), m; twice and four times that where noise leaves no triangle to spare; 0: none does. The cloth then comes to rest on
  /// the skin itself. It halves the time on 220,000 to 430,000 triangles.
  double skin_tolerance_m = 3e-4;
  double self_thickness_m = 0.002; ///< distance at which cloth feels cloth
  double settle_speed_m_s = 0.01;  ///< at rest below this speed
  double settle_force_ratio = 0.2; ///< residual force over a particle's weight
  double gravity_m_s2 = 9.80665;
  int max_steps = 1500;
  double max_seconds = 0;       ///< wall clock, 0 = no limit
  std::string effects = "auto"; ///< "auto" or a list
  std::string accuracy = "standard";
  bool hold_sleeve_ends = false; ///< until the cloth above them has found its folds (sleeve_ends.hpp): retarget() says so. Not of the report
  bool glides_first = false;     ///< free of weight and friction, which would keep strain of the start: drape_layers() says so. Not of the report
};

/// Where a garment that is not yet at rest stands when it is plain that it will not fit; 0: never.
struct FitBounds {
  double slip_m = 0;     ///< half of the particles have sunk farther than this since the start
  double strain_p99 = 0; ///< along the threads (cloth_strain.hpp), and by how it falls it will not come below
  bool tight = true;     ///< the garment is tight at some girth; where it has ease all around, strain is waited for twice as long
};

struct EffectReport {
  std::string name;
  bool active = false;
  std::string why;
  long calls = 0;
  double wall_s = 0;
};

struct DrapeReport {
  bool converged = false;
  std::string stop_reason;
  std::string unfit; ///< what of FitBounds ended the drape: "slides down", "stays stretched", or nothing
  int steps = 0;
  double simulated_s = 0, wall_s = 0;
  std::vector<EffectReport> effects;
  std::vector<std::pair<std::string, double>> phases; ///< name, wall seconds
  io::Json solver;                                    ///< see DESIGN section 5
  io::Json quality;
  std::vector<std::string> repairs;
  DrapeSettings settings;
};

/// What a checkpoint knows of the motion that the drape takes part in, for whoever gives it again.
struct MotionInput {
  std::string sha256; ///< motion_sha256() of its file; empty: not known, and not checked
  double fps = 0;     ///< 1/s, as it was asked for
};

struct LayersProgress; ///< drape_state.hpp

/// Where a drape notes its state now and then, so that it can go on from there after it was killed.
struct Checkpoints {
  std::string file; ///< replaced as a whole each time; empty: none is written
  int every_steps = 100;
  bool renew = false;                     ///< without a file too: what a run with a file does, to the bit
  std::optional<MotionInput> motion = {}; ///< of a drape in motion; drape_in_motion() and drape_layers() fill it in where it is not given
  const LayersProgress* layers = nullptr; ///< set by drape_layers(): of the drapes around this one
};

/// Sews (when seams are open), repairs the start, drapes until at rest.
/// @param garment  in: placed panels (particle_of empty: unsewn) or a sewn garment with positions near the body; out: the state reached
/// @param body     nullptr for none
/// @param bounds   ends the drape, with the reason in `unfit`, once the garment is beyond them
/// @param checkpoints  with a file: from one to the next the solver begins anew, so the result is another, as good, than without
/// @return what happened; not converging is a result, not an exception
/// @throws Error INPUT for a garment that cannot be simulated
DrapeReport drape(Garment& garment, const body::Body* body, const DrapeSettings& settings, Reporter& reporter, const FitBounds& bounds = {},
                  const Checkpoints& checkpoints = {});

/// Whether this JSON file is one, by its envelope. @throws Error INPUT for what is no JSON
bool is_checkpoint(const std::string& path);
/// Goes on from a checkpoint to the same garment, bit by bit, that the undisturbed run would have come to; settings are the checkpoint's.
/// @param garment  in: body_sha256 of the body, or empty to trust the caller; out: the state reached   @param body  the one that the run began with   @param
/// file  new checkpoints go there; empty: nowhere
/// @throws Error INPUT for what is no checkpoint, for another body, or for one of drape_layers() or drape_in_motion(), which drape_job.hpp goes on with
DrapeReport resume_drape(const std::string& checkpoint, Garment& garment, const body::Body* body, Reporter& reporter, const std::string& file = "");

/// Draws crossing cloth apart and out of the body without draping: only what crosses moves, by short steps; where that does not do, the body
/// is drawn in and inflated again under the whole garment, without weight. `quality.untangled` has the counts before and after; they are told.
/// @return converged: nothing crosses any more; a garment that was clean stays as it was, to the bit
/// @throws Error INPUT for a garment that is not sewn
DrapeReport untangle_only(Garment& garment, const body::Body* body, const DrapeSettings& settings, Reporter& reporter);

/// The report document without its envelope's inputs and hashes, which the tool adds.
io::Json report_json(const DrapeReport& report, const std::string& tool);

/// SHA-256 of the particle positions: of their bytes, and of their 10 um cells (to compare machines and compilers).
std::string strict_hash(const Garment& garment);
std::string quantised_hash(const Garment& garment);

} // namespace sloper::garment

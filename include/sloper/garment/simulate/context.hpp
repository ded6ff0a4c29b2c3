#pragma once
/// All that the phases of a drape share. The session owns it and hands it to one phase at a time;
/// nothing else keeps pointers into it.
#include <sloper/garment/body_model/collision_body.hpp>
#include <sloper/garment/simulate/fit_monitor.hpp>
#include <sloper/garment/simulate/penetration_resolver.hpp>
#include <sloper/garment/simulate/request.hpp>
#include <sloper/garment/simulate/simulated_cloth.hpp>
#include <sloper/garment/simulate/step_controller.hpp>
#include <sloper/garment/simulate/telemetry.hpp>
#include <sloper/garment/simulate/temporary_supports.hpp>

namespace sloper::garment {

/// Where a phase says that its state is whole, so that a checkpoint may be taken.
class CheckpointSink {
public:
  virtual ~CheckpointSink() = default;
  /// Between two steps: takes a checkpoint where one is due. @return whether the solver was built
  /// anew
  virtual bool offer() = 0;
  /// For a phase with a counter of its own: takes one when `count` is far enough beyond
  /// `last`.
  /// @param last  in and out
  virtual bool offer(int count, int& last) = 0;
};

/// Settings, body, cloth and services of one drape.
struct SimContext {
  /// All outlive this. @throws Error INPUT for a garment that cannot be simulated
  SimContext(Garment& garment, const body::Body* body_model, const DrapeSettings& drape_settings,
             const FitBounds& bounds, Reporter& reporter)
      : settings(drape_settings), telemetry(drape_settings, reporter),
        body(body_model, drape_settings.skin_tolerance_m, reporter),
        cloth(garment, settings, body, telemetry), stepper(cloth, settings, telemetry),
        resolver(cloth, body, telemetry), supports(cloth, settings, resolver, telemetry),
        fit(bounds, cloth) {}
  SimContext(const SimContext&) = delete;
  SimContext& operator=(const SimContext&) = delete;

  /// Builds cloth, solver and effects for the garment as it stands, and applies the
  /// temporary supports again. Arguments as of SimulatedCloth::build().
  void build_cloth(bool open_seams, bool keep_velocity = false) {
    supports.forget_effects();
    cloth.build(open_seams, keep_velocity);
    supports.apply();
  }

  const DrapeSettings settings;          ///< of the whole drape
  Telemetry telemetry;                   ///< report and times
  CollisionBody body;                    ///< as cloth meets it
  SimulatedCloth cloth;                  ///< solver and effects
  StepController stepper;                ///< guarded steps
  PenetrationResolver resolver;          ///< moves what crosses
  TemporarySupports supports;            ///< until weight comes
  FitMonitor fit;                        ///< early end
  CheckpointSink* checkpoints = nullptr; ///< set by the session
  /// The start is strained, by sewing, by a body that was drawn in or by StartFacts: it
  /// first relaxes without load.
  bool disturbed = false;
  bool only_clear = false; ///< DrapeRequest::only_clear
  bool carried = false;    ///< DrapeRequest::carried
};

} // namespace sloper::garment

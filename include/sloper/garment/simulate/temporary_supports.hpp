#pragma once
/// What helps a garment for a moment after sewing or placing, until weight and friction come: a
/// little pressure from within, sleeve ends held at the wrists, cloth that sewing left tangled
/// passing through itself. They come with effects = auto only, and not where they are switched off.
#include <sloper/garment/simulate/penetration_resolver.hpp>
#include <sloper/garment/simulate/simulated_cloth.hpp>
#include <sloper/io/json_fwd.hpp>

#include <string>
#include <vector>

namespace sloper::garment {

class TemporarySupports {
public:
  /// What a checkpoint keeps.
  struct State {
    std::vector<Vec3> held;   ///< m, where sleeve ends are held (sleeve_ends.hpp)
    std::vector<int> tangles; ///< particles that may pass through each other

    void write(io::Json& state) const;
    /// @throws Error INPUT, for particles that are not there too
    static State read(const io::Node& state, std::size_t n_particles);
  };

  /// All outlive this.
  TemporarySupports(SimulatedCloth& cloth, const DrapeSettings& settings,
                    PenetrationResolver& resolver, Telemetry& telemetry);

  /// A flared hem that sewing has dented inwards may stay so: a cone turned in is a state of rest
  /// too. Pressure from within turns it out. Not for cloth without seams, which would fly off.
  void add_inflation_pressure();
  void remove_inflation_pressure();

  /// Holds sleeve ends where they are now, from the next apply() on.
  void find_sleeve_ends();
  /// Where seams meet, panels that were drawn together may be tucked into each other, and once
  /// nothing crosses contact would keep them so. What crosses, and cloth around it, passes through
  /// itself until weight comes; bending and pressure smooth it meanwhile. Where only a little
  /// crosses, it is drawn apart for good: letting that pass too left knots in arm pits.
  void find_tangles();
  /// Holds sleeve ends and lets tangles pass, on a solver that was just built.
  void apply();
  void release_sleeve_ends();
  void close_tangles();

  const State& state() const { return m_state; }
  void restore(State state) { m_state = std::move(state); }
  /// The solver is built anew: its effects are gone.
  void forget_effects();

private:
  bool may_help(const std::string& effect) const;
  void remove_temporary_effect(const cloth::Effect*& effect);

  SimulatedCloth& m_cloth;
  const DrapeSettings& m_settings;
  PenetrationResolver& m_resolver;
  Telemetry& m_telemetry;
  State m_state;
  const cloth::Effect* m_pressure = nullptr; // of the solver
  const cloth::Effect* m_hold = nullptr;
};

} // namespace sloper::garment

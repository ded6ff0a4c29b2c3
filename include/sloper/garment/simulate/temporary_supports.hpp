#pragma once
/// Helps a garment after sewing or placing, until weight and friction come: a little
/// pressure from within, sleeve ends held at the wrists, tangled cloth that may pass
/// through itself. They come with effects = auto only, and not where they are switched
/// off.
#include <sloper/garment/simulate/penetration_resolver.hpp>
#include <sloper/garment/simulate/request.hpp>
#include <sloper/garment/simulate/simulated_cloth.hpp>
#include <sloper/io/json_fwd.hpp>

#include <string>
#include <vector>

namespace sloper::garment {

/// Particles of cloth that crosses itself, and of cloth around it. Linear in triangles and rings.
/// @param position  #particles by 3, m   @param triangles  of particles
/// @param rings  of triangles around what crosses
/// @return #particles, 1 where it is near; empty: nothing crosses
std::vector<char> near_crossings(const std::vector<Vec3>& position,
                                 const std::vector<Triangle>& triangles, int rings);

/// Adds and removes the temporary supports of one session.
class TemporarySupports {
public:
  /// State that a checkpoint keeps.
  struct State {
    LimbEnds ends = LimbEnds::NONE; ///< that are held (sleeve_ends.hpp)
    std::vector<Vec3> held;         ///< m, where
    std::vector<int> tangles;       ///< particles that may pass through each other

    /// Adds its keys to a checkpoint's object; read() is the inverse.
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
  /// Ends the pressure; nothing where there is none.
  void remove_inflation_pressure();

  /// Holds ends where they are now, from the next apply() on.
  void find_ends(LimbEnds ends);
  /// Where seams meet, panels that were drawn together may be tucked into each other, and once
  /// nothing crosses contact would keep them so. What crosses, and cloth around it, passes through
  /// itself until weight comes; bending and pressure smooth it meanwhile. Where only a little
  /// crosses, it is drawn apart for good: letting that pass too left knots in arm pits.
  void find_tangles();
  /// A fold that is turned inside out along a seam, or a hem that hangs through a panel, is not
  /// drawn apart: the line along which it crosses has no two sides, or stays as long. What crosses
  /// at rest, and cloth around it, passes through itself from now on: its own stiffness and weight
  /// bring it out.
  /// @param reach  m, around what crosses
  void open_knots(double reach);
  /// Holds ends and lets tangles pass, on a solver that was just built.
  void apply();
  /// Ends what find_ends() began; nothing where it found nothing.
  void release_ends();
  /// Ends what find_tangles() or open_knots() began: self-contact acts everywhere again, and
  /// remaining crossings are drawn apart.
  void close_tangles();

  /// For checkpoints.
  const State& state() const { return m_state; }
  /// Takes the state of a checkpoint; apply() puts it into effect.
  void restore(State state) { m_state = std::move(state); }
  /// The solver is built anew: its effects are gone.
  void forget_effects();

private:
  bool may_help(const std::string& effect) const;
  void let_tangles_pass();
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

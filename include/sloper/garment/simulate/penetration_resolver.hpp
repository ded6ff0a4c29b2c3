#pragma once
/// Moves cloth that crosses itself apart, and out of the body, by short moves of the
/// crossing cloth alone.
#include <sloper/garment/body_model/collision_body.hpp>
#include <sloper/garment/simulate/simulated_cloth.hpp>
#include <sloper/garment/simulate/telemetry.hpp>
#include <sloper/io/json_fwd.hpp>

#include <cstddef>
#include <vector>

namespace sloper::garment {

inline constexpr int MAX_PUSH_STEPS = 120; ///< for cloth at rest that is still through the skin
inline constexpr int MAX_RESOLVE_ALL_ROUNDS = 300; ///< of resolve_all(), where nothing else is done

/// Resolves crossings of one session's cloth.
class PenetrationResolver {
public:
  /// State that a checkpoint keeps: how often it was called for.
  struct State {
    int untanglings = 0; ///< of cloth that crosses itself
    int partings = 0;    ///< of cloth and skin

    /// Adds its keys to a checkpoint's object; read() is the inverse.
    void write(io::Json& state) const;
    static State read(const io::Node& state); ///< @throws Error INPUT
  };

  /// All outlive this.
  PenetrationResolver(SimulatedCloth& cloth, CollisionBody& body, Telemetry& telemetry);

  /// Moves cloth that crosses itself apart, ignoring the body. The report lists it as a
  /// repair where anything crossed.
  /// @return pairs of triangles that still cross. Cost: up to 80 searches for crossings
  std::size_t untangle();
  /// untangle() between two steps of the solver: contacts are searched anew, velocity is
  /// zero.
  void untangle_in_flight();
  /// Draws cloth out of itself and out of the body. The garment is left at its best
  /// state.
  /// @param max_rounds  at most
  /// @param rounds  out: made
  /// @return crossing pairs, faces through the skin and vertices inside that are left
  std::size_t resolve_all(int max_rounds, int& rounds);
  /// Moves the few vertices and faces that start in the body out of it, of a garment that
  /// was in order: drawing in the body would undo how it hangs.
  /// @param violations  vertices and faces in the body
  /// @return whether that was enough; else nothing moved
  bool resolve_initial(std::size_t violations);
  /// Moves the last faces through the skin out of it while the garment settles: contact
  /// alone does not free cloth whose other side is held too, as in the fold of an arm
  /// pit.
  /// @return whether there were any
  bool resolve_residual();
  /// How many vertices are in the body, and faces through its skin, at the garment's positions.
  std::size_t count_in_body() const;
  /// Writes the number of crossing triangle pairs to the log.
  /// @param when  begins the line
  void log_crossings(const char* when) const;

  /// For checkpoints.
  const State& state() const { return m_state; }
  /// Takes the state of a checkpoint.
  void restore(const State& state) { m_state = state; }

private:
  std::size_t push_out_of_body(const std::vector<Vec3>& x, const std::vector<Triangle>& triangles,
                               std::vector<Vec3>& move) const;

  SimulatedCloth& m_cloth;
  CollisionBody& m_body;
  Telemetry& m_telemetry;
  State m_state;
};

} // namespace sloper::garment

#pragma once
/// Decides whether a garment that is not yet at rest can still fit.
///
/// Cloth that is laid on a body too stretched relaxes along its threads within some tens
/// of steps: strain decays roughly geometrically, and then the cloth slides slowly or not
/// at all. So the extrapolated limit is judged: the strain less 20 times (40 with ease
/// all around) its last change. While internal forces are still large against the
/// tension, the extrapolation is not trusted.
#include <sloper/garment/simulate/request.hpp>
#include <sloper/garment/simulate/simulated_cloth.hpp>
#include <sloper/garment/simulate/stop_reason.hpp>
#include <sloper/io/json_fwd.hpp>

#include <vector>

namespace sloper::garment {

/// Ends a drape whose garment is beyond FitBounds for good.
class FitMonitor {
public:
  /// State that a checkpoint keeps: what was seen so far.
  struct State {
    std::vector<double> strains; ///< 99th percentile along the threads at each look
    double least_strain = 1e300; ///< of those
    int strain_fell_at = 0;      ///< step at which it last fell by a few per cent
    double slip = -1e300;        ///< m, median at the last look

    /// For a checkpoint; read() is the inverse.
    io::Json to_json() const;
    static State read(const io::Node& state); ///< @throws Error INPUT
  };

  /// @param cloth outlives this
  FitMonitor(const FitBounds& bounds, SimulatedCloth& cloth) : m_bounds(bounds), m_cloth(cloth) {}
  /// Measures slip and strain and judges them.
  /// @param start_height  #P, m: y where settling began
  /// @param last  the last step
  /// @param steps  of the drape so far
  /// @return which bound it is beyond for good
  Misfit judge(const std::vector<double>& start_height, const cloth::StepResult& last, int steps);

  /// The bounds as given; and the state for checkpoints.
  const FitBounds& bounds() const { return m_bounds; }
  const State& state() const { return m_state; }
  /// Takes the state of a checkpoint.
  void restore(State state) { m_state = std::move(state); }

private:
  bool is_calm(const cloth::StepResult& last) const;
  bool slides(const std::vector<double>& start_height);
  bool stays_stretched(const cloth::StepResult& last, int steps);

  FitBounds m_bounds;
  SimulatedCloth& m_cloth;
  State m_state;
};

} // namespace sloper::garment

#pragma once
/// The record of a drape while it runs: the report, and how long its phases took.
#include <sloper/base/progress.hpp>
#include <sloper/garment/simulate/report.hpp>
#include <sloper/geometry/types.hpp>

#include <chrono>
#include <string>

namespace sloper::garment {

/// Collects the report of one session.
class Telemetry {
public:
  /// Starts the clock.
  /// @param reporter  outlives this
  Telemetry(const DrapeSettings& settings, Reporter& reporter);

  /// s of wall clock since the drape began, those of the runs before a checkpoint included.
  double elapsed() const;
  /// The runs before this one took so long, s.
  void add_elapsed_before(double wall_s) { m_elapsed_before = wall_s; }
  /// Adds wall seconds to a phase by name; the same name again adds to it.
  void add_phase_time(const std::string& phase, double wall_s);
  /// Adds a sentence to DrapeReport::repairs.
  void add_repair(std::string repair) { report.repairs.push_back(std::move(repair)); }
  /// Marks an effect as active that a phase adds for a while.
  /// @param why  for the report
  void activate(const char* effect, const char* why);
  /// Whether the effect of that name takes part.
  bool is_active(const char* effect) const;

  DrapeReport report; ///< filled by all parts of the session
  Reporter& reporter; ///< log, progress and warnings

private:
  std::chrono::steady_clock::time_point m_start;
  double m_elapsed_before = 0;
};

/// Times a phase, into the report, and names it in the log.
class PhaseTimer {
public:
  /// Starts timing.
  /// @param telemetry  outlives this
  PhaseTimer(Telemetry& telemetry, std::string name);
  PhaseTimer(const PhaseTimer&) = delete;
  PhaseTimer& operator=(const PhaseTimer&) = delete;
  ~PhaseTimer() { m_telemetry.add_phase_time(m_name, m_telemetry.elapsed() - m_began); }

private:
  Telemetry& m_telemetry;
  std::string m_name;
  double m_began;
};

std::string place_text(const Vec3& p);  ///< "(0.012, 1.034, 0.120) m"
std::string millimetres_text(double m); ///< to a tenth: "1.2 mm"

} // namespace sloper::garment

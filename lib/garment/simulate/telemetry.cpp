#include <sloper/base/text.hpp>
#include <sloper/garment/simulate/telemetry.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::garment {

Telemetry::Telemetry(const DrapeSettings& settings, Reporter& r)
    : reporter(r), m_start(std::chrono::steady_clock::now()) {
  report.settings = settings;
}

double Telemetry::elapsed() const {
  return m_elapsed_before +
         std::chrono::duration<double>(std::chrono::steady_clock::now() - m_start).count();
}

void Telemetry::add_phase_time(const std::string& phase, double wall_s) {
  auto& phases = report.phases;
  const auto same =
      std::find_if(phases.begin(), phases.end(), [&](const auto& p) { return p.first == phase; });
  if (same == phases.end())
    phases.emplace_back(phase, wall_s);
  else
    same->second += wall_s; // a phase that comes twice, or a run that continues a checkpoint
}

void Telemetry::activate(const char* effect, const char* why) {
  for (EffectReport& e : report.effects)
    if (e.name == effect) {
      e.active = true;
      e.why = why;
    }
}

bool Telemetry::is_active(const char* effect) const {
  return garment::is_active(report.effects, effect);
}

PhaseTimer::PhaseTimer(Telemetry& telemetry, std::string name)
    : m_telemetry(telemetry), m_name(std::move(name)), m_began(telemetry.elapsed()) {
  telemetry.reporter.info(m_name + " ...");
}

std::string place_text(const Vec3& p) {
  return sloper::place_text(p.x(), p.y(), p.z()) + " m";
}

std::string millimetres_text(double m) {
  const long tenths = std::lround(m * 1e4);
  return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + " mm";
}

} // namespace sloper::garment

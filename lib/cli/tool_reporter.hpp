#pragma once
/// How a tool speaks: warnings and details to stderr, a progress line on a terminal only, Ctrl-C as
/// a stop flag.
#include <chrono>
#include <sloper/base/progress.hpp>
#include <string>

namespace sloper::cli {

class ToolReporter : public Reporter {
public:
  explicit ToolReporter(const std::string& tool_name);
  ~ToolReporter() override;
  bool quiet = false, verbose = false, show_progress = true;

  void info(const std::string& text) override;
  void warning(const std::string& text) override;
  /// Redrawn at most ten times a second; the time left is judged from the pace of this phase.
  void progress(const std::string& phase, double fraction) override;
  bool stop_requested() const override;
  void error(const std::string& text); ///< shown even with -q
  void clear_line();                   ///< takes the progress line away

private:
  using Clock = std::chrono::steady_clock;
  std::string m_tool, m_phase;
  bool m_terminal, m_color, m_line_shown = false;
  Clock::time_point m_phase_start, m_last_drawn;
  void line(const std::string& text, const char* color);
};

/// SIGPIPE is ignored; the first SIGINT or SIGTERM asks to stop, the second one has its usual
/// effect.
void install_signal_handlers();

} // namespace sloper::cli

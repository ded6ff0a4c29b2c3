#pragma once
/// How a tool speaks: warnings and details to stderr, a progress line on a terminal only, Ctrl-C as
/// a stop flag. With `as_json` each line on stderr is one JSON object instead (--messages json).
#include <chrono>
#include <sloper/base/error.hpp>
#include <sloper/base/progress.hpp>
#include <string>

namespace sloper::cli {

/// The reporter of one tool: what a library says goes to stderr, in words or as JSON.
class ToolReporter : public Reporter {
public:
  explicit ToolReporter(const std::string& tool_name);
  ~ToolReporter() override;
  bool quiet = false, verbose = false, show_progress = true, as_json = false;

  void info(const std::string& text) override;
  void warning(const Message& message) override;
  /// Redrawn at most ten times a second; the time left is judged from the pace of this phase.
  void progress(const std::string& phase, double fraction) override;
  bool stop_requested() const override;
  /// Shown even with -q. @param hint  where the error has no next step: a line of its own, or that
  /// step as JSON; may be empty
  void error(const Error& error, const std::string& hint);
  void tell(const std::string& text); ///< a line that an option asked for, shown even with -q
  void clear_line();                  ///< takes the progress line away

private:
  using Clock = std::chrono::steady_clock;
  std::string m_tool, m_phase;
  bool m_terminal, m_color, m_line_shown = false;
  Clock::time_point m_phase_start, m_last_drawn;
  void line(const std::string& text, const char* color);
  std::string with_id(const std::string& text, std::string_view id) const; ///< "text [id]" with -v
};

/// SIGPIPE is ignored; the first SIGINT or SIGTERM asks to stop, the second one has its usual
/// effect.
void install_signal_handlers();

/// Ends the process by the signal that asked to stop, so that a shell sees the interruption and
/// ends its loop; returns where none came. To be called once all results are written.
void end_by_stop_signal();

} // namespace sloper::cli

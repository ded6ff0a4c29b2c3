#include <cli/tool_reporter.hpp>
#include <nlohmann/json.hpp>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>

namespace sloper::cli {

/// The signal that asked to stop, or 0. A signal handler can reach nothing else.
static volatile std::sig_atomic_t g_stop = 0;

extern "C" {
static void on_stop_signal(int number) {
  g_stop = number;
}
}

void install_signal_handlers() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ,
              SIG_IGN); // a limit on file sizes is then an error of writing like a full disk
  struct sigaction action {};
  action.sa_handler = on_stop_signal;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  for (const int signal_number : {SIGINT, SIGTERM}) {
    struct sigaction before {};
    sigaction(signal_number, nullptr, &before);
    if (before.sa_handler != SIG_IGN)
      sigaction(signal_number, &action,
                nullptr); // nohup and background jobs keep what they were given
  }
}

void end_by_stop_signal() {
  const int number = g_stop;
  if (number == 0)
    return;
  std::fflush(nullptr);
  std::signal(number, SIG_DFL);
  std::raise(number);
}

static bool set_in_environment(const char* name) {
  const char* value = std::getenv(name);
  return value && *value;
}

ToolReporter::ToolReporter(const std::string& tool_name) : m_tool(tool_name) {
  const char* terminal_name = std::getenv("TERM");
  m_terminal = isatty(STDERR_FILENO) && terminal_name && std::string(terminal_name) != "dumb";
  m_color = m_terminal && !set_in_environment("NO_COLOR");
}

ToolReporter::~ToolReporter() {
  clear_line();
}

void ToolReporter::clear_line() {
  if (m_line_shown)
    std::fputs("\r\033[K", stderr);
  m_line_shown = false;
}

void ToolReporter::line(const std::string& text, const char* color) {
  clear_line();
  const std::string name =
      m_color && *color ? std::string(color) + m_tool + ":\033[0m" : m_tool + ":";
  std::fprintf(stderr, "%s %s\n", name.c_str(), text.c_str());
}

/// One object, one line. Bytes of a file's name that are no UTF-8 are replaced.
static void print_json(const nlohmann::ordered_json& object) {
  const std::string text =
      object.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  std::fprintf(stderr, "%s\n", text.c_str());
}

std::string ToolReporter::with_id(const std::string& text, std::string_view id) const {
  return verbose ? text + " [" + std::string(id) + "]" : text;
}

void ToolReporter::info(const std::string& text) {
  if (!verbose || quiet)
    return;
  if (as_json)
    print_json({{"tool", m_tool}, {"level", "info"}, {"text", text}});
  else
    line(text, "");
}

void ToolReporter::warning(const Message& message) {
  if (quiet)
    return;
  if (as_json)
    print_json(
        {{"tool", m_tool}, {"level", "warning"}, {"id", message.id}, {"text", message.text}});
  else
    line(with_id("warning: " + message.text, message.id), "\033[33m");
}

void ToolReporter::error(const Error& error, const std::string& hint) {
  const bool is_ours =
      error.kind() == ErrorKind::INTERNAL && error.id() != "general.out-of-memory"_id;
  const std::string text = (is_ours ? "our bug: " : "") + std::string(error.what());
  if (as_json) {
    print_json({{"tool", m_tool},
                {"level", "error"},
                {"id", error.id().text()},
                {"text", text},
                {"file", error.file()},
                {"place", error.place()},
                {"fact", error.fact()},
                {"next_step", error.next_step().empty() ? hint : error.next_step()},
                {"exit", error.exit_code()}});
    return;
  }
  line(with_id(text, error.id().text()), "\033[31m");
  if (!hint.empty())
    std::fprintf(stderr, "%s\n", hint.c_str());
}

void ToolReporter::tell(const std::string& text) {
  clear_line();
  if (as_json)
    print_json({{"tool", m_tool}, {"level", "info"}, {"text", text}});
  else
    std::fprintf(stderr, "%s\n", text.c_str());
}

bool ToolReporter::stop_requested() const {
  return g_stop != 0;
}

static constexpr double LEAST_TO_FORETELL = 0.02; // of a phase, for a guess of the time left

static std::string clock_text(double seconds) {
  constexpr long MINUTE = 60, HOUR = 60 * MINUTE; // s
  const long whole = std::lround(seconds), minutes = whole % HOUR / MINUTE, rest = whole % MINUTE;
  char text[32];
  if (whole >= HOUR)
    std::snprintf(text, sizeof text, "%ld h %02ld min", whole / HOUR, minutes);
  else if (whole >= MINUTE)
    std::snprintf(text, sizeof text, "%ld min %02ld s", minutes, rest);
  else
    std::snprintf(text, sizeof text, "%ld s", whole);
  return text;
}

void ToolReporter::progress(const std::string& phase, double fraction) {
  if (quiet || !show_progress || !m_terminal || as_json)
    return;
  const Clock::time_point now = Clock::now();
  const bool new_phase = phase != m_phase || m_phase_start == Clock::time_point{};
  if (new_phase) {
    m_phase = phase;
    m_phase_start = now;
  } else if (now - m_last_drawn < std::chrono::milliseconds(100) && fraction < 1)
    return;
  m_last_drawn = now;
  std::string text = m_tool + ": " + phase;
  if (fraction >= 0) {
    fraction = std::min(fraction, 1.0);
    text.append(" ").append(std::to_string(std::lround(100 * fraction))).append(" %");
    const double elapsed = std::chrono::duration<double>(now - m_phase_start).count();
    const bool known = fraction > LEAST_TO_FORETELL && fraction < 1 && elapsed > 1;
    if (known)
      text.append(", ").append(clock_text(elapsed * (1 - fraction) / fraction)).append(" left");
  }
  std::fprintf(stderr, "\r\033[K%s", text.c_str());
  std::fflush(stderr);
  m_line_shown = true;
}

} // namespace sloper::cli

#pragma once
/// How a library function speaks while it works: it is handed a Reporter and never prints by
/// itself.
#include <string>
namespace sloper {
class Reporter {
public:
  virtual ~Reporter() = default;
  virtual void info(const std::string&) {}    ///< shown with -v
  virtual void warning(const std::string&) {} ///< shown unless -q
  /// @param fraction 0..1 of the phase that is done, or negative when unknown
  virtual void progress(const std::string& /*phase*/, double /*fraction*/) {}
  /// True once the user asked to stop (Ctrl-C): finish the step, return the last good state.
  virtual bool stop_requested() const { return false; }
};
/// A reporter that says nothing.
Reporter& silent_reporter();
} // namespace sloper

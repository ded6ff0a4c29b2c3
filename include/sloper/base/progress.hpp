#pragma once
/// How a library function reports while it works: it is given a Reporter and never prints
/// by itself.
#include <sloper/base/message.hpp>
#include <string>
namespace sloper {
/// Receives log lines, warnings and progress; override those of interest. They come from
/// one thread at a time; stop_requested() may be asked by several (garment::redrape()).
class Reporter {
public:
  virtual ~Reporter() = default;
  virtual void info(const std::string&) {} ///< shown with -v
  virtual void warning(const Message&) {}  ///< shown unless -q
  /// @param fraction 0..1 of the phase that is done, or negative when unknown
  virtual void progress(const std::string& /*phase*/, double /*fraction*/) {}
  /// True once the user asked to stop (Ctrl-C): finish the step, return the last good state.
  virtual bool stop_requested() const { return false; }
};
/// A reporter that says nothing.
Reporter& silent_reporter();
} // namespace sloper

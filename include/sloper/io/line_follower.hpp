#pragma once
/// Lines of a file that grows while it is read, or of standard input as they arrive.
#include <optional>
#include <string>

namespace sloper::io {

/// Follows one file or standard input.
class LineFollower {
public:
  /// @param path  a file, or "-" for standard input. @throws Error INPUT where it cannot be opened
  explicit LineFollower(const std::string& path);
  ~LineFollower();
  LineFollower(const LineFollower&) = delete;
  LineFollower& operator=(const LineFollower&) = delete;

  /// The next whole line, without its end; empty where none came in time. A file's last
  /// line counts once its newline is there; the rest of a closed standard input counts
  /// without.
  /// @param wait_ms  longest wait, ms
  std::optional<std::string> next(int wait_ms);
  /// Nothing more can come: standard input was closed, and all of it was given. A file never ends.
  bool ended() const { return m_closed && m_buffer.empty(); }
  int line() const { return m_line; } ///< number of the line that next() gave last, from 1

private:
  bool fill(); ///< true where bytes came
  std::optional<std::string> take();
  int m_file = -1, m_line = 0;
  bool m_stream = false, m_closed = false;
  std::string m_buffer;
  std::size_t m_searched = 0;
};

} // namespace sloper::io

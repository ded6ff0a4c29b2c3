#pragma once
/// The lines of a live session: a head, edits, an end. See follow().
#include <sloper/io/json.hpp>
#include <sloper/pattern/pattern.hpp>

#include <optional>
#include <string>

namespace sloper::garment {

/// How a session ends. WARM leaves the cloth in its own rest; REPLAY goes back to the start and
/// makes all edits at once; COLD drapes the edited pattern anew.
enum class Finish {
  WARM,
  REPLAY,
  COLD,
};

/// Takes the lines one by one and holds them against what may stand where.
class EditLines {
public:
  /// @param has_body  without one the panels cannot be placed for a cold finish
  explicit EditLines(bool has_body) : m_has_body(has_body) {}

  /// What a line asks for.
  struct Taken {
    std::size_t edits = 0;                ///< how many
    std::optional<pattern::Pattern> next; ///< the edited pattern, where there are any
    io::Json document;                    ///< they, with their length unit
  };
  /// Reads the next line. @param pattern  to be edited   @throws Error INPUT for what is no edit of
  /// it; then nothing changed
  Taken take(const std::string& line, const pattern::Pattern& pattern);
  /// Adds what was taken, once the garment has it, to the log.
  void log_taken(const Taken& taken);
  /// The edits so far, as a document that pattern-mesh --edits replays.
  const io::Json& log() const { return m_log; }
  bool ended() const { return m_ended; }
  std::optional<Finish> finish() const { return m_finish; } ///< as asked for

private:
  void take_end(const io::Node& node);

  bool m_has_body;
  int m_line = 0;
  io::Json m_head;
  io::Json m_log = {
      {"format", "edits"}, {"version", 1}, {"length_unit", "m"}, {"edits", io::Json::array()}};
  bool m_ended = false;
  std::optional<Finish> m_finish;
};

} // namespace sloper::garment

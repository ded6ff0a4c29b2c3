#pragma once
/// Typed errors. Thrown in lib, caught once, in cli::Tool::run(). Every message says file, place,
/// fact and next step, and has an id that lasts (base/message.hpp).
/// Test: tests/base/test_error.cpp
#include <sloper/base/message.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace sloper {

/// What went wrong, in the terms of the command-line contract: each kind is one exit code.
enum class ErrorKind {
  USAGE = 2,    ///< wrong command line
  INPUT = 3,    ///< bad or unreadable input
  FAILED = 4,   ///< computed, but the result is not good enough to be called done
  OUTPUT = 5,   ///< cannot write
  INTERNAL = 70 ///< our own mistake
};

/// One error with the four things a reader needs.
/// what() reads "file: place: fact; next step", with empty parts left out.
class Error : public std::runtime_error {
public:
  /// @param id        what docs/messages.md has it under
  /// @param file      path as the user wrote it, or empty
  /// @param place     JSON pointer, line number, panel or element; or empty
  /// @param fact      what is wrong, in one clause
  /// @param next_step what to do about it, or empty
  Error(ErrorKind kind, MessageId id, std::string file, std::string place, std::string fact,
        std::string next_step = {});
  ErrorKind kind() const { return m_kind; }
  MessageId id() const { return m_id; }
  int exit_code() const { return static_cast<int>(m_kind); }
  const std::string& file() const { return m_file; }
  const std::string& place() const { return m_place; }
  const std::string& fact() const { return m_fact; }
  const std::string& next_step() const { return m_next_step; }

private:
  ErrorKind m_kind;
  MessageId m_id;
  std::string m_file, m_place, m_fact, m_next_step;
};

/// Shorthand for the most frequent error: bad input, exit 3.
Error input_error(MessageId id, std::string file, std::string place, std::string fact,
                  std::string next_step = {});

/// A word of an option that is not one of the known ones: exit 2, with the nearest of
/// them.
/// @param option  such as "--view"
/// @param word  the unknown one
/// @param next_step  what to do, or empty
Error unknown_word(const std::string& option, const std::string& word,
                   const std::vector<std::string>& known, std::string next_step);

/// " (did you mean 'X'?)" with the word of `known` nearest to `word` by edit distance, between
/// `quote`s; empty when none is near.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& known,
                         const char* quote = "'");

} // namespace sloper

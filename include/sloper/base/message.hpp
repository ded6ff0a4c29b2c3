#pragma once
/// Lasting names of what Sloper says. An id such as "pattern.outline-open" names one kind of fault:
/// one cause, one cure, however many places find it. Programs and scripts may rely on it where
/// words change: an id keeps its meaning and is never used again for another. docs/messages.md
/// lists all, and tests/cli/test-messages compares that list with the code.
#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

namespace sloper {

/// @return whether `text` is letters, a dot, then words of small letters and digits joined by
/// single hyphens
constexpr bool is_message_id(std::string_view text) {
  const std::size_t dot = text.find('.');
  if (dot == 0 || dot == std::string_view::npos || dot + 1 == text.size())
    return false;
  char before = '-'; // no word begins or ends with a hyphen
  for (std::size_t k = 0; k < text.size(); ++k) {
    const char c = text[k];
    const bool is_letter = c >= 'a' && c <= 'z', is_digit = c >= '0' && c <= '9';
    if (k == dot)
      before = '-';
    else if (is_letter || (is_digit && k > dot))
      before = c;
    else if (c == '-' && k > dot && before != '-')
      before = c;
    else
      return false;
  }
  return before != '-';
}

/// The characters of an id, as the argument of a template. (A consteval literal would do, but clang
/// before 17 leaves calls of it in templates.)
template<std::size_t N> struct IdText {
  /// @param text  of the literal, with the 0 at its end; another form than an id's does not compile
  constexpr IdText(const char (&text)[N]) {
    if (!is_message_id({text, N - 1}))
      throw "a message id is topic.fact in small letters";
    std::copy_n(text, N, characters);
  }
  char characters[N]; ///< with the 0 at their end
};

/// Made by the literal alone, "pattern.outline-open"_id, so that a search finds every one. The form
/// is checked when it is compiled: a topic of letters, a dot, and words of letters and digits with
/// hyphens.
class MessageId {
public:
  /// "pattern.outline-open"; the text lives as long as the program.
  constexpr std::string_view text() const { return m_text; }
  /// A copy of text().
  std::string string() const { return std::string(m_text); }
  friend constexpr bool operator==(MessageId a, MessageId b) { return a.m_text == b.m_text; }

private:
  template<IdText TEXT> friend constexpr MessageId operator""_id();
  constexpr explicit MessageId(std::string_view text) : m_text(text) {}
  std::string_view m_text; // of a literal, which outlives all
};

/// "pattern.outline-open"_id. Another form does not compile.
template<IdText TEXT> constexpr MessageId operator""_id() {
  return MessageId({TEXT.characters, sizeof TEXT.characters - 1});
}

/// A warning, or a finding that may become one.
struct Message {
  /// @param words  one line, without the program's name and the id
  Message(MessageId message, std::string words) : id(message.text()), text(std::move(words)) {}
  /// Of a document. @param message  its id there; empty where an older document has none
  static Message read(std::string message, std::string words) {
    return {std::move(message), std::move(words)};
  }
  std::string id;   ///< as docs/messages.md lists it; empty where an older document has none
  std::string text; ///< one line, without the program's name and the id
  friend bool operator==(const Message&, const Message&) = default;

private:
  Message(std::string message, std::string words)
      : id(std::move(message)), text(std::move(words)) {}
};

} // namespace sloper

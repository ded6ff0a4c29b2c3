#include <sloper/base/error.hpp>

#include <algorithm>
#include <vector>

namespace sloper {

static std::string join(const std::string& file, const std::string& place, const std::string& fact,
                        const std::string& next_step) {
  std::string out;
  for (const std::string* part : {&file, &place, &fact}) {
    if (part->empty())
      continue;
    if (!out.empty())
      out += ": ";
    out += *part;
  }
  if (!next_step.empty())
    out += "; " + next_step;
  return out;
}

Error::Error(ErrorKind kind, MessageId id, std::string file, std::string place, std::string fact,
             std::string next_step)
    : std::runtime_error(join(file, place, fact, next_step)), m_kind(kind), m_id(id),
      m_file(std::move(file)), m_place(std::move(place)), m_fact(std::move(fact)),
      m_next_step(std::move(next_step)) {}

Error input_error(MessageId id, std::string file, std::string place, std::string fact,
                  std::string next_step) {
  return {ErrorKind::INPUT,    id, std::move(file), std::move(place), std::move(fact),
          std::move(next_step)};
}

static std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j)
    row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0 : 1)});
      diagonal = above;
    }
  }
  return row[b.size()];
}

Error unknown_word(const std::string& option, const std::string& word,
                   const std::vector<std::string>& known, std::string next_step) {
  return {ErrorKind::USAGE,
          "option.unknown-word"_id,
          "",
          option + " " + word,
          "is not known" + did_you_mean(word, known),
          std::move(next_step)};
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& known,
                         const char* quote) {
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string& candidate : known) {
    const std::size_t d = edit_distance(word, candidate);
    if (d < best_distance) {
      best_distance = d;
      best = candidate;
    }
  }
  return best.empty() ? best : std::string(" (did you mean ") + quote + best + quote + "?)";
}

} // namespace sloper

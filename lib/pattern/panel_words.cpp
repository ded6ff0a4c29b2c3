#include <pattern/panel_words.hpp>

#include <algorithm>
#include <cctype>

namespace sloper::pattern {

/// Adds the words that parts of Chinese, Japanese and Korean names stand for, which are written
/// without gaps, in UTF-8.
static void add_east_asian(const std::string& name, Words& words) {
  const auto add = [&](const char* word, std::initializer_list<const char*> parts) {
    if (std::any_of(parts.begin(), parts.end(),
                    [&](const char* part) { return name.find(part) != std::string::npos; }))
      words.insert(word);
  };
  add("front", {"\u524d", "\uc55e"});
  add("back", {"\u540e", "\u5f8c", "\ub4a4"});
  add("yoke", {"\u8fc7\u80a9", "\u30e8\u30fc\u30af", "\uc694\ud06c"});
  add("sleeve", {"\u8896", "\uc18c\ub9e4"});
  add("cuff", {"\u514b\u592b", "\u30ab\u30d5\u30b9", "\ucee4\ud504\uc2a4"});
  add("collar", {"\u9886", "\u9818", "\u887f", "\u895f", "\uce7c\ub77c"});
  add("hood", {"\u5e3d", "\u30d5\u30fc\u30c9", "\ud6c4\ub4dc"});
  add("trousers", {"\u88e4", "\u8932", "\u30d1\u30f3\u30c4", "\u30ba\u30dc\u30f3", "\ubc14\uc9c0"});
  add("skirt", {"\u88d9", "\u30b9\u30ab\u30fc\u30c8", "\uc2a4\ucee4\ud2b8", "\uce58\ub9c8"});
  add("waist", {"\u8170", "\u30a6\u30a8\u30b9\u30c8", "\ud5c8\ub9ac"});
  add("left", {"\u5de6", "\uc67c"});
  add("right", {"\u53f3", "\uc624\ub978"});
}

Words words_of(const std::string& name) {
  Words words;
  add_east_asian(name, words);
  std::string word;
  char last = 0, before_word = 0;
  const auto is_digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  for (char c : name + "_") {
    const bool letter = std::isalpha(static_cast<unsigned char>(c)) != 0;
    if (!letter || (std::isupper(static_cast<unsigned char>(c)) &&
                    std::islower(static_cast<unsigned char>(last)))) {
      // A letter between digits is of a number: autumn 2017 in GMH2446F17BA, not a front.
      if (!word.empty() && !(word.size() == 1 && is_digit(before_word) && is_digit(c)))
        words.insert(word);
      word.clear();
    }
    if (letter) {
      if (word.empty())
        before_word = last;
      word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    last = c;
  }
  return words;
}

Words words_of(const Pattern& pattern, std::size_t k) {
  const Panel& panel = pattern.panels[k];
  Words words = words_of(panel.name);
  if (pattern.source_format != "dxf" && pattern.source_format != "clo")
    return words;
  const bool side_told = name_suggests_front(words) || says_back(words);
  for (const std::string& word : words_of(panel.label))
    if (!side_told || (!name_suggests_front({word}) && !says_back({word})))
      words.insert(word);
  return words;
}

bool any_of(const Words& words, std::initializer_list<const char*> wanted) {
  return std::any_of(wanted.begin(), wanted.end(),
                     [&](const char* w) { return words.count(w) != 0; });
}

bool any_begins(const Words& words, std::initializer_list<const char*> starts) {
  for (const std::string& w : words)
    for (const char* start : starts)
      if (w.rfind(start, 0) == 0)
        return true;
  return false;
}

bool any_ends(const Words& words, std::initializer_list<const char*> ends) {
  for (const std::string& w : words)
    for (const std::string end : ends)
      if (w.size() > end.size() && w.compare(w.size() - end.size(), end.size(), end) == 0)
        return true;
  return false;
}

bool says_sleeve(const Words& words) {
  for (const std::string& w : words) // FULLSLEEVE; but not SLEEVELESS
    if (const std::size_t at = w.find("sleeve");
        at != std::string::npos && w.compare(at, 10, "sleeveless") != 0)
      return true;
  return any_ends(words, {"slv", "sl"}) ||
         any_begins(words, {"slv", "manche", "manga", "manica", "rukav", "rekaw", "mouw", "aermel",
                            "rmel"}) ||
         any_of(words, {"sl"});
}
bool says_cuff(const Words& words) {
  return any_begins(words, {"cuff", "mansch"});
}
bool says_neck(const Words& words) {
  return any_begins(words, {"collar", "stand", "neck", "hood", "turtle", "lapel", "kragen",
                            "kapuze", "cuello", "capuch", "colletto"}) ||
         any_of(words, {"col"});
}
bool says_legs(const Words& words) {
  if (any_begins(words, {"leg", "pant", "trouser", "jean", "hose", "pantal"}))
    return true;
  return any_begins(words, {"short"}) && !says_sleeve(words); // a short sleeve is none
}
bool says_skirt(const Words& words) {
  if (says_cuff(words))
    return false; // the skirt of a cuff
  return any_begins(words, {"skirt", "gore", "waist", "rock", "jupe", "falda", "gonna"}) ||
         any_of(words, {"wb"});
}
bool name_suggests_front(const Words& words) {
  return any_begins(words, {"front", "frt", "ftorso", "fbodice", "vorder", "devant", "delanter",
                            "davanti"}) ||
         any_of(words, {"f", "cf", "fr"}) || any_ends(words, {"fr"});
}
bool says_back(const Words& words) {
  return any_begins(words, {"back", "bck", "rear", "bk", "btorso", "bbodice", "rueck", "hinter",
                            "espalda", "traser", "dietro", "yoke"}) ||
         any_of(words, {"b", "cb", "dos"}) || any_ends(words, {"bk"});
}
bool say_sleeve_halves(const Words& one, const Words& other) {
  return says_sleeve(one) && says_sleeve(other) &&
         ((name_suggests_front(one) && says_back(other)) ||
          (says_back(one) && name_suggests_front(other)));
}
bool says_left(const Words& words) {
  return any_of(words, {"l", "left", "lft", "links", "linke", "linker", "gauche", "izquierda"});
}
bool says_right(const Words& words) {
  return any_of(words,
                {"r", "right", "rgt", "rechts", "rechte", "rechter", "droit", "droite", "derecha"});
}

bool says_anything(const Words& words) {
  return says_sleeve(words) || says_cuff(words) || says_neck(words) || says_legs(words) ||
         says_skirt(words) || name_suggests_front(words) || says_back(words);
}

} // namespace sloper::pattern

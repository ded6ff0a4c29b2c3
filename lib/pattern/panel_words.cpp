#include <pattern/panel_words.hpp>

#include <algorithm>
#include <cctype>

namespace sloper::pattern {

Words words_of(const std::string& name) {
  Words words;
  std::string word;
  char last = 0;
  for (char c : name + "_") {
    const bool letter = std::isalpha(static_cast<unsigned char>(c)) != 0;
    if (!letter || (std::isupper(static_cast<unsigned char>(c)) && std::islower(static_cast<unsigned char>(last)))) {
      if (!word.empty()) words.insert(word);
      word.clear();
    }
    if (letter) word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    last = c;
  }
  return words;
}

bool any_of(const Words& words, std::initializer_list<const char*> wanted) {
  return std::any_of(wanted.begin(), wanted.end(), [&](const char* w) { return words.count(w) != 0; });
}

bool any_begins(const Words& words, std::initializer_list<const char*> starts) {
  for (const std::string& w : words)
    for (const char* start : starts)
      if (w.rfind(start, 0) == 0) return true;
  return false;
}

bool says_sleeve(const Words& words) {
  return any_begins(words, {"sleeve", "slv", "manche", "manga", "manica", "rukav", "rekaw", "mouw", "aermel", "rmel"}) || any_of(words, {"sl"});
}
bool says_cuff(const Words& words) { return any_begins(words, {"cuff", "mansch"}); }
bool says_neck(const Words& words) {
  return any_begins(words, {"collar", "stand", "neck", "hood", "turtle", "lapel", "kragen", "kapuze", "cuello", "capuch", "colletto"}) ||
         any_of(words, {"col"});
}
bool says_legs(const Words& words) { return any_begins(words, {"leg", "pant", "trouser", "short", "jean", "hose", "pantal"}); }
bool says_skirt(const Words& words) { return any_begins(words, {"skirt", "gore", "waist", "rock", "jupe", "falda", "gonna"}) || any_of(words, {"wb"}); }
bool says_front(const Words& words) {
  return any_begins(words, {"front", "frt", "ftorso", "fbodice", "vorder", "devant", "delanter", "davanti"}) || any_of(words, {"f", "cf", "fr"});
}
bool says_back(const Words& words) {
  return any_begins(words, {"back", "bck", "rear", "bk", "btorso", "bbodice", "rueck", "hinter", "espalda", "traser", "dietro", "yoke"}) ||
         any_of(words, {"b", "cb", "dos"});
}
bool says_left(const Words& words) { return any_of(words, {"l", "left", "lft", "links", "linke", "linker", "gauche", "izquierda"}); }
bool says_right(const Words& words) { return any_of(words, {"r", "right", "rgt", "rechts", "rechte", "rechter", "droit", "droite", "derecha"}); }

} // namespace sloper::pattern

#pragma once
/// What the name of a piece says about it.
#include <sloper/pattern/pattern.hpp>

#include <initializer_list>
#include <set>
#include <string>

namespace sloper::pattern {

using Words = std::set<std::string>;

/// Lower-case words of a name: "skirtFront_L2" is skirt, front, l. Of a Chinese, Japanese or Korean
/// one the English words that its parts stand for.
Words words_of(const std::string& name);
/// What a panel is called: its name, and of a DXF what its maker calls the kind of piece ("SLEEVE
/// SHORT"), of CLO where it is arranged, where the name is a code. A side that the name tells
/// counts more than that of the kind.
Words words_of(const Pattern& pattern, std::size_t panel);
bool any_of(const Words& words, std::initializer_list<const char*> wanted);
/// Whether some word begins with one of these.
bool any_begins(const Words& words, std::initializer_list<const char*> starts);
/// Whether some longer word ends with one of these: codes of pieces are written as one word with
/// the style's, REGTEEBK.
bool any_ends(const Words& words, std::initializer_list<const char*> ends);

/// What pieces are called in the languages that patterns come in; in ASCII, as many files have
/// them.
bool says_sleeve(const Words& words);
bool says_cuff(const Words& words);
bool says_neck(const Words& words); ///< collar, stand, hood
bool says_legs(const Words& words); ///< trousers, their parts and bands
bool says_skirt(const Words& words);
bool name_suggests_front(const Words& words);
bool says_back(const Words& words);
/// Whether they are the front and the back piece of a sleeve.
bool say_sleeve_halves(const Words& one, const Words& other);
bool says_left(const Words& words);
bool says_right(const Words& words);
bool says_anything(const Words& words); ///< of where a piece goes, other than left or right

} // namespace sloper::pattern

#include <pattern/panel_words.hpp>
#include <pattern/read/piece_notes.hpp>
#include <pattern/read/ring_repair.hpp>

#include <algorithm>
#include <cctype>
#include <optional>
#include <sstream>

namespace sloper::pattern {
namespace {

char lower(char c) {
  return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

std::string without_blanks(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t");
  return first == std::string::npos ? std::string() : text.substr(first, last - first + 1);
}

struct Quantity {
  int copies = 1, mirrored = 0;
};

/// "2", "1,1", "0,0": as drawn, then mirrored. Of a pair that is counted together one is mirrored.
std::optional<Quantity> quantity_of(const std::string& text) {
  std::istringstream in(text);
  int first = 0, second = 0;
  char comma = 0;
  if (!(in >> first) || first < 0 || first > 100)
    return std::nullopt;
  if (in >> comma && comma == ',' && in >> second && second >= 0 && second <= 100)
    return Quantity{first + second, second};
  return Quantity{first, first / 2};
}

/// "2XFABRIC", "2X FABRIC", "1XFABRIC 1X INTERLIN": how often of the first cloth that is named.
std::optional<Quantity> annotation_quantity(const std::string& text) {
  std::istringstream in(text);
  int times = 0;
  char x = 0;
  if (!(in >> times >> x) || lower(x) != 'x' || times < 1 || times > 100)
    return std::nullopt;
  return Quantity{times, times / 2};
}

Quantity read_quantity(const DxfBlock& block) {
  const auto stated = quantity_of(find_value(block.texts, "Quantity"));
  if (stated && stated->copies > 0)
    return *stated;
  const auto noted = annotation_quantity(find_value(block.texts, "Annotation"));
  if (stated)
    return {0, noted ? noted->mirrored : 0};
  if (noted)
    return *noted;
  for (const DxfText& t : block.texts) // "Fabric, Cut 2"
    if (const std::size_t cut = t.text.find("Cut "); cut != std::string::npos)
      if (const auto said = quantity_of(t.text.substr(cut + 4)))
        return *said;
  return {};
}

std::string inside_of(const Words& words) {
  if (any_begins(words, {"interlin", "interfac", "fusing", "fusible", "einlage", "vlies", "entoil",
                         "entretela"}))
    return "interlining";
  if (any_begins(words, {"lining", "futter", "doublure", "forro", "fodera", "podszew", "voering"}))
    return "lining";
  if (any_begins(words, {"facing", "besatz", "beleg", "parementure", "vista"}))
    return "facing";
  return {};
}

} // namespace

std::string value_of(const std::string& text, const std::string& key) {
  if (text.size() <= key.size())
    return {};
  for (std::size_t k = 0; k < key.size(); ++k)
    if (lower(text[k]) != lower(key[k]))
      return {};
  std::size_t at = key.size();
  while (at < text.size() && text[at] == ' ')
    ++at;
  if (at == text.size() || text[at] != ':')
    return {};
  ++at;
  while (at < text.size() && text[at] == ' ')
    ++at;
  return text.substr(at);
}

std::string find_value(const std::vector<DxfText>& texts, const std::string& key) {
  for (const DxfText& t : texts)
    if (const std::string v = value_of(t.text, key); !v.empty())
      return v;
  return {};
}

std::string reason_to_leave(const DxfBlock& block, const PieceNotes& notes,
                            const std::vector<Vec2>& ring, bool any_wanted) {
  constexpr double WIDEST_CLOTH = 1.5; // m: a rectangle without a grain line that is larger both
                                       // ways is the frame of the drawing
  if (!notes.inside.empty())
    return "is " + notes.inside;
  if (notes.copies == 0 && any_wanted)
    return "has the quantity 0, as an alternative";
  const Vec2 size = size_of(ring);
  const bool grain = std::any_of(block.lines.begin(), block.lines.end(),
                                 [](const DxfLine& line) { return line.layer == 7; });
  if (!grain && is_box(ring) && size.minCoeff() > WIDEST_CLOTH)
    return "is a frame of " + centimetres(size.x()) + " by " + centimetres(size.y());
  return {};
}

PieceNotes piece_notes(const DxfBlock& block) {
  PieceNotes notes;
  notes.category = without_blanks(find_value(block.texts, "Category"));
  notes.material = without_blanks(find_value(block.texts, "Material"));
  if (notes.material.empty())
    notes.material = without_blanks(find_value(block.texts, "Fabric"));
  const Quantity quantity = read_quantity(block);
  notes.copies = quantity.copies;
  notes.mirrored = quantity.mirrored;
  // Of what it is cut stands in an annotation too: "1XINTERLINING", but not "1XFABRIC 1X INTERLIN".
  std::string cut_of = find_value(block.texts, "Annotation");
  if (const std::size_t x = cut_of.find_first_of("xX"); annotation_quantity(cut_of))
    cut_of = cut_of.substr(x + 1);
  cut_of = cut_of.substr(
      0, cut_of.find_first_of(" ,;", cut_of.find_first_not_of(' ') == std::string::npos
                                         ? 0
                                         : cut_of.find_first_not_of(' ')));
  for (const std::string& text :
       {notes.category, notes.material, find_value(block.texts, "Piece Name"), cut_of})
    if (notes.inside.empty())
      notes.inside = inside_of(words_of(text));
  return notes;
}

} // namespace sloper::pattern

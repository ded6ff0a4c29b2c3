#pragma once
/// Sewing as layer-15 texts of a DXF say it: `SEW <seam> <a|b> <order> <+|-> <run>` near the middle
/// of a panel edge names the edge and its place in a seam; then, once for each seam or at every
/// run, what its sides do not show: a kind (`seam`, `dart`, `gather`, `closure`), `open`, and last
/// `ease <why>`. `RUN <run>` names an edge that is not sewn. Further words are of later versions.
#include <sloper/pattern/pattern.hpp>

#include <array>
#include <map>

namespace sloper::pattern {

/// The texts of one file that state seams.
class DxfSewing {
public:
  struct Text {
    int panel, edge, order;
    bool with_outline;
  };
  /// One text of layer 15 beside edge `edge` of a panel that will have the number `index`; others
  /// than SEW and RUN are none of ours.
  /// @throws Error INPUT for a SEW text with another side or direction
  void read(const std::string& text, Panel& panel, int index, int edge, const std::string& file);
  /// Those of one panel, so that they can go with its edges.
  std::vector<Text*> texts_of(int panel);
  /// Adds the seams, in the order in which they were first named. @throws Error INPUT for a seam
  /// with one side
  void make_seams(Pattern& pattern, const std::string& file) const;

private:
  struct Said {
    std::array<std::vector<Text>, 2> sides;
    std::string kind, ease; ///< empty: not said
    bool open = false;
  };
  std::map<std::string, Said> m_seams;
  std::vector<std::string> m_order;
};

} // namespace sloper::pattern

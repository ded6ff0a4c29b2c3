#include <pattern/read/choose_pieces.hpp>
#include <sloper/base/error.hpp>

#include <algorithm>
#include <cctype>

namespace sloper::pattern {
namespace {

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// For each panel whether one of the names means it.
std::vector<bool> named(const Pattern& pattern, const std::vector<std::string>& names,
                        const std::string& file) {
  std::vector<bool> out(pattern.panels.size(), false);
  for (const std::string& name : names) {
    bool found = false;
    for (std::size_t k = 0; k < out.size(); ++k)
      if (is_named(pattern.panels[k], name))
        out[k] = found = true;
    if (found)
      continue;
    std::string list;
    for (const Panel& panel : pattern.panels)
      list += (list.empty() ? "" : ", ") + panel.name;
    throw input_error("dxf.no-piece"_id, file, name, "no piece has this name",
                      "its pieces are " + list);
  }
  return out;
}

} // namespace

bool is_named(const Panel& panel, const std::string& name) {
  const std::string own = lower_case(panel.name), wanted = lower_case(name);
  return own == wanted || own == wanted + MIRRORED;
}

void remove_panels(Pattern& pattern, const std::vector<bool>& remove) {
  std::vector<int> index(remove.size(), -1);
  std::vector<Panel> panels;
  for (std::size_t k = 0; k < remove.size(); ++k) {
    if (remove[k])
      continue;
    index[k] = static_cast<int>(panels.size());
    panels.push_back(std::move(pattern.panels[k]));
  }
  pattern.panels = std::move(panels);
  std::vector<Seam> seams;
  for (Seam& seam : pattern.seams) {
    bool whole = true;
    for (auto* side : {&seam.a, &seam.b})
      for (Run& run : *side) {
        run.panel = index[run.panel];
        whole = whole && run.panel >= 0;
      }
    if (whole)
      seams.push_back(std::move(seam));
    else
      pattern.findings.push_back({"pattern.seam-left-out"_id,
                                  "seam " + seam.name + " is left out with a piece that it joins"});
  }
  pattern.seams = std::move(seams);
}

void choose_pieces(Pattern& pattern, const std::vector<std::string>& pieces,
                   const std::vector<std::string>& without, const std::string& file) {
  std::vector<bool> remove = named(pattern, without, file);
  if (!pieces.empty()) {
    const std::vector<bool> keep = named(pattern, pieces, file);
    for (std::size_t k = 0; k < remove.size(); ++k)
      remove[k] = remove[k] || !keep[k];
  }
  if (std::find(remove.begin(), remove.end(), true) != remove.end())
    remove_panels(pattern, remove);
}

} // namespace sloper::pattern

#include <pattern/read/dxf_sewing.hpp>
#include <sloper/base/error.hpp>

#include <algorithm>
#include <sstream>

namespace sloper::pattern {

constexpr double MOST_UNEVEN = 1.08; // sides that differ by more are gathered

void DxfSewing::read(const std::string& text, Panel& panel, int index, int edge,
                     const std::string& file) {
  std::istringstream words(text);
  std::string what, seam, side, direction, run;
  int order = 0;
  words >> what;
  if (what == "RUN" && words >> run)
    panel.edge(edge).name = run;
  if (what != "SEW" || !(words >> seam >> side >> order >> direction >> run))
    return;
  panel.edge(edge).name = run;
  if ((side != "a" && side != "b") || (direction != "+" && direction != "-"))
    throw input_error("dxf.sewing-text"_id, file, panel.name, "'" + text + "' is not a sewing text",
                      "write SEW <seam> <a|b> <order> <+|-> <run>");
  if (std::find(m_order.begin(), m_order.end(), seam) == m_order.end())
    m_order.push_back(seam);
  Said& said = m_seams[seam];
  said.sides[side == "b"].push_back({index, edge, order, direction == "+"});
  for (std::string word; words >> word;)
    if (word == "seam" || word == "dart" || word == "gather" || word == "closure")
      said.kind = word;
    else if (word == "open")
      said.open = true;
    else if (word == "ease")
      std::getline(words >> std::ws, said.ease);
}

std::vector<DxfSewing::Text*> DxfSewing::texts_of(int panel) {
  std::vector<Text*> out;
  for (auto& [name, said] : m_seams)
    for (auto& side : said.sides)
      for (Text& t : side)
        if (t.panel == panel)
          out.push_back(&t);
  return out;
}

void DxfSewing::make_seams(Pattern& pattern, const std::string& file) const {
  for (const std::string& name : m_order) {
    const Said& said = m_seams.at(name);
    Seam seam;
    seam.name = name;
    for (std::size_t s = 0; s < 2; ++s) {
      std::vector<Text> side = said.sides[s];
      std::stable_sort(side.begin(), side.end(),
                       [](const Text& a, const Text& b) { return a.order < b.order; });
      for (const Text& t : side)
        (s == 0 ? seam.a : seam.b)
            .push_back({t.panel, t.edge, t.with_outline ? 0.0 : 1.0, t.with_outline ? 1.0 : 0.0});
    }
    if (seam.a.empty() || seam.b.empty())
      throw input_error("dxf.sewing-text"_id, file, "seam " + name,
                        std::string("side ") + (seam.a.empty() ? "a" : "b") + " has no run",
                        "add its SEW text");
    if (seam.a.size() == 1 && seam.b.size() == 1 && seam.a[0].panel == seam.b[0].panel &&
        name.find("dart") != std::string::npos)
      seam.kind = "dart";
    const double ratio = side_length(pattern, seam.a) / side_length(pattern, seam.b);
    if (ratio > MOST_UNEVEN || ratio < 1 / MOST_UNEVEN)
      seam.kind = "gather";
    if (name.find("clos") != std::string::npos)
      seam.kind = "closure";
    if (!said.kind.empty())
      seam.kind = said.kind;
    seam.open = said.open;
    seam.ease = said.ease;
    pattern.seams.push_back(std::move(seam));
  }
}

} // namespace sloper::pattern

#include "renaming.hpp"

#include <algorithm>
#include <cmath>

namespace sloper::pattern::fit {
namespace {

class Renaming {
public:
  Renaming(const Pattern& pattern, const std::vector<SeamSide>& sides) : m_sides(sides) {
    for (int p = 0; p < std::ssize(pattern.panels); ++p) {
      auto& outline = m_outlines.emplace_back();
      for (int e = 0; e < static_cast<int>(pattern.panels[at(p)].loops[0].size()); ++e)
        outline.push_back(measure_side(pattern, p, e, 1));
      m_side_of.emplace_back(outline.size(), -1);
    }
    for (std::size_t k = 0; k < sides.size(); ++k)
      if (sides[k].loop_begin == 0)
        m_side_of[at(sides[k].panel)][at(sides[k].first)] = static_cast<int>(k);
  }

  std::set<SidePair> right_ones(const std::set<SidePair>& guess, const std::set<SidePair>& truth) {
    std::map<int, int> guessed, sewn;
    for (const SidePair& x : guess) {
      guessed[x[0]] = x[1];
      guessed[x[1]] = x[0];
    }
    for (const SidePair& x : truth) {
      sewn[x[0]] = x[1];
      sewn[x[1]] = x[0];
    }
    const int n = std::ssize(m_outlines);
    m_image.assign(m_outlines.size(), {-1, 0});
    m_used.assign(m_outlines.size(), 0);
    for (int p = 0; p < n; ++p) {
      std::size_t like = 0;
      for (int q = 0; q < n; ++q)
        like += shifts(p, q).size();
      if (like <= 1)
        put(p, p, 0);
    }
    for (int p = 0; p < n; ++p) {
      follow(guessed, sewn);
      if (m_image[at(p)].panel >= 0)
        continue;
      if (!m_used[at(p)])
        put(p, p, 0);
      else
        for (int q = 0; q < n && m_image[at(p)].panel < 0; ++q)
          if (const auto s = shifts(p, q); !m_used[at(q)] && !s.empty())
            put(p, q, s[0]);
    }
    std::set<SidePair> renamed, plain;
    for (const SidePair& x : guess) {
      int y[2] = {image(x[0]), image(x[1])};
      if (y[0] > y[1])
        std::swap(y[0], y[1]);
      if (truth.count({y[0], y[1]}))
        renamed.insert(x);
      if (truth.count(x))
        plain.insert(x);
    }
    return renamed.size() >= plain.size() ? renamed : plain;
  }

private:
  static std::size_t at(int k) { return static_cast<std::size_t>(k); }
  struct Image {
    int panel, shift;
  };

  std::vector<int> shifts(int p, int q) const {
    const auto &a = m_outlines[at(p)], &b = m_outlines[at(q)];
    std::vector<int> out;
    for (std::size_t r = 0; r < a.size() && a.size() == b.size(); ++r) {
      bool same = true;
      for (std::size_t e = 0; e < a.size() && same; ++e) {
        const SeamSide &x = a[e], &y = b[(e + r) % a.size()];
        same = std::abs(x.length - y.length) < 0.002 + 0.005 * x.length &&
               std::abs(x.corner_start - y.corner_start) < 0.03 &&
               std::abs(x.bulge - y.bulge) < 0.01;
      }
      if (same)
        out.push_back(static_cast<int>(r));
    }
    return out;
  }
  void put(int p, int q, int shift) {
    m_image[at(p)] = {q, shift};
    m_used[at(q)] = 1;
    m_queue.push_back(p);
  }
  int image(int side) const {
    const SeamSide& s = m_sides[at(side)];
    const Image& m = m_image[at(s.panel)];
    if (s.loop_begin > 0 || m.panel < 0)
      return -1;
    return m_side_of[at(m.panel)][at((s.first + m.shift) % s.loop_size)];
  }
  /// A panel that is sewn to one whose image is known has the image that the truth has there.
  void follow(const std::map<int, int>& guessed, const std::map<int, int>& sewn) {
    while (!m_queue.empty()) {
      const int p = m_queue.front();
      m_queue.erase(m_queue.begin());
      for (int k : m_side_of[at(p)]) {
        if (k < 0)
          continue;
        const auto to = guessed.find(k);
        const auto there = sewn.find(image(k));
        if (to == guessed.end() || there == sewn.end())
          continue;
        const SeamSide &own = m_sides[at(to->second)], &other = m_sides[at(there->second)];
        if (m_image[at(own.panel)].panel >= 0 || m_used[at(other.panel)])
          continue;
        const int n = own.loop_size, shift = ((other.first - own.first) % n + n) % n;
        const std::vector<int> all = shifts(own.panel, other.panel);
        if (std::find(all.begin(), all.end(), shift) != all.end())
          put(own.panel, other.panel, shift);
      }
    }
  }

  const std::vector<SeamSide>& m_sides;
  std::vector<std::vector<SeamSide>> m_outlines;
  std::vector<std::vector<int>> m_side_of;
  std::vector<Image> m_image;
  std::vector<char> m_used;
  std::vector<int> m_queue;
};

} // namespace

std::set<SidePair> right_ones(const Pattern& pattern, const std::vector<SeamSide>& sides,
                              const std::set<SidePair>& guess, const std::set<SidePair>& truth) {
  return Renaming(pattern, sides).right_ones(guess, truth);
}

} // namespace sloper::pattern::fit

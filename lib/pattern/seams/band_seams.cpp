#include <pattern/panel_words.hpp>
#include <pattern/seams/band_seams.hpp>
#include <pattern/seams/rims.hpp>
#include <pattern/seams/seam_sides.hpp>
#include <sloper/base/units.hpp>
#include <sloper/geometry/disjoint_sets.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace sloper::pattern {
namespace {

constexpr double BAND_CORNER = 25;    // degrees
constexpr double SAME_END = 0.03;     // logarithm of lengths
constexpr double LEAST_LEG_HEM = 0.2; // of an inseam's length
constexpr double WAIST_CORNER = 45;   // degrees by which the outline turns from crotch to waist
constexpr double SHORTEST_BAND = 0.6, LONGEST_BAND = 1.15; // of the rim's length
constexpr double SLIM = 3;                                 // length over width of a strip
constexpr double BAND_SCORE = 0.95;

class Bands {
public:
  Bands(const Pattern& pattern, std::vector<SeamGuess> guesses)
      : m_pattern(pattern), m_guesses(std::move(guesses)),
        m_sides(seam_sides(pattern, sharp_corners(pattern, units::radians(BAND_CORNER)), 0)) {
    for (std::size_t p = 0; p < pattern.panels.size(); ++p)
      m_words.push_back(words_of(pattern, p));
  }

  std::vector<SeamGuess> legs() {
    const auto mirrors = panel_mirrors(m_pattern);
    for (int p = 0; p < count(); ++p)
      for (const PanelMirror& m : mirrors[p])
        if (m.panel > p && may_be_leg(p) && may_be_leg(m.panel)) {
          const auto a = leg_of(p, m.panel), b = leg_of(m.panel, p);
          if (a && b)
            join_legs(*a, *b);
        }
    return std::move(m_guesses);
  }

  /// Mirror images that nothing joins: along the longest straight side that both leave free, in the
  /// middle of front and back.
  void join_halves() {
    constexpr double SHORTEST = 0.15, STRAIGHT = 0.99; // m; chord over length
    DisjointSets joined(m_pattern.panels.size());
    std::set<std::pair<int, int>> taken;
    for (const SeamGuess& g : m_guesses)
      for (const auto* side : {&g.seam.a, &g.seam.b})
        for (const Run& r : *side) {
          joined.unite(g.seam.a[0].panel, r.panel);
          taken.insert({r.panel, r.edge});
        }
    const auto mirrors = panel_mirrors(m_pattern);
    for (int p = 0; p < count(); ++p)
      for (const PanelMirror& m : mirrors[p]) {
        if (m.panel <= p || joined.find(p) == joined.find(m.panel))
          continue;
        if (says_sleeve(words(p)) && says_sleeve(words(m.panel)))
          continue; // of two arms
        const SeamSide* longest = nullptr;
        for (const SeamSide& s : m_sides) {
          const Edges edges = s.panel == p ? edges_of(s) : Edges();
          if (edges.empty() || s.loop_begin > 0 || s.length < SHORTEST ||
              s.chord.norm() < STRAIGHT * s.length || std::abs(s.chord.y()) < STRAIGHT * s.length ||
              std::any_of(edges.begin(), edges.end(), [&](const RimEdge& e) {
                return taken.count({p, e.edge}) ||
                       taken.count({m.panel, m.image(e.edge, s.loop_size)});
              }))
            continue;
          if (!longest || s.length > longest->length)
            longest = &s;
        }
        if (!longest)
          continue;
        Edges image;
        for (const RimEdge& e : edges_of(*longest))
          image.insert(image.begin(), {m.panel, m.image(e.edge, longest->loop_size), e.length, -1});
        Seam seam;
        seam.name = panel(p).name + "-" + panel(m.panel).name + " middle";
        seam.a = whole(edges_of(*longest), true);
        seam.b = whole(image, false);
        add(std::move(seam), false);
        m_guesses.back().score = 0.7;
      }
  }

  std::vector<SeamGuess> strips() {
    add_strip([](const Words& w) { return says_neck(w); }, true);
    add_strip(
        [](const Words& w) {
          return says_skirt(w) && !any_begins(w, {"skirt", "gore"});
        },
        false);
    add_cuffs();
    join_halves();
    return std::move(m_guesses);
  }

private:
  int count() const { return static_cast<int>(m_pattern.panels.size()); }
  const Panel& panel(int p) const { return m_pattern.panels[p]; }
  const Words& words(int p) const { return m_words[p]; }
  Edges edges_of(const SeamSide& s) const {
    return edges_between(m_pattern, s.panel, s.first, next_edge(panel(s.panel), s.last()));
  }
  bool sewn_for_certain(int p) const {
    return std::any_of(m_guesses.begin(), m_guesses.end(), [&](const SeamGuess& g) {
      return g.certain && (g.seam.a[0].panel == p) != (g.seam.b[0].panel == p);
    });
  }
  bool may_be_leg(int p) const {
    return says_legs(words(p)) || !(says_sleeve(words(p)) || says_neck(words(p)) ||
                                    name_suggests_front(words(p)) || says_back(words(p)));
  }
  void add(Seam seam, bool sure) {
    m_guesses.push_back(rim_guess(std::move(seam), sure, BAND_SCORE));
  }

  /// A leg in one piece: its inseams, and the crotch curves behind and before them.
  struct Leg {
    int panel = 0;
    Edges inseam, other; ///< along the outline; the hem lies between them
    Edges after, before; ///< crotch curves: behind `other`, and before `inseam`
  };
  /// By how much the outline turns to the left at the start of an edge, degrees.
  double turn_before(int p, const RimEdge& last, const RimEdge& next) const {
    const ArcLength in(panel(p).edge(last.edge).path), out(panel(p).edge(next.edge).path);
    const Vec2 u = in.tangent(in.length()), v = out.tangent(0);
    return units::degrees(std::atan2(u.x() * v.y() - u.y() * v.x(), u.dot(v)));
  }
  /// Of the outline without hem and inseams: up to the first corner to the waist.
  Edges crotch_of(int p, const Edges& rest) const {
    constexpr double NOTCH = 0.03; // m: the corner may be cut off
    for (std::size_t k = 0; k + 1 < rest.size(); ++k) {
      double turn = turn_before(p, rest[k], rest[k + 1]);
      if (k + 2 < rest.size() && rest[k + 1].length < NOTCH)
        turn = std::max(turn, turn + turn_before(p, rest[k + 1], rest[k + 2]));
      if (turn > WAIST_CORNER)
        return Edges(rest.begin(), rest.begin() + static_cast<long>(k) + 1);
    }
    return {};
  }
  std::optional<Leg> leg_of(int p, int mirror) const {
    for (const SeamGuess& g : m_guesses) // of a leg and its image edges alone would sew waists shut
      if (g.certain && touches(g.seam, {p}) && !touches(g.seam, {mirror}) &&
          (g.seam.a[0].panel != p || g.seam.b[0].panel != p))
        return std::nullopt;
    std::optional<Leg> leg;
    double longest = 0;
    for (const SeamSide& a : m_sides)
      for (const SeamSide& b : m_sides) {
        if (a.panel != p || b.panel != p || &a == &b || a.length < longest ||
            std::abs(std::log(a.length / b.length)) > SAME_END)
          continue;
        const Edges hem = edges_between(m_pattern, p, next_edge(panel(p), a.last()), b.first),
                    rest = edges_between(m_pattern, p, next_edge(panel(p), b.last()), a.first);
        if (length_of(hem) < LEAST_LEG_HEM * a.length || length_of(rest) < length_of(hem))
          continue;
        const Edges after = crotch_of(p, rest);
        Edges before;
        for (std::size_t k = rest.size(); k-- > 1;) {
          double turn = turn_before(p, rest[k - 1], rest[k]);
          before.insert(before.begin(), rest[k]);
          if (turn > WAIST_CORNER)
            break;
        }
        const double both = length_of(after) + length_of(before);
        if (after.empty() || before.empty() || both > 0.8 * length_of(rest))
          continue;
        longest = a.length;
        leg = Leg{p, edges_of(a), edges_of(b), after, before};
      }
    return leg;
  }
  void join_legs(const Leg& a, const Leg& b) {
    if (std::abs(std::log(length_of(a.after) / length_of(b.before))) > SAME_END ||
        std::abs(std::log(length_of(a.before) / length_of(b.after))) > SAME_END)
      return;
    for (SeamGuess& g : m_guesses)
      g.certain = g.certain && !touches(g.seam, {a.panel, b.panel});
    drop_unsure(m_guesses, [&](const Seam& s) { return touches(s, {a.panel, b.panel}); });
    const bool named = says_legs(words(a.panel)) && says_legs(words(b.panel));
    const int first = std::ssize(m_guesses);
    for (const Leg* leg : {&a, &b}) {
      Seam seam;
      seam.name = panel(leg->panel).name + " inseam";
      seam.a = whole(leg->inseam, true);
      seam.b = whole(leg->other, false);
      add(std::move(seam), named);
    }
    const auto join = [&](const char* name, const Edges& x, const Edges& y) {
      Seam seam;
      seam.name = panel(a.panel).name + name;
      seam.a = whole(x, true);
      seam.b = whole(y, false);
      add(std::move(seam), named);
    };
    join(" crotch 1", a.after, b.before);
    join(" crotch 2", a.before, b.after);
    together(first);
  }
  /// One answer tells all guesses from that one on.
  void together(int first) {
    for (int k = first + 1; k < std::ssize(m_guesses); ++k)
      m_guesses[first].with.push_back(k);
  }

  /// The long side of a strip, and its ends.
  struct Strip {
    const SeamSide *long_side = nullptr, *end = nullptr, *start = nullptr;
  };
  /// @param slim  least ratio of its length to its width
  std::optional<Strip> strip_of(int p, double slim = SLIM) const {
    Strip strip;
    double outline = 0;
    for (const SeamSide& s : m_sides) {
      if (s.panel != p)
        continue;
      outline += s.length;
      if (!strip.long_side || s.length > strip.long_side->length + 1e-6)
        strip.long_side = &s;
    }
    if (!strip.long_side || strip.long_side->after < 0 || strip.long_side->before < 0)
      return std::nullopt;
    const double width = 0.5 * (outline - 2 * strip.long_side->length);
    if (!(strip.long_side->length > slim * width))
      return std::nullopt;
    strip.end = &m_sides[strip.long_side->after];
    strip.start = &m_sides[strip.long_side->before];
    return strip;
  }

  bool is_wrist(const Rim& rim) const {
    return std::all_of(rim.edges.begin(), rim.edges.end(),
                       [&](const RimEdge& e) { return says_sleeve(words(e.panel)); });
  }

  /// Cuffs, cut as a pair, on the ends of two sleeves. Those of knit fabrics are cut double, so
  /// they are not slim, and are stretched more than a neck's rib.
  void add_cuffs() {
    constexpr double SLIM_CUFF = 1;       // length over width of a cuff cut double
    constexpr double SHORTEST_CUFF = 0.5; // of the rim's length
    const auto mirrors = panel_mirrors(m_pattern);
    std::vector<int> cuffs;
    for (int p = 0; p < count(); ++p)
      if (says_cuff(words(p)) && !sewn_for_certain(p) && strip_of(p, SLIM_CUFF))
        cuffs.push_back(p);
    const auto is_image = [&](const PanelMirror& m) { return m.panel == cuffs[1]; };
    if (cuffs.size() != 2 ||
        std::none_of(mirrors[cuffs[0]].begin(), mirrors[cuffs[0]].end(), is_image))
      return;
    const std::vector<Seam> seams = likely_seams(m_guesses, {cuffs[0], cuffs[1]});
    std::vector<Edges> ends;
    for (const Rim& r : rims_of(m_pattern, seams)) {
      const double share = strip_of(cuffs[0], SLIM_CUFF)->long_side->length / r.length;
      const Edges around = behind_longest_seam(m_pattern, r, seams);
      if (share > SHORTEST_CUFF && share < LONGEST_BAND && !around.empty() && is_wrist(r))
        ends.push_back(around);
    }
    if (ends.size() != 2 || std::abs(std::log(length_of(ends[0]) / length_of(ends[1]))) > SAME_END)
      return;
    bool sure = true;
    for (const Edges& end : ends)
      sure = sure && is_certain(m_guesses, seams, end);
    for (SeamGuess& g : m_guesses) // that closed a cuff by its other edges
      g.certain = g.certain && !touches(g.seam, {cuffs[0], cuffs[1]});
    drop_unsure(m_guesses, [&](const Seam& seam) {
      return touches(seam, {cuffs[0], cuffs[1]}) || takes_any(seam, ends[0]) ||
             takes_any(seam, ends[1]);
    });
    const int begin = std::ssize(m_guesses);
    for (std::size_t k = 0; k < 2; ++k)
      add_band(cuffs[k], *strip_of(cuffs[k], SLIM_CUFF), ends[k], "-sleeve", sure);
    together(begin);
  }

  template<class Says> void add_strip(Says says, bool neck) {
    std::vector<int> found;
    for (int p = 0; p < count(); ++p)
      if (says(words(p)) && !sewn_for_certain(p) && strip_of(p))
        found.push_back(p);
    if (found.size() != 1)
      return; // which of them is a question of what is made
    const int p = found[0];
    const Strip strip = *strip_of(p);
    const std::vector<Seam> seams = likely_seams(m_guesses, {p});
    std::optional<Rim> rim;
    for (Rim& r : rims_of(m_pattern, seams)) {
      std::set<int> panels;
      for (const RimEdge& e : r.edges)
        panels.insert(e.panel);
      const double share = strip.long_side->length / r.length;
      if (is_wrist(r) || r.has(p) || panels.size() < 2 || share < SHORTEST_BAND ||
          share > LONGEST_BAND)
        continue;
      if (!rim || (r.length < rim->length) == neck)
        rim = std::move(r);
    }
    if (!rim)
      return;
    const Edges around =
        neck ? from_middle_of_back(*rim) : behind_longest_seam(m_pattern, *rim, seams);
    if (around.empty())
      return;
    const bool sure = is_certain(m_guesses, seams, around);
    drop_unsure(m_guesses,
                [&](const Seam& seam) { return touches(seam, {p}) || takes_any(seam, around); });
    const int first = std::ssize(m_guesses);
    add_band(p, strip, around, neck ? "-neck" : "-waist", sure);
    together(first);
  }

  /// Sews a strip on a rim, and its ends to each other.
  void add_band(int p, const Strip& strip, const Edges& around, const char* where, bool sure) {
    Seam seam;
    seam.name = panel(p).name + where;
    seam.kind = "gather";
    seam.ease = "rib";
    seam.a = whole(edges_of(*strip.long_side), true);
    seam.b = turned(stretch(around, 0, length_of(around)));
    add(std::move(seam), sure);
    if (std::abs(std::log(strip.end->length / strip.start->length)) > SAME_END)
      return;
    Seam ends;
    ends.name = panel(p).name + " ends";
    ends.a = whole(edges_of(*strip.end), true);
    ends.b = whole(edges_of(*strip.start), false);
    add(std::move(ends), sure);
  }

  /// The neck from the corner that is nearest to the middle of its shortest part, which is the
  /// back's.
  Edges from_middle_of_back(const Rim& rim) const {
    std::map<int, double> of_panel;
    for (const RimEdge& e : rim.edges)
      of_panel[e.panel] += e.length;
    int back = -1;
    for (const auto& [p, l] : of_panel) {
      const bool says = says_back(words(p));
      if (back < 0 || (says && !says_back(words(back))) ||
          (says == says_back(words(back)) && l < of_panel[back]))
        back = p;
    }
    const std::size_t n = rim.edges.size();
    std::size_t first = n;
    for (std::size_t k = 0; k < n; ++k)
      if (rim.edges[k].panel == back && rim.edges[(k + n - 1) % n].panel != back)
        first = k;
    if (first == n)
      return {};
    double at = 0, best = 1e300;
    std::size_t begin = first;
    for (std::size_t k = first; rim.edges[k % n].panel == back && k < first + n; ++k) {
      if (const double off = std::abs(at - 0.5 * of_panel[back]); off < best) {
        best = off;
        begin = k % n;
      }
      at += rim.edges[k % n].length;
    }
    Edges out(rim.edges.begin() + static_cast<long>(begin), rim.edges.end());
    out.insert(out.end(), rim.edges.begin(), rim.edges.begin() + static_cast<long>(begin));
    return out;
  }

  const Pattern& m_pattern;
  std::vector<SeamGuess> m_guesses;
  std::vector<SeamSide> m_sides;
  std::vector<Words> m_words;
};

} // namespace

std::vector<SeamGuess> with_bands(const Pattern& pattern, std::vector<SeamGuess> guesses) {
  return Bands(pattern, std::move(guesses)).strips();
}

std::vector<SeamGuess> with_legs(const Pattern& pattern, std::vector<SeamGuess> guesses) {
  return Bands(pattern, std::move(guesses)).legs();
}

} // namespace sloper::pattern

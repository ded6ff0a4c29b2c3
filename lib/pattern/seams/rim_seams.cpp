#include <pattern/panel_words.hpp>
#include <pattern/seams/band_seams.hpp>
#include <pattern/seams/rim_seams.hpp>
#include <pattern/seams/rims.hpp>
#include <pattern/seams/ring_bands.hpp>
#include <pattern/seams/seam_sides.hpp>
#include <pattern/seams/sleeve_halves.hpp>
#include <sloper/base/units.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace sloper::pattern {
namespace {

constexpr double RIM_CORNER = 25;        // degrees
constexpr double SAME_SEAM_SIDE = 0.03;  // logarithm of lengths: both sides of a sleeve's own seam
constexpr double LEAST_SLEEVE_HEM = 0.3; // of such a side's length: what lies between them
constexpr double STRAIGHT_HEM = 0.93;    // chord over length of a hem
constexpr double SAME_RIM = 0.02;        // logarithm of lengths: left and right armhole
constexpr double LEAST_EASE = -0.04;     // logarithm of cap over armhole
constexpr double MOST_EASE = 0.16;
constexpr double USUAL_EASE = 0.03;
constexpr double SURE_EASE = 0.1; // beyond that, it is asked
constexpr double NEAR_SHOULDER =
    0.04; // of the cap: a corner of its outline so near to where the shoulder comes is meant
constexpr double RIM_SCORE = 0.95;
// Pieces that are called halves of a sleeve go nowhere else: gathers of 1 to 1.5 are set in too.
constexpr double MOST_EASE_OF_HALVES = 0.4;
constexpr double GATHERED_SCORE = 0.6;
constexpr double WRONG_HALVES = 1; // of the cap: a front half on a back

/// A piece that closes on itself, or the two halves of a sleeve.
struct Sleeve {
  std::set<int> panels;
  Edges cap; ///< along the outline, from the one side of its seam under the arm to the other
  std::vector<Seam> closures; ///< that are to be added
  bool named = false;
  std::optional<double> top; ///< m along the cap: where two halves meet

  int panel() const { return *panels.begin(); }
  double most_ease() const { return top ? MOST_EASE_OF_HALVES : MOST_EASE; }
};

class RimSeams {
public:
  RimSeams(const Pattern& pattern, std::vector<SeamGuess> guesses)
      : m_pattern(pattern), m_guesses(std::move(guesses)), m_mirrors(panel_mirrors(pattern)),
        m_sides(seam_sides(pattern, sharp_corners(pattern, units::radians(RIM_CORNER)), 0)) {
    for (std::size_t p = 0; p < pattern.panels.size(); ++p)
      m_words.push_back(words_of(pattern, p));
  }

  std::vector<SeamGuess> run() {
    set_in_sleeves();
    join_raglans();
    return std::move(m_guesses);
  }

private:
  const Panel& panel(int p) const { return m_pattern.panels[p]; }
  const Words& words(int p) const { return m_words[p]; }

  bool mirrored(int p, int q) const {
    for (const PanelMirror& m : m_mirrors[p])
      if (m.panel == q)
        return true;
    return false;
  }
  bool mirrored(const Sleeve& one, const Sleeve& other) const {
    return one.panels.size() == other.panels.size() &&
           std::all_of(one.panels.begin(), one.panels.end(), [&](int p) {
             return std::any_of(other.panels.begin(), other.panels.end(),
                                [&](int q) { return mirrored(p, q); });
           });
  }
  /// Whether one of some panels is sewn to another one.
  bool sewn_for_certain(const std::set<int>& panels) const {
    return std::any_of(m_guesses.begin(), m_guesses.end(), [&](const SeamGuess& g) {
      return g.certain &&
             (panels.count(g.seam.a[0].panel) > 0) != (panels.count(g.seam.b[0].panel) > 0);
    });
  }

  /// How far edges bulge to the right of their chord, out of the cloth, over its length.
  double bulge(const Edges& edges) const {
    const Vec2 a = panel(edges.front().panel).edge(edges.front().edge).path.front().p[0],
               b = panel(edges.back().panel).edge(edges.back().edge).path.back().p[3],
               chord = b - a;
    if (!(chord.norm() > 1e-6))
      return 0;
    const Vec2 out = Vec2(chord.y(), -chord.x()).normalized();
    double most = 0;
    for (const RimEdge& e : edges)
      for (const Segment& s : panel(e.panel).edge(e.edge).path)
        for (double t : {0.25, 0.5, 0.75, 1.0}) {
          const double off = (s.at(t) - a).dot(out);
          if (std::abs(off) > std::abs(most))
            most = off;
        }
    return most / chord.norm();
  }

  bool is_straight(const Edges& edges) const {
    const Vec2 chord = panel(edges.back().panel).edge(edges.back().edge).path.back().p[3] -
                       panel(edges.front().panel).edge(edges.front().edge).path.front().p[0];
    return chord.norm() > STRAIGHT_HEM * length_of(edges);
  }

  /// Sides of one piece that may be its own seam: as guessed, or two of one length around a third.
  std::optional<Sleeve> sleeve_of(int p) const {
    const bool half = name_suggests_front(words(p)) || says_back(words(p));
    Sleeve sleeve;
    sleeve.panels = {p};
    sleeve.named = says_sleeve(words(p)) && !half;
    if (says_anything(words(p)) && !sleeve.named)
      return std::nullopt;
    const SeamSide *first = nullptr, *second = nullptr;
    double best = SAME_SEAM_SIDE;
    for (const SeamSide& a : m_sides)
      for (const SeamSide& b : m_sides) {
        if (a.panel != p || b.panel != p || a.loop_begin != 0 || b.loop_begin != 0 || &a == &b)
          continue;
        const double unlike = std::abs(std::log(a.length / b.length));
        if (unlike >= best)
          continue;
        const Edges hem = edges_between(m_pattern, p, next_edge(panel(p), a.last()), b.first),
                    cap = edges_between(m_pattern, p, next_edge(panel(p), b.last()), a.first);
        if (hem.empty() || cap.empty() || length_of(hem) < LEAST_SLEEVE_HEM * a.length ||
            length_of(cap) < length_of(hem) || bulge(cap) < 0.1 || !is_straight(hem))
          continue;
        best = unlike;
        first = &a;
        second = &b;
        sleeve.cap = cap;
      }
    if (!first)
      return std::nullopt;
    bool known = false, denied = false;
    for (const SeamGuess& g : m_guesses) {
      if (!g.certain)
        continue;
      const auto takes = [&](const SeamSide& s) {
        const auto has = [&](const std::vector<Run>& side) {
          return std::any_of(side.begin(), side.end(),
                             [&](const Run& r) { return r.panel == p && r.edge == s.first; });
        };
        return has(g.seam.a) || has(g.seam.b);
      };
      known = known || (takes(*first) && takes(*second));
      denied = denied || takes(*first) != takes(*second);
    }
    if (denied)
      return std::nullopt;
    if (!known) {
      Seam seam;
      seam.name = panel(p).name + "." + panel(p).edge(first->first).name + "-" +
                  panel(p).edge(second->first).name;
      seam.a = whole(edges_between(m_pattern, p, first->first, next_edge(panel(p), first->last())),
                     true);
      seam.b = whole(
          edges_between(m_pattern, p, second->first, next_edge(panel(p), second->last())), false);
      sleeve.closures = {seam};
    }
    return sleeve;
  }

  /// Two pieces that are called halves of a sleeve, once they are sewn to each other.
  std::optional<Sleeve> sleeve_of(const SleeveHalves& halves) const {
    const int p = halves.over.a[0].panel, q = halves.over.b[0].panel;
    const std::vector<Seam> seams = {halves.over, halves.under};
    Sleeve sleeve;
    sleeve.panels = {p, q};
    sleeve.named = true;
    for (const Rim& rim : rims_of(m_pattern, seams)) {
      const bool hem = std::any_of(rim.edges.begin(), rim.edges.end(), [&](const RimEdge& e) {
        return e.panel == halves.hem.panel && e.edge == halves.hem.edge;
      });
      if (rim.has(p) && rim.has(q) && !hem)
        sleeve.cap = rim.edges;
    }
    const auto under = std::find_if(sleeve.cap.begin(), sleeve.cap.end(),
                                    [](const RimEdge& e) { return e.seam_after == 1; });
    if (under != sleeve.cap.end())
      std::rotate(sleeve.cap.begin(), under + 1, sleeve.cap.end());
    double at = 0;
    for (const RimEdge& e : sleeve.cap) {
      at += e.length;
      if (e.seam_after == 0)
        sleeve.top = at;
    }
    if (!sleeve.top)
      return std::nullopt;
    for (const Seam& seam : seams) {
      const auto is_it = [&](const SeamGuess& g) {
        return g.certain && touches_all(g.seam, seam.a) && touches_all(g.seam, seam.b);
      };
      if (std::none_of(m_guesses.begin(), m_guesses.end(), is_it))
        sleeve.closures.push_back(seam);
    }
    return sleeve;
  }
  static bool touches_all(const Seam& seam, const std::vector<Run>& side) {
    return std::all_of(side.begin(), side.end(), [&](const Run& run) {
      return takes_any(seam, {{run.panel, run.edge, 0, -1}});
    });
  }

  /// Where front and back meet at the shoulder, m along the rim; the first of its seams.
  static std::optional<double> shoulder_of(const Edges& rim) {
    double at = 0;
    for (std::size_t k = 0; k + 1 < rim.size(); ++k) {
      at += rim[k].length;
      if (rim[k].seam_after >= 0 && rim[k].panel != rim[k + 1].panel)
        return at;
    }
    return std::nullopt;
  }

  /// The corner of the cap nearest to a place, m; the place itself where none is near.
  static double crown(const Edges& cap, double at) {
    const double whole = length_of(cap);
    double best = NEAR_SHOULDER * whole, found = at, sum = 0;
    for (const RimEdge& e : cap) {
      sum += e.length;
      if (sum < whole - 1e-9 && std::abs(sum - at) < best) {
        best = std::abs(sum - at);
        found = sum;
      }
    }
    return found;
  }

  /// How badly a cap goes into an armhole: by the lengths of its halves, and their hollows.
  double mismatch(const Sleeve& sleeve, const Edges& rim, double shoulder) const {
    const Edges& cap = sleeve.cap;
    const double whole = length_of(cap), of_rim = length_of(rim);
    const double split = sleeve.top ? *sleeve.top : crown(cap, 0.5 * whole);
    const double last_part = of_rim - shoulder; // that the cap's first half goes with
    double cost = std::abs(split / whole - last_part / of_rim);
    const bool ends_on_back = says_back(words(rim.back().panel)),
               ends_on_front = name_suggests_front(words(rim.back().panel));
    if (sleeve.top) { // the words of its halves
      const bool fits = ends_on_back ? says_back(words(cap.front().panel))
                                     : name_suggests_front(words(cap.front().panel));
      return ends_on_back == ends_on_front || fits ? cost : cost + WRONG_HALVES;
    }
    if (ends_on_back != ends_on_front) {
      const double first = hollow(cap, 0, split), second = hollow(cap, split, whole);
      cost += 0.05 * (ends_on_front ? second - first : first - second);
    }
    return cost;
  }
  /// How far a stretch of the cap comes in, to the left of its chord, over its length.
  double hollow(const Edges& cap, double from, double to) const {
    std::vector<Vec2> points;
    double at = 0;
    for (const RimEdge& e : cap) {
      const ArcLength arc(panel(e.panel).edge(e.edge).path);
      for (int k = 0; k <= 16; ++k)
        if (const double s = at + e.length * k / 16; s >= from - 1e-9 && s <= to + 1e-9)
          points.push_back(arc.at(e.length * k / 16));
      at += e.length;
    }
    if (points.size() < 3)
      return 0;
    const Vec2 chord = points.back() - points.front();
    double most = 0;
    for (const Vec2& p : points)
      most = std::max(most, (p - points.front()).dot(Vec2(-chord.y(), chord.x())));
    return most / std::max(chord.squaredNorm(), 1e-9);
  }

  void set_in_sleeves() {
    std::vector<Sleeve> sleeves;
    for (int p = 0; p < std::ssize(m_pattern.panels); ++p)
      if (!sewn_for_certain({p}))
        if (auto s = sleeve_of(p))
          sleeves.push_back(*s);
    for (const SleeveHalves& halves : sleeve_halves(m_pattern))
      if (!sewn_for_certain({halves.over.a[0].panel, halves.over.b[0].panel}))
        if (auto s = sleeve_of(halves))
          sleeves.push_back(*s);
    for (std::size_t i = 0; i < sleeves.size(); ++i)
      for (std::size_t k = i + 1; k < sleeves.size(); ++k)
        if (mirrored(sleeves[i], sleeves[k]) && set_in(sleeves[i], sleeves[k]))
          return;
  }

  /// Raglan sleeves close on themselves and are sewn to front and back along the whole of both
  /// sides: one answer tells all of it.
  void join_raglans() {
    constexpr double LIKELY_RIM = 0.5; // probability
    for (int p = 0; p < std::ssize(m_pattern.panels); ++p)
      for (const PanelMirror& m : m_mirrors[p]) {
        if (m.panel <= p || !says_sleeve(words(p)))
          continue;
        std::vector<int> open;
        std::set<int> others;
        bool closes = false;
        for (int k = 0; k < std::ssize(m_guesses); ++k) {
          const SeamGuess& g = m_guesses[k];
          const int a = g.seam.a[0].panel, b = g.seam.b[0].panel;
          if (g.certain || g.score < LIKELY_RIM || !g.with.empty() ||
              !touches(g.seam, {p, m.panel}))
            continue;
          open.push_back(k);
          closes = closes || a == b;
          for (const int other : {a, b})
            if (other != p && other != m.panel)
              others.insert(other);
        }
        if (!closes || others.size() < 2)
          continue;
        SeamGuess& first = m_guesses[open[0]];
        for (const int k : open)
          if (k != open[0] && k != first.twin)
            first.with.push_back(k);
      }
  }

  bool set_in(const Sleeve& one, const Sleeve& other) {
    std::set<int> own = one.panels;
    own.insert(other.panels.begin(), other.panels.end());
    const std::vector<Seam> seams = likely_seams(m_guesses, own);
    const std::vector<Rim> rims = rims_of(m_pattern, seams);
    const double cap = length_of(one.cap);
    double best = 1e300;
    std::array<Edges, 2> holes;
    for (std::size_t i = 0; i < rims.size(); ++i)
      for (std::size_t k = i + 1; k < rims.size(); ++k) {
        const bool of_sleeve = std::any_of(own.begin(), own.end(),
                                           [&](int p) { return rims[i].has(p) || rims[k].has(p); });
        if (of_sleeve || !alike(rims[i], rims[k]))
          continue;
        const double ease = std::log(cap / rims[i].length);
        if (ease < LEAST_EASE || ease > one.most_ease() || std::abs(ease - USUAL_EASE) >= best)
          continue;
        const Edges a = behind_longest_seam(m_pattern, rims[i], seams),
                    b = behind_longest_seam(m_pattern, rims[k], seams);
        if (a.empty() || b.empty() || !shoulder_of(a) || !shoulder_of(b))
          continue;
        best = std::abs(ease - USUAL_EASE);
        holes = {a, b};
      }
    if (holes[0].empty())
      return false;
    const double shoulder[2] = {*shoulder_of(holes[0]), *shoulder_of(holes[1])};
    const double straight =
                     mismatch(one, holes[0], shoulder[0]) + mismatch(other, holes[1], shoulder[1]),
                 crossed =
                     mismatch(one, holes[1], shoulder[1]) + mismatch(other, holes[0], shoulder[0]);
    const bool sure = one.named && other.named && best < SURE_EASE - USUAL_EASE &&
                      is_certain(m_guesses, seams, holes[0]) &&
                      is_certain(m_guesses, seams, holes[1]);
    drop_unsure(m_guesses, [&](const Seam& seam) {
      return touches(seam, own) || takes_any(seam, holes[0]) || takes_any(seam, holes[1]);
    });
    const std::size_t first = straight <= crossed ? 0 : 1;
    const std::size_t begin = m_guesses.size();
    add_sleeve(one, holes[first], shoulder[first], sure);
    add_sleeve(other, holes[1 - first], shoulder[1 - first], sure);
    for (std::size_t k = begin + 1; k < m_guesses.size(); ++k) // one answer tells all
      m_guesses[begin].with.push_back(static_cast<int>(k));
    return true;
  }

  /// Whether they are mirror images, edge by edge.
  bool alike(const Rim& a, const Rim& b) const {
    if (std::abs(std::log(a.length / b.length)) > SAME_RIM)
      return false;
    return std::all_of(a.edges.begin(), a.edges.end(), [&](const RimEdge& e) {
      const int n = static_cast<int>(panel(e.panel).loops[0].size());
      const auto& mirrors = m_mirrors[e.panel];
      return e.edge < n && std::any_of(mirrors.begin(), mirrors.end(), [&](const PanelMirror& m) {
               return std::any_of(b.edges.begin(), b.edges.end(), [&](const RimEdge& f) {
                 return f.panel == m.panel && f.edge == m.image(e.edge, n);
               });
             });
    });
  }

  void add(Seam seam, bool sure, double score) {
    m_guesses.push_back(rim_guess(std::move(seam), sure, score));
  }

  /// The whole cap as one seam around the armhole, parted at the shoulder.
  void add_sleeve(const Sleeve& sleeve, const Edges& rim, double shoulder, bool sure) {
    const double cap = length_of(sleeve.cap), hole = length_of(rim);
    const double split =
        sleeve.top ? *sleeve.top : crown(sleeve.cap, cap * (hole - shoulder) / hole);
    const bool gathered = std::log(cap / hole) > MOST_EASE;
    const double score = gathered ? GATHERED_SCORE : RIM_SCORE;
    for (const Seam& seam : sleeve.closures)
      add(seam, sure, score);
    const auto seam_of = [&](const char* which, double from, double to, double rim_from,
                             double rim_to) {
      Seam seam;
      seam.name =
          panel(sleeve.panel()).name + " cap " + which + "-" + panel(rim.front().panel).name;
      seam.a = stretch(sleeve.cap, from, to);
      seam.b = turned(stretch(rim, rim_from, rim_to));
      if (std::log((to - from) / (rim_to - rim_from)) > MOST_EASE)
        seam.kind = "gather";
      if (sleeve.top)
        seam.name = panel(seam.a[0].panel).name + " cap-" + panel(seam.b[0].panel).name;
      add(std::move(seam), sure, score);
    };
    seam_of("first", 0, split, shoulder, hole);
    seam_of("second", split, cap, 0, shoulder);
  }

  const Pattern& m_pattern;
  std::vector<SeamGuess> m_guesses;
  std::vector<std::vector<PanelMirror>> m_mirrors;
  std::vector<SeamSide> m_sides;
  std::vector<Words> m_words;
};

} // namespace

std::vector<SeamGuess> with_rim_seams(const Pattern& pattern, std::vector<SeamGuess> guesses) {
  guesses = with_legs(pattern, std::move(guesses));
  guesses = with_bands(pattern, RimSeams(pattern, std::move(guesses)).run());
  return with_ring_bands(pattern, std::move(guesses));
}

} // namespace sloper::pattern

#include <pattern/seams/rims.hpp>

#include <algorithm>
#include <map>

namespace sloper::pattern {
namespace {

using EdgeKey = std::pair<int, int>; // panel, edge

/// Where an edge of a sewn side leads that a walk comes to.
struct Crossing {
  int seam = -1;
  bool begins = false; ///< whether the side begins with this edge, along the outline
  EdgeKey beyond;      ///< last edge, along its outline, of the other side
};

std::map<EdgeKey, Crossing> crossings_of(const std::vector<Seam>& seams) {
  std::map<EdgeKey, Crossing> out;
  for (std::size_t s = 0; s < seams.size(); ++s) {
    // A side's edges as its outline has them: a run from 0 to 1 goes with it.
    const auto with_outline = [](std::vector<Run> side) {
      if (!side.empty() && side.front().from > side.front().to)
        std::reverse(side.begin(), side.end());
      return side;
    };
    const std::vector<Run> sides[2] = {with_outline(seams[s].a), with_outline(seams[s].b)};
    for (std::size_t k : {0, 1})
      for (std::size_t r = 0; r < sides[k].size(); ++r) {
        const Run& last = sides[1 - k].back();
        out[{sides[k][r].panel, sides[k][r].edge}] = {
            static_cast<int>(s), r == 0, {last.panel, last.edge}};
      }
  }
  return out;
}

} // namespace

bool Rim::has(int panel) const {
  return std::any_of(edges.begin(), edges.end(),
                     [&](const RimEdge& e) { return e.panel == panel; });
}

int next_edge(const Panel& panel, int edge) {
  int begin = 0;
  for (const auto& loop : panel.loops) {
    const int n = std::ssize(loop);
    if (edge < begin + n)
      return begin + (edge - begin + 1) % n;
    begin += n;
  }
  return 0;
}

std::vector<Rim> rims_of(const Pattern& pattern, const std::vector<Seam>& seams) {
  const std::map<EdgeKey, Crossing> crossings = crossings_of(seams);
  std::map<EdgeKey, bool> met;
  std::vector<Rim> rims;
  for (int p = 0; p < std::ssize(pattern.panels); ++p)
    for (int first = 0; first < pattern.panels[p].n_edges(); ++first) {
      if (crossings.count({p, first}) || met[{p, first}])
        continue;
      Rim rim;
      EdgeKey at{p, first};
      bool closed = true;
      do {
        met[at] = true;
        const Panel& panel = pattern.panels[at.first];
        rim.edges.push_back({at.first, at.second, length(panel.edge(at.second).path), -1});
        rim.length += rim.edges.back().length;
        EdgeKey next{at.first, next_edge(panel, at.second)};
        for (std::size_t hops = 0; crossings.count(next); ++hops) {
          const Crossing& crossing = crossings.at(next);
          closed = closed && crossing.begins && hops <= crossings.size();
          if (!closed)
            break;
          rim.edges.back().seam_after = crossing.seam;
          const auto [other, edge] = crossing.beyond;
          next = {other, next_edge(pattern.panels[other], edge)};
        }
        if (!closed)
          break;
        at = next;
        closed = !met[at] || at == EdgeKey{p, first};
      } while (closed && at != EdgeKey{p, first});
      if (closed)
        rims.push_back(std::move(rim));
    }
  return rims;
}

double length_of(const Edges& edges) {
  double sum = 0;
  for (const RimEdge& e : edges)
    sum += e.length;
  return sum;
}

Edges edges_between(const Pattern& pattern, int p, int first, int end) {
  const Panel& panel = pattern.panels[p];
  Edges out;
  for (int e = first; e != end; e = next_edge(panel, e)) {
    out.push_back({p, e, length(panel.edge(e).path), -1});
    if (out.size() > static_cast<std::size_t>(panel.n_edges()))
      return {};
  }
  return out;
}

Edges behind_longest_seam(const Pattern& pattern, const Rim& rim, const std::vector<Seam>& seams) {
  std::size_t last = rim.edges.size();
  double longest = 0;
  for (std::size_t k = 0; k < rim.edges.size(); ++k) {
    const int s = rim.edges[k].seam_after;
    if (s < 0)
      continue;
    const double l = side_length(pattern, seams[s].a);
    if (l > longest) {
      longest = l;
      last = k;
    }
  }
  if (last == rim.edges.size())
    return {};
  Edges out(rim.edges.begin() + static_cast<long>(last) + 1, rim.edges.end());
  out.insert(out.end(), rim.edges.begin(), rim.edges.begin() + static_cast<long>(last) + 1);
  return out;
}

std::vector<Run> whole(Edges edges, bool with_outline) {
  if (!with_outline)
    std::reverse(edges.begin(), edges.end());
  std::vector<Run> runs;
  for (const RimEdge& e : edges)
    runs.push_back({e.panel, e.edge, with_outline ? 0.0 : 1.0, with_outline ? 1.0 : 0.0});
  return runs;
}

std::vector<Run> stretch(const Edges& edges, double from, double to) {
  constexpr double NOTHING = 1e-6; // m
  std::vector<Run> runs;
  double at = 0;
  for (const RimEdge& e : edges) {
    const double a = std::clamp((from - at) / e.length, 0.0, 1.0),
                 b = std::clamp((to - at) / e.length, 0.0, 1.0);
    const bool to_end = (1 - b) * e.length < NOTHING;
    if ((b - a) * e.length > NOTHING)
      runs.push_back({e.panel, e.edge, a * e.length < NOTHING ? 0 : a, to_end ? 1 : b});
    at += e.length;
  }
  return runs;
}

std::vector<Run> turned(std::vector<Run> runs) {
  std::reverse(runs.begin(), runs.end());
  for (Run& r : runs)
    std::swap(r.from, r.to);
  return runs;
}

SeamGuess rim_guess(Seam seam, bool sure, double score) {
  constexpr double SURE = 0.999; // the probability of what names or lengths leave no doubt about
  SeamGuess guess;
  guess.seam = std::move(seam);
  guess.score = sure ? SURE : score;
  guess.certain = sure;
  return guess;
}

bool touches(const Seam& seam, const std::set<int>& panels) {
  for (const auto* side : {&seam.a, &seam.b})
    for (const Run& r : *side)
      if (panels.count(r.panel))
        return true;
  return false;
}

bool takes_any(const Seam& seam, const Edges& edges) {
  for (const auto* side : {&seam.a, &seam.b})
    for (const Run& r : *side)
      for (const RimEdge& e : edges)
        if (e.panel == r.panel && e.edge == r.edge)
          return true;
  return false;
}

std::vector<Seam> likely_seams(const std::vector<SeamGuess>& guesses,
                               const std::set<int>& without) {
  constexpr double LIKELY = 0.5;
  std::vector<Seam> out;
  for (const SeamGuess& g : guesses)
    if (g.score >= LIKELY && !touches(g.seam, without))
      out.push_back(g.seam);
  return out;
}

bool is_certain(const std::vector<SeamGuess>& guesses, const std::vector<Seam>& seams,
                const Edges& rim) {
  return std::all_of(rim.begin(), rim.end(), [&](const RimEdge& e) {
    if (e.seam_after < 0)
      return true;
    const std::string& name = seams[e.seam_after].name;
    return std::any_of(guesses.begin(), guesses.end(),
                       [&](const SeamGuess& g) { return g.certain && g.seam.name == name; });
  });
}

void drop_unsure(std::vector<SeamGuess>& guesses, const std::function<bool(const Seam&)>& fits) {
  std::vector<int> now(guesses.size(), -1);
  std::vector<SeamGuess> kept;
  for (std::size_t k = 0; k < guesses.size(); ++k) {
    if (!guesses[k].certain && fits(guesses[k].seam))
      continue;
    now[k] = static_cast<int>(kept.size());
    kept.push_back(std::move(guesses[k]));
  }
  for (SeamGuess& g : kept) {
    if (g.twin >= 0)
      g.twin = now[g.twin];
    for (int& other : g.with)
      other = now[other];
    g.with.erase(std::remove(g.with.begin(), g.with.end(), -1), g.with.end());
  }
  guesses = std::move(kept);
}

} // namespace sloper::pattern

#pragma once
/// The free edges of panels that are partly sewn, as closed lines: necks, armholes, hems, the ends
/// of sleeves. Where two pieces of a garment are finished before they are joined, as sleeves and
/// bodice are, their rims are what is joined.
#include <sloper/pattern/seams/seam_guess.hpp>

#include <functional>
#include <set>
#include <vector>

namespace sloper::pattern {

/// One edge of a rim, walked along its panel's outline.
struct RimEdge {
  int panel = 0, edge = 0;
  double length = 0;   ///< m
  int seam_after = -1; ///< index of the seam that is crossed to come to the next edge; -1: none
};

using Edges = std::vector<RimEdge>;
double length_of(const Edges& edges); ///< m

/// A closed line of free edges.
struct Rim {
  Edges edges;       ///< in order, the first after the last
  double length = 0; ///< m
  bool has(int panel) const;
};

/// All rims of panels whose edges are sewn by `seams`, each of which takes whole edges. What a
/// contradictory seam leaves open is left out.
std::vector<Rim> rims_of(const Pattern& pattern, const std::vector<Seam>& seams);

/// The edge that follows another one in its loop.
int next_edge(const Panel& panel, int edge);

/// Edges of one loop from `first` up to, and without, `end`; none where it is not met.
Edges edges_between(const Pattern& pattern, int panel, int first, int end);

/// A rim from behind its longest seam on: of an armhole that of the sides, under the arm; of a
/// trousers' waist that of the back. None where no seam is crossed.
Edges behind_longest_seam(const Pattern& pattern, const Rim& rim, const std::vector<Seam>& seams);

/// Edges as runs of a seam, along their outlines or against them.
std::vector<Run> whole(Edges edges, bool with_outline);
/// The stretch [from, to], m, of edges that are walked in order.
std::vector<Run> stretch(const Edges& edges, double from, double to);
std::vector<Run> turned(std::vector<Run> runs); ///< walked in the opposite direction

/// A guess that rests on rims. @param score  its probability where it is not sure
SeamGuess rim_guess(Seam seam, bool sure, double score);

bool touches(const Seam& seam, const std::set<int>& panels);
bool takes_any(const Seam& seam, const Edges& edges);
/// Guesses as seams that are likely, without those of some panels.
std::vector<Seam> likely_seams(const std::vector<SeamGuess>& guesses, const std::set<int>& without);
/// Whether all seams that a rim crosses are certain.
bool is_certain(const std::vector<SeamGuess>& guesses, const std::vector<Seam>& seams,
                const Edges& rim);
/// Takes out guesses that are not certain and fit, and keeps the twins of the rest.
void drop_unsure(std::vector<SeamGuess>& guesses, const std::function<bool(const Seam&)>& fits);

} // namespace sloper::pattern

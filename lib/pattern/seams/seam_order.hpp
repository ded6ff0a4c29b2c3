#pragma once
/// What the order of seams around panels says: a garment is not twisted.
#include <sloper/pattern/seams/seam_guess.hpp>

namespace sloper::pattern {

/// Two panels that are sewn to each other in three places or more meet the seams in opposite order
/// around their outlines, or the garment would be twisted. Where two of the seams are certain, a
/// guess and its mirror image that twist the two panels change partners, and are certain if they
/// are likely and nothing else could be meant in their place: the shoulders of a front and a back
/// whose sides are known. Nothing is said of what would sew a corner shut, as hems would.
void settle_by_order(const Pattern& pattern, std::vector<SeamGuess>& guesses);

/// A certain seam of two panels goes on where both outlines go straight on, and the next edges are
/// free and as long as each other: CAD files cut sides up at notches and lines. A slit looks alike,
/// so this is guessed only where something else would sew the end of the slit shut, as a hem. Such
/// guesses are added, to be asked, and returned.
std::vector<Seam> continue_seams(const Pattern& pattern, std::vector<SeamGuess>& guesses);

/// Takes out guesses that are not certain and would make a bag of two panels that are no mirror
/// images: next to a certain seam of both, or one that is continued, around a corner of both, as
/// their hems are.
void drop_bags(const Pattern& pattern, std::vector<SeamGuess>& guesses,
               const std::vector<Seam>& continued = {});

/// Whether three seams between the same two panels are met in opposite order by the two.
bool in_order(const Pattern& pattern, const Seam& a, const Seam& b, const Seam& c);

} // namespace sloper::pattern

#pragma once
/// Which size of a garment was draped on the body most like another one.
#include <sloper/body/body.hpp>
#include <sloper/garment/fit/fit_policy.hpp>
#include <sloper/garment/garment.hpp>
#include <sloper/io/json_fwd.hpp>

#include <set>
#include <string>
#include <vector>

namespace sloper::garment {

/// One size, and how unlike the body is that it was draped on.
struct SizeRank {
  std::string file; ///< NAME@SIZE.json
  /// Root mean square of the differences of girths, shares of the body's, between the body that it
  /// was draped on and the other: of the girths and levels compared that both have.
  double distance = 0;
  int girths = 0; ///< how many
  /// By how much its top edge does not close on the other body, a share of the girth there:
  /// put_closing_sizes_first(); 0 where it closes.
  double short_share = 0;
  /// Of the girth there, as much as the fit policy allows the top edge to be too short: more of a
  /// knit than of a woven cloth; 0 before put_closing_sizes_first().
  double bearable_share = 0;
};
/// All sizes in order.
struct SizeRanking {
  std::vector<SizeRank> sizes; ///< the nearest first; by name where they are as near
  /// How likely the first is nearer than the second, given what the girths of the body are
  /// uncertain by (taken as independent and normal); 1 where there is one size. Where the second is
  /// nearer, but too short at the top edge: how likely it is too short.
  double sureness = 1;
  std::vector<std::string> compared; ///< names of the girths that were compared
};

/// The files NAME@*.json beside a garment document NAME@SIZE.json, itself among them.
/// @throws Error INPUT where its name has no size
std::vector<std::string> sizes_beside(const std::string& garment);

/// The girths and levels of a body that a garment goes round there, as Garment::body_girths_m names
/// them: a skirt is chosen by waist and hip, whatever the neck and the arms are.
///
/// The garment is placed by its body-relative coordinates, without a drape; cloth crosses the plane
/// of a girth or it does not. Cost: about 10 ms for 4,000 particles.
/// @param garment  in any size, bound
/// @return none where it cannot be placed on the body
std::set<std::string> girths_covered(const Garment& garment, const body::Body& body);

/// Ranks sizes by how near the bodies are that they were draped on.
/// @param files  garment documents, one at least
/// @param compared  names of the girths to compare, of girths_covered(); all where it is empty or
/// the documents know none of them
/// @throws Error INPUT: a document that is no garment, or does not know its body's girths
SizeRanking rank_sizes(const std::vector<std::string>& files, const body::Body& body,
                       const std::set<std::string>& compared = {});

/// Moves sizes of skirts and trousers that do not close at the waist behind those that do: a band
/// that is shorter than the waist by more than the policy bears there (3 % of a woven cloth) is
/// refused by the fit however near the hip is. Among those that do not close, the one
/// that is the least beyond what is borne comes first. Each size is placed on the body by its
/// coordinates (seat.hpp). Cost: the reading of each garment, and about 20 ms.
/// @param ranking  of rank_sizes(), in and out
/// @param policy  that the fit will be judged by; what the fabric of a size bears is added to it
void put_closing_sizes_first(SizeRanking& ranking, const body::Body& body, const FitPolicy& policy);

/// "of 3 sizes shirt@M.json is nearest (2.1 %), with a probability of 93 %; then ..."
std::string ranking_text(const SizeRanking& ranking);
/// For report.json.
io::Json ranking_json(const SizeRanking& ranking);

} // namespace sloper::garment

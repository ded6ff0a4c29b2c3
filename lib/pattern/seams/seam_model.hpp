#pragma once
/// How much the clues of a pair of sides speak for a seam: boosted decision trees, fitted to
/// specifications whose seams are known (tests/pattern/fit_seam_model.cpp).
#include <pattern/seams/seam_evidence.hpp>
#include <sloper/io/json_fwd.hpp>

namespace sloper::pattern {

/// Sum of small decision trees.
struct SeamTrees {
  struct Node {
    int clue = -1; ///< -1: a leaf
    int at = 0;    ///< up to this class the first branch, which is the next node
    float value = 0;
    std::size_t second = 0; ///< of the second branch
  };
  double constant = 0;
  std::vector<std::vector<Node>> trees;

  /// Log-odds.
  double operator()(const Evidence& evidence) const;
};

/// From a model's document: {"constant", "trees"}.
SeamTrees read_trees(const io::Json& json);

/// The trees of each look.
struct SeamModel {
  std::vector<SeamTrees> looks; ///< one after the other; only the first does without odds of others
  SeamTrees settle;             ///< while pairs are settled one after the other
  SeamTrees judge;              ///< of a pair among all that were settled
  std::vector<double> whole;    ///< weights of the clues of whole assemblies; may be empty
};

/// The model that is shipped.
const SeamModel& seam_model();

} // namespace sloper::pattern

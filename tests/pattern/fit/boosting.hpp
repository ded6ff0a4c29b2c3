#pragma once
/// Gradient-boosted trees of the clues of pairs (Friedman 2001), logistic loss.
#include <pattern/seams/seam_model.hpp>

#include <string>

namespace sloper::pattern::fit {

struct Sample {
  SidePair pair{};
  Evidence evidence{};
  bool sewn = false;
  float weight = 1;
};

struct Boosting {
  int trees = 90, depth = 4;
  double rate = 0.15, ridge = 2, least_weight = 2;
};

/// @param clues  how many of the clues are taken, from the first on
SeamTrees boost(const std::vector<const Sample*>& samples, std::size_t clues, const Boosting& how);

/// The trees as seam_model.json keeps them.
std::string trees_text(const SeamTrees& trees);

} // namespace sloper::pattern::fit

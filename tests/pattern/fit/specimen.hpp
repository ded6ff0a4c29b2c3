#pragma once
/// Specifications whose seams are known, as a CAD file without seams and names would show them.
#include "boosting.hpp"

#include <memory>
#include <set>

namespace sloper::pattern::fit {

struct Garment {
  std::string path;
  bool kept = false;
  Pattern pattern;
  std::vector<SeamSide> sides;
  std::unique_ptr<SeamWitness> witness;
  std::unique_ptr<SeamAssembly> assembly;
  std::set<SidePair> truth;
  SeamWitness::Odds odds;
  std::vector<Sample> samples;
};

/// @param path  of the specification; it is kept from learning where "keep" is part of it
std::unique_ptr<Garment> prepare(const std::string& path, Pattern pattern);

} // namespace sloper::pattern::fit

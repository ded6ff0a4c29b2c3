#pragma once
/// What report.json says of one effect.
#include <string>
#include <vector>

namespace sloper::garment {

/// Part of one effect in a drape, with the reason and its cost.
struct EffectReport {
  std::string name;    ///< as in the registry
  bool active = false; ///< it took part
  std::string why;     ///< on or off
  long calls = 0;      ///< of Effect::add(), over the whole drape
  double wall_s = 0;   ///< s, in those calls
};

/// Whether the effect of that name is active; false for an unknown name.
bool is_active(const std::vector<EffectReport>& effects, const std::string& name);

} // namespace sloper::garment

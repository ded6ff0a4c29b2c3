#pragma once
/// What report.json says of one effect.
#include <string>
#include <vector>

namespace sloper::garment {

struct EffectReport {
  std::string name;
  bool active = false;
  std::string why;   ///< on or off
  long calls = 0;    ///< of Effect::add(), over the whole drape
  double wall_s = 0; ///< s, in those calls
};

bool is_active(const std::vector<EffectReport>& effects, const std::string& name);

} // namespace sloper::garment

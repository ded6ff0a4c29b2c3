#include <body/landmark_finder.hpp>
namespace sloper::body {

void Finder::put(const std::string& name, const Vec3& p, int step, const std::string& rule, double confidence, double spread_m) const {
  if (!p.allFinite()) return;
  body.landmarks[name] = {p, step, rule, confidence, spread_m, {}};
}

} // namespace sloper::body

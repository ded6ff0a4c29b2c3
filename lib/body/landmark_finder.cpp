#include <body/landmark_finder.hpp>
namespace sloper::body {

void Finder::put(const std::string& name, const Vec3& p, int step, const std::string& rule, double confidence, double spread_m) const {
  if (!p.allFinite()) return;
  body.landmarks[name] = {p, step, rule, confidence, spread_m, {}};
}

void Finder::also(const std::string& name, const Vec3& p) const {
  const auto it = body.landmarks.find(name);
  if (it != body.landmarks.end() && p.allFinite() && (p - it->second.p).norm() > 0.001) it->second.alternatives.push_back(p);
}

double Finder::number(const std::string& name) const {
  if (!rules.has(name + ".female")) return rules.number(name);
  return figure.female * rules.number(name + ".female") + (1 - figure.female) * rules.number(name + ".male");
}

} // namespace sloper::body

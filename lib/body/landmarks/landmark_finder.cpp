#include <base/error.hpp>
#include <body/landmarks/landmark_finder.hpp>
namespace sloper::body {

bool Finder::find(const std::string& place, const std::string& suffix, int step,
                  std::initializer_list<Way<Vec3>> ways) const {
  const auto chosen = choose<Vec3>(place, place + suffix, ways);
  if (chosen) put(place + suffix, chosen->value, step, *chosen->rule);
  return chosen && has(place + suffix);
}

void Finder::put(const std::string& name, const Vec3& p, int step, const RuleChoice& rule) const {
  if (!p.allFinite()) return;
  body.landmarks[name] = {p, step, rule.name, rule.confidence, rule.spread_m, {}};
}

void Finder::no_such_rule(const std::string& place, const std::string& rule) {
  throw Error(ErrorKind::INTERNAL, "", "",
              "the tree names \"" + rule + "\" for " + place + ", which is no rule of the program");
}

void Finder::also(const std::string& name, const Vec3& p) const {
  const auto it = body.landmarks.find(name);
  if (it != body.landmarks.end() && p.allFinite() && (p - it->second.p).norm() > 0.001)
    it->second.alternatives.push_back(p);
}

double Finder::number(const std::string& name) const {
  if (!rules.has(name + ".female")) return rules.number(name);
  return figure.female * rules.number(name + ".female") +
         (1 - figure.female) * rules.number(name + ".male");
}

} // namespace sloper::body

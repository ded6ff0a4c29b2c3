#include <body/landmarks/landmark_finder.hpp>
#include <sloper/base/error.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace sloper::body {

namespace {

bool lies_on_skin(const std::string& place) {
  constexpr const char* ON_SKIN[] = {"acromion", "axilla_front", "axilla_back", "olecranon",
                                     "waist_side"};
  return std::any_of(std::begin(ON_SKIN), std::end(ON_SKIN),
                     [&](const char* name) { return place == name; });
}

/// The point of a triangle that is nearest to p (Ericson 2005, 5.1.5).
Vec3 nearest_in(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a;
  const double d1 = ab.dot(p - a), d2 = ac.dot(p - a), d3 = ab.dot(p - b), d4 = ac.dot(p - b),
               d5 = ab.dot(p - c), d6 = ac.dot(p - c);
  if (d1 <= 0 && d2 <= 0)
    return a;
  if (d3 >= 0 && d4 <= d3)
    return b;
  if (d6 >= 0 && d5 <= d6)
    return c;
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0)
    return a + d1 / (d1 - d3) * ab;
  if (vb <= 0 && d2 >= 0 && d6 <= 0)
    return a + d2 / (d2 - d6) * ac;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  const double sum = va + vb + vc;
  return sum > 0 ? Vec3(a + vb / sum * ab + vc / sum * ac) : a;
}

/// The nearest point of the skin; p itself where none is within `reach`, m.
Vec3 nearest_skin(const TriangleMesh& skin, const Vec3& p, double reach) {
  Vec3 best = p;
  double least = 1e300;
  for (const Triangle& t : skin.triangles) {
    if ((skin.positions[t[0]] - p).squaredNorm() > reach * reach)
      continue;
    const Vec3 q = nearest_in(p, skin.positions[t[0]], skin.positions[t[1]], skin.positions[t[2]]);
    if (const double d = (q - p).squaredNorm(); d < least) {
      least = d;
      best = q;
    }
  }
  return best;
}

} // namespace

Vec3 Finder::correction(const std::string& place, const std::string& suffix) const {
  int side = -1; // places without one
  if (suffix == "_l")
    side = 0;
  if (suffix == "_r")
    side = 1;
  Vec3 offset = s * corrections.offset(place, shape, side);
  if (side == 1)
    offset.x() = -offset.x();
  return offset;
}

double Finder::by_population(const std::string& place, double otherwise) const {
  const auto expected = corrections.expected(place, shape, -1);
  return expected ? expected->height * s : otherwise;
}

double Finder::more_likely(const std::string& place, double y) const {
  const auto expected = corrections.extrapolated(place, shape, -1);
  if (!expected)
    return y;
  const double weight = expected->weight(y / s);
  char text[160];
  std::snprintf(text, sizeof text,
                "%s: %.3f m high by its rule, %.3f by the rest of the body, which counts %.2f",
                place.c_str(), y, s * expected->height, weight);
  explain(text);
  return y + weight * (s * expected->height - y);
}

Vec3 Finder::corrected(const std::string& place, const std::string& suffix, const Vec3& p,
                       bool on_skin) const {
  constexpr double REACH =
      0.06; // of stature: corrections are half as large at most, and faces have a size
  const Vec3 offset = correction(place, suffix);
  if (offset.isZero())
    return p;
  return on_skin ? nearest_skin(levels.skin(), p + offset, REACH * s) : Vec3(p + offset);
}

bool Finder::find(const std::string& place, const std::string& suffix, int step,
                  std::initializer_list<LandmarkRule<Vec3>> known) const {
  const auto chosen = choose<Vec3>(place, place + suffix, known);
  if (chosen)
    put(place + suffix, corrected(place, suffix, chosen->value, lies_on_skin(place)), step,
        *chosen->rule);
  return chosen && has(place + suffix);
}

void Finder::put(const std::string& name, const Vec3& p, int step, const RuleChoice& rule) const {
  if (!p.allFinite())
    return;
  body.landmarks[name] = {p, step, rule.name, rule.confidence, rule.spread_m, {}};
}

void Finder::no_such_rule(const std::string& place, const std::string& rule) {
  throw Error(ErrorKind::INTERNAL, "general.internal"_id, "", "",
              "the tree names \"" + rule + "\" for " + place + ", which is no rule of the program");
}

void Finder::also(const std::string& name, const Vec3& p) const {
  const auto it = body.landmarks.find(name);
  if (it != body.landmarks.end() && p.allFinite() && (p - it->second.p).norm() > 0.001)
    it->second.alternatives.push_back(p);
}

double Finder::number(const std::string& name) const {
  if (!rules.has(name + ".female"))
    return rules.number(name);
  return figure.female * rules.number(name + ".female") +
         (1 - figure.female) * rules.number(name + ".male");
}

} // namespace sloper::body

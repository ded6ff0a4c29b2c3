#pragma once
/// Skirts of gores, drawn by the tests: what they have in common is flare in the seams between the
/// panels of one side.
#include <support/straight_patterns.hpp>

#include <cmath>

namespace sloper::pattern::test {

/// Half the width at some way down from the waist, cm.
struct GoreWidth {
  double down, half;
};

/// A gore with its waist at y = 0: edges hem, a (on the right as it is drawn) and b, which may be
/// in several lengths: a1, a2 from the top.
inline std::vector<DrawnEdge> gore(const std::vector<GoreWidth>& widths) {
  static const char* const A[] = {"a1", "a2", "a3"};
  static const char* const B[] = {"b1", "b2", "b3"};
  std::vector<DrawnEdge> edges = {{"hem", widths.back().half, -widths.back().down}};
  for (std::size_t k = widths.size() - 1; k-- > 0;)
    edges.push_back({A[k], widths[k].half, -widths[k].down});
  edges.push_back({"waist", -widths[0].half, 0});
  for (std::size_t k = 1; k < widths.size(); ++k)
    edges.push_back({B[k - 1], -widths[k].half, -widths[k].down});
  return edges;
}

/// In the order in which they stand around the body, from the wearer's right to the left in front
/// and back again behind.
inline std::vector<std::string> gore_names(int n) {
  if (n == 4)
    return {"skirt_front_r", "skirt_front_l", "skirt_back_l", "skirt_back_r"};
  if (n == 6)
    return {"skirt_front", "skirt_front_side_l", "skirt_back_side_l",
            "skirt_back",  "skirt_back_side_r",  "skirt_front_side_r"};
  return {"skirt_front_r", "skirt_front_l", "skirt_front_side_l", "skirt_back_side_l",
          "skirt_back_l",  "skirt_back_r",  "skirt_back_side_r",  "skirt_front_side_r"};
}

inline void add_gores(DrawnPattern& skirt, const std::vector<std::string>& names,
                      const std::vector<GoreWidth>& widths) {
  for (const std::string& name : names)
    skirt.panel(name, gore(widths));
  for (std::size_t k = 0; k < names.size(); ++k)
    for (std::size_t length = 1; length < widths.size(); ++length)
      skirt.seam(names[k], "a" + std::to_string(length), names[(k + 1) % names.size()],
                 "b" + std::to_string(length));
}

inline DrawnPattern gored_skirt(int n, const std::vector<GoreWidth>& widths) {
  DrawnPattern skirt;
  add_gores(skirt, gore_names(n), widths);
  return skirt;
}

/// Gores that are straight from the hip, and between each two a godet; names of godets tell
/// nothing.
inline DrawnPattern skirt_with_godets(int n) {
  const std::vector<std::string> names = gore_names(n);
  const double hip = 108.0 / n / 2;
  DrawnPattern skirt;
  for (const std::string& name : names)
    skirt.panel(name, gore({{0, 86.0 / n / 2}, {18, hip}, {34, hip}, {58, hip}}));
  for (std::size_t k = 0; k < names.size(); ++k) {
    const std::string godet = "piece " + std::to_string(k + 1),
                      &next = names[(k + 1) % names.size()];
    skirt.panel(godet, {{"hem1", 0, -24}, {"hem2", 11, -21.33}, {"a", 0, 0}, {"b", -11, -21.33}});
    for (const char* length : {"1", "2"})
      skirt.seam(names[k], std::string("a") + length, next, std::string("b") + length);
    skirt.seam(names[k], "a3", godet, "b");
    skirt.seam(godet, "a", next, "b3");
  }
  return skirt;
}

/// A circle skirt in four, its seams at 45 degrees to the middles of its panels; radii of its waist
/// and its hem, cm.
inline DrawnPattern circle_in_quarters(double waist, double hem,
                                       const std::vector<std::string>& names = gore_names(4)) {
  static const char* const HEM[] = {"h1", "h2", "h3", "h4", "h5", "h6"};
  static const char* const TOP[] = {"t1", "t2", "t3"};
  const auto point = [](const char* edge, double radius, double degrees) {
    return DrawnEdge{edge, radius * std::sin(degrees * M_PI / 180),
                     -radius * std::cos(degrees * M_PI / 180)};
  };
  std::vector<DrawnEdge> edges;
  for (int k = 1; k <= 6; ++k)
    edges.push_back(point(HEM[k - 1], hem, -45 + 15 * k));
  edges.push_back(point("a1", waist, 45));
  for (int k = 1; k <= 3; ++k)
    edges.push_back(point(TOP[k - 1], waist, 45 - 30 * k));
  edges.push_back(point("b1", hem, -45));
  DrawnPattern skirt;
  for (const std::string& name : names)
    skirt.panel(name, edges);
  for (std::size_t k = 0; k < names.size(); ++k)
    skirt.seam(names[k], "a1", names[(k + 1) % names.size()], "b1");
  return skirt;
}

} // namespace sloper::pattern::test

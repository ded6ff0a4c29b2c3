#include <garment/bind/body_sides.hpp>

#include <cmath>
#include <cstdio>
#include <optional>

namespace sloper::garment {

namespace {

struct Measure {
  double value = 0, spread = 0; // m
};

/// Length of the line through landmarks of one side.
std::optional<Measure> length_along(const body::Body& body, const std::vector<std::string>& names,
                                    const std::string& side) {
  Measure m;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto here = body.landmarks.find(names[i] + side);
    if (here == body.landmarks.end())
      return std::nullopt;
    m.spread = std::hypot(m.spread, here->second.spread_m);
    if (i > 0)
      m.value += (here->second.p - body.landmark(names[i - 1] + side)).norm();
  }
  return m;
}

std::optional<Measure> girth(const body::Body& body, const std::string& name,
                             const std::string& side) {
  const auto found = body.girths.find(name + side);
  if (found == body.girths.end() || !(found->second.value_m > 0))
    return std::nullopt;
  return Measure{found->second.value_m, found->second.spread_m};
}

} // namespace

std::vector<SideDifference> uneven_sides(const body::Body& body) {
  std::vector<SideDifference> uneven;
  const auto compare = [&](const char* limb, const char* what, const char* more,
                           const std::optional<Measure>& left,
                           const std::optional<Measure>& right) {
    if (!left || !right)
      return;
    const double difference = left->value - right->value;
    if (std::abs(difference) <= GRADED_SIDES_M + 2 * std::hypot(left->spread, right->spread))
      return;
    char text[128];
    std::snprintf(text, sizeof text, "the %s %s is %.1f cm %s than the %s one",
                  difference > 0 ? "left" : "right", what, 100 * std::abs(difference), more,
                  difference > 0 ? "right" : "left");
    uneven.push_back({limb, text});
  };
  const auto lengths = [&](const char* limb, const char* what,
                           const std::vector<std::string>& names) {
    compare(limb, what, "longer", length_along(body, names, "_l"), length_along(body, names, "_r"));
  };
  const auto girths = [&](const char* limb, const char* what, const char* name) {
    compare(limb, what, "more around", girth(body, name, "_l"), girth(body, name, "_r"));
  };
  lengths("torso", "shoulder", {"neck_side", "acromion"});
  lengths("arm", "arm", {"shoulder_joint", "elbow", "wrist"});
  lengths("leg", "leg", {"hip_joint", "knee", "ankle"});
  girths("arm", "upper arm", "upper_arm");
  girths("arm", "wrist", "wrist");
  girths("leg", "thigh", "thigh");
  girths("leg", "knee", "knee");
  return uneven;
}

} // namespace sloper::garment

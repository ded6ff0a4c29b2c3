#include <garment/fit/garment_regions.hpp>

#include <algorithm>
#include <map>

namespace sloper::garment {

namespace {

/// Frame on which a particle hangs most.
const std::string& main_frame(const Garment& garment, std::size_t particle) {
  const auto& weights = garment.bind.particles[particle];
  const auto most = std::max_element(
      weights.begin(), weights.end(),
      [](const BindWeight& a, const BindWeight& b) { return a.weight < b.weight; });
  return garment.bind.frames[most->frame];
}

double axilla_height(const body::Body& body) {
  double y = 1e300;
  for (const char* name : {"axilla_l", "axilla_r"})
    if (body.has_landmark(name))
      y = std::min(y, body.landmark(name).y());
  return y;
}

std::string region_of(const Garment& garment, std::size_t particle, double axilla_y) {
  const std::string& frame = main_frame(garment, particle);
  const std::string side = !frame.empty() && frame.back() == 'l' ? "left " : "right ";
  if (frame.find("arm_") != std::string::npos)
    return side + "sleeve";
  if (frame.rfind("leg_", 0) == 0)
    return side + "leg";
  if (frame == "lower_body")
    return "skirt";
  if (frame == "head")
    return "collar"; // or a hood
  return garment.position[particle].y() > axilla_y ? "shoulders" : "trunk";
}

} // namespace

std::vector<std::string> regions_of(const Garment& garment, const body::Body& body) {
  const double axilla_y = axilla_height(body);
  std::vector<std::string> regions;
  for (std::size_t i = 0; i < garment.position.size(); ++i)
    regions.push_back(region_of(garment, i, axilla_y));
  return regions;
}

std::string class_of(const std::vector<std::string>& region) {
  std::map<std::string, double> share;
  for (const std::string& name : region)
    share[name] += 1.0 / static_cast<double>(region.size());
  const double legs = share["left leg"] + share["right leg"];
  // Where a scan's arms lie on its flanks, no arm pits are found, and nothing counts as above them.
  const bool top =
      share["shoulders"] + share["left sleeve"] + share["right sleeve"] + share["collar"] > 0.02;
  if (legs > 0.2 && legs > share["skirt"])
    return top ? "whole" : "trousers";
  if (share["skirt"] > (top ? 0.1 : 0.2))
    return top ? "dress" : "skirt"; // of a short dress much more is bodice and sleeves
  return top || share["trunk"] > 0.9 ? "top" : "skirt";
}

} // namespace sloper::garment

#include <garment/sleeve_ends.hpp>

#include <algorithm>

namespace sloper::garment {

namespace {

constexpr double MAINLY = 0.5;      // of a particle's weights
constexpr double HELD = 0.03;       // m of a sleeve, from its end
constexpr double PAST_WRIST = 0.08; // m: the knuckles
constexpr double STIFFNESS = 1000;  // N/m, of each particle: 0.1 mm under a newton's tenth

} // namespace

std::vector<cloth::Pin> hold_sleeve_ends(const Garment& garment) {
  const Bind& bind = garment.bind;
  std::vector<cloth::Pin> pins;
  for (std::size_t k = 0; k < bind.frames.size(); ++k) {
    if (!bind.frames[k].starts_with("forearm")) continue;
    std::vector<std::pair<int, double>> sleeve; // particle, m from the wrist to the elbow
    double end = 1e300;
    for (std::size_t i = 0; i < bind.particles.size(); ++i)
      for (const BindWeight& w : bind.particles[i])
        if (w.frame == static_cast<int>(k) && w.weight >= MAINLY) {
          sleeve.emplace_back(static_cast<int>(i), w.z * bind.lengths_m[k]);
          end = std::min(end, sleeve.back().second);
        }
    if (end < -PAST_WRIST) continue;
    for (const auto& [particle, height] : sleeve)
      if (height < end + HELD) pins.push_back({particle, garment.position[particle], STIFFNESS, Vec3::Zero()});
  }
  return pins;
}

} // namespace sloper::garment

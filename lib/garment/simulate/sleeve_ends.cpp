#include <garment/simulate/sleeve_ends.hpp>

#include <sloper/geometry/triangle_mesh.hpp>

#include <algorithm>

namespace sloper::garment {

namespace {

constexpr double MAINLY = 0.5;      // of a particle's weights
constexpr double HELD = 0.03;       // m of a sleeve, from its end
constexpr double PAST_WRIST = 0.08; // m: the knuckles
constexpr double STIFFNESS = 1000;  // N/m, of each particle: 0.1 mm under a newton's tenth
constexpr double PUSHED = 0.01;     // m towards the fingers
constexpr double STRETCHED = 0.01;  // of a sleeve's edge

struct Sleeve {
  std::vector<int> forearm; // particles
  std::vector<int> end;     // of these
};

/// Those that end near a wrist.
std::vector<Sleeve> sleeves_of(const Bind& bind) {
  std::vector<Sleeve> sleeves;
  for (std::size_t k = 0; k < bind.frames.size(); ++k) {
    if (!bind.frames[k].starts_with("forearm"))
      continue;
    Sleeve sleeve;
    std::vector<double> height; // m from the wrist to the elbow
    double lowest = 1e300;
    for (std::size_t i = 0; i < bind.particles.size(); ++i)
      for (const BindWeight& w : bind.particles[i])
        if (w.frame == static_cast<int>(k) && w.weight >= MAINLY) {
          sleeve.forearm.push_back(static_cast<int>(i));
          height.push_back(w.z * bind.lengths_m[k]);
          lowest = std::min(lowest, height.back());
        }
    if (sleeve.forearm.empty() || lowest < -PAST_WRIST)
      continue;
    for (std::size_t i = 0; i < height.size(); ++i)
      if (height[i] < lowest + HELD)
        sleeve.end.push_back(sleeve.forearm[i]);
    sleeves.push_back(std::move(sleeve));
  }
  return sleeves;
}

Vec3 mean_of(const std::vector<Vec3>& x, const std::vector<int>& particles) {
  Vec3 sum = Vec3::Zero();
  for (int i : particles)
    sum += x[i];
  return sum / static_cast<double>(particles.size());
}

std::vector<char> flags_of(const std::vector<int>& particles, std::size_t n) {
  std::vector<char> flags(n, 0);
  for (int i : particles)
    flags[i] = 1;
  return flags;
}

} // namespace

std::vector<cloth::Pin> hold_sleeve_ends(const Garment& garment) {
  std::vector<cloth::Pin> pins;
  for (const Sleeve& sleeve : sleeves_of(garment.bind))
    for (int i : sleeve.end)
      pins.push_back({i, garment.position[i], STIFFNESS, Vec3::Zero()});
  return pins;
}

std::vector<int> ends_pushed_on_hands(const Garment& garment, const std::vector<Vec3>& placed,
                                      const std::vector<Vec3>& shape) {
  std::vector<int> pushed;
  for (const Sleeve& sleeve : sleeves_of(garment.bind)) {
    const Vec3 to_hand =
        (mean_of(placed, sleeve.end) - mean_of(placed, sleeve.forearm)).normalized();
    if ((mean_of(garment.position, sleeve.end) - mean_of(placed, sleeve.end)).dot(to_hand) < PUSHED)
      continue;
    const std::vector<char> of_end = flags_of(sleeve.end, placed.size());
    double length = 0, before = 0;
    for (const auto& [a, b] : free_edges_of(garment.particle_triangles()))
      if (of_end[a] && of_end[b]) {
        length += (garment.position[a] - garment.position[b]).norm();
        before += (shape[a] - shape[b]).norm();
      }
    if (length > (1 + STRETCHED) * before)
      pushed.insert(pushed.end(), sleeve.end.begin(), sleeve.end.end());
  }
  return pushed;
}

} // namespace sloper::garment

#include <garment/simulate/sleeve_ends.hpp>

#include <sloper/geometry/triangle_mesh.hpp>

#include <algorithm>

namespace sloper::garment {

namespace {

constexpr double MAINLY = 0.5;       // of a particle's weights
constexpr double HELD = 0.03;        // m of a sleeve, from its end
constexpr double PAST_WRIST = 0.08;  // m: the knuckles
constexpr double STIFFNESS = 1000;   // N/m, of each particle: 0.1 mm under a newton's tenth
constexpr double PUSHED = 0.01;      // m towards the fingers, or the toes
constexpr double UNDER_ANKLE = 0.15; // m: the floor is about 8 cm below
constexpr double ABOVE_ANKLE = 0.1;  // m: a leg that ends higher does not reach the foot
constexpr double ANY_HEIGHT = 1e300;
constexpr double STRETCHED = 0.01; // of a sleeve's edge

/// Heights of an end over the wrist or the ankle, m.
struct EndsBetween {
  double lowest, highest;
};

/// What covers a kind of limb and ends so near its lower joint.
/// @param limb  begins the names of its frames, whose z is 0 at that joint
std::vector<LimbCover> ends_of(const Bind& bind, const std::string& limb, EndsBetween between) {
  std::vector<LimbCover> covers;
  for (std::size_t k = 0; k < bind.frames.size(); ++k) {
    if (!bind.frames[k].starts_with(limb))
      continue;
    LimbCover cover;
    cover.frame = bind.frames[k];
    std::vector<double> height; // m over the joint
    double lowest = 1e300;
    for (std::size_t i = 0; i < bind.particles.size(); ++i)
      for (const BindWeight& w : bind.particles[i])
        if (w.frame == static_cast<int>(k) && w.weight >= MAINLY) {
          cover.limb.push_back(static_cast<int>(i));
          height.push_back(w.z * bind.lengths_m[k]);
          lowest = std::min(lowest, height.back());
        }
    cover.lowest_m = lowest;
    if (cover.limb.empty() || lowest < between.lowest || lowest > between.highest)
      continue;
    for (std::size_t i = 0; i < height.size(); ++i)
      if (height[i] < lowest + HELD)
        cover.end.push_back(cover.limb[i]);
    covers.push_back(std::move(cover));
  }
  return covers;
}

std::vector<LimbCover> sleeves_of(const Bind& bind) {
  return ends_of(bind, "forearm", {-PAST_WRIST, ANY_HEIGHT});
}

Vec3 mean_of(const std::vector<Vec3>& x, const std::vector<int>& particles) {
  Vec3 sum = Vec3::Zero();
  for (int i : particles)
    sum += x[i];
  return sum / static_cast<double>(particles.size());
}

/// m, of the mean of the end, away from the elbow or the hip
double moved_outwards(const LimbCover& cover, const std::vector<Vec3>& position,
                      const std::vector<Vec3>& placed) {
  const Vec3 end = mean_of(placed, cover.end);
  const Vec3 outwards = (end - mean_of(placed, cover.limb)).normalized();
  return (mean_of(position, cover.end) - end).dot(outwards);
}

std::vector<char> flags_of(const std::vector<int>& particles, std::size_t n) {
  std::vector<char> flags(n, 0);
  for (int i : particles)
    flags[i] = 1;
  return flags;
}

} // namespace

std::vector<LimbCover> legs_of(const Bind& bind) {
  return ends_of(bind, "leg", {-UNDER_ANKLE, ABOVE_ANKLE});
}

std::vector<cloth::Pin> hold_ends(const Garment& garment, LimbEnds ends) {
  std::vector<cloth::Pin> pins;
  const auto hold = [&](const std::vector<int>& particles) {
    for (int i : particles)
      pins.push_back({i, garment.position[i], STIFFNESS, Vec3::Zero()});
  };
  if (ends != LimbEnds::NONE)
    for (const LimbCover& cover : sleeves_of(garment.bind))
      hold(cover.end);
  if (ends == LimbEnds::SLEEVES_AND_LEGS)
    for (const LimbCover& leg : legs_of(garment.bind))
      hold(leg.end);
  return pins;
}

std::vector<int> ends_pushed_on_hands(const Garment& garment, const std::vector<Vec3>& placed,
                                      const std::vector<Vec3>& shape) {
  std::vector<int> pushed;
  for (const LimbCover& cover : sleeves_of(garment.bind)) {
    if (moved_outwards(cover, garment.position, placed) < PUSHED)
      continue;
    const std::vector<char> of_end = flags_of(cover.end, placed.size());
    double length = 0, before = 0;
    for (const auto& [a, b] : free_edges_of(garment.particle_triangles()))
      if (of_end[a] && of_end[b]) {
        length += (garment.position[a] - garment.position[b]).norm();
        before += (shape[a] - shape[b]).norm();
      }
    if (length > (1 + STRETCHED) * before)
      pushed.insert(pushed.end(), cover.end.begin(), cover.end.end());
  }
  return pushed;
}

} // namespace sloper::garment

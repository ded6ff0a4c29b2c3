#include <sloper/base/error.hpp>
#include <sloper/base/units.hpp>
#include <sloper/body/body.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::body {

std::string stance_of(double arms_deg) {
  constexpr double T_FROM_DEG = 70, A_FROM_DEG = 15;
  if (arms_deg > T_FROM_DEG)
    return "T";
  return arms_deg > A_FROM_DEG ? "A" : "I";
}

namespace {
constexpr const char* NAMES[N_PARTS] = {"head", "torso", "arm_l", "arm_r", "leg_l", "leg_r"};
}

const char* part_name(Part part) {
  return static_cast<int>(part) < N_PARTS ? NAMES[static_cast<int>(part)] : "none";
}

std::optional<Part> part_from_name(const std::string& name) {
  for (int k = 0; k < N_PARTS; ++k)
    if (name == NAMES[k])
      return static_cast<Part>(k);
  if (name == "none")
    return Part::NONE;
  return std::nullopt;
}

double SkinProfile::at(double theta, double z) const {
  if (n_theta < 1 || n_z < 1)
    return 0;
  const double turns = (theta + units::PI) / (2 * units::PI);
  const double column = (turns - std::floor(turns)) * n_theta;
  const double row = n_z == 1 || z_high <= z_low
                         ? 0
                         : std::clamp((z - z_low) / (z_high - z_low), 0.0, 1.0) * (n_z - 1);
  const int k0 = static_cast<int>(column) % n_theta, k1 = (k0 + 1) % n_theta;
  const int j0 = std::min(static_cast<int>(row), n_z - 1), j1 = std::min(j0 + 1, n_z - 1);
  const double u = column - std::floor(column), w = row - j0;
  auto r = [&](int j, int k) { return radius[static_cast<std::size_t>(j) * n_theta + k]; };
  return (1 - w) * ((1 - u) * r(j0, k0) + u * r(j0, k1)) +
         w * ((1 - u) * r(j1, k0) + u * r(j1, k1));
}

const Vec3& Body::landmark(const std::string& name) const {
  const auto it = landmarks.find(name);
  if (it == landmarks.end())
    throw input_error("body.no-landmark"_id, scan.file, "landmarks/" + name,
                      "was not found on this scan", "see scan.findings of the body document");
  return it->second.p;
}

} // namespace sloper::body

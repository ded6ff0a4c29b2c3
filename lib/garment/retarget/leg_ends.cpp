#include <garment/retarget/leg_ends.hpp>

#include <garment/bind/bind_frames.hpp>
#include <garment/simulate/sleeve_ends.hpp>

#include <algorithm>

namespace sloper::garment {

namespace {

constexpr double AT_FOOT = 0.05;   // m over the ankle: cloth below meets the foot
constexpr double LONGER = 0.01;    // m: less is no longer leg
constexpr double KNEE_SHARE = 0.5; // of the way from ankle to hip, where there is no knee

double height(const Vec3& p, const PartFrame& leg) {
  return (p - leg.lower).dot((leg.upper - leg.lower).normalized());
}

} // namespace

std::vector<int> raise_ends_off_feet(std::vector<Vec3>& placed, const Garment& garment,
                                     const body::Body& to, const std::vector<Triangle>& through) {
  std::vector<int> raised;
  if (through.empty())
    return raised;
  const BindFrames frames = make_bind_frames(to);
  for (const LimbCover& cover : legs_of(garment.bind)) {
    const int index = frames.index(cover.frame);
    if (index < 0)
      continue;
    const BindFrame& leg = frames.frames[index];
    std::vector<char> is_of_leg(placed.size(), 0);
    for (int i : cover.limb)
      is_of_leg[i] = 1;
    const bool meets_foot = std::any_of(through.begin(), through.end(), [&](const Triangle& t) {
      return is_of_leg[t[0]] && height(placed[t[0]], leg.frame) < AT_FOOT;
    });
    double lowest = 1e300;
    for (int i : cover.end)
      lowest = std::min(lowest, height(placed[i], leg.frame));
    const double by = cover.lowest_m - lowest;
    if (!meets_foot || by < LONGER)
      continue;
    const auto knee = leg.marks.find("knee");
    const double share = knee == leg.marks.end() ? KNEE_SHARE : knee->second;
    const double from = share * leg.frame.length();
    const Vec3 up = (leg.frame.upper - leg.frame.lower).normalized();
    for (int i : cover.limb)
      placed[i] += std::max(0.0, by * (from - height(placed[i], leg.frame)) / (from - lowest)) * up;
    raised.insert(raised.end(), cover.end.begin(), cover.end.end());
  }
  return raised;
}

} // namespace sloper::garment

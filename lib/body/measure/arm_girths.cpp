#include <body/measure/arm_girths.hpp>
#include <body/measure/plateau.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::body {

namespace {

// shares of stature
constexpr double LONGEST_HAND = 0.11;  ///< the palm is nearer to the tip
constexpr double STILL_RISING = 0.105; ///< what is widest from here on is forearm
constexpr double PALM_TO_WRIST = 0.085;
constexpr double FIST_TO_WRIST = 0.02; ///< at least: sections of a blunt end are no palm
/// Share to which a fist's girth falls at most: of eight fists 0.52 to 0.77, of a blunt end 0.91.
constexpr double FIST_FALLS = 0.85;
constexpr double BESIDE_LEAST = 0.02;
constexpr double THINNER = 0.995; ///< of the girth: what is less by less is as thin
constexpr double AS_THIN = 1.015; ///< of the least girth

struct Palm {
  std::size_t at;    ///< section
  std::size_t after; ///< the wrist is here or farther from the tip
};

/// The widest section of an open hand; of a fist that the forearm exceeds, the widest before the
/// girth falls to the least share of it. Empty where it only rises.
std::optional<Palm> palm_of(const std::vector<LimbSection>& sections, double s) {
  std::size_t widest = 0, end = 0;
  for (; end < sections.size() && sections[end].along < LONGEST_HAND * s; ++end)
    if (sections[end].girth > sections[widest].girth)
      widest = end;
  if (sections.empty())
    return std::nullopt;
  if (sections[widest].along <= STILL_RISING * s)
    return Palm{widest, widest + 1};
  std::optional<Palm> palm;
  std::size_t before = 0;
  double least = FIST_FALLS;
  for (std::size_t k = 1; k < end; ++k) {
    const double share = sections[k].girth / sections[before].girth;
    const bool is_apart = sections[k].along > sections[before].along + FIST_TO_WRIST * s;
    if (is_apart && share < least) {
      least = share;
      palm = Palm{before, k};
    }
    if (share > 1)
      before = k;
  }
  return palm;
}

} // namespace

std::optional<double> wrist_by_girth(const ArmTrace& arm, double least_to_palm, double s) {
  const std::vector<LimbSection>& sections = arm.sections;
  const auto found = palm_of(sections, s);
  if (!found)
    return std::nullopt;
  const std::size_t palm = found->at;
  std::size_t least = palm;
  for (std::size_t k = found->after;
       k + 1 < sections.size() && sections[k].along < sections[palm].along + PALM_TO_WRIST * s; ++k)
    if (sections[k].girth < THINNER * sections[least].girth)
      least = k;
  if (sections[least].girth > least_to_palm * sections[palm].girth)
    return std::nullopt;
  double sum = 0, weight = 0; // the middle of where it is as thin as makes no difference
  for (std::size_t k = found->after;
       k + 1 < sections.size() && sections[k].along < sections[palm].along + PALM_TO_WRIST * s;
       ++k) {
    const double w = std::max(0.0, AS_THIN * sections[least].girth - sections[k].girth);
    if (std::abs(sections[k].along - sections[least].along) < BESIDE_LEAST * s) {
      sum += w * sections[k].along;
      weight += w;
    }
  }
  return sum / weight;
}

std::optional<double> elbow_by_girth(const ArmTrace& arm, double s, double wrist) {
  const auto& sections = arm.sections;
  std::vector<Vec2> falls; // along, girth lost per length
  for (std::size_t k = 3; k + 3 < sections.size(); ++k) {
    const double along = sections[k].along;
    if (along < wrist + 0.10 * s || along > wrist + 0.185 * s)
      continue;
    double rise = 0;
    for (std::size_t j = 1; j <= 3; ++j)
      rise += (sections[k + j].girth - sections[k - j].girth) /
              (sections[k + j].along - sections[k - j].along) / 3;
    falls.emplace_back(along, -rise);
  }
  double steepest = 0;
  for (const Vec2& fall : falls)
    steepest = std::max(steepest, -fall.y());
  if (steepest <= 0)
    return std::nullopt;
  return lowest_of(falls, 0.25 * steepest)
      .middle; // of what is about as steep: sections lie centimetres apart
}

double upper_arm_without_hand(double reach, double usual, double share) {
  constexpr double SURELY_SHORT = 0.85; // of the usual length
  const double is_short =
      std::clamp((SHORT_ARM - reach / usual) / (SHORT_ARM - SURELY_SHORT), 0.0, 1.0);
  return share * ((1 - is_short) * std::min(reach, usual) + is_short * usual);
}

} // namespace sloper::body

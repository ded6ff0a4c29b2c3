#include <garment/retarget/keep_ease.hpp>

#include <algorithm>
#include <cmath>
#include <garment/fit/fit_measure.hpp>
#include <map>
#include <optional>
#include <set>
#include <sloper/base/text.hpp>

namespace sloper::garment {

namespace {

constexpr double CLOSE = 0.15;          // of the trunk's girth: more ease hangs past a hollow
constexpr double MOST = 0.2;            // logarithm: a girth further off was measured wrongly
constexpr double CHANGED_EASE = 0.02;   // m that a tailor would see at a close girth
constexpr std::size_t MOST_CHANGED = 3; // girths in one message
constexpr double ONE_PLACE = 0.01;      // m along a limb: girths nearer to each other are averaged

/// Levels of the trunk whose cloth lies at the same level on both bodies: those that coordinates
/// along the torso are piecewise linear between (bind.cpp).
const std::set<std::string> SHARED_LEVELS = {"chest_axilla",    "bust", "waist_semantic",
                                             "waist_girth_min", "hip",  "waist_width_min",
                                             "crotch"};

/// The limb that a girth goes around, or empty where its ease is not kept.
std::string limb_of_girth(const FitPlace& place) {
  if (place.kind == "level")
    return SHARED_LEVELS.count(place.name) ? "torso" : "";
  if (place.kind != "limb")
    return "";
  const bool is_arm = place.name.rfind("upper_arm", 0) == 0 || place.name.rfind("wrist", 0) == 0;
  return (is_arm ? "arm" : "leg") + place.name.substr(place.name.size() - 2);
}

/// "arm_l" for "forearm_l", "leg_r" for "leg_r"; of other frames the name.
std::string limb_name(const std::string& frame) {
  if (frame.find("arm_") != std::string::npos)
    return "arm" + frame.substr(frame.size() - 2);
  return frame;
}

std::optional<EaseAtGirth> ease_of(const Garment& placed, const std::vector<Vec3>& source,
                                   const FitPlace& place) {
  EaseAtGirth ease{.name = place.name,
                   .limb = limb_of_girth(place),
                   .center = place.center,
                   .axis = place.normal};
  const auto first_body =
      placed.body_girths_m.find((place.kind == "level" ? "level:" : "") + place.name);
  if (ease.limb.empty() || first_body == placed.body_girths_m.end())
    return std::nullopt;
  std::string why;
  const auto line = line_around(placed, cloth_of(placed, place), place, 0, why, &source);
  if (!line || line->bridged > 0)
    return std::nullopt;
  ease.ease_m = line->elsewhere - first_body->second;
  if (ease.limb == "torso" && ease.ease_m > CLOSE * first_body->second)
    return std::nullopt;
  ease.wanted_m = place.body_m + ease.ease_m;
  ease.has_m = line->lying;
  return ease;
}

/// Logarithms along one limb.
class AlongLimb {
public:
  explicit AlongLimb(const std::vector<EaseAtGirth>& girths) : m_axis(girths.front().axis) {
    const Vec3 chord = girths.back().center - girths.front().center;
    if (chord.norm() > ONE_PLACE) // a bent arm has an axis at each girth
      m_axis = chord.normalized();
    for (const EaseAtGirth& girth : girths) {
      const double log = std::clamp(std::log(girth.wanted_m / girth.has_m), -MOST, MOST);
      m_points.push_back({girth.center.dot(m_axis), log, 1});
    }
    std::sort(m_points.begin(), m_points.end(),
              [](const Point& a, const Point& b) { return a.along < b.along; });
    merge_near_ones();
  }

  const Vec3& axis() const { return m_axis; }

  double at(const Vec3& p) const {
    const double along = p.dot(m_axis);
    if (along <= m_points.front().along)
      return m_points.front().log;
    for (std::size_t i = 1; i < m_points.size(); ++i) {
      const Point &a = m_points[i - 1], &b = m_points[i];
      if (along <= b.along)
        return a.log + (along - a.along) / (b.along - a.along) * (b.log - a.log);
    }
    return m_points.back().log;
  }

private:
  struct Point {
    double along, log;
    int count;
  };

  void merge_near_ones() {
    std::vector<Point> merged;
    for (const Point& p : m_points) {
      if (merged.empty() || p.along - merged.back().along > ONE_PLACE) {
        merged.push_back(p);
        continue;
      }
      Point& last = merged.back();
      last.log = (last.count * last.log + p.log) / (last.count + 1);
      ++last.count;
    }
    m_points = std::move(merged);
  }

  Vec3 m_axis;
  std::vector<Point> m_points;
};

/// Directions of weft and warp of a triangle as it lies, unit columns; zero where it has no area.
Eigen::Matrix<double, 3, 2> threads_of(const Garment& garment, const Triangle& t,
                                       const Vec2& warp) {
  Eigen::Matrix2d flat;
  Eigen::Matrix<double, 3, 2> lies;
  const Vec2 weft(warp.y(), -warp.x());
  for (int k = 0; k < 2; ++k) {
    const Vec2 side = garment.panels.pattern[t[k + 1]] - garment.panels.pattern[t[0]];
    flat.col(k) << side.dot(weft), side.dot(warp);
    lies.col(k) = garment.position[garment.particle_of[t[k + 1]]] -
                  garment.position[garment.particle_of[t[0]]];
  }
  if (std::abs(flat.determinant()) < 1e-12)
    return Eigen::Matrix<double, 3, 2>::Zero();
  return (lies * flat.inverse()).colwise().normalized();
}

/// The share in which a unit direction runs around an axis.
double around(const Vec3& direction, const Vec3& axis) {
  return direction.squaredNorm() - std::pow(direction.dot(axis), 2);
}

} // namespace

std::vector<EaseAtGirth> ease_at_girths(const Garment& placed, const std::vector<Vec3>& source,
                                        const body::Body& to) {
  std::vector<EaseAtGirth> girths;
  for (const FitPlace& place : fit_places(to))
    if (auto ease = ease_of(placed, source, place))
      girths.push_back(std::move(*ease));
  return girths;
}

std::vector<Vec2> lengthening_for_ease(const Garment& placed,
                                       const std::vector<EaseAtGirth>& girths) {
  std::map<std::string, std::vector<EaseAtGirth>> of_arm;
  for (const EaseAtGirth& girth : girths)
    if (girth.limb.rfind("arm", 0) == 0)
      of_arm[girth.limb].push_back(girth);
  std::map<std::string, AlongLimb> limbs;
  for (const auto& [name, list] : of_arm)
    limbs.emplace(name, list);
  std::vector<Vec2> longer(placed.panels.triangles.size(), Vec2::Zero());
  if (limbs.empty())
    return longer;
  std::vector<const AlongLimb*> limb_of_frame;
  for (const std::string& frame : placed.bind.frames) {
    const auto limb = limbs.find(limb_name(frame));
    limb_of_frame.push_back(limb == limbs.end() ? nullptr : &limb->second);
  }
  for (const pattern::PanelInfo& panel : placed.panels.panels)
    for (int f = panel.first_triangle; f < panel.first_triangle + panel.n_triangles; ++f) {
      const Triangle& t = placed.panels.triangles[f];
      const Eigen::Matrix<double, 3, 2> threads = threads_of(placed, t, panel.grain.normalized());
      for (const int v : t) {
        const int particle = placed.particle_of[v];
        for (const BindWeight& w : placed.bind.particles[particle]) {
          const AlongLimb* const limb = limb_of_frame[w.frame];
          if (!limb)
            continue;
          const double log = w.weight * limb->at(placed.position[particle]) / 3;
          longer[f] += log * Vec2(around(threads.col(0), limb->axis()),
                                  around(threads.col(1), limb->axis()));
        }
      }
    }
  return longer;
}

std::string changed_ease_text(const FitReport& fit) {
  std::vector<const FitRow*> changed;
  for (const FitRow& row : fit.rows)
    if (row.source_ease_m && std::abs(row.ease_m - *row.source_ease_m) >
                                 std::max(CHANGED_EASE, 2 * row.ease_uncertainty_m))
      changed.push_back(&row);
  const auto change = [](const FitRow* row) { return std::abs(row->ease_m - *row->source_ease_m); };
  std::stable_sort(changed.begin(), changed.end(),
                   [&](const FitRow* a, const FitRow* b) { return change(a) > change(b); });
  if (changed.size() > MOST_CHANGED)
    changed.resize(MOST_CHANGED);
  std::string text;
  for (const FitRow* row : changed) {
    const bool more = row->ease_m > *row->source_ease_m;
    text += (text.empty() ? "has " : "; ") + sloper::centimetres(change(row)) +
            (more ? " more" : " less") + " ease at the " + spoken_girth(row->name) +
            " than on the body that it comes from: " + sloper::centimetres(row->ease_m) +
            ", there " + sloper::centimetres(*row->source_ease_m);
  }
  return text;
}

} // namespace sloper::garment

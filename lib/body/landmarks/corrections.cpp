#include <body/landmarks/corrections.hpp>
#include <io/json.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::body {

extern const char* const STANDARD_CORRECTIONS; ///< generated from rules/corrections.json

namespace {

constexpr double UNIT = 1e-5;  ///< of stature: the document's weights are whole numbers of it
constexpr double MOST = 0.005; ///< of stature: no correction is larger along any axis, so that none
                               ///< can make a landmark grossly wrong on a body of another make;
                               ///< with 0.03 the median of 48 kept bodies was 3.2 mm instead of 3.4
constexpr double BEYOND = 3;   ///< standard deviations: farther out a feature counts no more
constexpr double FAR = 6;      ///< and for the unlikeness no more than this
/// Standard deviations at which a body begins to be unlike those learned from, and at which it is
/// not corrected.
constexpr double UNLIKE = 1.7, STRANGE = 2.4;

} // namespace

const Corrections& Corrections::standard() {
  static const Corrections corrections = parse(STANDARD_CORRECTIONS, "built-in corrections");
  return corrections;
}

const Corrections& Corrections::none() {
  static const Corrections corrections;
  return corrections;
}

Corrections Corrections::parse(const std::string& text, const std::string& name) {
  const io::Json document = io::parse_json(text, name);
  const io::Node root(document, name);
  if (root.string("format", "") != "landmark-corrections")
    root.fail("is not a landmark-corrections document");
  Corrections corrections;
  const io::Node features = root.at("features");
  const std::vector<std::string>& known = shape_feature_names();
  if (features.size() == 0) return corrections;
  if (features.size() != known.size())
    features.fail("are not those of this program",
                  "derive the corrections again: scripts/derive-corrections");
  for (std::size_t k = 0; k < known.size(); ++k) {
    const io::Node feature = features.at(k);
    if (feature.at(std::size_t{0}).string() != known[k])
      feature.fail("is not \"" + known[k] + "\"",
                   "derive the corrections again: scripts/derive-corrections");
    corrections.m_features.push_back({feature.at(1).number(), feature.at(2).number()});
  }
  const io::Node points = root.at("points");
  for (const std::string& place : points.keys()) {
    const io::Node entry = points.at(place);
    for (int axis = 0; axis < 3; ++axis) {
      const std::string letter(1, "xyz"[axis]);
      if (!entry.has(letter)) continue;
      const io::Node list = entry.at(letter);
      if (list.size() != known.size() + 1) list.fail("has not one weight for each feature");
      Weights& weights = corrections.m_points[place][axis];
      weights.bias = UNIT * list.at(std::size_t{0}).number();
      for (std::size_t k = 1; k < list.size(); ++k)
        weights.of_feature.push_back(UNIT * list.at(k).number());
    }
  }
  return corrections;
}

/// A feature in standard deviations from the mean; 0 where it is not shown. Of both sides the mean,
/// for a landmark in the middle.
double Corrections::scaled(const ShapeFeatures& features, int side, std::size_t k) const {
  auto of = [&](int which) {
    const double z = (features.side[which][k] - m_features[k].mean) / m_features[k].sd;
    return std::isfinite(z) ? z : 0.0;
  };
  return side >= 0 ? of(side) : 0.5 * (of(0) + of(1));
}

double Corrections::unlikeness(const ShapeFeatures& features) const {
  if (m_features.empty()) return 0;
  double sum = 0;
  for (int side = 0; side < 2; ++side)
    for (std::size_t k = 0; k < m_features.size(); ++k) {
      const double z = std::min(FAR, std::abs(scaled(features, side, k)));
      sum += z * z;
    }
  return std::sqrt(sum / (2.0 * static_cast<double>(m_features.size())));
}

Vec3 Corrections::offset(const std::string& place, const ShapeFeatures& features, int side) const {
  Vec3 offset = Vec3::Zero();
  const auto it = m_points.find(place);
  if (it == m_points.end()) return offset;
  const double trust = std::clamp((STRANGE - unlikeness(features)) / (STRANGE - UNLIKE), 0.0, 1.0);
  if (trust <= 0) return offset;
  for (int axis = 0; axis < 3; ++axis) {
    const Weights& weights = it->second[axis];
    if (weights.of_feature.empty()) continue;
    double sum = weights.bias;
    for (std::size_t k = 0; k < weights.of_feature.size(); ++k)
      sum += weights.of_feature[k] * std::clamp(scaled(features, side, k), -BEYOND, BEYOND);
    offset[axis] = trust * std::clamp(sum, -MOST, MOST);
  }
  if (side < 0) offset.x() = 0;
  return offset;
}

} // namespace sloper::body

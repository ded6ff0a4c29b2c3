#include <sloper/body/landmarks/corrections.hpp>
#include <sloper/io/json.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::body {

extern const char* const STANDARD_CORRECTIONS; ///< generated from rules/corrections.json

namespace {

constexpr double UNIT = 1e-5;  ///< of stature: the document's weights are whole numbers of it
constexpr double SHARE = 1e-3; ///< of a standard deviation, or of a unit vector's length
constexpr double MOST = 0.03;  ///< of stature: no correction is larger along any axis
constexpr double BEYOND = 3;   ///< standard deviations: farther out a feature counts no more
constexpr double FAR = 6;      ///< and for the unlikeness no more than this
constexpr double NOTHING_LEARNED = 2; ///< of a make's limit: what was learned says nothing at all
/// Of a make's limit: a body that is as much nearer to it than to the others belongs to it. Of 72
/// corrupted scans each is by 0.13 or more; 18 mannequins are nearer to mannequins by 0.33.
constexpr double NEARER = 0.1;
constexpr double NO_MORE = 1.2; ///< of a make's limit, at which its bodies say nothing any more

std::vector<double> numbers_of(const io::Node& list, double unit) {
  std::vector<double> numbers;
  for (std::size_t k = 0; k < list.size(); ++k)
    numbers.push_back(unit * list.at(k).number());
  return numbers;
}

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
    root.fail("json.wrong-format"_id, "is not a landmark-corrections document");
  Corrections corrections;
  const io::Node features = root.at("features");
  const std::vector<std::string>& known = shape_feature_names();
  if (features.size() == 0)
    return corrections;
  if (features.size() != known.size())
    features.fail("corrections.other-program"_id, "are not those of this program",
                  "derive the corrections again: scripts/derive-corrections");
  for (std::size_t k = 0; k < known.size(); ++k) {
    const io::Node feature = features.at(k);
    if (feature.at(std::size_t{0}).string() != known[k])
      feature.fail("corrections.other-program"_id, "is not \"" + known[k] + "\"",
                   "derive the corrections again: scripts/derive-corrections");
    corrections.m_features.push_back({feature.at(1).number(), feature.at(2).number()});
  }
  corrections.read_population(root);
  const io::Node points = root.at("points");
  if (points.size() > 0 && corrections.m_makes.empty())
    root.fail("corrections.other-program"_id, "does not say which bodies are alike",
              "derive the corrections anew: scripts/derive-corrections");
  for (const std::string& place : points.keys()) {
    const io::Node entry = points.at(place);
    Point& point = corrections.m_points[place];
    point.of_make = corrections.read_makes(entry, "makes");
    for (int axis = 0; axis < 3; ++axis)
      if (const std::string letter(1, "xyz"[axis]); entry.has(letter))
        point.axis[axis] = corrections.read_weights(entry.at(letter));
  }
  if (root.has("crotch_at_an_end"))
    corrections.m_crotch_at_an_end = corrections.read_makes(root, "crotch_at_an_end");
  if (!root.has("expected"))
    return corrections;
  const io::Node expected = root.at("expected");
  for (const std::string& place : expected.keys()) {
    const io::Node entry = expected.at(place);
    Weights& weights = corrections.m_expected[place] = corrections.read_weights(entry.at("y"));
    weights.sd = UNIT * entry.at("sd").number();
    weights.of_make = corrections.read_makes(entry, "makes");
    if (!(weights.sd > 0))
      entry.at("sd").fail("json.out-of-range"_id, "is not positive");
  }
  return corrections;
}

/// 1 for each make that the list names; for all where there is no list.
std::vector<char> Corrections::read_makes(const io::Node& entry, const char* key) const {
  std::vector<char> of_make(m_makes.size(), entry.has(key) ? 0 : 1);
  if (!entry.has(key))
    return of_make;
  for (const double make : numbers_of(entry.at(key), 1)) {
    if (!(make >= 0 && make < static_cast<double>(of_make.size())))
      entry.at(key).fail("json.bad-index"_id, "names a make that is not there");
    of_make[make] = 1;
  }
  return of_make;
}

void Corrections::read_population(const io::Node& root) {
  if (!root.has("makes"))
    return;
  const std::size_t n = m_features.size();
  const io::Node makes = root.at("makes"), basis = root.at("basis");
  for (std::size_t m = 0; m < makes.size(); ++m) {
    const io::Node make = makes.at(m);
    m_makes.push_back(
        {make.at("name").string(), numbers_of(make.at("mean"), SHARE), make.at("limit").number()});
    if (m_makes.back().mean.size() != n)
      make.at("mean").fail("json.wrong-count"_id, "has not one number a feature");
    if (!(m_makes.back().limit > 0))
      make.at("limit").fail("json.out-of-range"_id, "is not positive");
  }
  for (std::size_t k = 0; k < basis.size(); ++k) {
    const io::Node row = basis.at(k);
    m_basis_sd.push_back(row.at("sd").number());
    m_basis.push_back(numbers_of(row.at("direction"), SHARE));
    if (m_basis.back().size() != n)
      row.fail("json.wrong-count"_id, "has not one number a feature");
    if (!(m_basis_sd.back() > 0))
      row.at("sd").fail("json.out-of-range"_id, "is not positive");
  }
  m_outside = root.at("outside").number();
  if (!(m_outside > 0))
    root.at("outside").fail("json.out-of-range"_id, "is not positive");
}

Corrections::Weights Corrections::read_weights(const io::Node& list) const {
  if (list.size() != m_features.size() + 1)
    list.fail("json.wrong-count"_id, "has not one weight for each feature");
  Weights weights;
  weights.of_feature = numbers_of(list, UNIT);
  weights.bias = weights.of_feature.front();
  weights.of_feature.erase(weights.of_feature.begin());
  return weights;
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

double Corrections::linear(const Weights& weights, const ShapeFeatures& features, int side) const {
  double sum = weights.bias;
  for (std::size_t k = 0; k < weights.of_feature.size(); ++k)
    sum += weights.of_feature[k] * std::clamp(scaled(features, side, k), -BEYOND, BEYOND);
  return sum;
}

double Corrections::unlikeness(const ShapeFeatures& features) const {
  if (m_features.empty())
    return 0;
  double sum = 0;
  for (int side = 0; side < 2; ++side)
    for (std::size_t k = 0; k < m_features.size(); ++k) {
      const double z = std::min(FAR, std::abs(scaled(features, side, k)));
      sum += z * z;
    }
  return std::sqrt(sum / (2.0 * static_cast<double>(m_features.size())));
}

std::vector<double> Corrections::distances(const ShapeFeatures& features) const {
  std::vector<double> distances;
  for (const Make& make : m_makes) {
    double sum = 0;
    for (int side = 0; side < 2; ++side) {
      std::vector<double> z;
      double outside = 0, within = 0;
      for (std::size_t k = 0; k < m_features.size(); ++k) {
        z.push_back(std::clamp(scaled(features, side, k), -FAR, FAR) - make.mean[k]);
        outside += z.back() * z.back();
      }
      for (std::size_t b = 0; b < m_basis.size(); ++b) {
        double along = 0;
        for (std::size_t k = 0; k < z.size(); ++k)
          along += m_basis[b][k] * z[k];
        outside -= along * along;
        within += along * along / (m_basis_sd[b] * m_basis_sd[b]);
      }
      sum += std::sqrt(
          std::max({0.0, outside / m_outside, within / static_cast<double>(m_basis.size())}));
    }
    distances.push_back(0.5 * sum);
  }
  return distances;
}

double Corrections::likeness(const ShapeFeatures& features) const {
  return likeness(features, nullptr);
}

/// @param of_make 1 for the makes that count; all where null
double Corrections::likeness(const ShapeFeatures& features,
                             const std::vector<char>* of_make) const {
  double most = 0;
  const std::vector<double> far = distances(features);
  for (std::size_t m = 0; m < far.size(); ++m)
    if (!of_make || (*of_make)[m])
      most = std::max(most,
                      std::clamp((NO_MORE - far[m] / m_makes[m].limit) / (NO_MORE - 1), 0.0, 1.0));
  return most;
}

double Corrections::membership(const ShapeFeatures& features,
                               const std::vector<char>& of_make) const {
  const std::vector<double> far = distances(features);
  double near = 1e300, other = 1e300;
  for (std::size_t m = 0; m < far.size() && m < of_make.size(); ++m) {
    double& nearest = of_make[m] ? near : other;
    nearest = std::min(nearest, far[m] / m_makes[m].limit);
  }
  return likeness(features, &of_make) * std::clamp((other - near) / NEARER, 0.0, 1.0);
}

double Corrections::membership(const std::string& place, const ShapeFeatures& features) const {
  const auto it = m_expected.find(place);
  return it == m_expected.end() ? 0 : membership(features, it->second.of_make);
}

double Corrections::crotch_at_an_end(const ShapeFeatures& features) const {
  return m_crotch_at_an_end.empty() ? 0 : membership(features, m_crotch_at_an_end);
}

Vec3 Corrections::offset(const std::string& place, const ShapeFeatures& features, int side) const {
  Vec3 offset = Vec3::Zero();
  const auto it = m_points.find(place);
  if (it == m_points.end())
    return offset;
  const double trust = likeness(features, &it->second.of_make);
  if (trust <= 0)
    return offset;
  for (int axis = 0; axis < 3; ++axis)
    if (const Weights& weights = it->second.axis[axis]; !weights.of_feature.empty())
      offset[axis] = trust * std::clamp(linear(weights, features, side), -MOST, MOST);
  if (side < 0)
    offset.x() = 0;
  return offset;
}

std::optional<Corrections::Expected>
Corrections::expected(const std::string& place, const ShapeFeatures& features, int side) const {
  const auto it = m_expected.find(place);
  if (it == m_expected.end() || likeness(features) < 1)
    return std::nullopt;
  return Expected{linear(it->second, features, side), it->second.sd};
}

double Corrections::strangeness(const ShapeFeatures& features) const {
  const std::vector<double> far = distances(features);
  if (far.empty())
    return 0;
  double least = 1e300;
  for (std::size_t m = 0; m < far.size(); ++m)
    least = std::min(least, far[m] / m_makes[m].limit);
  return least;
}

std::optional<Corrections::Expected>
Corrections::extrapolated(const std::string& place, const ShapeFeatures& features, int side) const {
  const auto it = m_expected.find(place);
  const double strange = strangeness(features);
  if (it == m_expected.end() || strange > NOTHING_LEARNED)
    return std::nullopt;
  const double wider = std::max(1.0, strange * strange);
  return Expected{linear(it->second, features, side), wider * it->second.sd};
}

} // namespace sloper::body

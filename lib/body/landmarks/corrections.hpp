#pragma once
/// What a population says of the rules' results: for each landmark an offset that is linear in the
/// body's shape, learned from bodies whose landmarks are known (scripts/derive-corrections; ridge
/// regression, Hoerl and Kennard 1970). A body unlike all of them is not corrected.
#include <body/landmarks/shape_features.hpp>
#include <geometry/triangle_mesh.hpp>
#include <map>
namespace sloper::body {

class Corrections {
public:
  /// Those embedded at build time (lib/body/landmarks/rules/corrections.json).
  static const Corrections& standard();
  /// None: the rules' results stay as they are.
  static const Corrections& none();
  /// @param name for messages
  /// @throws Error INPUT where the text is no such document, or one of features that this program
  /// does not know
  static Corrections parse(const std::string& text, const std::string& name);

  bool has(const std::string& place) const { return m_points.count(place) != 0; }
  /// How far the body is from those that were learned from: root mean square of its features'
  /// distances from theirs, in standard deviations; 0 where nothing was learned. On the bodies
  /// learned from it is 1 on average.
  double unlikeness(const ShapeFeatures& features) const;
  /// Offset of a landmark as shares of stature, x away from the middle plane; zero for what was not
  /// learned and for bodies unlike the others.
  /// @param side 0 left, 1 right, -1 for a landmark in the middle: its x is zero
  Vec3 offset(const std::string& place, const ShapeFeatures& features, int side) const;

private:
  struct Weights {
    double bias = 0;
    std::vector<double> of_feature; ///< per standard deviation
  };
  struct Feature {
    double mean = 0, sd = 1;
  };
  double scaled(const ShapeFeatures& features, int side, std::size_t k) const;
  std::vector<Feature> m_features;
  std::map<std::string, std::array<Weights, 3>> m_points;
};

} // namespace sloper::body

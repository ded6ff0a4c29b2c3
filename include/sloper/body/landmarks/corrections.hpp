#pragma once
/// Statistics of a population that correct the rules' results: for each landmark an
/// offset that is linear in the body's shape, and the height that the rest of the body
/// predicts, learned from bodies whose landmarks are known (scripts/derive-corrections;
/// ridge regression, Hoerl and Kennard 1970). The bodies are of several makes; one that
/// is unlike all of them is neither corrected nor judged.
/// Test: tests/body/landmarks/test_corrections.cpp
#include <map>
#include <optional>
#include <sloper/body/landmarks/shape_features.hpp>
#include <sloper/geometry/triangle_mesh.hpp>
namespace sloper::io {
class Node;
}
namespace sloper::body {

/// Learned offsets of landmarks and their expected heights, with the distance of a body
/// from the population that they were learned on.
class Corrections {
public:
  /// Standard deviations between a rule's height and the expected one beyond which they disagree:
  /// 4.5. Of 70 bodies kept from learning five had a place beyond, the front of the neck; all five
  /// were wrong by 11 to 29 mm, in that direction.
  static constexpr double DISAGREE = 4.5;
  /// Those embedded at build time (lib/body/landmarks/rules/corrections.json).
  static const Corrections& standard();
  /// None: the rules' results stay as they are.
  static const Corrections& none();
  /// @param name for messages
  /// @throws Error INPUT where the text is no such document, or one of features that this program
  /// does not know
  static Corrections parse(const std::string& text, const std::string& name);

  /// Whether an offset was learned for this place (a landmark without its side).
  bool has(const std::string& place) const { return m_points.count(place) != 0; }
  /// Distance of a body from the bodies that were learned from: root mean square of the
  /// distances of its features from their means, in standard deviations; 0 where nothing
  /// was learned. It is 1 on average over the bodies learned from.
  double unlikeness(const ShapeFeatures& features) const;
  /// Distance of a body from each make of bodies. With z its features in standard
  /// deviations about the make's mean, and B the main directions in which bodies of all
  /// makes differ: the larger of sqrt(mean (B z)_k^2 / s_k^2) and sqrt(|z - B^T B z|^2 /
  /// r) (Mahalanobis distance within and outside of the directions; r is the residual of
  /// bodies that were left out of their fold). Mean of both sides; empty where nothing
  /// was learned.
  std::vector<double> distances(const ShapeFeatures& features) const;
  /// Membership of a body in any make, 0 to 1: 1 where it is as near as 97 of 100 of the
  /// make's own bodies that were not learned from, 0 a fifth farther.
  double likeness(const ShapeFeatures& features) const;
  /// Offset of a landmark as shares of stature, x away from the middle plane; zero for
  /// places that were not learned and for bodies unlike the others.
  /// @param place  a landmark without its side
  /// @param features  of the body
  /// @param side  0 left, 1 right, -1 for a landmark in the middle: its x is zero
  Vec3 offset(const std::string& place, const ShapeFeatures& features, int side) const;

  /// Height that a linear model of the body's shape predicts for a landmark.
  struct Expected {
    double height = 0; ///< of stature
    double sd = 0;     ///< of stature, of bodies that were not learned from
    /// Weight of this height against a rule's, off^2 / (off^2 + 1), off = (y - height) / sd: where
    /// they agree the rule's counts, the farther they are apart the less.
    /// @param y  height by a rule, of stature
    double weight(double y) const {
      const double off = (y - height) / sd;
      return off * off / (off * off + 1);
    }
  };
  /// The height that the rest of the body predicts for a landmark; empty for places that
  /// were not learned and for bodies unlike the others. Arguments as of offset().
  std::optional<Expected> expected(const std::string& place, const ShapeFeatures& features,
                                   int side) const;
  /// The same for any body: sd grows by the square of strangeness() beyond 1. Enough to
  /// doubt a place, not to put one. Empty beyond a strangeness of 2.
  std::optional<Expected> extrapolated(const std::string& place, const ShapeFeatures& features,
                                       int side) const;
  /// Share, 0 to 1, to which a body belongs to the makes that taught an expected place: likeness()
  /// to them, and nothing where it is nearer to another make; 0 for places that were not learned.
  double membership(const std::string& place, const ShapeFeatures& features) const;
  /// The same for the makes whose crotches lie at one end of the trunk's underside or the other,
  /// and nowhere between: MakeHuman's bodies, not mannequins.
  double crotch_at_an_end(const ShapeFeatures& features) const;
  /// Distance of a body from the nearest make over the limit that holds 97 of 100 of the make's
  /// own bodies; 0 where nothing was learned.
  double strangeness(const ShapeFeatures& features) const;

private:
  struct Weights {
    double bias = 0, sd = 0;
    std::vector<double> of_feature; ///< per standard deviation
    std::vector<char> of_make;      ///< 1 where that make's bodies taught it
  };
  struct Feature {
    double mean = 0, sd = 1;
  };
  struct Make {
    std::string name;
    std::vector<double> mean; ///< standard deviations
    double limit = 0;         ///< of the distance
  };
  struct Point {
    std::array<Weights, 3> axis;
    std::vector<char> of_make; ///< 1 where that make's bodies taught it
  };
  double scaled(const ShapeFeatures& features, int side, std::size_t k) const;
  double linear(const Weights& weights, const ShapeFeatures& features, int side) const;
  double likeness(const ShapeFeatures& features, const std::vector<char>* of_make) const;
  double membership(const ShapeFeatures& features, const std::vector<char>& of_make) const;
  std::vector<char> read_makes(const io::Node& entry, const char* key) const;
  void read_population(const io::Node& root);
  Weights read_weights(const io::Node& list) const;
  std::vector<Feature> m_features;
  std::vector<Make> m_makes;
  std::vector<std::vector<double>> m_basis; ///< rows B_k
  std::vector<double> m_basis_sd;
  double m_outside = 1; ///< r
  std::map<std::string, Point> m_points;
  std::map<std::string, Weights> m_expected;
  std::vector<char> m_crotch_at_an_end; ///< 1 for such makes
};

} // namespace sloper::body

#pragma once
/// What tells the front of a garment from its back once it is known which panels face each other:
/// differences of the two faces that drafting gives them. A bust makes fronts wider and longer, a
/// neck is deeper in front, a skirt's waist is dropped there, a seat makes the crotch longer
/// behind.
#include <sloper/pattern/pattern.hpp>

#include <array>
#include <string>
#include <vector>

namespace sloper::pattern {

/// What is compared, on torso, lower body and legs.
inline constexpr std::size_t FACE_VOTES = 18;
inline constexpr const char* FACE_VOTE_NAMES[FACE_VOTES] = {
    "torso_width",  "torso_hem",     "torso_height", "neck_depth",  "neck_length", "torso_middle",
    "armhole",      "armhole_bulge", "torso_darts",  "lower_width", "waist_width", "lower_height",
    "lower_middle", "lower_darts",   "leg_width",    "crotch",      "crotch_lean", "leg_darts"};

/// Each from -1 to 1: how surely the first face has more of it, 0 where both have as much.
using FaceVotes = std::array<double, FACE_VOTES>;

/// The measures of a pattern's panels that votes compare.
class FaceWitness {
public:
  explicit FaceWitness(const Pattern& pattern);

  /// @param part  of each panel, of SHAPE_PART_NAMES
  /// @param face  of each panel, 1 the first face, -1 the other, 0 left out
  FaceVotes compare(const std::vector<std::size_t>& part, const std::vector<int>& face) const;

private:
  struct Edge {
    double length = 0, across = 0; ///< m, across: of its chord
    bool level = false;
    double height = 0; ///< of its middle in the panel's box, 0 to 1
    double bulge = 0;  ///< hollow above 0, over the length
    int other = -1;    ///< panel that it is sewn to, itself at a dart
    double dart = 0;   ///< m: width of the dart that it begins
  };
  struct Seen {
    std::vector<Edge> edges;
    double width = 0, height = 0;           ///< m, across and along the grain
    std::vector<std::vector<Vec2>> outline; ///< of each edge, samples across and along the grain
    Vec2 low = Vec2::Zero(), high = Vec2::Zero();
    bool symmetric = false;
  };
  /// Sums over the panels of one face and part.
  struct Sum {
    int panels = 0;
    double width = 0, height = 0, hem = 0, top = 0, neck = 0, depth = 0, middle = 0, lean = 0,
           armhole = 0, bulge = 0, darts = 0;
  };
  double neck_depth(std::size_t panel, double middle) const;
  Sum sum_of(const std::vector<std::size_t>& part, const std::vector<int>& face, std::size_t which,
             int side) const;

  std::vector<Seen> m_panels;
};

} // namespace sloper::pattern

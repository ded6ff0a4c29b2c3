#pragma once
/// What panels are on the body by their shapes and by what they are sewn to, without names.
#include <pattern/roles/face_votes.hpp>
#include <pattern/roles/shape_parts.hpp>
#include <pattern/seams/seam_model.hpp>

#include <string>
#include <vector>

namespace sloper::pattern {

/// What one panel is by its shape, as the model sees it.
struct ShapeRole {
  std::size_t part = 0; ///< of SHAPE_PART_NAMES
  double sure = 0;      ///< probability of the part
  bool back = false;
  int hand = 0;         ///< 1 the wearer's left, -1 right, 0 both or unknown
  double face_odds = 0; ///< log-odds that `back` is right
};

/// Boosted trees for each part, in two looks; for "is a back"; and for "both sides of a seam are on
/// the same face of the body". `front` weighs what the two faces of the whole garment differ by.
struct RoleModel {
  std::vector<SeamTrees> parts[2];
  SeamTrees back, same_face;
  FaceVotes front{};
};

/// The model that is shipped.
const RoleModel& role_model();

/// What is seen of a pattern's panels and seams, as classes for the trees.
class ShapeWitness {
public:
  explicit ShapeWitness(const Pattern& pattern);

  std::size_t count() const { return m_panels.size(); }
  /// Clues of a panel; with the parts' probabilities of all panels for the second look and the
  /// faces.
  Evidence panel(std::size_t k) const;
  Evidence panel(std::size_t k, const std::vector<std::array<double, SHAPE_PARTS>>& parts) const;

  struct Link {
    std::size_t a = 0, b = 0; ///< panels
    double length = 0;        ///< m
    bool middle = false;      ///< an edge sewn to its image in a mirrored panel
    Evidence evidence{};
    double x_a = 0.5, x_b = 0.5; ///< where in their panels' widths, 0 to 1
  };
  /// Seams between different panels.
  const std::vector<Link>& links() const { return m_links; }
  /// A link's clues with the parts of its panels.
  Evidence link(const Link& link, const std::vector<std::size_t>& parts) const;
  bool symmetric(std::size_t k) const { return m_panels[k].symmetric; }
  const FaceWitness& faces() const { return m_faces; }

private:
  struct Seen {
    Evidence evidence{};
    bool symmetric = false;
    double area = 0, height = 0;
  };
  std::vector<Seen> m_panels;
  std::vector<Link> m_links;
  FaceWitness m_faces;
};

/// @param pattern  with its seams
/// @param legs  whether there may be legs at all (see more_rims_than_trousers())
std::vector<ShapeRole> shape_roles(const Pattern& pattern, const RoleModel& model = role_model(),
                                   bool legs = true);

/// Which panels are on the same face of the garment: of each panel a root panel that it is compared
/// with, and whether it is on the other face than that.
std::vector<std::pair<std::size_t, bool>> tell_faces(const ShapeWitness& witness,
                                                     const RoleModel& model,
                                                     const std::vector<std::size_t>& part);

/// Faces and hands, the parts being known.
void tell_sides(const ShapeWitness& witness, const RoleModel& model,
                const std::vector<std::array<double, SHAPE_PARTS>>& parts,
                std::vector<ShapeRole>& roles);

} // namespace sloper::pattern

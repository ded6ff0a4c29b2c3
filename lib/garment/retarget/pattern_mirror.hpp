#pragma once
/// Which panels of a pattern are each other's mirror images on the two sides of the body, and
/// fields averaged over them.
#include <sloper/pattern/panel_mesh.hpp>

#include <vector>

namespace sloper::garment {

/// How one panel lies on its mirror image: q = linear * p + shift takes its pattern coordinates to
/// the partner's.
struct PanelMirror {
  int partner = -1; ///< panel; itself for a back or a whole front; -1: it has no mirror image
  Eigen::Matrix2d linear = Eigen::Matrix2d::Identity(); ///< a reflection
  Vec2 shift = Vec2::Zero();                            ///< m
  bool grain_across = false;       ///< the partner's weft is this panel's warp: cut on the bias
  double largest_difference_m = 0; ///< between the two outlines
};

/// Compares outlines: each panel with every other one and with itself, turned over in every way
/// that brings corners on corners. Where a panel has several mirror images (two cuffs, top and
/// bottom of a band), where they hang decides.
/// @param panels  outlines and grain   @param position  #V by 3, m: where panel vertices hang on a
/// body that faces +z, left at +x
/// @return by panel; a partner's partner is the panel itself. About 1 ms a pair of like panels.
std::vector<PanelMirror> panel_mirrors(const pattern::PanelMesh& panels,
                                       const std::vector<Vec3>& position);

/// Values at the vertices of a panel where the vertices of its mirror image would lie on it.
/// @param panel, image  the two, which may be one   @param mirror  of `image`: its partner is
/// `panel`
/// @param values  at the panel's vertices, one row each   @return one row for each vertex of
/// `image`
Eigen::MatrixX2d seen_from_mirror(const pattern::PanelMesh& panels, const pattern::PanelInfo& panel,
                                  const pattern::PanelInfo& image, const PanelMirror& mirror,
                                  const Eigen::MatrixX2d& values);

} // namespace sloper::garment

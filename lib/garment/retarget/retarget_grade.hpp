#pragma once
/// Regrading: the flat pattern made over for another body.
#include <sloper/garment/garment.hpp>

#include <map>
#include <sloper/base/message.hpp>

namespace sloper::garment {

/// Limbs ("arm", "leg", "torso") whose two sides the body has so unlike that their panels are
/// graded apart, and why.
struct GradeSides {
  std::map<std::string, std::string> apart;
};

/// What grading did to the pattern.
struct GradeReport {
  int mirrored_panels = 0; ///< graded together with their mirror images
  double largest_seam_change_m =
      0;                         ///< by which the sides of a seam fit each other worse than before
  std::vector<Message> findings; ///< limbs graded apart, seams that no longer match as they did
};

/// Changes the pattern coordinates of every panel so that the cloth has the strain at `after` that
/// it had at `before`.
///
/// Each triangle's map from `before` to `after` gives a stretch along warp and along weft in the
/// pattern plane. Both are smoothed far along their threads, which keeps a thread's length, and
/// hardly across where the garment is bound close to the skin, so that each level has its own
/// girth; where it hangs loose they bend little across, so that outlines are smooth. They are
/// averaged with those of the mirror image on the other side of the body (panel_mirrors), since a
/// pattern that was alike left and right stays so. The panel is laid out again so that its threads
/// have these lengths, their angle nearly free (a Chebyshev net): minimise sum of area |J - T|^2, J
/// the triangle's map from the old layout to the new in the grain's axes, T the nearest map whose
/// columns are as long as weft and warp are to be, drawn a little towards a right angle. The panel
/// keeps its centroid and grain. Rest length edits (rest_scale) stay as factors. Both sides of a
/// seam keep the ratio of lengths that they had, mesh edge by mesh edge, each giving way as little
/// as it must; a straight seam between a panel and its mirror image (center front, center back)
/// leaves its line only where nothing else gives way; the seams' stated lengths are measured again.
/// Stops after 1000 rounds at most; seams that then differ are among the findings.
/// @param before, after  #P by 3, m; `before` on a body that faces +z with its left at +x
/// @param widen_strained_pieces  #F, the logarithm of what weft and warp of a triangle are to be
/// longer by besides; or empty
GradeReport regrade(Garment& garment, const std::vector<Vec3>& before,
                    const std::vector<Vec3>& after, const GradeSides& sides = {},
                    const std::vector<Vec2>& widen_strained_pieces = {});

/// "arm", "leg" or "torso": where most of a panel hangs.
std::string limb_of(const Garment& garment, const pattern::PanelInfo& panel);

} // namespace sloper::garment

#pragma once
/// Which frames every particle of a garment hangs on, and how much on each.
///
/// A particle belongs to the frame of the skin that is nearest and faces the same way; the sharp
/// borders between frames are then spread over the garment by two implicit diffusion steps, (M +
/// s^2 L)^-2: weights are smooth along the cloth, whose two sides of an arm pit stay apart however
/// near they are in space, and no seam is torn.
#include <garment/bind/bind_frames.hpp>
#include <sloper/garment/garment.hpp>

namespace sloper::garment {

/// Whether some piece of the garment wraps both legs together (skirt, dress) rather than each by
/// itself (trousers): below the crotch it has cloth, and at most heights none of it lies between
/// the axes of the legs, however far apart the feet stand.
/// @param positions  #P by 3, m, y up, in the body's frame
/// @param piece      #P, the connected piece of each particle; `which` of them is asked about
/// @param crotch_y   m
/// @return false, too, for a body without legs and for a piece that ends above the crotch. Cost:
/// O(#triangles)
bool wraps_legs_together(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                         const std::vector<int>& piece, int which, const BindFrames& frames,
                         double crotch_y);

/// @return per particle (frame, weight), weight > 0, sum 1, frames ascending
/// @throws Error INPUT when the body has no labelled skin
std::vector<std::vector<std::pair<int, double>>>
bind_weights(const Garment& garment, const body::Body& body, const BindFrames& frames);

} // namespace sloper::garment

#pragma once
/// A draped state on another mesh of the same garment: where an edit asks for new vertices, they
/// start where the cloth hangs.
#include <sloper/garment/garment.hpp>

namespace sloper::garment {

/// Gives a sewn garment another mesh. Each new vertex gets the position of its place in the
/// pattern, by panel: that of the same name (with what was sewn to it and is now part of it, as
/// joining does), else those that are gone (as splitting does). Body parts and materials of panels
/// are kept; rest_scale and bind, which count old vertices, are emptied. Where the new mesh is open
/// and the old one was not, both sides go back by a millimetre, so that they do not start in one
/// place. Cost: new vertices; those beside the old panel times its triangles, and free edges
/// squared.
void transfer_state(Garment& garment, pattern::PanelMesh mesh);

} // namespace sloper::garment

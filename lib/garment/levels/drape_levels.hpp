#pragma once
/// Panels draped through two meshes of their pattern: sewn and relaxed on a coarse one where that
/// is cheap and contracts small differences (soft_sewing.hpp), carried to the given one by panel
/// and place (finer_mesh.hpp), and settled there by a session from a sewn start. A preset finer
/// than `standard` goes on from where `standard` comes to rest, so that what it differs by is the
/// error of that. Measured: docs/decisions/drape-through-levels.md. Test:
/// tests/garment/levels/test_levels.cpp
#include <base/progress.hpp>
#include <body/body.hpp>
#include <garment/garment.hpp>
#include <garment/scene/settings.hpp>
#include <garment/simulate/report.hpp>
#include <garment/simulate/request.hpp>

#include <string>

namespace sloper::garment {

/// Why these panels are not draped through levels; empty: they are. Asks for the pattern that they
/// were made from, edges of at most 30 mm, a body, a garment without scene effects and edited rest
/// lengths, effects "auto" with none switched off, and arms that are not in the way of what is sewn
/// around the lower body.
std::string refusal_of_levels(const Garment& garment, const body::Body* body,
                              const DrapeSettings& settings);

/// drape() of placed panels. Where refusal_of_levels() says so, and where the coarse way fails or
/// ends in crossings, they are draped on the given mesh alone; `repairs` says why. `phases` has
/// "sew coarse" and "carry to the mesh" besides those of a session from a sewn start.
/// @param garment  in: placed panels, particle_of empty; out: the state reached
DrapeReport drape_through_levels(Garment& garment, const body::Body* body,
                                 const DrapeSettings& settings, Reporter& reporter,
                                 const DrapeRequest& request);

} // namespace sloper::garment

#pragma once
/// Places on a garment that a scene names: panels, and runs of their vertices.
#include <sloper/garment/garment.hpp>

#include <string>
#include <vector>

namespace sloper::garment {

/// @param file  document that names it, for the message, and `place`, a JSON pointer there
/// @throws Error INPUT naming the panels when there is none of that name
const pattern::PanelInfo& panel_named(const Garment& garment, const std::string& name,
                                      const std::string& file = {}, const std::string& place = {});

/// The particle of a panel vertex, unsewn or sewn.
int particle_at(const Garment& garment, int vertex);

/// Particles of a fold line, in order: the shortest path over edges of the panel's mesh, through it
/// also where both ends lie on its outline. @throws Error INPUT naming the panels when there is
/// none of that name
std::vector<int> fold_particles(const Garment& garment, const PanelRun& run);

/// Panel vertices of a run, in order. @throws Error INPUT naming the panels when there is none of
/// that name
std::vector<int> run_vertices(const Garment& garment, const PanelRun& run);

/// Particles of a run, neighbours that a seam has welded into one taken once.
std::vector<int> run_particles(const Garment& garment, const PanelRun& run);

} // namespace sloper::garment

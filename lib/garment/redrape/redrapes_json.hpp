#pragma once
/// The key `redrapes` of garment.json: what re-drapes of a garment differ by.
#include <sloper/garment/garment.hpp>
#include <sloper/io/json.hpp>

namespace sloper::garment {

/// @param n_particles  of the garment; a spread of another length is left out
io::Json redrapes_json(const Redrapes& redrapes, std::size_t n_particles);

/// @param node  the key's value
/// @param n_particles  of the garment; spread_m has one number (m) for each
/// @throws Error INPUT for a count or a spread below zero, or a spread of another length
Redrapes read_redrapes(const io::Node& node, std::size_t n_particles);

} // namespace sloper::garment

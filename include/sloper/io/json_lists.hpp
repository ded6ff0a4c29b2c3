#pragma once
/// Lists of plain values in JSON documents.
#include <sloper/geometry/types.hpp>
#include <sloper/io/json_fwd.hpp>

#include <string>
#include <vector>

namespace sloper::io {

/// x, y, z of each point, one after the other.
Json flat_points(const std::vector<Vec3>& points);
/// Those of flat_points(). @throws Error INPUT where the count is no multiple of three, or a value
/// is no number
std::vector<Vec3> read_flat_points(const Node& node);

std::vector<double> read_numbers(const Node& node);      ///< @throws Error INPUT
std::vector<int> read_integers(const Node& node);        ///< @throws Error INPUT
std::vector<std::string> read_strings(const Node& node); ///< @throws Error INPUT

} // namespace sloper::io

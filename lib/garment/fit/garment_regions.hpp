#pragma once
/// Parts of the body that a garment covers, and the class of garment that these make.
#include <sloper/body/body.hpp>
#include <sloper/garment/garment.hpp>

#include <string>
#include <vector>

namespace sloper::garment {

/// Region of each particle by the frame that it is bound to most: "left sleeve", "right leg",
/// "skirt", "collar", "shoulders" above the arm pits, or "trunk".
/// @param garment  bound, at rest on `body`
std::vector<std::string> regions_of(const Garment& garment, const body::Body& body);

/// "top", "trousers", "skirt", "dress" or "whole", by the shares of particles in each region.
/// @param region  of each particle, not empty
std::string class_of(const std::vector<std::string>& region);

} // namespace sloper::garment

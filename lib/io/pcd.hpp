#pragma once
/// Point clouds of the Point Cloud Library: PCD 0.7, ascii, binary and binary_compressed.
#include <sloper/geometry/triangle_mesh.hpp>
#include <string>
#include <string_view>
namespace sloper::io {

/// The points of a PCD file (https://pointclouds.org/documentation/tutorials/pcd_file_format.html);
/// fields other than x, y and z are skipped, and so are points that are not finite, which organised
/// clouds hold where the sensor saw nothing.
/// @param bytes the whole file
/// @param name for messages
/// @return positions in the file's unit, no triangles
/// @throws Error INPUT with the place: no header, no x, y, z, a size or type that there is not, a
/// file that ends early, compressed data that are broken
TriangleMesh parse_pcd(std::string_view bytes, const std::string& name);

} // namespace sloper::io

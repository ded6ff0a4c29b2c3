#pragma once
/// The six parts: which vertex of the skin, and of the scan, belongs to head, torso, arms and legs.
#include <body/landmarks/landmark_finder.hpp>
namespace sloper::body {

/// One part per vertex of the skin, from the landmarks' border planes and the traced arms.
std::vector<Part> label_skin(const Finder& finder);
/// Part of every face: that of two of its corners, the first corner's where all three differ.
std::vector<Part> label_faces(const std::vector<Triangle>& triangles,
                              const std::vector<Part>& vertex_part);
/// Part of every scan vertex: its own skin vertex's where of_scan names one (see SkinSurface), else
/// that of the nearest skin vertex; NONE where is_body is 0 or the skin is farther than `reach` m.
/// @param positions #V by 3, body frame, m
std::vector<Part> label_scan(const std::vector<Vec3>& positions, const std::vector<char>& is_body,
                             const std::vector<int>& of_scan, const TriangleMesh& skin,
                             const std::vector<Part>& skin_part, double reach);

} // namespace sloper::body

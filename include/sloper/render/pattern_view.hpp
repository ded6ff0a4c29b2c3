#pragma once
/// The flat pattern as a picture: panels side by side, warp upwards, with grain, names, sizes and
/// seams in matching colours.
/// Test: tests/render/test_maps.cpp
#include <sloper/render/draw.hpp>
#include <sloper/render/maps.hpp>
#include <sloper/render/scene.hpp>
namespace sloper::render {

/// @param options size, background, map colours and context; the rest is not used
/// @param scene   with garments (or panels); map values of their meshes are shown when `options`
/// has map colours
/// @param name_edges  writes the names of panel edges inside them, small ones aside; outside them
/// those of edges that are asked about, with marks: "1?" asked for in the first question, "1.1" and
/// "1.2" its answers
/// @throws Error USAGE when there is no panel
io::Image draw_pattern(const Scene& scene, const DrawOptions& options, bool name_edges = false);

/// Lower left corner of each panel, m: rows of panels in order of height, filling about
/// `width_over_height`.
/// @param sizes  width and height, m
/// @param gap  m between panels
std::vector<Vec2> pack_panels(const std::vector<Vec2>& sizes, double gap, double width_over_height);

} // namespace sloper::render

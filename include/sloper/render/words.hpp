#pragma once
/// Words of render-png's command line, interpreted. All
/// @throws Error USAGE with words to use instead.
#include <sloper/render/draw.hpp>
#include <sloper/render/scene.hpp>

namespace sloper::render {

/// "800x1000": pixels of one view, 16x16 to 8192x8192.
std::array<int, 2> parse_size(const std::string& text);
/// Samples along a pixel's side that a picture of this size can have for the price of one of 1024 x
/// 1024 with two: 1 to 4.
int samples_for(const std::array<int, 2>& size);
/// "4f7396,b5654a" as 0xRRGGBB.
std::vector<int> parse_colors(const std::string& list);
/// white, grey, transparent (none) or RRGGBB.
std::optional<int> parse_background(const std::string& text);
/// Interprets --fabric: sets the fabric of `options`.
/// @param colors_given  --color was given
/// @return how the cloth is coloured
/// @throws Error INPUT for a print that cannot be read
ClothColors choose_fabric(const std::string& fabric, bool colors_given, const Scene& scene,
                          DrawOptions& options);

/// Refuses a number of views of this size that is too large for one picture.
void check_pixels(const std::array<int, 2>& size, std::size_t views);

} // namespace sloper::render

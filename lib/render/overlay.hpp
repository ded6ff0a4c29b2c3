#pragma once
/// What is laid over and around pictures: text, colour bars, contact sheets, comparison.
#include <io/png.hpp>
#include <render/scene.hpp>
namespace sloper::render {
/// Draws text with its baseline starting at (x, y), `size` pixels high. @throws Error INTERNAL without a font
void draw_text(io::Image& image, const std::string& text, int x, int y, int size, bool centered = false);
/// Colour bar along the right edge with ticks, unit and quantiles.
void draw_legend(io::Image& image, const Legend& legend);
/// Pictures side by side, row by row, each with a caption below (captions may be empty).
io::Image contact_sheet(const std::vector<io::Image>& images, const std::vector<std::string>& captions, int columns);
struct Comparison {
  double ssim = 1;    ///< mean structural similarity of 8 x 8 blocks of the luminance, Wang et al. 2004
  int largest = 0;    ///< largest difference of a channel, 0..255
  long different = 0; ///< pixels that differ by more than 2
  io::Image picture;  ///< the difference, grey where equal
};
/// @throws Error INPUT when the sizes differ
Comparison compare(const io::Image& a, const io::Image& b);
} // namespace sloper::render

#pragma once
/// Overlays and frames of pictures: text, colour bars, contact sheets, comparison.
/// Test: tests/render/test_render.cpp
#include <sloper/io/png.hpp>
#include <sloper/render/maps.hpp>
namespace sloper::render {
/// Where the given x lies on the text.
enum class Align { LEFT, CENTER, RIGHT };
/// Draws UTF-8 text.
/// @param x, y  pixels: `align` end of its baseline
/// @param size  height in pixels
/// @param color  0xRRGGBB
/// @throws Error INTERNAL without a font
void draw_text(io::Image& image, const std::string& text, int x, int y, int size,
               Align align = Align::LEFT, int color = 0x282828);
/// The same on a light halo, to be read on any colour.
void draw_text_halo(io::Image& image, const std::string& text, int x, int y, int size,
                    Align align = Align::LEFT, int color = 0x282828);
int text_width(const std::string& text, int size); ///< pixels
/// A straight line with soft edges.
/// @param x0, y0, x1, y1, width  pixels
/// @param color  0xRRGGBB
/// @param opacity  0..1
void draw_line(io::Image& image, double x0, double y0, double x1, double y1, double width,
               int color, double opacity = 1);
/// A disc, or with `ring` > 0 a ring that wide, with soft edges. Arguments as of
/// draw_line().
void draw_disc(io::Image& image, double x, double y, double radius, int color, double ring = 0,
               double opacity = 1);
/// Colour bar of eight steps along the right edge with ticks, unit and quantiles.
void draw_legend(io::Image& image, const Legend& legend);
/// Pixels that the colour bar takes along the right edge of a picture of this size; 0 without one.
int legend_width(const Legend& legend, int width, int height);
/// Pictures side by side, row by row, each column as wide and each row as high as its largest; a
/// caption below each (captions may be empty).
/// @param columns  at least 1
io::Image contact_sheet(const std::vector<io::Image>& images,
                        const std::vector<std::string>& captions, int columns);
/// How far two pictures differ.
struct Comparison {
  /// Mean structural similarity of 8 x 8 blocks of the luminance, Wang et al. 2004.
  double ssim = 1;
  int largest = 0;    ///< largest difference of a channel, 0..255
  long different = 0; ///< pixels that differ by more than 2
  /// Pixels that differ by more than 32: similarity knows no hues, and a white ground
  /// dilutes it.
  long far = 0;
  long counted = 0;  ///< pixels
  io::Image picture; ///< the difference, grey where equal
};
/// Compares two pictures.
/// @param a, b  of one size
/// @param mask  of the same size: only its bright pixels count; null: all do
/// @throws Error INPUT when the sizes differ, or the mask is dark
Comparison compare(const io::Image& a, const io::Image& b, const io::Image* mask = nullptr);
} // namespace sloper::render

#pragma once
/// Overlays and frames of pictures: text, colour bars, contact sheets, comparison.
/// Test: tests/render/test_render.cpp
#include <sloper/io/png.hpp>
#include <sloper/render/maps.hpp>
namespace sloper::render {
/// Where the given x lies on the text.
enum class Align { LEFT, CENTER, RIGHT };
/// How a text is drawn.
struct Lettering {
  int size;                  ///< height in pixels
  Align align = Align::LEFT; ///< end of the baseline that is given
  int color = 0x282828;      ///< 0xRRGGBB
};
/// Draws UTF-8 text.
/// @param x, y  pixels: the end of its baseline that Lettering::align names
/// @throws Error INTERNAL without a font
void draw_text(io::Image& image, const std::string& text, int x, int y, const Lettering& lettering);
/// The same on a light halo, to be read on any colour.
void draw_text_halo(io::Image& image, const std::string& text, int x, int y,
                    const Lettering& lettering);
int text_width(const std::string& text, int size); ///< pixels
/// How a line is drawn.
struct Stroke {
  double width;       ///< pixels
  int color;          ///< 0xRRGGBB
  double opacity = 1; ///< 0..1
};
/// A straight line with soft edges. Nothing is drawn of one that is longer than 100,000 pixels, or
/// not finite.
/// @param a, b  its ends, pixels
void draw_line(io::Image& image, const Vec2& a, const Vec2& b, const Stroke& stroke);
/// A disc, or with `ring` > 0 a ring that wide, with soft edges.
/// @param center, radius, ring  pixels
/// @param color  0xRRGGBB
/// @param opacity  0..1
void draw_disc(io::Image& image, const Vec2& center, double radius, int color, double ring = 0,
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

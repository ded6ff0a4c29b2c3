#pragma once
/// What is laid over and around pictures: text, colour bars, contact sheets, comparison.
#include <sloper/io/png.hpp>
#include <sloper/render/maps.hpp>
namespace sloper::render {
enum class Align { LEFT, CENTER, RIGHT };
/// Draws UTF-8 text with its baseline at (x, y), `size` pixels high. @throws Error INTERNAL without
/// a font
void draw_text(io::Image& image, const std::string& text, int x, int y, int size,
               Align align = Align::LEFT, int color = 0x282828);
/// The same on a light halo, to be read on any colour.
void draw_text_halo(io::Image& image, const std::string& text, int x, int y, int size,
                    Align align = Align::LEFT, int color = 0x282828);
int text_width(const std::string& text, int size); ///< pixels
/// A straight line with soft edges. @param color 0xRRGGBB @param opacity 0..1
void draw_line(io::Image& image, double x0, double y0, double x1, double y1, double width,
               int color, double opacity = 1);
/// A disc, or with `ring` > 0 a ring that wide, with soft edges.
void draw_disc(io::Image& image, double x, double y, double radius, int color, double ring = 0,
               double opacity = 1);
/// Colour bar of eight steps along the right edge with ticks, unit and quantiles.
void draw_legend(io::Image& image, const Legend& legend);
/// Pixels that the colour bar takes along the right edge of a picture of this size; 0 without one.
int legend_width(const Legend& legend, int width, int height);
/// Pictures side by side, row by row, each column as wide and each row as high as its largest; a
/// caption below each (captions may be empty).
io::Image contact_sheet(const std::vector<io::Image>& images,
                        const std::vector<std::string>& captions, int columns);
struct Comparison {
  double ssim =
      1; ///< mean structural similarity of 8 x 8 blocks of the luminance, Wang et al. 2004
  int largest = 0;    ///< largest difference of a channel, 0..255
  long different = 0; ///< pixels that differ by more than 2
  long far = 0;       ///< pixels that differ by more than 32: similarity knows no hues, and a white
                      ///< ground dilutes it
  long counted = 0;   ///< pixels
  io::Image picture;  ///< the difference, grey where equal
};
/// @param mask  of the same size: only what is bright in it counts; null: everything
/// @throws Error INPUT when the sizes differ, or the mask is dark
Comparison compare(const io::Image& a, const io::Image& b, const io::Image* mask = nullptr);
} // namespace sloper::render

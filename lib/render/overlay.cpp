#include <base/error.hpp>
#include <render/overlay.hpp>

#include <ft2build.h>
#include FT_FREETYPE_H

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace sloper::render {

namespace {

/// One FreeType face, opened once.
FT_Face face() {
  static FT_Face opened = [] {
    FT_Library library = nullptr;
    FT_Face f = nullptr;
    if (FT_Init_FreeType(&library) || FT_New_Face(library, SLOPER_FONT, 0, &f))
      throw Error(ErrorKind::INTERNAL, SLOPER_FONT, "", "the font cannot be opened", "install the package fonts-dejavu-core");
    return f;
  }();
  return opened;
}

void blend(std::uint8_t* pixel, int grey, int alpha) {
  for (int k = 0; k < 3; ++k) pixel[k] = static_cast<std::uint8_t>((pixel[k] * (255 - alpha) + grey * alpha + 127) / 255);
  pixel[3] = static_cast<std::uint8_t>(std::max<int>(pixel[3], alpha));
}

int text_width(const std::string& text) {
  int width = 0;
  for (unsigned char c : text)
    if (!FT_Load_Char(face(), c, FT_LOAD_DEFAULT)) width += static_cast<int>(face()->glyph->advance.x >> 6);
  return width;
}

std::uint8_t to_srgb(double linear) {
  const double s = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(s, 0.0, 1.0)));
}

std::string number(double x) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, std::abs(x) < 10 && x != std::floor(x) ? "%.1f" : "%.0f", x);
  return buffer;
}

} // namespace

void draw_text(io::Image& image, const std::string& text, int x, int y, int size, bool centered) {
  FT_Set_Pixel_Sizes(face(), 0, static_cast<FT_UInt>(size));
  if (centered) x -= text_width(text) / 2;
  for (unsigned char c : text) {
    if (FT_Load_Char(face(), c, FT_LOAD_RENDER)) continue;
    const FT_GlyphSlot glyph = face()->glyph;
    for (unsigned r = 0; r < glyph->bitmap.rows; ++r)
      for (unsigned q = 0; q < glyph->bitmap.width; ++q) {
        const int px = x + glyph->bitmap_left + static_cast<int>(q), py = y - glyph->bitmap_top + static_cast<int>(r);
        if (px >= 0 && py >= 0 && px < image.width && py < image.height) blend(image.at(px, py), 40, glyph->bitmap.buffer[r * glyph->bitmap.pitch + q]);
      }
    x += static_cast<int>(glyph->advance.x >> 6);
  }
}

void draw_legend(io::Image& image, const Legend& legend) {
  const int font = std::max(10, image.height / 55), bar_height = image.height / 2, bar_width = font;
  const int left = image.width - 5 * font, top = image.height / 6;
  for (int y = 0; y < bar_height; ++y) {
    const double t = 1 - (y + 0.5) / bar_height;
    const Vec3 color = scale_color(legend.diverging ? 2 * t - 1 : t, legend.diverging);
    for (int x = left; x < left + bar_width && x < image.width; ++x) {
      std::uint8_t* pixel = image.at(x, top + y);
      for (int k = 0; k < 3; ++k) pixel[k] = to_srgb(color[k]);
      pixel[3] = 255;
    }
  }
  for (int k = 0; k <= 4; ++k)
    draw_text(image, number(legend.high - k * (legend.high - legend.low) / 4) + (k == 0 ? " " + legend.unit : ""), left + bar_width + font / 2,
              top + bar_height * k / 4 + font / 3, font);
  draw_text(image, legend.title, image.width - 9 * font, top - font, font);
  const char* names[] = {"p50 ", "p99 ", "max "};
  const double values[] = {legend.p50, legend.p99, legend.largest};
  for (int k = 0; k < 3; ++k)
    draw_text(image, names[k] + number(values[k]) + " " + legend.unit, image.width - 9 * font, top + bar_height + (2 + k) * font * 3 / 2, font);
}

io::Image contact_sheet(const std::vector<io::Image>& images, const std::vector<std::string>& captions, int columns) {
  int cell_w = 1, cell_h = 1;
  for (const io::Image& i : images) {
    cell_w = std::max(cell_w, i.width);
    cell_h = std::max(cell_h, i.height);
  }
  const bool captioned = std::any_of(captions.begin(), captions.end(), [](const std::string& c) { return !c.empty(); });
  const int font = std::max(10, cell_h / 40), strip = captioned ? 2 * font : 0;
  const int rows = (static_cast<int>(images.size()) + columns - 1) / columns;
  io::Image sheet;
  sheet.width = cell_w * columns;
  sheet.height = (cell_h + strip) * rows;
  if (sheet.width > 16384 || sheet.height > 16384) throw Error(ErrorKind::USAGE, "", "--sheet", "the sheet would be larger than 16384 pixels");
  sheet.rgba.assign(4 * static_cast<std::size_t>(sheet.width) * sheet.height, 255);
  for (std::size_t k = 0; k < images.size(); ++k) {
    const int column = static_cast<int>(k) % columns, row = static_cast<int>(k) / columns;
    const int x0 = column * cell_w + (cell_w - images[k].width) / 2, y0 = row * (cell_h + strip);
    for (int y = 0; y < images[k].height; ++y) std::copy_n(images[k].at(0, y), 4 * images[k].width, sheet.at(x0, y0 + y));
    if (captioned && k < captions.size()) draw_text(sheet, captions[k], column * cell_w + cell_w / 2, y0 + cell_h + font, font, true);
  }
  return sheet;
}

Comparison compare(const io::Image& a, const io::Image& b) {
  if (a.width != b.width || a.height != b.height)
    throw input_error("", "",
                      "the pictures differ in size: " + std::to_string(a.width) + " x " + std::to_string(a.height) + " and " + std::to_string(b.width) + " x " +
                          std::to_string(b.height));
  Comparison result;
  result.picture = a;
  auto luminance = [](const std::uint8_t* p) { return (0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2]) * p[3] / 255.0; };
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      int d = 0;
      for (int k = 0; k < 4; ++k) d = std::max(d, std::abs(a.at(x, y)[k] - b.at(x, y)[k]));
      result.largest = std::max(result.largest, d);
      result.different += d > 2;
      std::uint8_t* out = result.picture.at(x, y);
      const auto grey = static_cast<std::uint8_t>(200 + luminance(a.at(x, y)) / 5);
      out[0] = d > 2 ? 220 : grey;
      out[1] = out[2] = d > 2 ? static_cast<std::uint8_t>(std::max(0, 120 - d)) : grey;
      out[3] = 255;
    }
  double sum = 0;
  long blocks = 0;
  for (int y = 0; y + 8 <= a.height; y += 8)
    for (int x = 0; x + 8 <= a.width; x += 8) {
      double sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
      for (int k = 0; k < 64; ++k) {
        const double la = luminance(a.at(x + k % 8, y + k / 8)), lb = luminance(b.at(x + k % 8, y + k / 8));
        sa += la, sb += lb, saa += la * la, sbb += lb * lb, sab += la * lb;
      }
      const double ma = sa / 64, mb = sb / 64, va = saa / 64 - ma * ma, vb = sbb / 64 - mb * mb, cov = sab / 64 - ma * mb;
      const double c1 = 6.5025, c2 = 58.5225;
      sum += (2 * ma * mb + c1) * (2 * cov + c2) / ((ma * ma + mb * mb + c1) * (va + vb + c2));
      ++blocks;
    }
  if (blocks) result.ssim = sum / static_cast<double>(blocks);
  return result;
}

} // namespace sloper::render

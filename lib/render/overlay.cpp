#include <render/srgb.hpp>
#include <sloper/base/error.hpp>
#include <sloper/base/text.hpp>
#include <sloper/render/overlay.hpp>

#include <ft2build.h>
#include FT_FREETYPE_H

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace sloper::render {

namespace {

constexpr int FULL = 255, BITS = 8;                      // of a channel
constexpr int FREETYPE_BITS = 6;                         // its lengths are in 64ths of a pixel
constexpr int LARGEST_SHEET = 16384;                     // pixels: more than most programs open
constexpr int BRIGHT = 128;                              // of 255: a mask counts from here
constexpr int DIFFERENT_RED = 220, DIFFERENT_PALE = 120; // channels of a pixel that differs
constexpr double RED_LIGHT = 0.2126, GREEN_LIGHT = 0.7152, BLUE_LIGHT = 0.0722; // ITU-R BT.709
constexpr int BLOCK = 8, PIXELS = BLOCK * BLOCK; // of the structural similarity

/// Opens the font. @throws Error INTERNAL where it is not there
FT_Face open_face() {
  FT_Library library = nullptr;
  FT_Face opened = nullptr;
  if (FT_Init_FreeType(&library) || FT_New_Face(library, SLOPER_FONT, 0, &opened))
    throw Error(ErrorKind::INTERNAL, "render.no-font"_id, SLOPER_FONT, "",
                "the font cannot be opened", "install the package fonts-dejavu-core");
  return opened;
}

/// One FreeType face, opened once.
FT_Face face() {
  static FT_Face opened = open_face();
  return opened;
}

void blend(std::uint8_t* pixel, int color, double alpha) {
  const double under = pixel[3] / static_cast<double>(FULL) * (1 - alpha), all = alpha + under;
  if (all <= 0)
    return;
  for (int k = 0; k < 3; ++k) {
    const int over = color >> BITS * (2 - k) & FULL;
    pixel[k] = static_cast<std::uint8_t>(std::lround((over * alpha + pixel[k] * under) / all));
  }
  pixel[3] = static_cast<std::uint8_t>(std::lround(FULL * all));
}

// UTF-8: the first byte of a code point of two, three and four bytes is at least this; each that
// follows has its first bit set, not its second, and six bits of the code point.
constexpr unsigned char CONTINUED = 0x80, OF_TWO = 0xc0, OF_THREE = 0xe0, OF_FOUR = 0xf0;
constexpr int CODE_BITS = 6, CODE_MASK = 0x3f;
constexpr unsigned long NO_CODE_POINT = 0xfffd; // U+FFFD, drawn in its place

/// Bytes that follow the first byte `c` of a code point; -1 where none begins with it.
int bytes_after(unsigned char c) {
  if (c < CONTINUED)
    return 0;
  if (c >= OF_FOUR)
    return 3;
  if (c >= OF_THREE)
    return 2;
  return c >= OF_TWO ? 1 : -1;
}

/// Calls visit(code point) for UTF-8; bytes that are none become U+FFFD.
template<class F> void for_code_points(const std::string& text, F&& visit) {
  for (std::size_t i = 0; i < text.size();) {
    const auto c = static_cast<unsigned char>(text[i++]);
    unsigned long code = c;
    int more = bytes_after(c);
    if (more > 0)
      code = c & (CODE_MASK >> more);
    for (; more > 0 && i < text.size() && (text[i] & OF_TWO) == CONTINUED; --more)
      code = code << CODE_BITS | (text[i++] & CODE_MASK);
    visit(more == 0 ? code : NO_CODE_POINT);
  }
}

constexpr double LONGEST_LINE = 1e5; // pixels: a longer one is of a projection that failed

/// Blends over all pixels of a box by coverage(x, y) of their middles.
template<class F>
void cover(io::Image& image, const Vec2& low, const Vec2& high, int color, F&& coverage) {
  if (!(high.x() >= 0 && high.y() >= 0 && low.x() <= image.width && low.y() <= image.height))
    return;
  const double last_x = std::min<double>(image.width - 1, high.x()),
               last_y = std::min<double>(image.height - 1, high.y());
  for (int y = std::max(0, static_cast<int>(low.y())); y <= last_y; ++y)
    for (int x = std::max(0, static_cast<int>(low.x())); x <= last_x; ++x) {
      const double alpha = std::clamp(coverage(x + 0.5, y + 0.5), 0.0, 1.0);
      if (alpha > 0)
        blend(image.at(x, y), color, alpha);
    }
}

std::string number(double x) {
  return decimals(x, std::abs(x) < 10 && x != std::floor(x) ? 1 : 0);
}

std::string share(double of_one) {
  return of_one < 0.001 ? "< 0.1 %" : percent(of_one);
}

void fill(io::Image& image, int x0, int y0, int x1, int y1, const Vec3& linear) {
  for (int y = std::max(y0, 0); y < std::min(y1, image.height); ++y)
    for (int x = std::max(x0, 0); x < std::min(x1, image.width); ++x) {
      std::uint8_t* pixel = image.at(x, y);
      for (int k = 0; k < 3; ++k) {
        const double number = std::clamp(to_srgb(linear[k]), 0.0, 1.0);
        pixel[k] = static_cast<std::uint8_t>(std::lround(FULL * number));
      }
      pixel[3] = FULL;
    }
}

/// The end of a colour bar: pointed where values lie beyond it. @param direction -1 up, 1 down
/// @param linear null: nothing does
void draw_tip(io::Image& image, int left, int end, int width, int direction, const Vec3* linear) {
  if (!linear)
    return;
  for (int k = 0; k < width / 2; ++k) {
    const int y = direction > 0 ? end + k : end - 1 - k;
    fill(image, left + k, y, left + width - k, y + 1, *linear);
  }
}

} // namespace

int text_width(const std::string& text, int size) {
  FT_Set_Pixel_Sizes(face(), 0, static_cast<FT_UInt>(size));
  int width = 0;
  for_code_points(text, [&](unsigned long code) {
    if (!FT_Load_Char(face(), code, FT_LOAD_DEFAULT))
      width += static_cast<int>(face()->glyph->advance.x >> FREETYPE_BITS);
  });
  return width;
}

void draw_text(io::Image& image, const std::string& text, int x, int y,
               const Lettering& lettering) {
  if (lettering.align != Align::LEFT)
    x -= text_width(text, lettering.size) / (lettering.align == Align::CENTER ? 2 : 1);
  FT_Set_Pixel_Sizes(face(), 0, static_cast<FT_UInt>(lettering.size));
  for_code_points(text, [&](unsigned long code) {
    if (FT_Load_Char(face(), code, FT_LOAD_RENDER))
      return;
    const auto* const glyph = face()->glyph;
    for (unsigned r = 0; r < glyph->bitmap.rows; ++r)
      for (unsigned q = 0; q < glyph->bitmap.width; ++q) {
        const int px = x + glyph->bitmap_left + static_cast<int>(q),
                  py = y - glyph->bitmap_top + static_cast<int>(r);
        if (px < 0 || py < 0 || px >= image.width || py >= image.height)
          continue;
        const int at = static_cast<int>(r) * glyph->bitmap.pitch + static_cast<int>(q);
        blend(image.at(px, py), lettering.color,
              glyph->bitmap.buffer[at] / static_cast<double>(FULL));
      }
    x += static_cast<int>(glyph->advance.x >> FREETYPE_BITS);
  });
}

void draw_text_halo(io::Image& image, const std::string& text, int x, int y,
                    const Lettering& lettering) {
  Lettering light = lettering;
  light.color = 0xffffff;
  for (const auto& [dx, dy] :
       {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, 1}, {-1, 1}, {1, -1}})
    draw_text(image, text, x + dx, y + dy, light);
  draw_text(image, text, x, y, lettering);
}

void draw_line(io::Image& image, const Vec2& a, const Vec2& b, const Stroke& stroke) {
  const double dx = b.x() - a.x(), dy = b.y() - a.y(), length2 = dx * dx + dy * dy;
  if (!std::isfinite(length2) || length2 > LONGEST_LINE * LONGEST_LINE)
    return;
  const Vec2 around = Vec2::Constant(0.5 * stroke.width + 1);
  cover(image, a.cwiseMin(b) - around, a.cwiseMax(b) + around, stroke.color,
        [&](double x, double y) {
          const double along = (x - a.x()) * dx + (y - a.y()) * dy;
          const double t = length2 > 0 ? std::clamp(along / length2, 0.0, 1.0) : 0;
          const double off = std::hypot(x - a.x() - t * dx, y - a.y() - t * dy);
          return stroke.opacity * std::min(1.0, 0.5 * stroke.width + 0.5 - off);
        });
}

void draw_disc(io::Image& image, const Vec2& center, double radius, int color, double ring,
               double opacity) {
  const Vec2 around = Vec2::Constant(radius + 1);
  cover(image, center - around, center + around, color, [&](double x, double y) {
    const double d = std::hypot(x - center.x(), y - center.y());
    return opacity * (ring > 0 ? std::min(1.0, 0.5 * ring + 0.5 - std::abs(d - radius))
                               : std::min(1.0, radius + 0.5 - d));
  });
}

static int legend_font(int width, int height) {
  return std::max(10, std::min(height / 55, width / 36));
}

int legend_width(const Legend& legend, int width, int height) {
  return legend.steps.empty() ? 0 : std::min(width / 2, 8 * legend_font(width, height));
}

/// What stands below a colour bar, line by line.
static std::vector<std::string> legend_notes(const Legend& legend) {
  const std::pair<const char*, double> all[] = {{"min  ", legend.least},
                                                {"p1  ", legend.p1},
                                                {"p50  ", legend.p50},
                                                {"p99  ", legend.p99},
                                                {"max  ", legend.largest}};
  std::vector<std::string> notes;
  for (std::size_t k = legend.diverging ? 0 : 2; k < std::size(all);
       ++k) // what has no other side needs no lower end
    notes.push_back(all[k].first + number(all[k].second) + " " + legend.unit);
  if (legend.beyond > 0)
    notes.push_back("above " + share(legend.beyond));
  if (legend.below > 0)
    notes.push_back("below " + share(legend.below));
  if (legend.has_gaps)
    notes.emplace_back("no value");
  return notes;
}

void draw_legend(io::Image& image, const Legend& legend) {
  if (legend.steps.empty())
    return;
  const std::vector<std::string> notes = legend_notes(legend);
  const int n = static_cast<int>(legend.steps.size()), lines = static_cast<int>(notes.size());
  const int font = legend_font(image.width, image.height), bar_width = 2 * font;
  const int left = image.width - 6 * font, right = image.width - font,
            top = image.height / 8 + 2 * font;
  const auto below_bar = [&](int line) { return (4 + 3 * line) * font / 2 + font / 2; };
  // In a small picture the bar leaves room for what stands below it.
  const int step = std::max(
      2, std::min(image.height / 22, (image.height - font / 2 - below_bar(lines - 1) - top) / n));
  for (int k = 0; k < n; ++k)
    fill(image, left, top + k * step, left + bar_width, top + (k + 1) * step,
         legend.steps[n - 1 - k]);
  draw_tip(image, left, top, bar_width, -1, legend.beyond > 0 ? &legend.steps.back() : nullptr);
  draw_tip(image, left, top + n * step, bar_width, 1,
           legend.below > 0 ? &legend.steps.front() : nullptr);
  const int every = 2 * step < font ? n / 2 : 2; // numbers do not cover each other
  for (int k = 0; k <= n; k += every)
    draw_text_halo(image, number(legend.high - k * (legend.high - legend.low) / n),
                   left + bar_width + font / 2, top + step * k + font * 3 / 8, {.size = font});
  const Lettering at_right = {.size = font, .align = Align::RIGHT};
  draw_text_halo(image, legend.title, right, top - font * 15 / 4, at_right);
  draw_text_halo(image, legend.unit, right, top - font * 19 / 8, at_right);
  for (int line = 0; line < lines; ++line) {
    const std::string& text = notes[line];
    const int y = top + n * step + below_bar(line);
    draw_text_halo(image, text, right, y, at_right);
    if (legend.has_gaps && line == lines - 1) {
      const int x0 = right - text_width(text, font) - 3 * font / 2;
      fill(image, x0, y - font, x0 + font, y, no_value_color());
    }
  }
}

io::Image contact_sheet(const std::vector<io::Image>& images,
                        const std::vector<std::string>& captions, int columns) {
  const std::size_t n = images.size(), across = static_cast<std::size_t>(std::max(columns, 1)),
                    rows = (n + across - 1) / across;
  std::vector<int> left(std::min(n, across) + 1, 0), top(rows + 1, 0);
  std::vector<int> width(left.size(), 1), height(rows, 1);
  for (std::size_t k = 0; k < n; ++k) {
    width[k % across] = std::max(width[k % across], images[k].width);
    height[k / across] = std::max(height[k / across], images[k].height);
  }
  const bool captioned = std::any_of(captions.begin(), captions.end(),
                                     [](const std::string& c) { return !c.empty(); });
  const int font = std::max(10, *std::max_element(height.begin(), height.end()) / 40),
            strip = captioned ? 2 * font : 0;
  for (std::size_t c = 0; c + 1 < left.size(); ++c)
    left[c + 1] = left[c] + width[c];
  for (std::size_t r = 0; r < rows; ++r)
    top[r + 1] = top[r] + height[r] + strip;
  io::Image sheet;
  sheet.width = left.back();
  sheet.height = top.back();
  if (sheet.width > LARGEST_SHEET || sheet.height > LARGEST_SHEET)
    throw Error(ErrorKind::USAGE, "render.too-large"_id, "", "--sheet",
                "the sheet would be larger than " + std::to_string(LARGEST_SHEET) + " pixels");
  sheet.rgba.assign(
      4 * static_cast<std::size_t>(sheet.width) * static_cast<std::size_t>(sheet.height), FULL);
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t column = k % across, row = k / across;
    const int x0 = left[column] + (width[column] - images[k].width) / 2, y0 = top[row];
    for (int y = 0; y < images[k].height; ++y)
      std::copy_n(images[k].at(0, y), 4 * images[k].width, sheet.at(x0, y0 + y));
    if (captioned && k < captions.size())
      draw_text(sheet, captions[k], left[column] + width[column] / 2, y0 + height[row] + font,
                {.size = font, .align = Align::CENTER});
  }
  return sheet;
}

Comparison compare(const io::Image& a, const io::Image& b, const io::Image* mask) {
  if (a.width != b.width || a.height != b.height)
    throw input_error("compare.sizes-differ"_id, "", "",
                      "the pictures differ in size: " + std::to_string(a.width) + " x " +
                          std::to_string(a.height) + " and " + std::to_string(b.width) + " x " +
                          std::to_string(b.height));
  if (mask && (mask->width != a.width || mask->height != a.height))
    throw input_error("compare.sizes-differ"_id, "", "",
                      "the mask's size is not that of the pictures");
  auto counts = [&](int x, int y) {
    return !mask || (mask->at(x, y)[0] >= BRIGHT && mask->at(x, y)[3] >= BRIGHT);
  };
  constexpr int FAR = 32; // of 255: another colour, not another rounding
  Comparison result;
  result.picture = a;
  auto luminance = [](const std::uint8_t* p) {
    return (RED_LIGHT * p[0] + GREEN_LIGHT * p[1] + BLUE_LIGHT * p[2]) * p[3] / FULL;
  };
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      int d = 0;
      for (int k = 0; k < 4 && counts(x, y); ++k)
        d = std::max(d, std::abs(a.at(x, y)[k] - b.at(x, y)[k]));
      result.largest = std::max(result.largest, d);
      result.different += d > 2;
      result.far += d > FAR;
      result.counted += counts(x, y);
      std::uint8_t* out = result.picture.at(x, y);
      const auto grey = static_cast<std::uint8_t>(200 + luminance(a.at(x, y)) / 5);
      out[0] = d > 2 ? DIFFERENT_RED : grey;
      out[1] = out[2] = d > 2 ? static_cast<std::uint8_t>(std::max(0, DIFFERENT_PALE - d)) : grey;
      out[3] = FULL;
    }
  if (result.counted == 0)
    throw input_error("compare.mask-dark"_id, "", "",
                      "the mask is dark everywhere: no pixel counts",
                      "make it bright where pixels are to be compared");
  double sum = 0;
  long blocks = 0;
  for (int y = 0; y + BLOCK <= a.height; y += BLOCK)
    for (int x = 0; x + BLOCK <= a.width; x += BLOCK) {
      double sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
      bool whole = true;
      for (int k = 0; k < PIXELS; ++k)
        whole &= counts(x + k % BLOCK, y + k / BLOCK);
      if (!whole)
        continue;
      for (int k = 0; k < PIXELS; ++k) {
        const int px = x + k % BLOCK, py = y + k / BLOCK;
        const double la = luminance(a.at(px, py)), lb = luminance(b.at(px, py));
        sa += la;
        sb += lb;
        saa += la * la;
        sbb += lb * lb;
        sab += la * lb;
      }
      const double ma = sa / PIXELS, mb = sb / PIXELS;                       // means
      const double va = saa / PIXELS - ma * ma, vb = sbb / PIXELS - mb * mb; // variances
      const double cov = sab / PIXELS - ma * mb;
      const double c1 = 6.5025, c2 = 58.5225; // (0.01 * 255)^2, (0.03 * 255)^2: Wang et al. 2004
      sum += (2 * ma * mb + c1) * (2 * cov + c2) / ((ma * ma + mb * mb + c1) * (va + vb + c2));
      ++blocks;
    }
  if (blocks)
    result.ssim = sum / static_cast<double>(blocks);
  return result;
}

} // namespace sloper::render

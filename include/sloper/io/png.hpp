#pragma once
/// PNG pictures: 8 bit RGBA, sRGB, rows from top to bottom.
#include <cstdint>
#include <string>
#include <utility>
#include <vector>
namespace sloper::io {

/// A picture in memory.
struct Image {
  int width = 0, height = 0;      ///< pixels
  std::vector<std::uint8_t> rgba; ///< 4 width height, not premultiplied
  /// The four bytes of a pixel, counted from the upper left; no check of the range.
  std::uint8_t* at(int x, int y) {
    return rgba.data() + 4 * (static_cast<std::size_t>(y) * width + x);
  }
  /// The same, to read.
  const std::uint8_t* at(int x, int y) const {
    return rgba.data() + 4 * (static_cast<std::size_t>(y) * width + x);
  }
};

/// Bytes of a PNG with sRGB and pHYs chunks and the given text chunks (keyword, text); the same for
/// the same input.
std::string png_bytes(const Image& image,
                      const std::vector<std::pair<std::string, std::string>>& texts);
/// Writes png_bytes() to a file.
/// @throws Error OUTPUT
void write_png(const std::string& path, const Image& image,
               const std::vector<std::pair<std::string, std::string>>& texts);
/// An animated PNG (PNG specification, third edition: acTL, fcTL and fdAT) of pictures of one size,
/// repeated without end; programs that do not know animation show the first picture. @param seconds
/// of one picture, 1/1000 to 60
/// @param texts  as of png_bytes()
/// @throws Error INTERNAL for no pictures or pictures of different sizes
std::string apng_bytes(const std::vector<Image>& images, double seconds,
                       const std::vector<std::pair<std::string, std::string>>& texts);
/// Reads a PNG of any colour type as RGBA.
/// @throws Error INPUT
Image read_png(const std::string& path);

} // namespace sloper::io

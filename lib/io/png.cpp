#include <sloper/base/error.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/png.hpp>

#include <cmath>
#include <csetjmp>
#include <cstring>
#include <png.h>
#include <zlib.h>

namespace sloper::io {

static constexpr unsigned LARGEST = 16384; // pixels a side of a picture that is read

static void append_bytes(png_structp png, png_bytep data, png_size_t size) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(data), size);
}

std::string png_bytes(const Image& image,
                      const std::vector<std::pair<std::string, std::string>>& texts) {
  std::string out;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  if (!info)
    throw Error(ErrorKind::INTERNAL, "general.internal"_id, "", "", "libpng cannot be started");
  std::vector<png_text> chunks;
  for (const auto& [key, text] : texts) {
    png_text t{};
    t.compression = PNG_TEXT_COMPRESSION_NONE;
    t.key = const_cast<char*>(key.c_str());
    t.text = const_cast<char*>(text.c_str());
    t.text_length = text.size();
    chunks.push_back(t);
  }
  if (setjmp(png_jmpbuf(png))) {
    png_destroy_write_struct(&png, &info);
    throw Error(ErrorKind::INTERNAL, "general.internal"_id, "", "",
                "libpng cannot write the picture");
  }
  png_set_write_fn(png, &out, append_bytes, nullptr);
  png_set_compression_level(png, 4);
  png_set_IHDR(png, info, image.width, image.height, 8, PNG_COLOR_TYPE_RGBA, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_set_pHYs(png, info, 5906, 5906, PNG_RESOLUTION_METER); // 150 dots per inch
  if (!chunks.empty())
    png_set_text(png, info, chunks.data(), static_cast<int>(chunks.size()));
  png_write_info(png, info);
  for (int y = 0; y < image.height; ++y)
    png_write_row(png, image.at(0, y));
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return out;
}

void write_png(const std::string& path, const Image& image,
               const std::vector<std::pair<std::string, std::string>>& texts) {
  write_file(path, png_bytes(image, texts));
}

namespace {

// Bytes of a file's signature; of a chunk before its data (length, name) and around it (and check).
constexpr std::size_t SIGNATURE = 8, BEFORE_DATA = 8, AROUND_DATA = 12;

std::string big_endian(std::uint32_t x, int n_bytes = 4) {
  std::string bytes;
  for (int k = n_bytes - 1; k >= 0; --k)
    bytes += static_cast<char>(x >> (8 * k) & 255);
  return bytes;
}

void append_chunk(std::string& to, const std::string& name, std::string_view data) {
  const std::string body = name + std::string(data);
  to += big_endian(static_cast<std::uint32_t>(data.size())) + body;
  to += big_endian(static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()))));
}

/// Calls visit(name, data) for the chunks of a PNG of our own.
template<class F> void for_chunks(const std::string& png, F&& visit) {
  for (std::size_t at = SIGNATURE; at + AROUND_DATA <= png.size();) {
    std::uint32_t size = 0;
    for (int k = 0; k < 4; ++k)
      size = size << 8 | static_cast<unsigned char>(png[at + static_cast<std::size_t>(k)]);
    visit(png.substr(at + 4, 4), std::string_view(png).substr(at + BEFORE_DATA, size));
    at += AROUND_DATA + size;
  }
}

} // namespace

std::string apng_bytes(const std::vector<Image>& images, double seconds,
                       const std::vector<std::pair<std::string, std::string>>& texts) {
  if (images.empty())
    throw Error(ErrorKind::INTERNAL, "general.internal"_id, "", "", "an animation needs pictures");
  std::string out;
  std::uint32_t sequence = 0;
  for (const Image& image : images) {
    if (image.width != images[0].width || image.height != images[0].height)
      throw Error(ErrorKind::INTERNAL, "general.internal"_id, "", "",
                  "the pictures of an animation differ in size");
    const bool first = &image == &images[0];
    const std::string png = png_bytes(image, first ? texts : decltype(texts){});
    if (first)
      out = png.substr(0, SIGNATURE);
    bool opened = false;
    for_chunks(png, [&](const std::string& name, std::string_view data) {
      if (name == "IDAT" && !opened) {
        opened = true;
        if (first)
          append_chunk(out, "acTL",
                       big_endian(static_cast<std::uint32_t>(images.size())) + big_endian(0));
        append_chunk(out, "fcTL",
                     big_endian(sequence++) + big_endian(static_cast<std::uint32_t>(image.width)) +
                         big_endian(static_cast<std::uint32_t>(image.height)) + big_endian(0) +
                         big_endian(0) +
                         big_endian(static_cast<std::uint32_t>(std::lround(1000 * seconds)), 2) +
                         big_endian(1000, 2) +
                         std::string(2, '\0')); // each picture replaces the one before
      }
      if (name == "IDAT" && !first)
        append_chunk(out, "fdAT", big_endian(sequence++) + std::string(data));
      else if (first && name != "IEND")
        append_chunk(out, name, data);
    });
  }
  append_chunk(out, "IEND", "");
  return out;
}

Image read_png(const std::string& path) {
  const std::string bytes = read_file(path);
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()))
    throw input_error("png.unreadable"_id, path, "", "is not a readable PNG",
                      "give a picture that render-png or another program wrote as PNG");
  png.format = PNG_FORMAT_RGBA;
  Image image;
  image.width = static_cast<int>(png.width);
  image.height = static_cast<int>(png.height);
  if (png.width > LARGEST || png.height > LARGEST) {
    png_image_free(&png);
    throw input_error("png.unreadable"_id, path, "",
                      "is larger than " + std::to_string(LARGEST) + " pixels a side",
                      "give a smaller picture");
  }
  image.rgba.resize(PNG_IMAGE_SIZE(png));
  if (!png_image_finish_read(&png, nullptr, image.rgba.data(), 0, nullptr))
    throw input_error("png.unreadable"_id, path, "", "is a damaged PNG", "write it again");
  return image;
}

} // namespace sloper::io

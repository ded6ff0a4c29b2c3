#include <base/error.hpp>
#include <io/files.hpp>
#include <io/png.hpp>

#include <csetjmp>
#include <cstring>
#include <png.h>

namespace sloper::io {

static void append_bytes(png_structp png, png_bytep data, png_size_t size) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(data), size);
}

std::string png_bytes(const Image& image, const std::vector<std::pair<std::string, std::string>>& texts) {
  std::string out;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  if (!info) throw Error(ErrorKind::INTERNAL, "", "", "libpng cannot be started");
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
    throw Error(ErrorKind::INTERNAL, "", "", "libpng cannot write the picture");
  }
  png_set_write_fn(png, &out, append_bytes, nullptr);
  png_set_compression_level(png, 4);
  png_set_IHDR(png, info, image.width, image.height, 8, PNG_COLOR_TYPE_RGBA, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_set_pHYs(png, info, 5906, 5906, PNG_RESOLUTION_METER); // 150 dots per inch
  if (!chunks.empty()) png_set_text(png, info, chunks.data(), static_cast<int>(chunks.size()));
  png_write_info(png, info);
  for (int y = 0; y < image.height; ++y) png_write_row(png, image.at(0, y));
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return out;
}

void write_png(const std::string& path, const Image& image, const std::vector<std::pair<std::string, std::string>>& texts) {
  write_file(path, png_bytes(image, texts));
}

Image read_png(const std::string& path) {
  const std::string bytes = read_file(path);
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_memory(&png, bytes.data(), bytes.size())) throw input_error(path, "", "is not a readable PNG");
  png.format = PNG_FORMAT_RGBA;
  Image image;
  image.width = static_cast<int>(png.width);
  image.height = static_cast<int>(png.height);
  if (png.width > 16384 || png.height > 16384) {
    png_image_free(&png);
    throw input_error(path, "", "is larger than 16384 pixels");
  }
  image.rgba.resize(PNG_IMAGE_SIZE(png));
  if (!png_image_finish_read(&png, nullptr, image.rgba.data(), 0, nullptr)) throw input_error(path, "", "is a damaged PNG");
  return image;
}

} // namespace sloper::io

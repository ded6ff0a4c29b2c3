#include <sloper/base/error.hpp>
#include <sloper/base/text.hpp>
#include <sloper/garment/materials.hpp>
#include <sloper/io/json_fwd.hpp>
#include <sloper/render/words.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace sloper::render {

std::array<int, 2> parse_size(const std::string& text) {
  int w = 0, h = 0;
  char end = 0;
  constexpr int SMALLEST = 16, LARGEST = 8192; // pixels
  const bool is_size = std::sscanf(text.c_str(), "%dx%d%c", &w, &h, &end) == 2;
  if (!is_size || std::min(w, h) < SMALLEST || std::max(w, h) > LARGEST)
    throw Error(ErrorKind::USAGE, "option.wrong-value"_id, "", "--size " + text,
                "is not a size from 16x16 to 8192x8192", "write for example --size 800x1000");
  return {w, h};
}

int samples_for(const std::array<int, 2>& size) {
  if (std::max(size[0], size[1]) > 4096)
    return 1; // four samples a pixel would need gigabytes
  constexpr double MOST = 4.3e6;
  const double pixels = static_cast<double>(size[0]) * size[1];
  int samples = 4;
  while (samples > 2 && pixels * samples * samples > MOST)
    --samples;
  return samples;
}

static int parse_color(const std::string& option, const std::string& word,
                       const std::string& or_else = "") {
  if (word.size() != 6 || word.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos)
    throw Error(ErrorKind::USAGE, "option.wrong-value"_id, "", option + " " + word,
                "is not a colour",
                "write " + or_else + "six hexadecimal digits, for example " + option + " 4f7396");
  return std::stoi(word, nullptr, 16);
}

std::vector<int> parse_colors(const std::string& text) {
  std::vector<int> colors;
  for (const std::string& word : split(text))
    colors.push_back(parse_color("--color", word));
  return colors;
}

std::optional<int> parse_background(const std::string& text) {
  if (text == "transparent")
    return std::nullopt;
  constexpr int WHITE = 0xffffff, GREY = 0xdbdbdb;
  if (text == "white")
    return WHITE;
  if (text == "grey")
    return GREY;
  return parse_color("--background", text, "white, grey, transparent or ");
}

ClothColors choose_fabric(const std::string& fabric, bool colors_given, const Scene& scene,
                          DrawOptions& options) {
  const std::pair<const char*, Fabric> known[] = {{"plain", Fabric::PLAIN},
                                                  {"woven", Fabric::WOVEN},
                                                  {"twill", Fabric::TWILL},
                                                  {"stripes", Fabric::STRIPES},
                                                  {"checks", Fabric::CHECKS}};
  const bool panels = fabric == "panels" || (fabric == "auto" && !scene.draped && !colors_given);
  options.fabric = panels ? Fabric::PLAIN : Fabric::WOVEN;
  if (panels)
    return ClothColors::PANELS;
  for (const auto& [name, kind] : known)
    if (fabric == name)
      return options.fabric = kind, ClothColors::GARMENTS;
  const auto is_denim = [](const garment::Garment& g) {
    return garment::main_material(g) == "denim";
  };
  if (fabric == "auto") {
    if (!scene.garments.empty() &&
        std::all_of(scene.garments.begin(), scene.garments.end(), is_denim))
      options.fabric = Fabric::TWILL;
    return ClothColors::GARMENTS;
  }
  if (io::ending_of(fabric) != ".png") {
    std::vector<std::string> names{"auto", "panels"};
    for (const auto& [name, kind] : known)
      names.emplace_back(name);
    throw unknown_word(
        "--fabric", fabric, names,
        "known are auto, panels, plain, woven, twill, stripes, checks and files ending in .png");
  }
  options.fabric = Fabric::PRINT;
  options.print = io::read_png(fabric);
  return ClothColors::GARMENTS;
}

void check_pixels(const std::array<int, 2>& size, std::size_t views) {
  constexpr double MOST = 268e6; // of one picture: 16384 x 16384, a gigabyte
  const double pixels = static_cast<double>(size[0]) * size[1] * static_cast<double>(views);
  if (pixels <= MOST)
    return;
  throw Error(ErrorKind::USAGE, "render.too-large"_id, "",
              "--size " + std::to_string(size[0]) + "x" + std::to_string(size[1]),
              std::to_string(views) + " views of that size are " +
                  std::to_string(std::llround(pixels / 1e6)) + " million pixels, more than 268",
              "make it smaller, ask for fewer views, or write --as files");
}

} // namespace sloper::render

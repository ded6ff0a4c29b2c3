/// render-png: pictures of bodies, panels and garments without a display.
#include <base/units.hpp>
#include <cli/run_tool.hpp>
#include <io/json.hpp>
#include <render/draw.hpp>
#include <render/overlay.hpp>

#include <cmath>
#include <cstdio>
#include <sstream>

using namespace sloper;

namespace {

struct Options {
  std::vector<std::string> documents;
  std::string view = "front", map = "none", size = "800x1000", background = "white", labels, output;
  bool sheet = false, compare = false;
  int columns = 0;
  double tolerance = 0.98;
};

void add_options(cli::Tool& tool, Options& o) {
  CLI::App& app = tool.app();
  app.add_option("DOC", o.documents, "body.json, shirt.json, panels.json or OBJ files; PNG files with --sheet and --compare")->required();
  app.add_option("--view", o.view, "front, back, left, right, iso or turntable:N (N views on one sheet)")->capture_default_str();
  app.add_option("--map", o.map, "colours: strain, gap, parts or none")->capture_default_str();
  app.add_option("--size", o.size, "WIDTHxHEIGHT of one view, pixels")->capture_default_str();
  app.add_option("--background", o.background, "white, grey or transparent")->capture_default_str();
  app.add_flag("--sheet", o.sheet, "put PNG files side by side");
  app.add_option("--columns", o.columns, "of a sheet; 0 is one row")->check(CLI::Range(0, 64));
  app.add_option("--labels", o.labels, "captions of a sheet, joined by commas");
  app.add_flag("--compare", o.compare, "compare two PNG files: figures to standard output, exit 1 when they differ");
  app.add_option("--tolerance", o.tolerance, "with --compare: least structural similarity")->check(cli::finite_in(0, 1, ""))->capture_default_str();
  app.add_option("-o,--output", o.output, "the PNG; with --compare the difference picture");
  tool.example("render-png -o shirt.png body.json shirt.json", "a dressed body from the front");
  tool.example("render-png --map strain --view iso -o strain.png body.json shirt.json", "where the cloth is stretched");
  tool.example("render-png --sheet --labels before,after -o pair.png a.png b.png", "two pictures side by side");
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  std::stringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  return parts;
}

std::array<int, 2> parse_size(const std::string& text) {
  int w = 0, h = 0;
  char end = 0;
  if (std::sscanf(text.c_str(), "%dx%d%c", &w, &h, &end) != 2 || w < 16 || h < 16 || w > 8192 || h > 8192)
    throw Error(ErrorKind::USAGE, "", "--size " + text, "is not a size from 16x16 to 8192x8192", "write for example --size 800x1000");
  return {w, h};
}

template<class T> T choose(const std::string& option, const std::string& value, std::initializer_list<std::pair<const char*, T>> choices) {
  std::string names;
  for (const auto& [name, choice] : choices) {
    if (value == name) return choice;
    names += (names.empty() ? "" : ", ") + std::string(name);
  }
  throw Error(ErrorKind::USAGE, "", option + " " + value, "is not known", "known are " + names);
}

int run_compare(const Options& o) {
  if (o.documents.size() != 2) throw Error(ErrorKind::USAGE, "", "--compare", "needs two PNG files");
  const render::Comparison c = render::compare(io::read_png(o.documents[0]), io::read_png(o.documents[1]));
  io::write_json("-", {{"ssim", c.ssim}, {"largest_difference", c.largest}, {"different_pixels", c.different}, {"equal", c.ssim >= o.tolerance}});
  if (!o.output.empty()) io::write_png(o.output, c.picture, {{"Software", "render-png"}});
  return c.ssim >= o.tolerance ? 0 : 1;
}

int run_sheet(const Options& o) {
  std::vector<io::Image> images;
  for (const std::string& path : o.documents) images.push_back(io::read_png(path));
  io::write_png(o.output, render::contact_sheet(images, split(o.labels), o.columns > 0 ? o.columns : static_cast<int>(images.size())),
                {{"Software", "render-png"}});
  return 0;
}

int run_render(cli::Tool& tool, const Options& o) {
  render::DrawOptions options;
  const auto size = parse_size(o.size);
  options.width = size[0];
  options.height = size[1];
  using render::Background;
  options.background =
      choose<Background>("--background", o.background, {{"white", Background::WHITE}, {"grey", Background::GREY}, {"transparent", Background::TRANSPARENT}});
  using render::Map;
  const Map map = choose<Map>("--map", o.map, {{"none", Map::NONE}, {"strain", Map::STRAIN}, {"gap", Map::GAP}, {"parts", Map::PARTS}});
  std::vector<std::array<double, 2>> views;
  int turns = 0;
  if (std::sscanf(o.view.c_str(), "turntable:%d", &turns) == 1) {
    if (turns < 1 || turns > 36) throw Error(ErrorKind::USAGE, "", "--view " + o.view, "needs 1 to 36 views");
    for (int k = 0; k < turns; ++k) views.push_back({2 * units::PI * k / turns, units::radians(8)});
  } else {
    views.push_back(render::view_angles(o.view));
  }
  render::Scene scene = render::read_scene(o.documents);
  const render::Legend legend = render::apply_map(scene, map);
  std::size_t triangles = 0;
  for (const render::DrawMesh& m : scene.meshes) triangles += m.triangles.size();
  if (triangles > 150000) options.occlusion_directions = 12; // a large scan: a second is all that there is
  const render::Renderer renderer(scene.meshes, options);
  std::vector<io::Image> images;
  for (const auto& v : views) {
    tool.reporter().progress("draw", static_cast<double>(images.size()) / static_cast<double>(views.size()));
    images.push_back(renderer.draw(render::frame_scene(scene.meshes, v[0], v[1], static_cast<double>(options.width) / options.height)));
    if (map == Map::STRAIN || map == Map::GAP) render::draw_legend(images.back(), legend);
  }
  std::string source;
  for (const std::string& name : scene.names) source += (source.empty() ? "" : ", ") + name;
  io::write_png(o.output,
                images.size() == 1 ? images[0]
                                   : render::contact_sheet(images, {}, o.columns > 0 ? o.columns : std::min<int>(4, static_cast<int>(images.size()))),
                {{"Software", "render-png"}, {"Source", source}});
  return 0;
}

} // namespace

int main(int argc, char** argv) {
  cli::Tool tool("render-png", "Draw bodies, panels and garments into a PNG, without a display");
  Options options;
  add_options(tool, options);
  return tool.run(argc, argv, [&] {
    if (options.compare) return run_compare(options);
    if (options.output.empty()) throw Error(ErrorKind::USAGE, "", "-o", "is missing", "name the PNG to write");
    return options.sheet ? run_sheet(options) : run_render(tool, options);
  });
}

/// render-png: pictures of bodies, panels and garments without a display.
#include <base/units.hpp>
#include <base/version.hpp>
#include <cli/run_tool.hpp>
#include <io/files.hpp>
#include <io/json.hpp>
#include <render/draw.hpp>
#include <render/export.hpp>
#include <render/overlay.hpp>
#include <render/pattern_view.hpp>
#include <render/show.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <sstream>

using namespace sloper;

namespace {

struct Options {
  std::vector<std::string> documents;
  std::string view = "front", camera, map = "none", show, fabric = "auto", colors, size = "800x1000", background = "white", context = "osmesa";
  std::string labels, mask, values, as = "sheet", output;
  bool sheet = false, compare = false;
  int columns = 0;
  double tolerance = 0.98, seconds = 0.1, range = 0, print_size = 0.1, field_height = 0;
};

void add_options(cli::Tool& tool, Options& o) {
  tool.option("DOC", o.documents, "body.json, shirt.json, panels.json, a pattern, OBJ, PLY or STL meshes; PNG files with --sheet and --compare")
      .required()
      .check(cli::input_file());
  tool.option("--view", o.view, "front, back, left, right, iso, pattern (laid flat) or turntable:N; several joined by commas make a sheet")
      .show_default()
      .type_name("LIST");
  tool.option("--camera", o.camera, "camera.json instead of --view").check(cli::input_file());
  tool.option("--field-height", o.field_height, "metres that a picture is high; 0 frames the scene").check(cli::finite_in(0, 1000, "m"));
  tool.option("--map", o.map, "numbers as colours").check(cli::one_of(render::map_names())).show_default();
  tool.option("--range", o.range, "top of the colour scale in the map's unit; 0 picks one").check(cli::finite_in(0, 1e9, ""));
  tool.option("--values", o.values, "write the numbers behind the map: a .csv, or a .ply with a value for each vertex").check(cli::output_file());
  tool.option("--show", o.show, "landmarks, bones, frames, slices, seams, names; joined by commas").type_name("LIST");
  tool.option("--fabric", o.fabric, "auto, panels (a colour each), plain, woven, twill, stripes, checks, or a PNG to print on the cloth")
      .show_default()
      .type_name("NAME");
  tool.option("--print-size", o.print_size, "width of one repeat of a printed PNG").check(cli::finite_in(0.001, 10, "m")).show_default();
  tool.option("--color", o.colors, "cloth colours as RRGGBB, one for each garment, joined by commas").type_name("LIST");
  tool.option("--size", o.size, "WIDTHxHEIGHT of one view, pixels").show_default().type_name("WxH");
  tool.option("--background", o.background, "white, grey, transparent, or a colour as RRGGBB").show_default().type_name("COLOR");
  tool.option("--context", o.context, "what draws: osmesa, or egl (surfaceless)").check(cli::one_of({"osmesa", "egl"})).show_default();
  tool.option("--as", o.as, "several views: one sheet, one animation (APNG), or files of their own, numbered before the ending")
      .check(cli::one_of({"sheet", "animation", "files"}))
      .show_default();
  tool.option("--seconds", o.seconds, "that each picture of an animation is shown").check(cli::finite_in(0.001, 60, "s")).show_default();
  tool.flag("--sheet", o.sheet, "put PNG files side by side");
  tool.option("--columns", o.columns, "of a sheet; 0 is one row").check(cli::finite_in(0, 64, ""));
  tool.option("--labels", o.labels, "captions of a sheet, joined by commas").type_name("LIST");
  tool.flag("--compare", o.compare, "compare two PNG files: figures to standard output, exit 1 when they differ");
  tool.option("--tolerance", o.tolerance, "with --compare: least structural similarity").check(cli::finite_in(0, 1, "")).show_default();
  tool.option("--mask", o.mask, "with --compare: a PNG, bright where pixels count").check(cli::input_file());
  tool.option("-o,--output", o.output, "the PNG, or a .glb, .obj or .ply of the scene; with --compare the difference picture").check(cli::output_file());
  tool.example("render-png -o shirt.png body.json shirt.json", "a dressed body from the front");
  tool.example("render-png --view front,back,left,right -o views.png body.json shirt.json", "four views on one sheet");
  tool.example("render-png --map strain --view iso -o strain.png body.json shirt.json", "where the cloth is stretched");
  tool.example("render-png --view pattern -o pattern.png panels.json", "the pattern, laid flat, seams in colours");
  tool.example("render-png --view turntable:36 --as animation --size 400x500 -o turn.png body.json shirt.json", "a turntable that browsers play");
  tool.example("render-png --show landmarks,slices -o landmarks.png body.json", "what was measured on a scan");
  tool.example("render-png -o shirt.glb body.json shirt.json", "a model for a browser");
  tool.example("render-png --sheet --labels before,after -o pair.png a.png b.png", "two pictures side by side");
  tool.formats("body, garment and panels documents (version 1), pattern files, OBJ, PLY, STL, PNG", "PNG, APNG, GLB, OBJ, PLY, CSV");
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

int parse_color(const std::string& option, const std::string& word, const std::string& or_else = "") {
  if (word.size() != 6 || word.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos)
    throw Error(ErrorKind::USAGE, "", option + " " + word, "is not a colour", "write " + or_else + "six hexadecimal digits, for example " + option + " 4f7396");
  return std::stoi(word, nullptr, 16);
}

std::vector<int> parse_colors(const std::string& text) {
  std::vector<int> colors;
  for (const std::string& word : split(text)) colors.push_back(parse_color("--color", word));
  return colors;
}

/// None for transparent.
std::optional<int> parse_background(const std::string& text) {
  if (text == "transparent") return std::nullopt;
  return text == "white" ? 0xffffff : text == "grey" ? 0xdbdbdb : parse_color("--background", text, "white, grey, transparent or ");
}

/// ".png" of out.PNG; empty where there is none.
std::string ending_of(const std::string& path) {
  const std::string name = io::file_name(path);
  const std::size_t dot = name.rfind('.');
  std::string ending = dot == std::string::npos ? "" : name.substr(dot);
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

/// What --fabric says; sets how the cloth is coloured.
render::ClothColors choose_fabric(const Options& o, const render::Scene& scene, render::DrawOptions& options) {
  using render::Fabric;
  const std::pair<const char*, Fabric> known[] = {
      {"plain", Fabric::PLAIN}, {"woven", Fabric::WOVEN}, {"twill", Fabric::TWILL}, {"stripes", Fabric::STRIPES}, {"checks", Fabric::CHECKS}};
  const bool panels = o.fabric == "panels" || (o.fabric == "auto" && !scene.draped && o.colors.empty());
  options.fabric = panels ? Fabric::PLAIN : Fabric::WOVEN;
  if (panels) return render::ClothColors::PANELS;
  for (const auto& [name, fabric] : known)
    if (o.fabric == name) return options.fabric = fabric, render::ClothColors::GARMENTS;
  if (o.fabric == "auto") return render::ClothColors::GARMENTS;
  if (ending_of(o.fabric) != ".png")
    throw Error(ErrorKind::USAGE, "", "--fabric " + o.fabric, "is not known",
                "known are auto, panels, plain, woven, twill, stripes, checks and files ending in .png");
  options.fabric = Fabric::PRINT;
  options.print = io::read_png(o.fabric);
  options.print_size = o.print_size;
  return render::ClothColors::GARMENTS;
}

int run_compare(const Options& o) {
  if (o.documents.size() != 2) throw Error(ErrorKind::USAGE, "", "--compare", "needs two PNG files");
  io::Image mask;
  if (!o.mask.empty()) mask = io::read_png(o.mask);
  const render::Comparison c = render::compare(io::read_png(o.documents[0]), io::read_png(o.documents[1]), o.mask.empty() ? nullptr : &mask);
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

/// Names that promise something else than what would be written are refused.
void check_output(const std::string& path) {
  const std::string ending = ending_of(path);
  if (ending.empty() || path.rfind("/dev/", 0) == 0 || render::is_export(path)) return;
  if (ending != ".png") throw Error(ErrorKind::USAGE, "", "-o " + path, "is no kind of file that can be written", "end it in .png, .glb, .obj or .ply");
}

/// What --values asks for; refused before anything is drawn.
bool wants_ply(const Options& o) {
  if (o.values.empty()) return false;
  if (o.map == "none" || o.map == "parts") throw Error(ErrorKind::USAGE, "", "--values", "needs a map with numbers", "say for example --map strain");
  const std::string ending = ending_of(o.values);
  if (ending == ".ply") return true;
  if (ending == ".csv" || o.values == "-" || o.values.rfind("/dev/", 0) == 0) return false;
  throw Error(ErrorKind::USAGE, "", "--values " + o.values, "is no kind of file that can be written", "end it in .csv or .ply");
}

void write_pictures(const Options& o, const std::vector<io::Image>& images, const render::Scene& scene) {
  std::string source;
  for (const std::string& name : scene.names) source += (source.empty() ? "" : ", ") + name;
  const std::vector<std::pair<std::string, std::string>> texts = {{"Software", generator_stamp("render-png")}, {"Source", source}};
  if (images.size() > 1 && o.as == "animation") {
    io::write_file(o.output, io::apng_bytes(images, o.seconds, texts));
  } else if (images.size() > 1 && o.as == "files") {
    for (std::size_t k = 0; k < images.size(); ++k) io::write_png(io::numbered_path(o.output, k + 1, images.size()), images[k], texts);
  } else {
    const int columns = o.columns > 0 ? o.columns : std::min<int>(images.size() > 8 ? 6 : 4, static_cast<int>(images.size()));
    io::write_png(o.output, images.size() == 1 ? images[0] : render::contact_sheet(images, split(o.labels), columns), texts);
  }
}

int run_render(cli::Tool& tool, const Options& o) {
  check_output(o.output);
  const bool values_as_ply = wants_ply(o);
  if (o.as == "files" && (o.output == "-" || o.output.rfind("/dev/", 0) == 0))
    throw Error(ErrorKind::USAGE, "", "--as files", "needs a file name to number", "say for example -o turn.png");
  render::DrawOptions options;
  const auto size = parse_size(o.size);
  options.width = size[0];
  options.height = size[1];
  if (std::max(size[0], size[1]) > 4096) options.supersample = 1; // four samples a pixel would need gigabytes
  options.background = parse_background(o.background);
  options.context = o.context == "egl" ? render::ContextKind::EGL : render::ContextKind::OSMESA;
  auto views = o.camera.empty() ? render::parse_views(o.view) : std::vector<std::optional<render::CameraOptions>>{render::read_camera(o.camera)};
  for (auto& v : views)
    if (v && o.camera.empty() && o.field_height > 0) v->field_height = o.field_height;
  const render::Show show = render::parse_show(o.show);
  const std::vector<int> colors = parse_colors(o.colors);
  const auto& maps = render::map_names();
  render::Scene scene = render::read_scene(o.documents);
  const render::Legend legend = render::apply_map(scene, static_cast<render::Map>(std::find(maps.begin(), maps.end(), o.map) - maps.begin()), o.range);
  render::color_cloth(scene, choose_fabric(o, scene, options), colors);
  options.map_colors = legend.steps;
  options.map_low = legend.low;
  options.map_high = legend.high;
  options.ground = scene.body_mesh >= 0;
  if (!o.values.empty()) io::write_file(o.values, values_as_ply ? render::values_ply(scene, legend) : render::values_csv(scene, legend));
  std::vector<render::DrawMesh> meshes = scene.meshes; // the scene keeps its panels' own vertices
  for (render::DrawMesh& mesh : meshes) render::smooth_cloth(mesh);
  if (render::is_export(o.output)) {
    const std::optional<render::Rig> rig = render::make_rig(scene);
    render::export_scene(o.output, meshes, legend, rig ? &*rig : nullptr);
    return 0;
  }
  std::optional<render::Renderer> renderer;
  std::vector<io::Image> images;
  for (const auto& view : views) {
    tool.reporter().progress("draw", static_cast<double>(images.size()) / static_cast<double>(views.size()));
    if (!view) {
      images.push_back(render::draw_pattern(scene, options));
    } else {
      if (!renderer) renderer.emplace(meshes, options).keep_depth(show.any());
      const render::Camera camera = render::frame_scene(meshes, *view, static_cast<double>(options.width) / options.height);
      images.push_back(renderer->draw(camera));
      if (show.any()) render::draw_show(images.back(), scene, camera, *renderer, show);
    }
    render::draw_legend(images.back(), legend);
  }
  write_pictures(o, images, scene);
  return 0;
}

} // namespace

int main(int argc, char** argv) {
  cli::Tool tool("render-png", "Draw bodies, panels and garments into a PNG, without a display");
  Options options;
  add_options(tool, options);
  return tool.run(argc, argv, [&] {
    if (options.compare) return run_compare(options);
    if (options.output.empty()) throw Error(ErrorKind::USAGE, "", "", "--output is missing", "say for example -o shirt.png");
    return options.sheet ? run_sheet(options) : run_render(tool, options);
  });
}

/// render-png: pictures of bodies, panels and garments without a display.
#include "render_options.hpp"

#include <sloper/base/text.hpp>
#include <sloper/base/units.hpp>
#include <sloper/base/version.hpp>
#include <sloper/cli/run_tool.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/json.hpp>
#include <sloper/render/draw.hpp>
#include <sloper/render/export.hpp>
#include <sloper/render/overlay.hpp>
#include <sloper/render/pattern_view.hpp>
#include <sloper/render/show.hpp>
#include <sloper/render/words.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <sstream>

using namespace sloper;
using namespace sloper::render_options;

namespace {

int run_compare(const Options& o) {
  if (o.documents.size() != 2)
    throw Error(ErrorKind::USAGE, "option.wrong-count"_id, "", "--compare", "needs two PNG files");
  io::Image mask;
  if (!o.mask.empty())
    mask = io::read_png(o.mask);
  const render::Comparison c = render::compare(
      io::read_png(o.documents[0]), io::read_png(o.documents[1]), o.mask.empty() ? nullptr : &mask);
  const double share = static_cast<double>(c.far) / static_cast<double>(c.counted);
  const bool equal = c.ssim >= o.tolerance && share <= o.different;
  io::write_json("-", {{"ssim", c.ssim},
                       {"largest_difference", c.largest},
                       {"different_pixels", c.different},
                       {"far_share", share},
                       {"equal", equal}});
  if (!o.output.empty())
    io::write_png(o.output, c.picture, {{"Software", "render-png"}});
  return equal ? 0 : 1;
}

int run_sheet(const Options& o) {
  std::vector<io::Image> images;
  for (const std::string& path : o.documents)
    images.push_back(io::read_png(path));
  io::write_png(o.output,
                render::contact_sheet(images, split(o.labels),
                                      o.columns > 0 ? o.columns : static_cast<int>(images.size())),
                {{"Software", "render-png"}});
  return 0;
}

/// Names that promise something else than what would be written are refused.
void check_output(const std::string& path) {
  const std::string ending = io::ending_of(path);
  if (ending.empty() || path.rfind("/dev/", 0) == 0 || render::is_export(path))
    return;
  if (ending != ".png")
    throw Error(ErrorKind::USAGE, "option.unknown-ending"_id, "", "-o " + path,
                "is no kind of file that can be written", "end it in .png, .glb, .obj or .ply");
}

/// What --values asks for; refused before anything is drawn.
bool wants_ply(const Options& o) {
  if (o.values.empty())
    return false;
  if (o.map == "none" || o.map == "parts")
    throw Error(ErrorKind::USAGE, "option.needs-another"_id, "", "--values",
                "needs a map with numbers", "for example --map strain");
  const std::string ending = io::ending_of(o.values);
  if (ending == ".ply")
    return true;
  if (ending == ".csv" || o.values == "-" || o.values.rfind("/dev/", 0) == 0)
    return false;
  throw Error(ErrorKind::USAGE, "option.unknown-ending"_id, "", "--values " + o.values,
              "is no kind of file that can be written", "end it in .csv or .ply");
}

using Texts = std::vector<std::pair<std::string, std::string>>;

/// What a picture says of itself.
Texts provenance(const render::Scene& scene) {
  std::string source;
  for (const std::string& name : scene.names)
    source += (source.empty() ? "" : ", ") + name;
  return {{"Software", generator_stamp("render-png")}, {"Source", source}};
}

void write_pictures(const Options& o, const std::vector<io::Image>& images, const Texts& texts) {
  if (images.size() > 1 && o.as == "animation") {
    io::write_file(o.output, io::apng_bytes(images, o.seconds, texts));
  } else {
    const int most_columns = images.size() > 8 ? 6 : 4;
    const int columns =
        o.columns > 0 ? o.columns : std::min(most_columns, static_cast<int>(images.size()));
    io::write_png(o.output,
                  images.size() == 1 ? images[0]
                                     : render::contact_sheet(images, split(o.labels), columns),
                  texts);
  }
}

/// What the command line alone says of the drawing.
render::DrawOptions drawing_options(const Options& o) {
  render::DrawOptions options;
  const auto size = render::parse_size(o.size);
  options.print_size = o.print_size;
  options.width = size[0];
  options.height = size[1];
  options.supersample = render::samples_for(size);
  options.background = render::parse_background(o.background);
  options.context = o.context == "egl" ? render::ContextKind::EGL : render::ContextKind::OSMESA;
  return options;
}

/// The cameras asked for; none where the pattern is to be laid flat.
std::vector<std::optional<render::CameraOptions>> views_of(const Options& o) {
  if (!o.camera.empty())
    return {render::read_camera(o.camera)};
  auto views = render::parse_views(o.view);
  for (auto& v : views)
    if (v && o.field_height > 0)
      v->field_height = o.field_height;
  return views;
}

/// What is drawn, and how.
struct Drawing {
  const render::Scene& scene;
  const std::vector<render::DrawMesh>& meshes; ///< of the scene, with smooth cloth
  const render::DrawOptions& options;
  const render::Legend& legend;
  const render::Show& show;
  /// Views without a camera draw the pattern, laid flat.
  std::vector<std::optional<render::CameraOptions>> views;
};

/// Draws from each view and writes the pictures.
void draw_views(cli::Tool& tool, const Options& o, Drawing drawing) {
  const render::Scene& scene = drawing.scene;
  const render::DrawOptions& options = drawing.options;
  const render::Legend& legend = drawing.legend;
  const render::Show& show = drawing.show;
  std::vector<std::optional<render::CameraOptions>>& views = drawing.views;
  std::optional<render::Renderer> renderer;
  std::vector<io::Image> images;
  const Texts texts = provenance(scene);
  std::size_t drawn = 0;
  const bool fits =
      o.camera.empty() &&
      o.field_height == 0; // nobody says how large: labels and legend have room of their own
  const double left = fits ? render::label_share(scene, show, options.width, options.height) : 0;
  const int legend_width = render::legend_width(legend, options.width, options.height);
  const double right = fits ? left + static_cast<double>(legend_width) / options.width : 0;
  if (fits && views.size() > 1)
    render::share_scale(drawing.meshes, views, static_cast<double>(options.width) / options.height,
                        left, right);
  if (o.as != "files")
    render::check_pixels({options.width, options.height}, views.size());
  for (const auto& view : views) {
    tool.require_not_stopped(o.output);
    tool.reporter().progress("draw", static_cast<double>(drawn + images.size()) /
                                         static_cast<double>(views.size()));
    if (!view) {
      images.push_back(render::draw_pattern(scene, options, show.edges));
    } else {
      if (!renderer)
        renderer.emplace(drawing.meshes, options).keep_depth(show.any());
      const render::Camera camera = render::frame_beside(
          drawing.meshes, *view, static_cast<double>(options.width) / options.height, left, right);
      images.push_back(renderer->draw(camera));
      if (show.any())
        render::draw_show(images.back(), scene, camera, *renderer, show, legend_width);
    }
    render::draw_legend(images.back(), legend);
    if (views.size() > 1 && o.as == "files") { // one at a time: there may be hundreds
      io::write_png(io::numbered_path(o.output, ++drawn, views.size()), images.back(), texts);
      images.clear();
    }
  }
  if (!images.empty())
    write_pictures(o, images, texts);
}

int run_render(cli::Tool& tool, const Options& o) {
  check_output(o.output);
  const bool values_as_ply = wants_ply(o);
  if (o.as == "files" && (o.output == "-" || o.output.rfind("/dev/", 0) == 0))
    throw Error(ErrorKind::USAGE, "option.needs-file-name"_id, "", "--as files",
                "needs a file name to number", "for example -o turn.png");
  render::DrawOptions options = drawing_options(o);
  auto views = views_of(o);
  const render::Show show = render::parse_show(o.show);
  const std::vector<int> colors = render::parse_colors(o.colors);
  const auto& maps = render::map_names();
  render::Scene scene = render::read_scene(o.documents);
  for (const Message& finding : scene.findings)
    tool.reporter().warning(finding);
  const render::Legend legend = render::apply_map(
      scene, static_cast<render::Map>(std::find(maps.begin(), maps.end(), o.map) - maps.begin()),
      o.range);
  if (scene.garment_mesh.empty() && (o.fabric != "auto" || !o.colors.empty()))
    tool.reporter().warning(
        {"render.no-cloth-to-color"_id,
         "--fabric and --color are for garments and panels, and none of the documents is one"});
  render::color_cloth(scene, render::choose_fabric(o.fabric, !o.colors.empty(), scene, options),
                      colors);
  options.map_colors = legend.steps;
  options.map_low = legend.low;
  options.map_high = legend.high;
  options.ground = scene.body_mesh >= 0;
  if (!o.values.empty())
    io::write_file(o.values, values_as_ply ? render::values_ply(scene, legend)
                                           : render::values_csv(scene, legend));
  std::vector<render::DrawMesh> meshes = scene.meshes; // the scene keeps its panels' own vertices
  render::smooth_cloth(meshes, render::is_export(o.output));
  if (render::is_export(o.output)) {
    const std::optional<render::Rig> rig = render::make_rig(scene, meshes);
    const render::Print print{options.print, options.print_size};
    render::export_scene(o.output, meshes, legend, rig ? &*rig : nullptr,
                         print.image.rgba.empty() ? nullptr : &print);
    return 0;
  }
  draw_views(tool, o, {scene, meshes, options, legend, show, std::move(views)});
  return 0;
}

} // namespace

int main(int argc, char** argv) {
  cli::Tool tool("render-png", "Draw bodies, panels and garments into a PNG, without a display");
  Options options;
  add_options(tool, options);
  return tool.run(argc, argv, [&] {
    check_options(options);
    for (const Message& warning : passed_over(options))
      tool.reporter().warning(warning);
    if (options.compare)
      return run_compare(options);
    if (options.output.empty())
      throw Error(ErrorKind::USAGE, "option.missing"_id, "", "", "--output is missing",
                  "for example -o shirt.png");
    return options.sheet ? run_sheet(options) : run_render(tool, options);
  });
}

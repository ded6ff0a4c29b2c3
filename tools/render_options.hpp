#pragma once
/// The options of render-png: their texts, and which of them need one another.
#include <sloper/cli/run_tool.hpp>
#include <sloper/io/json_fwd.hpp>
#include <sloper/render/context.hpp>
#include <sloper/render/export.hpp>
#include <sloper/render/maps.hpp>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace sloper::render_options {

/// As the command line has them; empty, 0 or false where an option is not given.
struct Options {
  std::vector<std::string> documents;
  std::string view = "front", camera, map = "none", show, fabric = "auto", colors,
              size = "800x1000", background = "white", context;
  std::string labels, mask, values, as = "sheet", output;
  bool sheet = false, compare = false;
  int columns = 0;
  std::optional<cli::Option> seconds_given, columns_given, labels_given, tolerance_given,
      different_given, mask_given;
  std::vector<std::pair<std::string, cli::Option>> of_pictures; ///< mean nothing to a model
  std::vector<std::pair<std::string, cli::Option>> of_scenes;   ///< nor to PNG files that are given
  std::optional<cli::Option> view_given, field_height_given, range_given, fabric_given,
      colors_given, print_size_given;
  double tolerance = 0.98, different = 0.01, seconds = 0.1, range = 0, print_size = 0.1,
         field_height = 0;
};

inline void add_options(cli::Tool& tool, Options& o) {
  tool.option(
          "DOC", o.documents,
          "body.json, shirt.json, panels.json, a pattern, the questions about it, OBJ, PLY or STL "
          "meshes; PNG files with --sheet and --compare")
      .required()
      .check(cli::input_file());
  o.view_given =
      tool.option(
              "--view", o.view,
              "front, back, left, right, iso, pattern (laid flat) or turntable:N; several joined "
              "by commas make a sheet")
          .show_default()
          .type_name("LIST");
  o.of_pictures.emplace_back("--view", *o.view_given);
  const auto camera =
      tool.option("--camera", o.camera, "camera.json instead of --view").check(cli::input_file());
  o.of_pictures.emplace_back("--camera", camera);
  o.field_height_given = tool.option("--field-height", o.field_height,
                                     "metres that a picture is high; 0 frames the scene")
                             .check(cli::finite_in(0, 1000, "m"));
  o.of_pictures.emplace_back("--field-height", *o.field_height_given);
  const auto map = tool.option("--map", o.map, "numbers as colours")
                       .check(cli::one_of(render::map_names()))
                       .show_default();
  o.of_scenes.emplace_back("--map", map);
  o.range_given =
      tool.option("--range", o.range, "top of the colour scale in the map's unit; 0 picks one")
          .check(cli::finite_in(0, 1e9, ""));
  o.of_scenes.emplace_back("--range", *o.range_given);
  tool.option("--values", o.values,
              "write the numbers behind the map: a .csv, or a .ply with a value for each vertex")
      .check(cli::output_file());
  const auto show =
      tool.option(
              "--show", o.show,
              "landmarks, bones, frames, slices, seams, names, of a flat pattern edges; joined by "
              "commas")
          .type_name("LIST");
  o.of_pictures.emplace_back("--show", show);
  o.fabric_given =
      tool.option("--fabric", o.fabric,
                  "auto, panels (a colour each), plain, woven, twill, stripes, checks, or a PNG to "
                  "print on the cloth")
          .show_default()
          .type_name("NAME");
  o.of_scenes.emplace_back("--fabric", *o.fabric_given);
  o.print_size_given =
      tool.option("--print-size", o.print_size, "width of one repeat of a printed PNG")
          .check(cli::finite_in(0.001, 10, "m"))
          .show_default();
  o.of_scenes.emplace_back("--print-size", *o.print_size_given);
  o.colors_given = tool.option("--color", o.colors,
                               "cloth colours as RRGGBB, one for each garment, joined by commas")
                       .type_name("LIST");
  o.of_scenes.emplace_back("--color", *o.colors_given);
  const auto size = tool.option("--size", o.size, "WIDTHxHEIGHT of one view, pixels")
                        .show_default()
                        .type_name("WxH");
  o.of_pictures.emplace_back("--size", size);
  const auto background =
      tool.option("--background", o.background, "white, grey, transparent, or a colour as RRGGBB")
          .show_default()
          .type_name("COLOR");
  o.of_pictures.emplace_back("--background", background);
  std::vector<std::string> contexts;
  for (const render::ContextKind kind : render::built_contexts())
    contexts.emplace_back(kind == render::ContextKind::EGL ? "egl" : "osmesa");
  o.context = contexts.front();
  const auto context =
      tool.option("--context", o.context, "what draws: osmesa, or egl (surfaceless), as built in")
          .check(cli::one_of(contexts))
          .show_default();
  o.of_pictures.emplace_back("--context", context);
  const auto as =
      tool.option("--as", o.as,
                  "several views: one sheet, one animation (APNG), or files of their own, numbered "
                  "before the ending")
          .check(cli::one_of({"sheet", "animation", "files"}))
          .show_default();
  o.of_pictures.emplace_back("--as", as);
  o.seconds_given =
      tool.option("--seconds", o.seconds, "that each picture of an animation is shown")
          .check(cli::finite_in(0.001, 60, "s"))
          .show_default();
  tool.flag("--sheet", o.sheet, "put PNG files side by side");
  o.columns_given = tool.option("--columns", o.columns, "of a sheet; 0 is one row")
                        .check(cli::finite_in(0, 64, ""));
  o.labels_given =
      tool.option("--labels", o.labels, "captions of a sheet, joined by commas").type_name("LIST");
  tool.flag("--compare", o.compare,
            "compare two PNG files: figures to standard output, exit 1 when they differ");
  o.tolerance_given =
      tool.option("--tolerance", o.tolerance, "with --compare: least structural similarity")
          .check(cli::finite_in(0, 1, ""))
          .show_default();
  o.different_given =
      tool.option("--different", o.different,
                  "with --compare: largest share of pixels that may differ by more than 32 of 255")
          .check(cli::finite_in(0, 1, ""))
          .show_default();
  o.mask_given = tool.option("--mask", o.mask, "with --compare: a PNG, bright where pixels count")
                     .check(cli::input_file());
  tool.option(
          "-o,--output", o.output,
          "the PNG, or a .glb, .obj or .ply of the scene; with --compare the difference picture")
      .check(cli::output_file());
  tool.example("render-png -o shirt.png body.json shirt.json", "a dressed body from the front");
  tool.example("render-png --view front,back,left,right -o views.png body.json shirt.json",
               "four views on one sheet");
  tool.example("render-png --map strain --view iso -o strain.png body.json shirt.json",
               "where the cloth is stretched");
  tool.example("render-png --view pattern -o pattern.png panels.json",
               "the pattern, laid flat, seams in colours");
  tool.example("render-png --view pattern --show edges -o edges.png shirt.pattern.json",
               "the names of the edges that seams join");
  tool.example("render-png --view turntable:36 --as animation --size 400x500 -o turn.png body.json "
               "shirt.json",
               "a turntable that browsers play");
  tool.example("render-png --show landmarks,slices -o landmarks.png body.json",
               "what was measured on a scan");
  tool.example("render-png -o shirt.glb body.json shirt.json", "a model for a browser");
  tool.example("render-png --sheet --labels before,after -o pair.png a.png b.png",
               "two pictures side by side");
  tool.formats("body, garment and panels documents (version 1), pattern files, OBJ, PLY, STL, PNG",
               "PNG, APNG, GLB, OBJ, PLY, CSV");
}

/// An option that would be passed over is refused with what it goes with.
inline void needs(const char* name, const std::optional<cli::Option>& option, bool there,
                  const char* fact, const char* next) {
  if (option->given() && !there)
    throw Error(ErrorKind::USAGE, "option.needs-another"_id, "", name, fact, next);
}

/// Warnings of options that are given and change nothing, each with why.
inline std::vector<Message> passed_over(const Options& o) {
  std::vector<Message> out;
  const auto tell = [&](const std::string& name, const cli::Option& option, bool idle,
                        const std::string& why) {
    if (idle && option.given())
      out.push_back({"option.passed-over"_id, name + " changes nothing: " + why});
  };
  const bool of_files = o.sheet || o.compare;
  const bool model = render::is_export(o.output) && !of_files;
  for (const auto& [name, option] : o.of_scenes)
    tell(name, option, of_files, "the pictures are drawn already");
  for (const auto& [name, option] : o.of_pictures) {
    tell(name, option, of_files, "the pictures are drawn already");
    tell(name, option, model, "it is for pictures, and " + o.output + " is a model");
  }
  if (of_files)
    return out;
  const bool mapped = o.map != "none" && o.map != "parts"; // a map of the body's own
  if (!model) {
    tell("--view", *o.view_given, !o.camera.empty(), "the camera of " + o.camera + " is drawn");
    tell("--field-height", *o.field_height_given, !o.camera.empty(),
         "the camera of " + o.camera + " says how high a picture is");
  }
  tell("--range", *o.range_given, !mapped, "it is the scale of a map; give --map too");
  tell("--fabric", *o.fabric_given, mapped, "the map colours the cloth");
  tell("--color", *o.colors_given, mapped, "the map colours the cloth");
  tell("--print-size", *o.print_size_given, io::ending_of(o.fabric) != ".png" || mapped,
       "no picture is printed on the cloth; give --fabric PNG");
  return out;
}

/// Refuses options that need another one. @throws Error USAGE
inline void check_options(const Options& o) {
  const bool several = o.sheet || o.view.find_first_of(",:") != std::string::npos;
  needs("--mask", o.mask_given, o.compare, "says where pictures are compared",
        "give --compare too");
  needs("--tolerance", o.tolerance_given, o.compare, "says how like compared pictures must be",
        "give --compare too");
  needs("--different", o.different_given, o.compare,
        "says how many pixels of compared pictures may differ", "give --compare too");
  needs("--seconds", o.seconds_given, o.as == "animation", "is for animations",
        "give --as animation too");
  needs("--labels", o.labels_given, several,
        "captions the pictures of a sheet, and there is one picture",
        "ask for several views, or give --sheet");
  needs("--columns", o.columns_given, several, "lays out a sheet, and there is one picture",
        "ask for several views, or give --sheet");
  if (o.show.find("edges") != std::string::npos && o.view.find("pattern") == std::string::npos)
    throw Error(ErrorKind::USAGE, "option.needs-another"_id, "", "--show edges",
                "edges are named on the flat pattern", "give --view pattern too");
}

} // namespace sloper::render_options

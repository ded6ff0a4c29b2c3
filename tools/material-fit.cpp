/// material-fit: cheap tests of a fabric to a material that drape takes.
#include <sloper/base/text.hpp>
#include <sloper/cli/run_tool.hpp>
#include <sloper/garment/drapemeter/material_fit.hpp>
#include <sloper/garment/drapemeter/silhouette.hpp>
#include <sloper/garment/material_json.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/json.hpp>

#include <charconv>
#include <cmath>

using namespace sloper;

namespace {

struct Options {
  std::vector<std::string> pictures, drape_percent, folds, overhang[3];
  std::string name, preset = "cotton-poplin", output, draw;
  double weight = 0, disc = 180, specimen = 300, mm_per_pixel = 0, ruler = 2, shear = 0;
};

constexpr const char* DIRECTIONS[] = {"warp", "weft", "bias"};

void add_options(cli::Tool& tool, Options& o) {
  tool.option(
      "SILHOUETTE", o.pictures,
      "PNG from above: cloth that hangs over the disc, on a ground of another grey, the disc "
      "on top of another grey too; several are drapes of one fabric");
  tool.option("--weight", o.weight, "g/m2: weigh the specimen and divide by its area")
      .required()
      .check(cli::finite_in(5, 5000, "g/m2"));
  tool.option("--preset", o.preset,
              "where what was not measured comes from (stretch, shear, friction): a preset, CSV or "
              "material (default: cotton-poplin)")
      .type_name("NAME");
  tool.option("--shear", o.shear, "N/m: measured, as KES-F or FAST give it; else the preset's")
      .check(cli::finite_in(0.1, 1e5, "N/m"));
  tool.option(
          "--overhang-warp", o.overhang[0],
          "mm that a strip cut along warp hangs over a level edge before its end is 41.5 degrees "
          "below it; repeat for more strips")
      .type_name("MM");
  tool.option("--overhang-weft", o.overhang[1], "the same along weft").type_name("MM");
  tool.option("--overhang-bias", o.overhang[2], "the same at 45 degrees").type_name("MM");
  tool.option("--ruler", o.ruler, "mm: standard error of one overhang (default: 2)")
      .check(cli::finite_in(0.01, 50, "mm"));
  tool.option("--drape-percent", o.drape_percent,
              "drape coefficient, %, where it is known already; repeat for more drapes")
      .type_name("PERCENT");
  tool.option("--folds", o.folds, "folds counted in a drape; repeat for more drapes")
      .type_name("N");
  tool.option("--disc", o.disc, "mm: diameter of the disc, a plate (default: 180)")
      .check(cli::finite_in(20, 1000, "mm"));
  tool.option("--specimen", o.specimen, "mm: diameter of the round specimen (default: 300)")
      .check(cli::finite_in(40, 2000, "mm"));
  tool.option("--mm-per-pixel", o.mm_per_pixel,
              "scale of the pictures, where no disc is to be seen")
      .check(cli::finite_in(1e-3, 100, "mm"));
  tool.option("--name", o.name, "name of the material (default: that of the output)")
      .type_name("NAME");
  tool.option("--draw", o.draw,
              "PNG: how the material found drapes, from above, to be laid beside the picture")
      .check(cli::output_file());
  tool.option("-o,--output", o.output, "material.json, for drape --material and scenes")
      .required()
      .check(cli::document_file());
  tool.example("material-fit --weight 121 --overhang-warp 42 --overhang-weft 36 --overhang-bias 38 "
               "-o poplin.json",
               "three strips over the edge of a table");
  tool.example("material-fit --weight 121 --drape-percent 66 --drape-percent 69 --folds 6 -o "
               "poplin.json",
               "two drapes of which the coefficients are known");
  tool.formats("PNG, material (version 1), CSV of KES-F or FAST values",
               "material (version 1), PNG");
}

std::vector<double> numbers(const char* option, const std::vector<std::string>& texts) {
  std::vector<double> out;
  for (const std::string& text : texts) {
    double value = 0;
    const char* end = text.data() + text.size();
    const auto read = std::from_chars(text.data(), end, value);
    if (read.ec != std::errc() || read.ptr != end || !std::isfinite(value))
      throw Error(ErrorKind::USAGE, "option.wrong-value"_id, "", std::string(option) + " " + text,
                  "is not a number");
    out.push_back(value);
  }
  return out;
}

// A share of 1 is at most 1; the folds of cloth that falls straight down stand out further than 5
// %.
constexpr double LEAST_DRAPE_PERCENT = 5;

/// A share of 1 taken for per cent would be a fabric without any stiffness.
double drape_coefficient(double percent) {
  if (percent > 0 && percent < LEAST_DRAPE_PERCENT) {
    const std::string meant =
        percent <= 1 ? ": " + decimals(100 * percent, 0) + "?" : ", from 5 to 100";
    throw input_error("drapemeter.out-of-range"_id, "", "--drape-percent " + decimals(percent, 2),
                      "is less than any cloth drapes to", "give it in per cent" + meant);
  }
  return 0.01 * percent;
}

garment::FabricTests tests_of(const Options& o) {
  garment::FabricTests tests;
  tests.base = garment::material_from(o.preset);
  tests.base.density_kg_m2 = 1e-3 * o.weight;
  if (o.shear > 0) {
    tests.base.shear_n_m = o.shear;
    tests.shear_error = 0;
  }
  tests.base.name = o.name;
  if (o.name.empty()) {
    const std::string file = io::file_name(o.output);
    tests.base.name = file.substr(0, file.find('.'));
  }
  tests.base.source = "material-fit; what was not measured is of " + o.preset;
  for (int k = 0; k < 3; ++k) {
    const std::string option = std::string("--overhang-") + DIRECTIONS[k];
    for (double mm : numbers(option.c_str(), o.overhang[k]))
      tests.overhang_m[k].push_back(1e-3 * mm);
  }
  tests.length_error_m = 1e-3 * o.ruler;
  for (double percent : numbers("--drape-percent", o.drape_percent))
    tests.coefficient.push_back(drape_coefficient(percent));
  for (double folds : numbers("--folds", o.folds))
    tests.folds.push_back(static_cast<int>(std::lround(folds)));
  tests.setup.disc_radius_m = 0.5e-3 * o.disc;
  tests.setup.specimen_radius_m = 0.5e-3 * o.specimen;
  // 9 mm on the standard's specimen; a larger one bends more widely.
  tests.setup.edge_m *= (tests.setup.specimen_radius_m - tests.setup.disc_radius_m) / 0.06;
  return tests;
}

int run(cli::Tool& tool, const Options& o) {
  if (o.disc >= 0.9 * o.specimen)
    throw Error(ErrorKind::USAGE, "drapemeter.hardly-hangs"_id, "", "--specimen",
                "hardly hangs over the disc", "give diameters that differ by a tenth and more");
  garment::FabricTests tests = tests_of(o);
  const garment::SilhouetteSetup setup{1e-3 * o.disc, 1e-3 * o.specimen, 1e-3 * o.mm_per_pixel};
  for (const std::string& path : o.pictures) {
    const garment::Silhouette s = garment::measure_silhouette(io::read_png(path), path, setup);
    tests.coefficient.push_back(std::clamp(s.coefficient, 1e-6, 1.0));
    tests.folds.push_back(s.folds);
    tool.reporter().info(path + ": drape coefficient " + std::to_string(100 * s.coefficient) +
                         " %, " + std::to_string(s.folds) + " folds, " +
                         std::to_string(1e3 * s.m_per_pixel) + " mm a pixel");
  }
  const garment::MaterialFit fit = garment::fit_material(tests, tool.reporter());
  tool.require_not_stopped(o.output);
  io::write_json(o.output, garment::material_fit_json(fit, tests, tool.name()));
  for (const std::string& what : fit.cannot_tell)
    tool.reporter().warning({"drapemeter.cannot-tell"_id, "cannot tell " + what});
  if (!o.draw.empty()) {
    const garment::DrapemeterResult drape = garment::drape_specimen(fit.material, tests.setup, 1);
    io::write_png(o.draw,
                  garment::draw_silhouette(drape.triangles, drape.position, 1e-3 * o.disc, 800,
                                           1.1e-3 * o.specimen),
                  {});
  }
  return fit.mean && fit.contradiction.empty() ? 0 : static_cast<int>(ErrorKind::FAILED);
}

} // namespace

int main(int argc, char** argv) {
  cli::Tool tool("material-fit", "Find how a fabric bends from cheap tests");
  Options options;
  add_options(tool, options);
  return tool.run(argc, argv, [&] { return run(tool, options); });
}

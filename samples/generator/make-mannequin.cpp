/// Makes a mannequin: a closed body mesh from proportions, girths and a stance, with its landmarks known by construction.
#include "mannequin.hpp"
#include <CLI/CLI.hpp>
#include <base/error.hpp>
#include <cstdio>
#include <io/files.hpp>
#include <io/json.hpp>
#include <io/obj.hpp>

using namespace sloper;

namespace {

struct Options {
  std::string preset, output, truth, parts;
  std::vector<std::string> girths;
  bool list = false;
};

void read_girths(const std::vector<std::string>& texts, samples::Mannequin& shape) {
  for (const std::string& text : texts) {
    const std::size_t equal = text.find('=');
    try {
      if (equal == std::string::npos) throw std::invalid_argument(text);
      shape.girths_m[text.substr(0, equal)] = std::stod(text.substr(equal + 1));
    } catch (const std::logic_error&) {
      throw Error(ErrorKind::USAGE, "", "--girth", "\"" + text + "\" is not NAME=METRES", "for example --girth waist=0.72");
    }
  }
}

void write(const Options& o, const samples::Mannequin& shape) {
  const samples::MadeMannequin made = samples::make_mannequin(shape);
  io::ObjMesh obj;
  obj.positions = made.mesh.positions;
  obj.triangles = made.mesh.triangles;
  io::write_obj(o.output, obj, "mannequin, m, y up, faces +z");
  if (!o.parts.empty()) io::write_file(o.parts, std::string(made.parts.begin(), made.parts.end()));
  if (!o.truth.empty()) {
    io::Json document = made.truth;
    document["mesh"]["file"] = io::file_name(o.output);
    document["name"] = io::file_name(o.output).substr(0, io::file_name(o.output).rfind('.'));
    io::write_json(o.truth, document);
  }
}

} // namespace

int main(int argc, char** argv) {
  CLI::App app("Makes a mannequin (OBJ, m, y up, facing +z) from proportions, girths and a stance.", "make-mannequin");
  app.footer("Examples:\n"
             "  make-mannequin --preset f-165-a -o body.obj\n"
             "  make-mannequin --sex f --stature 1.65 --arm-deg 40 --girth waist=0.72 -o body.obj --truth body.truth.json\n"
             "  make-mannequin --list");
  Options o;
  samples::Mannequin given;
  app.add_option("--preset", o.preset, "A figure of the family by name; the options below change it");
  app.add_flag("--list", o.list, "List the figures and stop");
  auto* sex = app.add_option("--sex", given.sex, "f or m");
  auto* stature = app.add_option("--stature", given.stature_m, "Stature, m");
  auto* bmi = app.add_option("--bmi", given.bmi, "Body mass index; decides the girths that are not given");
  auto* arm = app.add_option("--arm-deg", given.arm_deg, "Angle of the arms from hanging down, 10 to 90");
  auto* leg = app.add_option("--leg-deg", given.leg_deg, "Angle of each leg from vertical, 0 to 15");
  auto* cell = app.add_option("--cell", given.cell_m, "Edge length of the mesh, m");
  app.add_option("--girth", o.girths, "NAME=METRES; neck, bust, underbust, waist, abdomen, hip, thigh, knee, calf, ankle, upper_arm, forearm, wrist");
  app.add_option("-o,--output", o.output, "OBJ file to write");
  app.add_option("--truth", o.truth, "Write landmarks, levels and girths known by construction (JSON)");
  app.add_option("--parts", o.parts, "Write one byte per vertex: 0 head, 1 torso, 2 arm_l, 3 arm_r, 4 leg_l, 5 leg_r");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  try {
    if (o.list) {
      for (const std::string& name : samples::preset_names()) std::printf("%s\n", name.c_str());
      return 0;
    }
    if (o.output.empty()) throw Error(ErrorKind::USAGE, "", "-o", "no output file is given");
    samples::Mannequin shape = o.preset.empty() ? samples::Mannequin{} : samples::preset(o.preset);
    if (*sex) shape.sex = given.sex;
    if (*stature) shape.stature_m = given.stature_m;
    if (*bmi) shape.bmi = given.bmi;
    if (*arm) shape.arm_deg = given.arm_deg;
    if (*leg) shape.leg_deg = given.leg_deg;
    if (*cell) shape.cell_m = given.cell_m;
    read_girths(o.girths, shape);
    write(o, shape);
    return 0;
  } catch (const Error& e) {
    std::fprintf(stderr, "make-mannequin: %s\n", e.what());
    return e.exit_code();
  } catch (const std::exception& e) {
    std::fprintf(stderr, "make-mannequin: %s\n", e.what());
    return static_cast<int>(ErrorKind::INTERNAL);
  }
}

/// Makes a mannequin: a closed body mesh from proportions, girths and a stance, with its landmarks
/// known by construction.
#include "mannequin.hpp"
#include "named_length.hpp"
#include <cstdio>
#include <sloper/base/error.hpp>
#include <sloper/cli/run_tool.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/json.hpp>
#include <sloper/io/obj.hpp>

using namespace sloper;

namespace {

struct Options {
  std::string preset, output, truth, parts;
  std::vector<std::string> girths;
  bool list = false;
};

void read_girths(const std::vector<std::string>& texts, samples::Mannequin& shape) {
  for (const std::string& text : texts) {
    const auto [name, metres] = samples::named_length("--girth", text);
    shape.girths_m[name] = metres;
  }
}

void write(const Options& o, const samples::Mannequin& shape) {
  const samples::MadeMannequin made = samples::make_mannequin(shape);
  io::ObjMesh obj;
  obj.positions = made.mesh.positions;
  obj.triangles = made.mesh.triangles;
  io::write_obj(o.output, obj, "mannequin, m, y up, faces +z");
  if (!o.parts.empty())
    io::write_file(o.parts, std::string(made.parts.begin(), made.parts.end()));
  if (!o.truth.empty()) {
    io::Json document = made.truth;
    document["mesh"]["file"] = io::file_name(o.output);
    document["name"] = io::file_name(o.output).substr(0, io::file_name(o.output).rfind('.'));
    io::write_json(o.truth, document);
  }
}

} // namespace

int main(int argc, char** argv) {
  cli::Tool tool(
      "make-mannequin",
      "Make a mannequin (OBJ, m, y up, facing +z) from proportions, girths and a stance");
  Options o;
  samples::Mannequin given;
  tool.option("--preset", o.preset, "a figure of the family by name; the options below change it")
      .type_name("NAME");
  tool.flag("--list", o.list, "list the figures and stop");
  const cli::Option sex = tool.option("--sex", given.sex, "f or m").type_name("f|m");
  const cli::Option stature =
      tool.option("--stature", given.stature_m, "stature, m").type_name("M");
  const cli::Option bmi =
      tool.option("--bmi", given.bmi, "body mass index; decides the girths that are not given");
  const cli::Option arm =
      tool.option("--arm-deg", given.arm_deg, "angle of the arms from hanging down, 10 to 90");
  const cli::Option leg =
      tool.option("--leg-deg", given.leg_deg, "angle of each leg from vertical, 0 to 15");
  const cli::Option cell =
      tool.option("--cell", given.cell_m, "edge length of the mesh, m").type_name("M");
  tool.option("--girth", o.girths,
              "set one girth, m: neck, bust, underbust, waist, abdomen, hip, thigh, knee, calf, "
              "ankle, upper_arm, forearm or wrist")
      .type_name("NAME=METRES");
  tool.option("-o,--output", o.output, "OBJ file to write").check(cli::output_file());
  tool.option("--truth", o.truth, "write landmarks, levels and girths known by construction (JSON)")
      .check(cli::output_file());
  tool.option("--parts", o.parts,
              "write one byte per vertex: 0 head, 1 torso, 2 arm_l, 3 arm_r, 4 leg_l, 5 leg_r")
      .check(cli::output_file());
  tool.example("make-mannequin --preset f-165-a -o body.obj", "one of the family");
  tool.example("make-mannequin --sex f --stature 1.65 --arm-deg 40 --girth waist=0.72 -o body.obj "
               "--truth body.truth.json",
               "a figure of these measures");
  tool.example("make-mannequin --list", "the names of the family");
  tool.formats("", "OBJ, truth documents (JSON)");
  return tool.run(argc, argv, [&] {
    if (o.list) {
      for (const std::string& name : samples::preset_names())
        std::printf("%s\n", name.c_str());
      return 0;
    }
    if (o.output.empty())
      throw Error(ErrorKind::USAGE, "option.missing"_id, "", "-o", "no output file is given",
                  "for example -o body.obj");
    samples::Mannequin shape = o.preset.empty() ? samples::Mannequin{} : samples::preset(o.preset);
    if (sex.given())
      shape.sex = given.sex;
    if (stature.given())
      shape.stature_m = given.stature_m;
    if (bmi.given())
      shape.bmi = given.bmi;
    if (arm.given())
      shape.arm_deg = given.arm_deg;
    if (leg.given())
      shape.leg_deg = given.leg_deg;
    if (cell.given())
      shape.cell_m = given.cell_m;
    read_girths(o.girths, shape);
    write(o, shape);
    return 0;
  });
}

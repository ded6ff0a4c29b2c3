/// Makes a mannequin: a closed body mesh from proportions, girths and a stance, with its landmarks
/// known by construction.
#include "mannequin.hpp"
#include "named_length.hpp"
#include <cmath>
#include <cstdio>
#include <sloper/base/error.hpp>
#include <sloper/cli/run_tool.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/json.hpp>
#include <sloper/io/obj.hpp>

using namespace sloper;

namespace {

constexpr double NEAR_ENOUGH = 0.005; // m, by which a girth may differ from the one asked for

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

/// Warns of each girth that was asked for and did not come out.
/// @return whether all of them did
bool check_girths(const samples::Mannequin& asked, const samples::MadeMannequin& made,
                  Reporter& reporter) {
  bool all = true;
  for (const auto& [name, value] : asked.girths_m) {
    const double came_out = made.girths_m.at(name);
    if (std::abs(came_out - value) <= NEAR_ENOUGH)
      continue;
    all = false;
    char fact[200];
    std::snprintf(fact, sizeof fact,
                  "--girth %s=%.4g: the figure came out with %.3f m there; ask for a girth nearer "
                  "to it, or change --bmi or the girths beside it too",
                  name.c_str(), value, came_out);
    reporter.warning({"sample.girth-not-had"_id, fact});
  }
  return all;
}

void write(const Options& o, const samples::MadeMannequin& made) {
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
      tool.option("--cell", given.cell_m,
                  "edge length of the mesh, m; it comes out up to a quarter finer where "
                  "the surface closes only so")
          .type_name("M");
  tool.option("--girth", o.girths,
              "set one girth, m: neck, bust, underbust, waist, abdomen, hip, thigh, knee, calf, "
              "ankle, upper_arm, forearm or wrist")
      .type_name("NAME=METRES");
  tool.option("-o,--output", o.output, "OBJ file to write").check(cli::output_file_of(".obj"));
  tool.option("--truth", o.truth, "write landmarks, levels and girths known by construction (JSON)")
      .check(cli::output_file_of(".json"));
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
    const samples::MadeMannequin made = samples::make_mannequin(shape);
    write(o, made);
    return check_girths(shape, made, tool.reporter()) ? 0 : static_cast<int>(ErrorKind::FAILED);
  });
}

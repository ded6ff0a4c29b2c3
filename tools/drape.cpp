/// drape: placed panels or a kept garment to cloth at rest on a body.
#include <body/body_json.hpp>
#include <cli/run_tool.hpp>
#include <garment/bind.hpp>
#include <garment/drape.hpp>
#include <garment/garment_json.hpp>
#include <garment/kes.hpp>
#include <garment/scene.hpp>
#include <io/files.hpp>
#include <pattern/panel_mesh_json.hpp>

using namespace sloper;

namespace {

struct Options {
  std::string scene, body, panels, from, accuracy, effects, material, report, output;
  std::vector<std::string> set;
  double max_seconds = 0;
};

io::Json input_entry(const std::string& path) { return {{"file", io::file_name(path)}, {"sha256", io::sha256(io::read_file(path))}}; }

void add_options(cli::Tool& tool, Options& o) {
  CLI::App& app = tool.app();
  app.add_option("--scene", o.scene, "scene.json: body, panels, materials, effects, settings; options below override it")->check(cli::input_file());
  app.add_option("--body", o.body, "body.json from scan-landmarks")->check(cli::input_file());
  app.add_option("--panels", o.panels, "panels.json from pattern-mesh")->check(cli::input_file());
  app.add_option("--from", o.from, "go on from a garment that drape or retarget-garment wrote")->check(cli::input_file());
  app.add_option("--accuracy", o.accuracy, "how exact, and how long it takes (default: standard)")->check(cli::one_of(garment::accuracy_names()));
  app.add_option("--effects", o.effects, "auto, auto with changes (auto,membrane,-friction), or exactly those of a list (default: auto)")->type_name("LIST");
  app.add_option("--material", o.material,
                 "fabric of panels that name none: a preset such as cotton-poplin, denim, silk, jersey, or a CSV of KES-F or FAST values")
      ->type_name("NAME");
  app.add_option("--set", o.set, "one setting by its name in the report's settings")->type_name("KNOB=VALUE");
  app.add_option("--max-seconds", o.max_seconds, "stop after this wall time, s, with the best state so far (exit 4)")->check(cli::finite_in(0, 1e6, "s"));
  app.add_option("--report", o.report, "write report.json: convergence, effects with calls and time, quality, settings")->check(cli::output_file());
  app.add_option("-o,--output", o.output, "shirt.json; shirt.obj is written beside it")->required()->check(cli::output_file());
  tool.example("drape --body body.json --panels panels.json --report report.json -o shirt.json", "drape a sewn pattern on a scanned body");
  tool.formats("scene, body, panels and garment documents (version 1)", "garment and report documents (version 1), OBJ");
  tool.example("drape --from shirt.json --body body.json --accuracy fine -o shirt-fine.json", "go on, more exactly");
}

garment::DrapeSettings resolve(const Options& o, const garment::Scene& scene) {
  garment::DrapeSettings settings = garment::preset_settings(!o.accuracy.empty() ? o.accuracy : !scene.accuracy.empty() ? scene.accuracy : "standard");
  for (const auto& [name, value] : scene.settings) garment::set_knob(settings, name, value);
  for (const std::string& assignment : o.set) garment::set_knob(settings, assignment);
  if (o.max_seconds > 0) settings.max_seconds = o.max_seconds;
  if (!scene.effects.empty()) settings.effects = scene.effects;
  if (!o.effects.empty()) settings.effects = o.effects;
  return settings;
}

int run(cli::Tool& tool, Options& o) {
  const garment::Scene scene = o.scene.empty() ? garment::Scene{} : garment::read_scene(o.scene);
  if (o.body.empty()) o.body = scene.body;
  if (o.panels.empty()) o.panels = scene.panels;
  if (o.panels.empty() == o.from.empty())
    throw Error(ErrorKind::USAGE, "", "", o.from.empty() ? "nothing to drape" : "both --panels and --from are given",
                "give --panels panels.json or --from shirt.json");
  const garment::DrapeSettings settings = resolve(o, scene);

  io::Json inputs = io::Json::array();
  garment::Garment garment;
  const std::string& source = o.from.empty() ? o.panels : o.from;
  if (o.from.empty()) garment.panels = pattern::read_panel_mesh(o.panels);
  else garment = garment::read_garment(o.from);
  inputs.push_back(input_entry(source));
  garment::apply_scene(scene, garment);
  if (!o.material.empty()) garment.materials[""] = garment::material_from(o.material);

  body::Body body;
  if (!o.body.empty()) {
    body = body::read_body(o.body);
    inputs.push_back(input_entry(o.body));
    const std::string mesh = io::mesh_path_beside(o.body);
    garment.body_sha256 = io::sha256(io::read_file(mesh));
  }
  const garment::DrapeReport report = garment::drape(garment, o.body.empty() ? nullptr : &body, settings, tool.reporter());
  if (!o.body.empty()) garment::bind_garment(garment, body);

  garment::write_garment(o.output, garment, tool.name());
  if (!o.report.empty()) {
    io::Json document = garment::report_json(report, tool.name());
    document["inputs"] = inputs;
    document["hash"] = {{"strict", garment::strict_hash(garment)}, {"quantised_10um", garment::quantised_hash(garment)}};
    io::write_json(o.report, document);
  }
  if (report.converged) return 0;
  tool.reporter().warning("not done: " + report.stop_reason + " after " + std::to_string(report.steps) + " steps; the state reached is in " + o.output);
  return static_cast<int>(ErrorKind::FAILED);
}

} // namespace

int main(int argc, char** argv) {
  cli::Tool tool("drape", "Drape a sewn pattern on a body until the cloth is at rest");
  Options options;
  add_options(tool, options);
  return tool.run(argc, argv, [&] { return run(tool, options); });
}

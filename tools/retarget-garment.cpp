/// retarget-garment: a draped garment on another body, and how it fits there.
#include <body/body_json.hpp>
#include <cli/run_tool.hpp>
#include <garment/bind.hpp>
#include <garment/drape.hpp>
#include <garment/fit.hpp>
#include <garment/garment_json.hpp>
#include <garment/retarget.hpp>
#include <garment/scene.hpp>
#include <io/files.hpp>

using namespace sloper;

namespace {

struct Options {
  std::string garment, to, mode = "keep-fabric", accuracy = "standard", policy, fit, report, output;
  std::vector<std::string> set;
  double max_seconds = 0;
  bool no_drape = false;
};

void add_options(cli::Tool& tool, Options& o) {
  CLI::App& app = tool.app();
  app.add_option("--garment", o.garment, "shirt.json from drape or retarget-garment")->required()->check(cli::input_file());
  app.add_option("--to", o.to, "body.json of the other body, from scan-landmarks")->required()->check(cli::input_file());
  app.add_option("--mode", o.mode, "keep-fabric: the same sewn garment; keep-fit: the pattern is regraded so that the ease stays (default: keep-fabric)")
      ->check(cli::one_of({"keep-fabric", "keep-fit"}));
  app.add_option("--policy", o.policy, "policy.json with limits per girth; exit 1 when the garment does not fit by it")->check(cli::input_file());
  app.add_option("--fit", o.fit, "write fit.json: body, garment, ease, strain, gap and verdict per girth")->check(cli::output_file());
  app.add_option("--report", o.report, "write report.json: placement, convergence, effects, quality, settings")->check(cli::output_file());
  app.add_option("--accuracy", o.accuracy, "how exact the re-drape is (default: standard)")->check(cli::one_of(garment::accuracy_names()));
  app.add_option("--set", o.set, "one setting of the re-drape")->type_name("KNOB=VALUE");
  app.add_option("--max-seconds", o.max_seconds, "stop after this wall time, s, with the best state so far (exit 4)")->check(cli::finite_in(0, 1e6, "s"));
  app.add_flag("--no-drape", o.no_drape, "only place the garment by its coordinates, without a drape");
  app.add_option("-o,--output", o.output, "shirt-b.json; shirt-b.obj is written beside it")->required()->check(cli::output_file());
  tool.example("retarget-garment --garment shirt.json --to other.body.json --fit fit.json -o shirt-b.json", "put a shirt on another body and see how it fits");
  tool.formats("garment, body and fit policy documents (version 1)", "garment, fit and report documents (version 1), OBJ");
  tool.example("retarget-garment --garment shirt.json --to other.body.json --mode keep-fit -o shirt-b.json", "make the shirt over for another body");
}

io::Json input_entry(const std::string& path) { return {{"file", io::file_name(path)}, {"sha256", io::sha256(io::read_file(path))}}; }

/// A garment that cannot go on this body at all: the answer is no, and said so in fit.json.
void refuse_missing_parts(const Options& o, const garment::Garment& garment, const body::Body& body, const std::string& tool) {
  const std::map<std::string, double> missing = garment::missing_frames(garment, body);
  if (missing.empty()) return;
  const std::string reason = "hangs on " + missing.begin()->first + ", which the body lacks";
  if (!o.fit.empty()) {
    garment::FitReport report;
    report.fits = false;
    report.verdict = garment::FitVerdict::TOO_SMALL;
    report.reason = reason;
    io::Json document = garment::fit_json(report, tool);
    document["verdict"] = "impossible";
    io::write_json(o.fit, document);
  }
  throw Error(ErrorKind::FAILED, o.to, "", "the garment " + reason, "give a body with that part, or another garment");
}

int run(cli::Tool& tool, const Options& o) {
  const garment::RetargetMode mode = garment::retarget_mode_from_name(o.mode);
  if (o.output == "-") throw Error(ErrorKind::USAGE, "", "-o", "a garment is two files and cannot go to standard output", "give a file name");
  garment::DrapeSettings settings = garment::preset_settings(o.accuracy);
  for (const std::string& assignment : o.set) garment::set_knob(settings, assignment);
  if (o.max_seconds > 0) settings.max_seconds = o.max_seconds;
  const garment::FitPolicy policy = o.policy.empty() ? garment::standard_fit_policy() : garment::read_fit_policy(o.policy);

  const garment::Garment source = garment::read_garment(o.garment);
  if (source.bind.empty()) throw input_error(o.garment, "/bind", "the garment is not bound to a body", "drape it with --body first");
  const body::Body body = body::read_body(o.to);
  refuse_missing_parts(o, source, body, tool.name());
  const collision::BodyCollider skin(body.skin);

  garment::Retargeted placed = garment::retarget(source, body, skin, mode, tool.reporter());
  garment::Garment& garment = placed.garment;
  garment.body_sha256 = io::sha256(io::read_file(io::mesh_path_beside(o.to)));
  garment::DrapeReport report;
  report.settings = settings;
  report.stop_reason = "placed only";
  if (!o.no_drape) report = garment::drape(garment, &body, settings, tool.reporter());
  garment::bind_garment(garment, body);
  garment::write_garment(o.output, garment, tool.name());

  const garment::FitReport fit = garment::fit_garment(garment, body, skin, policy);
  const io::Json inputs = {input_entry(o.garment), input_entry(o.to)};
  if (!o.fit.empty()) {
    io::Json document = garment::fit_json(fit, tool.name());
    document["converged"] = report.converged;
    document["inputs"] = inputs;
    io::write_json(o.fit, document);
  }
  if (!o.report.empty()) {
    io::Json document = garment::report_json(report, tool.name());
    document["mode"] = o.mode;
    document["placement"] = garment::placement_json(placed.report);
    document["inputs"] = inputs;
    document["hash"] = {{"strict", garment::strict_hash(garment)}, {"quantised_10um", garment::quantised_hash(garment)}};
    io::write_json(o.report, document);
  }
  if (!fit.fits) tool.reporter().warning("the garment " + fit.reason);
  if (!o.no_drape && !report.converged) {
    tool.reporter().warning("not done: " + report.stop_reason + " after " + std::to_string(report.steps) + " steps; the state reached is in " + o.output);
    return static_cast<int>(ErrorKind::FAILED);
  }
  return !o.policy.empty() && !fit.fits ? 1 : 0;
}

} // namespace

int main(int argc, char** argv) {
  cli::Tool tool("retarget-garment", "Put a draped garment on another body");
  Options options;
  add_options(tool, options);
  return tool.run(argc, argv, [&] { return run(tool, options); });
}

/// retarget-garment: a draped garment on another body, and how it fits there.
#include <sloper/body/body_json.hpp>
#include <sloper/cli/run_tool.hpp>
#include <sloper/collision/skin_cache.hpp>
#include <sloper/garment/bind/bind.hpp>
#include <sloper/garment/drape/drape.hpp>
#include <sloper/garment/fit/fit.hpp>
#include <sloper/garment/fit/stretch.hpp>
#include <sloper/garment/garment_json.hpp>
#include <sloper/garment/inputs.hpp>
#include <sloper/garment/retarget/retarget.hpp>
#include <sloper/garment/retarget/retarget_pattern.hpp>
#include <sloper/garment/scene/scene.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/write/export_pattern.hpp>

using namespace sloper;

namespace {

constexpr int MOST_GRADINGS = 4; // with keep-fit, of a garment that comes out too tight

struct Options {
  std::string garment, to, mode = "keep-fabric", accuracy = "standard", policy, fit, fit_csv,
                           fit_page, pattern, report, cache, output;
  std::vector<std::string> set;
  double max_seconds = 0;
  bool no_drape = false;
};

void add_options(cli::Tool& tool, Options& o) {
  tool.option("--garment", o.garment, "shirt.json from drape or retarget-garment")
      .required()
      .check(cli::input_file());
  tool.option("--to", o.to, "body.json of the other body, from scan-landmarks")
      .required()
      .check(cli::input_file());
  tool.option("--mode", o.mode,
              "keep-fabric: the same sewn garment; keep-fit: the pattern is regraded so that the "
              "ease stays (default: keep-fabric)")
      .check(cli::one_of({"keep-fabric", "keep-fit"}));
  tool.option("--policy", o.policy,
              "policy.json with limits per girth; exit 1 when the garment does not fit by it")
      .check(cli::input_file());
  tool.option("--fit", o.fit,
              "write fit.json: body, garment, ease, strain, gap, pressure and verdict per girth")
      .check(cli::output_file());
  tool.option("--fit-csv", o.fit_csv, "write the girths of the fit report as CSV")
      .check(cli::output_file());
  tool.option("--fit-page", o.fit_page, "write the fit report as one HTML page")
      .check(cli::output_file());
  tool.option("--pattern", o.pattern,
              "with keep-fit: write the regraded pattern JSON; its .dxf and its .csv of changes in "
              "cm go beside it")
      .check(cli::output_file());
  tool.option("--report", o.report,
              "write report.json: placement, convergence, effects, quality, settings")
      .check(cli::output_file());
  tool.option("--accuracy", o.accuracy, "how exact the re-drape is (default: standard)")
      .check(cli::one_of(garment::accuracy_names()));
  tool.option("--set", o.set, "one setting of the re-drape").type_name("KNOB=VALUE");
  tool.option("--max-seconds", o.max_seconds,
              "stop after this wall time, s, with the best state so far (exit 4)")
      .check(cli::finite_in(0, 1e6, "s"));
  tool.option("--cache", o.cache,
              "keep prepared bodies in this folder for later runs on the same body: "
              "the same result, sooner")
      .type_name("DIR");
  tool.flag("--no-drape", o.no_drape, "only place the garment by its coordinates, without a drape");
  tool.option("-o,--output", o.output, "shirt-b.json; shirt-b.obj is written beside it")
      .required()
      .check(cli::document_file());
  tool.example(
      "retarget-garment --garment shirt.json --to other.body.json --fit fit.json -o shirt-b.json",
      "put a shirt on another body and see how it fits");
  tool.formats("garment, body and fit policy documents (version 1)",
               "garment, fit and report documents (version 1), OBJ");
  tool.example(
      "retarget-garment --garment shirt.json --to other.body.json --mode keep-fit -o shirt-b.json",
      "make the shirt over for another body");
}

void write_fit(const Options& o, const garment::FitReport& fit, const std::string& tool,
               bool converged, const io::Json& inputs) {
  if (!o.fit.empty()) {
    io::Json document = garment::fit_json(fit, tool);
    document["converged"] = converged;
    document["inputs"] = inputs;
    io::write_json(o.fit, document);
  }
  if (!o.fit_csv.empty()) io::write_file(o.fit_csv, garment::fit_csv(fit));
  if (!o.fit_page.empty())
    io::write_file(o.fit_page,
                   garment::fit_page(fit, io::file_name(o.garment), io::file_name(o.to)));
}

/// The answer is no: said on stderr, with the state that was written, exit 1 under a policy, else
/// 4, since what was asked for could not be made.
int refuse(cli::Tool& tool, const Options& o, const garment::FitReport& fit) {
  std::string written;
  if (fit.state == "placed") written = "; " + o.output + " has it as it was placed, not draped";
  if (fit.state == "not at rest") written = "; " + o.output + " has it as far as the drape came";
  if (fit.state == "not placed") written = "; " + o.output + " is not written";
  tool.reporter().warning("does not fit: the garment " + fit.reason + written);
  return o.policy.empty() ? static_cast<int>(ErrorKind::FAILED) : 1;
}

/// The regraded pattern, as DXF beside it, and what changed.
void write_pattern(cli::Tool& tool, const Options& o, const garment::Garment& regraded,
                   const garment::Garment& source) {
  const pattern::Pattern before = garment::pattern_of(source, source),
                         after = garment::pattern_of(regraded, source);
  const std::string stem =
      o.pattern.substr(0, o.pattern.size() - (o.pattern.ends_with(".json") ? 5 : 0));
  std::vector<std::string> left_out;
  io::write_json(o.pattern, pattern::pattern_json(after, tool.name()));
  io::write_file(stem + ".dxf", pattern::pattern_dxf(after, left_out));
  io::write_file(stem + ".csv", garment::grade_table(before, after));
  for (const std::string& finding : after.findings) tool.reporter().warning(finding);
  for (const std::string& what : left_out)
    tool.reporter().warning(io::file_name(stem) + ".dxf: " + what);
}

int run(cli::Tool& tool, const Options& o) {
  const garment::RetargetMode mode = garment::retarget_mode_from_name(o.mode);
  if (!o.pattern.empty() && mode != garment::RetargetMode::KEEP_FIT)
    throw Error(ErrorKind::USAGE, "", "--pattern", "keep-fabric does not change the pattern",
                "say --mode keep-fit");
  if (o.pattern == "-")
    throw Error(ErrorKind::USAGE, "", "--pattern",
                "a regraded pattern is three files and cannot go to standard output",
                "give a file name");
  garment::DrapeSettings settings = garment::preset_settings(o.accuracy);
  for (const std::string& assignment : o.set) garment::set_knob(settings, assignment);
  if (o.max_seconds > 0) settings.max_seconds = o.max_seconds;
  garment::FitPolicy policy =
      o.policy.empty() ? garment::standard_fit_policy() : garment::read_fit_policy(o.policy);

  const garment::Garment source = garment::read_garment(o.garment);
  if (o.policy.empty()) { // what it bears on its own body
    const garment::Stretch worn = garment::stretch_of(source);
    if (source.converged && worn.p99 <= worn.bound)
      policy.worn_p99 = worn.p99, policy.worn_max = worn.max;
  }
  if (source.bind.empty())
    throw input_error(o.garment, "/bind", "the garment is not bound to a body",
                      "drape it with --body first");
  body::Body body = body::read_body(o.to);
  body.skin_cache = std::make_shared<collision::SkinCache>(o.cache, tool.reporter());
  const std::string skin_hash = body::skin_sha256(o.to);
  const io::Json inputs = {garment::input_entry(o.garment), garment::input_entry(o.to)};
  if (const std::string reason = garment::why_impossible(source, body); !reason.empty()) {
    const garment::FitReport fit = garment::impossible_fit(reason, policy);
    write_fit(o, fit, tool.name(), false, inputs);
    return refuse(tool, o, fit);
  }
  const collision::BodyCollider skin = collision::make_collider(body.skin, body.skin_cache.get());

  garment::Retargeted placed = garment::retarget(source, body, skin, mode, tool.reporter());
  garment::Garment& garment = placed.garment;
  garment.body_sha256 = skin_hash;
  garment::FitReport fit;
  if (!o.no_drape) fit = garment::fit_before_drape(garment, source.position, body, policy);
  garment::DrapeReport report;
  report.settings = settings;
  report.stop_reason = garment::StopReason::PLACED_ONLY;
  const bool hopeless = !fit.fits, keep_fit = mode == garment::RetargetMode::KEEP_FIT;
  if (hopeless) {
    report.stop_reason = garment::StopReason::NOT_DRAPED;
    report.stop_detail = fit.reason;
  }
  const garment::DrapeRequest request{.bounds = garment::early_termination_bounds(policy, fit),
                                      .start = {.hold_sleeve_ends = placed.has_folded_sleeves}};
  for (;;) {
    if (!o.no_drape && !hopeless)
      report = garment::drape(garment, &body, settings, tool.reporter(), request);
    garment::bind_garment(garment, body);
    if (hopeless) break;
    const auto& made_for =
        keep_fit ? garment.body_girths_m : source.body_girths_m; // keep-fit cuts it anew
    fit = garment::fit_garment(garment, body, skin, policy, &placed.placed,
                               garment::misfit_text(report.misfit), made_for);
    const bool too_tight = !fit.fits && fit.verdict == garment::FitVerdict::TOO_SMALL;
    if (!keep_fit || o.no_drape || !too_tight || placed.report.gradings == MOST_GRADINGS) break;
    if (settings.max_seconds > 0 && (settings.max_seconds -= report.wall_s) <= 0) break;
    tool.reporter().info("the garment " + fit.reason + ": let out there");
    garment::widen_strained_pieces(placed, source, body);
  }
  garment::write_garment(o.output, garment, tool.name());
  if (!o.pattern.empty()) write_pattern(tool, o, garment, source);
  for (const std::string& finding : placed.report.findings) tool.reporter().warning(finding);
  if (const std::string why = garment::why_stuck(garment, body);
      fit.fits && !o.no_drape && !report.converged && !why.empty())
    fit.fits = false, fit.verdict = garment::FitVerdict::IMPOSSIBLE, fit.reason = why;
  if (o.no_drape) fit.state = "placed";
  write_fit(o, fit, tool.name(), report.converged, inputs);
  if (!o.report.empty()) {
    io::Json document = garment::report_json(report, tool.name());
    document["mode"] = o.mode;
    document["placement"] = garment::placement_json(placed.report);
    document["findings"] = placed.report.findings;
    document["inputs"] = inputs;
    document["hash"] = {{"strict", garment::strict_hash(garment)},
                        {"quantised_10um", garment::quantised_hash(garment)}};
    io::write_json(o.report, document);
  }
  if (!o.no_drape && !hopeless && !report.converged && report.misfit == garment::Misfit::NONE)
    tool.reporter().warning("not done: " + garment::stop_text(report) + " after " +
                            std::to_string(report.steps) + " steps; the state reached is in " +
                            o.output);
  if (!fit.fits && !o.no_drape) return refuse(tool, o, fit);
  return report.converged || o.no_drape ? 0 : static_cast<int>(ErrorKind::FAILED);
}

} // namespace

int main(int argc, char** argv) {
  cli::Tool tool("retarget-garment", "Put a draped garment on another body");
  Options options;
  add_options(tool, options);
  return tool.run(argc, argv, [&] { return run(tool, options); });
}

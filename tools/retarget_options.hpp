#pragma once
/// The options of retarget-garment: their texts, and which of them exclude or need one another.
#include <sloper/cli/run_tool.hpp>
#include <sloper/garment/fit/fit_policy.hpp>
#include <sloper/garment/materials.hpp>
#include <sloper/garment/retarget/retarget_job.hpp>
#include <sloper/garment/scene/scene.hpp>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace sloper::retarget_options {

/// As the command line has them; empty, 0 or false where an option is not given.
struct Options {
  std::string garment, from, fabric, to, mode = "keep-fabric", accuracy = "standard", policy, fit,
                                         fit_csv, fit_page, pattern, report, cache, output;
  std::vector<std::string> set;
  double max_seconds = 0;
  bool no_drape = false, nearest_size = false;
  std::vector<std::pair<std::string, cli::Option>> of_drapes; ///< mean nothing to --no-drape
};

/// Name of the built-in policy, which --policy takes beside files.
inline constexpr const char* BUILT_IN_POLICY = "woven";

/// A policy document, "-" or the built-in policy by its name. A file of that name comes first.
inline cli::Check policy_file() {
  cli::Check check = cli::input_file();
  const auto fault = check.fault;
  check.fault = [fault](const std::string& path) -> std::string {
    return path == BUILT_IN_POLICY && !std::filesystem::exists(path) ? "" : fault(path);
  };
  return check;
}

/// The policy that --policy names; without it the built-in one.
inline garment::FitPolicy policy_of(const std::string& path) {
  const bool built_in = path.empty() || (path == BUILT_IN_POLICY && !std::filesystem::exists(path));
  return built_in ? garment::standard_fit_policy() : garment::read_fit_policy(path);
}

/// The names of the preset fabrics.
inline std::vector<std::string> fabric_names() {
  std::vector<std::string> names;
  for (const garment::Material& m : garment::material_presets())
    names.push_back(m.name);
  return names;
}

inline void add_options(cli::Tool& tool, Options& o) {
  tool.option("--garment", o.garment,
              "shirt.json from drape or retarget-garment; or a mesh without a pattern (OBJ, PLY, "
              "GLB), with --from")
      .required()
      .check(cli::input_file());
  tool.option("--from", o.from, "of a mesh: body.json of the body that wears it in the file")
      .check(cli::input_file());
  tool.option("--fabric", o.fabric, "of a mesh: its fabric (default: cotton-poplin)")
      .check(cli::one_of(fabric_names()));
  tool.flag("--nearest-size", o.nearest_size,
            "of NAME@SIZE.json take the size beside it whose own body is nearest to the other one, "
            "by the "
            "girths that the garment goes round");
  tool.option("--to", o.to, "body.json of the other body, from scan-landmarks")
      .required()
      .check(cli::input_file());
  tool.option("--mode", o.mode,
              "keep-fabric: the same sewn garment; keep-fit: the pattern is regraded to keep the "
              "ease of close girths (default: keep-fabric)")
      .check(cli::one_of({"keep-fabric", "keep-fit"}));
  tool.option(
          "--policy", o.policy,
          "policy.json with limits per girth, or woven: the built-in limits, as they stand; exit "
          "1 when the garment does not fit by it")
      .check(policy_file());
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
  o.of_drapes.emplace_back(
      "--accuracy",
      tool.option("--accuracy", o.accuracy, "how exact the re-drape is (default: standard)")
          .check(cli::one_of(garment::accuracy_names())));
  o.of_drapes.emplace_back(
      "--set", tool.option("--set", o.set, "one setting of the re-drape").type_name("KNOB=VALUE"));
  o.of_drapes.emplace_back(
      "--max-seconds",
      tool.option("--max-seconds", o.max_seconds,
                  "stop after this wall time, s, with the best state so far (exit 4)")
          .check(cli::finite_in(0, 1e6, "s")));
  tool.option("--cache", o.cache,
              "keep prepared bodies in this folder for later runs on the same body: "
              "the same result, sooner")
      .type_name("DIR");
  tool.flag("--no-drape", o.no_drape, "only place the garment by its coordinates, without a drape");
  tool.option("-o,--output", o.output,
              "shirt-b.json; shirt-b.obj is written beside it. Of a mesh: also shirt-b.mesh.EXT, "
              "the file on the other body; or NAME.EXT for that alone")
      .required()
      .check(cli::document_or_mesh_file());
  tool.example(
      "retarget-garment --garment shirt.json --to other.body.json --fit fit.json -o shirt-b.json",
      "put a shirt on another body and see how it fits");
  tool.example("retarget-garment --garment shirt.obj --from body.json --to other.body.json -o "
               "shirt-b.obj",
               "put a mesh that has no pattern on another body; it comes out as it came in");
  tool.formats("garment, body and fit policy documents (version 1)",
               "garment, fit and report documents (version 1), OBJ");
  tool.example(
      "retarget-garment --garment shirt.json --to other.body.json --mode keep-fit -o shirt-b.json",
      "make the shirt over for another body");
}

/// Warnings of options that are given and change nothing, each with why.
inline std::vector<Message> passed_over(const Options& o) {
  std::vector<Message> out;
  for (const auto& [name, option] : o.of_drapes)
    if (o.no_drape && option.given())
      out.push_back(
          {"option.passed-over"_id, name + " changes nothing: with --no-drape there is no drape"});
  return out;
}

/// Refuses options that do not fit together. @param mode  that of o @throws Error USAGE
inline void check_options(const Options& o, garment::RetargetMode mode) {
  if (!o.pattern.empty() && mode != garment::RetargetMode::KEEP_FIT)
    throw Error(ErrorKind::USAGE, "option.conflict"_id, "", "--pattern",
                "keep-fabric does not change the pattern", "say --mode keep-fit");
  if (o.pattern == "-")
    throw Error(ErrorKind::USAGE, "option.needs-file-name"_id, "", "--pattern",
                "a regraded pattern is three files and cannot go to standard output",
                "give a file name");
}

} // namespace sloper::retarget_options

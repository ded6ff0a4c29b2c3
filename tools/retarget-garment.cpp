/// retarget-garment: a draped garment on another body, and how it fits there.
#include "retarget_options.hpp"

#include <sloper/body/body_json.hpp>
#include <sloper/cli/run_tool.hpp>
#include <sloper/collision/skin_cache.hpp>
#include <sloper/garment/bind/bind.hpp>
#include <sloper/garment/drape/judge_faults.hpp>
#include <sloper/garment/drape/judge_roll_lines.hpp>
#include <sloper/garment/fit/fit.hpp>
#include <sloper/garment/fit/stretch.hpp>
#include <sloper/garment/fit/worn_policy.hpp>
#include <sloper/garment/garment_json.hpp>
#include <sloper/garment/ingest/mesh_garment.hpp>
#include <sloper/garment/inputs.hpp>
#include <sloper/garment/materials.hpp>
#include <sloper/garment/retarget/nearest_size.hpp>
#include <sloper/garment/retarget/retarget_job.hpp>
#include <sloper/garment/retarget/retarget_pattern.hpp>
#include <sloper/garment/scene/scene.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/json.hpp>
#include <sloper/io/mesh_file.hpp>
#include <sloper/pattern/write/export_pattern.hpp>

using namespace sloper;
using namespace sloper::retarget_options;

namespace {

/// @param findings  of the garment and of this run; of the garment those of pattern-mesh come first
void write_fit(const Options& o, garment::FitReport fit, const std::vector<Message>& findings,
               const std::string& tool, bool converged, const io::Json& inputs) {
  fit.mode = o.mode;
  fit.findings = findings;
  if (!o.fit.empty()) {
    io::Json document = garment::fit_json(fit, tool);
    document["converged"] = converged;
    document["inputs"] = inputs;
    io::write_json(o.fit, document);
  }
  if (!o.fit_csv.empty())
    io::write_file(o.fit_csv, garment::fit_csv(fit));
  if (!o.fit_page.empty())
    io::write_file(o.fit_page,
                   garment::fit_page(fit, io::file_name(o.garment), io::file_name(o.to)));
}

/// What a reader of the fit report alone has to know: what pattern-mesh found on the garment, then
/// what this run found.
std::vector<Message> fit_findings(const garment::Garment& source,
                                  const std::vector<Message>& of_run) {
  std::vector<Message> findings = source.panels.findings;
  findings.insert(findings.end(), of_run.begin(), of_run.end());
  return findings;
}

/// The answer is no: said on stderr, with the state that was written, exit 1 under a policy, else
/// 4, since what was asked for could not be made.
int refuse(cli::Tool& tool, const Options& o, const garment::FitReport& fit) {
  std::string written;
  if (fit.state == "placed")
    written = "; " + o.output + " has it as it was placed, not draped";
  if (fit.state == "not at rest")
    written = "; " + o.output + " has it as far as the drape came";
  if (fit.state == "not placed")
    written = "; " + o.output + " is not written";
  std::string rule = garment::rule_text(fit.rule, fit.policy);
  if (!rule.empty())
    rule = "; the rule is " + rule + ": --policy FILE gives others (POLICY in the manual page)";
  tool.reporter().warning(
      {"retarget.does-not-fit"_id, "does not fit: the garment " + fit.reason + rule + written});
  return o.policy.empty() ? static_cast<int>(ErrorKind::FAILED) : 1;
}

/// A garment whose strain is unknown fits as far as is known: what that leaves open.
void tell_unknown_strain(cli::Tool& tool, const Options& o, const garment::FitReport& fit) {
  if (const std::string text = garment::unknown_strain_text(fit); !text.empty())
    tool.reporter().warning({"retarget.strain-unknown"_id, io::file_name(o.garment) + " " + text});
}

/// What is put on: a garment, and the mesh file that it was where it has no pattern.
struct Source {
  garment::Garment garment;
  std::optional<garment::MeshGarment> mesh;
};

Source read_source(cli::Tool& tool, const Options& o) {
  if (!io::is_mesh_file(o.garment)) {
    cli::refuse_together({"--garment of a document", true},
                         {{"--from", !o.from.empty()}, {"--fabric", !o.fabric.empty()}});
    if (const std::string fault = cli::document_file().fault(o.output); !fault.empty())
      throw Error(ErrorKind::USAGE, "option.unknown-ending"_id, "", "--output", fault);
    return {garment::read_garment(o.garment), {}};
  }
  if (o.from.empty())
    throw Error(ErrorKind::USAGE, "option.needs-another"_id, "", "--from",
                "a mesh does not say which body wears it", "give the body.json of that body");
  if (io::is_mesh_file(o.output) && io::ending_of(o.output) != io::ending_of(o.garment))
    throw Error(ErrorKind::USAGE, "option.unknown-ending"_id, "", "--output",
                "the mesh comes out as it came in, as " + io::ending_of(o.garment),
                "end the name so, or with .json");
  body::Body from = body::read_body(o.from);
  for (const Message& finding : from.file_findings)
    tool.reporter().warning(finding);
  from.skin_cache = std::make_shared<collision::SkinCache>(o.cache, tool.reporter());
  Source source;
  source.mesh = garment::read_mesh_garment(
      o.garment, from, collision::make_collider(from.skin, from.skin_cache.get()),
      body::skin_sha256(o.from), o.fabric.empty() ? garment::Material().name : o.fabric,
      tool.reporter());
  source.garment = source.mesh->garment;
  for (const Message& finding : source.mesh->findings)
    tool.reporter().warning(finding);
  return source;
}

/// The file of a mesh with its vertices on the other body. @return whether more crosses than before
bool write_mesh(cli::Tool& tool, const Options& o, const garment::MeshGarment& mesh,
                const garment::DressedMesh& dressed) {
  std::string path = o.output;
  if (!io::is_mesh_file(path))
    path = path.substr(0, path.size() - (path.ends_with(".json") ? 5 : 0)) + ".mesh" +
           io::ending_of(o.garment);
  io::write_file(path, dressed.bytes);
  for (const std::string& left : io::copy_companions(mesh.file, path))
    tool.reporter().warning({"import.file-left-out"_id, io::file_name(path) + ": " + left});
  bool worse = false;
  const auto compare = [&](int now, int before, const std::string& what) {
    if (now <= before)
      return;
    worse = true;
    tool.reporter().warning({"import.crosses-more"_id, io::file_name(path) + ": " +
                                                           std::to_string(now) + what + ", " +
                                                           std::to_string(before) + " as it came"});
  };
  compare(dressed.crossings, mesh.crossings, " pairs of faces cross");
  compare(dressed.faces_through, mesh.faces_through, " faces go through the body");
  return worse;
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
  for (const Message& finding : after.findings)
    tool.reporter().warning(finding);
  for (const std::string& what : left_out)
    tool.reporter().warning({"dxf.not-written"_id, io::file_name(stem) + ".dxf: " + what});
}

/// What became of the garment's roll lines. One that is not turned over is a finding; one that
/// stands, and did not where the garment came from, is a failure.
std::vector<garment::RollLineState> judge_rolls(const Options& o, const garment::Garment& source,
                                                garment::RetargetOutcome& outcome) {
  garment::Garment& garment = outcome.retargeted.garment;
  const std::vector<garment::RollLineState> states = garment::roll_line_states(garment);
  for (const Message& finding : garment::unturned_findings(states, o.garment))
    outcome.retargeted.report.findings.push_back(finding);
  if (outcome.was_draped() && garment::standing_text(garment::roll_line_states(source)).empty())
    garment::fail_where_one_stands(states, garment, outcome.report);
  return states;
}

/// What the report says beside the drape.
struct Retargeted {
  const garment::RetargetOutcome& outcome; ///< with all findings
  const std::vector<garment::RollLineState>& rolls;
  const Source& source;
  const std::optional<garment::DressedMesh>& dressed; ///< of a mesh without a pattern
  const garment::SizeRanking& sizes;                  ///< with --nearest-size
  const io::Json& inputs;
};

void write_report(const Options& o, const Retargeted& all, const std::string& tool) {
  const garment::Garment& garment = all.outcome.retargeted.garment;
  io::Json document = garment::report_json(all.outcome.report, tool);
  document["mode"] = o.mode;
  document["placement"] = garment::placement_json(all.outcome.retargeted.report);
  if (!all.rolls.empty())
    document["roll_lines"] = garment::roll_lines_json(all.rolls);
  io::put_findings(document, all.outcome.retargeted.report.findings);
  if (all.dressed)
    document["garment_mesh"] = garment::mesh_json(*all.source.mesh, &*all.dressed);
  if (o.nearest_size)
    document["sizes"] = garment::ranking_json(all.sizes);
  document["inputs"] = all.inputs;
  document["hash"] = {{"strict", garment::strict_hash(garment)},
                      {"quantised_10um", garment::quantised_hash(garment)}};
  io::write_json(o.report, document);
}

int run(cli::Tool& tool, Options o) {
  const garment::RetargetMode mode = garment::retarget_mode_from_name(o.mode);
  check_options(o, mode);
  for (const Message& warning : passed_over(o))
    tool.reporter().warning(warning);
  garment::DrapeSettings settings = garment::preset_settings(o.accuracy);
  for (const std::string& assignment : o.set)
    garment::set_knob(settings, assignment);
  if (o.max_seconds > 0)
    settings.max_seconds = o.max_seconds;
  garment::FitPolicy policy = policy_of(o.policy);

  body::Body body = body::read_body(o.to);
  body.skin_cache = std::make_shared<collision::SkinCache>(o.cache, tool.reporter());
  garment::SizeRanking sizes;
  if (o.nearest_size) {
    const std::vector<std::string> files = garment::sizes_beside(o.garment);
    sizes = garment::rank_sizes(files, body,
                                garment::girths_covered(garment::read_garment(o.garment), body));
    if (mode == garment::RetargetMode::KEEP_FABRIC)
      garment::put_closing_sizes_first(sizes, body, policy);
    o.garment = sizes.sizes.front().file;
    tool.reporter().info(garment::ranking_text(sizes));
  }
  const Source put_on = read_source(tool, o);
  const garment::Garment& source = put_on.garment;
  std::vector<Message> file_findings = body.file_findings;
  file_findings.insert(file_findings.end(), source.file_findings.begin(),
                       source.file_findings.end());
  for (const Message& finding : file_findings)
    tool.reporter().warning(finding);
  for (const Message& doubt : garment::policy_doubts(policy, source, o.policy))
    tool.reporter().warning(doubt);
  garment::follow_fabric(source, policy);
  if (source.bind.empty())
    throw input_error("garment.not-bound"_id, o.garment, "/bind",
                      "the garment is not bound to a body", "drape it with --body first");
  const std::string skin_hash = body::skin_sha256(o.to);
  io::Json inputs = {garment::input_entry(o.garment), garment::input_entry(o.to)};
  if (put_on.mesh)
    inputs.push_back(garment::input_entry(o.from));
  if (const std::string reason = garment::why_impossible(source, body); !reason.empty()) {
    const garment::FitReport fit = garment::impossible_fit(reason, policy);
    write_fit(o, fit, fit_findings(source, file_findings), tool.name(), false, inputs);
    return refuse(tool, o, fit);
  }
  const collision::BodyCollider skin = collision::make_collider(body.skin, body.skin_cache.get());

  if (o.policy.empty())
    garment::follow_worn(source, body, skin, skin_hash, policy);

  garment::RetargetOutcome outcome = garment::retarget_and_judge(
      {source, body, skin, skin_hash, mode, settings, policy, o.no_drape}, tool.reporter());
  const std::vector<garment::RollLineState> rolls = judge_rolls(o, source, outcome);
  const garment::Garment& garment = outcome.retargeted.garment;
  const garment::DrapeReport& report = outcome.report;
  const garment::FitReport& fit = outcome.fit;
  std::vector<Message>& findings = outcome.retargeted.report.findings;
  if (!io::is_mesh_file(o.output))
    garment::write_garment(o.output, garment, tool.name());
  bool worse = false;
  std::optional<garment::DressedMesh> dressed;
  if (put_on.mesh) {
    dressed = garment::dressed_mesh(*put_on.mesh, garment, body, skin);
    worse = write_mesh(tool, o, *put_on.mesh, *dressed);
  }
  if (!o.pattern.empty())
    write_pattern(tool, o, garment, source);
  if (!outcome.stretched_at.empty())
    findings.push_back(
        {"drape.stretched-place"_id,
         io::file_name(o.garment) + " on " + io::file_name(o.to) + ": " + outcome.stretched_at});
  if (!outcome.changed_ease.empty())
    findings.push_back(
        {"retarget.ease-changed"_id,
         io::file_name(o.garment) + " on " + io::file_name(o.to) + " " + outcome.changed_ease});
  for (const Message& finding : findings)
    tool.reporter().warning(finding);
  findings.insert(findings.end(), file_findings.begin(), file_findings.end());
  write_fit(o, fit, fit_findings(source, findings), tool.name(), report.converged, inputs);
  if (!o.report.empty())
    write_report(o, {outcome, rolls, put_on, dressed, sizes, inputs}, tool.name());
  if (outcome.was_draped() && !report.converged && report.misfit == garment::Misfit::NONE)
    tool.reporter().warning(garment::not_done(report, o.output));
  if (!fit.fits && !o.no_drape)
    return refuse(tool, o, fit);
  if (!o.no_drape)
    tell_unknown_strain(tool, o, fit);
  if (worse && !o.no_drape)
    return static_cast<int>(ErrorKind::FAILED);
  return report.converged || o.no_drape ? 0 : static_cast<int>(ErrorKind::FAILED);
}

} // namespace

int main(int argc, char** argv) {
  cli::Tool tool("retarget-garment", "Put a draped garment on another body");
  Options options;
  add_options(tool, options);
  return tool.run(argc, argv, [&] { return run(tool, options); });
}

/// drape: placed panels or a kept garment to cloth at rest on a body.
#include "drape_options.hpp"

#include <sloper/body/body_json.hpp>
#include <sloper/cli/run_tool.hpp>
#include <sloper/collision/skin_cache.hpp>
#include <sloper/garment/bind/bind.hpp>
#include <sloper/garment/drape/drape_job.hpp>
#include <sloper/garment/drape/judge_faults.hpp>
#include <sloper/garment/drape/judge_roll_lines.hpp>
#include <sloper/garment/fit/slid_down.hpp>
#include <sloper/garment/fit/stretch.hpp>
#include <sloper/garment/fit/too_small.hpp>
#include <sloper/garment/garment_json.hpp>
#include <sloper/garment/inputs.hpp>
#include <sloper/garment/material_json.hpp>
#include <sloper/garment/redrape/spread.hpp>
#include <sloper/garment/scene/scene.hpp>
#include <sloper/garment/scene/scene_folds.hpp>
#include <sloper/garment/simulate/checkpoint.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/mesh/folds.hpp>
#include <sloper/pattern/panel_mesh_json.hpp>

#include <algorithm>
#include <iostream>

using namespace sloper;
using namespace sloper::drape_options;

namespace {

/// What scene and options say beside the preset.
void set_knobs(garment::DrapeSettings& settings, const Options& o, const garment::Scene& scene) {
  for (const auto& [name, value] : scene.settings)
    garment::set_knob(settings, name, value);
  for (const std::string& assignment : o.set)
    garment::set_knob(settings, assignment);
  if (o.max_seconds > 0)
    settings.max_seconds = o.max_seconds;
  if (!scene.effects.empty())
    settings.effects = scene.effects;
  if (!o.effects.empty())
    settings.effects = o.effects;
}

/// Whether presets are climbed until an error or a time is met, instead of one being given.
bool has_goal(const Options& o, const garment::Scene& scene) {
  const bool preset = !o.accuracy.empty() || !scene.accuracy.empty() || !o.checkpoint.empty();
  if (o.max_error_mm > 0 && !o.accuracy.empty())
    throw Error(ErrorKind::USAGE, "option.conflict"_id, "", "--max-error-mm",
                "chooses the preset by itself", "leave --accuracy out");
  return o.max_error_mm > 0 || (o.max_seconds > 0 && !preset);
}

/// The drape that the options ask for.
garment::DrapeJob job_of(const cli::Tool& tool, const Options& o, const garment::Scene& scene,
                         const garment::DrapeSettings& settings) {
  garment::DrapeJob job;
  job.tool = tool.name();
  if (o.follow.empty() && o.motion.empty() && !o.untangle_only && has_goal(o, scene))
    job.goal = garment::AccuracyGoal{1e-3 * o.max_error_mm, settings.max_seconds};
  job.adjust = [&o, &scene](garment::DrapeSettings& s) { set_knobs(s, o, scene); };
  job.motion = o.motion;
  if (o.motion_fps > 0)
    job.motion_fps = o.motion_fps;
  job.untangle_only = o.untangle_only;
  job.follow = o.follow;
  job.frames = o.frames;
  job.edit_log = o.edit_log;
  job.checkpoints = {o.checkpoint, o.checkpoint_steps};
  return job;
}

/// What pattern-mesh found under one of some ids.
std::vector<Message> found_before(const garment::Garment& garment,
                                  std::initializer_list<std::string_view> ids) {
  std::vector<Message> out;
  for (const Message& finding : garment.panels.findings)
    if (std::find(ids.begin(), ids.end(), finding.id) != ids.end())
      out.push_back(finding);
  return out;
}

/// What is too short for the body that the panels were placed around.
std::vector<Message> tight_rings(const garment::Garment& garment) {
  return found_before(garment, {"placement.too-tight"_id.text()});
}

/// What a user who reads the report alone has to know of the panels.
std::vector<Message> faults_of_panels(const garment::Garment& garment) {
  return found_before(garment, {"placement.too-tight"_id.text(), "placement.impossible"_id.text(),
                                "pattern.half-sewn"_id.text()});
}

/// What may be the reason, for the end of a sentence.
std::string why_not(const garment::Garment& garment) {
  const std::vector<Message> tight = tight_rings(garment);
  return tight.empty() ? "" : "; it was too small from the start: " + tight.front().text;
}

/// Writes all that is asked for; the exit code.
int write_out(cli::Tool& tool, const Options& o, garment::Garment& garment,
              std::vector<garment::Garment>& under, const body::Body& body,
              garment::DrapeOutcome& outcome, const io::Json& inputs,
              const std::vector<Message>& findings) {
  if (!o.body.empty() && o.motion.empty())
    garment::bind_garment(garment, body);
  garment::write_garment(o.output, garment, tool.name());
  for (std::size_t k = 0; k < o.over_output.size(); ++k) {
    if (o.motion.empty())
      garment::bind_garment(under[k], body);
    garment::write_garment(o.over_output[k], under[k], tool.name());
  }
  io::Json& document = outcome.document;
  const garment::DrapeReport& report = outcome.report;
  if (!o.report.empty()) {
    io::put_findings(document, findings);
    document["inputs"] = inputs;
    document["hash"] = {{"strict", garment::strict_hash(garment)},
                        {"quantised_10um", garment::quantised_hash(garment)}};
    io::write_json(o.report, document);
  }
  if (outcome.refused_lines > 0)
    tool.reporter().warning(
        {"drape.edits-refused"_id,
         std::to_string(outcome.refused_lines) +
             (outcome.refused_lines == 1 ? " line was not an edit" : " lines were not edits") +
             " of this pattern and changed nothing"});
  if (document.contains("accuracy") && report.converged &&
      !document["accuracy"]["met"].get<bool>()) {
    tool.reporter().warning({"drape.error-too-large"_id,
                             "at rest, but not within --max-error-mm; see \"accuracy\" in the "
                             "report; the state reached is in " +
                                 o.output});
    return static_cast<int>(ErrorKind::FAILED);
  }
  if (report.converged)
    return outcome.refused_lines > 0 ? static_cast<int>(ErrorKind::FAILED) : 0;
  Message not_done = garment::not_done(report, o.output);
  not_done.text += why_not(garment);
  tool.reporter().warning(not_done);
  return static_cast<int>(ErrorKind::FAILED);
}

/// Drapes again and again; the garment becomes the drape that is nearest to all others.
garment::DrapeOutcome redrape(cli::Tool& tool, const Options& o, garment::Garment& garment,
                              const body::Body* body, const garment::DrapeSettings& settings) {
  garment::RedrapeRequest request;
  request.count = o.redrapes;
  request.seed = static_cast<std::uint64_t>(o.seed);
  for (const std::string& assignment : o.jitter)
    garment::set_jitter(request.jitter, assignment);
  garment::RedrapeSet set = garment::redrape(garment, body, settings, request, tool.reporter());
  const garment::Spread spread = garment::measure_spread(set, body);
  if (!o.spread.empty())
    io::write_json(o.spread, garment::spread_json(spread, request, tool.name()));
  const auto medoid = static_cast<std::size_t>(spread.medoid);
  garment = std::move(set.garments[medoid]);
  garment::keep_spread(spread, garment);
  garment::DrapeOutcome outcome;
  outcome.report = garment::whole_report(set, medoid);
  outcome.document = garment::report_json(outcome.report, tool.name());
  outcome.document["redrapes"] = garment::redrape_costs(set);
  if (spread.at_rest < spread.count)
    tool.reporter().warning(
        {"drape.redrapes-not-at-rest"_id, std::to_string(spread.count - spread.at_rest) + " of " +
                                              std::to_string(spread.count) +
                                              " drapes did not come to rest and do not count"});
  return outcome;
}

body::Body read_body(cli::Tool& tool, const Options& o) {
  body::Body body = body::read_body(o.body);
  body.skin_cache = std::make_shared<collision::SkinCache>(o.cache, tool.reporter());
  return body;
}

/// Goes on from a checkpoint, which knows all but the body and its motion.
int resume(cli::Tool& tool, const Options& o) {
  const cli::Given given[] = {{"--scene", !o.scene.empty()},
                              {"--accuracy", !o.accuracy.empty()},
                              {"--effects", !o.effects.empty()},
                              {"--material", !o.material.empty()},
                              {"--set", !o.set.empty()},
                              {"--over", !o.over.empty()},
                              {"--max-error-mm", o.max_error_mm > 0},
                              {"--max-seconds", o.max_seconds > 0},
                              {"--redrapes", o.redrapes > 0},
                              {"--follow", !o.follow.empty()},
                              {"--untangle-only", o.untangle_only},
                              {"--motion-fps", o.motion_fps > 0}};
  for (const auto& [name, is_given] : given)
    if (is_given)
      throw Error(ErrorKind::USAGE, "checkpoint.fixes-option"_id, "", name,
                  "cannot be changed when resuming; the checkpoint fixes it", "leave it out");
  const garment::DrapeCheckpoint checkpoint = garment::read_checkpoint(o.from);
  check_over_output(o, checkpoint.layers ? checkpoint.layers->garments.size() - 1 : 0);
  io::Json inputs = io::Json::array({garment::input_entry(o.from)});
  garment::Garment garment;
  std::vector<garment::Garment> under;
  body::Body body;
  if (!o.body.empty()) {
    body = read_body(tool, o);
    garment.body_sha256 = body::skin_sha256(o.body);
    inputs.push_back(garment::input_entry(o.body));
  }
  if (!o.motion.empty())
    inputs.push_back(garment::input_entry(o.motion));
  garment::DrapeJob job;
  job.tool = tool.name();
  job.motion = o.motion;
  job.frames = o.frames;
  job.checkpoints.file = o.checkpoint;
  garment::DrapeOutcome outcome =
      garment::resume_job(job, checkpoint, {garment, under}, o.body.empty() ? nullptr : &body,
                          std::cout, tool.reporter());
  std::vector<Message> findings;
  for (const Message& finding : body.file_findings) {
    findings.push_back(finding);
    tool.reporter().warning(finding);
  }
  garment::judge_roll_lines(garment, outcome, o.from, findings, tool.reporter());
  if (o.accept_faults)
    garment.panels.faults.clear();
  garment::judge_faults(garment, outcome);
  return write_out(tool, o, garment, under, body, outcome, inputs, findings);
}

int run(cli::Tool& tool, Options& o) {
  check_options(o);
  if (!o.from.empty() && garment::is_checkpoint(o.from))
    return resume(tool, o);
  check_over_output(o, o.over.size());
  const garment::Scene scene = o.scene.empty() ? garment::Scene{} : garment::read_scene(o.scene);
  if (o.body.empty())
    o.body = scene.body;
  if (o.panels.empty())
    o.panels = scene.panels;
  if (o.panels.empty() == o.from.empty())
    throw Error(ErrorKind::USAGE, "drape.not-one-start"_id, "", "",
                o.from.empty() ? "nothing to drape" : "both --panels and --from are given",
                "give --panels panels.json or --from shirt.json, which follows an edited pattern "
                "with --follow edits.jsonl");
  const std::string scene_accuracy = scene.accuracy.empty() ? "standard" : scene.accuracy;
  garment::DrapeSettings settings =
      garment::preset_settings(o.accuracy.empty() ? scene_accuracy : o.accuracy);
  set_knobs(settings, o, scene);
  if (!o.motion.empty() && o.body.empty())
    throw Error(ErrorKind::USAGE, "drape.no-body"_id, "", "--motion", "there is no body to move",
                "give --body body.json");
  if (!o.over.empty() && o.body.empty())
    throw Error(ErrorKind::USAGE, "drape.no-body"_id, "", "--over", "layers need a body",
                "give --body body.json");

  garment::Garment garment;
  const std::string& source = o.from.empty() ? o.panels : o.from;
  if (o.from.empty()) {
    garment.panels = pattern::read_panel_mesh(o.panels);
    garment.file_findings = garment.panels.file_findings;
    garment.rest_scale = pattern::tape_scales(garment.panels);
  } else
    garment = garment::read_garment(o.from);
  if (o.accept_faults)
    garment.panels.faults.clear();
  io::Json inputs = io::Json::array({garment::input_entry(source)});
  garment::apply_scene(scene, garment);
  if (!o.material.empty())
    garment.materials[""] = garment::material_from(o.material);
  for (const Message& finding : garment::unused_materials(scene, o.scene, garment))
    tool.reporter().warning(finding);
  garment::apply_interfacing(scene, garment);

  std::vector<garment::Garment> layers;
  for (const std::string& path : o.over)
    layers.push_back(garment::read_garment(path));
  const body::Body body = o.body.empty() ? body::Body{} : read_body(tool, o);
  const std::string skin = o.body.empty() ? "" : body::skin_sha256(o.body);
  const std::optional<double> before = garment::stretch_elsewhere(garment, skin);
  std::vector<Message> findings =
      garment::start_findings(garment, {source, o.body, skin, !o.from.empty()});
  findings.insert(findings.end(), garment.file_findings.begin(), garment.file_findings.end());
  findings.insert(findings.end(), body.file_findings.begin(), body.file_findings.end());
  for (const garment::Garment& layer : layers)
    findings.insert(findings.end(), layer.file_findings.begin(), layer.file_findings.end());
  if (!o.body.empty()) {
    for (std::size_t k = 0; k < layers.size(); ++k)
      for (const Message& finding :
           garment::start_findings(layers[k], {o.over[k], o.body, skin, true}))
        findings.push_back(finding);
    garment.body_sha256 = skin;
    inputs.push_back(garment::input_entry(o.body));
  }
  for (const Message& finding : faults_of_panels(garment))
    findings.push_back(finding);
  for (const Message& finding :
       garment::mesh_along_folds(garment, o.body.empty() ? nullptr : &body, skin, o.scene))
    findings.push_back(finding);
  for (const Message& finding : findings)
    tool.reporter().warning(finding);
  if (!o.motion.empty())
    inputs.push_back(garment::input_entry(o.motion));
  for (const std::string& path : o.over)
    inputs.push_back(garment::input_entry(path));
  const body::Body* const dressed = o.body.empty() ? nullptr : &body;
  garment::DrapeOutcome outcome =
      o.redrapes > 0 ? redrape(tool, o, garment, dressed, settings)
                     : garment::do_drape(job_of(tool, o, scene, settings), {garment, layers},
                                         dressed, settings, std::cout, tool.reporter());
  if (!o.untangle_only) {
    garment::judge_stretch(garment, outcome, {source, o.body, skin, !o.from.empty()}, before,
                           findings, tool.reporter());
    garment::judge_too_small(garment, body, outcome.report, {source, o.body, skin, !o.from.empty()},
                             findings, tool.reporter());
    garment::judge_slid_down(garment, body, outcome, {source, o.body, skin, !o.from.empty()},
                             findings, tool.reporter());
    garment::judge_roll_lines(garment, outcome, source, findings, tool.reporter());
    garment::judge_faults(garment, outcome);
  }
  return write_out(tool, o, garment, layers, body, outcome, inputs, findings);
}

} // namespace

int main(int argc, char** argv) {
  cli::Tool tool("drape", "Drape a sewn pattern on a body until the cloth is at rest");
  Options options;
  add_options(tool, options);
  return tool.run(argc, argv, [&] { return run(tool, options); });
}

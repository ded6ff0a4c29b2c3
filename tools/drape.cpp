/// drape: placed panels or a kept garment to cloth at rest on a body.
#include <sloper/body/body_json.hpp>
#include <sloper/cli/run_tool.hpp>
#include <sloper/collision/skin_cache.hpp>
#include <sloper/garment/bind/bind.hpp>
#include <sloper/garment/drape/drape_job.hpp>
#include <sloper/garment/fit/stretch.hpp>
#include <sloper/garment/garment_json.hpp>
#include <sloper/garment/inputs.hpp>
#include <sloper/garment/material_json.hpp>
#include <sloper/garment/redrape/spread.hpp>
#include <sloper/garment/scene/scene.hpp>
#include <sloper/garment/simulate/checkpoint.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/mesh/folds.hpp>
#include <sloper/pattern/panel_mesh_json.hpp>

#include <iostream>

using namespace sloper;

namespace {

struct Options {
  std::string scene, body, panels, from, accuracy, effects, material, report, output, cache,
      checkpoint, follow, frames, edit_log, motion, spread;
  std::vector<std::string> set, over, over_output, jitter;
  int checkpoint_steps = 100;
  double max_seconds = 0, max_error_mm = 0, motion_fps = 0;
  bool untangle_only = false;
  int redrapes = 0, seed = 1;
};

void add_options(cli::Tool& tool, Options& o) {
  tool.option("--scene", o.scene,
              "scene.json: body, panels, materials, effects, settings; options below override it")
      .check(cli::input_file());
  tool.option("--body", o.body, "body.json from scan-landmarks").check(cli::input_file());
  tool.option("--panels", o.panels, "panels.json from pattern-mesh").check(cli::input_file());
  tool.option("--from", o.from,
              "start from a garment that drape or retarget-garment wrote, or from a checkpoint")
      .check(cli::input_file());
  tool.option("--over", o.over,
              "a draped garment below this one; repeat it from the skin outwards. Inner "
              "cloth is tucked in where it lies outside, then all "
              "come to rest together")
      .check(cli::input_file());
  tool.option("--over-output", o.over_output,
              "write the garments of --over as they lie below this one; as many, in the same order")
      .check(cli::document_file());
  tool.option("--accuracy", o.accuracy, "how exact, and how long it takes (default: standard)")
      .check(cli::one_of(garment::accuracy_names()));
  tool.option("--effects", o.effects,
              "auto, auto with changes (auto,membrane,-friction), or exactly those of a list "
              "(default: auto)")
      .type_name("LIST");
  tool.option("--material", o.material,
              "fabric of panels that name none: a preset such as cotton-poplin, denim, silk, "
              "jersey, or a CSV of KES-F or FAST values")
      .type_name("NAME");
  tool.option("--set", o.set, "one setting by its name in the report's settings")
      .type_name("KNOB=VALUE");
  tool.option("--max-seconds", o.max_seconds,
              "stop after this wall time, s, with the best state so far; without --accuracy: "
              "draft, and standard when there is time for it")
      .check(cli::finite_in(0, 1e6, "s"));
  tool.option("--max-error-mm", o.max_error_mm,
              "use finer and finer presets until the cloth is nearer than this to where the finest "
              "would bring it, root mean square; exit 4 when none is")
      .check(cli::finite_in(1e-3, 1e3, "mm"));
  tool.option("--report", o.report,
              "write report.json: convergence, effects with calls and time, quality, settings")
      .check(cli::output_file());
  tool.option("--follow", o.follow,
              "with --from: edits of the pattern, one JSON object a line, taken as they come from "
              "a file that grows or from standard input (\"-\")")
      .type_name("FILE");
  tool.option("--motion", o.motion,
              "then move the body: a BVH motion, or the first of a numbered sequence of skins "
              "(body.0001.obj, from scan-landmarks --pose); the cloth "
              "follows and comes to rest in the last pose")
      .check(cli::input_file());
  tool.option("--motion-fps", o.motion_fps,
              "with --motion: frames a second kept of a BVH motion, and those of a sequence of "
              "skins (default: 30)")
      .check(cli::finite_in(1, 1000, "1/s"));
  tool.option("--frames", o.frames,
              "with --follow or --motion: every step or frame as an OBJ in this folder with "
              "frames.jsonl, or as JSON lines to standard output (\"-\")")
      .type_name("DIR");
  tool.option("--edit-log", o.edit_log,
              "with --follow: the edits taken, as pattern-mesh --edits replays them")
      .check(cli::output_file());
  tool.flag("--untangle-only", o.untangle_only,
            "with --from: only draw crossing cloth apart and out of the body, and drape nothing; "
            "exit 4 where crossings remain");
  tool.option("--redrapes", o.redrapes,
              "drape so many times from starts that differ as a person's hands do; the drape "
              "written is the one nearest to all others, with the spread of each place")
      .check(cli::finite_in(2, 1000, "drapes"));
  tool.option("--jitter", o.jitter,
              "with --redrapes: how far starts differ: turn_deg (1.1), offset_mm (3), order_mm (2: "
              "what part of the cloth comes down first)")
      .type_name("NAME=VALUE");
  tool.option("--seed", o.seed, "with --redrapes: of the starts (default: 1)")
      .check(cli::finite_in(0, 1e9, ""));
  tool.option("--spread", o.spread,
              "with --redrapes: write spread.json, mean and standard deviation of girths, ease, "
              "hems, strain, folds and shadow, for scripts/compare-drape --spread")
      .check(cli::output_file());
  tool.option(
          "--checkpoint", o.checkpoint,
          "save the state in this file every --checkpoint-steps; after a crash, --from FILE with "
          "the same --body and --motion resumes and ends in the same bytes")
      .check(cli::output_file());
  tool.option("--checkpoint-steps", o.checkpoint_steps,
              "steps from one checkpoint to the next; part of the result (default: 100)")
      .check(cli::finite_in(1, 1e6, "steps"));
  tool.option("--cache", o.cache,
              "keep prepared bodies in this folder for later runs on the same body: "
              "the same result, sooner")
      .type_name("DIR");
  tool.option("-o,--output", o.output, "shirt.json; shirt.obj is written beside it")
      .required()
      .check(cli::document_file());
  tool.example("drape --body body.json --panels panels.json --report report.json -o shirt.json",
               "drape a sewn pattern on a scanned body");
  tool.formats("scene, body, panels and garment documents (version 1)",
               "garment and report documents (version 1), OBJ");
  tool.example(
      "drape --from shirt.json --body body.json --follow edits.jsonl --frames - -o edited.json",
      "change the pattern and watch the cloth follow");
  tool.example("drape --body body.json --over shirt.json --panels jacket-panels.json --over-output "
               "shirt-below.json -o jacket.json",
               "a jacket over a shirt");
  tool.example("drape --from shirt.json --body body.json --motion walk.bvh --frames walk -o "
               "shirt-walked.json",
               "let the body walk, cloth frame by frame");
  tool.example("drape --from shirt.json --body body.json --untangle-only -o clean.json",
               "free a garment of crossings and leave the rest of it as it is");
  tool.example("drape --body body.json --panels panels.json --redrapes 10 --spread spread.json -o "
               "shirt.json",
               "ten drapes: the middle one, and how far they differ");
  tool.example("drape --from run.checkpoint.json --body body.json -o shirt.json",
               "go on where a run with --checkpoint run.checkpoint.json was killed");
  tool.example("drape --from shirt.json --body body.json --accuracy fine -o shirt-fine.json",
               "go on, more exactly");
  tool.example("drape --body body.json --panels panels.json --max-error-mm 0.5 --report "
               "report.json -o shirt.json",
               "as accurate as that, and no more");
}

/// What scene and options say beside the preset.
void set_knobs(garment::DrapeSettings& settings, const Options& o, const garment::Scene& scene) {
  for (const auto& [name, value] : scene.settings) garment::set_knob(settings, name, value);
  for (const std::string& assignment : o.set) garment::set_knob(settings, assignment);
  if (o.max_seconds > 0) settings.max_seconds = o.max_seconds;
  if (!scene.effects.empty()) settings.effects = scene.effects;
  if (!o.effects.empty()) settings.effects = o.effects;
}

/// Whether presets are climbed until an error or a time is met, instead of one being given.
bool has_goal(const Options& o, const garment::Scene& scene) {
  const bool preset = !o.accuracy.empty() || !scene.accuracy.empty() || !o.checkpoint.empty();
  if (o.max_error_mm > 0 && !o.accuracy.empty())
    throw Error(ErrorKind::USAGE, "option.conflict"_id, "", "--max-error-mm",
                "chooses the preset by itself", "leave --accuracy out");
  return o.max_error_mm > 0 || (o.max_seconds > 0 && !preset);
}

/// The way that the options ask for.
garment::DrapeJob job_of(const cli::Tool& tool, const Options& o, const garment::Scene& scene,
                         const garment::DrapeSettings& settings) {
  garment::DrapeJob job;
  job.tool = tool.name();
  if (o.follow.empty() && o.motion.empty() && !o.untangle_only && has_goal(o, scene))
    job.goal = garment::AccuracyGoal{1e-3 * o.max_error_mm, settings.max_seconds};
  job.adjust = [&o, &scene](garment::DrapeSettings& s) { set_knobs(s, o, scene); };
  job.motion = o.motion;
  if (o.motion_fps > 0) job.motion_fps = o.motion_fps;
  job.untangle_only = o.untangle_only;
  job.follow = o.follow;
  job.frames = o.frames;
  job.edit_log = o.edit_log;
  job.checkpoints = {o.checkpoint, o.checkpoint_steps};
  return job;
}

void check_options(const Options& o) {
  const cli::Given follow{"--follow", !o.follow.empty()}, over{"--over", !o.over.empty()},
      checkpoint{"--checkpoint", !o.checkpoint.empty()},
      max_error{"--max-error-mm", o.max_error_mm > 0}, untangle{"--untangle-only", o.untangle_only},
      motion{"--motion", !o.motion.empty()};
  cli::refuse_together(motion, {follow, max_error, untangle});
  cli::refuse_together(untangle, {follow, over, checkpoint, max_error});
  cli::refuse_together(checkpoint, {follow, max_error});
  cli::refuse_together(over, {follow, max_error});
  const cli::Given redrapes{"--redrapes", o.redrapes > 0};
  cli::refuse_together(redrapes, {follow, over, checkpoint, max_error, untangle, motion});
  for (const cli::Given& with :
       {cli::Given{"--jitter", !o.jitter.empty()}, cli::Given{"--spread", !o.spread.empty()},
        cli::Given{"--seed", o.seed != 1}})
    if (with.second && !redrapes.second)
      throw Error(ErrorKind::USAGE, "option.needs-another"_id, "", with.first,
                  "the garment is draped once", "give --redrapes too");
  for (const cli::Given& one : {follow, untangle})
    if (one.second && o.from.empty())
      throw Error(ErrorKind::USAGE, "option.needs-another"_id, "", one.first,
                  "needs a garment to start from", "give --from shirt.json");
  if (o.follow.empty() && !o.edit_log.empty())
    throw Error(ErrorKind::USAGE, "option.needs-another"_id, "", "--edit-log", "needs --follow",
                "give --follow too");
  if (o.follow.empty() && o.motion.empty() && !o.frames.empty())
    throw Error(ErrorKind::USAGE, "option.needs-another"_id, "", "--frames",
                "nothing moves, so there are no frames", "give --follow or --motion too");
}

/// @param below  garments that will lie below this one
void check_over_output(const Options& o, std::size_t below) {
  if (!o.over_output.empty() && o.over_output.size() != below)
    throw Error(ErrorKind::USAGE, "option.wrong-count"_id, "", "--over-output",
                "is given " + std::to_string(o.over_output.size()) + " times, --over " +
                    std::to_string(below),
                "name one file for each garment of --over");
}

/// Writes all that is asked for; the exit code.
int write_out(cli::Tool& tool, const Options& o, garment::Garment& garment,
              std::vector<garment::Garment>& under, const body::Body& body,
              garment::DrapeOutcome& outcome, const io::Json& inputs,
              const std::vector<Message>& findings) {
  if (!o.body.empty() && o.motion.empty()) garment::bind_garment(garment, body);
  garment::write_garment(o.output, garment, tool.name());
  for (std::size_t k = 0; k < o.over_output.size(); ++k) {
    if (o.motion.empty()) garment::bind_garment(under[k], body);
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
  if (report.converged) return outcome.refused_lines > 0 ? static_cast<int>(ErrorKind::FAILED) : 0;
  tool.reporter().warning({"drape.not-at-rest"_id, "not done: " + garment::stop_text(report) +
                                                       " after " + std::to_string(report.steps) +
                                                       " steps; the state reached is in " +
                                                       o.output});
  return static_cast<int>(ErrorKind::FAILED);
}

/// Drapes again and again; the garment becomes the drape that is nearest to all others.
garment::DrapeOutcome redrape(cli::Tool& tool, const Options& o, garment::Garment& garment,
                              const body::Body* body, const garment::DrapeSettings& settings) {
  garment::RedrapeRequest request;
  request.count = o.redrapes;
  request.seed = static_cast<std::uint64_t>(o.seed);
  for (const std::string& assignment : o.jitter) garment::set_jitter(request.jitter, assignment);
  garment::RedrapeSet set = garment::redrape(garment, body, settings, request, tool.reporter());
  const garment::Spread spread = garment::measure_spread(set, body);
  if (!o.spread.empty())
    io::write_json(o.spread, garment::spread_json(spread, request, tool.name()));
  const auto medoid = static_cast<std::size_t>(spread.medoid);
  garment = std::move(set.garments[medoid]);
  garment::keep_spread(spread, garment);
  garment::DrapeOutcome outcome;
  outcome.report = std::move(set.reports[medoid]);
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
  if (!o.motion.empty()) inputs.push_back(garment::input_entry(o.motion));
  garment::DrapeJob job;
  job.tool = tool.name();
  job.motion = o.motion;
  job.frames = o.frames;
  job.checkpoints.file = o.checkpoint;
  garment::DrapeOutcome outcome =
      garment::resume_job(job, checkpoint, garment, under, o.body.empty() ? nullptr : &body,
                          std::cout, tool.reporter());
  return write_out(tool, o, garment, under, body, outcome, inputs, {});
}

int run(cli::Tool& tool, Options& o) {
  check_options(o);
  if (!o.from.empty() && garment::is_checkpoint(o.from)) return resume(tool, o);
  check_over_output(o, o.over.size());
  const garment::Scene scene = o.scene.empty() ? garment::Scene{} : garment::read_scene(o.scene);
  if (o.body.empty()) o.body = scene.body;
  if (o.panels.empty()) o.panels = scene.panels;
  if (o.panels.empty() == o.from.empty())
    throw Error(ErrorKind::USAGE, "drape.not-one-start"_id, "", "",
                o.from.empty() ? "nothing to drape" : "both --panels and --from are given",
                "give --panels panels.json or --from shirt.json, which follows an edited pattern "
                "with --follow edits.jsonl");
  garment::DrapeSettings settings =
      garment::preset_settings(!o.accuracy.empty()       ? o.accuracy
                               : !scene.accuracy.empty() ? scene.accuracy
                                                         : "standard");
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
    garment.rest_scale = pattern::tape_scales(garment.panels);
  } else garment = garment::read_garment(o.from);
  io::Json inputs = io::Json::array({garment::input_entry(source)});
  garment::apply_scene(scene, garment);
  if (!o.material.empty()) garment.materials[""] = garment::material_from(o.material);
  garment::apply_interfacing(scene, garment);

  std::vector<garment::Garment> layers;
  for (const std::string& path : o.over) layers.push_back(garment::read_garment(path));
  const body::Body body = o.body.empty() ? body::Body{} : read_body(tool, o);
  const std::string skin = o.body.empty() ? "" : body::skin_sha256(o.body);
  const std::optional<double> before = garment::stretch_elsewhere(garment, skin);
  std::vector<Message> findings =
      garment::start_findings(garment, {source, o.body, skin, !o.from.empty()});
  if (!o.body.empty()) {
    for (std::size_t k = 0; k < layers.size(); ++k)
      for (const Message& finding :
           garment::start_findings(layers[k], {o.over[k], o.body, skin, true}))
        findings.push_back(finding);
    garment.body_sha256 = skin;
    inputs.push_back(garment::input_entry(o.body));
  }
  for (const Message& finding : findings) tool.reporter().warning(finding);
  if (!o.motion.empty()) inputs.push_back(garment::input_entry(o.motion));
  for (const std::string& path : o.over) inputs.push_back(garment::input_entry(path));
  garment::DrapeOutcome outcome =
      o.redrapes > 0 ? redrape(tool, o, garment, o.body.empty() ? nullptr : &body, settings)
                     : garment::do_drape(job_of(tool, o, scene, settings), garment, layers,
                                         o.body.empty() ? nullptr : &body, settings, std::cout,
                                         tool.reporter());
  if (!o.untangle_only)
    garment::judge_stretch(garment, outcome, {source, o.body, skin, !o.from.empty()}, before,
                           findings, tool.reporter());
  return write_out(tool, o, garment, layers, body, outcome, inputs, findings);
}

} // namespace

int main(int argc, char** argv) {
  cli::Tool tool("drape", "Drape a sewn pattern on a body until the cloth is at rest");
  Options options;
  add_options(tool, options);
  return tool.run(argc, argv, [&] { return run(tool, options); });
}

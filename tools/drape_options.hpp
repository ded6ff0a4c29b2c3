#pragma once
/// The options of drape: their texts, and which of them exclude or need one another.
#include <sloper/cli/run_tool.hpp>
#include <sloper/garment/scene/scene.hpp>

#include <string>
#include <vector>

namespace sloper::drape_options {

/// As the command line has them; empty, 0 or false where an option is not given.
struct Options {
  std::string scene, body, panels, from, accuracy, effects, material, report, output, cache,
      checkpoint, follow, frames, edit_log, motion, spread;
  std::vector<std::string> set, over, over_output, jitter;
  int checkpoint_steps = 100;
  double max_seconds = 0, max_error_mm = 0, motion_fps = 0;
  bool untangle_only = false, accept_faults = false;
  int redrapes = 0, seed = 1;
};

inline void add_options(cli::Tool& tool, Options& o) {
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
  std::string knobs;
  for (const std::string& name : garment::knob_names())
    knobs += (knobs.empty() ? "" : ", ") + name;
  tool.option("--set", o.set, "one setting, by its name in the report's settings: " + knobs)
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
  tool.flag("--accept-faults", o.accept_faults,
            "panels on which pattern-mesh ended with exit status 4 are meant as they are: they "
            "do not fail the drape, nor any later one of this garment");
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
  tool.example("drape --body body.json --panels panels.json --max-error-mm 1 --report "
               "report.json -o shirt.json",
               "as accurate as that, and no more");
}

/// Refuses options that do not fit together. @throws Error USAGE
inline void check_options(const Options& o) {
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

/// As many outputs as garments below this one, or none. @param below  their number
/// @throws Error USAGE
inline void check_over_output(const Options& o, std::size_t below) {
  if (!o.over_output.empty() && o.over_output.size() != below)
    throw Error(ErrorKind::USAGE, "option.wrong-count"_id, "", "--over-output",
                "is given " + std::to_string(o.over_output.size()) + " times, --over " +
                    std::to_string(below),
                "name one file for each garment of --over");
}

} // namespace sloper::drape_options

/// pattern-mesh: a sewing pattern to meshed, placed panels.
#include "pattern_faults.hpp"
#include "pattern_options.hpp"

#include <sloper/base/progress.hpp>
#include <sloper/base/text.hpp>
#include <sloper/base/units.hpp>
#include <sloper/body/body_json.hpp>
#include <sloper/cli/run_tool.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/edit/edits.hpp>
#include <sloper/pattern/edit/shoulder_folds.hpp>
#include <sloper/pattern/mesh/mesh_pattern.hpp>
#include <sloper/pattern/panel_mesh_json.hpp>
#include <sloper/pattern/place/place_panels.hpp>
#include <sloper/pattern/read/read_pattern.hpp>
#include <sloper/pattern/seams/check_pattern.hpp>
#include <sloper/pattern/seams/infer_seams.hpp>
#include <sloper/pattern/seams/piece_versions.hpp>
#include <sloper/pattern/write/export_pattern.hpp>

#include <algorithm>
#include <iostream>
#include <sstream>

using namespace sloper;
using namespace sloper::pattern_faults;
using namespace sloper::pattern_options;

namespace {

constexpr double LEAST_ANGLE =
    15; // degrees: a mesh carried over an edit is kept while it is no worse

/// The pattern as read (and edited), in the format of the file name's ending.
void write_pattern(cli::Tool& tool, const pattern::Pattern& source, const std::string& path) {
  const auto ends = [&](const std::string& tail) {
    return path.size() >= tail.size() &&
           path.compare(path.size() - tail.size(), tail.size(), tail) == 0;
  };
  if (ends(".svg"))
    io::write_file(path, pattern::pattern_svg(source));
  else if (ends(".dxf")) {
    std::vector<std::string> left_out;
    io::write_file(path, pattern::pattern_dxf(source, left_out));
    for (const std::string& line : left_out)
      tool.reporter().warning({"dxf.not-written"_id, line});
  } else if (ends(".json"))
    io::write_json(path, pattern::pattern_json(source, tool.name()));
  else
    throw Error(ErrorKind::USAGE, "option.unknown-ending"_id, path, "",
                "the file name does not end in a pattern format",
                "name a .json, .dxf or .svg file");
}

std::string questions(std::size_t n) {
  return std::to_string(n) + (n == 1 ? " question is" : " questions are");
}

/// Sews what is certain, and of the rest the first answer to each question. All of it goes to
/// standard output as a sidecar.
void take_first_answers(cli::Tool& tool, pattern::Pattern& source,
                        const std::vector<pattern::SeamGuess>& guesses,
                        const std::vector<pattern::PieceVersions>& versions,
                        std::size_t questions) {
  std::vector<pattern::SeamGuess> answers = pattern::first_answers(guesses);
  std::string taken;
  for (pattern::SeamGuess& g : answers) {
    source.seams.push_back(g.seam);
    const std::string seam = g.seam.name + " (" + decimals(100 * g.score, 0) + " %)";
    if (!g.certain)
      taken += (taken.empty() ? "" : ", ") + seam;
    source.findings.push_back(
        g.certain ? Message{"pattern.seam-guessed"_id, "seam " + g.seam.name + " is guessed"}
                  : Message{"pattern.answer-taken"_id, "seam " + seam + " is a first answer"});
    g.certain = true;
  }
  io::Json document = pattern::sewing_questions(source, answers, tool.name(), versions);
  document["questions"] = io::Json::array();
  for (const std::string& name : pattern::leave_out_unsewn(source)) {
    // A name means the piece's mirrored copy too.
    const bool with_original = document.contains("without") &&
                               name == document["without"].back().get<std::string>() + "_mirror";
    if (!with_original && source.find_panel(name + "_mirror") < 0)
      document["without"].push_back(name);
    source.findings.push_back(
        {"dxf.piece-left-out"_id, name + " is left out: nothing is found that it is sewn to; name "
                                         "its seam in --sewing to take it"});
  }
  std::cout << io::to_text(document);
  std::string left_out;
  for (const io::Json& name : document.value("without", io::Json::array()))
    left_out += (left_out.empty() ? "" : ", ") + name.get<std::string>();
  tool.reporter().warning(
      {"pattern.answers-taken"_id,
       "the file states no seams: the first answers to " + std::to_string(questions) +
           (questions == 1 ? " question" : " questions") +
           " are taken, each with its probability: " + (taken.empty() ? "none" : taken) +
           (left_out.empty()
                ? ""
                : "; left out as other versions, or since nothing is found for them: " + left_out) +
           "; look at the picture of the drape, or run without --answers to be asked"});
}

/// Seams of a file that states none. True when all that could be sewn is certain, or the first
/// answers are to be taken; else the open questions go to standard output.
bool guess_seams(cli::Tool& tool, pattern::Pattern& source, const Options& o) {
  const bool pieces_chosen = !o.pieces.empty();
  std::vector<pattern::PieceVersions> versions;
  std::optional<std::vector<pattern::SeamGuess>> inferred;
  if (!pieces_chosen)
    versions = pattern::take_versions(source, inferred);
  const std::vector<pattern::SeamGuess> guesses =
      inferred ? std::move(*inferred) : pattern::infer_seams(source);
  const io::Json document = pattern::sewing_questions(source, guesses, tool.name(), versions);
  if (o.answers == "first" && !document["questions"].empty() && !guesses.empty()) {
    take_first_answers(tool, source, guesses, versions, document["questions"].size());
    return true;
  }
  for (const pattern::SeamGuess& g : guesses)
    if (g.certain) {
      source.seams.push_back(g.seam);
      source.findings.push_back({"pattern.seam-guessed"_id, "seam " + g.seam.name + " is guessed"});
    }
  const std::vector<std::string> apart = pattern::panels_apart(source);
  if (document["questions"].empty() && !source.seams.empty() && apart.empty())
    return true;
  std::cout << io::to_text(document);
  tool.reporter().warning({"pattern.seams-guessed"_id,
                           "the file states no seams: " + std::to_string(source.seams.size()) +
                               " are guessed, " + questions(document["questions"].size()) +
                               " open" +
                               (apart.empty() ? "" : ", nothing is found for " + apart.front()) +
                               "; answer the questions on standard output and give them "
                               "as --sewing, take the first answers with --answers first, or "
                               "take the pieces --unsewn; render-png --view pattern --show edges "
                               "draws the edges that are asked for"});
  return false;
}

std::vector<std::string> names_in(const std::string& list) {
  std::vector<std::string> out;
  std::istringstream in(list);
  for (std::string name; std::getline(in, name, ',');)
    if (!name.empty())
      out.push_back(name);
  return out;
}

double metres_per(const std::string& unit) {
  if (unit == "mm")
    return units::MM;
  if (unit == "cm")
    return units::CM;
  if (unit == "in")
    return units::INCH;
  return unit == "m" ? 1 : 0;
}

/// A unit that was stated on the command line and makes the garment one of a giant or a doll is
/// wrong. @throws Error INPUT
void refuse_unit(const pattern::Pattern& source, const Options& o) {
  if (o.unit.empty())
    return;
  for (const pattern::PatternFinding& finding : pattern::check_pattern(source))
    if (finding.rule == "wrong-unit")
      throw input_error("pattern.wrong-unit"_id, o.pattern, finding.place + ", --unit " + o.unit,
                        finding.fact);
}

int run(cli::Tool& tool, const Options& o) {
  pattern::PatternChoice choice{o.sewing,           o.size,      o.grade_rules,
                                metres_per(o.unit), o.allowance, names_in(o.pieces),
                                names_in(o.without)};
  pattern::Pattern source = pattern::read_pattern(o.pattern, choice);
  io::Json edits;
  if (!o.edits.empty())
    edits = io::read_json(o.edits);
  if (!o.undo.empty()) {
    if (o.edits.empty())
      throw Error(ErrorKind::USAGE, "option.needs-another"_id, o.undo, "",
                  "no edits to take back were given", "give --edits too");
    io::write_json(o.undo, pattern::inverse_edits(source, edits, o.edits, tool.name()));
  }
  if (o.check ||
      (o.output.empty() && (!o.write_pattern.empty() || !o.undo.empty()))) { // nothing to mesh
    if (!o.edits.empty()) {
      const pattern::Pattern before = source;
      pattern::apply_edits(source, edits, o.edits);
      if (!o.check) // which lists them
        report_faults_of_edits(tool, before, source);
    }
    if (!o.write_pattern.empty())
      write_pattern(tool, source, o.write_pattern);
    return o.check ? check(tool, source, o) : 0;
  }
  if (!source.open_questions.empty() && !o.unsewn) {
    tool.reporter().warning(
        {"pattern.question-open"_id,
         o.sewing + ": /questions: " + questions(source.open_questions.size()) +
             " not answered, the first about " + source.open_questions.front() +
             "; copy one of its candidates to \"seams\", or take the question out where that edge "
             "stays free"});
    return 1;
  }
  const bool may_lack_seams = source.source_format == "dxf" || source.source_format == "clo";
  const bool guessed =
      source.seams.empty() && may_lack_seams && source.panels.size() > 1 && !o.unsewn;
  if (guessed && !guess_seams(tool, source, o))
    return 1;
  const std::vector<std::string> apart =
      guessed ? pattern::panels_apart(source) : std::vector<std::string>{};
  if (o.output.empty())
    throw Error(ErrorKind::USAGE, "option.missing"_id, "", "", "--output is missing",
                "for example -o panels.json");
  if (!o.body.empty() && pattern::cut_shoulder_folds(source) > 0 && !o.edits.empty()) {
    source = pattern::read_pattern(o.pattern, choice); // edits name the panels of the file
    pattern::apply_edits(source, edits, o.edits);
    pattern::cut_shoulder_folds(source);
    edits = nullptr;
  }
  refuse_unit(source, o);
  pattern::require_sewable(source, o.pattern);
  const auto mesh_source = [&] {
    return pattern::mesh_pattern(
        source, pattern::lengths_for_rolls(source, o.edge_length, o.seam_length), o.pattern);
  };
  pattern::PanelMesh mesh = mesh_source();
  if (!edits.is_null()) {
    const pattern::Pattern before = source;
    pattern::apply_edits(source, edits, o.edits);
    pattern::require_sewable(source, o.pattern);
    if (!pattern::follow_edits(before, source, mesh, LEAST_ANGLE)) {
      mesh = mesh_source();
      mesh.findings.push_back(
          {"mesh.made-anew"_id, "the edits need another mesh: vertex ids are new"});
      tool.reporter().warning(mesh.findings.back());
    }
  }
  if (!o.write_pattern.empty())
    write_pattern(tool, source, o.write_pattern);
  const std::optional<Message> half_sewn = report_faults(tool, source, mesh);
  std::vector<std::string> impossible;
  if (o.body.empty())
    pattern::lay_flat(source, mesh);
  else {
    mesh.body_sha256 = body::skin_sha256(o.body);
    const body::Body body = body::read_body(o.body);
    for (const Message& finding : body.file_findings)
      tool.reporter().warning(finding);
    const pattern::PlacementReport r = pattern::place_panels(source, body, mesh);
    if (r.crossings + r.vertices_inside + r.faces_through > 0)
      tool.reporter().warning(
          {"placement.not-free"_id,
           "the start is not free: " + std::to_string(r.crossings) + " pairs of triangles cross, " +
               std::to_string(r.vertices_inside) + " vertices lie in the body, " +
               std::to_string(r.faces_through) + " faces go through its skin"});
    if (r.is_guess)
      tool.reporter().warning(mesh.findings.back());
    for (const std::string& fact : r.too_tight) {
      mesh.findings.push_back({"placement.too-tight"_id, fact});
      tool.reporter().warning(mesh.findings.back());
    }
    impossible = r.impossible;
    for (const std::string& fact : impossible) {
      mesh.findings.push_back({"placement.impossible"_id, fact});
      mesh.faults.push_back(fact);
    }
    tool.reporter().info("seam gap at the start: mean " + pattern::centimetres(r.seam_gap_mean) +
                         ", largest " + pattern::centimetres(r.seam_gap_max));
  }
  // A drawing that states no seams: they were guessed or answered, and one was missed.
  const bool missed = half_sewn && (guessed || !o.sewing.empty());
  if (missed || !apart.empty())
    add_unsewn(apart, mesh);
  for (const Message& finding : mesh.findings)
    tool.reporter().info(finding.text);
  pattern::write_panel_mesh(o.output, mesh, tool.name());
  if (!impossible.empty())
    throw Error(
        ErrorKind::FAILED, "placement.impossible"_id, o.pattern, "",
        "the panels cannot start so: " + impossible.front(),
        "name the pieces for what they are, or say where they go with a hint (\"place\"); " +
            o.output + " shows where they lie");
  if (!apart.empty())
    throw Error(ErrorKind::FAILED, "pattern.half-sewn"_id, o.pattern, "",
                "nothing is found that " + apart.front() + " is sewn to",
                "leave it out with --without, or name its seam in --sewing; " + o.output +
                    " is written as it is");
  if (missed)
    throw Error(ErrorKind::FAILED, "pattern.half-sewn"_id, o.pattern, "", half_sewn->text,
                "name the seam in --sewing, or cut the piece where a line of its drawing ends; " +
                    o.output + " is written as it is");
  return 0;
}

} // namespace

int main(int argc, char** argv) {
  cli::Tool tool("pattern-mesh", "Mesh a sewing pattern and place its panels around a body");
  Options o;
  add_options(tool, o);
  return tool.run(argc, argv, [&] { return run(tool, o); });
}

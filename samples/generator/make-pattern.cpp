/// Drafts a sewing pattern from body measures: shirt, tshirt, skirt or trousers.
#include "mannequin.hpp"
#include "measures.hpp"
#include "named_length.hpp"
#include <algorithm>
#include <cstdio>
#include <sloper/base/error.hpp>
#include <sloper/cli/run_tool.hpp>

using namespace sloper;

namespace {

using Drafter = samples::Draft (*)(const samples::Measures&);
const std::vector<std::pair<std::string, Drafter>> GARMENTS = {
    {"shirt", samples::draft_shirt},
    {"tshirt", samples::draft_tshirt},
    {"skirt", samples::draft_skirt},
    {"trousers", samples::draft_trousers}};

samples::Draft draft(const std::string& garment, const samples::Measures& measures) {
  std::vector<std::string> names;
  for (const auto& [name, drafter] : GARMENTS) {
    names.push_back(name);
    if (name == garment)
      return drafter(measures);
  }
  throw Error(ErrorKind::USAGE, "option.unknown-word"_id, "", "GARMENT",
              "there is no garment \"" + garment + "\"" + did_you_mean(garment, names, "\""),
              "it makes a shirt, tshirt, skirt or trousers");
}

void set_measures(const std::vector<std::string>& texts, samples::Measures& measures) {
  for (const std::string& text : texts) {
    const auto [name, metres] = samples::named_length("--measure", text);
    samples::set_measure(measures, name, metres);
  }
}

/// A standard figure of the stature that --measure says, or of its own.
samples::Measures standard_figure(const std::vector<std::string>& given) {
  samples::Measures said;
  set_measures(given, said);
  return samples::standard_measures(said.stature);
}

/// Which measures are nobody's own, with their values.
std::string standard_list(const std::vector<std::string>& given) {
  const samples::Measures standard = standard_figure(given);
  std::string list;
  for (const auto& [name, member] : samples::measure_names()) {
    const bool own = std::any_of(given.begin(), given.end(), [n = name](const std::string& text) {
      return text.rfind(n + "=", 0) == 0;
    });
    char value[32];
    std::snprintf(value, sizeof value, " %.1f", 100 * standard.*member);
    if (!own && standard.*member > 0)
      list += (list.empty() ? "" : ", ") + name + value;
  }
  return list.empty() ? "all measures are those of --measure"
                      : "what --measure does not say is of a standard figure, in cm: " + list;
}

} // namespace

int main(int argc, char** argv) {
  cli::Tool tool("make-pattern", "Draft a sewing pattern from body measures");
  std::string names;
  for (const auto& [name, member] : samples::measure_names())
    names += (names.empty() ? "" : ", ") + name;
  std::string garment, body, preset, output;
  std::vector<std::string> given;
  bool band_collar = false, turned_collar = false;
  double flare = 0;
  tool.option(
          "GARMENT", garment,
          "shirt (its collar stands unless --turned-collar is given), tshirt, skirt or trousers")
      .required();
  tool.option("--body", body,
              "take the measures from a body document (or from a mannequin's truth)")
      .check(cli::input_file());
  tool.option("--preset", preset, "take the measures from a mannequin of the family")
      .type_name("NAME");
  tool.option("--measure", given, "set one measure, m: " + names).type_name("NAME=METRES");
  tool.flag("--band-collar", band_collar, "a shirt's collar is its stand alone");
  tool.flag("--turned-collar", turned_collar, "a shirt's collar is turned over its stand");
  tool.option(
          "--flare", flare,
          "m by which each side seam of a skirt leans out more at its hem, on either side of it")
      .check(cli::finite_in(0, 0.25, "m"));
  tool.option("-o,--output", output, "pattern document to write")
      .required()
      .check(cli::output_file_of(".json"));
  tool.example("make-pattern shirt --body body.json -o shirt.pattern.json",
               "a shirt for a measured body");
  tool.example("make-pattern shirt --band-collar --body body.json -o shirt.pattern.json",
               "with a collar that leaves the chin free");
  tool.example("make-pattern shirt --turned-collar --body body.json -o shirt.pattern.json",
               "with its collar turned over");
  tool.example("make-pattern skirt --preset f-165-a -o skirt.pattern.json",
               "a skirt for a mannequin");
  tool.example("make-pattern shirt --measure bust=0.96 --measure waist=0.78 -o shirt.pattern.json",
               "a shirt for these measures");
  tool.formats("body documents (version 1)", "pattern documents (version 1)");
  return tool.run(argc, argv, [&] {
    if (!body.empty() && !preset.empty())
      throw Error(ErrorKind::USAGE, "option.conflict"_id, "", "--body",
                  "cannot be combined with --preset", "leave one of them out");
    samples::Measures measures = standard_figure(given);
    if (!body.empty())
      measures = samples::measures_from_body(io::read_json(body), body);
    else if (!preset.empty())
      measures = samples::measures_from_body(samples::make_mannequin(samples::preset(preset)).truth,
                                             preset);
    set_measures(given, measures);
    samples::Draft made = draft(garment, measures);
    if (flare > 0 && garment != "skirt")
      throw Error(ErrorKind::USAGE, "sample.option-of-another"_id, "", "--flare",
                  "is of skirts, not of a " + garment, "leave it out");
    if (flare > 0)
      made = samples::draft_flared_skirt(measures, flare);
    if (band_collar && garment != "shirt")
      throw Error(ErrorKind::USAGE, "sample.option-of-another"_id, "", "--band-collar",
                  "a " + garment + " has no collar", "leave it out");
    if (turned_collar && (band_collar || garment != "shirt"))
      throw Error(ErrorKind::USAGE, "sample.option-of-another"_id, "", "--turned-collar",
                  "there is no collar to turn", "leave it out");
    if (band_collar)
      made.remove("collar");
    for (samples::DraftPanel& panel : made.panels)
      if (turned_collar && panel.name == "collar")
        panel.roll_edge = "low";
    if (garment == "shirt" && !band_collar && !turned_collar)
      tool.reporter().warning({"sample.collar-stands"_id,
                               "the collar has no roll line and stands up to the chin: say "
                               "--turned-collar to turn it over, or --band-collar to leave it "
                               "out"});
    if (body.empty() && preset.empty())
      tool.reporter().warning(
          {"sample.standard-measures"_id, "no --body is given: " + standard_list(given)});
    if (const std::vector<std::string> faults = samples::draft_faults(made); !faults.empty())
      throw Error(ErrorKind::FAILED, "sample.faulty-draft"_id, body, garment,
                  "these measures give a faulty draft: " + faults.front(), "check the measures");
    io::write_json(output, samples::pattern_document(made));
    return 0;
  });
}

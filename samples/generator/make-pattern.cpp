/// Drafts a sewing pattern from body measures: shirt, tshirt, skirt or trousers.
#include "mannequin.hpp"
#include "measures.hpp"
#include <CLI/CLI.hpp>
#include <base/error.hpp>
#include <cstdio>

using namespace sloper;

namespace {

using Drafter = samples::Draft (*)(const samples::Measures&);
const std::vector<std::pair<std::string, Drafter>> GARMENTS = {
    {"shirt", samples::draft_shirt}, {"tshirt", samples::draft_tshirt}, {"skirt", samples::draft_skirt}, {"trousers", samples::draft_trousers}};

samples::Draft draft(const std::string& garment, const samples::Measures& measures) {
  std::vector<std::string> names;
  for (const auto& [name, drafter] : GARMENTS) {
    names.push_back(name);
    if (name == garment) return drafter(measures);
  }
  const std::string near = nearest_word(garment, names.data(), names.data() + names.size());
  throw Error(ErrorKind::USAGE, "", "GARMENT", "there is no garment \"" + garment + "\"",
              near.empty() ? "shirt, tshirt, skirt or trousers" : "did you mean \"" + near + "\"?");
}

void set_measures(const std::vector<std::string>& texts, samples::Measures& measures) {
  for (const std::string& text : texts) {
    const std::size_t equal = text.find('=');
    double value = 0;
    try {
      if (equal == std::string::npos) throw std::invalid_argument(text);
      value = std::stod(text.substr(equal + 1));
    } catch (const std::logic_error&) {
      throw Error(ErrorKind::USAGE, "", "--measure", "\"" + text + "\" is not NAME=METRES", "for example --measure bust=0.96");
    }
    samples::set_measure(measures, text.substr(0, equal), value);
  }
}

} // namespace

int main(int argc, char** argv) {
  CLI::App app("Drafts a sewing pattern from body measures.", "make-pattern");
  std::string names;
  for (const auto& [name, member] : samples::measure_names()) names += (names.empty() ? "" : ", ") + name;
  app.footer("Examples:\n"
             "  make-pattern shirt --body body.json -o shirt.pattern.json\n"
             "  make-pattern skirt --preset f-165-a -o skirt.pattern.json\n"
             "  make-pattern shirt --measure bust=0.96 --measure waist=0.78 -o shirt.pattern.json\n"
             "Measures: " +
             names);
  std::string garment, body, preset, output;
  std::vector<std::string> given;
  app.add_option("GARMENT", garment, "shirt, tshirt, skirt or trousers")->required();
  auto* from_body = app.add_option("--body", body, "Take the measures from a body document (or from a mannequin's truth)");
  app.add_option("--preset", preset, "Take the measures from a mannequin of the family")->excludes(from_body);
  app.add_option("--measure", given, "NAME=METRES: set one measure");
  app.add_option("-o,--output", output, "Pattern document to write")->required();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  try {
    samples::Measures measures;
    if (!body.empty()) measures = samples::measures_from_body(io::read_json(body), body);
    else if (!preset.empty()) measures = samples::measures_from_body(samples::make_mannequin(samples::preset(preset)).truth, preset);
    set_measures(given, measures);
    const samples::Draft made = draft(garment, measures);
    if (const std::vector<std::string> faults = samples::draft_faults(made); !faults.empty())
      throw Error(ErrorKind::FAILED, body, garment, "these measures give a faulty draft: " + faults.front(), "check the measures");
    io::write_json(output, samples::pattern_document(made));
    return 0;
  } catch (const Error& e) {
    std::fprintf(stderr, "make-pattern: %s\n", e.what());
    return e.exit_code();
  } catch (const std::exception& e) {
    std::fprintf(stderr, "make-pattern: %s\n", e.what());
    return static_cast<int>(ErrorKind::INTERNAL);
  }
}

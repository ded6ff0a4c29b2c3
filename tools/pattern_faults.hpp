#pragma once
/// Faults of a pattern as pattern-mesh reports them: of --check, of panels that are meshed, and of
/// edits.
#include "pattern_options.hpp"

#include <sloper/cli/run_tool.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/measure/finished_measures.hpp>
#include <sloper/pattern/measure/half_sewn.hpp>
#include <sloper/pattern/panel_mesh.hpp>
#include <sloper/pattern/seams/check_pattern.hpp>

#include <algorithm>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

namespace sloper::pattern_faults {

/// Findings to standard output, as JSON too where an output is named. 1 where the pattern cannot be
/// sewn as drawn, or seems to be meant otherwise.
inline int check(const cli::Tool& tool, const pattern::Pattern& source,
                 const pattern_options::Options& o) {
  io::Json document = io::new_document("pattern-findings", 1, tool.name());
  document["findings"] = io::Json::array();
  std::vector<pattern::PatternFinding> findings = pattern::check_pattern(source);
  // What is metres too large takes minutes to measure.
  const bool sewable = std::none_of(findings.begin(), findings.end(), [](const auto& f) {
    return pattern::forbids_sewing(f) || f.rule == "wrong-unit";
  });
  pattern::FinishedMeasures measures;
  if (sewable) {
    measures = pattern::finished_measures(source, o.pattern);
    findings.insert(findings.end(), measures.half_sewn.begin(), measures.half_sewn.end());
  }
  bool bad = false;
  for (const pattern::PatternFinding& f : findings) {
    std::cout << f.severity << ": " << f.rule << ": " << f.place << ": " << f.fact << '\n';
    document["findings"].push_back(
        {{"severity", f.severity}, {"rule", f.rule}, {"place", f.place}, {"fact", f.fact}});
    bad = bad || f.severity == "error";
  }
  if (sewable) { // what the finished garment measures
    for (const pattern::NamedMeasure& m : measures.named)
      std::cout << "measure: " << m.name << ' ' << pattern::centimetres(m.value) << " (" << m.how
                << ")\n";
    for (const pattern::Opening& opening : measures.openings) {
      std::string edges;
      for (const std::string& edge : opening.edges)
        edges += (edges.empty() ? "" : ", ") + edge;
      std::cout << "measure: opening of " << pattern::centimetres(opening.length) << ": " << edges
                << '\n';
    }
    document["measures"] = pattern::measures_json(measures);
  }
  const bool sarif = o.output.size() > 6 && o.output.compare(o.output.size() - 6, 6, ".sarif") == 0;
  if (!o.output.empty())
    io::write_json(o.output,
                   sarif ? pattern::findings_sarif(findings, o.pattern, tool.name()) : document);
  return bad ? 1 : 0;
}

/// Findings of a pattern that can be sewn nevertheless, into the mesh and as warnings.
/// @returns the first edge that is left open though the seams beside it ask for a seam there
inline std::optional<Message> report_faults(cli::Tool& tool, const pattern::Pattern& source,
                                            pattern::PanelMesh& mesh) {
  std::vector<pattern::PatternFinding> findings = pattern::check_pattern(source);
  const std::vector<pattern::PatternFinding> open = pattern::half_sewn(source, mesh);
  findings.insert(findings.end(), open.begin(), open.end());
  std::optional<Message> half_sewn;
  for (const pattern::PatternFinding& f : findings) {
    // A pattern of our own may hold pieces of their own; the other formats are of one garment.
    const bool unsewn = f.rule == "unsewn-panel" && f.severity == "warning" &&
                        !source.seams.empty() && source.source_format != "pattern";
    if (f.severity != "error" && !unsewn)
      continue;
    const bool half = unsewn || f.rule == "loose-part" || f.rule == "half-sewn";
    const Message message = half
                                ? Message{"pattern.half-sewn"_id, f.place + ": " + f.fact}
                                : Message{"pattern.sewn-despite-fault"_id, f.place + ": " + f.fact};
    mesh.findings.push_back(message);
    tool.reporter().warning(message);
    if (f.rule == "half-sewn" && !half_sewn)
      half_sewn = message;
  }
  return half_sewn;
}

/// What is half sewn becomes a fault of the mesh.
/// @param apart  panels that nothing is found for
inline void add_unsewn(const std::vector<std::string>& apart, pattern::PanelMesh& mesh) {
  const std::string half_sewn = "pattern.half-sewn"_id.string();
  for (const Message& finding : mesh.findings)
    if (finding.id == half_sewn)
      mesh.faults.push_back(finding.text);
  if (!mesh.faults.empty())
    return;
  const std::string fact = "nothing is found that " + apart.front() + " is sewn to";
  mesh.findings.push_back({"pattern.half-sewn"_id, fact});
  mesh.faults.push_back(fact);
}

/// Warnings of what edits made wrong: findings of the edited pattern that the one before has not.
inline void report_faults_of_edits(cli::Tool& tool, const pattern::Pattern& before,
                                   const pattern::Pattern& edited) {
  const std::vector<pattern::PatternFinding> known = pattern::check_pattern(before);
  for (const pattern::PatternFinding& f : pattern::check_pattern(edited)) {
    const bool there = std::any_of(known.begin(), known.end(), [&](const auto& k) {
      return k.rule == f.rule && k.place == f.place;
    });
    if (!there && f.severity != "info")
      tool.reporter().warning(
          {"pattern.fault-by-edit"_id, "after the edits: " + f.place + ": " + f.fact});
  }
}

} // namespace sloper::pattern_faults

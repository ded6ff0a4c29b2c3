#pragma once
/// The options of pattern-mesh: their texts.
#include <sloper/cli/run_tool.hpp>

#include <string>

namespace sloper::pattern_options {

/// As the command line has them; empty, 0 or false where an option is not given.
struct Options {
  std::string pattern, output, sewing, body, edits, write_pattern, size, grade_rules, undo, unit,
      pieces, without, answers = "none";
  double edge_length = 0.015, seam_length = 0, allowance = 0;
  bool check = false, unsewn = false;
};

inline void add_options(cli::Tool& tool, Options& o) {
  tool.option("PATTERN", o.pattern,
              "pattern JSON, GarmentCode specification, sewing-spec JSON, pattern JSON of CLO or "
              "AAMA / "
              "ASTM DXF")
      .required()
      .check(cli::input_file());
  tool.option("--edge-length", o.edge_length, "length of mesh edges, m (default: 0.015)")
      .check(cli::finite_in(0.001, 0.2, "m"));
  tool.option("--seam-edge-length", o.seam_length,
              "length of mesh edges along seams and darts, m, growing away from them (default: as "
              "elsewhere)")
      .check(cli::finite_in(0.001, 0.2, "m"));
  tool.option("--body", o.body, "body.json from scan-landmarks: panels are placed around this body")
      .check(cli::input_file());
  tool.option("--edits", o.edits,
              "edits.json: changes of the outline that keep the mesh and its vertex ids where they "
              "can; \"-\" reads standard input")
      .check(cli::input_file());
  tool.option("--undo", o.undo, "write the edits that take --edits back, to the last bit")
      .check(cli::output_file());
  tool.option("--sewing", o.sewing, "sidecar with the seams of a DXF that has none")
      .check(cli::input_file());
  tool.option("--size", o.size, "size to take from a graded DXF (default: its sample size)")
      .type_name("SIZE");
  tool.option("--unit", o.unit, "unit of a DXF, where what it states is wrong")
      .check(cli::one_of({"mm", "cm", "m", "in"}));
  tool.option("--allowance", o.allowance,
              "seam allowance to take off the pieces of a DXF that have no sew line, m")
      .check(cli::finite_in(0, 0.1, "m"));
  tool.option("--pieces", o.pieces,
              "take only these pieces, names with commas between, linings and alternatives among "
              "them too")
      .type_name("LIST");
  tool.option("--without", o.without, "leave these pieces out").type_name("LIST");
  tool.option("--grade-rules", o.grade_rules, "grade rule table (.rul) of a DXF")
      .check(cli::input_file());
  tool.option("--answers", o.answers,
              "first: take the first answer to each question about a DXF that states no seams")
      .check(cli::one_of({"none", "first"}))
      .show_default();
  tool.flag("--unsewn", o.unsewn, "mesh a DXF that states no seams without guessing any");
  tool.option("--write-pattern", o.write_pattern,
              "write the pattern as read and edited: FILE.json (own format), FILE.dxf (AAMA with "
              "sewing texts) or FILE.svg (to look at)")
      .check(cli::output_file());
  tool.option("-o,--output", o.output, "panels.json; panels.obj is written beside it")
      .check(cli::document_file());
  tool.flag("--check", o.check,
            "validate only: findings and finished measures to standard output (as JSON or SARIF to "
            "-o FILE.json or FILE.sarif), exit 1 where the pattern "
            "cannot be sewn as drawn or seems to be meant otherwise");
  tool.example("pattern-mesh --body body.json -o panels.json shirt.pattern.json",
               "mesh a pattern and place it around a scanned body");
  tool.example("pattern-mesh --check shirt.pattern.json",
               "list what is wrong with a pattern without meshing it");
}

} // namespace sloper::pattern_options

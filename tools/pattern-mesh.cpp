/// pattern-mesh: a sewing pattern to meshed, placed panels.
#include <base/progress.hpp>
#include <body/body_json.hpp>
#include <cli/run_tool.hpp>
#include <pattern/mesh_pattern.hpp>
#include <pattern/panel_mesh_json.hpp>
#include <pattern/place_panels.hpp>
#include <pattern/read_pattern.hpp>

using namespace sloper;

namespace {

struct Options {
  std::string pattern, output, sewing, body;
  double edge_length = 0.015;
};

int run(cli::Tool& tool, const Options& o) {
  const pattern::Pattern source = pattern::read_pattern(o.pattern, o.sewing);
  pattern::PanelMesh mesh = pattern::mesh_pattern(source, o.edge_length, o.pattern);
  if (o.body.empty()) pattern::lay_flat(source, mesh);
  else {
    const pattern::PlacementReport r = pattern::place_panels(source, body::read_body(o.body), mesh);
    tool.reporter().info("seam gap at the start: mean " + pattern::centimetres(r.seam_gap_mean) + ", largest " + pattern::centimetres(r.seam_gap_max));
  }
  for (const std::string& finding : mesh.findings) tool.reporter().info(finding);
  pattern::write_panel_mesh(o.output, mesh, tool.name());
  return 0;
}

} // namespace

int main(int argc, char** argv) {
  cli::Tool tool("pattern-mesh", "Mesh a sewing pattern and place its panels around a body");
  Options o;
  CLI::App& app = tool.app();
  app.add_option("PATTERN", o.pattern, "pattern JSON, GarmentCode specification, sewing-spec JSON or AAMA / ASTM DXF")->required()->check(cli::input_file());
  app.add_option("--edge-length", o.edge_length, "length of mesh edges, m (default: 0.015)")->check(cli::finite_in(0.001, 0.2, "m"));
  app.add_option("--body", o.body, "body.json from scan-landmarks: panels are placed around this body")->check(cli::input_file());
  app.add_option("--sewing", o.sewing, "sidecar with the seams of a DXF that has none")->check(cli::input_file());
  app.add_option("-o,--output", o.output, "panels.json; panels.obj is written beside it")->required();
  tool.example("pattern-mesh --body body.json -o panels.json shirt.pattern.json", "mesh a pattern and place it around a scanned body");
  return tool.run(argc, argv, [&] { return run(tool, o); });
}

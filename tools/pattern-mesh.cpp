/// pattern-mesh: a sewing pattern to meshed, placed panels.
#include <base/progress.hpp>
#include <cli/run_tool.hpp>
#include <pattern/mesh_pattern.hpp>
#include <pattern/panel_mesh_json.hpp>
#include <pattern/read_pattern.hpp>

using namespace sloper;

namespace {

struct Options {
  std::string pattern, output, sewing;
  double edge_length = 0.015;
};

int run(cli::Tool& tool, const Options& o) {
  const pattern::Pattern source = pattern::read_pattern(o.pattern, o.sewing);
  const pattern::PanelMesh mesh = pattern::mesh_pattern(source, o.edge_length, o.pattern);
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
  app.add_option("--sewing", o.sewing, "sidecar with the seams of a DXF that has none")->check(cli::input_file());
  app.add_option("-o,--output", o.output, "panels.json; panels.obj is written beside it")->required();
  tool.example("pattern-mesh --body body.json -o panels.json shirt.pattern.json", "mesh a pattern and place it around a scanned body");
  return tool.run(argc, argv, [&] { return run(tool, o); });
}

#include <sloper/garment/fit/slid_down.hpp>

#include <sloper/base/text.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/json.hpp>

#include <algorithm>

namespace sloper::garment {

namespace {

constexpr double EDGE_BAND = 0.03; // m below the highest vertex: the upper edge
// Of the garments of 57 files that came to rest clean none sank by more than 17 cm, of 16 fresh
// ones none by more than 5, and one whose waistband had ended around the thighs by 43.
constexpr double LEAST_SLIDE = 0.25; // m

bool is_about_trunk(const pattern::PanelInfo& panel) {
  return panel.part == "torso" || panel.part == "lower_body" || panel.part == "leg_l" ||
         panel.part == "leg_r";
}

} // namespace

std::optional<UpperEdge> upper_edge(const Garment& garment) {
  const pattern::PanelMesh& mesh = garment.panels;
  if (mesh.placement != pattern::Placement::BODY || garment.particle_of.size() < mesh.placed.size())
    return std::nullopt;
  std::vector<int> vertices;
  double highest = -1e300;
  for (const pattern::PanelInfo& panel : mesh.panels)
    for (int v = panel.first_vertex;
         is_about_trunk(panel) && v < panel.first_vertex + panel.n_vertices; ++v) {
      vertices.push_back(v);
      highest = std::max(highest, mesh.placed[v].y());
    }
  if (vertices.empty())
    return std::nullopt;
  UpperEdge edge;
  double count = 0;
  for (const int v : vertices) {
    if (mesh.placed[v].y() < highest - EDGE_BAND)
      continue;
    edge.placed_m += mesh.placed[v].y();
    edge.height_m += garment.position[garment.particle_of[v]].y();
    ++count;
  }
  edge.placed_m /= count;
  edge.height_m /= count;
  return edge;
}

void judge_slid_down(Garment& garment, const body::Body& body, DrapeOutcome& outcome,
                     const Start& start, std::vector<Message>& findings, Reporter& reporter) {
  DrapeReport& report = outcome.report;
  if (!report.converged || start.body.empty() || start.draped)
    return;
  const std::optional<UpperEdge> edge = upper_edge(garment);
  if (!edge || edge->placed_m - edge->height_m < LEAST_SLIDE)
    return;
  findings.push_back(
      {"drape.slid-down"_id,
       io::file_name(start.file) + " on " + io::file_name(start.body) +
           ": its upper edge hangs at " + centimetres(edge->height_m) + ", " +
           centimetres(edge->placed_m - edge->height_m) +
           " below where it was placed: it slid down as it was sewn, or is too wide to stay up; "
           "look at it (render-png), and take it in, or place its panels nearer to each other"});
  reporter.warning(findings.back());
  if (!body.has_landmark("crotch"))
    return;
  const double crotch = body.landmark("crotch").y();
  if (edge->placed_m < crotch || edge->height_m >= crotch)
    return;
  report.converged = garment.converged = false;
  report.stop_reason = StopReason::MISFIT;
  report.misfit = Misfit::SLIDES_DOWN;
  outcome.document["converged"] = false;
  outcome.document["stop_reason"] = stop_text(report);
}

} // namespace sloper::garment

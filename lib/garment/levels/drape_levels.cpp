#include <base/error.hpp>
#include <collision/topology.hpp>
#include <garment/levels/drape_levels.hpp>
#include <garment/levels/finer_mesh.hpp>
#include <garment/levels/soft_sewing.hpp>
#include <garment/scene/scene.hpp>
#include <garment/simulate/session.hpp>
#include <pattern/mesh/mesh_pattern.hpp>
#include <pattern/pattern.hpp>

#include <algorithm>
#include <chrono>

namespace sloper::garment {

namespace {

constexpr double COARSE_EDGE = 0.048; // m: 300 to 700 particles of a shirt or trousers
constexpr double MOST_EDGE =
    0.03; // m, of the given mesh: with longer ones the coarse mesh saves nothing
constexpr double SOFT_SKIN_TOLERANCE =
    1e-3; // m: by how much a dense skin may be simplified for soft contact
constexpr double WIDEST_GAP = 0.03; // m of a stitch after sewing: beyond, the coarse way has
                                    // failed. Three garments end at 6 to 9 mm
constexpr SoftRelaxing COARSE_RELAXING = {};
constexpr SoftRelaxing FINE_RELAXING = {
    .steps = 15, .bending = 10, .reach_m = 0.008, .last_reach_m = 0.006, .cg_tolerance = 1e-2};
constexpr int CLEARING_ROUNDS = 6;
constexpr double CLEARANCE = 1.1;      // times the contact gap
constexpr double CLEARING_REACH = 0.1; // m

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Particles and faces that are nearer to the skin than the gap go out along its normal.
void clear_of_skin(Garment& garment, const collision::BodyCollider& skin, double gap) {
  const std::vector<Triangle> triangles = garment.particle_triangles();
  const collision::Topology topology = collision::make_topology(garment.position.size(), triangles);
  std::vector<int> hint(garment.position.size(), -1);
  for (int round = 0; round < CLEARING_ROUNDS; ++round) {
    std::vector<Vec3> out(garment.position.size(), Vec3::Zero());
    bool any = false;
    const auto push = [&](std::size_t i, const Vec3& by) {
      any = true;
      if (by.squaredNorm() > out[i].squaredNorm()) out[i] = by;
    };
    for (std::size_t i = 0; i < out.size(); ++i) {
      const collision::SignedDistance d =
          skin.signed_distance(garment.position[i], CLEARING_REACH, hint[i]);
      hint[i] = d.triangle;
      if (d.triangle >= 0 && d.distance < gap) push(i, (gap - d.distance) * d.normal);
    }
    for (const collision::FaceContact& c :
         skin.face_contacts(garment.position, triangles, topology, gap)) {
      if (c.distance >= gap) continue;
      const Triangle& t = triangles[static_cast<std::size_t>(c.triangle)];
      for (std::size_t k = 0; k < 3; ++k)
        push(static_cast<std::size_t>(t[k]), c.barycentric[static_cast<int>(k)] /
                                                 c.barycentric.squaredNorm() * (gap - c.distance) *
                                                 c.normal);
    }
    if (!any) return;
    for (std::size_t i = 0; i < out.size(); ++i) garment.position[i] += out[i];
  }
}

/// The coarse mesh of the pattern, placed as the given panels are.
pattern::PanelMesh coarse_panels(const pattern::PanelMesh& given) {
  pattern::PanelMesh coarse =
      pattern::mesh_pattern(*given.source, COARSE_EDGE, "the pattern of the panels", 0);
  coarse.placed = interpolate(given, given.placed, coarse);
  coarse.placement = given.placement;
  coarse.body_sha256 = given.body_sha256;
  for (pattern::PanelInfo& panel : coarse.panels)
    for (const pattern::PanelInfo& same : given.panels)
      if (same.name == panel.name) panel.part = same.part;
  for (pattern::MeshSeam& seam : coarse.seams)
    for (const pattern::MeshSeam& same : given.seams)
      if (same.name == seam.name) seam.open = same.open;
  return coarse;
}

void prepare(CollisionBody& body, const Garment& garment) {
  body.prepare(body.ends_near(garment.panels.placed));
}

/// @return why it failed; empty: the garment is sewn on the given mesh, near the body
std::string sew_through_coarse_mesh(Garment& garment, const body::Body& body,
                                    const DrapeSettings& settings, Reporter& reporter,
                                    DrapeReport& told) {
  const pattern::PanelMesh given = garment.panels;
  Garment cloth = garment;
  CollisionBody met(&body, SOFT_SKIN_TOLERANCE, reporter);
  const auto began = Clock::now();
  try {
    cloth.panels = coarse_panels(given);
    prepare(met, cloth);
    const SoftSewing sewing = sew_softly(cloth, met, reporter);
    told.steps += sewing.steps;
    if (!sewing.finite) return "coarse cloth diverged";
    if (sewing.widest_gap_m > WIDEST_GAP)
      return "a seam of the coarse mesh stayed open by " + millimetres_text(sewing.widest_gap_m);
    if (!relax_softly(cloth, met, COARSE_RELAXING, settings.gravity_m_s2, reporter))
      return "coarse cloth diverged";
    told.steps += COARSE_RELAXING.steps;
  } catch (const Error& e) { // a pattern too narrow for coarse triangles, a body without bones
    if (e.kind() != ErrorKind::INPUT) throw;
    return e.fact();
  }
  told.phases.emplace_back("sew coarse", seconds_since(began));
  const auto carried = Clock::now();
  Garment fine = on_finer_mesh(cloth, given);
  if (!relax_softly(fine, met, FINE_RELAXING, settings.gravity_m_s2, reporter))
    return "cloth diverged on the given mesh";
  told.steps += FINE_RELAXING.steps;
  clear_of_skin(fine, *met.collider(), CLEARANCE * settings.contact_gap_m);
  told.phases.emplace_back("carry to the mesh", seconds_since(carried));
  garment = std::move(fine);
  return "";
}

bool is_clean(const DrapeReport& report) {
  return report.quality.value("faces_through_body", 0) == 0 &&
         report.quality.value("vertices_inside_body", 0) == 0 &&
         report.quality.value("self_intersections", 0) == 0;
}

/// The settings of `standard`, for a preset that is finer; all knobs that presets leave alone are
/// kept.
DrapeSettings as_standard(DrapeSettings settings) {
  const DrapeSettings standard = preset_settings("standard");
  settings.cg_tolerance = standard.cg_tolerance;
  settings.settle_force_ratio = standard.settle_force_ratio;
  settings.settle_speed_m_s = standard.settle_speed_m_s;
  return settings;
}

bool is_finer_than_standard(const DrapeSettings& settings) {
  return settings.accuracy == "fine" || settings.accuracy == "reference";
}

/// What came before a report is part of it.
void put_before(const DrapeReport& before, DrapeReport& report) {
  report.steps += before.steps;
  report.simulated_s += before.simulated_s;
  report.phases.insert(report.phases.begin(), before.phases.begin(), before.phases.end());
  report.repairs.insert(report.repairs.begin(), before.repairs.begin(), before.repairs.end());
}

DrapeReport run_session(Garment& garment, const body::Body* body, const DrapeSettings& settings,
                        Reporter& reporter, const DrapeRequest& request) {
  return DrapeSession({.garment = garment, .body = body, .request = request}, settings, reporter)
      .run();
}

} // namespace

std::string refusal_of_levels(const Garment& garment, const body::Body* body,
                              const DrapeSettings& settings) {
  if (!garment.panels.source) return "the panels do not name their pattern";
  if (garment.panels.edge_length > MOST_EDGE) return "their mesh is coarse";
  if (!body || body->skin.triangles.empty()) return "there is no body";
  if (garment.panels.seams.empty()) return "nothing is sewn";
  if (!garment.scene.empty()) return "the scene adds effects";
  for (const pattern::Panel& panel : garment.panels.source->panels)
    if (!panel.pleats.empty()) return "pleats are folded on their own mesh";
  if (!garment.rest_scale.empty()) return "rest lengths were edited";
  if (!settings.effects.starts_with("auto") || settings.effects.find("-") != std::string::npos)
    return "effects were chosen by hand";
  if (garment.panels.placed.size() != garment.panels.pattern.size())
    return "the panels are not placed";
  CollisionBody met(body, 0, silent_reporter());
  met.find_arms_aside(garment);
  if (met.state().arms_aside) return "arms are in the way of what is sewn around the lower body";
  return "";
}

DrapeReport drape_through_levels(Garment& garment, const body::Body* body,
                                 const DrapeSettings& settings, Reporter& reporter,
                                 const DrapeRequest& request) {
  const auto began = Clock::now();
  const Garment start = garment;
  const auto drape_at_once = [&](const std::string& why, DrapeReport before) {
    reporter.info("draped on the given mesh alone: " + why);
    before.repairs.push_back("draped on the given mesh alone: " + why);
    garment = start;
    DrapeReport report = run_session(garment, body, settings, reporter, request);
    put_before(before, report);
    report.wall_s = seconds_since(began);
    return report;
  };
  if (const std::string why = refusal_of_levels(garment, body, settings); !why.empty())
    return drape_at_once(why, {});
  DrapeReport before;
  if (const std::string why = sew_through_coarse_mesh(garment, *body, settings, reporter, before);
      !why.empty())
    return drape_at_once(why, before);
  if (is_finer_than_standard(settings))
    put_before(
        std::exchange(before, run_session(garment, body, as_standard(settings), reporter, {})),
        before);
  DrapeReport report = run_session(garment, body, settings, reporter, request);
  const bool interrupted =
      reporter.stop_requested() || report.stop_reason == StopReason::TIME_LIMIT;
  put_before(before, report);
  report.wall_s = seconds_since(began);
  const bool misfit = report.misfit != Misfit::NONE;
  if (interrupted || misfit || (report.converged && is_clean(report))) return report;
  const Garment reached = garment;
  DrapeReport again =
      drape_at_once(report.converged ? "cloth of the coarse way still crossed"
                                     : "cloth of the coarse way did not come to rest",
                    report);
  if (again.converged || !report.converged) return again;
  garment = reached;
  return report;
}

} // namespace sloper::garment

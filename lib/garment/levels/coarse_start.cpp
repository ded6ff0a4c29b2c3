#include <garment/levels/coarse_start.hpp>
#include <garment/levels/finer_mesh.hpp>
#include <garment/levels/soft_sewing.hpp>
#include <garment/levels/turned_leaves.hpp>
#include <garment/scene/fold_edges.hpp>
#include <sloper/base/error.hpp>
#include <sloper/base/parallel.hpp>
#include <sloper/collision/topology.hpp>
#include <sloper/garment/simulate/roll_line_states.hpp>
#include <sloper/garment/simulate/telemetry.hpp>
#include <sloper/garment/simulate/temporary_supports.hpp>
#include <sloper/pattern/mesh/folds.hpp>
#include <sloper/pattern/mesh/mesh_pattern.hpp>
#include <sloper/pattern/pattern.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace sloper::garment {

namespace {

constexpr double COARSE_EDGE = 0.048; // m: 300 to 700 particles of a shirt or trousers
constexpr double MOST_EDGE =
    0.03; // m, of the given mesh: with longer ones the coarse mesh saves nothing
constexpr double SOFT_SKIN_TOLERANCE =
    1e-3; // m: by how much a dense skin may be simplified for soft contact
/// m of a stitch after sewing. Of 10 garments that ended at 15 to 25 mm all came clear when they
/// were carried; of five at 28 to 59 mm three did, and the flounce of one of them stands off, where
/// it hangs in folds when it is sewn on the given mesh.
constexpr double WIDEST_GAP = 0.025;
constexpr SoftRelaxing COARSE_RELAXING = {};
constexpr SoftRelaxing FINE_RELAXING = {
    .steps = 15, .bending = 10, .reach_m = 0.008, .last_reach_m = 0.006, .cg_tolerance = 1e-2};
/// Where a garment is placed on another body, cloth of arm pits is folded into itself. Stiff enough
/// it springs flat, through other cloth: with 30 times its bending a T-shirt kept 144 crossing
/// pairs and two starts 1 um apart ended 8 mm apart, with 3,000 times 2.6 mm, with 30,000 times 1.5
/// mm.
constexpr SoftRelaxing PLACED_RELAXING = {
    .steps = 50, .bending = 3e4, .reach_m = 0.008, .last_reach_m = 0.006, .cg_tolerance = 1e-4};
// Cloth that crosses itself after it was carried springs flat as stiffly as placed cloth relaxes.
// The rest bends 100 times as stiffly meanwhile: of eight garments that crossed seven came clear,
// NTQH0RO1L0 of GarmentCode's random ones not with the fabric's own bending.
constexpr double SPRUNG_REACH = 0.06;  // m, along the cloth from what crosses
constexpr double SPRUNG_BENDING = 3e4; // times the fabric's
constexpr SoftRelaxing SPRINGING = {
    .steps = 40, .bending = 100, .reach_m = 0.006, .last_reach_m = 0.006, .cg_tolerance = 1e-3};
constexpr int CLEARING_ROUNDS = 6;
constexpr double CLEARANCE = 1.1;      // times the contact gap
constexpr double CLEARING_REACH = 0.1; // m
constexpr std::size_t PARTICLE_GRAIN = 128;
constexpr double LEAF_GAP = 0.003; // m between turned cloth and what it lies on

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Particles and faces that are nearer to the skin than the gap go out along its normal.
void clear_of_skin(Garment& garment, const collision::BodyCollider& skin, double gap) {
  const std::vector<Triangle> triangles = garment.particle_triangles();
  const collision::Topology topology = collision::make_topology(garment.position.size(), triangles);
  std::vector<collision::SignedDistance> near(garment.position.size());
  for (int round = 0; round < CLEARING_ROUNDS; ++round) {
    std::vector<Vec3> out(garment.position.size(), Vec3::Zero());
    bool any = false;
    const auto push = [&](std::size_t i, const Vec3& by) {
      any = true;
      if (by.squaredNorm() > out[i].squaredNorm())
        out[i] = by;
    };
    parallel_for(near.size(), PARTICLE_GRAIN, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        near[i] = skin.signed_distance(garment.position[i], CLEARING_REACH, near[i].triangle);
    });
    for (std::size_t i = 0; i < out.size(); ++i)
      if (near[i].triangle >= 0 && near[i].distance < gap)
        push(i, (gap - near[i].distance) * near[i].normal);
    for (const collision::FaceContact& c :
         skin.face_contacts(garment.position, triangles, topology, gap)) {
      if (c.distance >= gap)
        continue;
      const Triangle& t = triangles[c.triangle];
      for (std::size_t k = 0; k < 3; ++k)
        push(static_cast<std::size_t>(t[k]), c.barycentric[static_cast<int>(k)] /
                                                 c.barycentric.squaredNorm() * (gap - c.distance) *
                                                 c.normal);
    }
    if (!any)
      return;
    for (std::size_t i = 0; i < out.size(); ++i)
      garment.position[i] += out[i];
  }
}

/// The coarse mesh of the pattern, placed as the given panels are. It has edges along roll lines:
/// with 48 mm that of a collar of 5 cm would be left out, and the collar would stand.
pattern::PanelMesh coarse_panels(const pattern::PanelMesh& given) {
  pattern::PanelMesh coarse =
      pattern::mesh_pattern(*given.source, pattern::lengths_for_rolls(*given.source, COARSE_EDGE),
                            "the pattern of the panels");
  coarse.placed = interpolate(given, given.placed, coarse);
  take_over(given, coarse);
  return coarse;
}

/// The body as coarse cloth meets it: forearms are out of the way of what is sewn around the lower
/// body, as they are where the given mesh is sewn.
void prepare(CollisionBody& body, const Garment& garment) {
  body.find_arms_aside(garment);
  body.prepare(body.ends_near(garment.panels.placed) |
               (body.state().arms_aside ? ExtremityHulls::HANDS : 0u));
  body.put_arms_aside();
}

/// @return why it failed; empty: the garment is sewn and near its rest, on the coarse mesh
std::string sew(Garment& cloth, CollisionBody& body, const DrapeSettings& settings,
                Reporter& reporter, DrapeReport& report) {
  const SoftSewing sewing = sew_softly(cloth, body, reporter);
  report.steps += sewing.steps;
  if (!sewing.finite)
    return "coarse cloth diverged";
  if (sewing.widest_gap_m > WIDEST_GAP)
    return "a seam of the coarse mesh stayed open by " + millimetres_text(sewing.widest_gap_m);
  const SoftRelaxed relaxed =
      relax_softly(cloth, body, COARSE_RELAXING, settings.gravity_m_s2, reporter);
  if (!relaxed.finite)
    return "coarse cloth diverged";
  report.steps += COARSE_RELAXING.steps;
  report.levels.coarse_edge_m = COARSE_EDGE;
  report.levels.coarse_particles = static_cast<int>(cloth.position.size());
  report.levels.coarse_residual_force_ratio = relaxed.residual_force_ratio;
  return "";
}

/// @return whether any panel was placed in folds
bool forget_folds(pattern::PanelMesh& mesh) {
  bool any = false;
  for (pattern::PanelInfo& panel : mesh.panels) {
    any = any || panel.in_folds;
    panel.in_folds = false;
  }
  return any;
}

} // namespace

std::string sew_on_coarse_mesh(Garment& garment, const body::Body& body,
                               const DrapeSettings& settings, CarriedCrossings crossings,
                               Reporter& reporter, DrapeReport& report) {
  pattern::PanelMesh given = garment.panels;
  if (crossings == CarriedCrossings::SPRUNG) // stiff folds have sunk into each other
    forget_folds(given);
  Garment cloth = garment;
  CollisionBody met(&body, SOFT_SKIN_TOLERANCE, reporter);
  const auto began = Clock::now();
  try {
    cloth.panels = coarse_panels(given);
    cloth.scene.creases.clear(); // roll lines of the pattern are pressed, others come later
    prepare(met, garment);
    std::string why = sew(cloth, met, settings, reporter, report);
    if (!why.empty() && forget_folds(cloth.panels)) // stiff folds may keep a seam from closing
      why = sew(cloth, met, settings, reporter, report);
    if (!why.empty())
      return why;
  } catch (const Error& e) { // a pattern too narrow for coarse triangles, a body without bones
    if (e.kind() != ErrorKind::INPUT)
      throw;
    return e.fact();
  }
  report.phases.emplace_back("sew coarse", seconds_since(began));
  const auto carried = Clock::now();
  Garment fine = on_finer_mesh(cloth, given);
  if (!relax_softly(fine, met, FINE_RELAXING, settings.gravity_m_s2, reporter).finite)
    return "cloth diverged on the given mesh";
  report.steps += FINE_RELAXING.steps;
  if (crossings == CarriedCrossings::SPRUNG) {
    const int rings = static_cast<int>(std::lround(SPRUNG_REACH / given.edge_length));
    const StiffRegion stiff{.particles =
                                near_crossings(fine.position, fine.particle_triangles(), rings),
                            .bending = SPRUNG_BENDING};
    if (!stiff.particles.empty()) {
      if (!spring_softly(fine, met, SPRINGING, stiff, settings.gravity_m_s2).finite)
        return "cloth diverged on the given mesh";
      report.steps += SPRINGING.steps;
    }
  }
  clear_of_skin(fine, *met.collider(), CLEARANCE * settings.contact_gap_m);
  lay_leaves_over(fine, LEAF_GAP);
  report.phases.emplace_back("carry to the mesh", seconds_since(carried));
  if (const std::string stands = standing_text(roll_line_states(fine)); !stands.empty())
    return stands;
  fine.scene = garment.scene;
  for (std::size_t k = 0; k < fine.panels.panels.size(); ++k)
    fine.panels.panels[k].in_folds = garment.panels.panels[k].in_folds;
  garment = std::move(fine);
  return "";
}

/// Whether a scene adds nothing but folds, along edges that the mesh has.
static bool adds_folds_alone(const Garment& garment) {
  SceneEffects others = garment.scene;
  others.creases.clear();
  const auto& folds = garment.scene.creases;
  return others.empty() && std::all_of(folds.begin(), folds.end(), [&](const SceneCrease& fold) {
           return is_meshed(garment, fold);
         });
}

/// Why soft sewing and relaxing do not know all of this scene; empty: they do.
static std::string refusal_of_soft_cloth(const Garment& garment, const DrapeSettings& settings) {
  if (!adds_folds_alone(garment))
    return "the scene adds effects";
  if (garment.panels.source)
    for (const pattern::Panel& panel : garment.panels.source->panels)
      if (!panel.pleats.empty())
        return "pleats are folded on their own mesh";
  if (!settings.effects.starts_with("auto") || settings.effects.find("-") != std::string::npos)
    return "effects were chosen by hand";
  return "";
}

std::string refusal_of_levels(const Garment& garment, const body::Body* body,
                              const DrapeSettings& settings) {
  if (!garment.panels.source)
    return "the panels do not name their pattern";
  if (garment.panels.edge_length > MOST_EDGE)
    return "their mesh is coarse";
  if (!body || body->skin.triangles.empty())
    return "there is no body";
  if (garment.panels.seams.empty())
    return "nothing is sewn";
  if (std::string why = refusal_of_soft_cloth(garment, settings); !why.empty())
    return why;
  if (!garment.rest_scale.empty())
    return "rest lengths were edited";
  if (garment.panels.placed.size() != garment.panels.pattern.size())
    return "the panels are not placed";
  return "";
}

std::string relax_where_placed(Garment& garment, const body::Body& body,
                               const DrapeSettings& settings, Reporter& reporter,
                               DrapeReport& report) {
  if (settings.levels < 2)
    return "it is to be draped as it lies";
  if (std::string why = refusal_of_soft_cloth(garment, settings); !why.empty())
    return why;
  if (!garment.scene.empty() || !roll_line_states(garment).empty())
    return "stiff cloth would turn back what is folded over";
  Garment cloth = garment;
  CollisionBody met(&body, SOFT_SKIN_TOLERANCE, reporter);
  met.prepare(met.ends_near(garment.position));
  const auto began = Clock::now();
  if (!relax_softly(cloth, met, PLACED_RELAXING, settings.gravity_m_s2, reporter).finite)
    return "placed cloth diverged";
  report.steps += PLACED_RELAXING.steps;
  clear_of_skin(cloth, *met.collider(), CLEARANCE * settings.contact_gap_m);
  report.phases.emplace_back("relax where placed", seconds_since(began));
  report.wall_s += seconds_since(began);
  garment = std::move(cloth);
  return "";
}

} // namespace sloper::garment

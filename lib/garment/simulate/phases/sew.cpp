#include <sloper/base/units.hpp>
#include <sloper/garment/sewing.hpp>
#include <sloper/garment/simulate/phases/sew.hpp>
#include <sloper/io/json.hpp>
#include <sloper/io/json_lists.hpp>

#include <algorithm>

namespace sloper::garment {

namespace {

constexpr double SEWN_GAP = 5e-4; // m: a stitch this short is welded
constexpr int SEW_STEPS = 600;    // at most
constexpr double SEW_PULL = 10;   // of a stitch at reach, in weights of a particle
constexpr double SEW_MOVE = 0.8;  // of the mesh edge: of any particle in one step
constexpr double SEW_GROWTH =
    1.6; // of the pull where seams hardly close on, in five steps by a part of SEW_SLOW
constexpr double SEW_SLOW = 0.06; // at 0.04 a tenth more steps; at 0.1 a long sleeve is strained by
                                  // up to 20 % instead of 10
constexpr double SEW_STEP_S = 0.1;
constexpr double SEW_STRONGEST = 20; // N at reach: closes seams of garments that fit tightly
constexpr int SEW_LOOK_BACK = 5;     // steps over which closing is judged
constexpr int SEW_LAST_CHANCE = 20;  // steps at the strongest pull before open seams are welded
constexpr double SEW_PROGRESS = 0.4; // of the progress bar

} // namespace

bool SewPhase::is_needed(const SimContext& context) const {
  return context.cloth.is_active("sewing");
}

void SewPhase::begin(SimContext& context, bool resumed) {
  if (resumed)
    return;
  context.build_cloth(true);
  context.resolver.log_crossings("start");
  const cloth::ClothMesh& mesh = context.cloth.mesh();
  double weight = 0;
  for (double m : mesh.mass)
    weight += m * units::GRAVITY / mesh.n_particles;
  m_state.step = 0;
  m_state.pull = SEW_PULL * weight;
}

/// Raises the pull where seams hardly close on. @return false where they will not come closer
bool SewPhase::adapt_pull() {
  const int k = m_state.step;
  const std::vector<double>& gaps = m_state.gaps;
  const bool slow = k >= m_state.pull_changed + SEW_LOOK_BACK &&
                    gaps[k] > (1 - SEW_SLOW) * gaps[k - SEW_LOOK_BACK];
  if (!slow)
    return true;
  if (m_state.pull >= SEW_STRONGEST)
    return k < m_state.pull_changed + SEW_LAST_CHANCE;
  m_state.pull = std::min(SEW_GROWTH * m_state.pull, SEW_STRONGEST);
  m_state.pull_changed = k;
  return true;
}

PhaseStatus SewPhase::step(SimContext& context) {
  if (m_state.step >= SEW_STEPS) {
    weld_seams(context);
    return PhaseStatus::DONE;
  }
  context.checkpoints->offer();
  SimulatedCloth& cloth = context.cloth;
  cloth.sewing()->set_stiffness(m_state.pull / SEW_REACH);
  const double gap = cloth.sewing()->widest(cloth.x()).length;
  m_state.gaps.push_back(gap);
  context.telemetry.reporter.progress("sew", SEW_PROGRESS * m_state.step / SEW_STEPS);
  if (m_state.step % 20 == 0)
    context.telemetry.reporter.info("sew step " + std::to_string(m_state.step) + ": largest gap " +
                                    millimetres_text(gap) + ", pull " +
                                    std::to_string(m_state.pull) + " N");
  if (gap < SEWN_GAP || !adapt_pull()) {
    weld_seams(context);
    return PhaseStatus::DONE;
  }
  if (!context.stepper.advance(
          {.h = SEW_STEP_S, .kind = StepKind::SEW, .largest_move_m = SEW_MOVE * cloth.mean_edge()}))
    return PhaseStatus::STOP;
  ++m_state.step;
  return PhaseStatus::CONTINUE;
}

void SewPhase::weld_seams(SimContext& context) const {
  Garment& garment = context.cloth.garment();
  const auto [gap, where] = context.cloth.sewing()->widest(garment.position);
  if (gap > 5 * SEWN_GAP)
    context.telemetry.add_repair("seams were still open by " + millimetres_text(gap) + " at " +
                                 place_text(where) + " when they were welded");
  std::vector<Vec3> vertex_position(garment.particle_of.size());
  for (std::size_t v = 0; v < vertex_position.size(); ++v)
    vertex_position[v] = garment.position[garment.particle_of[v]];
  context.resolver.log_crossings("sewn");
  weld(garment, vertex_position);
  context.resolver.log_crossings("welded");
  context.supports.find_tangles();
}

} // namespace sloper::garment

/// The parts of a drape that draw crossing cloth apart and out of the body, and the run that does nothing else.
#include <collision/untangle.hpp>
#include <garment/scene/effects.hpp>
#include <garment/simulate/drape_run.hpp>

#include <algorithm>
#include <base/error.hpp>
#include <cmath>

namespace sloper::garment {

namespace {

constexpr int UNTANGLE_ROUNDS = 80;
constexpr double UNTANGLE_STEP = 0.001;                // m: of an edge against its face in one round
constexpr int PART_ROUNDS = 300;                       // of untangling with the body in the way
constexpr double PART_STEP = 0.004;                    // m: of a particle out of the body in one round
constexpr double PART_CLEAR = 5e-4;                    // m: what was in the body ends this far outside
constexpr int SETTLING_ROUNDS = 60, MOST_PARTINGS = 4; // while the garment settles
constexpr double FEW = 0.01;                           // of the faces: more is no pinch but a garment too small
constexpr double FEW_AT_START = 0.03;                  // likewise: nothing pulls yet
constexpr double PART_REACH = 0.3;                     // m: deeper cloth has no way out along the skin's normal

} // namespace

void DrapeRun::log_crossings(const char* when) const {
  const std::vector<Triangle> triangles = m_garment.particle_triangles();
  const collision::TriangleTree tree(m_garment.position, triangles);
  m_reporter.info(std::string(when) + ": " + std::to_string(collision::self_intersections(m_garment.position, triangles, tree).size()) +
                  " pairs of triangles cross");
}

std::size_t DrapeRun::untangle() {
  const std::vector<Triangle> triangles = m_garment.particle_triangles();
  const collision::Topology topology = collision::make_topology(m_garment.position.size(), triangles);
  std::vector<Vec3> x = m_garment.position;
  collision::TriangleTree tree(x, triangles);
  std::size_t at_start = 0, least = std::numeric_limits<std::size_t>::max();
  for (int k = 0; k < UNTANGLE_ROUNDS; ++k) {
    tree.refit(x);
    const std::size_t count = collision::self_intersections(x, triangles, tree).size();
    if (k == 0) at_start = count;
    if (count < least) {
      least = count;
      m_garment.position = x;
    }
    if (count == 0) break;
    const auto pairs = collision::untangle_directions(x, triangles, topology, tree);
    const std::vector<Vec3> move = collision::untangle_displacements(pairs, triangles, topology, x.size(), UNTANGLE_STEP);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += move[i];
  }
  if (at_start > 0) m_report.repairs.push_back("untangled: " + std::to_string(at_start) + " pairs of triangles crossed, " + std::to_string(least) + " remain");
  return least;
}

void DrapeRun::untangle_now() {
  ++m_at.untanglings;
  m_garment.position = m_solver->x();
  untangle();
  m_solver->set_positions(m_garment.position);
  m_self_contact->refresh();
  if (m_body_contact) m_body_contact->refresh();
}

/// What of the garment crosses the skin or lies inside goes out along the skin's normal; moves are added to `move` where they are longer.
std::size_t DrapeRun::part_from_body(const std::vector<Vec3>& x, const std::vector<Triangle>& triangles, std::vector<Vec3>& move) const {
  if (!m_collider) return 0;
  std::size_t trouble = 0;
  std::vector<Vec3> out(x.size(), Vec3::Zero());
  const auto push = [&](int i, const Vec3& by) {
    const double length = by.norm();
    const Vec3 limited = length > PART_STEP ? Vec3(PART_STEP / length * by) : by;
    if (limited.squaredNorm() > out[i].squaredNorm()) out[i] = limited;
  };
  for (std::size_t i = 0; i < x.size(); ++i) {
    const collision::SignedDistance d = m_collider->signed_distance(x[i], PART_REACH);
    const bool inside = d.triangle >= 0 ? d.distance < 0 : m_collider->is_inside(x[i]);
    if (!inside) continue;
    ++trouble;
    if (d.triangle >= 0) push(static_cast<int>(i), (PART_CLEAR - d.distance) * d.normal);
  }
  const std::vector<int> through = m_collider->faces_through(x, triangles);
  trouble += through.size();
  std::vector<Triangle> crossing;
  for (int f : through) crossing.push_back(triangles[f]);
  for (const collision::FaceContact& c : m_collider->face_contacts(x, crossing, PART_STEP)) { // skin that shows through between particles
    if (c.distance >= PART_CLEAR) continue;
    const double share = c.barycentric.squaredNorm();
    for (int k = 0; k < 3; ++k) push(crossing[c.triangle][k], c.barycentric[k] / share * (PART_CLEAR - c.distance) * c.normal);
  }
  for (int f : through) // what neither found: straight out
    if (out[triangles[f][0]].isZero() && out[triangles[f][1]].isZero() && out[triangles[f][2]].isZero())
      for (int i : triangles[f]) push(i, UNTANGLE_STEP * m_collider->signed_distance(x[i], PART_REACH).normal);
  for (std::size_t i = 0; i < x.size(); ++i) move[i] += out[i];
  return trouble;
}

/// Short moves of what crosses, and of nothing else, in at most so many rounds. What remains.
std::size_t DrapeRun::part_all(int most_rounds, int& rounds) {
  const std::vector<Triangle> triangles = m_garment.particle_triangles();
  const collision::Topology topology = collision::make_topology(m_garment.position.size(), triangles);
  std::vector<Vec3> x = m_garment.position;
  collision::TriangleTree tree(x, triangles);
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (rounds = 0; rounds < most_rounds && !m_reporter.stop_requested(); ++rounds) {
    m_reporter.progress("untangle", static_cast<double>(rounds) / most_rounds);
    tree.refit(x);
    const auto pairs = collision::untangle_directions(x, triangles, topology, tree);
    std::vector<Vec3> move = collision::untangle_displacements(pairs, triangles, topology, x.size(), UNTANGLE_STEP);
    const std::size_t count = collision::self_intersections(x, triangles, tree).size() + part_from_body(x, triangles, move);
    if (count < least) {
      least = count;
      m_garment.position = x;
    }
    if (count == 0) break;
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += move[i];
  }
  return least;
}

/// A garment that was in order but for a little, as where another was tucked below it: drawing in the body would undo how it hangs.
bool DrapeRun::part_few_at_start(std::size_t trouble) {
  if (static_cast<double>(trouble) > FEW_AT_START * static_cast<double>(m_garment.panels.triangles.size())) return false;
  const std::vector<Vec3> start = m_garment.position;
  int rounds = 0;
  if (part_all(SETTLING_ROUNDS, rounds) > 0) {
    m_garment.position = start;
    return false;
  }
  m_report.repairs.push_back("start: " + std::to_string(trouble) + " vertices or faces in the body moved out");
  return true;
}

/// Contact alone does not free cloth whose other side is held too, as in the fold of an arm pit.
bool DrapeRun::part_the_few() {
  if (!m_body_contact || m_at.partings >= MOST_PARTINGS) return false;
  const std::size_t through = m_body_contact->n_crossing();
  if (through == 0 || static_cast<double>(through) > FEW * static_cast<double>(m_cloth->triangles.size())) return false;
  ++m_at.partings;
  m_garment.position = m_solver->x();
  int rounds = 0;
  const std::size_t remain = part_all(SETTLING_ROUNDS, rounds);
  m_report.repairs.push_back("step " + std::to_string(m_report.steps) + ": " + std::to_string(through) + " faces through the skin moved out, " +
                             std::to_string(remain) + " crossings remain");
  m_solver->set_positions(m_garment.position);
  m_body_contact->refresh();
  if (m_self_contact) m_self_contact->refresh();
  return true;
}

DrapeReport DrapeRun::run_untangle_only() {
  if (m_garment.particle_of.empty()) throw input_error("", "", "the garment is not sewn yet", "drape it first");
  m_report.effects = choose_effects(m_garment, m_body, m_settings);
  for (EffectReport& e : m_report.effects) e.active = e.active && (e.name == "body_contact" || e.name == "self_contact");
  if (m_body && !m_body->skin.triangles.empty()) collide_with(m_body->skin);
  const auto counts = [&] {
    const Audit a = audit(m_garment, m_collider ? &*m_collider : nullptr);
    return io::Json{
        {"faces_through_body", a.through.size()}, {"vertices_inside_body", a.inside.size()}, {"deepest_m", a.deepest_m}, {"self_intersections", a.self.size()}};
  };
  const io::Json before = counts();
  const std::vector<Vec3> start = m_garment.position;
  const bool was_at_rest = m_garment.converged;
  std::size_t least = 0;
  {
    const Phase phase(*this, "untangle");
    least = part_all(PART_ROUNDS, m_report.steps);
  }
  if (least > 0 && m_collider && !m_reporter.stop_requested()) { // deep: the body is drawn in, the cloth makes room as it comes back
    const std::vector<Vec3> shallow = m_garment.position;
    m_garment.position = start;
    m_report.effects = choose_effects(m_garment, m_body, m_settings);
    start_outside_body(false);
    untangle();
    build_solver(false);
    inflate();
    for (int k = 0; k < MOST_PUSH_STEPS && !m_stopped && m_body_contact && m_body_contact->n_crossing() > 0; ++k) step(m_settings.time_step_s, 0);
    m_garment.position = m_solver->x();
    report_effects();
    m_solver.reset();
    meet_bare_skin();
    const std::size_t now = part_all(PART_ROUNDS, m_report.steps); // what the push leaves is shallow
    if (now >= least) m_garment.position = shallow;
    least = std::min(least, now);
  }
  double farthest = 0;
  std::size_t moved = 0;
  for (std::size_t i = 0; i < start.size(); ++i) {
    const double way = (m_garment.position[i] - start[i]).norm();
    moved += way > 0;
    farthest = std::max(farthest, way);
  }
  finish();
  const io::Json after = counts();
  m_report.converged = after["faces_through_body"] == 0 && after["vertices_inside_body"] == 0 && after["self_intersections"] == 0;
  m_report.stop_reason = !m_report.converged ? "crossings remain" : moved == 0 ? "nothing crossed" : "nothing crosses any more";
  m_garment.converged = was_at_rest && moved == 0;
  m_report.quality["untangled"] = {{"before", before}, {"after", after}, {"particles_moved", moved}, {"farthest_m", farthest}};
  m_report.wall_s = elapsed();
  return std::move(m_report);
}

DrapeReport untangle_only(Garment& garment, const body::Body* body, const DrapeSettings& settings, Reporter& reporter) {
  DrapeReport report = DrapeRun(garment, body, settings, reporter).run_untangle_only();
  std::string told;
  bool crossed = false;
  for (const char* when : {"before", "after"}) {
    const io::Json& c = report.quality["untangled"][when];
    told += (told.empty() ? "" : "; ") + std::string(when) + ": " + c["faces_through_body"].dump() + " faces through the body, " +
            c["vertices_inside_body"].dump() + " vertices inside it, " + c["self_intersections"].dump() + " self intersections";
    crossed |= c["faces_through_body"] != 0 || c["vertices_inside_body"] != 0 || c["self_intersections"] != 0;
  }
  if (crossed) reporter.warning(told);
  else reporter.info(told);
  return report;
}

} // namespace sloper::garment

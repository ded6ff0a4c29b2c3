#include <garment/simulate/audit.hpp>
#include <sloper/collision/intersections.hpp>
#include <sloper/collision/untangle.hpp>
#include <sloper/garment/simulate/penetration_resolver.hpp>
#include <sloper/io/json.hpp>

#include <limits>

namespace sloper::garment {

namespace {

constexpr int UNTANGLE_ROUNDS = 80;
constexpr double UNTANGLE_STEP = 0.001; // m: of an edge against its face in one round
constexpr double PART_STEP = 0.004;     // m: of a particle out of the body in one round
constexpr double PART_CLEAR = 5e-4;     // m: what was in the body ends this far outside
constexpr int SETTLING_ROUNDS = 60;     // while the garment settles
constexpr int MAX_PARTINGS = 4;         // in which cloth is parted from the body, while it settles
constexpr double MOST_IN_FLIGHT = 0.01; // of the faces: more is no pinch but a garment too small
constexpr double MOST_AT_START = 0.03;  // of the faces, before sewing: nothing pulls yet
constexpr double PART_REACH = 0.3;      // m: deeper cloth does not get out along the skin's normal

} // namespace

PenetrationResolver::PenetrationResolver(SimulatedCloth& cloth, CollisionBody& body,
                                         Telemetry& telemetry)
    : m_cloth(cloth), m_body(body), m_telemetry(telemetry) {}

std::size_t PenetrationResolver::count_in_body() const {
  const collision::BodyCollider* skin = m_body.collider();
  const std::vector<Vec3>& position = m_cloth.garment().position;
  return skin->faces_through(position, m_cloth.garment().particle_triangles()).size() +
         inside_body(position, *skin).size();
}

void PenetrationResolver::log_crossings(const char* when) const {
  const std::vector<Vec3>& position = m_cloth.garment().position;
  const std::vector<Triangle> triangles = m_cloth.garment().particle_triangles();
  const collision::TriangleTree tree(position, triangles);
  m_telemetry.reporter.info(
      std::string(when) + ": " +
      std::to_string(collision::self_intersections(position, triangles, tree).size()) +
      " pairs of triangles cross");
}

std::size_t PenetrationResolver::untangle() {
  std::vector<Vec3>& position = m_cloth.garment().position;
  const std::vector<Triangle> triangles = m_cloth.garment().particle_triangles();
  const collision::Topology topology = collision::make_topology(position.size(), triangles);
  std::vector<Vec3> x = position;
  collision::TriangleTree tree(x, triangles);
  std::size_t at_start = 0, least = std::numeric_limits<std::size_t>::max();
  for (int k = 0; k < UNTANGLE_ROUNDS; ++k) {
    tree.refit(x);
    const std::size_t count = collision::self_intersections(x, triangles, tree).size();
    if (k == 0)
      at_start = count;
    if (count < least) {
      least = count;
      position = x;
    }
    if (count == 0)
      break;
    const auto pairs = collision::untangle_directions(x, triangles, topology, tree);
    const std::vector<Vec3> move =
        collision::untangle_displacements(pairs, triangles, topology, x.size(), UNTANGLE_STEP);
    for (std::size_t i = 0; i < x.size(); ++i)
      x[i] += move[i];
  }
  if (at_start > 0)
    m_telemetry.add_repair("untangled: " + std::to_string(at_start) +
                           " pairs of triangles crossed, " + std::to_string(least) + " remain");
  return least;
}

void PenetrationResolver::untangle_in_flight() {
  ++m_state.untanglings;
  untangle();
  m_cloth.positions_changed();
}

/// Pushes what of the garment crosses the skin or lies inside out along the skin's normal. @param
/// move  #P by 3, m, in and out: the moves are added
/// @return vertices inside and faces through the skin
std::size_t PenetrationResolver::push_out_of_body(const std::vector<Vec3>& x,
                                                  const std::vector<Triangle>& triangles,
                                                  std::vector<Vec3>& move) const {
  const collision::BodyCollider* skin = m_body.collider();
  if (!skin)
    return 0;
  std::size_t violations = 0;
  std::vector<Vec3> out(x.size(), Vec3::Zero());
  const auto push = [&](int i, const Vec3& by) {
    const double length = by.norm();
    const Vec3 limited = length > PART_STEP ? Vec3(PART_STEP / length * by) : by;
    if (limited.squaredNorm() > out[i].squaredNorm())
      out[i] = limited;
  };
  for (std::size_t i = 0; i < x.size(); ++i) {
    const collision::SignedDistance d = skin->signed_distance(x[i], PART_REACH);
    const bool inside = d.triangle >= 0 ? d.distance < 0 : skin->is_inside(x[i]);
    if (!inside)
      continue;
    ++violations;
    if (d.triangle >= 0)
      push(static_cast<int>(i), (PART_CLEAR - d.distance) * d.normal);
  }
  const std::vector<int> through = skin->faces_through(x, triangles);
  violations += through.size();
  std::vector<Triangle> crossing;
  for (int f : through)
    crossing.push_back(triangles[f]);
  for (const collision::FaceContact& c :
       skin->face_contacts(x, crossing, PART_STEP)) { // skin that shows through between particles
    if (c.distance >= PART_CLEAR)
      continue;
    const double share = c.barycentric.squaredNorm();
    for (int k = 0; k < 3; ++k)
      push(crossing[c.triangle][k],
           c.barycentric[k] / share * (PART_CLEAR - c.distance) * c.normal);
  }
  for (int f : through) // what neither found: straight out
    if (out[triangles[f][0]].isZero() && out[triangles[f][1]].isZero() &&
        out[triangles[f][2]].isZero())
      for (int i : triangles[f])
        push(i, UNTANGLE_STEP * skin->signed_distance(x[i], PART_REACH).normal);
  for (std::size_t i = 0; i < x.size(); ++i)
    move[i] += out[i];
  return violations;
}

std::size_t PenetrationResolver::resolve_all(int max_rounds, int& rounds) {
  std::vector<Vec3>& position = m_cloth.garment().position;
  const std::vector<Triangle> triangles = m_cloth.garment().particle_triangles();
  const collision::Topology topology = collision::make_topology(position.size(), triangles);
  std::vector<Vec3> x = position;
  collision::TriangleTree tree(x, triangles);
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (rounds = 0; rounds < max_rounds && !m_telemetry.reporter.stop_requested(); ++rounds) {
    m_telemetry.reporter.progress("untangle", static_cast<double>(rounds) / max_rounds);
    tree.refit(x);
    const auto pairs = collision::untangle_directions(x, triangles, topology, tree);
    std::vector<Vec3> move =
        collision::untangle_displacements(pairs, triangles, topology, x.size(), UNTANGLE_STEP);
    const std::size_t count = collision::self_intersections(x, triangles, tree).size() +
                              push_out_of_body(x, triangles, move);
    if (count < least) {
      least = count;
      position = x;
    }
    if (count == 0)
      break;
    for (std::size_t i = 0; i < x.size(); ++i)
      x[i] += move[i];
  }
  return least;
}

bool PenetrationResolver::resolve_initial(std::size_t violations) {
  if (static_cast<double>(violations) >
      MOST_AT_START * static_cast<double>(m_cloth.garment().panels.triangles.size()))
    return false;
  std::vector<Vec3>& position = m_cloth.garment().position;
  const std::vector<Vec3> start = position;
  int rounds = 0;
  if (resolve_all(SETTLING_ROUNDS, rounds) > 0) {
    position = start;
    return false;
  }
  m_telemetry.add_repair("start: " + std::to_string(violations) +
                         " vertices or faces in the body moved out");
  return true;
}

bool PenetrationResolver::resolve_residual() {
  const cloth::BodyContactEffect* contact = m_cloth.body_contact();
  if (!contact || m_state.partings >= MAX_PARTINGS)
    return false;
  const std::size_t through = contact->n_crossing();
  if (through == 0 || static_cast<double>(through) >
                          MOST_IN_FLIGHT * static_cast<double>(m_cloth.mesh().triangles.size()))
    return false;
  ++m_state.partings;
  int rounds = 0;
  const std::size_t remain = resolve_all(SETTLING_ROUNDS, rounds);
  m_telemetry.add_repair("step " + std::to_string(m_telemetry.report.steps) + ": " +
                         std::to_string(through) + " faces through the skin moved out, " +
                         std::to_string(remain) + " crossings remain");
  m_cloth.positions_changed();
  return true;
}

} // namespace sloper::garment

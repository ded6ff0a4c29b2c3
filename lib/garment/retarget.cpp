#include <garment/retarget.hpp>

#include <base/error.hpp>
#include <collision/intersections.hpp>
#include <garment/bind.hpp>
#include <garment/bind_frames.hpp>
#include <garment/bind_laplacian.hpp>
#include <garment/retarget_grade.hpp>

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>

namespace sloper::garment {

namespace {

constexpr double CLEAR_LENGTH = 0.04;   // m over which a push is spread
constexpr double CLEAR_STIFFNESS = 200; // of a push against the spreading
constexpr double SEARCH_DEPTH = 0.15;   // m, deeper is not looked for
constexpr double FINAL_GAP_SHARE = 0.5; // of the gap: near enough to stop

using Field = Eigen::Matrix<double, Eigen::Dynamic, 3>;

PlacementState state_of(const std::vector<Vec3>& x, const std::vector<Triangle>& triangles, const collision::BodyCollider& body) {
  PlacementState state;
  for (const Vec3& p : x) {
    const double d = body.signed_distance(p, SEARCH_DEPTH).distance;
    if (d >= 0) continue;
    ++state.vertices_inside;
    state.deepest_m = std::max(state.deepest_m, -d);
  }
  state.faces_through = static_cast<int>(body.faces_through(x, triangles).size());
  const collision::TriangleTree tree(x, triangles);
  state.self_intersections = static_cast<int>(collision::self_intersections(x, triangles, tree).size());
  return state;
}

io::Json state_json(const PlacementState& s) {
  return {{"vertices_inside_body", s.vertices_inside},
          {"deepest_m", s.deepest_m},
          {"faces_through_body", s.faces_through},
          {"self_intersections", s.self_intersections}};
}

/// Pushes of one round: for each particle the largest wanted move.
class Pushes {
public:
  explicit Pushes(std::size_t n) : m_push(n, Vec3::Zero()), m_active(n, 0) {}
  void add(int particle, const Vec3& push) {
    if (push.squaredNorm() > m_push[particle].squaredNorm()) m_push[particle] = push;
    m_active[particle] = 1;
  }
  const Vec3& operator[](std::size_t i) const { return m_push[i]; }
  bool active(std::size_t i) const { return m_active[i] != 0; }

private:
  std::vector<Vec3> m_push;
  std::vector<char> m_active;
};

} // namespace

RetargetMode retarget_mode_from_name(const std::string& name) {
  if (name == "keep-fabric") return RetargetMode::KEEP_FABRIC;
  if (name == "keep-fit") return RetargetMode::KEEP_FIT;
  throw Error(ErrorKind::USAGE, "", "--mode", "\"" + name + "\" is not a mode", "use keep-fabric or keep-fit");
}

io::Json placement_json(const PlacementReport& r) {
  return {{"placed", state_json(r.placed)},
          {"cleared", state_json(r.cleared)},
          {"clear_rounds", r.clear_rounds},
          {"largest_move_m", r.largest_move_m},
          {"stretch", {{"p01", r.stretch_p01}, {"p50", r.stretch_p50}, {"p99", r.stretch_p99}}}};
}

int clear_skin(std::vector<Vec3>& positions, const std::vector<Triangle>& triangles, const collision::BodyCollider& body, double gap, int max_rounds) {
  const std::size_t n = positions.size();
  const std::vector<Vec3> start = positions;
  const collision::Topology topology = collision::make_topology(n, triangles);
  const SurfaceOperators ops = surface_operators(start, triangles);
  Field move = Field::Zero(static_cast<Eigen::Index>(n), 3);
  std::vector<char> held(n, 0);
  std::vector<int> hint(n, -1);
  for (int round = 0; round < max_rounds; ++round) {
    Pushes pushes(n);
    double worst = gap;
    for (std::size_t i = 0; i < n; ++i) {
      const collision::SignedDistance d = body.signed_distance(positions[i], SEARCH_DEPTH, hint[i]);
      if (d.triangle >= 0) hint[i] = d.triangle;
      if (d.distance >= gap) continue;
      worst = std::min(worst, d.distance);
      pushes.add(static_cast<int>(i), (gap - d.distance) * d.normal);
    }
    for (const collision::FaceContact& c : body.face_contacts(positions, triangles, topology, std::max(gap, 0.01))) {
      if (c.distance >= gap) continue;
      worst = std::min(worst, c.distance);
      const double share = c.barycentric.squaredNorm();
      for (int k = 0; k < 3; ++k)
        if (c.barycentric[k] > 0) pushes.add(triangles[c.triangle][k], (gap - c.distance) * c.barycentric[k] / share * c.normal);
    }
    if (worst >= FINAL_GAP_SHARE * gap && body.faces_through(positions, triangles).empty()) return round;
    Eigen::SparseMatrix<double> system = CLEAR_LENGTH * CLEAR_LENGTH * ops.stiffness;
    Field right = Field::Zero(static_cast<Eigen::Index>(n), 3);
    for (std::size_t i = 0; i < n; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      held[i] = held[i] || pushes.active(i); // once in contact, held: else it would fall back in the next round
      system.coeffRef(row, row) += ops.mass[row] * (held[i] ? 1 + CLEAR_STIFFNESS : 1);
      if (held[i]) right.row(row) = CLEAR_STIFFNESS * ops.mass[row] * (move.row(row) + pushes[i].transpose());
    }
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(system);
    const Field solved = solver.solve(right);
    move = solved;
    for (std::size_t i = 0; i < n; ++i) positions[i] = start[i] + move.row(static_cast<Eigen::Index>(i)).transpose();
  }
  return max_rounds;
}

std::map<std::string, double> missing_frames(const Garment& garment, const body::Body& body) {
  const BindFrames frames = make_bind_frames(body);
  std::map<std::string, double> missing;
  for (const auto& weights : garment.bind.particles)
    for (const BindWeight& w : weights)
      if (const std::string& name = garment.bind.frames[w.frame]; frames.index(name) < 0)
        missing[name] += w.weight / static_cast<double>(garment.bind.particles.size());
  return missing;
}

Retargeted retarget(const Garment& garment, const body::Body& to, const collision::BodyCollider& skin, RetargetMode mode, Reporter& reporter) {
  Retargeted result{garment, {}};
  Garment& g = result.garment;
  g.converged = false;
  g.position = place_garment(garment, to);
  const std::vector<Triangle> triangles = g.particle_triangles();
  std::vector<double> stretch;
  for (const auto& [a, b] : edges_of(triangles))
    if (const double before = (garment.position[a] - garment.position[b]).norm(); before > 0)
      stretch.push_back((g.position[a] - g.position[b]).norm() / before - 1);
  std::sort(stretch.begin(), stretch.end());
  if (!stretch.empty()) {
    const auto quantile = [&](double q) { return stretch[static_cast<std::size_t>(q * static_cast<double>(stretch.size() - 1))]; };
    result.report.stretch_p01 = quantile(0.01), result.report.stretch_p50 = quantile(0.5), result.report.stretch_p99 = quantile(0.99);
  }
  result.report.placed = state_of(g.position, triangles, skin);
  if (mode == RetargetMode::KEEP_FIT) regrade(g, garment.position, g.position);
  const std::vector<Vec3> placed = g.position;
  result.report.clear_rounds = clear_skin(g.position, triangles, skin, g.offset_m);
  for (std::size_t i = 0; i < placed.size(); ++i) result.report.largest_move_m = std::max(result.report.largest_move_m, (g.position[i] - placed[i]).norm());
  result.report.cleared = state_of(g.position, triangles, skin);
  reporter.info("placed: " + std::to_string(result.report.placed.vertices_inside) + " particles in the body, " +
                std::to_string(result.report.cleared.vertices_inside) + " after clearing the skin in " + std::to_string(result.report.clear_rounds) +
                " rounds");
  return result;
}

} // namespace sloper::garment

#include <sloper/base/statistics.hpp>
#include <sloper/garment/retarget/retarget.hpp>

#include <garment/bind/bind_frames.hpp>
#include <garment/bind/bind_laplacian.hpp>
#include <garment/bind/body_sides.hpp>
#include <garment/retarget/keep_ease.hpp>
#include <garment/retarget/leg_ends.hpp>
#include <garment/retarget/retarget_grade.hpp>
#include <garment/retarget/seat.hpp>
#include <garment/simulate/sleeve_ends.hpp>
#include <sloper/base/error.hpp>
#include <sloper/base/text.hpp>
#include <sloper/collision/intersections.hpp>
#include <sloper/collision/skin_cache.hpp>
#include <sloper/garment/bind/bind.hpp>
#include <sloper/garment/body_model/extremity_hulls.hpp>
#include <sloper/garment/body_model/under_arms.hpp>
#include <sloper/garment/fit/cloth_strain.hpp>
#include <sloper/geometry/rotation.hpp>
#include <sloper/geometry/sparse_solver.hpp>
#include <sloper/io/json.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace sloper::garment {

namespace {

constexpr double ATTRACTION_LENGTH =
    0.25; // m: over this length the shape of the cloth wins over where it was placed
constexpr double CONTACT_LENGTH =
    0.04; // m over which a push is spread by the cloth's own stiffness
constexpr double CONTACT_STIFFNESS = 200; // of a push against the spreading
constexpr double SEARCH_DEPTH = 0.15;     // m, deeper is not looked for
constexpr double FINAL_GAP_SHARE = 0.5;   // of the gap: near enough to stop
constexpr double PRESSED_SHARE =
    0.5; // of the gap: as near tight cloth lies to the skin once it is at rest
constexpr int LEAST_ROUNDS = 6; // before which the shape has not found its rest
constexpr double FEW_THROUGH =
    0.01; // of the faces: more is cloth that is too small, and no round brings it out
constexpr int MOST_TIMES = 4; // the rounds, while there are few
constexpr int PATIENCE = 10;  // rounds without fewer faces through: of 4 shirts that 40 rounds did
                              // not clear, 120 more cleared none, and the count only varied
constexpr double LONGEST_MOVE = 0.008; // m of a particle in one round
constexpr double LEAST_SLEEVE = 0.02;  // of a garment that hangs on one arm: it has a sleeve
constexpr double EASY_STRAIN = 0.01;   // of cloth that is let out
constexpr double FREELY = 2;    // by how much more than it is strained: some of it slides away, and
                                // much goes along its threads
constexpr double STILL = 0.003; // m that no particle moves any more in a round

using Field = Eigen::Matrix<double, Eigen::Dynamic, 3>;

PlacementState state_of(const std::vector<Vec3>& x, const std::vector<Triangle>& triangles,
                        const collision::BodyCollider& body) {
  PlacementState state;
  for (const Vec3& p : x) {
    const double d = body.signed_distance(p, SEARCH_DEPTH).distance;
    if (d >= 0)
      continue;
    ++state.vertices_inside;
    state.deepest_m = std::max(state.deepest_m, -d);
  }
  state.faces_through = static_cast<int>(body.faces_through(x, triangles).size());
  const collision::TriangleTree tree(x, triangles);
  state.self_intersections =
      static_cast<int>(collision::self_intersections(x, triangles, tree).size());
  return state;
}

io::Json state_json(const PlacementState& s) {
  return {{"vertices_inside_body", s.vertices_inside},
          {"deepest_m", s.deepest_m},
          {"faces_through_body", s.faces_through},
          {"self_intersections", s.self_intersections}};
}

/// A move that stays where the skin is still what it was seen as.
Vec3 shortened(const Vec3& move) {
  const double length = move.norm();
  return length > LONGEST_MOVE ? Vec3(LONGEST_MOVE / length * move) : move;
}

/// Contacts of one round: for each particle that is near the skin the plane that wants it farthest
/// out.
class Pushes {
public:
  Pushes(std::size_t n, double nearest)
      : m_normal(n, Vec3::Zero()), m_amount(n, -1), m_nearest(nearest) {}
  /// @param amount  m along the unit normal, 0 for what is only not to come nearer
  void add(int particle, const Vec3& normal, double amount, double distance) {
    if (amount > m_amount[particle]) {
      m_normal[particle] = normal;
      m_amount[particle] = amount;
    }
    m_nearest = std::min(m_nearest, distance);
  }
  bool active(std::size_t i) const { return m_amount[i] >= 0; }
  /// Where the shape alone wants a particle, brought to its side of the plane: what slides along
  /// the skin is free to.
  Vec3 admitted(std::size_t i, const Vec3& now, const Vec3& wanted) const {
    const Vec3 move = shortened(wanted - now);
    return now + move + std::max(0.0, m_amount[i] - m_normal[i].dot(move)) * m_normal[i];
  }
  double nearest() const { return m_nearest; } ///< smallest distance to the skin, m

private:
  std::vector<Vec3> m_normal;
  std::vector<double> m_amount;
  double m_nearest;
};

Pushes pushes_of(const std::vector<Vec3>& x, const std::vector<Triangle>& triangles,
                 const collision::Topology& topology, const collision::BodyCollider& body,
                 double gap, std::vector<int>& hint) {
  Pushes pushes(x.size(), gap);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const collision::SignedDistance d = body.signed_distance(x[i], SEARCH_DEPTH, hint[i]);
    if (d.triangle >= 0)
      hint[i] = d.triangle;
    // What lies just outside the gap is held too, or it would fall in while its neighbours are
    // pushed.
    if (d.distance < 1.5 * gap)
      pushes.add(static_cast<int>(i), d.normal, std::max(0.0, gap - d.distance), d.distance);
  }
  for (const collision::FaceContact& c :
       body.face_contacts(x, triangles, topology, std::max(gap, 0.01))) {
    if (c.distance >= gap)
      continue;
    const double share = c.barycentric.squaredNorm();
    for (int k = 0; k < 3; ++k)
      if (c.barycentric[k] > 0)
        pushes.add(triangles[c.triangle][k], c.normal,
                   (gap - c.distance) * c.barycentric[k] / share, c.distance);
  }
  return pushes;
}

/// The local step of as-rigid-as-possible deformation (Sorkine and Alexa 2007): best rotation of
/// the spokes of each particle.
class Rotations {
public:
  Rotations(const std::vector<Vec3>& shape, const SurfaceOperators& ops)
      : m_shape(shape), m_stiffness(ops.stiffness) {}
  /// Sum over spokes of c_ij (R_i + R_j)/2 (shape_i - shape_j).
  Field right_side(const std::vector<Vec3>& x) const {
    std::vector<Mat3> rotation(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      Mat3 covariance = Mat3::Zero();
      for (Eigen::SparseMatrix<double>::InnerIterator e(m_stiffness, static_cast<Eigen::Index>(i));
           e; ++e)
        if (const auto j = static_cast<std::size_t>(e.row()); j != i)
          covariance -= e.value() * (m_shape[i] - m_shape[j]) * (x[i] - x[j]).transpose();
      rotation[i] = nearest_rotation(covariance);
    }
    Field right = Field::Zero(static_cast<Eigen::Index>(x.size()), 3);
    for (std::size_t i = 0; i < x.size(); ++i)
      for (Eigen::SparseMatrix<double>::InnerIterator e(m_stiffness, static_cast<Eigen::Index>(i));
           e; ++e)
        if (const auto j = static_cast<std::size_t>(e.row()); j != i)
          right.row(static_cast<Eigen::Index>(i)) -=
              0.5 * e.value() *
              ((rotation[i] + rotation[j]) * (m_shape[i] - m_shape[j])).transpose();
    return right;
  }

private:
  const std::vector<Vec3>& m_shape;
  const Eigen::SparseMatrix<double>& m_stiffness;
};

/// Makes the pattern of `source` over for where its cloth lies on the other body. @param longer
/// regrade()'s widen_strained_pieces
void grade(Retargeted& result, const Garment& source, const std::vector<Vec3>& after,
           const body::Body& to, const std::vector<Vec2>& longer = {}) {
  GradeSides sides;
  for (const SideDifference& d : uneven_sides(to))
    sides.apart[d.limb] += (sides.apart[d.limb].empty() ? "" : ", ") + d.text;
  result.garment.panels = source.panels;
  Garment placed = source;
  placed.position = after;
  std::vector<Vec2> lengthening =
      lengthening_for_ease(placed, ease_at_girths(placed, source.position, to));
  for (std::size_t f = 0; f < longer.size(); ++f)
    lengthening[f] += longer[f];
  const GradeReport report = regrade(result.garment, source.position, after, sides, lengthening);
  result.report.mirrored_panels = report.mirrored_panels;
  result.report.findings = report.findings;
  ++result.report.gradings;
}

/// Lowers a skirt or trousers to where the top edge closes.
/// @return particles of that edge, from which they hang
std::vector<int> seat(Retargeted& result, const Garment& source, const body::Body& to,
                      Reporter& reporter) {
  const Seat seat = seat_of_waist(result.garment, source.position, to);
  result.report.seated_lower_m = seat.below_m;
  if (seat.below_m > 0) {
    result.garment.position = place_garment(source, to, Waist::SEMANTIC, seat.below_m);
    reporter.info("the top edge does not close where it was placed: worn " +
                  centimetres(seat.below_m) + " lower");
  }
  return seat.edge;
}

} // namespace

RetargetMode retarget_mode_from_name(const std::string& name) {
  if (name == "keep-fabric")
    return RetargetMode::KEEP_FABRIC;
  if (name == "keep-fit")
    return RetargetMode::KEEP_FIT;
  throw Error(ErrorKind::USAGE, "option.unknown-word"_id, "", "--mode",
              "\"" + name + "\" is not a mode", "use keep-fabric or keep-fit");
}

io::Json placement_json(const PlacementReport& r) {
  return {{"placed", state_json(r.placed)},
          {"cleared", state_json(r.cleared)},
          {"clear_rounds", r.clear_rounds},
          {"largest_move_m", r.largest_move_m},
          {"mirrored_panels", r.mirrored_panels},
          {"gradings", r.gradings},
          {"seated_lower_m", r.seated_lower_m},
          {"stretch", {{"p01", r.stretch_p01}, {"p50", r.stretch_p50}, {"p99", r.stretch_p99}}},
          {"settled_stretch",
           {{"p01", r.settled_p01}, {"p50", r.settled_p50}, {"p99", r.settled_p99}}}};
}

int settle_shape(std::vector<Vec3>& positions, const ShapeToSettle& cloth,
                 const collision::BodyCollider& body, double gap) {
  const std::vector<Vec3>& shape = cloth.shape;
  const std::vector<Triangle>& triangles = cloth.triangles;
  const std::size_t n = positions.size();
  const std::vector<Vec3> placed = positions;
  const collision::Topology topology = collision::make_topology(n, triangles);
  const SurfaceOperators ops = surface_operators(shape, triangles);
  const Rotations rotations(shape, ops);
  const double push_stiffness = CONTACT_STIFFNESS / (CONTACT_LENGTH * CONTACT_LENGTH);
  std::vector<double> attraction(n, 1 / (ATTRACTION_LENGTH * ATTRACTION_LENGTH));
  for (int i : cloth.held)
    attraction[i] = push_stiffness;
  Eigen::SparseMatrix<double> free_system = ops.stiffness;
  for (std::size_t i = 0; i < n; ++i)
    free_system.coeffRef(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)) +=
        attraction[i] * ops.mass[static_cast<Eigen::Index>(i)];
  const SparseSolver free_solver(free_system);
  SparseSolver solver;
  solver.analyse(ops.stiffness);
  std::vector<char> was_pushed; // in the round of the factorisation
  std::vector<int> hint(n, -1);
  double largest_move = 0;
  int round = 0, best_round = 0;
  std::size_t least_through = triangles.size();
  const auto few_are_through = [&] {
    const std::size_t through = body.faces_through(positions, triangles).size();
    if (through < least_through) {
      least_through = through;
      best_round = round;
    }
    return through > 0 && round - best_round < PATIENCE &&
           static_cast<double>(through) < FEW_THROUGH * static_cast<double>(triangles.size());
  };
  for (; round < cloth.max_rounds || (round < MOST_TIMES * cloth.max_rounds && few_are_through());
       ++round) {
    const Pushes pushes = pushes_of(positions, triangles, topology, body, gap, hint);
    if (round >= LEAST_ROUNDS && largest_move < STILL &&
        pushes.nearest() >= FINAL_GAP_SHARE * gap &&
        body.faces_through(positions, triangles).empty())
      return round;
    Field right = rotations.right_side(positions);
    for (std::size_t i = 0; i < n; ++i)
      right.row(static_cast<Eigen::Index>(i)) +=
          (attraction[i] * ops.mass[static_cast<Eigen::Index>(i)] * placed[i]).transpose();
    const Field wanted = free_solver.solve(right);
    std::vector<char> is_pushed(n, 0);
    for (std::size_t i = 0; i < n; ++i) {
      if (!pushes.active(i))
        continue;
      const auto row = static_cast<Eigen::Index>(i);
      is_pushed[i] = 1;
      right.row(row) += (push_stiffness * ops.mass[row] *
                         pushes.admitted(i, positions[i], wanted.row(row).transpose()))
                            .transpose();
    }
    if (is_pushed != was_pushed) { // all that the matrix depends on
      Eigen::SparseMatrix<double> system = free_system;
      for (Eigen::Index row = 0; row < system.rows(); ++row)
        if (is_pushed[static_cast<std::size_t>(row)])
          system.coeffRef(row, row) += push_stiffness * ops.mass[row];
      solver.factorise(system);
      was_pushed = std::move(is_pushed);
    }
    const Field solved = solver.solve(right);
    largest_move = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3 move =
          shortened(Vec3(solved.row(static_cast<Eigen::Index>(i)).transpose()) - positions[i]);
      largest_move = std::max(largest_move, move.norm());
      positions[i] += move;
    }
  }
  return round;
}

std::vector<Vec3> as_near_as_placed(std::vector<Vec3> settled, const std::vector<Vec3>& placed,
                                    const collision::BodyCollider& skin, double gap) {
  const double least = PRESSED_SHARE * gap;
  for (std::size_t i = 0; i < settled.size(); ++i) {
    const double lay = skin.signed_distance(placed[i], SEARCH_DEPTH).distance;
    if (lay >= gap)
      continue;
    const collision::SignedDistance now = skin.signed_distance(settled[i], SEARCH_DEPTH);
    settled[i] -= std::clamp(now.distance - std::max(lay, least), 0.0, gap - least) * now.normal;
  }
  return settled;
}

std::string why_impossible(const Garment& garment, const body::Body& body) {
  if (!body.frames.count("torso") &&
      !(body.has_landmark("hip_center") && body.has_landmark("neck_center")))
    return "cannot be hung on this body: neither hip_center nor neck_center make a torso";
  const BindFrames frames = make_bind_frames(body);
  std::map<std::string, int> missing; // particles that hang mainly on a frame that is not there
  for (const auto& weights : garment.bind.particles) {
    double there = 0;
    const BindWeight* most = nullptr;
    for (const BindWeight& w : weights) {
      if (frames.index(garment.bind.frames[w.frame]) >= 0)
        there += w.weight;
      if (!most || w.weight > most->weight)
        most = &w;
    }
    if (there < 0.5 && most)
      ++missing[garment.bind.frames[most->frame]];
  }
  if (missing.empty())
    return {};
  const auto most =
      std::max_element(missing.begin(), missing.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  return "hangs on " + most->first + ", which the body lacks";
}

std::string why_stuck(const Garment& garment, const body::Body& body) {
  for (const std::string side : {"left", "right"}) {
    const std::string suffix = side == "left" ? "_l" : "_r";
    if (body.has_landmark("axilla" + suffix) || !body.has_landmark("shoulder_joint" + suffix))
      continue;
    double sleeve = 0;
    for (const auto& weights : garment.bind.particles)
      for (const BindWeight& w : weights)
        if (const std::string& frame = garment.bind.frames[w.frame];
            frame.find("arm") != std::string::npos && frame.ends_with(suffix))
          sleeve += w.weight;
    if (sleeve > LEAST_SLEEVE * static_cast<double>(garment.bind.particles.size()))
      return "has a " + side + " sleeve, and no cloth goes between the scan's " + side +
             " arm and its trunk, which touch";
  }
  return {};
}

Retargeted retarget(const Garment& garment, const body::Body& to,
                    const collision::BodyCollider& skin, RetargetMode mode, Reporter& reporter) {
  Retargeted result{.garment = garment, .placed = {}, .report = {}};
  Garment& g = result.garment;
  g.converged = false;
  const bool keep_fit = mode == RetargetMode::KEEP_FIT;
  g.position = place_garment(garment, to, keep_fit ? Waist::OF_ALL : Waist::SEMANTIC);
  result.placed = g.position;
  for (const EaseAtGirth& girth : ease_at_girths(g, garment.position, to))
    result.source_ease_m[girth.name] = girth.ease_m;
  const std::vector<int> hangs_from =
      keep_fit ? std::vector<int>() : seat(result, garment, to, reporter);
  std::optional<collision::BodyCollider> mittens;
  if (const std::size_t moved =
          bring_under_arms(g.position, hanging_on_arms(g.bind), to, g.offset_m);
      moved > 0) {
    reporter.info(std::to_string(moved) + " particles were placed in hands or forearms or beyond "
                                          "them: now between those and the body");
    mittens.emplace(collision::make_collider(ExtremityHulls(to, ExtremityHulls::HANDS).mesh(),
                                             to.skin_cache.get()));
  }
  const collision::BodyCollider& met = mittens ? *mittens : skin;
  const std::vector<Triangle> triangles = g.particle_triangles();
  const auto measure = [&](double& p01, double& p50, double& p99) {
    std::vector<double> stretch;
    for (const auto& [a, b] : edges_of(triangles))
      if (const double before = (garment.position[a] - garment.position[b]).norm(); before > 0)
        stretch.push_back((g.position[a] - g.position[b]).norm() / before - 1);
    if (stretch.empty())
      return;
    p01 = lower_quantile(stretch, 0.01);
    p50 = lower_quantile(stretch, 0.5);
    p99 = lower_quantile(stretch, 0.99);
  };
  PlacementReport& report = result.report;
  measure(report.stretch_p01, report.stretch_p50, report.stretch_p99);
  report.placed = state_of(g.position, triangles, skin);
  std::vector<Vec3> placed = g.position;
  // keep-fabric: the cloth wants the shape it had; keep-fit: the shape it was placed in, and is
  // regraded to where the skin lets it lie.
  const std::vector<Vec3>& shape = keep_fit ? placed : garment.position;
  report.clear_rounds = settle_shape(g.position, {shape, triangles, hangs_from}, met, g.offset_m);
  std::vector<int> pushed = ends_pushed_on_hands(g, placed, garment.position);
  if (!pushed.empty()) {
    result.folded = LimbEnds::SLEEVES;
    reporter.info(
        "a sleeve is longer than the arm and narrower than the hand: its end stays at the wrist");
  }
  std::vector<Triangle> through;
  for (int f : met.faces_through(g.position, triangles))
    through.push_back(triangles[f]);
  if (const std::vector<int> ends = raise_ends_off_feet(placed, garment, to, through);
      !ends.empty()) {
    result.folded = LimbEnds::SLEEVES_AND_LEGS;
    reporter.info("legs are longer than those of the body: their ends stay at the ankles");
    pushed.insert(pushed.end(), ends.begin(), ends.end());
  }
  if (!pushed.empty()) {
    g.position = placed;
    pushed.insert(pushed.end(), hangs_from.begin(), hangs_from.end());
    report.clear_rounds += settle_shape(g.position, {shape, triangles, pushed}, met, g.offset_m);
  }
  if (keep_fit)
    grade(result, garment, as_near_as_placed(g.position, placed, skin, g.offset_m), to);
  for (std::size_t i = 0; i < placed.size(); ++i)
    report.largest_move_m = std::max(report.largest_move_m, (g.position[i] - placed[i]).norm());
  measure(report.settled_p01, report.settled_p50, report.settled_p99);
  report.cleared = state_of(g.position, triangles, skin);
  result.is_tangled = report.cleared.faces_through > 0 || report.cleared.vertices_inside > 0 ||
                      report.cleared.self_intersections > 0;
  reporter.info("placed: " + std::to_string(report.placed.vertices_inside) +
                " particles in the body, " + std::to_string(report.cleared.vertices_inside) +
                " after clearing the skin in " + std::to_string(report.clear_rounds) + " rounds");
  return result;
}

void widen_strained_pieces(Retargeted& worn, const Garment& source, const body::Body& to) {
  const auto beyond = [](double strain) {
    return std::log1p(std::max(strain, EASY_STRAIN)) - std::log1p(EASY_STRAIN);
  };
  const std::vector<TriangleStrain> then = triangle_strains(source, source.position),
                                    now = triangle_strains(worn.garment, worn.garment.position);
  std::vector<Vec2> longer;
  for (std::size_t f = 0; f < now.size(); ++f)
    longer.emplace_back(beyond(then[f].weft) + FREELY * beyond(now[f].weft),
                        beyond(then[f].warp) + FREELY * beyond(now[f].warp));
  grade(worn, source, worn.garment.position, to, longer);
  worn.garment.converged = false;
}

} // namespace sloper::garment

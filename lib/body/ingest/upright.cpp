#include <Eigen/LU>
#include <body/ingest/upright.hpp>
#include <sloper/base/units.hpp>
#include <sloper/geometry/rotation.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::body {

namespace {

constexpr double OWN_LEAN =
    5; ///< degrees by which the line from calves to head leans in upright people, at most
constexpr double FOOT_LEAN = 12; ///< degrees between that line and the normal of the plane below
                                 ///< the feet: more, and the feet do not rest on it
constexpr double NEAR_AXIS = 3;  ///< degrees: so near to the axis that was read, the axis is meant
constexpr int STANDING_ROUNDS = 6;
constexpr double CLEAR = 0.9, CLEARLY_BETTER = 0.1; ///< scores of readings
constexpr std::size_t THINNED = 20000;
constexpr int COARSE_CELLS = 72; ///< along the longest side, to read many directions
constexpr int DIRECTIONS = 110;  ///< over half the sphere: about 14 degrees apart
constexpr std::size_t CANDIDATES = 4;
constexpr double SAME = 25; ///< degrees: directions that near lead to the same

/// From the middle of the calves to the middle of the head; nothing where either is missing.
std::optional<Vec3> body_line(const std::vector<Vec3>& positions, const SegmentedScan& sorted) {
  Box3 calves, head; // boxes, for one side may be scanned more densely
  for (std::size_t v = 0; v < positions.size(); ++v) {
    if (!sorted.is_body[v])
      continue;
    const double h = (positions[v].dot(sorted.up) - sorted.low) / (sorted.high - sorted.low);
    if (h > 0.12 && h < 0.25)
      calves.add(positions[v]);
    else if (h > 0.92)
      head.add(positions[v]);
  }
  if (calves.low.x() > calves.high.x() || head.low.x() > head.high.x())
    return std::nullopt;
  return head.center() - calves.center();
}

Eigen::Matrix3d turn_to_y(const Vec3& up) {
  return rotation_between(up, Vec3::UnitY()).toRotationMatrix();
}

std::vector<Vec3> turned(const Eigen::Matrix3d& turn, const std::vector<Vec3>& points) {
  std::vector<Vec3> out;
  out.reserve(points.size());
  for (const Vec3& p : points)
    out.push_back(turn * p);
  return out;
}

/// Directions of a coarse grid over the sphere along which a person stands most clearly and with
/// the least lean, the best first.
std::vector<Vec3> search(const std::vector<Vec3>& points) {
  std::vector<std::pair<double, Vec3>> all;
  for (int k = 0; k < DIRECTIONS;
       ++k) { // a spiral of equal areas over half the sphere; a reading looks both ways
    const double y = (k + 0.5) / DIRECTIONS, angle = 2.399963229728653 * k,
                 r = std::sqrt(1 - y * y);
    const Eigen::Matrix3d turn = turn_to_y(Vec3(r * std::cos(angle), y, r * std::sin(angle)));
    TriangleMesh cloud;
    cloud.positions = turned(turn, points);
    const SegmentedScan sorted = sort_coarsely(cloud, "y", COARSE_CELLS);
    if (sorted.is_body.empty() || sorted.high <= sorted.low)
      continue;
    const auto line = body_line(cloud.positions, sorted);
    if (!line)
      continue;
    const double worth = sorted.up_score - degrees_between(*line, sorted.up) / 200;
    if (worth > 0)
      all.emplace_back(worth, (turn.transpose() * *line).normalized());
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Vec3> best;
  for (const auto& candidate : all) {
    const Vec3& up = candidate.second; // clang 14 captures no structured binding
    if (best.size() == CANDIDATES)
      break;
    if (std::none_of(best.begin(), best.end(),
                     [&](const Vec3& other) { return degrees_between(up, other) < SAME; }))
      best.push_back(up);
  }
  return best;
}

struct Standing {
  Vec3 up;
  double score; ///< of the reading along it
};

/// From a rough direction to that of the body's line, then of the normal of the plane below the
/// feet.
std::optional<Standing> stand_up(const std::vector<Vec3>& points, Vec3 up) {
  double score = 0;
  for (int round = 0; round < STANDING_ROUNDS; ++round) {
    const Eigen::Matrix3d turn = turn_to_y(up);
    TriangleMesh cloud;
    cloud.positions = turned(turn, points);
    const SegmentedScan stands = segment_scan(cloud, "y");
    if (!shows_a_person(stands))
      return std::nullopt;
    score = stands.up_score;
    const auto line = body_line(
        cloud.positions, stands); // along what is up now: it may be upside down to what it was
    if (!line)
      return std::nullopt;
    Vec3 next = line->normalized();
    if (round > 0) {
      const Eigen::Matrix3d along =
          turn_to_y(next); // heights along the body's line, as long as the plane is not known
      std::vector<Vec3> feet;
      double lowest = 1e300;
      for (std::size_t v = 0; v < points.size(); ++v)
        if (stands.is_body[v])
          lowest = std::min(lowest, (along * cloud.positions[v]).y());
      Box3 box;
      for (std::size_t v = 0; v < points.size(); ++v)
        if (stands.is_body[v])
          if (const Vec3 p = along * cloud.positions[v];
              p.y() < lowest + SOLE_HEIGHT * (stands.high - stands.low)) {
            feet.push_back(p);
            box.add(p);
          }
      if (const auto plane = resting_plane(feet, Vec2(box.center().x(), box.center().z()))) {
        const Vec3 normal = Vec3(-plane->x(), 1, -plane->y()).normalized();
        if (degrees_between(normal, Vec3::UnitY()) < FOOT_LEAN)
          next = along.transpose() * normal;
      }
    }
    up = (turn.transpose() * next).normalized();
  }
  return Standing{up, score};
}

} // namespace

std::optional<Vec3> resting_plane(const std::vector<Vec3>& points, const Vec2& at) {
  if (points.size() < 3)
    return std::nullopt;
  const Box3 box = bounding_box(points);
  const double reach = 4 * box.size().maxCoeff() + 1e-9, above = box.high.y() + reach;
  // three points high above hold the plane until points of the body do
  std::vector<Vec3> holding{Vec3(at.x() + reach, above, at.y() + reach),
                            Vec3(at.x() - reach, above, at.y() + reach),
                            Vec3(at.x(), above, at.y() - reach)};
  Vec3 plane = Vec3::Zero();
  for (int round = 0; round < 40; ++round) {
    double highest = -1e300;
    for (std::size_t i = 0; i < holding.size(); ++i)
      for (std::size_t j = i + 1; j < holding.size(); ++j)
        for (std::size_t k = j + 1; k < holding.size(); ++k) {
          Eigen::Matrix3d rows;
          const std::size_t of[] = {i, j, k};
          Vec3 heights;
          for (int r = 0; r < 3; ++r) {
            const Vec3& p = holding[of[r]];
            rows.row(r) << p.x(), p.z(), 1;
            heights[r] = p.y();
          }
          if (std::abs(rows.determinant()) < 1e-9 * reach * reach)
            continue;
          const Vec3 trial = rows.inverse() * heights;
          const double y = trial.x() * at.x() + trial.y() * at.y() + trial.z();
          if (y <= highest)
            continue;
          const bool below = std::all_of(holding.begin(), holding.end(), [&](const Vec3& p) {
            return trial.x() * p.x() + trial.y() * p.z() + trial.z() <= p.y() + 1e-9 * reach;
          });
          if (below) {
            highest = y;
            plane = trial;
          }
        }
    auto gap = [&](const Vec3& p) {
      return p.y() - plane.x() * p.x() - plane.y() * p.z() - plane.z();
    };
    const auto deepest =
        std::min_element(points.begin(), points.end(),
                         [&](const Vec3& a, const Vec3& b) { return gap(a) < gap(b); });
    if (gap(*deepest) > -1e-7 * reach)
      return plane;
    std::erase_if(holding, [&](const Vec3& p) {
      return gap(p) > 1e-7 * reach;
    }); // the plane's own three stay
    holding.push_back(*deepest);
  }
  return plane;
}

std::optional<Eigen::Matrix3d> upright_turn(const TriangleMesh& scan, const SegmentedScan& sorted) {
  double most = 0; // of the axis that was read: a raised hand may pass for a head, so another
                   // direction must be clearly better
  if (sorted.high > sorted.low && shows_a_person(sorted))
    if (const auto line = body_line(scan.positions, sorted);
        line && degrees_between(*line, sorted.up) < OWN_LEAN) {
      if (sorted.up_score > CLEAR)
        return std::nullopt;
      most = CLEARLY_BETTER;
    }
  std::vector<Vec3> points;
  for (std::size_t v = 0, step = 1 + scan.positions.size() / THINNED; v < scan.positions.size();
       v += step)
    points.push_back(scan.positions[v]);
  const std::vector<Vec3> spread =
      points_of_body(scan, std::vector<char>(scan.positions.size(), 1),
                     2 * THINNED); // a coarse mesh's vertices fall apart
  if (most > 0) {                  // compared as thinned as the others
    TriangleMesh cloud;
    cloud.positions = spread;
    most += segment_scan(cloud, "auto").up_score;
  }
  // Who leans in the file is set upright from there first: of a man with spread arms and legs the
  // search below took a leg and an arm for legs.
  std::optional<Standing> best;
  if (shows_a_person(sorted))
    best = stand_up(spread, sorted.up);
  if (!best || best->score <= CLEAR)
    for (const Vec3& direction : search(points)) {
      const auto found = stand_up(spread, direction);
      if (found && (!best || found->score > best->score + 0.02))
        best = found;
      if (best && best->score > CLEAR)
        break;
    }
  if (!best || best->score < most)
    return std::nullopt;
  const Vec3 up = best->up;
  if (degrees_between(up, sorted.up) < NEAR_AXIS)
    return std::nullopt;
  return turn_to_y(up);
}

} // namespace sloper::body

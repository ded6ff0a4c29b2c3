#include <body/ingest/mirror.hpp>
#include <body/ingest/upright.hpp>
#include <body/ingest/vertical.hpp>
#include <sloper/base/units.hpp>
#include <sloper/geometry/rotation.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace sloper::body {

namespace {

constexpr double HEAD_BEFORE_CALVES =
    2.0; ///< degrees by which the line from the calves to the head leans forward in upright people
constexpr double FAR_APART =
    8; ///< degrees between posture and soles: so far, the soles are not believed at all
constexpr double SOLES_WEIGHT = 0.85; ///< against the posture
constexpr double SLUMPED = 2;         ///< degrees between posture and soles
constexpr double NEAR_FILE =
    1.6; ///< degrees from the file's vertical to the body's: so near, the body's is taken
/// Of the angle between posture and soles: soles nearer to the file's vertical than this mean the
/// same floor, however slumped the posture. Of 80 fresh bodies in natural and mixed stances one,
/// slumped by 7.6 degrees with soles 1.61 from the file's level, was tilted by 4.9 degrees.
constexpr double SOLES_WITH_FILE = 0.33;
constexpr int SHAPE_ROUNDS = 2, HEADINGS = 2;
constexpr double SETTLED = 1e-4; ///< rad

/// A direction that is nearly +y, rad from it: `forward` to +z, `left` to +x.
struct Lean {
  double forward, left;
  Vec3 direction() const { return Vec3(std::tan(left), 1, std::tan(forward)).normalized(); }
};

/// From the middle of the calves to the middle of the head, forwards; nothing where either is
/// missing. Boxes, for one side may be scanned more densely than the other.
std::optional<double> lean_of_posture(const std::vector<Vec3>& points, double stature) {
  Box3 calves, head;
  for (const Vec3& p : points) {
    const double h = p.y() / stature;
    if (h > 0.92)
      head.add(p);
    else if (h > 0.12 && h < 0.25)
      calves.add(p);
  }
  if (calves.low.x() > calves.high.x() || head.low.x() > head.high.x())
    return std::nullopt;
  const Vec3 line = head.center() - calves.center();
  return std::atan2(line.z(), line.y()) - units::radians(HEAD_BEFORE_CALVES);
}

std::optional<Lean> lean_of_soles(const std::vector<Vec3>& points, double stature) {
  std::vector<Vec3> feet;
  Box3 box;
  for (const Vec3& p : points)
    if (p.y() < SOLE_HEIGHT * stature) {
      feet.push_back(p);
      box.add(p);
    }
  const auto plane = resting_plane(feet, Vec2(box.center().x(), box.center().z()));
  if (!plane)
    return std::nullopt;
  return Lean{-std::atan(plane->y()), -std::atan(plane->x())};
}

/// A part of the body, by its height, whose place before the calves tells of the vertical.
struct Witness {
  double low, high;      ///< of stature
  double aside;          ///< of stature beside the mid-plane: the chest without its arms
  bool is_front;         ///< its front end, no middle
  double mean, sd;       ///< of stature before the calves' middle
  double degrees_per_cm; ///< per hundredth of the stature that it is farther forward
};
constexpr Witness WITNESSES[] = {{0.92, 1.01, 0.2, false, 0.0256, 0.0099, -0.1774},
                                 {0.68, 0.76, 0.08, false, 0.0098, 0.0077, 0.2414},
                                 {0, 0.03, 0.3, true, 0.1119, 0.0085, -0.1913}};
constexpr Witness CALVES = {0.12, 0.25, 0.3, false, 0, 1, 0};
constexpr double USUAL_LEAN = -0.4466;   ///< degrees
constexpr double WITNESSES_BEYOND = 2.5; ///< standard deviations: farther off counts no more

/// Middle, or front end, of a part of the body, of stature; nothing where it is not there.
std::optional<double> depth_of(const Witness& part, const std::vector<Vec3>& points,
                               double stature) {
  double back = 1e300, front = -1e300;
  for (const Vec3& p : points) {
    const double h = p.y() / stature;
    if (h <= part.low || h >= part.high || std::abs(p.x()) >= part.aside * stature)
      continue;
    back = std::min(back, p.z());
    front = std::max(front, p.z());
  }
  if (back > front)
    return std::nullopt;
  return (part.is_front ? front : 0.5 * (back + front)) / stature;
}

/// Half of what `other` says, less the further it is off.
double drawn(double own, double other) {
  const double off = (other - own) / units::radians(FAR_APART);
  return own + SOLES_WEIGHT * std::max(0.0, 1 - off * off) * (other - own);
}

} // namespace

std::optional<ShapeVertical> vertical_of_shape(std::vector<Vec3> points,
                                               const CanonicalFrame& frame) {
  std::vector<Vec3> turned;
  for (Vec3& p : points)
    p = transform(frame.scan_to_body, p);
  if (points.empty())
    return std::nullopt;
  ShapeVertical vertical{Vec3::UnitY(), Vec3::UnitY(), std::nullopt};
  Vec3 up = Vec3::UnitY(); // in `frame`
  turned.resize(points.size());
  for (int round = 0; round < SHAPE_ROUNDS; ++round) {
    Eigen::Matrix3d turn = rotation_between(up, Vec3::UnitY()).toRotationMatrix();
    double low = 1e300, high = -1e300;
    for (std::size_t k = 0; k < points.size(); ++k) {
      turned[k] = turn * points[k];
      low = std::min(low, turned[k].y());
      high = std::max(high, turned[k].y());
    }
    for (Vec3& p : turned)
      p.y() -= low;
    const auto forward = lean_of_posture(turned, high - low),
               left = mirror_roll(turned, high - low);
    if (!forward || !left)
      return std::nullopt;
    Lean lean{*forward, *left};
    const auto soles = lean_of_soles(turned, high - low);
    vertical.by_posture = lean.direction();
    if (soles)
      lean = {drawn(lean.forward, soles->forward), drawn(lean.left, soles->left)};
    const Eigen::Matrix3d back = frame.scan_to_body.block<3, 3>(0, 0).transpose() /
                                 std::cbrt(frame.scan_to_body.block<3, 3>(0, 0).determinant());
    auto in_scan = [&](const Vec3& direction) { return Vec3(back * turn.transpose() * direction); };
    vertical.by_posture = in_scan(vertical.by_posture);
    vertical.by_soles = soles ? std::optional(in_scan(soles->direction())) : std::nullopt;
    up = turn.transpose() * lean.direction();
    vertical.up = back * up;
    if (lean.direction().cross(Vec3::UnitY()).norm() < SETTLED)
      break;
  }
  return vertical;
}

void settle_vertical(const TriangleMesh& scan, const std::vector<Vec3>& points,
                     SegmentedScan& sorted, CanonicalFrame& frame, bool upright_file) {
  CanonicalFrame settled = frame;
  SegmentedScan by_body = sorted;
  for (int round = 0; round < HEADINGS; ++round) { // the heading depends a little on the vertical
    const auto vertical = vertical_of_shape(points, settled);
    if (!vertical)
      return;
    auto near_file = [&](const Vec3& up) { return degrees_between(up, sorted.up) < NEAR_FILE; };
    // a slumped posture tells no vertical: where the soles rest on the file's level, that is the
    // floor
    if (upright_file && vertical->by_soles) {
      const double slump = degrees_between(vertical->by_posture, *vertical->by_soles);
      const double floor_off = degrees_between(*vertical->by_soles, sorted.up);
      if (slump > SLUMPED && floor_off < std::max(NEAR_FILE, SOLES_WITH_FILE * slump))
        return;
    }
    if (upright_file && !near_file(vertical->up) &&
        (near_file(vertical->by_posture) || (vertical->by_soles && near_file(*vertical->by_soles))))
      return;
    by_body.up = vertical->up;
    const Vec3 up = (settled.scan_to_body.block<3, 3>(0, 0) * vertical->up).normalized();
    Mat4 turn = Mat4::Identity();
    turn.block<3, 3>(0, 0) = rotation_between(up, Vec3::UnitY()).toRotationMatrix();
    const Vec3 middle(0, 0.65 * settled.stature_m,
                      0); // of the trunk, which the mirror plane goes through
    turn.block<3, 1>(0, 3) = middle - turn.block<3, 3>(0, 0) * middle;
    settled.scan_to_body = turn * settled.scan_to_body;
    const Eigen::RowVector4d row = settled.scan_to_body.row(1);
    by_body.low = 1e300;
    by_body.high = -1e300;
    for (std::size_t v = 0; v < scan.positions.size(); ++v)
      if (by_body.is_body[v]) {
        const double y = row.head<3>().dot(scan.positions[v]) + row[3];
        by_body.low = std::min(by_body.low, y);
        by_body.high = std::max(by_body.high, y);
      }
    settled.scan_to_body(1, 3) -= by_body.low;
    settled.stature_m = by_body.high - by_body.low;
    const double unit = row.head<3>().norm();
    by_body.low = (by_body.low - row[3]) / unit;
    by_body.high = (by_body.high - row[3]) / unit;
    refine_heading(points, settled);
  }
  if (const double far = degrees_between(by_body.up, sorted.up); upright_file) {
    char text[120];
    std::snprintf(text, sizeof text,
                  "the vertical is the body's own, %.1f degrees from the file's%s", far,
                  far > NEAR_FILE ? ", in which it leans" : "");
    settled.findings.push_back(
        {"scan.vertical"_id, far > NEAR_FILE ? "warning" : "info", text, "scan"});
  }
  sorted = std::move(by_body);
  frame = std::move(settled);
}

double likeliest_lean(const std::vector<Vec3>& points, double stature) {
  double degrees = USUAL_LEAN;
  const auto calves = depth_of(CALVES, points, stature);
  for (const Witness& witness : WITNESSES)
    if (const auto depth = depth_of(witness, points, stature); depth && calves) {
      const double off = (*depth - *calves - witness.mean) / witness.sd;
      degrees += witness.degrees_per_cm * 100 * witness.sd *
                 std::clamp(off, -WITNESSES_BEYOND, WITNESSES_BEYOND);
    }
  return units::radians(degrees);
}

} // namespace sloper::body

#include <body/skin_profile.hpp>
#include <sloper/base/units.hpp>
#include <sloper/body/measure/section.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::body {

namespace {

constexpr int N_THETA = 64, N_Z = 48;
constexpr double MIN_RADIUS = 0.002; ///< m, where the axis itself leaves the skin

/// Fills unset (negative) entries of one row around the circle by linear interpolation; false when
/// the row is empty.
bool fill_row(double* row, int n) {
  int first = -1;
  for (int i = 0; i < n && first < 0; ++i)
    if (row[i] > 0)
      first = i;
  if (first < 0)
    return false;
  int last = first;
  for (int k = 1; k <= n; ++k) {
    const int i = (first + k) % n;
    if (row[i] <= 0)
      continue;
    const int gap = (i - last + n) % n == 0 ? n : (i - last + n) % n;
    for (int j = 1; j < gap; ++j)
      row[(last + j) % n] = row[last] + (row[i] - row[last]) * j / gap;
    last = i;
  }
  return true;
}

void fill_rows(SkinProfile& profile, const std::vector<char>& filled) {
  for (int z = 0; z < profile.n_z; ++z) {
    if (filled[z])
      continue;
    int below = z, above = z;
    while (below >= 0 && !filled[below])
      --below;
    while (above < profile.n_z && !filled[above])
      ++above;
    if (below < 0 && above >= profile.n_z)
      continue;
    for (int k = 0; k < profile.n_theta; ++k) {
      const double a = below >= 0 ? profile.radius[below * profile.n_theta + k]
                                  : profile.radius[above * profile.n_theta + k];
      const double b = above < profile.n_z ? profile.radius[above * profile.n_theta + k] : a;
      const double w =
          below >= 0 && above < profile.n_z ? static_cast<double>(z - below) / (above - below) : 0;
      profile.radius[z * profile.n_theta + k] = a + w * (b - a);
    }
  }
}

/// [1 2 1]/4 around the circle and along the axis.
void smooth(SkinProfile& profile) {
  const int n = profile.n_theta, m = profile.n_z;
  std::vector<double> next(profile.radius.size());
  for (int z = 0; z < m; ++z)
    for (int k = 0; k < n; ++k)
      next[z * n + k] =
          0.25 * (profile.radius[z * n + (k + n - 1) % n] + 2 * profile.radius[z * n + k] +
                  profile.radius[z * n + (k + 1) % n]);
  for (int z = 0; z < m; ++z)
    for (int k = 0; k < n; ++k)
      profile.radius[z * n + k] = 0.25 * (next[std::max(0, z - 1) * n + k] + 2 * next[z * n + k] +
                                          next[std::min(m - 1, z + 1) * n + k]);
}

} // namespace

SkinProfile skin_profile(const PartFrame& frame, const TriangleMesh& skin,
                         const std::vector<int>& triangles, double z_low, double z_high,
                         bool taut) {
  SkinProfile profile;
  profile.n_theta = N_THETA;
  profile.n_z = N_Z;
  profile.z_low = z_low;
  profile.z_high = z_high;
  profile.radius.assign(static_cast<std::size_t>(N_THETA) * N_Z, -1.0);
  const Vec3 a = frame.axis();
  const double length = frame.length(), step = (z_high - z_low) / (N_Z - 1);
  std::vector<std::vector<int>> rows(N_Z);
  for (const int t : triangles) {
    double low = 1e300, high = -1e300;
    for (const int v : skin.triangles[t]) {
      const double z = (skin.positions[v] - frame.lower).dot(a) / length;
      low = std::min(low, z);
      high = std::max(high, z);
    }
    const int first = std::max(0, static_cast<int>(std::floor((low - z_low) / step))),
              last = std::min(N_Z - 1, static_cast<int>(std::ceil((high - z_low) / step)));
    for (int k = first; k <= last; ++k)
      rows[k].push_back(t);
  }
  constexpr double column = 2 * units::PI / N_THETA;
  std::array<Vec2, N_THETA> rays;
  for (int k = 0; k < N_THETA; ++k)
    rays[k] = Vec2(std::cos(-units::PI + k * column), std::sin(-units::PI + k * column));
  std::vector<char> filled(N_Z, 0);
  const Vec3 side = (frame.mirrored ? -1.0 : 1.0) * a.cross(frame.theta_zero);
  for (int z = 0; z < N_Z; ++z) {
    Plane plane{frame.lower + (z_low + z * step) * length * a, frame.theta_zero, side};
    double* row = &profile.radius[static_cast<std::size_t>(z) * N_THETA];
    std::vector<std::array<Vec2, 2>> segments;
    for (const Loop& loop : cut(skin, plane, &rows[z]))
      segments.insert(segments.end(), loop.segments.begin(), loop.segments.end());
    if (taut && segments.size() > 2) {
      std::vector<Vec2> points;
      for (const auto& s : segments)
        points.push_back(s[0]);
      const std::vector<Vec2> hull = convex_hull(std::move(points));
      segments.clear();
      for (std::size_t i = 0; i < hull.size(); ++i)
        segments.push_back({hull[i], hull[(i + 1) % hull.size()]});
    }
    for (const auto& s :
         segments) { // the ray of every column that this segment crosses; the outermost counts
      double t0 = std::atan2(s[0].y(), s[0].x()), t1 = std::atan2(s[1].y(), s[1].x());
      if (t1 - t0 > units::PI)
        t1 -= 2 * units::PI;
      if (t0 - t1 > units::PI)
        t1 += 2 * units::PI;
      if (t1 < t0)
        std::swap(t0, t1);
      for (int k = static_cast<int>(std::ceil((t0 + units::PI) / column));
           k <= static_cast<int>(std::floor((t1 + units::PI) / column)); ++k) {
        const int at = (k % N_THETA + N_THETA) % N_THETA;
        const Vec2 &ray = rays[at], d = s[1] - s[0];
        const double cross = ray.x() * d.y() - ray.y() * d.x();
        if (std::abs(cross) < 1e-12)
          continue;
        const double r = (s[0].x() * d.y() - s[0].y() * d.x()) / cross;
        row[at] = std::max(row[at], r);
      }
    }
    filled[z] = fill_row(row, N_THETA);
  }
  fill_rows(profile, filled);
  for (double& r : profile.radius)
    r = std::max(r, MIN_RADIUS);
  smooth(profile);
  return profile;
}

void build_frames(Body& body) {
  auto triangles_of = [&](std::initializer_list<Part> parts) {
    std::vector<int> list;
    for (std::size_t t = 0; t < body.face_part.size(); ++t)
      if (std::find(parts.begin(), parts.end(), body.face_part[t]) != parts.end())
        list.push_back(static_cast<int>(t));
    return list;
  };
  auto add = [&](const std::string& name, const std::string& lower, const std::string& upper,
                 bool mirrored, std::initializer_list<Part> parts, double z_low, double z_high) {
    if (!body.has_landmark(lower) || !body.has_landmark(upper))
      return;
    BodyFrame frame;
    frame.frame =
        make_part_frame(body.landmark(lower), body.landmark(upper), Vec3::UnitZ(), mirrored);
    if (frame.frame.length() < 1e-3)
      return;
    frame.profile = skin_profile(frame.frame, body.skin, triangles_of(parts), z_low, z_high, false);
    body.frames[name] = frame;
  };
  add("head", "neck_center", "head_tip", false, {Part::HEAD}, -0.1, 1.0);
  add("torso", "hip_center", "neck_center", false, {Part::TORSO}, -0.15, 1.05);
  add("arm_l", "hand_tip_l", "acromion_l", false, {Part::ARM_L}, 0.0, 1.05);
  add("arm_r", "hand_tip_r", "acromion_r", true, {Part::ARM_R}, 0.0, 1.05);
  add("leg_l", "ankle_l", "hip_joint_l", false, {Part::LEG_L}, -0.1, 1.05);
  add("leg_r", "ankle_r", "hip_joint_r", true, {Part::LEG_R}, -0.1, 1.05);
  if (body.has_landmark("ankle_l") && body.has_landmark("ankle_r") &&
      body.has_landmark("hip_center")) {
    BodyFrame frame;
    frame.frame = make_part_frame(0.5 * (body.landmark("ankle_l") + body.landmark("ankle_r")),
                                  body.landmark("hip_center"), Vec3::UnitZ(), false);
    frame.profile =
        skin_profile(frame.frame, body.skin, triangles_of({Part::LEG_L, Part::LEG_R, Part::TORSO}),
                     -0.1, 1.2, true);
    body.frames["lower_body"] = frame;
  }
}

void build_bones(Body& body) {
  auto add = [&](const std::string& name, const std::string& parent, const std::string& head,
                 const std::string& tail) {
    if (body.has_landmark(head) && body.has_landmark(tail))
      body.bones.push_back({name, parent, body.landmark(head), body.landmark(tail)});
  };
  add("spine", "", "hip_center", "neck_center");
  add("head", "spine", "neck_center", "head_tip");
  for (const std::string side : {"_l", "_r"}) {
    add("clavicle" + side, "spine", "neck_center", "shoulder_joint" + side);
    add("upper_arm" + side, "clavicle" + side, "shoulder_joint" + side, "elbow" + side);
    add("forearm" + side, "upper_arm" + side, "elbow" + side, "wrist" + side);
    add("hand" + side, "forearm" + side, "wrist" + side, "hand_tip" + side);
    add("pelvis" + side, "spine", "hip_center", "hip_joint" + side);
    add("thigh" + side, "pelvis" + side, "hip_joint" + side, "knee" + side);
    add("shin" + side, "thigh" + side, "knee" + side, "ankle" + side);
    add("foot" + side, "shin" + side, "ankle" + side, "foot_tip" + side);
  }
}

} // namespace sloper::body

#include <garment/bind/bind_frames.hpp>

#include <sloper/base/error.hpp>
#include <sloper/base/units.hpp>
#include <sloper/geometry/sparse_solver.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace sloper::garment {

namespace {

using body::Body;
using body::Part;

constexpr int N_THETA = 72;
constexpr double ROW_HEIGHT = 0.012; // m
constexpr double SAMPLE_SPACING =
    0.005; // m between points taken from the skin; below the size of a profile cell
constexpr double PROFILE_SIGMA = 0.015; // m
constexpr double MIN_RADIUS = 0.01;     // m, no part is thinner
constexpr double MIN_MARK_DISTANCE =
    0.04; // m, closer marks say more about their noise than about the body

/// Fractions of the arm from shoulder to hand tip, for bodies whose elbow or wrist was not found.
constexpr double ELBOW_FRACTION = 0.43, WRIST_FRACTION = 0.74;

const char* MARKS_BY_WEIGHT[] = {"neck_side", "crotch", "acromion", "axilla",
                                 "knee",      "waist",  "bust",     "hip"};
/// Heights that tell the waist: by proportion, where the girth is least, where the width is; and
/// how far each may be off, m, as the rules of body say.
constexpr std::pair<const char*, double> WAISTS[] = {
    {"waist", 0.015}, {"waist_girth_min", 0.010}, {"waist_width_min", 0.010}};

bool in(Part part, const std::vector<Part>& parts) {
  return std::find(parts.begin(), parts.end(), part) != parts.end();
}

/// Points on the faces of some parts, dense enough to leave no profile cell empty by chance.
std::vector<Vec3> sample_skin(const Body& body, const std::vector<Part>& parts) {
  std::vector<Vec3> points;
  for (std::size_t f = 0; f < body.skin.triangles.size(); ++f) {
    if (!in(body.face_part[f], parts))
      continue;
    const Triangle& t = body.skin.triangles[f];
    const Vec3 &a = body.skin.positions[t[0]], &b = body.skin.positions[t[1]],
               &c = body.skin.positions[t[2]];
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    const int n = std::clamp(static_cast<int>(std::ceil(longest / SAMPLE_SPACING)), 1, 200);
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j)
        points.push_back(a + (b - a) * (static_cast<double>(i) / n) +
                         (c - a) * (static_cast<double>(j) / n));
  }
  return points;
}

std::optional<Vec3> landmark_of(const Body& body, const std::string& name) {
  if (!body.has_landmark(name))
    return std::nullopt;
  return body.landmark(name);
}

/// Mean of a landmark of both sides, or of the one that is there.
std::optional<Vec3> find_middle(const Body& body, const std::string& stem) {
  const auto l = landmark_of(body, stem + "_l"), r = landmark_of(body, stem + "_r");
  if (l && r)
    return Vec3(0.5 * (*l + *r));
  return l ? l : r;
}

/// Centre of the skin points whose projection on the line from a to b is near a fraction of it.
Vec3 center_of_slab(const std::vector<Vec3>& points, const Vec3& a, const Vec3& b,
                    double fraction) {
  const Vec3 d = b - a;
  Vec3 sum = Vec3::Zero();
  double n = 0;
  for (const Vec3& p : points) {
    const double s = (p - a).dot(d) / d.squaredNorm();
    if (std::abs(s - fraction) < 0.03) {
      sum += p;
      ++n;
    }
  }
  return n > 0 ? Vec3(sum / n) : Vec3(a + fraction * d);
}

struct ArmJoints {
  Vec3 shoulder, elbow, wrist;
};

std::optional<ArmJoints> arm_joints(const Body& body, const std::string& side,
                                    const std::vector<Vec3>& skin) {
  const auto acromion = landmark_of(body, "acromion_" + side),
             axilla = landmark_of(body, "axilla_" + side);
  auto tip = landmark_of(body, "hand_tip_" + side);
  if (!tip)
    tip = landmark_of(body, "hand_extreme_" + side);
  if (!acromion || !tip || skin.empty())
    return std::nullopt;
  ArmJoints joints;
  // The acromion lies on the skin; the middle between it and the arm pit is inside the shoulder.
  joints.shoulder = axilla ? Vec3(0.5 * (*acromion + *axilla)) : Vec3(*acromion - Vec3(0, 0.05, 0));
  if (const auto joint = landmark_of(body, "shoulder_joint_" + side))
    joints.shoulder = *joint;
  const auto elbow = landmark_of(body, "elbow_" + side), wrist = landmark_of(body, "wrist_" + side);
  joints.elbow = elbow ? *elbow : center_of_slab(skin, joints.shoulder, *tip, ELBOW_FRACTION);
  joints.wrist = wrist ? *wrist : center_of_slab(skin, joints.shoulder, *tip, WRIST_FRACTION);
  if ((joints.shoulder - joints.elbow).norm() < 0.08 || (joints.elbow - joints.wrist).norm() < 0.05)
    return std::nullopt;
  return joints;
}

PartFrame body_frame(const Body& body, const std::string& name, const Vec3& lower,
                     const Vec3& upper) {
  const auto found = body.frames.find(name);
  if (found != body.frames.end())
    return found->second.frame;
  return make_part_frame(lower, upper, Vec3::UnitZ(),
                         name.size() > 2 && name.compare(name.size() - 2, 2, "_r") == 0);
}

void add_frame(BindFrames& all, const std::string& name, const PartFrame& frame,
               std::vector<Part> parts, double z_low, double z_high) {
  all.frames.push_back({name, frame, std::move(parts), z_low, z_high, {}, {}});
}

std::map<std::string, double> torso_marks(const Body& body, const PartFrame& frame) {
  std::map<std::string, double> marks;
  const auto set = [&](const std::string& name, const std::optional<Vec3>& p) {
    if (p)
      marks[name] = frame.coordinates(*p).z;
  };
  const auto set_level = [&](const std::string& name, const std::string& level) {
    const auto found = body.levels.find(level);
    if (found == body.levels.end())
      return;
    const double at = (found->second.y - frame.lower.y()) /
                      (frame.upper.y() - frame.lower.y()); // where the level crosses the axis
    if (std::isfinite(at))
      marks[name] = at;
  };
  set("crotch", landmark_of(body, "crotch"));
  set("axilla", find_middle(body, "axilla"));
  set("acromion", find_middle(body, "acromion"));
  set("neck_side", find_middle(body, "neck_side"));
  set_level("hip", "hip");
  set_level("waist", "waist_semantic");
  set_level("waist_girth_min", "waist_girth_min");
  set_level("waist_width_min", "waist_width_min");
  set_level("bust", "bust");
  return marks;
}

} // namespace

int BindFrames::index(const std::string& name) const {
  for (std::size_t k = 0; k < frames.size(); ++k)
    if (frames[k].name == name)
      return static_cast<int>(k);
  return -1;
}

body::SkinProfile fit_skin_profile(const PartFrame& frame, const std::vector<Vec3>& points,
                                   double z_low, double z_high, double sigma) {
  std::vector<PartCoordinates> samples;
  samples.reserve(points.size());
  double low = 1e300, high = -1e300, mean_radius = 0;
  for (const Vec3& p : points) {
    const PartCoordinates c = frame.coordinates(p);
    if (c.z < z_low || c.z > z_high)
      continue;
    samples.push_back(c);
    low = std::min(low, c.z);
    high = std::max(high, c.z);
    mean_radius += c.r;
  }
  body::SkinProfile profile;
  profile.n_theta = N_THETA;
  if (samples.empty()) { // no skin at all: a thin rod keeps the frame usable
    profile.n_z = 2;
    profile.z_low = 0;
    profile.z_high = 1;
    profile.radius.assign(2 * N_THETA, MIN_RADIUS);
    return profile;
  }
  mean_radius = std::max(mean_radius / static_cast<double>(samples.size()), MIN_RADIUS);
  const double height = std::max((high - low) * frame.length(), ROW_HEIGHT);
  const int rows = std::clamp(static_cast<int>(std::round(height / ROW_HEIGHT)) + 1, 2, 400);
  profile.n_z = rows;
  profile.z_low = low;
  profile.z_high = high;
  const double dz = height / (rows - 1), dtheta = 2 * units::PI / N_THETA;

  const int n = rows * N_THETA;
  std::vector<double> outermost(n, -1);
  for (const PartCoordinates& c : samples) {
    const int i = static_cast<int>(std::lround((c.theta + units::PI) / dtheta)) % N_THETA;
    const int j =
        std::clamp(static_cast<int>(std::lround((c.z - low) * frame.length() / dz)), 0, rows - 1);
    outermost[j * N_THETA + i] = std::max(outermost[j * N_THETA + i], c.r);
  }
  // (D + sigma^2 L) R = D R_known on the grid, 5-point, periodic in theta, free at the ends.
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(5 * static_cast<std::size_t>(n));
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
  const auto couple = [&](int a, int b, double c) {
    entries.emplace_back(a, a, c);
    entries.emplace_back(b, b, c);
    entries.emplace_back(a, b, -c);
    entries.emplace_back(b, a, -c);
  };
  const double across = std::pow(sigma / (mean_radius * dtheta), 2),
               along = std::pow(sigma / dz, 2);
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < N_THETA; ++i) {
      const int at = j * N_THETA + i;
      couple(at, j * N_THETA + (i + 1) % N_THETA, across);
      if (j + 1 < rows)
        couple(at, at + N_THETA, along);
      if (outermost[at] >= 0) {
        entries.emplace_back(at, at, 1.0);
        right[at] = outermost[at];
      }
    }
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const SparseSolver solver(matrix);
  const Eigen::VectorXd radius = solver.solve(right);
  profile.radius.resize(n);
  for (int k = 0; k < n; ++k)
    profile.radius[k] = std::max(radius[k], MIN_RADIUS);
  return profile;
}

BindFrames make_bind_frames(const Body& body) {
  BindFrames all;
  if (body.face_part.size() != body.skin.triangles.size())
    throw input_error("body.no-parts"_id, "", "", "the body's faces have no parts",
                      "make the body document again with scan-landmarks");
  const auto hip = landmark_of(body, "hip_center"), neck = landmark_of(body, "neck_center"),
             tip = landmark_of(body, "head_tip");
  const bool has_torso = body.frames.count("torso") || (hip && neck);
  if (!has_torso)
    throw input_error("body.no-torso-frame"_id, "", "/landmarks",
                      "the body has no torso frame: hip_center or neck_center was not found",
                      "a garment cannot be hung on this body");
  const PartFrame torso =
      body_frame(body, "torso", hip.value_or(Vec3::Zero()), neck.value_or(Vec3::UnitY()));
  add_frame(all, "torso", torso, {Part::TORSO, Part::LEG_L, Part::LEG_R, Part::HEAD}, -0.5, 1.2);
  all.frames.back().marks = torso_marks(body, torso);
  if (body.frames.count("head") || (neck && tip))
    add_frame(all, "head",
              body_frame(body, "head", torso.upper, tip.value_or(torso.upper + Vec3(0, 0.25, 0))),
              {Part::HEAD, Part::TORSO}, -0.5, 2);

  std::map<Part, ArmJoints> arms;
  for (const auto& [part, side] :
       {std::pair{Part::ARM_L, std::string("l")}, std::pair{Part::ARM_R, std::string("r")}}) {
    const std::vector<Vec3> skin = sample_skin(body, {part});
    const auto joints = arm_joints(body, side, skin);
    if (!joints)
      continue;
    arms[part] = *joints;
    const bool mirrored = side == "r";
    add_frame(all, "upper_arm_" + side,
              make_part_frame(joints->elbow, joints->shoulder, Vec3::UnitZ(), mirrored), {part},
              -0.35, 1.4);
    add_frame(all, "forearm_" + side,
              make_part_frame(joints->wrist, joints->elbow, Vec3::UnitZ(), mirrored), {part}, -1.5,
              1.3);
  }
  for (const auto& [part, side] :
       {std::pair{Part::LEG_L, std::string("l")}, std::pair{Part::LEG_R, std::string("r")}}) {
    const auto ankle = landmark_of(body, "ankle_" + side),
               joint = landmark_of(body, "hip_joint_" + side);
    const bool has_skin =
        std::find(body.face_part.begin(), body.face_part.end(), part) != body.face_part.end();
    if (!has_skin || !(body.frames.count("leg_" + side) || (ankle && joint)))
      continue;
    const PartFrame frame = body_frame(body, "leg_" + side, ankle.value_or(Vec3::Zero()),
                                       joint.value_or(Vec3::UnitY()));
    add_frame(all, "leg_" + side, frame, {part}, -0.5, 1.5);
    if (const auto knee = landmark_of(body, "knee_" + side))
      all.frames.back().marks["knee"] = frame.coordinates(*knee).z;
    if (const auto crotch = landmark_of(body, "crotch"))
      all.frames.back().marks["crotch"] = frame.coordinates(*crotch).z;
  }
  const int leg_l = all.index("leg_l"), leg_r = all.index("leg_r");
  if (leg_l >= 0 && leg_r >= 0) {
    const Vec3 ankles = 0.5 * (all.frames[leg_l].frame.lower + all.frames[leg_r].frame.lower);
    const PartFrame frame = body_frame(body, "lower_body", ankles, torso.lower);
    add_frame(all, "lower_body", frame, {Part::LEG_L, Part::LEG_R, Part::TORSO}, -0.5, 1.4);
    if (const auto crotch = landmark_of(body, "crotch"))
      all.frames.back().marks["crotch"] = frame.coordinates(*crotch).z;
  }

  all.frame_of_face.reserve(body.face_part.size());
  for (std::size_t f = 0; f < body.face_part.size(); ++f) {
    const Part part = body.face_part[f];
    std::string name = part == Part::NONE ? "" : body::part_name(part);
    if (part == Part::ARM_L || part == Part::ARM_R) {
      const auto joints = arms.find(part);
      if (joints != arms.end()) {
        const Triangle& t = body.skin.triangles[f];
        const Vec3 center =
            (body.skin.positions[t[0]] + body.skin.positions[t[1]] + body.skin.positions[t[2]]) / 3;
        const ArmJoints& j = joints->second;
        const Vec3 along =
            (j.shoulder - j.elbow).normalized() +
            (j.elbow - j.wrist).normalized(); // square to the plane that halves the elbow
        name = ((center - j.elbow).dot(along) > 0 ? "upper_arm_" : "forearm_") +
               std::string(part == Part::ARM_L ? "l" : "r");
      }
    }
    all.frame_of_face.push_back(name.empty() ? -1 : all.index(name));
  }
  return all;
}

void fit_profiles(BindFrames& frames, const Body& body, const std::vector<char>& needed) {
  for (std::size_t k = 0; k < frames.frames.size(); ++k) {
    BindFrame& f = frames.frames[k];
    if (needed[k])
      f.profile =
          fit_skin_profile(f.frame, sample_skin(body, f.parts), f.z_low, f.z_high, PROFILE_SIGMA);
  }
}

std::pair<Marks, Marks> with_one_waist(Marks from, Marks to) {
  double from_sum = 0, to_sum = 0, sum = 0;
  for (const auto& [name, spread] : WAISTS) {
    const double weight = 1 / (spread * spread);
    if (from.count(name) && to.count(name)) {
      from_sum += weight * from.at(name);
      to_sum += weight * to.at(name);
      sum += weight;
    }
    from.erase(name);
    to.erase(name);
  }
  if (sum > 0) {
    from["waist"] = from_sum / sum;
    to["waist"] = to_sum / sum;
  }
  return {from, to};
}

MarkMap::MarkMap(const Marks& from, double from_length, const Marks& to, double to_length)
    : m_outside_slope(from_length / to_length) {
  std::vector<std::pair<double, double>> knots;
  const auto fits = [&](double x, double y) {
    for (const auto& [kx, ky] : knots) {
      if (std::abs(x - kx) * from_length < MIN_MARK_DISTANCE ||
          std::abs(y - ky) * to_length < MIN_MARK_DISTANCE)
        return false;
      const double stretch = (y - ky) * to_length / ((x - kx) * from_length);
      if (stretch < 1.0 / 3 || stretch > 3)
        return false; // not the same place on both bodies
    }
    return true;
  };
  for (const char* name : MARKS_BY_WEIGHT)
    if (from.count(name) && to.count(name) && fits(from.at(name), to.at(name)))
      knots.emplace_back(from.at(name), to.at(name));
  if (knots.empty())
    knots = {{0.0, 0.0}, {1.0, 1.0}};
  else if (fits(0, 0) && knots.size() == 1)
    knots.emplace_back(0.0, 0.0);
  std::sort(knots.begin(), knots.end());
  for (const auto& [x, y] : knots) {
    m_x.push_back(x);
    m_y.push_back(y);
  }
  const std::size_t n = m_x.size();
  m_slope.assign(n, m_outside_slope);
  const auto secant = [&](std::size_t i) { return (m_y[i + 1] - m_y[i]) / (m_x[i + 1] - m_x[i]); };
  for (std::size_t i = 0; i < n; ++i) {
    const double before = i > 0 ? secant(i - 1) : m_outside_slope,
                 after = i + 1 < n ? secant(i) : m_outside_slope;
    m_slope[i] = 2 * before * after / (before + after); // harmonic mean: monotone
  }
}

double MarkMap::operator()(double z) const {
  if (z <= m_x.front())
    return m_y.front() + (z - m_x.front()) * m_outside_slope;
  if (z >= m_x.back())
    return m_y.back() + (z - m_x.back()) * m_outside_slope;
  std::size_t i = 0;
  while (z > m_x[i + 1])
    ++i;
  const double h = m_x[i + 1] - m_x[i], t = (z - m_x[i]) / h, u = 1 - t;
  return m_y[i] * u * u * (1 + 2 * t) + m_slope[i] * h * t * u * u +
         m_y[i + 1] * t * t * (3 - 2 * t) - m_slope[i + 1] * h * t * t * u;
}

} // namespace sloper::garment

#include <sloper/base/error.hpp>
#include <sloper/body/measure/geodesic.hpp>
#include <sloper/body/pose.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::body {

namespace {

/// To both sides of a border, share of stature.
constexpr double SHOULDER = 0.040, GROIN = 0.045, NECK_BLEND = 0.025;
constexpr double BEND_LOW = 0.10,
                 BEND_HIGH = 0.60; ///< the trunk bends between these shares of hip centre to neck
/// The shoulder goes with the clavicle: from this share of it outwards to all, and from so far
/// below the joint, of stature, up to all.
constexpr double CLAVICLE_NEAR = 0.20, CLAVICLE_FAR = 0.95, CLAVICLE_LOW = 0.13,
                 CLAVICLE_HIGH = 0.02;

double smooth_step(double x) {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// What most of a vertex's faces say.
std::vector<Part> vertex_parts(const Body& body) {
  std::vector<std::array<int, N_PARTS>> votes(body.skin.positions.size(),
                                              std::array<int, N_PARTS>{});
  for (std::size_t t = 0; t < body.skin.triangles.size(); ++t)
    if (body.face_part[t] != Part::NONE)
      for (const int v : body.skin.triangles[t])
        ++votes[v][static_cast<int>(body.face_part[t])];
  std::vector<Part> part(votes.size(), Part::TORSO);
  for (std::size_t v = 0; v < votes.size(); ++v)
    if (const auto most = std::max_element(votes[v].begin(), votes[v].end()); *most > 0)
      part[v] = static_cast<Part>(most - votes[v].begin());
  return part;
}

/// Distance over the skin from a part's border, positive inside, at most `reach` to both sides.
std::vector<double> from_border(const Body& body, const EdgeGraph& graph,
                                const std::vector<Part>& part, Part inside, double reach) {
  std::vector<char> on_border(part.size(), 0);
  for (const Triangle& t : body.skin.triangles) {
    int n = 0;
    for (const int v : t)
      n += part[v] == inside;
    if (n > 0 && n < 3)
      for (const int v : t)
        on_border[v] = 1;
  }
  std::vector<int> sources;
  for (std::size_t v = 0; v < part.size(); ++v)
    if (on_border[v])
      sources.push_back(static_cast<int>(v));
  std::vector<double> d = graph.distances(sources, reach, {});
  for (std::size_t v = 0; v < d.size(); ++v)
    d[v] = (part[v] == inside ? 1 : -1) * std::min(d[v], reach);
  return d;
}

struct Limb {
  Part part;
  std::array<std::string, 3> bones; ///< from the trunk outwards
  double blend;                     ///< at the trunk, share of stature
};

} // namespace

SkinWeights skin_weights(const Body& body) {
  if (body.skin.triangles.empty() || body.face_part.size() != body.skin.triangles.size())
    throw input_error("body.no-skin"_id, body.scan.file, "", "the body has no skin to pose",
                      "measure the scan again without --anonymise");
  auto bone = [&](const std::string& name) -> const Bone* {
    for (const Bone& b : body.bones)
      if (b.name == name)
        return &b;
    return nullptr;
  };
  const Bone* spine = bone("spine");
  if (!spine)
    throw input_error("pose.no-limb"_id, body.scan.file, "bones", "the body has no spine to pose",
                      "its hip joints or its neck were not found");
  const double s = std::max(body.scan.stature_m, 0.3);
  SkinWeights out;
  out.joints = joint_names(body);
  auto joint = [&](const std::string& name) {
    const auto it = std::find(out.joints.begin(), out.joints.end(), name);
    return it == out.joints.end() ? -1 : static_cast<int>(it - out.joints.begin());
  };
  const EdgeGraph graph(body.skin);
  const std::vector<Part> part = vertex_parts(body);
  const std::size_t n = part.size();
  std::vector<std::map<int, double>> share(n);
  std::vector<double> limbs(n, 0); // what the limbs and the head take
  const Limb all[] = {{Part::HEAD, {"head", "", ""}, NECK_BLEND},
                      {Part::ARM_L, {"upper_arm_l", "forearm_l", "hand_l"}, SHOULDER},
                      {Part::ARM_R, {"upper_arm_r", "forearm_r", "hand_r"}, SHOULDER},
                      {Part::LEG_L, {"thigh_l", "shin_l", "foot_l"}, GROIN},
                      {Part::LEG_R, {"thigh_r", "shin_r", "foot_r"}, GROIN}};
  for (const Limb& limb : all) {
    if (joint(limb.bones[0]) < 0)
      continue;
    const double reach = limb.blend * s;
    const std::vector<double> d = from_border(body, graph, part, limb.part, reach);
    for (std::size_t v = 0; v < n; ++v) {
      const double whole = smooth_step(0.5 + 0.5 * d[v] / reach);
      if (whole <= 0)
        continue;
      limbs[v] += whole;
      // from bone to bone: by the place along the direction halfway between them
      double left = whole;
      for (int k = 0; k < 3; ++k) {
        double on = 0;
        const Bone *here = bone(limb.bones[k]),
                   *next = k < 2 && !limb.bones[k + 1].empty() ? bone(limb.bones[k + 1]) : nullptr;
        if (!here)
          break;
        if (next) {
          const Vec3 axis =
              ((here->tail - here->head).normalized() + (next->tail - next->head).normalized())
                  .normalized();
          const double width =
              std::clamp(0.18 * (here->tail - here->head).norm(), 0.012 * s, 0.035 * s);
          on = smooth_step(0.5 + 0.5 * (body.skin.positions[v] - next->head).dot(axis) / width);
        }
        share[v][joint(limb.bones[k])] += left * (1 - on);
        left *= on;
      }
    }
  }
  std::vector<std::pair<const Bone*, int>> clavicles; // with their joints
  for (const char* name : {"clavicle_l", "clavicle_r"})
    if (const int j = joint(name); j >= 0)
      clavicles.emplace_back(bone(name), j);
  const auto of_clavicle = [&](const Bone& b, const Vec3& p) {
    const Vec3 along_bone = b.tail - b.head;
    const double along = (p.x() - b.head.x()) * along_bone.x() /
                         std::max(along_bone.x() * along_bone.x(), 1e-12),
                 below = (b.tail.y() - p.y()) / s;
    return smooth_step((along - CLAVICLE_NEAR) / (CLAVICLE_FAR - CLAVICLE_NEAR)) *
           smooth_step((CLAVICLE_LOW - below) / (CLAVICLE_LOW - CLAVICLE_HIGH));
  };
  const Vec3 axis = spine->tail - spine->head;
  for (std::size_t v = 0; v < n; ++v) {
    if (limbs[v] > 1)
      for (auto& [j, w] : share[v])
        w /= limbs[v];
    const double trunk = std::max(0.0, 1 - limbs[v]);
    const double z = (body.skin.positions[v] - spine->head).dot(axis) / axis.squaredNorm();
    const double upper = smooth_step((z - BEND_LOW) / (BEND_HIGH - BEND_LOW));
    if (trunk <= 0)
      continue;
    share[v][0] += trunk * (1 - upper);
    double on_spine = trunk * upper;
    for (const auto& [clavicle, j] : clavicles)
      if (const double w = of_clavicle(*clavicle, body.skin.positions[v]) * trunk * upper; w > 0) {
        share[v][j] += w;
        on_spine -= w;
      }
    share[v][joint("spine")] += on_spine;
  }
  out.joint.assign(n, {});
  out.share.assign(n, {});
  for (std::size_t v = 0; v < n; ++v) {
    std::vector<std::pair<double, int>> most;
    for (const auto& [j, w] : share[v])
      if (w > 1e-6)
        most.emplace_back(-w, j);
    std::sort(most.begin(), most.end());
    most.resize(std::min<std::size_t>(most.size(), SkinWeights::MOST));
    double sum = 0;
    for (const auto& [w, j] : most)
      sum -= w;
    for (std::size_t k = 0; k < most.size(); ++k) {
      out.joint[v][k] = most[k].second;
      out.share[v][k] = -most[k].first / sum;
    }
  }
  return out;
}

} // namespace sloper::body

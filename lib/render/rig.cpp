#include <sloper/base/error.hpp>
#include <sloper/base/parallel.hpp>
#include <sloper/body/pose.hpp>
#include <sloper/render/rig.hpp>

#include <algorithm>
#include <cmath>
#include <set>

namespace sloper::render {

namespace {

constexpr double SAMPLE_CELL = 0.02;                 // m: skin is sampled once in each cube
constexpr float REACH = 0.04F, REACH_PER_GAP = 0.5F; // m, and of the gap

/// The four largest of the shares, made to sum to 1.
void keep_four(const Eigen::VectorXd& share, std::array<int, 4>& joint,
               std::array<double, 4>& weight) {
  std::vector<int> order(static_cast<std::size_t>(share.size()));
  for (std::size_t k = 0; k < order.size(); ++k)
    order[k] = static_cast<int>(k);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return share[a] > share[b]; });
  double sum = 0;
  for (std::size_t k = 0; k < 4 && k < order.size(); ++k)
    sum += share[order[k]];
  for (std::size_t k = 0; k < 4; ++k) {
    weight[k] = k < order.size() ? share[order[k]] / sum : 0;
    joint[k] = weight[k] > 0 ? order[k] : 0;
  }
}

/// Skin, thinned.
struct Samples {
  std::vector<Vec3> at;
  std::vector<Eigen::VectorXd> share; ///< by joint
};

Rig::Skin along_with(const std::vector<Vec3>& positions, const Samples& samples) {
  const auto n = static_cast<Eigen::Index>(samples.at.size());
  Eigen::Array<float, Eigen::Dynamic, 3> at(n, 3);
  for (Eigen::Index s = 0; s < n; ++s)
    at.row(s) = samples.at[s].cast<float>().transpose();
  Rig::Skin skin;
  skin.joint.resize(positions.size());
  skin.weight.resize(positions.size());
  parallel_for(positions.size(), 512, [&](std::size_t begin, std::size_t end) {
    Eigen::ArrayXf distance2(n);
    Eigen::VectorXd share(samples.share[0].size());
    for (std::size_t v = begin; v < end; ++v) {
      const Eigen::Vector3f p = positions[v].cast<float>();
      distance2 = (at.col(0) - p.x()).square() + (at.col(1) - p.y()).square() +
                  (at.col(2) - p.z()).square();
      const float gap = std::sqrt(distance2.minCoeff()), reach = REACH + REACH_PER_GAP * gap,
                  most2 = (gap + reach) * (gap + reach);
      share.setZero();
      for (Eigen::Index s = 0; s < n; ++s) {
        if (distance2[s] >= most2)
          continue;
        const double near = 1 - (std::sqrt(distance2[s]) - gap) / reach;
        share += near * near * samples.share[s];
      }
      keep_four(share, skin.joint[v], skin.weight[v]);
    }
  });
  return skin;
}

} // namespace

std::optional<Rig> make_rig(const Scene& scene, const std::vector<DrawMesh>& meshes) {
  if (!scene.body || scene.body_mesh < 0)
    return {};
  const body::Body& body = *scene.body;
  body::SkinWeights weights;
  try {
    weights = body::skin_weights(body);
  } catch (const Error&) {
    return {}; // a torso, say: it is drawn as it stands
  }
  const auto own_mesh = static_cast<std::size_t>(scene.body_mesh);
  const std::vector<Vec3>& skin = meshes[own_mesh].positions;
  if (skin.size() != weights.joint.size())
    return {};
  Rig rig;
  rig.names = weights.joints;
  const auto bone = [&](const std::string& name) {
    return std::find_if(body.bones.begin(), body.bones.end(),
                        [&](const body::Bone& b) { return b.name == name; });
  };
  for (const std::string& name : rig.names) {
    const bool root = rig.names.front() == name;
    const auto own = bone(root ? "spine" : name);
    if (own == body.bones.end())
      return {};
    rig.head.push_back(own->head);
    int parent = root ? -1 : 0;
    for (auto above = root ? body.bones.end() : bone(own->parent);
         above != body.bones.end() && parent == 0; above = bone(above->parent)) {
      const auto known = std::find(rig.names.begin(), rig.names.end(), above->name);
      if (known != rig.names.end())
        parent = static_cast<int>(known - rig.names.begin());
    }
    if (parent >= std::ssize(rig.parent))
      return {};
    rig.parent.push_back(parent);
  }

  rig.skins.resize(meshes.size());
  Rig::Skin& of_body = rig.skins[own_mesh];
  of_body.joint.resize(skin.size());
  of_body.weight.resize(skin.size());
  Samples samples;
  std::set<std::array<long, 3>> sampled;
  for (std::size_t v = 0; v < skin.size(); ++v) {
    Eigen::VectorXd share = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(rig.names.size()));
    for (std::size_t k = 0; k < body::SkinWeights::MOST; ++k)
      share[weights.joint[v][k]] += weights.share[v][k];
    keep_four(share, of_body.joint[v], of_body.weight[v]);
    const Vec3 cell = skin[v] / SAMPLE_CELL;
    if (!sampled.insert({std::lround(cell.x()), std::lround(cell.y()), std::lround(cell.z())})
             .second)
      continue;
    samples.at.push_back(skin[v]);
    samples.share.push_back(share);
  }
  if (!scene.draped || samples.at.empty())
    return rig;
  for (const int mesh : scene.garment_mesh)
    rig.skins[mesh] = along_with(meshes[mesh].positions, samples);
  return rig;
}

} // namespace sloper::render

#include <sloper/garment/body_model/coarse_skin.hpp>

#include <meshoptimizer.h>

namespace sloper::garment {

CoarseSkin::CoarseSkin(const TriangleMesh& skin, double tolerance) : m_all(skin.triangles.size()) {
  std::vector<float> position;
  for (const Vec3& p : skin.positions)
    for (const double coordinate : p)
      position.push_back(static_cast<float>(coordinate));
  std::vector<unsigned> all;
  for (const Triangle& t : skin.triangles)
    for (const int v : t)
      all.push_back(static_cast<unsigned>(v));
  std::vector<unsigned> left(all.size());
  constexpr std::size_t STRIDE = 3 * sizeof(float);
  const float scale = meshopt_simplifyScale(position.data(), skin.positions.size(), STRIDE);
  left.resize(meshopt_simplify(left.data(), all.data(), all.size(), position.data(),
                               skin.positions.size(), STRIDE, 0,
                               static_cast<float>(tolerance) / scale, 0, nullptr));
  std::vector<int> index(skin.positions.size(), -1);
  for (const unsigned v : left)
    index[v] = 0;
  for (std::size_t v = 0; v < index.size(); ++v)
    if (index[v] == 0) {
      index[v] = static_cast<int>(m_source.size());
      m_source.push_back(static_cast<int>(v));
    }
  for (std::size_t k = 0; k < left.size(); k += 3)
    m_mesh.triangles.push_back({index[left[k]], index[left[k + 1]], index[left[k + 2]]});
  m_mesh.positions = positions(skin.positions);
}

std::vector<Vec3> CoarseSkin::positions(const std::vector<Vec3>& skin) const {
  std::vector<Vec3> own;
  for (const int v : m_source)
    own.push_back(skin[v]);
  return own;
}

} // namespace sloper::garment

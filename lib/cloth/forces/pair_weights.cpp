#include <sloper/cloth/forces/pair_weights.hpp>

#include <algorithm>

namespace sloper::cloth {

void PairWeights::add(std::span<const int> particle, const Eigen::MatrixXd& k) {
  for (std::size_t a = 0; a < particle.size(); ++a)
    for (std::size_t b = a + 1; b < particle.size(); ++b) {
      const auto [low, high] = std::minmax(particle[a], particle[b]);
      const double weight = -k(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
      std::vector<Weight>& row = m_filling[low]; // of a dozen: quicker gone through than sorted
      const int other = high;
      const auto found =
          std::find_if(row.begin(), row.end(), [&](const Weight& w) { return w.other == other; });
      if (found == row.end())
        row.push_back({other, weight});
      else
        found->weight += weight;
    }
}

void PairWeights::pack() {
  m_start = {0};
  m_diagonal.assign(m_filling.size(), 0);
  for (std::size_t i = 0; i < m_filling.size(); ++i) {
    std::vector<Weight>& row = m_filling[i];
    std::sort(row.begin(), row.end(),
              [](const Weight& a, const Weight& b) { return a.other < b.other; });
    for (const Weight& w : row) {
      m_diagonal[i] += w.weight;
      m_diagonal[w.other] += w.weight;
    }
    m_pair.insert(m_pair.end(), row.begin(), row.end());
    m_start.push_back(static_cast<int>(m_pair.size()));
  }
  m_filling = {};
}

void PairWeights::declare(std::vector<std::array<int, 2>>& pairs) const {
  for (std::size_t i = 0; i < m_diagonal.size(); ++i)
    for (int k = m_start[i]; k < m_start[i + 1]; ++k)
      pairs.push_back({static_cast<int>(i), m_pair[k].other});
}

void PairWeights::bind(const BlockMatrix& matrix) {
  m_slot.clear();
  for (std::size_t i = 0; i < m_diagonal.size(); ++i)
    for (int k = m_start[i]; k < m_start[i + 1]; ++k)
      m_slot.push_back(matrix.slot(static_cast<int>(i), m_pair[k].other));
}

double PairWeights::energy(const std::vector<Vec3>& x) const {
  double sum = 0;
  for (std::size_t i = 0; i < m_diagonal.size(); ++i) {
    double row = 0;
    for (int k = m_start[i]; k < m_start[i + 1]; ++k)
      row += m_pair[k].weight * (x[m_pair[k].other] - x[i]).squaredNorm();
    sum += row;
  }
  return 0.5 * sum;
}

void PairWeights::add_force(const std::vector<Vec3>& x, double scale,
                            std::vector<Vec3>& force) const {
  for (std::size_t i = 0; i < m_diagonal.size(); ++i) {
    Vec3 row = Vec3::Zero();
    for (int k = m_start[i]; k < m_start[i + 1]; ++k) {
      const Vec3 pull = scale * m_pair[k].weight * (x[m_pair[k].other] - x[i]);
      row += pull;
      force[m_pair[k].other] -= pull;
    }
    force[i] += row;
  }
}

void PairWeights::add_stiffness(double scale, BlockMatrix& matrix) const {
  for (std::size_t i = 0; i < m_diagonal.size(); ++i)
    matrix.add_isotropic_diagonal(static_cast<int>(i), scale * m_diagonal[i]);
  for (std::size_t k = 0; k < m_pair.size(); ++k)
    matrix.add_isotropic(m_slot[k], -scale * m_pair[k].weight);
}

} // namespace sloper::cloth

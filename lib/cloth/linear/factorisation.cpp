#include <sloper/cloth/linear/factorisation.hpp>

#include <algorithm>

namespace sloper::cloth {

namespace {

/// The lower triangle of a matrix of 3x3 blocks.
class LowerTriangle {
public:
  explicit LowerTriangle(int n_blocks) : m_size(3 * n_blocks) {}
  /// Adds block (i, j), and its transpose at (j, i) when they differ.
  void add(int i, int j, const Mat3& block) {
    if (i < j) {
      add(j, i, block.transpose());
      return;
    }
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < (i == j ? r + 1 : 3); ++c)
        m_entries.emplace_back(3 * i + r, 3 * j + c, block(r, c));
  }
  Eigen::SparseMatrix<double> matrix() const {
    Eigen::SparseMatrix<double> lower(m_size, m_size);
    lower.setFromTriplets(m_entries.begin(), m_entries.end());
    return lower;
  }

private:
  int m_size;
  std::vector<Eigen::Triplet<double>> m_entries;
};

} // namespace

void Factorisation::update(const LinearSystem& system) {
  const BlockMatrix& a = system.matrix;
  LowerTriangle lower(a.size());
  for (int i = 0; i < a.size(); ++i) {
    lower.add(i, i, a.diagonal(i));
    for (int k = a.row_start()[i]; k < a.row_start()[i + 1]; ++k)
      lower.add(i, a.column()[k], a.value()[k]);
    for (int k = a.isotropic_start()[i]; k < a.isotropic_start()[i + 1]; ++k) {
      const auto [slot, column] = a.isotropic()[k];
      if (column < i)
        lower.add(i, column, a.isotropic_value()[slot] * Mat3::Identity());
    }
  }
  for (const ContactElement& e : system.elements) {
    const Mat3 stiffness = e.stiffness();
    for (int k = 0; k < e.n; ++k)
      for (int l = 0; l <= k; ++l) {
        const Mat3 block = e.weight[k] * e.weight[l] * stiffness;
        if (k != l && e.particle[k] == e.particle[l])
          lower.add(e.particle[k], e.particle[k], 2 * block);
        else
          lower.add(e.particle[k], e.particle[l], block);
      }
  }
  m_solver.compute(lower.matrix());
}

void Factorisation::apply(const std::vector<Vec3>& r, std::vector<Vec3>& z) {
  const Eigen::Index n = 3 * static_cast<Eigen::Index>(r.size());
  z.resize(r.size());
  Eigen::Map<Eigen::VectorXd>(z.data()->data(), n) =
      m_solver.solve(Eigen::Map<const Eigen::VectorXd>(r.data()->data(), n));
}

} // namespace sloper::cloth

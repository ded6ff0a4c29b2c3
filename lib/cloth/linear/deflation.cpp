#include <cloth/linear/deflation.hpp>

#include <cmath>

namespace sloper::cloth {

/// A vector counts as new where at least this share of its energy is in what the ones before it do
/// not have.
static constexpr double LEAST_NEW_ENERGY = 1e-4;

void Deflation::keep(const std::vector<Float4>& x) {
  if (m_n_kept < MAX_BASIS)
    ++m_n_kept;
  std::rotate(m_kept.begin(), m_kept.begin() + static_cast<long>(m_n_kept - 1),
              m_kept.begin() + static_cast<long>(m_n_kept));
  m_kept[0] = x;
}

/// Each vector's dot product with v.
Deflation::Shares Deflation::shares(const Vectors& of, const std::vector<Float4>& v) {
  m_part.assign((v.size() + ROW_GRAIN - 1) / ROW_GRAIN, {});
  parallel_for(v.size(), ROW_GRAIN, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = 0; k < m_n_basis; ++k)
      m_part[begin / ROW_GRAIN][k] = dot(of[k], v, begin, end);
  });
  Shares sum{};
  for (const Shares& part : m_part)
    for (std::size_t k = 0; k < m_n_basis; ++k)
      sum[k] += part[k];
  return sum;
}

/// v -= sum_k shares_k from_k
void Deflation::take(const Vectors& from, const Shares& shares, std::vector<Float4>& v) const {
  parallel_for(v.size(), ROW_GRAIN, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = 0; k < m_n_basis; ++k) {
      const Float4 share = Float4::all(static_cast<float>(shares[k]));
      for (std::size_t i = begin; i < end; ++i)
        v[i] = v[i] - share * from[k][i];
    }
  });
}

/// Makes the vector after the last A-orthogonal to those before and of energy 1, by Gram and
/// Schmidt.
/// @return false where nothing new is left of it
bool Deflation::orthonormalise() {
  std::vector<Float4>&newest = m_basis[m_n_basis], &image = m_image[m_n_basis];
  const double before = dot(newest, image, m_sum);
  const Shares had = shares(m_image, newest);
  take(m_basis, had, newest);
  take(m_image, had, image);
  const double energy = dot(newest, image, m_sum);
  if (!(before > 0 && energy > LEAST_NEW_ENERGY * before))
    return false;
  const Float4 scale = Float4::all(static_cast<float>(1 / std::sqrt(energy)));
  for (std::size_t i = 0; i < newest.size(); ++i) {
    newest[i] = scale * newest[i];
    image[i] = scale * image[i];
  }
  return true;
}

void Deflation::start(std::vector<Float4>& x, std::vector<Float4>& r) {
  Shares best = shares(m_basis, r);
  take(m_image, best, r);
  for (double& share : best)
    share = -share;
  take(m_basis, best, x);
}

void Deflation::project(const std::vector<Float4>& r, std::vector<Float4>& z) {
  if (m_n_basis == 0)
    return;
  Shares too_much = shares(m_image, z);
  const Shares missing = shares(m_basis, r);
  for (std::size_t k = 0; k < m_n_basis; ++k)
    too_much[k] -= missing[k];
  take(m_basis, too_much, z);
}

} // namespace sloper::cloth

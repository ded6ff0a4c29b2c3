#include <cloth/linear/deflation.hpp>

#include <cmath>

namespace sloper::cloth {

/// A way counts as new where at least this share of its energy is in what the ways before it do not
/// have.
static constexpr double NEW = 1e-4;

void Deflation::keep(const std::vector<Float4>& x) {
  if (m_n_kept < MOST) ++m_n_kept;
  std::rotate(m_kept.begin(), m_kept.begin() + static_cast<long>(m_n_kept - 1),
              m_kept.begin() + static_cast<long>(m_n_kept));
  m_kept[0] = x;
}

/// Each vector's dot product with v.
Deflation::Shares Deflation::shares(const Vectors& of, const std::vector<Float4>& v) {
  m_part.assign((v.size() + ROW_GRAIN - 1) / ROW_GRAIN, {});
  parallel_for(v.size(), ROW_GRAIN, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = 0; k < m_n_ways; ++k)
      m_part[begin / ROW_GRAIN][k] = dot(of[k], v, begin, end);
  });
  Shares sum{};
  for (const Shares& part : m_part)
    for (std::size_t k = 0; k < m_n_ways; ++k) sum[k] += part[k];
  return sum;
}

/// v -= sum_k shares_k from_k
void Deflation::take(const Vectors& from, const Shares& shares, std::vector<Float4>& v) const {
  parallel_for(v.size(), ROW_GRAIN, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = 0; k < m_n_ways; ++k) {
      const Float4 share = Float4::all(static_cast<float>(shares[k]));
      for (std::size_t i = begin; i < end; ++i) v[i] = v[i] - share * from[k][i];
    }
  });
}

/// Makes the way after the last A-orthogonal to those before and of energy 1, by Gram and Schmidt.
/// False: it is none.
bool Deflation::orthonormalise() {
  std::vector<Float4>&way = m_way[m_n_ways], &image = m_image[m_n_ways];
  const double before = dot(way, image, m_sum);
  const Shares had = shares(m_image, way);
  take(m_way, had, way);
  take(m_image, had, image);
  const double energy = dot(way, image, m_sum);
  if (!(before > 0 && energy > NEW * before)) return false;
  const Float4 scale = Float4::all(static_cast<float>(1 / std::sqrt(energy)));
  for (std::size_t i = 0; i < way.size(); ++i) {
    way[i] = scale * way[i];
    image[i] = scale * image[i];
  }
  return true;
}

void Deflation::start(std::vector<Float4>& x, std::vector<Float4>& r) {
  Shares best = shares(m_way, r);
  take(m_image, best, r);
  for (double& share : best) share = -share;
  take(m_way, best, x);
}

void Deflation::project(const std::vector<Float4>& r, std::vector<Float4>& z) {
  if (m_n_ways == 0) return;
  Shares too_much = shares(m_image, z);
  const Shares missing = shares(m_way, r);
  for (std::size_t k = 0; k < m_n_ways; ++k) too_much[k] -= missing[k];
  take(m_way, too_much, z);
}

} // namespace sloper::cloth

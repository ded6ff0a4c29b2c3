#pragma once
/// Elastic bands sewn along lines of the cloth (waistbands, cuffs): each runs through particles and
/// wants to be shorter than the cloth that it is sewn to. It pulls and never pushes: tension T = EA
/// max(0, l/l0 - 1), E = EA/(2 l0) max(0, l - l0)^2 per link.
/// Test: tests/cloth/forces/test_jacobians.cpp
#include <sloper/cloth/effect.hpp>

namespace sloper::cloth {

/// A piece of band between two particles.
struct BandLink {
  int i, j;           ///< particles
  double rest_length; ///< l0 of the band between the two particles, m > 0
  double strength_n;  ///< EA: tension at unit strain, N
};

/// The effect of all bands.
class ElasticBandEffect : public Effect {
public:
  /// @param links  particles within the cloth
  explicit ElasticBandEffect(std::vector<BandLink> links) : m_links(std::move(links)) {}
  const char* name() const override { return "elastic_bands"; }
  void declare(Couplings& couplings) const override;
  void bind(const BlockMatrix& matrix) override;
  void add(StepContext& c) override;
  /// Potential at x, J.
  double energy(const std::vector<Vec3>& x) const override;
  /// Tension of link k at x, N.
  double tension(std::size_t k, const std::vector<Vec3>& x) const;
  /// As given.
  const std::vector<BandLink>& links() const { return m_links; }

private:
  std::vector<BandLink> m_links;
  std::vector<int> m_slots;
};

} // namespace sloper::cloth

#pragma once
/// Contact of cloth with cloth: repulsion inside the thickness, friction, and a bound on every particle's motion that no
/// crossing can survive.
///
/// Between two searches no particle moves farther than `displacement_bound` (less than half of the distance between any two
/// elements that it belongs to), so that a state free of crossings stays free of them, whatever the forces do (the
/// conservative bound of Offset Geometric Contact, Chen et al. 2025). Repulsion: E = k A (t - d)^3 / (6 t) for d < t, stiffened as
/// d -> 0 so that cloth pressed together keeps a gap.
#include <cloth/cloth_mesh.hpp>
#include <cloth/effect.hpp>
#include <collision/distance.hpp>
#include <collision/self_proximity.hpp>

namespace sloper::cloth {

struct SelfContactOptions {
  double thickness_m = 0.003;  ///< distance at which cloth feels cloth; less where the mesh is finer
  double search_m = 0.008;     ///< pairs up to this distance are kept
  double stiffness_n_m3 = 1e6; ///< pressure per depth
  double friction = 0.0;
};

class SelfContactEffect : public Effect {
public:
  /// @param never_collide  #P lists or empty: pairs of elements holding particles that are listed together are left out
  ///                       (the two sides of a seam that is not welded yet)
  SelfContactEffect(const ClothMesh& mesh, const SelfContactOptions& options, std::vector<std::vector<int>> never_collide = {});
  const char* name() const override { return "self_contact"; }
  void begin_step(const std::vector<Vec3>& x, double h) override;
  void add(StepContext& c) override;
  void limit(const std::vector<Vec3>& x, std::vector<Vec3>& dx) override;
  void set_search(double search_m);
  void set_friction(double mu) { m_options.friction = mu; }
  /// Room that a particle still has before the next search, m.
  double room(int particle, const Vec3& x) const;
  /// Crossing pairs of triangles at the last search; while there are any, each search looks for them anew.
  const std::vector<std::array<int, 2>>& crossings() const { return m_crossings; }
  /// Positions were changed from outside: search before the next step.
  void refresh() { m_stale = true; }
  long searches = 0;

private:
  void search(const std::vector<Vec3>& x);
  void add_pair(StepContext& c, const std::array<int, 4>& particle, const std::array<double, 4>& weight);

  const ClothMesh& m_mesh;
  SelfContactOptions m_options;
  collision::SelfProximity m_proximity;
  std::vector<double> m_thickness; // #P
  std::vector<double> m_bound;     // #P, m, from m_searched_at
  std::vector<Vec3> m_searched_at, m_last_dx;
  std::vector<std::array<int, 2>> m_crossings;
  bool m_stale = true, m_look_for_crossings = true;
};

} // namespace sloper::cloth

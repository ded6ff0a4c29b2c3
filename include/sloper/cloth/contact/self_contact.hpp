#pragma once
/// Contact of cloth with cloth: repulsion inside the thickness, friction, and limits on every
/// particle's motion that no crossing can survive.
///
/// A separating plane halfway between the elements of a near pair keeps each on its side in a step
/// (MotionLimits). While no particle moves farther than just under half the search radius from
/// where it was searched, no other pair can cross. Beyond that, CCD candidates
/// (collision/ccd_candidates.hpp) get planes too, so cloth that moves as one may move far. If
/// particles outrun the search in each step, only the repulsion radius is searched. So a state free
/// of crossings stays free of them. Pairs that can neither repel each other nor meet in the step
/// are not measured. Repulsion: see contact_potential.hpp; friction between layers is
/// Coulomb's, regularised, on the slide of the last step.
/// Test: tests/cloth/contact/test_contact.cpp
#include <set>
#include <sloper/cloth/cloth_mesh.hpp>
#include <sloper/cloth/contact/contact_potential.hpp>
#include <sloper/cloth/effect.hpp>
#include <sloper/collision/ccd_candidates.hpp>
#include <sloper/collision/distance.hpp>
#include <sloper/collision/self_proximity.hpp>

namespace sloper::cloth {

/// Numbers of contact of cloth with cloth.
struct SelfContactOptions {
  /// Activation distance of cloth with cloth; less where the mesh is finer.
  double thickness_m = 0.003;
  /// Pairs up to this distance are kept while cloth moves little; less where the mesh is
  /// finer.
  double search_m = 0.008;
  double stiffness_n_m3 = 1e6; ///< pressure per depth
  double friction = 0.0;       ///< mu; Coulomb, regularised for small slides
};

/// The self-contact effect of one cloth.
class SelfContactEffect : public Effect {
public:
  /// @param seam_class  #P or empty: particles that a seam will weld share a number >= 0, all
  /// others have -1. Elements that meet at
  ///                    a seam do not repel each other; once the seam is closed there, neither do
  ///                    they bind each other's motion.
  SelfContactEffect(const ClothMesh& mesh, const SelfContactOptions& options,
                    std::vector<int> seam_class = {});
  const char* name() const override { return "self_contact"; }
  void begin_step(const std::vector<Vec3>& x, double h) override;
  void update_contacts(const std::vector<Vec3>& x, double h) override;
  bool is_search() const override { return true; }
  void prefetch_contacts(const std::vector<Vec3>& x, double h) override {
    if (m_crossings.empty())
      begin_step(x, h);
  }
  bool crosses() const override { return !m_crossings.empty(); }
  void add(StepContext& c) override;
  double energy(const std::vector<Vec3>& x) const override;
  bool add_separating_planes(const std::vector<Vec3>& x, const std::vector<Vec3>& dx,
                             MotionLimits& limits, bool last) override;
  void end_step(const std::vector<Vec3>& x) override;
  /// Coefficient from the next step on.
  void set_friction(double mu) { m_options.friction = mu; }
  /// Switches contact off within a set of particles.
  /// @param passes  #P or empty: elements all of whose particles are marked neither repel
  /// each other nor limit each other's motion from now on
  void let_pass(std::vector<char> passes);
  /// Crossing pairs of triangles at the last search; while there are any, each search looks for
  /// them anew.
  const std::vector<std::array<int, 2>>& crossings() const { return m_crossings; }
  /// The crossings at x, searched now. Pairs that crossed and came apart are watched less
  /// closely for a while.
  const std::vector<std::array<int, 2>>& find_crossings(const std::vector<Vec3>& x);
  /// All particles moved by this common displacement, m: what the last search found still
  /// holds.
  void moved_by(const Vec3& common) {
    for (Vec3& p : m_searched_at)
      p += common;
  }
  /// Positions were changed from outside: search before the next step.
  void refresh() { m_stale = m_look_for_crossings = true; }
  long searches = 0;     ///< so far
  long far_searches = 0; ///< for pairs that close in on each other from beyond the search radius

private:
  enum class Pair { FREE, OPEN_SEAM, PASSES };
  Pair kind_of(const int* a, int n_a, const int* b, int n_b) const;
  void find_closed_seams(const std::vector<Vec3>& x);
  void search(const std::vector<Vec3>& x);
  void look(const std::vector<Vec3>& x); ///< search where it must be

  const ClothMesh& m_mesh;
  SelfContactOptions m_options;
  collision::SelfProximity m_proximity;
  collision::CcdCandidates m_closing;
  bool m_closing_stale = true;                       // positions have changed since its last search
  std::set<std::array<int, 2>> m_guarded_closing[2]; // in this step: vertex and face, edges
  std::vector<int> m_seam_class;                     // #P or empty
  std::vector<char> m_closed;                        // by seam class
  std::vector<char> m_passes;                        // #P or empty
  std::vector<double> m_thickness;                   // #P
  double m_reach = 0;                                // m, at which any pair may begin to repel
  double m_radius = 0;                               // m, of the last search
  bool m_again = false;                              // part of the step is done, from m_x_before
  bool m_fast = false;                               // the last step outran what a search covers
  struct Near {
    std::array<int, 4> particle; // vertex and face, or edge and edge
    bool is_edge;
    double distance = 0; // m, at the search
    double stiffness =
        -1; // N/m, of add(), which leaves its change out of the force; < 0: not looked at there
    double reach = 0;     // m, at which they begin to repel each other; 0 for those that do not
    bool guarded = false; // in this step
    int n_first() const { return is_edge ? 2 : 1; }
  };
  /// A pair's closest points now.
  struct Closest {
    std::array<double, 4> weight; // + on the first element, - on the second: the weighted sum is
                                  // the line from it to the first
    Vec3 first, second;           // m
    double distance;              // m
  };
  Closest closest(const Near& near, const std::vector<Vec3>& x) const;
  /// At x, N/m.
  double stiffness_of(const Near& near, const Closest& c, const std::vector<Vec3>& x) const;
  /// What a pair's ends can close in at most when particles move by these lengths, m.
  static double closing(const Near& near, const std::vector<double>& length);
  bool guard_near(const std::vector<Vec3>& x, const std::vector<Vec3>& dx, MotionLimits& limits);
  void guard(const Near& near, const Closest& c, MotionLimits& limits) const;
  bool guard_closing(const std::vector<std::array<int, 2>>& pairs, bool is_edge,
                     const std::vector<Vec3>& x, MotionLimits& limits);
  double safe_move(std::size_t particle) const;
  std::vector<Near> m_pairs;
  std::vector<Vec3> m_searched_at, m_x_before, m_last_dx;
  std::vector<double> m_moved;          // #P, m: from m_searched_at to the positions of this step
  mutable std::vector<double> m_length; // #P, m: work
  std::vector<char> m_far;              // #P: the displacement goes beyond what the search covers
  std::vector<std::array<int, 2>> m_crossings;
  bool m_stale = true, m_look_for_crossings = true;
};

} // namespace sloper::cloth

#pragma once
/// What the scenes share: sheets, simple bodies, jitter, and the measures of a state.
#include "hard_case.hpp"

#include <sloper/base/random.hpp>
#include <sloper/body/body.hpp>
#include <sloper/cloth/cloth_mesh.hpp>
#include <sloper/cloth/solver/implicit_step.hpp>
#include <sloper/garment/garment.hpp>

namespace sloper::hard {

/// A rectangle of cloth, row r along -y (hanging) or -z (flat), column c along +x.
struct Sheet {
  cloth::ClothMesh mesh;
  std::vector<Vec3> x;
  int columns = 0, rows = 0; ///< of particles
  int at(int c, int r) const { return r * columns + c; }
};
/// @param widths cells along x, m   @param heights cells along the warp, m
Sheet make_sheet(const std::vector<double>& widths, const std::vector<double>& heights,
                 const cloth::Fabric& fabric, bool hanging, const Vec3& first,
                 const std::vector<double>& layers = {0});

/// Fabric from parameters stretch_n_m, weft_ratio, shear_n_m, bend_n_m, density_kg_m2, damping_s,
/// poisson.
cloth::Fabric fabric_of(const Parameters& p);
/// Adds the membrane ("springs", "triangles", "fem") and bending ("isometric", "dihedral", "none")
/// that the parameters name.
void add_models(cloth::ClothSolver& solver, const cloth::ClothMesh& mesh, const Parameters& p);

void jitter(std::vector<Vec3>& x, double amount, std::uint64_t seed);
/// Uniform in the box between two corners.
Vec3 random_point(Random& random, const Vec3& low, const Vec3& high);

/// "finite", "strain_p99", "strain_max" (either sign), "stretch_p99" (lengthening), "crossings"
/// (pairs of triangles), "extent_m".
void measure_cloth(Outcome& o, const cloth::ClothMesh& mesh, const std::vector<Vec3>& x);
/// Hashes of a state.
void fingerprint(Outcome& o, const std::vector<Vec3>& x);

/// Sums of effects' potentials and of the motion, J.
double potential(const cloth::ClothSolver& solver, const std::vector<Vec3>& x);
double kinetic(const cloth::ClothSolver& solver);

/// Steps, and what a run measures on the way: "energy_growth" over the fall of the energy,
/// "indefinite" (solves that met p'Ap <= 0), "speed_max", "speed_last", "cg_max", "cg_mean".
class Watch {
public:
  explicit Watch(cloth::ClothSolver& solver, double inertia);
  /// False when the step was not finite.
  bool step(const cloth::StepOptions& options);
  void fill(Outcome& o) const;

private:
  double energy() const;
  cloth::ClothSolver& m_solver;
  double m_inertia, m_start, m_largest, m_least, m_growth = 0, m_speed_max = 0, m_speed = 0,
                                                 m_cg_sum = 0;
  int m_steps = 0, m_cg_max = 0, m_indefinite = 0;
  bool m_finite = true;
};

/// Closed or open skins: "sphere", "spheres" (two, `gap_m` apart along z), "pillar", "arm" (pillar
/// and a thinner one beside it, `gap_m` apart), "ridge", "spike", "plate" (one open sheet),
/// "groove". Sizes by parameters radius_m, fineness.
TriangleMesh make_body_mesh(const Parameters& p);
/// With what a drape asks of a body: parts and the landmarks of its axis.
body::Body make_body(TriangleMesh mesh);
/// What scanners do: "holes", "open" (no faces at the upper and lower end), "noise", "flipped",
/// "debris", "duplicates", "cracks", "zero_area", "none".
void damage(TriangleMesh& mesh, const std::string& kind, std::uint64_t seed);

Outcome fault_scene(const Parameters& p,
                    std::uint64_t seed); ///< crashes and endless loops, to test the runner
Outcome sheet_scene(const Parameters& p, std::uint64_t seed); ///< cloth alone
Outcome contact_scene(const Parameters& p,
                      std::uint64_t seed); ///< sheets and a body, still or moving
Outcome drape_scene(const Parameters& p,
                    std::uint64_t seed); ///< garment::drape as the program calls it
Outcome file_scene(const Parameters& p,
                   std::uint64_t seed); ///< documents and scans with something wrong in them
Outcome scan_scene(const Parameters& p,
                   std::uint64_t seed); ///< measure_scan of a damaged mannequin
Outcome bending_scene(const Parameters& p,
                      std::uint64_t seed); ///< a cantilever over decades of bending stiffness

} // namespace sloper::hard

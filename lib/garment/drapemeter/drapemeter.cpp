#include <garment/drapemeter/shadow.hpp>
#include <sloper/base/error.hpp>
#include <sloper/base/random.hpp>
#include <sloper/base/units.hpp>
#include <sloper/cloth/forces/edge_spring.hpp>
#include <sloper/cloth/forces/gravity.hpp>
#include <sloper/cloth/forces/membrane.hpp>
#include <sloper/cloth/forces/orthotropic_bending.hpp>
#include <sloper/cloth/forces/pins.hpp>
#include <sloper/cloth/forces/shear.hpp>
#include <sloper/cloth/solver/implicit_step.hpp>
#include <sloper/garment/drapemeter/drapemeter.hpp>

#include <cmath>
#include <string>

namespace sloper::garment {

namespace {

constexpr double PIN_STIFFNESS = 1e4;  // N/m
constexpr double SHADOW_CELL = 2.5e-4; // m
/// The specimen comes down unevenly: waves around the disc of this height at the rim, m, as where
/// hands let go of it one after the other, and a roughness of the cloth. Standard deviation of
/// twelve drapes of cotton, wool and denim, points: 1.2, 0.7, 1.2 with waves of 4 mm; 1.1, 1.1, 2.1
/// with 10; 1.5, 1.0, 1.5 with 20. Repeated tests of five real fabrics: 1.0 to 6.4 (Gong et al.
/// 2024).
constexpr double WAVE_HEIGHT = 1e-2, ROUGHNESS = 2e-4;
constexpr int LEAST_WAVES = 2, MOST_WAVES = 8;
/// Rings 0 to this one are held: the hinges over it carry a whole cell's curvature, half of it
/// inside the disc, and the edge of the mesh lies two cells away from there.
constexpr int OUTERMOST_HELD = 2;
constexpr int MOST_STEPS = 1500;
constexpr double STILL_M_S = 1e-4; // of pseudo time
constexpr double LARGEST_STEP_S = 0.2;

struct Ring {
  std::vector<Vec2> flat;
  std::vector<std::vector<int>> particles; // ring by ring, from within
  std::vector<cloth::RestTriangle> triangles;
};

/// Two rings zipped, always by the shorter diagonal.
void zip(const std::vector<int>& p, const std::vector<int>& q, Ring& ring) {
  const std::vector<Vec2>& flat = ring.flat;
  const auto add = [&](int a, int b, int c) {
    ring.triangles.push_back({{a, b, c}, {flat[a], flat[b], flat[c]}, 0});
  };
  std::size_t first = 0;
  for (std::size_t j = 0; j < q.size(); ++j)
    if ((flat[q[j]] - flat[p[0]]).norm() < (flat[q[first]] - flat[p[0]]).norm())
      first = j;
  for (std::size_t i = 0, j = 0; i < p.size() || j < q.size();) {
    const int pi = p[i % p.size()], pn = p[(i + 1) % p.size()], qj = q[(first + j) % q.size()],
              qn = q[(first + j + 1) % q.size()];
    const bool inner = j == q.size() || (i < p.size() && (flat[pn] - flat[qj]).norm() <
                                                             (flat[qn] - flat[pi]).norm());
    if (inner) {
      add(pi, qj, pn);
      ++i;
    } else {
      add(pi, qj, qn);
      ++j;
    }
  }
}

Ring make_ring(const DrapemeterSetup& setup) {
  const double width = setup.specimen_radius_m - setup.disc_radius_m;
  const int rings =
      std::max(3, static_cast<int>(std::lround(width / (setup.edge_m * std::sqrt(0.75)) + 0.5)));
  const double dr = width / (rings - 0.5);
  Ring ring;
  for (int k = 0; k <= rings + 1; ++k) {
    const double r = setup.disc_radius_m + (k - OUTERMOST_HELD + 0.5) * dr;
    const int n = static_cast<int>(std::lround(2 * units::PI * r * std::sqrt(0.75) / dr));
    const double offset = std::fmod(0.6180339887 * k, 1.0); // no two rings in line
    ring.particles.emplace_back();
    for (int i = 0; i < n; ++i) {
      const double a = 2 * units::PI * (i + offset) / n;
      ring.particles.back().push_back(std::ssize(ring.flat));
      ring.flat.emplace_back(r * std::cos(a), r * std::sin(a));
    }
  }
  for (int k = 0; k <= rings; ++k)
    zip(ring.particles[k], ring.particles[k + 1], ring);
  return ring;
}

/// Heights from which the free cloth comes down.
void lower_unevenly(const DrapemeterSetup& setup, const Ring& ring, std::uint64_t seed,
                    std::vector<Vec3>& x) {
  Random random(seed);
  std::vector<double> height, phase;
  for (int m = LEAST_WAVES; m <= MOST_WAVES; ++m) {
    height.push_back(random.uniform(0, WAVE_HEIGHT) / std::sqrt(MOST_WAVES - LEAST_WAVES + 1.0));
    phase.push_back(random.uniform(0, 2 * units::PI));
  }
  const double width = setup.specimen_radius_m - setup.disc_radius_m;
  for (std::size_t i = static_cast<std::size_t>(ring.particles[OUTERMOST_HELD].back()) + 1;
       i < x.size(); ++i) {
    const double angle = std::atan2(ring.flat[i].y(), ring.flat[i].x()),
                 out = std::clamp((ring.flat[i].norm() - setup.disc_radius_m) / width, 0.0, 1.0);
    for (int m = LEAST_WAVES; m <= MOST_WAVES; ++m)
      x[i].y() +=
          out * out * height[m - LEAST_WAVES] * std::sin(m * angle + phase[m - LEAST_WAVES]);
    x[i].y() += random.uniform(-ROUGHNESS, ROUGHNESS);
  }
}

/// Steps without inertia until nothing moves. Solves end early, since a line search keeps the
/// energy falling all the same: of eight specimens (four fabrics, edges of 9 mm) a drape took a
/// quarter of the time of one with a tolerance of 1e-4 and no line search
/// (docs/decisions/simulated-drapemeter.md).
/// @return steps, and whether nothing moves
std::pair<int, bool> bring_to_rest(cloth::ClothSolver& solver) {
  cloth::StepOptions o;
  o.h = 0.02;
  o.cg_tolerance = 1e-2;
  o.line_search = true;
  o.cg_max_iterations = 2000;
  o.largest_move_m = 0.02;
  for (int k = 0; k < MOST_STEPS; ++k) {
    const cloth::StepResult r = solver.step(o);
    if (!r.finite)
      return {k, false};
    const bool whole_step = r.halvings == 0 && o.h > 0.5 * LARGEST_STEP_S;
    if (whole_step && r.largest_move_m / o.h < STILL_M_S)
      return {k + 1, true};
    o.h =
        r.largest_move_m < 0.005 ? std::min(1.3 * o.h, LARGEST_STEP_S) : std::max(0.8 * o.h, 0.005);
  }
  return {MOST_STEPS, false};
}

} // namespace

DrapemeterResult drape_specimen(const cloth::Fabric& fabric, const DrapemeterSetup& setup,
                                std::uint64_t seed) {
  const double width = setup.specimen_radius_m - setup.disc_radius_m;
  if (!(setup.disc_radius_m > 0) || !(width > 2 * setup.edge_m) || !(setup.edge_m > 0))
    throw input_error("drapemeter.hardly-hangs"_id, "", "",
                      "the specimen does not hang over the disc by two edges of the mesh",
                      "give the diameters of disc and specimen");
  Ring ring = make_ring(setup);
  const cloth::ClothMesh mesh =
      cloth::make_cloth_mesh(static_cast<int>(ring.flat.size()), ring.triangles, {fabric});
  std::vector<Vec3> x;
  std::vector<cloth::Pin> pins;
  for (std::size_t i = 0; i < ring.flat.size(); ++i) {
    x.emplace_back(ring.flat[i].x(), 0, -ring.flat[i].y());
    if (static_cast<int>(i) <= ring.particles[OUTERMOST_HELD].back())
      pins.push_back({static_cast<int>(i), x.back(), PIN_STIFFNESS, Vec3::Zero()});
  }
  lower_unevenly(setup, ring, seed, x);
  cloth::ClothSolver solver(mesh, x);
  if (std::string(setup.membrane) == "fem")
    solver.emplace<cloth::MembraneEffect>(mesh);
  else {
    solver.emplace<cloth::EdgeSpringEffect>(mesh);
    solver.emplace<cloth::ShearEffect>(mesh);
  }
  // By angles: at a fold a cell of 8 mm turns by up to a radian, where the curvature vector is a
  // tenth short of the energy. That made coarse meshes softer.
  solver.emplace<cloth::OrthotropicBendingEffect>(mesh, std::vector<double>(mesh.hinges.size()));
  solver.emplace<cloth::GravityEffect>(mesh, Vec3(0, -units::GRAVITY, 0));
  solver.emplace<cloth::PinsEffect>(pins);

  DrapemeterResult out;
  std::tie(out.steps, out.at_rest) = bring_to_rest(solver);
  out.position = solver.x();
  out.triangles = mesh.particle_triangles();
  const double free = units::PI * (setup.specimen_radius_m * setup.specimen_radius_m -
                                   setup.disc_radius_m * setup.disc_radius_m);
  out.coefficient =
      shadow_area(out.triangles, out.position, SHADOW_CELL, setup.disc_radius_m) / free;
  for (int p : ring.particles.back())
    out.rim.push_back(out.position[p]);
  out.folds = count_folds(out.rim);
  for (const cloth::EdgeSpring& s : mesh.springs)
    out.largest_strain = std::max(
        out.largest_strain, (out.position[s.j] - out.position[s.i]).norm() / s.rest_length - 1);
  return out;
}

} // namespace sloper::garment

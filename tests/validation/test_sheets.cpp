/// Sheets that hang, pull and swell, against closed solutions; and that energy never grows by
/// itself.
#include "at_rest.hpp"
#include "figures.hpp"

#include <gtest/gtest.h>
#include <memory>
#include <sloper/base/random.hpp>
#include <sloper/cloth/forces/bending.hpp>
#include <sloper/cloth/forces/dihedral_bending.hpp>
#include <sloper/cloth/forces/edge_spring.hpp>
#include <sloper/cloth/forces/gravity.hpp>
#include <sloper/cloth/forces/membrane.hpp>
#include <sloper/cloth/forces/pins.hpp>
#include <sloper/cloth/forces/pressure.hpp>
#include <sloper/cloth/forces/shear.hpp>
#include <sloper/cloth/forces/triangle_stretch.hpp>

using namespace sloper;
using namespace sloper::cloth;

namespace {

constexpr double G = 9.80665;
enum class Model { SPRINGS, TRIANGLES, FEM };
constexpr Model MODELS[] = {Model::SPRINGS, Model::TRIANGLES, Model::FEM};
const char* name_of(Model m) {
  if (m == Model::SPRINGS)
    return "springs";
  return m == Model::TRIANGLES ? "triangles" : "fem";
}

void add_stretch(ClothSolver& solver, const ClothMesh& mesh, Model model) {
  if (model == Model::SPRINGS)
    solver.emplace<EdgeSpringEffect>(mesh);
  if (model == Model::TRIANGLES)
    solver.emplace<TriangleStretchEffect>(mesh);
  if (model == Model::FEM)
    solver.emplace<MembraneEffect>(mesh);
  if (model != Model::FEM)
    solver.emplace<ShearEffect>(mesh);
}

Fabric plain(double stretch) {
  Fabric f;
  f.density_kg_m2 = 0.2;
  f.stretch_warp_n_m = f.stretch_weft_n_m = stretch;
  f.shear_n_m = stretch / 8;
  f.bend_n_m = 1e-7;
  f.damping_s = 0;
  f.poisson = 0;
  return f;
}

} // namespace

TEST(Catenary, a_strip_between_two_points_hangs_as_a_chain_within_1_percent) {
  // y = a cosh(x/a): length 2 a sinh(d/2a) = 0.5 m over a span d of 0.4 m, sag a (cosh(d/2a) - 1).
  const double length = 0.5, span = 0.4;
  double low = 0.01, high = 10;
  for (int k = 0; k < 100; ++k) {
    const double a = 0.5 * (low + high);
    (2 * a * std::sinh(span / (2 * a)) > length ? low : high) = a;
  }
  const double sag = low * (std::cosh(span / (2 * low)) - 1);
  for (double x = -0.5 * span; x <= 0.5 * span + 1e-9; x += span / 40)
    plot_point("catenary", "chain", x, low * (std::cosh(x / low) - 1) - sag);
  for (Model model : MODELS) {
    const int n = 50;
    Sheet s = make_sheet(n, 2, length / n, length / n, plain(5000));
    std::vector<Vec3> x = s.x;
    for (Vec3& p : x)
      p.x() *= span / length; // compressed at the start: it must find its length
    for (Vec3& p : x)
      p.y() = -0.01 * std::sin(M_PI * p.x() / span);
    ClothSolver solver(s.mesh, x);
    add_stretch(solver, s.mesh, model);
    solver.emplace<BendingEffect>(s.mesh);
    solver.emplace<GravityEffect>(s.mesh, Vec3(0, -G, 0));
    std::vector<Pin> pins;
    for (int r = 0; r <= s.ny; ++r)
      for (int c : {0, n})
        pins.push_back({s.at(c, r), x[s.at(c, r)], 1e5, Vec3::Zero()});
    solver.emplace<PinsEffect>(pins);
    EXPECT_GT(go_to_rest(solver), 0);
    const double ours = -solver.x()[s.at(n / 2, 1)].y();
    for (int c = 0; c <= n; c += 2)
      plot_point("catenary", name_of(model), solver.x()[s.at(c, 1)].x() - 0.5 * span,
                 solver.x()[s.at(c, 1)].y());
    print_figure(std::string("catenary sag, m, ") + name_of(model), ours, sag);
    EXPECT_NEAR(ours / sag, 1, 0.01) << name_of(model);
  }
}

TEST(HangingSquare, grows_under_its_own_weight_by_rho_g_L2_over_2Y) {
  // A square held along its upper edge, without Poisson's ratio: strain at height z above the hem
  // rho g z / Y, in sum rho g L^2 / 2Y.
  const double side = 0.5, stretch = 200;
  for (Model model : MODELS) {
    Fabric fabric = plain(stretch);
    fabric.shear_n_m = stretch / 2; // of an isotropic sheet without Poisson's ratio
    const int n = 20;
    HexSheet s =
        make_hex_sheet(n, side / n, 17, fabric); // springs are calibrated for equilateral triangles
    for (Vec3& p : s.x)
      p = Vec3(p.z(), -p.x(), 0); // upright: the first column is the upper edge
    ClothSolver solver(s.mesh, s.x);
    add_stretch(solver, s.mesh, model);
    solver.emplace<BendingEffect>(s.mesh);
    solver.emplace<GravityEffect>(s.mesh, Vec3(0, -G, 0));
    std::vector<Pin> pins;
    for (int p : s.columns[0])
      pins.push_back({p, s.x[p], 1e5, Vec3::Zero()});
    solver.emplace<PinsEffect>(pins);
    EXPECT_GT(go_to_rest(solver), 0);
    const auto& hem = s.columns.back();
    const double ours = -side - solver.x()[hem[hem.size() / 2]].y(),
                 exact = fabric.density_kg_m2 * G * side * side / (2 * stretch);
    for (std::size_t c = 0; c < s.columns.size();
         c += 2) { // the middle of each row, and how far it sank
      const int p = s.columns[c][s.columns[c].size() / 2];
      const double below = -s.x[p].y();
      plot_point("hanging", name_of(model), below, 1000 * (s.x[p].y() - solver.x()[p].y()));
      if (model == Model::FEM)
        plot_point("hanging", "exact", below,
                   1000 * fabric.density_kg_m2 * G * (side * below - 0.5 * below * below) /
                       stretch);
    }
    print_figure(std::string("own-weight stretch, m, ") + name_of(model), ours, exact);
    EXPECT_NEAR(ours / exact, 1, 0.02) << name_of(model);
  }
}

TEST(Drum, under_pressure_bulges_as_hencky_s_membrane_within_3_percent) {
  // Hencky 1915: a round membrane held at its rim, w0 = 0.662 a (p a / E h)^(1/3) for a Poisson's
  // ratio of 0.3 (Timoshenko and Woinowsky-Krieger, Theory of Plates and Shells, 1959, section 98).
  const double a = 0.1, stretch = 2000, nu = 0.3, pressure = 20;
  Fabric fabric = plain(stretch);
  fabric.poisson = nu;
  fabric.shear_n_m = stretch / (2 * (1 + nu));
  const int rings = 14;
  std::vector<Vec2> flat{Vec2(0, 0)};
  std::vector<RestTriangle> triangles;
  auto id = [&](int ring, int k) {
    return ring == 0 ? 0 : 1 + 3 * ring * (ring - 1) + (k % (6 * ring));
  };
  for (int ring = 1; ring <= rings; ++ring)
    for (int k = 0; k < 6 * ring; ++k) {
      const double t = 2 * M_PI * k / (6 * ring);
      flat.emplace_back(a * ring / rings * std::cos(t), a * ring / rings * std::sin(t));
    }
  auto add = [&](int p, int q, int r) {
    triangles.push_back({{p, q, r}, {flat[p], flat[q], flat[r]}, 0});
  };
  for (int ring = 1; ring <= rings; ++ring)
    for (int side = 0; side < 6; ++side)
      for (int k = 0; k < ring; ++k) {
        const int outer = side * ring + k, inner = side * (ring - 1) + k;
        add(id(ring, outer), id(ring, outer + 1), id(ring - 1, inner));
        if (k + 1 < ring)
          add(id(ring - 1, inner), id(ring, outer + 1), id(ring - 1, inner + 1));
      }
  const ClothMesh mesh = make_cloth_mesh(static_cast<int>(flat.size()), triangles, {fabric});
  std::vector<Vec3> x;
  std::vector<Pin> pins;
  for (const Vec2& p : flat) {
    x.emplace_back(p.x(), 1e-3 * (1 - p.squaredNorm() / (a * a)), -p.y());
    if (p.norm() > a * (1 - 1e-9))
      pins.push_back({static_cast<int>(x.size()) - 1, x.back(), 1e6, Vec3::Zero()});
  }
  ClothSolver solver(mesh, x);
  solver.emplace<MembraneEffect>(mesh);
  solver.emplace<PressureEffect>(mesh.particle_triangles(), pressure);
  solver.emplace<PinsEffect>(pins);
  EXPECT_GT(go_to_rest(solver), 0);
  const double exact = 0.662 * a * std::cbrt(pressure * a / stretch);
  for (int ring = 0; ring <= rings; ++ring)
    plot_point("drum", "finite elements", 1000 * flat[id(ring, 0)].norm(),
               1000 * solver.x()[id(ring, 0)].y());
  plot_point("drum", "Hencky 1915", 0, 1000 * exact);
  print_figure("drum's height, m", solver.x()[0].y(), exact);
  EXPECT_NEAR(solver.x()[0].y() / exact, 1, 0.03);
}

TEST(Energy, never_grows_without_input) {
  // From a crumpled start, with the inertia of the paper's own step, no gravity, no damping:
  // kinetic plus potential energy may only fall (implicit steps take some), at any step.
  for (Model model : MODELS)
    for (double h : {1.0 / 240, 1.0 / 60, 1.0 / 30})
      for (double scale : {0.9, 1.05}) {
        Sheet s = make_sheet(8, 8, 0.02, 0.02, plain(1000));
        Random random(7);
        for (Vec3& p : s.x) {
          p *= scale;
          for (int k = 0; k < 3; ++k)
            p[k] += random.uniform(-0.002, 0.002);
        }
        ClothSolver solver(s.mesh, s.x);
        const auto potential = [&] {
          const auto& x = solver.x();
          double sum = BendingEffect(s.mesh).energy(x);
          if (model == Model::SPRINGS)
            sum += EdgeSpringEffect(s.mesh).energy(x);
          if (model == Model::TRIANGLES)
            sum += TriangleStretchEffect(s.mesh).energy(x);
          if (model == Model::FEM)
            sum += MembraneEffect(s.mesh).energy(x);
          if (model != Model::FEM)
            sum += ShearEffect(s.mesh).energy(x);
          return sum;
        };
        add_stretch(solver, s.mesh, model);
        solver.emplace<BendingEffect>(s.mesh);
        StepOptions o;
        o.h = h;
        o.inertia = 1;
        o.cg_tolerance = 1e-6;
        o.cg_max_iterations = 2000;
        o.largest_move_m = 1;
        const double start = potential();
        double before = start, worst = 0;
        for (int k = 0; k < 100; ++k) {
          ASSERT_TRUE(solver.step(o).finite);
          double total = potential();
          for (std::size_t i = 0; i < s.x.size(); ++i)
            total += 0.5 * s.mesh.mass[i] * solver.v()[i].squaredNorm();
          worst = std::max(worst, (total - before) / start);
          if (scale < 1)
            plot_point("energy",
                       std::string(name_of(model)) + ", h = 1/" +
                           std::to_string(std::lround(1 / h)) + " s",
                       (k + 1) * h, total / start);
          before = total;
        }
        EXPECT_LT(worst, 1e-6) << name_of(model) << ", h " << h << ", scale " << scale;
        EXPECT_LT(before, start);
      }
}

#include "scene_tools.hpp"

#include <sloper/cloth/forces/bending.hpp>
#include <sloper/cloth/forces/dihedral_bending.hpp>
#include <sloper/cloth/forces/edge_spring.hpp>
#include <sloper/cloth/forces/membrane.hpp>
#include <sloper/cloth/forces/shear.hpp>
#include <sloper/cloth/forces/triangle_stretch.hpp>
#include <sloper/collision/intersections.hpp>
#include <sloper/io/files.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sloper::hard {

const std::map<std::string, Scene>& scenes() {
  static const std::map<std::string, Scene> all = {
      {"sheet", sheet_scene}, {"contact", contact_scene}, {"drape", drape_scene},
      {"file", file_scene},   {"scan", scan_scene},       {"bending", bending_scene},
      {"fault", fault_scene}};
  return all;
}

Sheet make_sheet(const std::vector<double>& widths, const std::vector<double>& heights,
                 const cloth::Fabric& fabric, bool hanging, const Vec3& first,
                 const std::vector<double>& layers) {
  Sheet s;
  s.columns = static_cast<int>(widths.size()) + 1;
  s.rows = static_cast<int>(heights.size()) + 1;
  std::vector<double> u{0}, v{0};
  for (double w : widths)
    u.push_back(u.back() + w);
  for (double h : heights)
    v.push_back(v.back() + h);
  std::vector<Vec2> flat;
  std::vector<cloth::RestTriangle> triangles;
  for (std::size_t layer = 0; layer < layers.size(); ++layer) {
    const int base = std::ssize(s.x);
    for (double b : v)
      for (double a : u) {
        flat.emplace_back(a, b);
        s.x.push_back(first + (hanging ? Vec3(a, -b, layers[layer]) : Vec3(a, layers[layer], -b)));
      }
    auto add = [&](int a, int b, int c) {
      triangles.push_back({{base + a, base + b, base + c}, {flat[a], flat[b], flat[c]}, 0});
    };
    for (int r = 0; r + 1 < s.rows; ++r)
      for (int c = 0; c + 1 < s.columns; ++c) {
        const int a = s.at(c, r), b = s.at(c + 1, r), d = s.at(c, r + 1), e = s.at(c + 1, r + 1);
        if ((r + c) % 2) {
          add(a, b, d);
          add(b, e, d);
        } else {
          add(a, b, e);
          add(a, e, d);
        }
      }
  }
  s.mesh = cloth::make_cloth_mesh(static_cast<int>(s.x.size()), triangles, {fabric});
  return s;
}

cloth::Fabric fabric_of(const Parameters& p) {
  cloth::Fabric f;
  f.stretch_warp_n_m = p.number("stretch_n_m", 1000);
  f.stretch_weft_n_m = f.stretch_warp_n_m * p.number("weft_ratio", 1);
  f.shear_n_m = p.number("shear_n_m", 60);
  f.bend_n_m = p.number("bend_n_m", 1e-5);
  f.density_kg_m2 = p.number("density_kg_m2", 0.12);
  f.damping_s = p.number("damping_s", 0.02);
  f.poisson = p.number("poisson", 0.25);
  return f;
}

void add_models(cloth::ClothSolver& solver, const cloth::ClothMesh& mesh, const Parameters& p) {
  const std::string membrane = p.text("membrane", "springs"),
                    bending = p.text("bending", "isometric");
  if (membrane == "fem")
    solver.emplace<cloth::MembraneEffect>(mesh);
  else if (membrane == "triangles")
    solver.emplace<cloth::TriangleStretchEffect>(mesh);
  else
    solver.emplace<cloth::EdgeSpringEffect>(mesh);
  if (membrane != "fem")
    solver.emplace<cloth::ShearEffect>(mesh);
  if (bending == "dihedral")
    solver.emplace<cloth::DihedralBendingEffect>(mesh);
  else if (bending != "none")
    solver.emplace<cloth::BendingEffect>(mesh);
}

void jitter(std::vector<Vec3>& x, double amount, std::uint64_t seed) {
  if (seed == 0 || amount == 0)
    return;
  Random random(seed);
  for (Vec3& p : x)
    for (int k = 0; k < 3; ++k)
      p[k] += random.uniform(-amount, amount);
}

Vec3 random_point(Random& random, const Vec3& low, const Vec3& high) {
  Vec3 p;
  for (int k : {2, 1, 0})
    p[k] = random.uniform(low[k], high[k]);
  return p;
}

void measure_cloth(Outcome& o, const cloth::ClothMesh& mesh, const std::vector<Vec3>& x) {
  o.value["finite"] = std::all_of(x.begin(), x.end(), [](const Vec3& p) { return p.allFinite(); });
  if (o.value["finite"] == 0)
    return;
  std::vector<double> strain, stretch;
  for (const cloth::EdgeSpring& s : mesh.springs) {
    const double e = (x[s.j] - x[s.i]).norm() / s.rest_length - 1;
    strain.push_back(std::abs(e));
    stretch.push_back(std::max(e, 0.0));
  }
  std::sort(strain.begin(), strain.end());
  std::sort(stretch.begin(), stretch.end());
  const std::size_t p99 = (strain.size() - 1) * 99 / 100;
  o.value["strain_p99"] = strain[p99];
  o.value["strain_max"] = strain.back();
  o.value["stretch_p99"] = stretch[p99];
  double extent = 0;
  for (const Vec3& q : x)
    extent = std::max(extent, q.cwiseAbs().maxCoeff());
  o.value["extent_m"] = extent;
  const std::vector<Triangle> triangles = mesh.particle_triangles();
  o.value["crossings"] = static_cast<double>(
      collision::self_intersections(x, triangles, collision::TriangleTree(x, triangles)).size());
}

void fingerprint(Outcome& o, const std::vector<Vec3>& x) {
  o.hash = io::sha256({reinterpret_cast<const char*>(x.data()), x.size() * sizeof(Vec3)});
  std::vector<long> cells;
  for (const Vec3& p : x)
    for (int k = 0; k < 3; ++k)
      cells.push_back(std::isfinite(p[k]) ? std::lround(p[k] * 1e5) : 0);
  o.quantised =
      io::sha256({reinterpret_cast<const char*>(cells.data()), cells.size() * sizeof(long)});
}

double potential(const cloth::ClothSolver& solver, const std::vector<Vec3>& x) {
  double sum = 0;
  for (const auto& e : solver.effects())
    sum += e->energy(x);
  return sum;
}

double kinetic(const cloth::ClothSolver& solver) {
  double sum = 0;
  for (std::size_t i = 0; i < solver.v().size(); ++i)
    sum += 0.5 * solver.mesh().mass[i] * solver.v()[i].squaredNorm();
  return sum;
}

Watch::Watch(cloth::ClothSolver& solver, double inertia) : m_solver(solver), m_inertia(inertia) {
  m_start = m_largest = m_least = energy();
}

double Watch::energy() const {
  return potential(m_solver, m_solver.x()) + (m_inertia > 0 ? kinetic(m_solver) : 0);
}

bool Watch::step(const cloth::StepOptions& options) {
  const cloth::StepResult r = m_solver.step(options);
  m_indefinite += r.cg.indefinite;
  m_cg_max = std::max(m_cg_max, r.cg.iterations);
  m_cg_sum += r.cg.iterations;
  ++m_steps;
  m_finite = m_finite && r.finite;
  m_speed = r.largest_move_m / options.h;
  m_speed_max = std::max(m_speed_max, m_speed);
  const double e = energy();
  m_largest = std::max(m_largest, e);
  m_least = std::min(m_least, e);
  return r.finite;
}

void Watch::fill(Outcome& o) const {
  o.value["energy_growth"] = (m_largest - m_start) / (m_start - m_least + 1e-9);
  o.value["indefinite"] = m_indefinite;
  o.value["cg_max"] = m_cg_max;
  o.value["cg_mean"] = m_cg_sum / std::max(m_steps, 1);
  o.value["speed_max"] = m_speed_max;
  o.value["speed_last"] = m_speed;
  o.value["steps"] = m_steps;
  if (!m_finite) {
    o.exit = 4;
    o.said += "a step was not finite and was undone";
  }
}

} // namespace sloper::hard

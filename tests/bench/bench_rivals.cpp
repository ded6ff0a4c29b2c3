/// Scenes that other cloth programs were timed on, simulated as they were (dynamics, 60 frames),
/// and then brought to rest. Usage: bench_rivals FOLDER [SCENE ...]: FOLDER holds scenes.json and
/// its OBJ files (z up). A scene's name may end in "+self" (self contact), "+rest" (on to rest: the
/// scene's frames, then steps without inertia, which alone would crumple cloth in free fall) or
/// both. Prints one line a scene, to rest one for each of SLOPER_BENCH_STARTS starts from
/// SLOPER_BENCH_START on, and their mean. One thread.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <optional>
#include <sloper/base/parallel.hpp>
#include <sloper/base/random.hpp>
#include <sloper/cloth/contact/body_contact.hpp>
#include <sloper/cloth/contact/self_contact.hpp>
#include <sloper/cloth/forces/bending.hpp>
#include <sloper/cloth/forces/edge_spring.hpp>
#include <sloper/cloth/forces/gravity.hpp>
#include <sloper/cloth/forces/pins.hpp>
#include <sloper/cloth/forces/shear.hpp>
#include <sloper/cloth/solver/implicit_step.hpp>
#include <sloper/collision/body_collider.hpp>
#include <sloper/collision/intersections.hpp>
#include <sloper/io/json.hpp>
#include <sloper/io/obj.hpp>

using namespace sloper;
using namespace sloper::cloth;

namespace {

double cpu_s() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

const char* environment(const char* name, const char* fallback) {
  const char* value = std::getenv(name);
  return value ? value : fallback;
}

ClothMesh cloth_of(const TriangleMesh& rest, double density) {
  std::vector<RestTriangle> triangles;
  for (const Triangle& t : rest.triangles) {
    const Vec3 u = rest.positions[t[1]] - rest.positions[t[0]],
               v = rest.positions[t[2]] - rest.positions[t[0]];
    const Vec3 along = u.normalized(), across = (v - v.dot(along) * along).normalized();
    triangles.push_back({t, {Vec2(0, 0), Vec2(u.norm(), 0), Vec2(v.dot(along), v.dot(across))}, 0});
  }
  Fabric fabric;
  fabric.density_kg_m2 = density;
  fabric.stretch_warp_n_m = fabric.stretch_weft_n_m = 1000;
  fabric.shear_n_m = 0; // the rivals have none: edges in three directions carry it
  fabric.damping_s = std::atof(environment("SLOPER_BENCH_DAMPING", "0.005"));
  return make_cloth_mesh(static_cast<int>(rest.positions.size()), triangles, {fabric});
}

struct Quality {
  double strain_p99 = 0, strain_max = 0, deepest_m = 0;
  std::size_t inside = 0, through = 0, self = 0;
};

Quality measure(const ClothMesh& mesh, const std::vector<Vec3>& x,
                const collision::BodyCollider* body) {
  Quality q;
  std::vector<double> strain;
  for (const EdgeSpring& s : mesh.springs)
    strain.push_back((x[s.i] - x[s.j]).norm() / s.rest_length - 1);
  std::sort(strain.begin(), strain.end());
  q.strain_p99 = strain[static_cast<std::size_t>(0.99 * static_cast<double>(strain.size() - 1))];
  q.strain_max = strain.back();
  const std::vector<Triangle> triangles = mesh.particle_triangles();
  if (body) {
    q.through = body->faces_through(x, triangles).size();
    for (const Vec3& p : x) {
      if (!body->is_inside(p))
        continue;
      ++q.inside;
      q.deepest_m = std::max(q.deepest_m, -body->signed_distance(p, 1).distance);
    }
  }
  const collision::TriangleTree tree(x, triangles);
  q.self = collision::self_intersections(x, triangles, tree).size();
  return q;
}

/// Where the cloth starts: each number but 0 moves each coordinate by up to half a micrometre,
/// otherwise. How many steps lead to rest is up to chance by a factor of two: a figure is a mean
/// over several.
std::vector<Vec3> start_of(std::vector<Vec3> x, int seed) {
  Random random(static_cast<std::uint64_t>(seed));
  for (Vec3& p : x)
    for (double& c : p)
      c += seed > 0 ? random.uniform(-0.5e-6, 0.5e-6) : 0;
  return x;
}

/// Prints its line. @returns CPU seconds
double run(const std::string& folder, const std::string& name, bool self, bool to_rest,
           const io::Json& scene, int seed) {
  const auto load = [&](const std::string& file) {
    const io::ObjMesh obj = io::read_obj(folder + "/" + file);
    return TriangleMesh{obj.positions, obj.triangles};
  };
  const TriangleMesh start = load(scene.at("cloth"));
  const ClothMesh mesh = cloth_of(start, scene.at("areal_density"));
  ClothSolver solver(mesh, start_of(start.positions, seed));
  solver.emplace<EdgeSpringEffect>(mesh);
  solver.emplace<BendingEffect>(mesh);
  const auto g = scene.at("gravity").get<std::array<double, 3>>();
  solver.emplace<GravityEffect>(mesh, Vec3(g[0], g[1], g[2]));
  std::vector<Pin> pins;
  for (int p : scene.at("pins"))
    pins.push_back({p, start.positions[p]});
  if (!pins.empty())
    solver.emplace<PinsEffect>(pins);
  std::optional<collision::BodyCollider> body;
  BodyContactEffect* body_contact = nullptr;
  for (const std::string collider : scene.at("colliders")) {
    body.emplace(load(collider));
    BodyContactOptions options;
    options.friction = 0.3;
    body_contact = &solver.emplace<BodyContactEffect>(mesh, *body, options);
  }
  SelfContactEffect* self_contact = nullptr;
  if (self) {
    SelfContactOptions options;
    options.thickness_m = scene.at("thickness");
    options.friction = 0.3;
    self_contact = &solver.emplace<SelfContactEffect>(mesh, options);
  }

  const int frames = std::min(scene.at("frames").get<int>(),
                              std::atoi(environment("SLOPER_BENCH_FRAMES", "1000000")));
  const int substeps = std::atoi(environment("SLOPER_BENCH_SUBSTEPS", "1"));
  StepOptions options;
  // In motion as loose as the step itself: skirt_3k after 20 frames is 16 mm RMS from a solve to
  // 0.001, and that 23 mm from one with half the step.
  options.cg_tolerance = to_rest ? 1e-3 : std::atof(environment("SLOPER_BENCH_TOLERANCE", "0.5"));
  options.cg_energy_tolerance =
      to_rest ? std::atof(environment("SLOPER_BENCH_ENERGY_TOLERANCE", "0.1")) : 0;
  options.largest_move_m = 0.5;
  std::vector<double> frame_ms;
  long iterations = 0, steps = 0;
  StepResult last;
  const double began = cpu_s();
  options.inertia = 1;
  options.h = 1.0 / scene.at("fps").get<double>() / substeps;
  for (int f = 0; f < frames; ++f) {
    const double frame_began = cpu_s();
    for (int s = 0; s < substeps; ++s, ++steps) {
      last = solver.step(options);
      iterations += last.cg.iterations;
    }
    frame_ms.push_back(1e3 * (cpu_s() - frame_began));
  }
  if (to_rest) {
    const double target = 0.01; // of a particle's weight
    solver.stop();
    options.inertia = 0;
    options.least_residual_ratio = target;
    options.h = 1.0 / 30;
    options.line_search = options.momentum = true;
    options.full_hessian_near_rest = true;
    options.largest_move_m = 0.05;
    for (; steps < 3000; ++steps) {
      last = solver.step(options);
      iterations += last.cg.iterations;
      if (std::getenv("SLOPER_BENCH_TRACE")) // one line a step
        std::printf(
            "%5ld h %8.4f CG %3d halvings %d move %9.3g mm, residual %9.4f %9.4f held %zu\n", steps,
            options.h, last.cg.iterations, last.halvings, 1e3 * last.largest_move_m,
            last.residual_force_ratio, last.residual_force_ratio_max, last.held);
      if (last.residual_force_ratio_max < target)
        break;
      options.h =
          last.halvings > 0 ? std::max(0.7 * options.h, 0.01) : std::min(1.3 * options.h, 1e3);
    }
    frame_ms.assign(1, 0);
  }
  const double seconds = cpu_s() - began;
  std::sort(frame_ms.begin(), frame_ms.end());
  const Quality q = measure(mesh, solver.x(), body ? &*body : nullptr);
  const std::string label = name + (self ? "+self" : "") + (to_rest ? "+rest" : "");
  std::printf(
      "%-20s %8.3f %-12s %7.2f %7.2f %6ld %6.1f %8.2f %8.2f %6zu %6zu %7.2f %6zu %9.4f %9.4f\n",
      label.c_str(), to_rest ? seconds : seconds / frames * scene.at("fps").get<double>(),
      to_rest ? "s to rest" : "CPU s/s", frame_ms[frame_ms.size() / 2], frame_ms.back(), steps,
      steps ? static_cast<double>(iterations) / static_cast<double>(steps) : 0, 100 * q.strain_p99,
      100 * q.strain_max, q.inside, q.through, 1e3 * q.deepest_m, q.self, last.residual_force_ratio,
      last.residual_force_ratio_max);
  if (std::getenv("SLOPER_BENCH_SPLIT")) {
    std::printf("    assembly %.3f solve %.3f limits %.3f search %.3f s;", solver.assembly_s,
                solver.solve_s, solver.contact_s, solver.search_s);
    for (const auto& e : solver.effects())
      std::printf(" %s %.3f", e->name(), e->wall_s);
    std::printf("; searches body %ld self %ld\n", body_contact ? body_contact->searches : 0,
                self_contact ? self_contact->searches : 0);
  }
  if (const char* out = std::getenv("SLOPER_BENCH_OUT")) {
    FILE* file = std::fopen((std::string(out) + "/" + label + ".obj").c_str(), "w");
    for (const Vec3& p : solver.x())
      std::fprintf(file, "v %.6f %.6f %.6f\n", p.x(), p.y(), p.z());
    for (const Triangle& t : start.triangles)
      std::fprintf(file, "f %d %d %d\n", t[0] + 1, t[1] + 1, t[2] + 1);
    std::fclose(file);
  }
  std::fflush(stdout);
  return seconds;
}

} // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: bench_rivals FOLDER [SCENE[+self][+rest] ...]\n");
    return 2;
  }
  set_thread_count(1);
  const std::string folder = argv[1];
  std::vector<std::string> wanted(argv + 2, argv + argc);
  if (wanted.empty())
    wanted = {"hang_3k",      "skirt_3k+self",      "skirt_10k+self",      "sheet_30k+self",
              "hang_3k+rest", "skirt_3k+self+rest", "skirt_10k+self+rest", "sheet_30k+self+rest"};
  const io::Json scenes = io::read_json(folder + "/scenes.json");
  std::printf("%-20s %8s %-12s %7s %7s %6s %6s %8s %8s %6s %6s %7s %6s %9s %9s\n", "scene", "time",
              "", "ms/f", "worst", "steps", "CG", "p99 %", "max %", "inside", "thru", "deep mm",
              "self", "res p95", "res max");
  for (const std::string& w : wanted) {
    const std::string name = w.substr(0, w.find('+'));
    const bool to_rest = w.find("+rest") != std::string::npos;
    const int first = std::atoi(environment("SLOPER_BENCH_START", "0")),
              starts = to_rest ? std::atoi(environment("SLOPER_BENCH_STARTS", "1")) : 1;
    double seconds = 0;
    for (int seed = first; seed < first + starts; ++seed)
      seconds +=
          run(folder, name, w.find("+self") != std::string::npos, to_rest, scenes.at(name), seed);
    if (starts > 1)
      std::printf("%-20s %8.3f s to rest, mean of %d starts\n", w.c_str(), seconds / starts,
                  starts);
  }
  return 0;
}
